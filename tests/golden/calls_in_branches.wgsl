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

fn half(x: f32) -> f32 {
    return x * 0.5f;
}

fn first_below(x: f32, limit: f32) -> f32 {
    var y: f32 = x;
    var i: u32 = 0u;
    for (; i < 40u; i = i + 1u) {
        if (y < limit) {
            return y;
        }
        y = half(y) - params.lit_1_0;
    }
    return limit;
}

fn deeper(x: f32, n: u32) -> f32 {
    if (n % 2u == 0u) {
        return first_below(x, 3.0f);
    }
    return half(first_below(x * 2.0f, half(x)));
}

fn calls_in_branches(x: f32, n: u32) -> f32 {
    var sum: f32 = 0.0f;
    var i: u32 = 0u;
    for (; i < n; i = i + 1u) {
        var value: f32;
        if (x > f32(i)) {
            if (deeper(x, i) > 1.0f) {
                continue;
            }
            value = half(sum);
        } else if (first_below(x, sum) < -20.0f) {
            return sum;
        } else {
            value = deeper(sum, i);
        }
        sum = sum + value;
    }
    return sum;
}

fn element(input: Tuple) -> f32 {
    return calls_in_branches(input._0, input._1);
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
