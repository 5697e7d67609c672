struct Tuple {
    _0: f32,
    _1: u32,
}

struct StoredTuple {
    arg0: f32,
    arg1: u32,
}

struct Params {
    lit_100_0: f32,
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

fn labelled_blocks(x: f32, n: u32) -> f32 {
    var leave: u32 = 0u;
    var sum: f32 = x;
    var i: u32 = 0u;
    for (; i < n; i = i + 1u) {
        let i_1 = i;
        var y: f32;
        loop {
            if (sum > 20.0f) {
                y = 1.0f;
                break;
            }
            if (i_1 == 4u) {
                leave = 3u;
                break;
            }
            if (sum < -50.0f) {
                leave = 2u;
                break;
            }
            y = sum * 0.5f;
            break;
        }
        if (leave == 3u) {
            leave = 0u;
            continue;
        }
        if (leave == 2u) {
            leave = 0u;
            break;
        }
        sum = sum + y;
    }
    loop {
        if (sum > 5.0f) {
            break;
        }
        sum = sum + params.lit_100_0;
        break;
    }
    return sum;
}

fn element(input: Tuple) -> f32 {
    return labelled_blocks(input._0, input._1);
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
