//! What a WGSL program consists of, and its size.
//!
//! naga, the compiler of wgpu, reads the text: what is listed here is in the program, whatever its
//! comments say.

use naga::back::spv;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use naga::{AddressSpace, Handle, Module, Type, TypeInner};

/// A program that naga refuses.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the program is not valid: {message}; a kernel's own text always is")]
pub struct InvalidProgram {
    /// naga's message.
    pub message: String,
}

/// The declarations of a WGSL program.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Program {
    /// Names of the functions, the entry point's among them.
    pub functions: Vec<String>,
    /// Names of the structs.
    pub structs: Vec<String>,
    /// Names of the buffers, textures and samplers.
    pub bindings: Vec<String>,
    /// Names of the numbers in the uniform buffer: captured ones, literals, and lengths of buffers.
    pub numbers: Vec<String>,
    /// Names of the constants and overrides.
    pub constants: Vec<String>,
    /// How large it is.
    pub size: ProgramSize,
    /// The words of its SPIR-V, as naga writes it without names and without bounds checks.
    pub spirv: Vec<u32>,
}

/// How large a program is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ProgramSize {
    /// Bytes of its text.
    pub wgsl_bytes: usize,
    /// Functions.
    pub functions: usize,
    /// Instructions of its SPIR-V, declarations among them, as naga writes it without names and
    /// without bounds checks.
    pub instructions: usize,
    /// Those of its functions alone.
    pub code: usize,
    /// Buffers, textures and samplers.
    pub bindings: usize,
    /// Bytes of the variables of all functions: stacks of traversals, above all.
    pub private_bytes: u64,
    /// Bytes of workgroup memory.
    pub workgroup_bytes: u64,
}

impl Program {
    /// Reads a program.
    ///
    /// ```
    /// use raydsl::prelude::*;
    /// use raydsl_report::Program;
    ///
    /// let kernel = kernel!(|x: f32| x * x);
    /// let program = Program::read(&kernel.wgsl())?;
    /// assert!(program.functions.contains(&"kernel".to_owned()));
    /// assert_eq!(program.size.bindings, 4);
    /// # Ok::<(), raydsl_report::InvalidProgram>(())
    /// ```
    ///
    /// # Errors
    ///
    /// If naga refuses the text.
    pub fn read(wgsl: &str) -> Result<Self, InvalidProgram> {
        let module = naga::front::wgsl::parse_str(wgsl)
            .map_err(|error| invalid(error.emit_to_string(wgsl)))?;
        let globals = || module.global_variables.iter().map(|(_, global)| global);
        let bindings: Vec<String> =
            globals().filter(|g| g.binding.is_some()).filter_map(|g| g.name.clone()).collect();
        let numbers = globals().find(|g| g.name.as_deref() == Some(PARAMETERS));
        let functions = module.functions.iter().filter_map(|(_, f)| f.name.clone());
        let entries = module.entry_points.iter().map(|entry| entry.name.clone());
        let is_struct = |t: &&Type| matches!(t.inner, TypeInner::Struct { .. });
        let structs = module.types.iter().map(|(_, t)| t).filter(is_struct);
        let constants = module.constants.iter().filter_map(|(_, c)| c.name.clone());
        let overrides = module.overrides.iter().filter_map(|(_, o)| o.name.clone());
        let functions: Vec<String> = functions.chain(entries).collect();
        let words = spirv(&module)?;
        let size = ProgramSize {
            wgsl_bytes: wgsl.len(),
            functions: functions.len(),
            instructions: instructions(&words).count(),
            code: code(&words),
            bindings: bindings.len(),
            private_bytes: private_bytes(&module),
            workgroup_bytes: bytes_of(&module, AddressSpace::WorkGroup),
        };
        Ok(Self {
            functions,
            structs: structs.filter_map(|t| t.name.clone()).collect(),
            bindings,
            numbers: numbers.map(|g| members(&module, g.ty)).unwrap_or_default(),
            constants: constants.chain(overrides).collect(),
            size,
            spirv: words,
        })
    }

    /// Returns all names that the program declares.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        let lists =
            [&self.functions, &self.structs, &self.bindings, &self.numbers, &self.constants];
        lists.into_iter().flatten().map(String::as_str)
    }
}

/// How generated text calls the buffer of a kernel's numbers.
const PARAMETERS: &str = "params";

fn invalid(message: impl Into<String>) -> InvalidProgram {
    InvalidProgram { message: message.into() }
}

/// Returns the names of a struct's members.
fn members(module: &Module, ty: Handle<Type>) -> Vec<String> {
    match &module.types[ty].inner {
        TypeInner::Struct { members, .. } => {
            members.iter().filter_map(|member| member.name.clone()).collect()
        }
        _ => Vec::new(),
    }
}

fn private_bytes(module: &Module) -> u64 {
    let size = |ty: Handle<Type>| u64::from(module.types[ty].inner.size(module.to_ctx()));
    let functions = module.functions.iter().map(|(_, f)| f);
    let all = functions.chain(module.entry_points.iter().map(|entry| &entry.function));
    let locals: u64 = all.flat_map(|f| f.local_variables.iter()).map(|(_, v)| size(v.ty)).sum();
    locals + bytes_of(module, AddressSpace::Private)
}

/// Returns the bytes of the global variables of a space.
fn bytes_of(module: &Module, space: AddressSpace) -> u64 {
    let globals = module.global_variables.iter().map(|(_, global)| global);
    let size = |ty: Handle<Type>| u64::from(module.types[ty].inner.size(module.to_ctx()));
    globals.filter(|global| global.space == space).map(|global| size(global.ty)).sum()
}

/// Returns the words of a module's SPIR-V.
fn spirv(module: &Module) -> Result<Vec<u32>, InvalidProgram> {
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty()).validate(module);
    let info = info.map_err(|error| invalid(error.into_inner().to_string()))?;
    let options = spv::Options {
        flags: spv::WriterFlags::empty(),
        fake_missing_bindings: true,
        ..Default::default()
    };
    spv::write_vec(module, &info, &options, None).map_err(|error| invalid(error.to_string()))
}

/// Words of a module before its instructions.
const HEADER: usize = 5;

/// The opcode that begins a function.
const OP_FUNCTION: u32 = 54;

/// Returns the opcodes of a module, in order.
fn instructions(words: &[u32]) -> impl Iterator<Item = u32> {
    let mut at = HEADER;
    core::iter::from_fn(move || {
        let word = *words.get(at)?;
        at += (word >> 16).max(1) as usize;
        Some(word & 0xffff)
    })
}

/// Returns the number of instructions from the first function on.
fn code(words: &[u32]) -> usize {
    instructions(words).skip_while(|opcode| *opcode != OP_FUNCTION).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "
struct Params { scale: f32, lit_1_0: f32 }
struct Pair { a: f32, b: f32 }
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read_write> out: array<f32>;
var<workgroup> shared_by_all: array<f32, 8>;
const TWO: f32 = 2.0;
fn sum(p: Pair) -> f32 { return p.a + p.b; }
@compute @workgroup_size(8)
fn main(@builtin(local_invocation_index) i: u32) {
    var stack: array<u32, 16>;
    stack[i % 16u] = i;
    shared_by_all[i % 8u] = params.scale;
    out[i] = sum(Pair(TWO, f32(stack[i % 16u]))) + shared_by_all[i % 8u];
}
";

    #[test]
    fn declarations_are_listed() -> Result<(), InvalidProgram> {
        let program = Program::read(TEXT)?;
        assert_eq!(program.functions, ["sum", "main"]);
        assert_eq!(program.structs, ["Params", "Pair"]);
        assert_eq!(program.bindings, ["params", "out"]);
        assert_eq!(program.numbers, ["scale", "lit_1_0"]);
        assert_eq!(program.constants, ["TWO"]);
        let size = program.size;
        assert_eq!((size.private_bytes, size.workgroup_bytes, size.bindings), (64, 32, 2));
        assert_eq!(size.wgsl_bytes, TEXT.len());
        assert!(size.code > 20 && size.code < size.instructions, "{size:?}");
        assert!(Program::read("fn f() -> f32 { return 1u; }").is_err());
        Ok(())
    }
}
