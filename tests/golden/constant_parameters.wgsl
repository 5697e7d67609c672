struct Tuple {
    _0: f32,
    _1: f32,
}

struct StoredTuple {
    arg0: f32,
    arg1: f32,
}

struct Params {
    lit_2_0: f32,
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

fn sum_of(values: array<f32, 3>, scale: f32) -> f32 {
    var sum: f32 = 0.0f;
    var i: u32 = 0u;
    for (; i < 3u; i = i + 1u) {
        sum = sum + select(select(values[0], values[1], (i >= 1u)), values[2], (i >= 2u));
    }
    return sum * scale;
}

fn generic_sum_of(values: array<f32, 2>) -> f32 {
    var sum: f32 = 0.0f;
    var i: u32 = 0u;
    for (; i < 2u; i = i + 1u) {
        sum = sum + select(values[0], values[1], (i >= 1u));
    }
    return sum - params.lit_2_0;
}

fn constant_parameters(x: f32, y: f32) -> f32 {
    return sum_of(array<f32, 3>(x, y, x * 0.5f), 2.0f) + generic_sum_of(array<f32, 2>(y, x));
}

fn element(input: Tuple) -> f32 {
    return constant_parameters(input._0, input._1);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple>;
@group(0) @binding(3) var<storage, read_write> outputs: array<f32>;

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
