struct Tuple {
    _0: f32,
    _1: f32,
    _2: u32,
}

struct StoredTuple {
    arg0: f32,
    arg1: f32,
    arg2: u32,
}

struct Params {
    lit_10_0: f32,
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

fn permuted_names(a: f32, b: f32, n: u32) -> f32 {
    var first: f32;
    if (a > b) {
        first = b * params.lit_10_0 + a;
    } else {
        first = a - b;
    }
    let t = n % 3u;
    let u = n % 5u;
    var second: u32;
    let value_6 = n % 2u;
    if (value_6 == 0u) {
        second = t * 10u + u;
    } else {
        second = t + u * 10u;
    }
    var third: f32;
    if (a > b) {
        third = a;
    } else {
        third = a * 0.5f;
    }
    return first + f32(second) + third;
}

fn element(input: Tuple) -> f32 {
    return permuted_names(input._0, input._1, input._2);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple>;
@group(0) @binding(3) var<storage, read_write> outputs: array<f32>;

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
    outputs[index] = result;
}
