struct Tuple {
    _0: vec3<f32>,
    _1: vec3<f32>,
}

struct StoredTuple {
    arg0_x: f32,
    arg0_y: f32,
    arg0_z: f32,
    arg1_x: f32,
    arg1_y: f32,
    arg1_z: f32,
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

fn vector_parts(a: vec3<f32>, b: vec3<f32>) -> vec3<f32> {
    let v = floor(a) + ceil(b) - trunc(a);
    let t = select(a.z, a.y, a.y < a.z);
    let t_1 = select(t, a.x, a.x < t);
    let t_2 = select(b.z, b.y, b.z < b.y);
    let t_3 = select(t_2, b.x, t_2 < b.x);
    var result: vec3<f32>;
    if (t_1 > t_3) {
        result = -vec3<f32>(t_1, t_3, v.z);
    } else {
        result = vec3<f32>(t_1, t_3, v.z) + abs(b);
    }
    return result;
}

fn element(input: Tuple) -> vec3<f32> {
    return vector_parts(input._0, input._1);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple>;
@group(0) @binding(3) var<storage, read_write> outputs: array<StoredVec3>;

fn load_input(i: u32) -> Tuple {
    let s = inputs[i];
    return Tuple(vec3<f32>(s.arg0_x, s.arg0_y, s.arg0_z), vec3<f32>(s.arg1_x, s.arg1_y, s.arg1_z));
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let result = element(load_input(index));
    outputs[index] = StoredVec3(result.x, result.y, result.z);
}
