struct Tuple {
    _0: f32,
    _1: u32,
}

struct StoredTuple {
    arg0: f32,
    arg1: u32,
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

fn loops_with_values(x: f32, n: u32) -> f32 {
    var leave: u32 = 0u;
    var i: u32 = 0u;
    var first: f32;
    loop {
        i = i + 1u;
        if (f32(i) * params.lit_3_0 > x) {
            first = f32(i);
            break;
        }
        if (i > n) {
            first = -1.0f;
            break;
        }
    }
    let first_1 = first;
    var outer: u32;
    loop {
        loop {
            i = i + 1u;
            if (i % 5u == 0u) {
                outer = i;
                leave = 4u;
                break;
            }
            if (i > 12u) {
                break;
            }
        }
        if (leave == 4u) {
            leave = 0u;
            break;
        }
        outer = 100u;
        break;
    }
    return first_1 + f32(outer);
}

fn element(input: Tuple) -> f32 {
    return loops_with_values(input._0, input._1);
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
