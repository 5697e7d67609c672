struct Tuple {
    _1: f32,
    _2: f32,
}

struct Tuple_1 {
    _0: u32,
    _1: u32,
}

struct Tuple_2 {
    _1: f32,
}

struct Tuple_3 {
    _0: f32,
    _1: f32,
    _2: u32,
}

struct StoredTuple_3 {
    arg0: f32,
    arg1: f32,
    arg2: u32,
}

struct Params {
    lit_1_0: f32,
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

fn exchange(a: f32, b: f32) -> Tuple {
    var a_1: f32 = a;
    var b_1: f32 = b;
    let old = a_1;
    a_1 = b_1;
    b_1 = old;
    return Tuple(a_1, b_1);
}

fn bump(n: u32) -> Tuple_1 {
    var n_1: u32 = n;
    if (n_1 > 5u) {
        n_1 = 0u;
        return Tuple_1(100u, n_1);
    }
    n_1 = n_1 + 1u;
    return Tuple_1(n_1, n_1);
}

fn bump_twice(n: u32, limit: u32) -> Tuple_1 {
    var n_1: u32 = n;
    let n_1_1 = n_1;
    let t = bump(n_1_1);
    n_1 = t._1;
    var sum: u32 = t._0;
    if (sum < limit) {
        let n_1_2 = n_1;
        let t_1 = bump(n_1_2);
        n_1 = t_1._1;
        sum = sum + t_1._0;
    }
    return Tuple_1(sum + n_1, n_1);
}

fn add(x: f32, y: f32) -> Tuple_2 {
    var x_1: f32 = x;
    x_1 = x_1 + y;
    return Tuple_2(x_1);
}

fn settle(x: f32, limit: f32) -> Tuple_2 {
    var x_1: f32 = x;
    var i: u32 = 0u;
    for (; i < 4u; i = i + 1u) {
        if (x_1 < limit) {
            return Tuple_2(x_1);
        }
        x_1 = x_1 * 0.5f;
        if (i == 2u) {
            let x_2 = limit * 2.0f;
            if (x_2 > 3.0f) {
                return Tuple_2(x_1);
            }
        }
    }
    x_1 = x_1 - params.lit_1_0;
    return Tuple_2(x_1);
}

fn changed_arguments(x: f32, y: f32, n: u32) -> f32 {
    var pair_0: f32 = x;
    var pair_1: f32 = y;
    var a: f32 = x * 2.0f;
    var count: u32 = n;
    if (x < y) {
        var pair: f32 = pair_0;
        let pair_4 = pair;
        let t = exchange(pair_4, a);
        pair = t._1;
        a = t._2;
        pair_0 = pair;
    }
    let count_1 = count;
    let t_1 = bump_twice(count_1, 7u);
    count = t_1._1;
    var pair_2: f32 = pair_1;
    pair_2 = add(pair_2, f32(t_1._0))._1;
    pair_1 = pair_2;
    a = settle(a, y)._1;
    var pair_3: f32 = pair_0;
    pair_3 = settle(pair_3, 1.5f)._1;
    pair_0 = pair_3;
    return pair_0 - pair_1 * a + f32(count);
}

fn element(input: Tuple_3) -> f32 {
    return changed_arguments(input._0, input._1, input._2);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple_3>;
@group(0) @binding(3) var<storage, read_write> outputs: array<f32>;

fn load_input(i: u32) -> Tuple_3 {
    let s = inputs[i];
    return Tuple_3(s.arg0, s.arg1, s.arg2);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let result = element(load_input(index));
    outputs[index] = result;
}
