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
        var b: f32;
        if (y > 0.0f) {
            b = x + y;
        } else {
            b = x - y;
        }
        a = b * 2.0f;
    } else if (y > 10.0f) {
        if (x < -50.0f) {
            a = 3.0f;
        } else {
            a = y;
        }
    } else {
        a = x * y;
    }
    var value: f32;
    if (a > 5.0f) {
        value = a;
    } else {
        value = -a;
    }
    let c = params.lit_1_0 + value;
    var value_1: f32;
    if (x == y) {
        value_1 = 1.0f;
    } else {
        value_1 = 0.5f;
    }
    return c - value_1;
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

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let result = element(load_input(index));
    outputs[index] = result;
}
