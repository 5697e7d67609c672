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

fn for_with_continue(n: u32, m: u32) -> u32 {
    var sum: u32 = 0u;
    var i: u32 = 0u;
    for (; i < n; i = i + 1u) {
        if (i % 3u == 0u) {
            continue;
        }
        sum = sum + i;
        if ((i & 1u) != 0u) {
            continue;
        }
        sum = sum * m;
    }
    return sum;
}

fn element(input: Tuple) -> u32 {
    return for_with_continue(input._0, input._1);
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
