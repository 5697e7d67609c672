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

fn Dual_part(self_: Dual, k: f32) -> f32 {
    return self_.dx - k;
}

fn last_part(all_: array<Dual, 3>, n: u32) -> f32 {
    var sum: f32 = Dual_part(all_[1], 0.5f);
    var i_1: u32 = 0u;
    for (; i_1 < 3u; i_1 = i_1 + 1u) {
        sum = sum + Dual_part(Dual(0.0f, select(select(all_[0].dx, all_[1].dx, (i_1 >= 1u)), all_[2].dx, (i_1 >= 2u))), 2.0f);
    }
    let t = n % 3u;
    return sum + Dual_part(Dual(0.0f, select(select(all_[0].dx, all_[1].dx, (t >= 1u)), all_[2].dx, (t >= 2u))), 1.0f);
}

fn generic_elements(a: f32, n: u32) -> f32 {
    return last_part(array<Dual, 3>(Dual(0.0f, a * 0.5f), Dual(0.0f, 2.0f), Dual(0.0f, 4.0f)), n);
}

fn element(input: Tuple) -> f32 {
    return generic_elements(input._0, input._1);
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
