struct Tuple {
    _0: u32,
    _1: i32,
    _2: f32,
}

struct StoredTuple {
    arg0: u32,
    arg1: i32,
    arg2: f32,
}

struct Params {
    lit_7_0: f32,
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

fn compound(a: u32, b: i32, x: f32) -> f32 {
    var n: u32 = a;
    n = n + 7u;
    n = n * 3u;
    n = n - 2u;
    n = n / 4u;
    n = n % 11u;
    n = n | 80u;
    n = n & 126u;
    n = n ^ 15u;
    n = n << 3u;
    n = n >> 1u;
    var i: i32 = b;
    i = i * -2i;
    i = i - 5i;
    var y: f32 = x;
    y = y / params.lit_7_0;
    y = y * y;
    y = y - f32(n);
    return y + f32(i);
}

fn element(input: Tuple) -> f32 {
    return compound(input._0, input._1, input._2);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple>;
@group(0) @binding(3) var<storage, read_write> outputs: array<f32>;

fn load_input(i: u32) -> Tuple {
    let s = inputs[i];
    return Tuple(s.arg0, s.arg1, s.arg2);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let result = element(load_input(index));
    outputs[index] = result;
}
