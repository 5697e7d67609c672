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

fn struct_patterns(p: Particle, x: f32) -> f32 {
    var result: f32;
    if (p.alive && (p.hits >= 0u && p.hits <= 3u)) {
        result = p.mass + x;
    } else if (!p.alive) {
        result = p.mass - p.position.x;
    } else {
        result = p.position.x * x;
    }
    return result;
}

fn element(input: Tuple) -> f32 {
    return struct_patterns(input._0, input._1);
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
