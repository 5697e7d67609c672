struct Tuple {
    _0: f32,
    _1: f32,
}

struct StoredTuple {
    arg0: f32,
    arg1: f32,
}

struct Params {
    lit_3_0: f32,
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

fn early_returns(x: f32, y: f32) -> f32 {
    if (x > y) {
        if (x > 10.0f) {
            return 1.0f;
        } else if (y < -10.0f) {
            return 2.0f;
        }
    } else if (x < 0.0f) {
        return x - y;
    } else {
        return x + y;
    }
    return x * params.lit_3_0;
}

fn element(input: Tuple) -> f32 {
    return early_returns(input._0, input._1);
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
