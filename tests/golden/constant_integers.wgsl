struct Tuple {
    _0: u32,
    _1: i32,
}

struct StoredTuple {
    arg0: u32,
    arg1: i32,
}

struct Params {
    infinity: f32,
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

fn constant_integers(n: u32, i: i32) -> u32 {
    let e = params.infinity > f32(n);
    return (((n | 4294967288u) ^ 1610612736u) ^ bitcast<u32>((i & (-2147483647i - 1i)) & 1073741824i)) ^ u32(e);
}

fn element(input: Tuple) -> u32 {
    return constant_integers(input._0, input._1);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple>;
@group(0) @binding(3) var<storage, read_write> outputs: array<u32>;

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
