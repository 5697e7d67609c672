struct Tuple {
    _0: u32,
    _1: f32,
}

struct Tuple_1 {
    _0: f32,
    _1: u32,
}

struct Tuple_2 {
    _0: Tuple_1,
    _1: f32,
}

struct StoredTuple_2 {
    arg0_0: f32,
    arg0_1: u32,
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

fn tuple_result(x: f32, n: u32) -> Tuple {
    if (x > 10.0f) {
        return Tuple(0u, x);
    }
    return Tuple(n, -x);
}

fn tuple_calls(parts_1: Tuple_1, scale: f32) -> f32 {
    let parts_2 = tuple_result(parts_1._0 * scale, parts_1._1);
    return parts_2._1 + f32(parts_2._0);
}

fn element(input: Tuple_2) -> f32 {
    return tuple_calls(input._0, input._1);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple_2>;
@group(0) @binding(3) var<storage, read_write> outputs: array<f32>;

fn load_input(i: u32) -> Tuple_2 {
    let s = inputs[i];
    return Tuple_2(Tuple_1(s.arg0_0, s.arg0_1), s.arg1);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let result = element(load_input(index));
    outputs[index] = result;
}
