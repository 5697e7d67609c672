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

fn blocks_with_exits(x: f32, n: u32) -> f32 {
    let t = x * 2.0f;
    let a = t + params.lit_1_0;
    var sum: f32 = a;
    var i: u32 = 0u;
    for (; i < n; i = i + 1u) {
        if (sum > 30.0f) {
            break;
        }
        let s = f32(i);
        if (s == 3.0f) {
            continue;
        }
        let step_ = s * 0.5f;
        var other: f32;
        if (step_ > 2.0f) {
            if (x < -20.0f) {
                return -1.0f;
            }
            other = step_;
        } else {
            other = 1.0f;
        }
        sum = sum + (step_ + other);
    }
    return sum;
}

fn element(input: Tuple) -> f32 {
    return blocks_with_exits(input._0, input._1);
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
