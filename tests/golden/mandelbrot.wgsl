struct Tuple {
    _0: f32,
    _1: f32,
}

struct StoredTuple {
    arg0: f32,
    arg1: f32,
}

struct Params {
    lit_0_03: f32,
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

fn mandelbrot(x: f32, y: f32) -> u32 {
    let cx = x * params.lit_0_03;
    let cy = y * params.lit_0_03;
    var zx: f32 = 0.0f;
    var zy: f32 = 0.0f;
    var i: u32 = 0u;
    for (; i < 50u; i = i + 1u) {
        let xx = zx * zx;
        let zy_1 = zy;
        let zy_2 = zy;
        let yy = zy_1 * zy_2;
        if (xx + yy > 4.0f) {
            return i;
        }
        zy = 2.0f * zx * zy + cy;
        zx = xx - yy + cx;
    }
    return 50u;
}

fn element(input: Tuple) -> u32 {
    return mandelbrot(input._0, input._1);
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
