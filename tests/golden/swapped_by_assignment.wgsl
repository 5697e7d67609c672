struct Tuple {
    _0: f32,
    _1: f32,
}

struct StoredTuple {
    arg0: f32,
    arg1: f32,
}

struct Params {
    none: u32,
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

fn swapped_by_assignment(a: f32, b: f32) -> f32 {
    var x: f32 = a;
    var y: f32 = b;
    var p_x: f32 = 1.0f;
    var p_y: f32 = 2.0f;
    let x_1 = x;
    x = y;
    y = x_1;
    let p_x_1 = p_x;
    p_x = x;
    p_y = p_x_1;
    return x * 2.0f - y + p_x + p_y;
}

fn element(input: Tuple) -> f32 {
    return swapped_by_assignment(input._0, input._1);
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
