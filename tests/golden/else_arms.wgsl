struct Tuple {
    _0: f32,
    _1: u32,
}

struct StoredTuple {
    arg0: f32,
    arg1: u32,
}

struct Params {
    lit_1_0: f32,
    lit_0_25: f32,
    lit_0_125: f32,
    lit_1_5: f32,
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

fn else_arms(x: f32, n: u32) -> f32 {
    var sum: f32 = 0.0f;
    var i: u32 = 0u;
    for (; i < n; i = i + 1u) {
        if (x < f32(i)) {
            sum = sum + params.lit_1_0;
            if (sum > 3.0f) {
                break;
            } else {
                sum = sum + params.lit_0_25;
            }
        } else if (x > 10.0f) {
            sum = sum - params.lit_0_125;
            continue;
        } else {
            sum = sum + x;
        }
        sum = sum * params.lit_1_5;
    }
    return sum;
}

fn element(input: Tuple) -> f32 {
    return else_arms(input._0, input._1);
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
