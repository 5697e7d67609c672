struct Tuple {
    _0: f32,
}

struct StoredTuple {
    arg0: f32,
}

struct Params {
    lit_0_625: f32,
    lit_3_5: f32,
    lit_1_0: f32,
    lit_0_0: f32,
    lit_3_1415927: f32,
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

fn constants(x: f32) -> f32 {
    let v = vec3<f32>(x, params.lit_0_625, params.lit_3_5) + vec3<f32>(params.lit_1_0, params.lit_0_0, params.lit_0_0);
    var result: f32;
    if (x > 3.5f) {
        result = v.x * params.lit_0_625;
    } else {
        result = select(x, 340282346638528859811704183484516925440.0f, 340282346638528859811704183484516925440.0f < x) + v.z * params.lit_3_1415927;
    }
    return result;
}

fn element(input: Tuple) -> f32 {
    return constants(input._0);
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
