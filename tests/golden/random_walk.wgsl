struct Pcg {
    state: u32,
}

struct Tuple {
    _0: u32,
    _1: Pcg,
}

struct Tuple_1 {
    _0: f32,
    _1: Pcg,
}

struct Tuple_2 {
    _1: f32,
}

struct Tuple_3 {
    _0: u32,
    _1: u32,
}

struct Walk {
    rng: Pcg,
    at: vec2<f32>,
    counts: array<u32, 2>,
}

struct Tuple_4 {
    _0: bool,
    _1: Walk,
}

struct Tuple_5 {
    _1: Pcg,
}

struct Tuple_6 {
    _0: Walk,
    _1: u32,
}

struct StoredTuple_6 {
    arg0_at: vec2<f32>,
    arg0_counts_0: u32,
    arg0_counts_1: u32,
    arg0_rng_state: u32,
    arg1: u32,
}

struct StoredWalk {
    at_x: f32,
    at_y: f32,
    counts_0: u32,
    counts_1: u32,
    rng_state: u32,
}

struct Params {
    lit_0_5: f32,
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

fn Pcg_bits(self_: Pcg) -> Tuple {
    var self_state: u32 = self_.state;
    let old = self_state;
    self_state = old * 747796405u + 2891336453u;
    let word = ((old >> (((old >> 28u) + 4u) & 31u)) ^ old) * 277803737u;
    return Tuple(((word >> 22u) ^ word), Pcg(self_state));
}

fn Pcg_unit(self_: Pcg) -> Tuple_1 {
    var self_state: u32 = self_.state;
    let self_state_1 = self_state;
    let t = Pcg_bits(Pcg(self_state_1));
    self_state = t._1.state;
    return Tuple_1(f32(t._0 >> 8u) / 16777216.0f, Pcg(self_state));
}

fn add(x: f32, y: f32) -> Tuple_2 {
    var x_1: f32 = x;
    x_1 = x_1 + y;
    return Tuple_2(x_1);
}

fn bump(n: u32) -> Tuple_3 {
    var n_1: u32 = n;
    if (n_1 > 5u) {
        n_1 = 0u;
        return Tuple_3(0u, n_1);
    }
    n_1 = n_1 + 1u;
    return Tuple_3(0u, n_1);
}

fn Walk_step(self_: Walk, length_: f32) -> Tuple_4 {
    var self_rng_state: u32 = self_.rng.state;
    var self_at: vec2<f32> = self_.at;
    var self_counts_0: u32 = self_.counts[0];
    var self_counts_1: u32 = self_.counts[1];
    var this_state: u32 = self_rng_state;
    let this_state_2 = this_state;
    let t = Pcg_unit(Pcg(this_state_2));
    this_state = t._1.state;
    self_rng_state = this_state;
    let x = t._0 - params.lit_0_5;
    self_at = vec2<f32>(self_at.x + x * length_, self_at.y);
    var self__1: f32 = self_at.y;
    var this_state_1: u32 = self_rng_state;
    let this_state_1_1 = this_state_1;
    let t_1 = Pcg_unit(Pcg(this_state_1_1));
    this_state_1 = t_1._1.state;
    self_rng_state = this_state_1;
    self__1 = add(self__1, t_1._0 - params.lit_0_5)._1;
    self_at = vec2<f32>(self_at.x, self__1);
    var self__2: u32 = self_counts_0;
    self__2 = bump(self__2)._1;
    self_counts_0 = self__2;
    if (x > 0.25f) {
        var self__3: u32 = self_counts_1;
        self__3 = bump(self__3)._1;
        self_counts_1 = self__3;
        return Tuple_4(true, Walk(Pcg(self_rng_state), self_at, array<u32, 2>(self_counts_0, self_counts_1)));
    }
    return Tuple_4(false, Walk(Pcg(self_rng_state), self_at, array<u32, 2>(self_counts_0, self_counts_1)));
}

fn Pcg_skip(self_: Pcg, n: u32) -> Tuple_5 {
    var self_state: u32 = self_.state;
    var i: u32 = 0u;
    for (; i < n; i = i + 1u) {
        self_state = Pcg_bits(Pcg(self_state))._1.state;
    }
    return Tuple_5(Pcg(self_state));
}

fn random_walk(walk: Walk, n: u32) -> Walk {
    var w_rng_state: u32 = walk.rng.state;
    var w_at: vec2<f32> = walk.at;
    var w_counts_0: u32 = walk.counts[0];
    var w_counts_1: u32 = walk.counts[1];
    var i: u32 = 0u;
    for (; i < n; i = i + 1u) {
        let w_rng_state_1 = w_rng_state;
        let w_at_1 = w_at;
        let w_counts_0_1 = w_counts_0;
        let w_counts_1_1 = w_counts_1;
        let t = Walk_step(Walk(Pcg(w_rng_state_1), w_at_1, array<u32, 2>(w_counts_0_1, w_counts_1_1)), 2.0f);
        w_rng_state = t._1.rng.state;
        w_at = t._1.at;
        w_counts_0 = t._1.counts[0];
        w_counts_1 = t._1.counts[1];
        if (t._0) {
            var w_state: u32 = w_rng_state;
            w_state = Pcg_skip(Pcg(w_state), 1u)._1.state;
            w_rng_state = w_state;
        }
    }
    var w_state_1: u32 = w_rng_state;
    let w_state_1_1 = w_state_1;
    let t_1 = Pcg_bits(Pcg(w_state_1_1));
    w_state_1 = t_1._1.state;
    w_rng_state = w_state_1;
    w_counts_1 = w_counts_1 + (t_1._0 & 3u);
    return Walk(Pcg(w_rng_state), w_at, array<u32, 2>(w_counts_0, w_counts_1));
}

fn element(input: Tuple_6) -> Walk {
    return random_walk(input._0, input._1);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple_6>;
@group(0) @binding(3) var<storage, read_write> outputs: array<StoredWalk>;

fn load_input(i: u32) -> Tuple_6 {
    let s = inputs[i];
    return Tuple_6(Walk(Pcg(s.arg0_rng_state), s.arg0_at, array<u32, 2>(s.arg0_counts_0, s.arg0_counts_1)), s.arg1);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let result = element(load_input(index));
    outputs[index] = StoredWalk(result.at.x, result.at.y, result.counts[0], result.counts[1], result.rng.state);
}
