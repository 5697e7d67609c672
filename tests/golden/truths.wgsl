struct Tuple {
    _0: u32,
    _1: f32,
}

struct StoredTuple {
    arg0: u32,
    arg1: f32,
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

fn truths(a: u32, x: f32) -> u32 {
    let p = x > 0.0f;
    let q = a % 2u == 1u;
    let n = u32(p) + u32(q) * 2u;
    let m = u32(p && q) * 4u + u32(p || !q) * 8u + u32(p != q) * 16u;
    let k = bitcast<i32>(u32(!(p != q))) * 32i + bitcast<i32>(u32(p != (a > 7u))) * 64i + bitcast<i32>(u32((p && q) || !p)) * 128i;
    return n + m + bitcast<u32>(k);
}

fn element(input: Tuple) -> u32 {
    return truths(input._0, input._1);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple>;
@group(0) @binding(3) var<storage, read_write> outputs: array<u32>;

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
    outputs[index] = result;
}
