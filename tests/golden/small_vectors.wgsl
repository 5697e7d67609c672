struct Tuple {
    _0: vec2<f32>,
    _1: vec4<f32>,
    _2: f32,
}

struct StoredTuple {
    arg1: vec4<f32>,
    arg0: vec2<f32>,
    arg2: f32,
    pad_28: u32,
}

struct StoredVec4 {
    value: vec4<f32>,
}

struct Params {
    lit_2_0: f32,
    lit_0_5: f32,
    lit_7_0: f32,
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

fn small_vectors(a: vec2<f32>, b: vec4<f32>, x: f32) -> vec4<f32> {
    let c = vec2<f32>(x, params.lit_2_0) * a + params.lit_0_5;
    let d = c * (1.0f / sqrt(c.x * c.x + c.y * c.y)) - a / params.lit_7_0;
    let e = b * x - vec4<f32>(d.x, d.y, c.x * a.x + c.y * a.y, sqrt(c.x * c.x + c.y * c.y));
    return e + vec4<f32>(a.x, a.y, b.z, b.w) * 0.25f;
}

fn element(input: Tuple) -> vec4<f32> {
    return small_vectors(input._0, input._1, input._2);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple>;
@group(0) @binding(3) var<storage, read_write> outputs: array<StoredVec4>;

fn load_input(i: u32) -> Tuple {
    let s = inputs[i];
    return Tuple(s.arg0, s.arg1, s.arg2);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let result = element(load_input(index));
    outputs[index] = StoredVec4(vec4<f32>(result.x, result.y, result.z, result.w));
}
