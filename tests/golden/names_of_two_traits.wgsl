struct Dual {
    x: f32,
    dx: f32,
}

struct Tuple {
    _0: f32,
    _1: u32,
}

struct StoredTuple {
    arg0: f32,
    arg1: u32,
}

struct Params {
    lit_2_0: f32,
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

fn Dual_part(self_: Dual, k: f32) -> f32 {
    return self_.x + k;
}

fn own_types_Dual_part(self_: Dual, k: f32) -> f32 {
    return self_.dx - k;
}

fn own_far(f: Dual, k: f32) -> f32 {
    return own_types_Dual_part(f, k);
}

fn Dual_blend(self_: Dual, with_: f32) -> f32 {
    return self_.x - with_;
}

fn own_types_Dual_blend(self_: Dual, with_: u32) -> f32 {
    return self_.dx + f32(with_);
}

fn names_of_two_traits(a: f32, n: u32) -> f32 {
    let t = a - params.lit_2_0;
    let parts = Dual_part(Dual(a, 0.0f), 2.0f) + own_types_Dual_part(Dual(0.0f, t), 1.0f);
    return parts + own_far(Dual(0.0f, t), a) + Dual_blend(Dual(a, 0.0f), a * 0.5f) + own_types_Dual_blend(Dual(0.0f, t), n % 8u);
}

fn element(input: Tuple) -> f32 {
    return names_of_two_traits(input._0, input._1);
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
