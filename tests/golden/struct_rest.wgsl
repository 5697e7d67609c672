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

fn struct_rest(p: Particle, x: f32) -> Particle {
    let t = p.hits | 1u;
    var result_position: vec3<f32>;
    var result_mass: f32;
    var result_alive: bool;
    var result_hits: u32;
    if (x > 0.0f) {
        result_position = p.position * x;
        result_mass = x;
        result_alive = false;
        result_hits = t;
    } else {
        result_position = p.position;
        result_mass = x;
        result_alive = false;
        result_hits = t;
    }
    return Particle(result_position, result_mass, result_alive, result_hits);
}

fn element(input: Tuple) -> Particle {
    return struct_rest(input._0, input._1);
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
