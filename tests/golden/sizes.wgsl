struct Tuple {
    _0: u32,
    _1: f32,
    _2: i32,
}

struct Tuple_1 {
    _0: u32,
    _1: i32,
}

struct StoredTuple_1 {
    arg0: u32,
    arg1: i32,
}

struct StoredTuple {
    arg0: u32,
    arg1: f32,
    arg2: i32,
}

struct Params {
    lit_4_0: f32,
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

fn sizes(n: u32, k: i32) -> Tuple {
    var i: u32 = n % 4u;
    var sum: f32 = select(select(select(3.0f, 1.0f, (i >= 1u)), 4.0f, (i >= 2u)), 1.5f, (i >= 3u)) + params.lit_4_0;
    var j: u32 = 0u;
    for (; j < 4u; j = j + 1u) {
        if (j == 2u) {
            continue;
        }
        let t = i + j;
        i = select(t, 3u, (3u < t));
        sum = sum + select(select(select(3.0f, 1.0f, (i >= 1u)), 4.0f, (i >= 2u)), 1.5f, (i >= 3u)) * f32(j);
    }
    let last = 2u + i;
    return Tuple(last, sum, bitcast<i32>(bitcast<u32>(k & 3i)) + bitcast<i32>(i));
}

fn element(input: Tuple_1) -> Tuple {
    return sizes(input._0, input._1);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple_1>;
@group(0) @binding(3) var<storage, read_write> outputs: array<StoredTuple>;

fn load_input(i: u32) -> Tuple_1 {
    let s = inputs[i];
    return Tuple_1(s.arg0, s.arg1);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let result = element(load_input(index));
    outputs[index] = StoredTuple(result._0, result._1, result._2);
}
