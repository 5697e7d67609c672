struct Tuple {
    _0: f32,
    _1: f32,
}

struct StoredTuple {
    arg0: f32,
    arg1: f32,
}

struct Params {
    lit_1_0: f32,
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

fn value_ifs(x: f32, y: f32) -> f32 {
    var a: f32;
    if (x > 0.0f) {
        let b = select(x - y, x + y, (y > 0.0f));
        a = b * 2.0f;
    } else {
        a = select(x * y, select(y, 3.0f, (x < -50.0f)), (y > 10.0f));
    }
    let c = params.lit_1_0 + select(-a, a, (a > 5.0f));
    return c - select(0.5f, 1.0f, (x == y));
}

fn element(input: Tuple) -> f32 {
    return value_ifs(input._0, input._1);
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
