struct Codes {
    a: u32,
    b: u32,
    c: u32,
    d: u32,
}

struct Tuple {
    _0: Codes,
}

struct StoredTuple {
    arg0_d: u32,
    arg0_c_arg0_a_arg0_b: u32,
}

struct StoredVec4 {
    value: vec4<f32>,
}

struct Params {
    lit_255_0: f32,
    lit_65535_0: f32,
}

struct Job {
    size: vec2<u32>,
    first: vec2<u32>,
    count: vec2<u32>,
    base: u32,
    pad: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<uniform> job: Job;

fn unorms(c: Codes) -> vec4<f32> {
    return vec4<f32>(f32(c.a) / params.lit_255_0, f32(c.b) / params.lit_255_0, f32(c.c) / params.lit_65535_0, f32(c.d) / 4294967300.0f);
}

fn element(input: Tuple) -> vec4<f32> {
    return unorms(input._0);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple>;
@group(0) @binding(3) var<storage, read_write> outputs: array<StoredVec4>;

fn load_input(i: u32) -> Tuple {
    let s = inputs[i];
    return Tuple(Codes((s.arg0_c_arg0_a_arg0_b >> 16u) & 0xffu, (s.arg0_c_arg0_a_arg0_b >> 24u) & 0xffu, s.arg0_c_arg0_a_arg0_b & 0xffffu, s.arg0_d));
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let result = element(load_input(index));
    outputs[index] = StoredVec4(vec4<f32>(result.x, result.y, result.z, result.w));
}
