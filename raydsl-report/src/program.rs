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
#[non_exhaustive]
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
    /// Those that may run more than once for an invocation: in loops, and of functions that are called
    /// in loops.
    pub in_loops: usize,
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
            in_loops: in_loops(&words),
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
/// The opcode of a call.
const OP_FUNCTION_CALL: u32 = 57;
/// The opcode that stands in a loop's first block, and names the block behind the loop.
const OP_LOOP_MERGE: u32 = 246;
/// The opcode that begins a block.
const OP_LABEL: u32 = 248;

/// Returns the instructions of a module, in order: the opcode, and the words behind it.
fn instructions(words: &[u32]) -> impl Iterator<Item = (u32, &[u32])> {
    let mut rest = words.get(HEADER..).unwrap_or_default();
    core::iter::from_fn(move || {
        let (first, _) = rest.split_first()?;
        let length = ((first >> 16).max(1) as usize).min(rest.len());
        let (instruction, behind) = rest.split_at(length);
        rest = behind;
        Some((first & 0xffff, &instruction[1..]))
    })
}

/// Returns the number of instructions from the first function on.
fn code(words: &[u32]) -> usize {
    instructions(words).skip_while(|(opcode, _)| *opcode != OP_FUNCTION).count()
}

/// A function of a module.
#[derive(Default)]
struct Counted {
    id: u32,
    instructions: usize,
    in_loops: usize,
    /// The functions that it calls, and whether it does in a loop.
    calls: Vec<(u32, bool)>,
}

/// Returns the number of instructions in loops, and of functions that are called there. Blocks are
/// written in order: those of a loop come before the one behind it.
fn in_loops(words: &[u32]) -> usize {
    let mut functions: Vec<Counted> = Vec::new();
    let mut ends: Vec<u32> = Vec::new();
    for (opcode, operands) in instructions(words) {
        match (opcode, operands) {
            (OP_FUNCTION, [_, id, ..]) => {
                functions.push(Counted { id: *id, ..Counted::default() });
                ends.clear();
            }
            (OP_LOOP_MERGE, [end, ..]) => ends.push(*end),
            (OP_LABEL, [id, ..]) if ends.last() == Some(id) => drop(ends.pop()),
            _ => {}
        }
        let Some(function) = functions.last_mut() else { continue };
        function.instructions += 1;
        function.in_loops += usize::from(!ends.is_empty());
        if let (OP_FUNCTION_CALL, [_, _, id, ..]) = (opcode, operands) {
            function.calls.push((*id, !ends.is_empty()));
        }
    }
    // All of a function that is called in a loop, and of those that it calls. WGSL has no recursion.
    let calls = functions.iter().flat_map(|f| &f.calls);
    let mut repeated: Vec<u32> = calls.filter(|(_, in_loop)| *in_loop).map(|(id, _)| *id).collect();
    repeated.sort_unstable();
    repeated.dedup();
    let mut next = 0;
    while let Some(&caller) = repeated.get(next) {
        let callers = functions.iter().filter(|f| f.id == caller);
        for (id, _) in callers.flat_map(|f| &f.calls) {
            if !repeated.contains(id) {
                repeated.push(*id);
            }
        }
        next += 1;
    }
    let count = |f: &Counted| if repeated.contains(&f.id) { f.instructions } else { f.in_loops };
    functions.iter().map(count).sum()
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
        assert_eq!(size.in_loops, 0);
        assert!(Program::read("fn f() -> f32 { return 1u; }").is_err());
        Ok(())
    }

    #[test]
    fn what_loops_run_is_counted() -> Result<(), InvalidProgram> {
        let text = |inner: &str, behind: &str| {
            format!(
                "
@group(0) @binding(0) var<storage, read_write> out: array<f32>;
fn below(x: f32) -> f32 {{ return x * 3.0 + 1.0; }}
fn twice(x: f32) -> f32 {{ return below(x) * 2.0; }}
@compute @workgroup_size(8)
fn main(@builtin(local_invocation_index) i: u32) {{
    var sum = 0.0;
    for (var k = 0u; k < i; k++) {{
        sum += f32(k);
        {inner}
    }}
    {behind}
    out[i] = sum;
}}
"
            )
        };
        let count = |inner, behind| Program::read(&text(inner, behind)).map(|p| p.size.in_loops);
        let plain = count("", "")?;
        assert!(plain > 5, "{plain}");
        // What stands behind the loop runs once.
        assert_eq!(count("", "sum = twice(sum) * 7.0;")?, plain);
        let more = count("sum = sum * 7.0;", "")?;
        assert!(more > plain && more < plain + 6, "{more} {plain}");
        // Both functions, and the call.
        let called = count("sum = twice(sum);", "")?;
        assert!(called > plain + 10, "{called} {plain}");
        let within = count("for (var j = 0u; j < k; j++) { sum *= 2.0; }", "")?;
        assert!(within > plain + 5, "{within} {plain}");
        Ok(())
    }
}
