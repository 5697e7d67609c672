struct Products {
    cross: vec3<f32>,
    unit: vec3<f32>,
    dot: f32,
    length: f32,
    least: vec3<f32>,
    scaled: vec3<f32>,
}

struct Tuple {
    _0: vec3<f32>,
    _1: vec3<f32>,
    _2: f32,
}

struct StoredTuple {
    arg0_x: f32,
    arg0_y: f32,
    arg0_z: f32,
    arg1_x: f32,
    arg1_y: f32,
    arg1_z: f32,
    arg2: f32,
}

struct StoredProducts {
    cross_x: f32,
    cross_y: f32,
    cross_z: f32,
    unit_x: f32,
    unit_y: f32,
    unit_z: f32,
    dot: f32,
    length: f32,
    least_x: f32,
    least_y: f32,
    least_z: f32,
    scaled_x: f32,
    scaled_y: f32,
    scaled_z: f32,
}

struct Params {
    lit_100_5: f32,
    lit_0_0: f32,
    lit_0_25: f32,
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

fn vectors(a: vec3<f32>, b: vec3<f32>, x: f32) -> Products {
    let shifted = a + vec3<f32>(params.lit_100_5, params.lit_0_0, params.lit_0_25);
    let t = a - b;
    let t_1 = select(b, a, a < b);
    let t_2 = -a;
    return Products(vec3<f32>(a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y), shifted * (1.0f / sqrt(shifted.x * shifted.x + shifted.y * shifted.y + shifted.z * shifted.z)), a.x * b.x + a.y * b.y + a.z * b.z - (a.x * a.x + a.y * a.y + a.z * a.z), sqrt(t.x * t.x + t.y * t.y + t.z * t.z), abs(select(t_2, t_1, t_2 < t_1)), x * a - b / params.lit_3_0 + a * b - 2.0f * b);
}

fn element(input: Tuple) -> Products {
    return vectors(input._0, input._1, input._2);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple>;
@group(0) @binding(3) var<storage, read_write> outputs: array<StoredProducts>;

fn load_input(i: u32) -> Tuple {
    let s = inputs[i];
    return Tuple(vec3<f32>(s.arg0_x, s.arg0_y, s.arg0_z), vec3<f32>(s.arg1_x, s.arg1_y, s.arg1_z), s.arg2);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let result = element(load_input(index));
    outputs[index] = StoredProducts(result.cross.x, result.cross.y, result.cross.z, result.unit.x, result.unit.y, result.unit.z, result.dot, result.length, result.least.x, result.least.y, result.least.z, result.scaled.x, result.scaled.y, result.scaled.z);
}
