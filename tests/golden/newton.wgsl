struct Tuple {
    _0: f32,
}

struct StoredTuple {
    arg0: f32,
}

struct Params {
    lit_0_5: f32,
    lit_0_0001: f32,
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

fn newton(x: f32) -> f32 {
    let a = abs(x) + params.lit_0_5;
    var y: f32 = a;
    var last: f32 = 0.0f;
    while (abs(y - last) > params.lit_0_0001 * y) {
        last = y;
        y = (y + a / y) * 0.5f;
    }
    return y;
}

fn element(input: Tuple) -> f32 {
    return newton(input._0);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple>;
@group(0) @binding(3) var<storage, read_write> outputs: array<f32>;

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
