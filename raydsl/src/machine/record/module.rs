//! Printing of the whole module: types, bindings, functions, entry point.

use core::fmt::Write;
use std::collections::HashSet;

use super::function::{FunctionPrinter, Text};
use super::ir::{Function, SceneBuffer, Type, Uniform};
use super::lean::lean;
use super::storage::{self, Stored};
use super::types::Names;
use super::{Recording, State, textures};
use crate::machine::{
    Schema,
    wgsl::{Arithmetic, Buffer, Limits, Module, Texture, Window},
};

/// The workgroup of a grid of pixels: a square, so that the rays of neighbours run together.
const OF_PIXELS: [u32; 2] = [8, 8];
/// The workgroup of a batch, which is a grid of one row.
const OF_ELEMENTS: [u32; 2] = [64, 1];

/// Returns the size of a kernel's workgroups.
fn workgroup(recording: &Recording) -> [u32; 2] {
    if recording.input.is_some() { OF_ELEMENTS } else { OF_PIXELS }
}

const JOB: &str = "\
struct Job {
    size: vec2<u32>,
    first: vec2<u32>,
    count: vec2<u32>,
    base: u32,
    pad: u32,
}
";

const SATURATE_I32: &str = "\
/// As Rust's `as`: out of range gives the nearest number, NaN gives 0.
fn saturate_i32(x: f32) -> i32 {
    if ((bitcast<u32>(x) & 0x7fffffffu) > 0x7f800000u) { return 0i; }
    if (x >= 2147483648.0) { return 2147483647i; }
    if (x < -2147483648.0) { return (-2147483647i - 1i); }
    return i32(x);
}
";

const SATURATE_U32: &str = "\
/// As Rust's `as`: out of range gives the nearest number, NaN gives 0.
fn saturate_u32(x: f32) -> u32 {
    if ((bitcast<u32>(x) & 0x7fffffffu) > 0x7f800000u) { return 0u; }
    if (x >= 4294967296.0) { return 4294967295u; }
    if (x <= 0.0) { return 0u; }
    return u32(x);
}
";

/// Returns a function that is not the kernel's.
fn helper_text(name: &str) -> String {
    match name {
        "saturate_i32" => SATURATE_I32.to_owned(),
        "saturate_u32" => SATURATE_U32.to_owned(),
        "exact_quotient" => include_str!("exact_quotient.wgsl").to_owned(),
        "exact_root" => include_str!("exact_root.wgsl").to_owned(),
        name => by_component(name),
    }
}

/// Returns the function of vectors that applies one of numbers, whose name it has with the number of
/// components behind it.
fn by_component(name: &str) -> String {
    let (of, n) = name.split_at(name.len() - 1);
    let params = if of == "exact_root" { &["a"][..] } else { &["a", "b"] };
    let declared: Vec<String> = params.iter().map(|p| format!("{p}: vec{n}<f32>")).collect();
    let component = |c: &str| {
        let arguments: Vec<String> = params.iter().map(|p| format!("{p}.{c}")).collect();
        format!("{of}({})", arguments.join(", "))
    };
    let count = n.parse().unwrap_or(4);
    let components: Vec<String> =
        ["x", "y", "z", "w"].into_iter().take(count).map(component).collect();
    format!(
        "fn {name}({}) -> vec{n}<f32> {{\n    return vec{n}<f32>({});\n}}\n",
        declared.join(", "),
        components.join(", ")
    )
}

/// A module with the sources of its numbers and data: the text is reused where those change.
#[cfg_attr(not(feature = "gpu"), expect(dead_code, reason = "only a device runs modules"))]
pub(super) struct Printed {
    pub(super) module: Module,
    uniforms: Vec<Number>,
    /// Indices of the recorded buffers and textures in the text, in its order.
    buffers: Vec<usize>,
    textures: Vec<usize>,
}

/// A member of the uniform buffer.
#[derive(Clone, Copy)]
enum Number {
    /// A recorded uniform.
    Uniform(usize),
    /// The length of a recorded buffer.
    Length(usize),
}

impl Number {
    fn uniform(self, state: &State) -> Uniform {
        match self {
            Self::Uniform(i) => state.uniforms[i].clone(),
            Self::Length(i) => {
                let SceneBuffer { name, len, .. } = &state.buffers[i];
                let words = vec![*len as u32];
                let name = format!("len_of_{name}");
                Uniform { name, ty: Type::U32, words, is_constant: false }
            }
        }
    }
}

#[cfg(feature = "gpu")]
impl Printed {
    /// Returns the module with the numbers and data of a recording of the same program, for the
    /// same limits.
    pub(super) fn of(&self, recording: &Recording, limits: &Limits) -> Module {
        let state = &recording.state;
        let uniforms: Vec<Uniform> = self.uniforms.iter().map(|n| n.uniform(state)).collect();
        let mut module = Module { uniforms: uniform_bytes(&uniforms), ..self.module.clone() };
        for (buffer, i) in module.buffers.iter_mut().zip(&self.buffers) {
            let SceneBuffer { key, len, .. } = state.buffers[*i];
            let (stride, first) = (u64::from(buffer.stride), buffer.windows[0].binding);
            let windows = windows(len, stride, limits.max_binding_bytes, first);
            (buffer.key, buffer.len, buffer.windows) = (key, len, windows);
        }
        for (texture, i) in module.textures.iter_mut().zip(&self.textures) {
            texture.key = state.textures[*i].key;
        }
        module
    }
}

/// Prints the declaration of the uniform buffer.
fn uniform_block(uniforms: &[Uniform], names: &mut Names) -> String {
    let mut text = "struct Params {\n".to_owned();
    for u in uniforms {
        let _ = writeln!(text, "    {}: {},", u.name, names.ty(u.ty));
    }
    if uniforms.is_empty() {
        text += "    none: u32,\n";
    }
    text + "}\n"
}

/// Returns the bytes of the uniform buffer.
fn uniform_bytes(uniforms: &[Uniform]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for u in uniforms {
        let align = match u.ty {
            Type::Vector(_, 2) => 8,
            Type::Vector(..) => 16,
            _ => 4,
        };
        bytes.resize(usize::next_multiple_of(bytes.len(), align), 0);
        bytes.extend(u.words.iter().flat_map(|w| w.to_le_bytes()));
    }
    bytes.resize(usize::next_multiple_of(bytes.len().max(1), 16), 0);
    bytes
}

/// Returns the number of windows of a buffer.
#[cfg(feature = "gpu")]
pub(super) fn window_count(buffer: &SceneBuffer, limits: &Limits) -> usize {
    let stride = storage::stride(buffer.schema) as u64;
    windows(buffer.len, stride, limits.max_binding_bytes, 0).len()
}

/// Splits `len` elements into windows of at most `max` bytes.
fn windows(len: u64, stride: u64, max: u64, first_binding: u32) -> Vec<Window> {
    let each = (max / stride).max(1);
    let count = len.div_ceil(each).max(1);
    (0..count)
        .map(|i| Window {
            binding: first_binding + i as u32,
            first: i * each,
            count: each.min(len.saturating_sub(i * each)),
        })
        .collect()
}

/// Returns the name of a stored type's struct, and whether that is the value's own.
fn stored_type(schema: &'static Schema, names: &mut Names) -> (String, bool) {
    let stored = Stored::new(schema);
    let name = match schema {
        Schema::F32 | Schema::I32 | Schema::U32 | Schema::Kind { .. } => {
            return (names.ty(Type::of(schema)), true);
        }
        Schema::Struct { .. } => {
            let value = names.ty(Type::of(schema));
            if stored.is_value(schema) {
                return (value, true);
            }
            format!("Stored{value}")
        }
        Schema::Vector(element, n) => {
            let kind = match element {
                Schema::I32 => "I",
                Schema::U32 => "U",
                Schema::Bool => "B",
                _ => "",
            };
            format!("Stored{kind}Vec{n}")
        }
        Schema::Array { .. } => "StoredArray".to_owned(),
        Schema::Bool => "StoredBool".to_owned(),
        Schema::Small { .. } | Schema::Host => "StoredValue".to_owned(),
    };
    (names.stored(&name, |name| stored.declaration(name)), false)
}

/// Prints the bindings of a scene buffer and the accessor that hides its windows.
fn buffer_text(buffer: &Buffer, schema: &'static Schema, names: &mut Names) -> String {
    let (element, same) = stored_type(schema, names);
    let value = names.ty(Type::of(schema));
    let name = &buffer.name;
    let several = buffer.windows.len() > 1;
    let window = |i: usize| if several { format!("{name}_part{i}") } else { name.clone() };
    let mut text = String::new();
    for (i, w) in buffer.windows.iter().enumerate() {
        let _ = writeln!(
            text,
            "@group(0) @binding({}) var<storage, read> {}: array<{element}>;",
            w.binding,
            window(i)
        );
    }
    let give = |i: usize, index: String, names: &mut Names| {
        if same {
            return format!("return {}[{index}];", window(i));
        }
        let stored = Stored::new(schema);
        format!("let s = {}[{index}];\n    return {};", window(i), stored.load(schema, "s", names))
    };
    let _ = writeln!(text, "\nfn {name}_at(i: u32) -> {value} {{");
    if several {
        let each = buffer.windows[0].count;
        let _ = writeln!(text, "    switch (i / {each}u) {{");
        for (i, w) in buffer.windows.iter().enumerate().skip(1) {
            let body = give(i, format!("i - {}u", w.first), names).replace('\n', "\n        ");
            let _ = writeln!(
                text,
                "        case {i}u: {{\n            {}\n        }}",
                body.trim_start()
            );
        }
        text += "        default: {}\n    }\n";
    }
    let _ = writeln!(text, "    {}\n}}", give(0, "i".to_owned(), names));
    text
}

/// Prints the accessor for an index that a kernel computed.
fn element_text(name: &str, value: &str) -> String {
    format!(
        "\n/// The last element stands for those out of range.\n\
         fn {name}_element(i: u32) -> {value} {{\n    \
         return {name}_at(min(i, max(params.len_of_{name}, 1u) - 1u));\n}}\n"
    )
}

/// Returns the identifiers of a text.
pub(super) fn identifiers(text: &str) -> HashSet<&str> {
    text.split(|c: char| !(c.is_alphanumeric() || c == '_')).filter(|w| !w.is_empty()).collect()
}

fn function_text(state: &State, i: usize, names: &mut Names) -> String {
    match &state.functions[i] {
        Function::Recorded(f) => FunctionPrinter::new(f, &Text { state }).print(names),
        Function::Text { text, types, .. } => {
            if !text.is_empty() {
                types.iter().for_each(|ty| drop(names.ty(Type::of(ty))));
            }
            text.clone()
        }
    }
}

/// Returns the functions that the entry needs, callees first. It follows the text: calls recorded
/// behind a condition of the host that never holds are not in it.
fn reachable(state: &State, entry: usize) -> Vec<usize> {
    fn visit(state: &State, i: usize, seen: &mut Vec<usize>, under_way: &mut Vec<usize>) {
        if seen.contains(&i) || under_way.contains(&i) {
            return;
        }
        under_way.push(i);
        let text = function_text(state, i, &mut state.names());
        let words = identifiers(&text);
        for (j, g) in state.functions.iter().enumerate() {
            if j != i && words.contains(g.name()) {
                visit(state, j, seen, under_way);
            }
        }
        under_way.pop();
        seen.push(i);
    }
    let mut seen = Vec::new();
    visit(state, entry, &mut seen, &mut Vec::new());
    seen
}

fn entry_text(recording: &Recording, names: &mut Names) -> String {
    let State { functions, .. } = &recording.state;
    let kernel = functions[recording.entry].name();
    let mut text = String::new();
    let argument = match recording.input {
        None => "at.x, at.y".to_owned(),
        Some(schema) => {
            let (element, same) = stored_type(schema, names);
            let _ = writeln!(
                text,
                "@group(0) @binding(2) var<storage, read> inputs: array<{element}>;"
            );
            if same { "inputs[index]".to_owned() } else { "load_input(index)".to_owned() }
        }
    };
    let (element, same) = stored_type(recording.output, names);
    let _ =
        writeln!(text, "@group(0) @binding(3) var<storage, read_write> outputs: array<{element}>;");
    if let Some(schema) = recording.input
        && argument.starts_with("load_input")
    {
        let value = names.ty(Type::of(schema));
        let load = Stored::new(schema).load(schema, "s", names);
        let _ = writeln!(
            text,
            "\nfn load_input(i: u32) -> {value} {{\n    let s = inputs[i];\n    return {load};\n}}"
        );
    }
    let result = if same {
        "result".to_owned()
    } else {
        Stored::new(recording.output).store(recording.output, &element, "result")
    };
    let workgroup = workgroup(recording);
    let _ = writeln!(
        text,
        "
@compute @workgroup_size({}, {})
fn main(@builtin(global_invocation_id) id: vec3<u32>) {{
    if (any(id.xy >= job.count)) {{ return; }}
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let result = {kernel}({argument});
    outputs[index] = {result};
}}",
        workgroup[0], workgroup[1]
    );
    text
}

/// Prints the whole module.
pub(super) fn module(recording: &Recording, limits: &Limits) -> Printed {
    let recording = &lean(recording);
    let state = &recording.state;
    let mut names = state.names();
    if recording.arithmetic == Arithmetic::Strict {
        names.quotients = limits.quotients;
    }
    let order = reachable(state, recording.entry);

    let mut functions = String::new();
    for i in &order {
        let text = function_text(state, *i, &mut names);
        if !text.is_empty() {
            functions += "\n";
            functions += &text;
        }
    }
    let words = identifiers(&functions);

    let is_used = |i: &usize| words.contains(state.uniforms[*i].name.as_str());
    let mut numbers: Vec<Number> =
        (0..state.uniforms.len()).filter(is_used).map(Number::Uniform).collect();
    let (mut buffers, mut printed_buffers) = (Vec::new(), Vec::new());
    let mut bindings = String::new();
    let mut binding = 4;
    for (i, b) in state.buffers.iter().enumerate() {
        let has_elements = words.contains(format!("{}_element", b.name).as_str());
        // A kernel may use the length and no element.
        let length = format!("len_of_{}", b.name);
        if has_elements || words.contains(length.as_str()) {
            numbers.push(Number::Length(i));
        }
        if !has_elements && !words.contains(format!("{}_at", b.name).as_str()) {
            continue;
        }
        let stride = storage::stride(b.schema) as u64;
        let windows = windows(b.len, stride, limits.max_binding_bytes, binding);
        binding += windows.len() as u32;
        let buffer =
            Buffer { key: b.key, name: b.name.clone(), stride: stride as u32, len: b.len, windows };
        bindings += "\n";
        bindings += &buffer_text(&buffer, b.schema, &mut names);
        if has_elements {
            bindings += &element_text(&b.name, &names.ty(Type::of(b.schema)));
        }
        buffers.push(buffer);
        printed_buffers.push(i);
    }
    let is_sampled =
        |i: &usize| words.contains(format!("{}_sample", state.textures[*i].name).as_str());
    let printed_textures: Vec<usize> = (0..state.textures.len()).filter(is_sampled).collect();
    let mut textures: Vec<Texture> =
        printed_textures.iter().map(|i| state.textures[*i].clone()).collect();
    for texture in &mut textures {
        texture.binding = binding;
        binding += 2;
        bindings += "\n";
        bindings += &textures::bindings(texture);
    }
    let entry = entry_text(recording, &mut names);
    let uniforms: Vec<Uniform> = numbers.iter().map(|n| n.uniform(state)).collect();
    let params = uniform_block(&uniforms, &mut names);
    let mut source = names.declarations();
    source += &names.stored_declarations();
    source += &params;
    source += "\n";
    source += JOB;
    source += "\n@group(0) @binding(0) var<uniform> params: Params;\n";
    source += "@group(0) @binding(1) var<uniform> job: Job;\n";
    source += &bindings;
    for helper in &names.helpers {
        source += "\n";
        source += &helper_text(helper);
    }
    source += &functions;
    source += "\n";
    source += &entry;
    let module = Module {
        source,
        arithmetic: recording.arithmetic,
        workgroup: workgroup(recording),
        uniforms: uniform_bytes(&uniforms),
        input_stride: recording.input.map_or(0, |s| storage::stride(s) as u32),
        output_stride: storage::stride(recording.output) as u32,
        buffers,
        textures,
    };
    Printed { module, uniforms: numbers, buffers: printed_buffers, textures: printed_textures }
}
