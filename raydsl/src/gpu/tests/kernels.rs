//! The modules under test and their expected results.

use crate::machine::wgsl::{Arithmetic, Buffer, BufferKey, Module, Window};

/// The head of every module; `{columns}` and `{rows}` are filled in.
const HEAD: &str = "
struct Job { size: vec2<u32>, first: vec2<u32>, count: vec2<u32>, base: u32, pad: u32 }
@group(0) @binding(0) var<uniform> params: vec4<u32>;
@group(0) @binding(1) var<uniform> job: Job;
";

/// Returns the entry point around `body`, which has `pixel` and `linear` and sets `element`.
fn entry(workgroup: [u32; 2], body: &str) -> String {
    let [columns, rows] = workgroup;
    format!(
        "@compute @workgroup_size({columns}, {rows})
fn main(@builtin(global_invocation_id) gid: vec3<u32>) {{
    if (any(gid.xy >= job.count)) {{ return; }}
    let pixel = job.first + gid.xy;
    let linear = pixel.y * job.size.x + pixel.x;
    let element = linear - job.base;
    {body}
}}
"
    )
}

/// Returns the bytes of a parameter block.
pub(super) fn params(first: u32, second: u32) -> Vec<u8> {
    bytemuck::cast_slice(&[first, second, 0, 0]).to_vec()
}

/// Returns a pseudo-random index, the same in WGSL and here.
pub(super) fn hash(value: u32) -> u32 {
    let mixed = value.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((mixed >> ((mixed >> 28) + 4)) ^ mixed).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

const HASH: &str = "
fn hash(value: u32) -> u32 {
    let mixed = value * 747796405u + 2891336453u;
    let word = ((mixed >> ((mixed >> 28u) + 4u)) ^ mixed) * 277803737u;
    return (word >> 22u) ^ word;
}
";

/// Returns a scene buffer of `len` u32 in windows of `window` elements, from binding 4 on.
pub(super) fn scene_buffer(key: BufferKey, len: u64, window: u64) -> Buffer {
    let firsts = (0..len).step_by(window as usize);
    let windows = firsts.enumerate().map(|(number, first)| Window {
        binding: 4 + number as u32,
        first,
        count: window.min(len - first),
    });
    Buffer { key, name: "scene".to_owned(), stride: 4, len, windows: windows.collect() }
}

/// Returns a module for `output = scene[hash(linear) % len] + params.x`, through one accessor with
/// a `switch`.
pub(super) fn gather(key: BufferKey, len: u64, window: u64, add: u32) -> Module {
    let buffer = scene_buffer(key, len, window);
    let mut source = HEAD.to_owned() + HASH;
    let mut cases = String::new();
    for (number, Window { binding, .. }) in buffer.windows.iter().enumerate() {
        source += &format!(
            "@group(0) @binding({binding}) var<storage, read> scene{number}: array<u32>;\n"
        );
        let label = if number + 1 == buffer.windows.len() {
            "default".to_owned()
        } else {
            format!("case {number}u")
        };
        cases += &format!("        {label} {{ return scene{number}[at % {window}u]; }}\n");
    }
    source += "@group(0) @binding(3) var<storage, read_write> outputs: array<u32>;\n";
    source += &format!(
        "fn load(index: u32) -> u32 {{
    let at = min(index, {}u);
    switch at / {window}u {{
{cases}    }}
}}
",
        len - 1
    );
    let body = format!("outputs[element] = load(hash(linear) % {len}u) + params.x;");
    Module {
        source: source + &entry([8, 8], &body),
        workgroup: [8, 8],
        uniforms: params(add, 0),
        input_stride: 0,
        output_stride: 4,
        arithmetic: Arithmetic::Strict,
        buffers: vec![buffer],
        textures: vec![],
    }
}

/// Returns the expected result of [`gather`].
pub(super) fn gathered(scene: &[u32], pixels: u32, add: u32) -> Vec<u32> {
    let load = |linear| scene[hash(linear) as usize % scene.len()];
    (0..pixels).map(|linear| load(linear).wrapping_add(add)).collect()
}

/// Returns a module for `output = (input * params.x, pixel.x, pixel.y, linear)`: four words for
/// one.
pub(super) fn spread(workgroup: [u32; 2], factor: u32) -> Module {
    let storage = "
@group(0) @binding(2) var<storage, read> inputs: array<u32>;
@group(0) @binding(3) var<storage, read_write> outputs: array<vec4<u32>>;
";
    let body =
        "outputs[element] = vec4<u32>(inputs[element] * params.x, pixel.x, pixel.y, linear);";
    Module {
        source: format!("{HEAD}{storage}{}", entry(workgroup, body)),
        workgroup,
        uniforms: params(factor, 0),
        input_stride: 4,
        output_stride: 16,
        arithmetic: Arithmetic::Strict,
        buffers: Vec::new(),
        textures: Vec::new(),
    }
}

/// Returns the expected result of [`spread`].
pub(super) fn spreaded(inputs: &[u32], width: u32, factor: u32) -> Vec<[u32; 4]> {
    let elements = inputs.iter().zip(0u32..);
    elements
        .map(|(&input, linear)| {
            [input.wrapping_mul(factor), linear % width, linear / width, linear]
        })
        .collect()
}

/// Returns a module that hashes each pixel's index `params.x` times: work of any length.
pub(super) fn grind(rounds: u32) -> Module {
    let storage = "@group(0) @binding(3) var<storage, read_write> outputs: array<u32>;\n";
    let body = "var value = linear;
    for (var round = 0u; round < params.x; round++) { value = hash(value); }
    outputs[element] = value;";
    Module {
        source: format!("{HEAD}{HASH}{storage}{}", entry([8, 8], body)),
        workgroup: [8, 8],
        uniforms: params(rounds, 0),
        input_stride: 0,
        output_stride: 4,
        arithmetic: Arithmetic::Strict,
        buffers: Vec::new(),
        textures: Vec::new(),
    }
}

/// Returns the expected result of [`grind`].
pub(super) fn ground(pixels: u32, rounds: u32) -> Vec<u32> {
    let grind = |linear| (0..rounds).fold(linear, |value, _| hash(value));
    (0..pixels).map(grind).collect()
}
