struct Tuple {
    _0: f32,
}

struct StoredTuple {
    arg0: f32,
}

struct Params {
    lit_1_0: f32,
    lit_1_5: f32,
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

fn store_before_if(x: f32) -> f32 {
    var count: f32 = 0.0f;
    var y: f32 = x;
    while (y < 20.0f) {
        count = count + params.lit_1_0;
        y = y + params.lit_1_5;
        if (y > 10.0f) {
            y = y * params.lit_1_5;
        }
        if (count > 30.0f) {
            break;
        }
    }
    return count + y;
}

fn element(input: Tuple) -> f32 {
    return store_before_if(input._0);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple>;
@group(0) @binding(3) var<storage, read_write> outputs: array<f32>;

fn load_input(i: u32) -> Tuple {
    let s = inputs[i];
    return Tuple(s.arg0);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let result = element(load_input(index));
    outputs[index] = result;
}
