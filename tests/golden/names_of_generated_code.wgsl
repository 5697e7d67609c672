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

fn names_of_generated_code(a: f32, b: f32) -> f32 {
    var result_x: f32 = a;
    var result_y: f32 = b;
    let result_x_1 = result_x;
    let result_y_1 = result_y;
    let t = Couple_step(Couple(result_x_1, result_y_1));
    result_x = t._1.x;
    result_y = t._1.y;
    var part_0: f32 = t._0;
    var part_1: f32 = b;
    var part: f32 = part_1;
    let part_2 = part;
    let t_1 = add_to(1.0f, part_2);
    part = t_1._1;
    part_1 = part;
    var result: f32 = result_y;
    let result_1 = result;
    let t_2 = add_to(t_1._0, result_1);
    result = t_2._1;
    result_y = result;
    let right = params.lit_2_0 + t_2._0;
    part_0 = part_0 + right;
    return result_x + part_0 + part_1;
}

fn element(input: Tuple_1) -> f32 {
    return names_of_generated_code(input._0, input._1);
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
