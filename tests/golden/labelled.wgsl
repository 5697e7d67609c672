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
    lit_0_5: f32,
    lit_0_25: f32,
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

fn labelled(x: f32, n: u32) -> f32 {
    var leave: u32 = 0u;
    var sum: f32 = 0.0f;
    var i: u32 = 0u;
    for (; i < n; i = i + 1u) {
        let i_1 = i;
        sum = sum + params.lit_1_0;
        var j: u32 = 0u;
        for (; j < i_1; j = j + 1u) {
            let j_1 = j;
            var k: u32 = 0u;
            loop {
                k = k + 1u;
                if (k > 3u) {
                    break;
                }
                if (x < sum && j_1 > 2u) {
                    leave = 3u;
                    break;
                }
                if (x > 90.0f && i_1 == 5u) {
                    leave = 2u;
                    break;
                }
                if (k == 2u && j_1 == 3u) {
                    leave = 5u;
                    break;
                }
                if (sum > 40.0f) {
                    leave = 4u;
                    break;
                }
                sum = sum + x * 0.125f;
            }
            if (leave == 3u) {
                break;
            }
            if (leave == 2u) {
                break;
            }
            if (leave == 5u) {
                leave = 0u;
                continue;
            }
            if (leave == 4u) {
                leave = 0u;
                break;
            }
            sum = sum + params.lit_0_5;
        }
        if (leave == 3u) {
            leave = 0u;
            continue;
        }
        if (leave == 2u) {
            leave = 0u;
            break;
        }
        sum = sum + params.lit_0_25;
    }
    return sum;
}

fn element(input: Tuple) -> f32 {
    return labelled(input._0, input._1);
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
