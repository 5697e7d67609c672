struct Tuple {
    _0: f32,
    _1: u32,
}

struct StoredTuple {
    arg0: f32,
    arg1: u32,
}

struct Params {
    lit_0_75: f32,
    lit_1_0: f32,
    lit_0_125: f32,
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

fn return_in_loops(x: f32, n: u32) -> f32 {
    var a: f32 = x;
    var i: u32 = 0u;
    for (; i < n; i = i + 1u) {
        let i_1 = i;
        var j: u32 = 0u;
        while (j < i_1) {
            a = a * params.lit_0_75 + params.lit_1_0;
            if (a > 3.5f && j == 2u) {
                return a;
            }
            let j_1 = j;
            var k: u32 = 0u;
            for (; k < j_1; k = k + 1u) {
                if (a < -2.0f) {
                    return f32(k);
                }
                a = a + params.lit_0_125;
            }
            j = j + 1u;
        }
    }
    return a;
}

fn element(input: Tuple) -> f32 {
    return return_in_loops(input._0, input._1);
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
