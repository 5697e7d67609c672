struct Tuple {
    _0: u32,
    _1: u32,
    _2: bool,
}

struct StoredTuple {
    arg0: u32,
    arg1: u32,
    arg2: u32,
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

fn match_tuples(a: u32, b: u32, c: bool) -> u32 {
    var found: u32;
    let value_1 = a % 3u;
    let value_2 = b % 3u;
    if (value_1 == 0u && value_2 == 0u) {
        found = 10u;
    } else {
        var both: bool;
        if (value_1 == 0u) {
            both = value_2 > 1u;
        } else {
            both = false;
        }
        if (both) {
            found = 11u;
        } else {
            var both_1: bool;
            if (value_1 == 1u) {
                both_1 = c;
            } else {
                both_1 = false;
            }
            if (both_1) {
                found = 20u + value_2;
            } else if (value_2 == 2u) {
                found = 30u + value_1;
            } else {
                found = 40u;
            }
        }
    }
    return select(found + 100u, found, c);
}

fn element(input: Tuple) -> u32 {
    return match_tuples(input._0, input._1, input._2);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple>;
@group(0) @binding(3) var<storage, read_write> outputs: array<u32>;

fn load_input(i: u32) -> Tuple {
    let s = inputs[i];
    return Tuple(s.arg0, s.arg1, (s.arg2 & 0xffu) != 0u);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let result = element(load_input(index));
    outputs[index] = result;
}
