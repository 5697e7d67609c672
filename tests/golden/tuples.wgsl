struct Tuple {
    _0: f32,
    _1: u32,
}

struct StoredTuple {
    arg0: f32,
    arg1: u32,
}

struct Params {
    lit_1_0: f32,
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

fn tuples(x: f32, n: u32) -> f32 {
    let a = x * 2.0f;
    let b = n + 1u;
    let d = f32(b);
    var c: f32 = a - params.lit_1_0;
    var pair_0: f32;
    var pair_1: u32;
    if (x > 0.0f) {
        pair_0 = c;
        pair_1 = 1u;
    } else {
        pair_0 = d;
        pair_1 = 2u;
    }
    var swapped_0: u32 = pair_1;
    let swapped_1 = pair_0;
    swapped_0 = swapped_0 + b;
    c = c + swapped_1;
    return c * a + f32(swapped_0);
}

fn element(input: Tuple) -> f32 {
    return tuples(input._0, input._1);
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
