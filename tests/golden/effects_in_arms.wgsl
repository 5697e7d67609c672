struct Couple {
    x: f32,
    y: f32,
}

struct Tuple {
    _0: f32,
    _1: Couple,
}

struct Tuple_1 {
    _0: f32,
    _1: u32,
}

struct StoredTuple_1 {
    arg0: f32,
    arg1: u32,
}

struct Params {
    lit_10_0: f32,
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

fn Couple_dot(self_: Couple) -> Tuple {
    var self_x: f32 = self_.x;
    let self_y = self_.y;
    self_x = self_x + params.lit_10_0;
    return Tuple(self_y, Couple(self_x, 0.0f));
}

fn clamp_(n: u32) -> u32 {
    var k: u32 = n;
    var steps: u32 = 0u;
    while (k != 1u) {
        var value: u32;
        if (k % 2u == 0u) {
            value = k / 2u;
        } else {
            value = k * 3u + 1u;
        }
        k = value;
        steps = steps + 1u;
    }
    return steps;
}

fn Couple_length(self_: Couple) -> f32 {
    return sqrt(self_.x * self_.x + self_.y * self_.y);
}

fn effects_in_arms(a: f32, n: u32) -> f32 {
    var s_x: f32 = a;
    let s_y = 1.0f;
    var r: f32;
    if (a > 2.0f) {
        let s_x_1 = s_x;
        let s_y_1 = s_y;
        let t = Couple_dot(Couple(s_x_1, s_y_1));
        s_x = t._1.x;
        r = t._0;
    } else {
        r = 0.0f;
    }
    var steps: u32;
    if (n % 50u > 0u) {
        steps = clamp_(n % 50u);
    } else {
        steps = 0u;
    }
    var sum: f32 = r + s_x + f32(steps) + Couple_length(Couple(s_x, s_y));
    if (a < 0.0f) {
        let s_x_2 = s_x;
        let s_y_2 = s_y;
        let t_1 = Couple_dot(Couple(s_x_2, s_y_2));
        s_x = t_1._1.x;
        sum = sum + t_1._0;
    }
    return sum + s_x;
}

fn element(input: Tuple_1) -> f32 {
    return effects_in_arms(input._0, input._1);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple_1>;
@group(0) @binding(3) var<storage, read_write> outputs: array<f32>;

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
    outputs[index] = result;
}
