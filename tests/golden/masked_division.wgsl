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

fn masked_division(a: u32, b: u32) -> u32 {
    var r: u32 = 0u;
    var both: bool;
    if (b != 0u) {
        both = a / b > 2u;
    } else {
        both = false;
    }
    if (both) {
        r = r + 1u;
    }
    var either: bool;
    if (b == 0u) {
        either = true;
    } else {
        either = a % b == 0u;
    }
    if (either) {
        r = r + 2u;
    }
    if (b > 5u) {
        r = r + 100u / b;
    }
    var both_1: bool;
    var either_1: bool;
    if (b == 0u) {
        either_1 = true;
    } else {
        either_1 = a / b < 7u;
    }
    if (!either_1) {
        both_1 = a % b != 1u;
    } else {
        both_1 = false;
    }
    if (both_1) {
        r = r + 1000u;
    }
    return r;
}

fn element(input: Tuple) -> u32 {
    return masked_division(input._0, input._1);
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
