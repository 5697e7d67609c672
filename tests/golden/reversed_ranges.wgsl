struct Tuple {
    _0: u32,
    _1: f32,
}

struct StoredTuple {
    arg0: u32,
    arg1: f32,
}

struct Params {
    lit_1_0: f32,
    lit_0_125: f32,
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

fn reversed_ranges(n: u32, x: f32) -> f32 {
    var sum: f32 = x;
    var k: u32 = n;
    for (; 0u < k; k = k - 1u) {
        sum = sum * 0.5f + f32(k - 1u);
        if (sum > 30.0f) {
            continue;
        }
        sum = sum + params.lit_1_0;
    }
    var k_1: u32 = 3u;
    var done: bool = false;
    loop {
        if (!(!done && 0u <= k_1)) { break; }
        sum = sum - f32(k_1) * 0.25f;
        continuing {
            done = k_1 == 0u;
            k_1 = k_1 - 1u;
        }
    }
    var i: u32 = 2u;
    var done_1: bool = false;
    loop {
        if (!(!done_1 && i <= n)) { break; }
        sum = sum + params.lit_0_125;
        continuing {
            done_1 = i == n;
            i = i + 1u;
        }
    }
    return sum;
}

fn element(input: Tuple) -> f32 {
    return reversed_ranges(input._0, input._1);
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
