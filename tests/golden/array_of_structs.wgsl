struct Particle {
    position: vec3<f32>,
    mass: f32,
    alive: bool,
    hits: u32,
}

struct Tuple {
    _0: Particle,
    _1: u32,
}

struct StoredTuple {
    arg0_position_x: f32,
    arg0_position_y: f32,
    arg0_position_z: f32,
    arg0_mass: f32,
    arg0_hits: u32,
    arg0_alive: u32,
    arg1: u32,
}

struct Params {
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

fn Particle_moved(self_: Particle, by: vec3<f32>) -> Particle {
    return Particle(self_.position + by, self_.mass, self_.alive, self_.hits);
}

fn array_of_structs(p: Particle, n: u32) -> f32 {
    let t = Particle_moved(p, vec3<f32>(1.0f, 2.0f, 3.0f));
    var all_0_position: vec3<f32> = p.position;
    var all_0_mass: f32 = p.mass;
    var all_0_alive: bool = p.alive;
    var all_0_hits: u32 = p.hits;
    var all_1_position: vec3<f32> = t.position;
    var all_1_mass: f32 = t.mass;
    var all_1_alive: bool = t.alive;
    var all_1_hits: u32 = t.hits;
    let i = n & 1u;
    let all_0_position_1 = all_0_position;
    let all_0_mass_1 = all_0_mass;
    let all_0_alive_1 = all_0_alive;
    let all_0_hits_1 = all_0_hits;
    let t_1 = i >= 1u;
    let t_2 = select(all_0_position_1.x, all_1_position.x, t_1);
    let t_3 = select(all_0_position_1.y, all_1_position.y, t_1);
    let t_4 = select(all_0_position_1.z, all_1_position.z, t_1);
    let t_5 = select(all_0_alive_1, all_1_alive, t_1);
    let t_6 = select(all_0_hits_1, all_1_hits, t_1);
    let t_7 = select(all_0_mass_1, all_1_mass, t_1) + params.lit_1_5;
    let t_8 = i == 0u;
    let t_9 = i >= 1u;
    all_0_position = vec3<f32>(select(all_0_position_1.x, t_2, t_8), select(all_0_position_1.y, t_3, t_8), select(all_0_position_1.z, t_4, t_8));
    all_0_mass = select(all_0_mass_1, t_7, t_8);
    all_0_alive = select(all_0_alive_1, t_5, t_8);
    all_0_hits = select(all_0_hits_1, t_6, t_8);
    all_1_position = vec3<f32>(select(all_1_position.x, t_2, t_9), select(all_1_position.y, t_3, t_9), select(all_1_position.z, t_4, t_9));
    all_1_mass = select(all_1_mass, t_7, t_9);
    all_1_alive = select(all_1_alive, t_5, t_9);
    all_1_hits = select(all_1_hits, t_6, t_9);
    let all_0_position_2 = all_0_position;
    let all_0_mass_2 = all_0_mass;
    let all_0_alive_2 = all_0_alive;
    let all_0_hits_2 = all_0_hits;
    let t_10 = i >= 1u;
    let t_11 = select(all_0_position_2.x, all_1_position.x, t_10);
    let t_12 = select(all_0_position_2.z, all_1_position.z, t_10);
    let t_13 = select(all_0_mass_2, all_1_mass, t_10);
    let t_14 = select(all_0_alive_2, all_1_alive, t_10);
    let t_15 = select(all_0_hits_2, all_1_hits, t_10);
    let t_16 = i == 0u;
    let t_17 = i >= 1u;
    all_0_position = vec3<f32>(select(all_0_position_2.x, t_11, t_16), select(all_0_position_2.y, 4.0f, t_16), select(all_0_position_2.z, t_12, t_16));
    all_0_mass = select(all_0_mass_2, t_13, t_16);
    all_0_alive = select(all_0_alive_2, t_14, t_16);
    all_0_hits = select(all_0_hits_2, t_15, t_16);
    all_1_position = vec3<f32>(select(all_1_position.x, t_11, t_17), select(all_1_position.y, 4.0f, t_17), select(all_1_position.z, t_12, t_17));
    all_1_mass = select(all_1_mass, t_13, t_17);
    all_1_alive = select(all_1_alive, t_14, t_17);
    all_1_hits = select(all_1_hits, t_15, t_17);
    if (all_0_alive) {
        let t_18 = 1u - i;
        let all_0_position_3 = all_0_position;
        let all_0_mass_3 = all_0_mass;
        let all_0_alive_3 = all_0_alive;
        let t_19 = t_18 >= 1u;
        let t_20 = select(all_0_position_3.x, all_1_position.x, t_19);
        let t_21 = select(all_0_position_3.y, all_1_position.y, t_19);
        let t_22 = select(all_0_position_3.z, all_1_position.z, t_19);
        let t_23 = select(all_0_mass_3, all_1_mass, t_19);
        let t_24 = select(all_0_alive_3, all_1_alive, t_19);
        let t_25 = t_18 == 0u;
        let t_26 = t_18 >= 1u;
        all_0_position = vec3<f32>(select(all_0_position_3.x, t_20, t_25), select(all_0_position_3.y, t_21, t_25), select(all_0_position_3.z, t_22, t_25));
        all_0_mass = select(all_0_mass_3, t_23, t_25);
        all_0_alive = select(all_0_alive_3, t_24, t_25);
        all_0_hits = select(all_0_hits, n, t_25);
        all_1_position = vec3<f32>(select(all_1_position.x, t_20, t_26), select(all_1_position.y, t_21, t_26), select(all_1_position.z, t_22, t_26));
        all_1_mass = select(all_1_mass, t_23, t_26);
        all_1_alive = select(all_1_alive, t_24, t_26);
        all_1_hits = select(all_1_hits, n, t_26);
    }
    let t_27 = i >= 1u;
    let t_28 = i >= 1u;
    let t_29 = select(all_0_position.x, all_1_position.x, t_28);
    let t_30 = select(all_0_position.y, all_1_position.y, t_28);
    let t_31 = select(all_0_position.z, all_1_position.z, t_28);
    let length_ = t_29 * t_29 + t_30 * t_30 + t_31 * t_31;
    return select(all_0_mass, all_1_mass, t_27) + (select(all_0_position.x, all_1_position.x, t_27) * all_0_position.x + select(all_0_position.y, all_1_position.y, t_27) * all_0_position.y + select(all_0_position.z, all_1_position.z, t_27) * all_0_position.z) + f32(all_1_hits) + length_;
}

fn element(input: Tuple) -> f32 {
    return array_of_structs(input._0, input._1);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple>;
@group(0) @binding(3) var<storage, read_write> outputs: array<f32>;

fn load_input(i: u32) -> Tuple {
    let s = inputs[i];
    return Tuple(Particle(vec3<f32>(s.arg0_position_x, s.arg0_position_y, s.arg0_position_z), s.arg0_mass, (s.arg0_alive & 0xffu) != 0u, s.arg0_hits), s.arg1);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let result = element(load_input(index));
    outputs[index] = result;
}
