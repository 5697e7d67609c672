struct Tuple {
    _0: f32,
    _1: f32,
    _2: f32,
}

struct StoredTuple {
    arg0: f32,
    arg1: f32,
    arg2: f32,
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

fn clamped(x: f32, y: f32, z: f32) -> vec4<f32> {
    let low = select(y, z, z < y);
    let high = select(y, z, y < z);
    let t = select(x, low, x < low);
    let t_1 = select(x, 0.0f, x < 0.0f);
    return vec4<f32>(select(t, high, high < t), select(select(x, y, y < x), y, (x != x)), select(select(z, x, z < x), x, (z != z)), select(t_1, 1.0f, 1.0f < t_1));
}

fn element(input: Tuple) -> vec4<f32> {
    return clamped(input._0, input._1, input._2);
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
