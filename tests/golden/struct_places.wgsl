struct Particle {
    position: vec3<f32>,
    mass: f32,
    alive: bool,
    hits: u32,
}

struct Tuple {
    _0: Particle,
    _1: f32,
}

struct StoredTuple {
    arg0_position_x: f32,
    arg0_position_y: f32,
    arg0_position_z: f32,
    arg0_mass: f32,
    arg0_hits: u32,
    arg0_alive: u32,
    arg1: f32,
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
    lit_1_0: f32,
    lit_0_0: f32,
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

fn struct_places(p: Particle, x: f32) -> Particle {
    var q_position: vec3<f32> = p.position;
    var q_mass: f32 = p.mass;
    var q_alive: bool = p.alive;
    var q_hits: u32 = p.hits;
    q_position = vec3<f32>(q_position.x + x, q_position.y, q_position.z);
    q_position = vec3<f32>(q_position.x, q_position.y, q_position.z * 2.0f);
    if (q_position.y > 0.0f) {
        q_alive = !q_alive;
        q_hits = q_hits + 1u;
        q_position = q_position + vec3<f32>(params.lit_1_0, params.lit_0_0, x);
    }
    if (x > 10.0f) {
        q_position = p.position;
        q_mass = p.mass;
        q_alive = p.alive;
        q_hits = p.hits;
        q_mass = -x;
    }
    q_mass = q_mass - params.lit_0_5;
    return Particle(q_position, q_mass, q_alive, q_hits);
}

fn element(input: Tuple) -> Particle {
    return struct_places(input._0, input._1);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple>;
@group(0) @binding(3) var<storage, read_write> outputs: array<StoredParticle>;

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
    outputs[index] = StoredParticle(result.position.x, result.position.y, result.position.z, result.mass, result.hits, (select(0u, 1u, result.alive)));
}
