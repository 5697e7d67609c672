struct Dual {
    x: f32,
    dx: f32,
}

struct Tuple {
    _1: Dual,
}

struct Pair {
    first: Dual,
    second: f32,
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

fn Dual_mul(self_: Dual, o: Dual) -> Dual {
    if (o.x == 0.0f) {
        return Dual(0.0f, self_.x * o.dx);
    }
    return Dual(self_.x * o.x, self_.x * o.dx);
}

fn own_types_Dual_mul(self_: Dual, k: f32) -> Dual {
    return Dual(self_.x * k, self_.dx * k);
}

fn Dual_neg(self_: Dual) -> Dual {
    return Dual(-self_.x, -self_.dx);
}

fn Dual_div(self_: Dual, k: f32) -> Dual {
    return Dual(self_.x / k, self_.dx / k);
}

fn Dual_sub(self_: Dual, o: Dual) -> Dual {
    return Dual(self_.x - o.x, self_.dx - o.dx);
}

fn f32_mul(self_: f32, o: Dual) -> Dual {
    return own_types_Dual_mul(o, self_);
}

fn Dual_add_assign(self_: Dual, o: Dual) -> Tuple {
    var self_x: f32 = self_.x;
    var self_dx: f32 = self_.dx;
    self_x = self_x + o.x;
    self_dx = o.x;
    return Tuple(Dual(self_x, self_dx));
}

fn Dual_mul_assign(self_: Dual, k: f32) -> Tuple {
    var self_x: f32 = self_.x;
    var self_dx: f32 = self_.dx;
    let self_x_1 = self_x;
    let t = own_types_Dual_mul(Dual(self_x_1, self_dx), k);
    self_x = t.x;
    self_dx = t.dx;
    return Tuple(Dual(self_x, self_dx));
}

fn Pair_add(self_: Pair, o: Pair) -> Pair {
    return Pair(self_.first, self_.second + o.second);
}

fn Dual_add(self_: Dual, o: Dual) -> Dual {
    return Dual(self_.x + o.x, 0.0f);
}

fn own_types_Dual_mul_1(self_: Dual, k: u32) -> f32 {
    return self_.x * f32(k);
}

fn own_operators(a: f32, b: f32) -> f32 {
    let t = Dual_sub(own_types_Dual_mul(Dual_mul(Dual(a, 0.0f), Dual(a, 1.0f)), 2.0f), Dual_div(Dual_neg(Dual(a, 1.0f)), 4.0f));
    let t_1 = f32_mul(0.5f, t);
    var sum_x: f32 = t_1.x;
    var sum_dx: f32 = t_1.dx;
    var list_0_x: f32 = a;
    var list_0_dx: f32 = 1.0f;
    var list_1_x: f32 = t.x;
    var list_1_dx: f32 = t.dx;
    if (a > b) {
        var self_x: f32 = sum_x;
        var self_dx: f32 = sum_dx;
        let self_x_4 = self_x;
        let t_2 = Dual_add_assign(Dual(self_x_4, self_dx), t);
        self_x = t_2._1.x;
        self_dx = t_2._1.dx;
        sum_x = self_x;
        sum_dx = self_dx;
        var self_x_1: f32 = list_1_x;
        var self_dx_1: f32 = list_1_dx;
        let self_x_1_1 = self_x_1;
        let t_3 = Dual_add_assign(Dual(self_x_1_1, self_dx_1), Dual(a, 0.0f));
        self_x_1 = t_3._1.x;
        self_dx_1 = t_3._1.dx;
        list_1_x = self_x_1;
        list_1_dx = self_dx_1;
    }
    var self_x_2: f32 = sum_x;
    var self_dx_2: f32 = sum_dx;
    let self_x_2_1 = self_x_2;
    let t_4 = Dual_mul_assign(Dual(self_x_2_1, self_dx_2), b);
    self_x_2 = t_4._1.x;
    self_dx_2 = t_4._1.dx;
    sum_x = self_x_2;
    sum_dx = self_dx_2;
    let t_5 = u32(b > 0.0f);
    let t_6 = t_5 >= 1u;
    var self_x_3: f32 = select(list_0_x, list_1_x, t_6);
    var self_dx_3: f32 = select(list_0_dx, list_1_dx, t_6);
    let self_x_3_1 = self_x_3;
    let t_7 = Dual_mul_assign(Dual(self_x_3_1, self_dx_3), 2.0f);
    self_x_3 = t_7._1.x;
    self_dx_3 = t_7._1.dx;
    let t_8 = t_5 == 0u;
    let t_9 = t_5 >= 1u;
    list_0_x = select(list_0_x, self_x_3, t_8);
    list_0_dx = select(list_0_dx, self_dx_3, t_8);
    list_1_x = select(list_1_x, self_x_3, t_9);
    list_1_dx = select(list_1_dx, self_dx_3, t_9);
    let pair = Pair_add(Pair(Dual(0.0f, 1.0f), a), Pair(Dual(0.0f, 0.0f), b));
    var chosen_x: f32;
    if (a < b) {
        chosen_x = Dual_add(Dual(sum_x, 0.0f), t).x;
    } else {
        chosen_x = Dual_sub(t, Dual(a, 1.0f)).x;
    }
    return sum_x + sum_dx + list_1_dx + list_0_x + pair.first.dx + pair.second + chosen_x + own_types_Dual_mul_1(t, 2u);
}

fn element(input: Tuple_1) -> f32 {
    return own_operators(input._0, input._1);
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
