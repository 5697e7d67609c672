struct Tuple {
    _0: f32,
    _1: f32,
}

struct StoredTuple {
    arg0: f32,
    arg1: f32,
}

struct StoredVec3 {
    value_x: f32,
    value_y: f32,
    value_z: f32,
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

fn tail_is_an_if(x: f32, y: f32) -> vec3<f32> {
    var result: vec3<f32>;
    if (x > y) {
        result = vec3<f32>(x, y, 0.0f);
    } else if (x == y) {
        result = vec3<f32>(x);
    } else {
        result = vec3<f32>(y, x, 1.0f) * 2.0f;
    }
    return result;
}

fn element(input: Tuple) -> vec3<f32> {
    return tail_is_an_if(input._0, input._1);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple>;
@group(0) @binding(3) var<storage, read_write> outputs: array<StoredVec3>;

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
    outputs[index] = StoredVec3(result.x, result.y, result.z);
}
