struct Tuple {
    _0: u32,
    _1: u32,
}

struct StoredTuple {
    arg0: u32,
    arg1: u32,
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

fn integers(a: u32, b: u32) -> u32 {
    let sum = a + b - 17u;
    let product = sum * 2654435761u;
    let d = select(b, 1u, (b == 0u));
    let q = product / d;
    let r = product % d;
    let t = r * 3u;
    let t_1 = select(q, t, (t < q));
    return select(t_1, 5u, (t_1 < 5u)) + (a / 7u + b % 10u);
}

fn element(input: Tuple) -> u32 {
    return integers(input._0, input._1);
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
