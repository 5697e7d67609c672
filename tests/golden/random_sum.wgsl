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
    _1: Pcg,
}

struct Tuple_3 {
    _0: u32,
    _1: u32,
}

struct StoredTuple_3 {
    arg0: u32,
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

fn Pcg_seeded(seed: u32) -> Pcg {
    return Pcg(seed * 747796405u + 1u);
}

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

fn Pcg_skip(self_: Pcg, n: u32) -> Tuple_2 {
    var self_state: u32 = self_.state;
    var i: u32 = 0u;
    for (; i < n; i = i + 1u) {
        self_state = Pcg_bits(Pcg(self_state))._1.state;
    }
    return Tuple_2(Pcg(self_state));
}

fn random_sum(seed: u32, n: u32) -> f32 {
    var rng_state: u32 = Pcg_seeded(seed).state;
    var sum: f32 = 0.0f;
    var i: u32 = 0u;
    for (; i < n; i = i + 1u) {
        if (i % 3u == 1u) {
            continue;
        }
        var both: bool;
        if (sum > 3.0f) {
            let rng_state_1 = rng_state;
            let t = Pcg_unit(Pcg(rng_state_1));
            rng_state = t._1.state;
            both = t._0 < 0.5f;
        } else {
            both = false;
        }
        if (both) {
            rng_state = Pcg_skip(Pcg(rng_state), i)._1.state;
            break;
        }
        let rng_state_2 = rng_state;
        let t_1 = Pcg_unit(Pcg(rng_state_2));
        rng_state = t_1._1.state;
        sum = sum + t_1._0;
    }
    let rng_state_3 = rng_state;
    let t_2 = Pcg_unit(Pcg(rng_state_3));
    rng_state = t_2._1.state;
    return sum + t_2._0;
}

fn element(input: Tuple_3) -> f32 {
    return random_sum(input._0, input._1);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple_3>;
@group(0) @binding(3) var<storage, read_write> outputs: array<f32>;

fn load_input(i: u32) -> Tuple_3 {
    let s = inputs[i];
    return Tuple_3(s.arg0, s.arg1);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let result = element(load_input(index));
    outputs[index] = result;
}
