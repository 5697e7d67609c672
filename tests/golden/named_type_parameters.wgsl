struct Tuple {
    _0: f32,
}

struct StoredTuple {
    arg0: f32,
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

fn Couple_number() -> f32 {
    return 7.0f;
}

fn lucky(x: f32) -> f32 {
    return Couple_number() * x;
}

fn named_type_parameters(x: f32) -> f32 {
    return lucky(x) + Couple_number();
}

fn element(input: Tuple) -> f32 {
    return named_type_parameters(input._0);
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
