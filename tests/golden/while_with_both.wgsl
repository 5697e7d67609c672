struct Tuple {
    _0: u32,
    _1: f32,
}

struct StoredTuple {
    arg0: u32,
    arg1: f32,
}

struct Params {
    lit_1_25: f32,
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

fn while_with_both(n: u32, x: f32) -> f32 {
    var i: u32 = 0u;
    var y: f32 = x;
    while ((i < n && y * y < 500.0f) || i < 2u) {
        y = y + params.lit_1_25;
        i = i + 1u;
    }
    return y * f32(i);
}

fn element(input: Tuple) -> f32 {
    return while_with_both(input._0, input._1);
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
