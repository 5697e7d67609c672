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

fn for_over_signed(low: i32, high: i32) -> i32 {
    var sum: i32 = 0i;
    var i: i32 = low;
    for (; i < high; i = i + 1i) {
        if (i < -10i) {
            continue;
        }
        sum = sum * 3i % 1000i + i;
    }
    var i_1: i32 = -2i;
    for (; i_1 < 3i; i_1 = i_1 + 1i) {
        sum = sum + 1i;
    }
    return sum;
}

fn element(input: Tuple) -> i32 {
    return for_over_signed(input._0, input._1);
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
