struct Tuple {
    _0: f32,
    _1: u32,
    _2: i32,
}

struct StoredTuple {
    arg0: f32,
    arg1: u32,
    arg2: i32,
}

struct Params {
    lit_3_0: f32,
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

fn array_elements(x: f32, n: u32, i: i32) -> f32 {
    var counts_0: u32 = 0u;
    var counts_1: u32 = 0u;
    var counts_2: u32 = 0u;
    var k: u32 = 0u;
    for (; k < n; k = k + 1u) {
        let t = k % 3u;
        let counts_0_1 = counts_0;
        let counts_1_1 = counts_1;
        let t_1 = select(select(counts_0_1, counts_1_1, (t >= 1u)), counts_2, (t >= 2u)) + k;
        counts_0 = select(counts_0_1, t_1, (t == 0u));
        counts_1 = select(counts_1_1, t_1, (t == 1u));
        counts_2 = select(counts_2, t_1, (t >= 2u));
    }
    counts_1 = counts_0 + 1u;
    var table_0_0: f32 = x;
    var table_0_1: f32 = x;
    var table_1_0: f32 = 1.0f;
    var table_1_1: f32 = 2.0f;
    let t_2 = n & 1u;
    let t_3 = bitcast<u32>(i & 1i);
    let table_0_0_1 = table_0_0;
    let table_0_1_1 = table_0_1;
    let table_1_0_1 = table_1_0;
    let t_4 = t_2 >= 1u;
    let t_5 = select(table_0_0_1, table_1_0_1, t_4);
    let t_6 = select(table_0_1_1, table_1_1, t_4);
    let t_7 = select(t_5, t_6, (t_3 >= 1u)) * params.lit_3_0;
    let t_8 = select(t_5, t_7, (t_3 == 0u));
    let t_9 = select(t_6, t_7, (t_3 >= 1u));
    let t_10 = t_2 == 0u;
    let t_11 = t_2 >= 1u;
    table_0_0 = select(table_0_0_1, t_8, t_10);
    table_0_1 = select(table_0_1_1, t_9, t_10);
    table_1_0 = select(table_1_0_1, t_8, t_11);
    table_1_1 = select(table_1_1, t_9, t_11);
    let t_12 = n % 4u;
    let t_13 = bitcast<u32>(i & 1i);
    return select(select(select(0.25f, x, (t_12 >= 1u)), 1.5f, (t_12 >= 2u)), -2.0f, (t_12 >= 3u)) + f32(select(select(counts_0, counts_1, (t_13 >= 1u)), counts_2, (t_13 >= 2u))) + table_1_0 - table_0_1 + f32(n);
}

fn element(input: Tuple) -> f32 {
    return array_elements(input._0, input._1, input._2);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple>;
@group(0) @binding(3) var<storage, read_write> outputs: array<f32>;

fn load_input(i: u32) -> Tuple {
    let s = inputs[i];
    return Tuple(s.arg0, s.arg1, s.arg2);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let result = element(load_input(index));
    outputs[index] = result;
}
