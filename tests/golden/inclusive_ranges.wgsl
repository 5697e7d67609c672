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

fn inclusive_ranges(n: u32, i: i32) -> i32 {
    var sum: i32 = 0i;
    var k: u32 = 1u;
    var done: bool = false;
    loop {
        if (!(!done && k <= n)) { break; }
        if (k == 7u) {
            continue;
        }
        sum = sum + bitcast<i32>(k);
        continuing {
            done = k == n;
            k = k + 1u;
        }
    }
    var k_1: i32 = i;
    var done_1: bool = false;
    loop {
        if (!(!done_1 && k_1 <= 3i)) { break; }
        sum = sum - k_1;
        if (sum < -60i) {
            break;
        }
        continuing {
            done_1 = k_1 == 3i;
            k_1 = k_1 + 1i;
        }
    }
    var k_2: u32 = 4294967293u;
    var done_2: bool = false;
    loop {
        if (!(!done_2 && k_2 <= 4294967295u)) { break; }
        sum = sum ^ bitcast<i32>(k_2 & 7u);
        continuing {
            done_2 = k_2 == 4294967295u;
            k_2 = k_2 + 1u;
        }
    }
    return sum;
}

fn element(input: Tuple) -> i32 {
    return inclusive_ranges(input._0, input._1);
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
