struct Tuple {
    _0: u32,
    _1: f32,
}

struct Tuple_1 {
    _0: f32,
    _1: u32,
}

struct StoredTuple_1 {
    arg0: f32,
    arg1: u32,
}

struct StoredTuple {
    arg0: u32,
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

fn element(input: Tuple_1) -> Tuple {
    return tuple_result(input._0, input._1);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple_1>;
@group(0) @binding(3) var<storage, read_write> outputs: array<StoredTuple>;

fn load_input(i: u32) -> Tuple_1 {
    let s = inputs[i];
    return Tuple_1(s.arg0, s.arg1);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let result = element(load_input(index));
    outputs[index] = StoredTuple(result._0, result._1);
}
