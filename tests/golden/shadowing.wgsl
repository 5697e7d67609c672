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
    lit_0_5: f32,
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

fn shadowing(x: f32, y: f32) -> f32 {
    let x_1 = x + params.lit_1_0;
    var y_1: f32 = y * x_1;
    if (x_1 > 3.0f) {
        let x_2 = y_1 - params.lit_1_0;
        var y_2: f32 = x_2 * 0.5f;
        y_2 = y_2 + params.lit_1_0;
        if (y_2 > x_2) {
            y_2 = y_2 * 2.0f;
        }
        return y_2 + x_2;
    }
    y_1 = y_1 + x_1;
    let y_3 = y_1 - params.lit_0_5;
    let x_3 = select(-x_1, x_1, (y_3 > 0.0f));
    return x_3 * y_3;
}

fn element(input: Tuple) -> f32 {
    return shadowing(input._0, input._1);
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
