struct Tuple {
    _0: i32,
    _1: u32,
}

struct StoredTuple {
    arg0: i32,
    arg1: u32,
}

struct StoredVec4 {
    value: vec4<f32>,
}

struct Params {
    none: u32,
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

fn to_float(a: i32, b: u32) -> vec4<f32> {
    return vec4<f32>(f32(a), f32(b), f32(bitcast<u32>(a)), f32(bitcast<i32>(b)));
}

fn element(input: Tuple) -> vec4<f32> {
    return to_float(input._0, input._1);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple>;
@group(0) @binding(3) var<storage, read_write> outputs: array<StoredVec4>;

fn load_input(i: u32) -> Tuple {
    let s = inputs[i];
    return Tuple(s.arg0, s.arg1);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let result = element(load_input(index));
    outputs[index] = StoredVec4(vec4<f32>(result.x, result.y, result.z, result.w));
}
