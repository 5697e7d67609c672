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
    _1: f32,
}

struct StoredTuple_1 {
    arg0: f32,
    arg1: f32,
}

struct Params {
    lit_1_0: f32,
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

fn Couple_step(self_: Couple) -> Tuple {
    var self_x: f32 = self_.x;
    let self_y = self_.y;
    self_x = self_x + params.lit_1_0;
    return Tuple(self_x, Couple(self_x, self_y));
}

fn add_to(x: f32, to: f32) -> Tuple_1 {
    var to_1: f32 = to;
    to_1 = to_1 + x;
    return Tuple_1(select(select(to_1, x, to_1 < x), x, (to_1 != to_1)), to_1);
}

fn arguments_in_order(a: f32, b: f32) -> f32 {
    var s_x: f32 = a;
    let s_y = b;
    let s_x_1 = s_x;
    let s_y_1 = s_y;
    let t_1 = Couple_step(Couple(s_x_1, s_y_1));
    s_x = t_1._1.x;
    var s: f32 = s_x;
    let s_1 = s;
    let t_2 = add_to(t_1._0, s_1);
    s = t_2._1;
    s_x = s;
    var t_x: f32 = b;
    var t_y: f32 = a;
    let t_x_1 = t_x;
    let t_y_1 = t_y;
    let t_3 = Couple_step(Couple(t_x_1, t_y_1));
    t_x = t_3._1.x;
    t_y = t_3._1.y;
    let s_x_2 = s_x;
    let s_y_2 = s_y;
    let t_4 = Couple_step(Couple(s_x_2, s_y_2));
    s_x = t_4._1.x;
    var t: f32 = t_y;
    let t_5 = t;
    let t_6 = add_to(t_3._0 + t_4._0, t_5);
    t = t_6._1;
    t_y = t;
    return t_2._0 + t_6._0 + s_x * params.lit_3_0 + t_y;
}

fn element(input: Tuple_1) -> f32 {
    return arguments_in_order(input._0, input._1);
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
