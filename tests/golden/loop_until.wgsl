struct Tuple {
    _0: f32,
}

struct StoredTuple {
    arg0: f32,
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

fn loop_until(x: f32) -> u32 {
    var n: u32 = 0u;
    var y: f32 = x;
    loop {
        n = n + 1u;
        y = y * 0.5f - params.lit_1_0;
        if (y < -1.5f || n == 40u) {
            break;
        }
        if (n % 2u == 0u) {
            continue;
        }
        y = y + params.lit_0_125;
    }
    return n;
}

fn element(input: Tuple) -> u32 {
    return loop_until(input._0);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple>;
@group(0) @binding(3) var<storage, read_write> outputs: array<u32>;

fn load_input(i: u32) -> Tuple {
    let s = inputs[i];
    return Tuple(s.arg0);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let result = element(load_input(index));
    outputs[index] = result;
}
