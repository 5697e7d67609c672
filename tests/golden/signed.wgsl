struct Tuple {
    _0: i32,
    _1: i32,
}

struct StoredTuple {
    arg0: i32,
    arg1: i32,
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

fn signed(a: i32, b: i32) -> i32 {
    let d = select(b, 3i, (b == 0i || b == -1i));
    let q = a / d;
    let r = a % d;
    let n = select(a, -a, (a > -1000i && a < 1000i));
    let t = q + r * 31i - n;
    let t_1 = select(t, -2000000000i, (t < -2000000000i));
    let t_2 = b + n;
    return select(t_1, t_2, (t_2 < t_1));
}

fn element(input: Tuple) -> i32 {
    return signed(input._0, input._1);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple>;
@group(0) @binding(3) var<storage, read_write> outputs: array<i32>;

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
