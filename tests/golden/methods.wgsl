struct Particle {
    position: vec3<f32>,
    mass: f32,
    alive: bool,
    hits: u32,
}

struct Tuple {
    _0: Particle,
    _1: Particle,
    _2: f32,
}

struct StoredTuple {
    arg0_position_x: f32,
    arg0_position_y: f32,
    arg0_position_z: f32,
    arg0_mass: f32,
    arg0_hits: u32,
    arg0_alive: u32,
    arg1_position_x: f32,
    arg1_position_y: f32,
    arg1_position_z: f32,
    arg1_mass: f32,
    arg1_hits: u32,
    arg1_alive: u32,
    arg2: f32,
}

struct StoredParticle {
    position_x: f32,
    position_y: f32,
    position_z: f32,
    mass: f32,
    hits: u32,
    alive: u32,
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

fn Particle_moved(self_: Particle, by: vec3<f32>) -> Particle {
    return Particle(self_.position + by, self_.mass, self_.alive, self_.hits);
}

fn Particle_is_heavy(self_: Particle, limit: f32) -> bool {
    return self_.mass > limit && self_.alive;
}

fn Particle_heavier(self_: Particle, other: Particle) -> Particle {
    if (Particle_is_heavy(other, self_.mass)) {
        return other;
    }
    return self_;
}

fn Particle_at_rest(mass: f32) -> Particle {
    return Particle(vec3<f32>(0.0f), mass, true, 0u);
}

fn methods(p: Particle, q: Particle, x: f32) -> Particle {
    let t = Particle_moved(p, vec3<f32>(x, 0.0f, 1.0f));
    var r_position: vec3<f32> = t.position;
    var r_mass: f32 = t.mass;
    var r_alive: bool = t.alive;
    var r_hits: u32 = t.hits;
    if (Particle_is_heavy(Particle(vec3<f32>(0.0f), r_mass, r_alive, 0u), x)) {
        let r_position_1 = r_position;
        let r_mass_1 = r_mass;
        let r_alive_1 = r_alive;
        let t_1 = Particle_heavier(Particle(r_position_1, r_mass_1, r_alive_1, r_hits), Particle_moved(q, p.position));
        r_position = t_1.position;
        r_mass = t_1.mass;
        r_alive = t_1.alive;
        r_hits = t_1.hits;
    } else {
        let r_position_2 = r_position;
        let r_mass_2 = r_mass;
        let r_alive_2 = r_alive;
        let t_2 = Particle_heavier(Particle_at_rest(x), Particle(r_position_2, r_mass_2, r_alive_2, r_hits));
        r_position = t_2.position;
        r_mass = t_2.mass;
        r_alive = t_2.alive;
        r_hits = t_2.hits;
    }
    return Particle(r_position, r_mass, r_alive, r_hits);
}

fn element(input: Tuple) -> Particle {
    return methods(input._0, input._1, input._2);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple>;
@group(0) @binding(3) var<storage, read_write> outputs: array<StoredParticle>;

fn load_input(i: u32) -> Tuple {
    let s = inputs[i];
    return Tuple(Particle(vec3<f32>(s.arg0_position_x, s.arg0_position_y, s.arg0_position_z), s.arg0_mass, (s.arg0_alive & 0xffu) != 0u, s.arg0_hits), Particle(vec3<f32>(s.arg1_position_x, s.arg1_position_y, s.arg1_position_z), s.arg1_mass, (s.arg1_alive & 0xffu) != 0u, s.arg1_hits), s.arg2);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let result = element(load_input(index));
    outputs[index] = StoredParticle(result.position.x, result.position.y, result.position.z, result.mass, result.hits, (select(0u, 1u, result.alive)));
}
