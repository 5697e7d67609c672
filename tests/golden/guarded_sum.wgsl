struct Tuple {
    _0: u32,
    _1: i32,
}

struct StoredTuple {
    arg0: u32,
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

fn guarded_sum(a: u32, b: i32) -> u32 {
    var r: u32 = 0u;
    if (a > 0u && a - 1u < 10u) {
        r = r + 1u;
    }
    if (a == 4294967295u || a + 1u > 100u) {
        r = r + 2u;
    }
    if (b < 1000i && b > -1000i && b * b > 100i) {
        r = r + 4u;
    }
    if (a < 32u && (1u << (a & 31u)) > 50u) {
        r = r + 8u;
    }
    return r;
}

fn element(input: Tuple) -> u32 {
    return guarded_sum(input._0, input._1);
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
