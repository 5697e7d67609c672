struct Tuple {
    _0: f32,
    _1: u32,
}

struct StoredTuple {
    arg0: f32,
    arg1: u32,
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

fn changed_while_read(a: f32, n: u32) -> f32 {
    var leave: u32 = 0u;
    var list_0: f32 = a;
    var list_1: f32 = 1.0f;
    var list_2: f32 = 2.0f;
    var list_3: f32 = 3.0f;
    var sum: f32 = 0.0f;
    let list_0_1 = list_0;
    let list_1_1 = list_1;
    let list_2_1 = list_2;
    let list_3_1 = list_3;
    var i_1: u32 = 0u;
    for (; i_1 < 4u; i_1 = i_1 + 1u) {
        let v = select(select(select(list_0_1, list_1_1, (i_1 >= 1u)), list_2_1, (i_1 >= 2u)), list_3_1, (i_1 >= 3u));
        sum = sum + v;
        let t = n % 4u;
        list_0 = select(list_0, sum, (t == 0u));
        list_1 = select(list_1, sum, (t == 1u));
        list_2 = select(list_2, sum, (t == 2u));
        list_3 = select(list_3, sum, (t >= 3u));
    }
    let sum_1 = sum;
    var i_3: u32 = 0u;
    for (; i_3 < 2u; i_3 = i_3 + 1u) {
        let v_1 = select(a, sum_1, (i_3 >= 1u));
        let list_0_2 = list_0;
        let list_1_2 = list_1;
        let list_2_2 = list_2;
        let list_3_2 = list_3;
        var i_5: u32 = 0u;
        for (; i_5 < 4u; i_5 = i_5 + 1u) {
            let w = select(select(select(list_0_2, list_1_2, (i_5 >= 1u)), list_2_2, (i_5 >= 2u)), list_3_2, (i_5 >= 3u));
            if (w > v_1) {
                leave = 5u;
                break;
            }
            sum = sum + params.lit_1_0;
        }
        if (leave == 5u) {
            leave = 0u;
            continue;
        }
    }
    return sum;
}

fn element(input: Tuple) -> f32 {
    return changed_while_read(input._0, input._1);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple>;
@group(0) @binding(3) var<storage, read_write> outputs: array<f32>;

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
