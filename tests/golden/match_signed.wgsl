struct Tuple {
    _0: i32,
    _1: f32,
}

struct StoredTuple {
    arg0: i32,
    arg1: f32,
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

fn match_signed(i: i32, x: f32) -> i32 {
    var sum: i32 = 1i;
    if (i >= (-2147483647i - 1i) && i <= -10i) {
        sum = 5i;
    } else if (i == -9i || i == -7i) {
        sum = sum + 2i;
        if (x > 0.0f) {
            return sum;
        }
    } else if (i == -1i) {
        sum = sum - 1i;
    } else if (i >= 0i && i < 4i) {
    } else {
        return 7i;
    }
    return sum * 2i;
}

fn element(input: Tuple) -> i32 {
    return match_signed(input._0, input._1);
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
