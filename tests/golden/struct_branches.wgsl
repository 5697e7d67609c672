struct Particle {
    position: vec3<f32>,
    mass: f32,
    alive: bool,
    hits: u32,
}

struct Pair {
    first: Particle,
    second: Particle,
    weight: i32,
}

struct Tuple {
    _0: Pair,
    _1: f32,
}

struct StoredTuple {
    arg0_weight: i32,
    arg0_first_position_x: f32,
    arg0_first_position_y: f32,
    arg0_first_position_z: f32,
    arg0_first_mass: f32,
    arg0_first_hits: u32,
    arg0_first_alive: u32,
    arg0_second_position_x: f32,
    arg0_second_position_y: f32,
    arg0_second_position_z: f32,
    arg0_second_mass: f32,
    arg0_second_hits: u32,
    arg0_second_alive: u32,
    arg1: f32,
}

struct StoredPair {
    weight: i32,
    first_position_x: f32,
    first_position_y: f32,
    first_position_z: f32,
    first_mass: f32,
    first_hits: u32,
    first_alive: u32,
    second_position_x: f32,
    second_position_y: f32,
    second_position_z: f32,
    second_mass: f32,
    second_hits: u32,
    second_alive: u32,
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

fn struct_branches(a: Pair, x: f32) -> Pair {
    var p_first_position: vec3<f32> = a.first.position;
    var p_first_mass: f32 = a.first.mass;
    var p_first_alive: bool = a.first.alive;
    var p_first_hits: u32 = a.first.hits;
    var p_second_position: vec3<f32> = a.second.position;
    var p_second_mass: f32 = a.second.mass;
    var p_second_alive: bool = a.second.alive;
    var p_second_hits: u32 = a.second.hits;
    var p_weight: i32 = a.weight;
    var i: u32 = 0u;
    for (; i < 3u; i = i + 1u) {
        var chosen_position: vec3<f32>;
        var chosen_mass: f32;
        var chosen_alive: bool;
        var chosen_hits: u32;
        if (x > f32(i)) {
            chosen_position = p_first_position;
            chosen_mass = p_first_mass;
            chosen_alive = p_first_alive;
            chosen_hits = p_first_hits;
        } else {
            chosen_position = p_second_position;
            chosen_mass = p_second_mass;
            chosen_alive = p_second_alive;
            chosen_hits = p_second_hits;
        }
        if (chosen_mass > 5.0f) {
            let t = Particle_moved(Particle(chosen_position, chosen_mass, chosen_alive, chosen_hits), vec3<f32>(1.0f, 1.0f, x));
            p_second_position = t.position;
            p_second_mass = t.mass;
            p_second_alive = t.alive;
            p_second_hits = t.hits;
            p_weight = p_weight + 1i;
        } else {
            p_first_hits = p_first_hits + i;
            let p_first_position_1 = p_first_position;
            let p_first_mass_1 = p_first_mass;
            let p_first_alive_1 = p_first_alive;
            let p_first_hits_1 = p_first_hits;
            p_first_position = p_second_position;
            p_first_mass = p_second_mass;
            p_first_alive = p_second_alive;
            p_first_hits = p_second_hits;
            p_second_position = p_first_position_1;
            p_second_mass = p_first_mass_1;
            p_second_alive = p_first_alive_1;
            p_second_hits = p_first_hits_1;
        }
        if (p_first_alive && p_second_alive) {
            return Pair(Particle(p_first_position, p_first_mass, p_first_alive, p_first_hits), Particle(p_second_position, p_second_mass, p_second_alive, p_second_hits), p_weight);
        }
    }
    return Pair(Particle(p_first_position, p_first_mass, p_first_alive, p_first_hits), Particle(p_second_position, p_second_mass, p_second_alive, p_second_hits), p_weight);
}

fn element(input: Tuple) -> Pair {
    return struct_branches(input._0, input._1);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple>;
@group(0) @binding(3) var<storage, read_write> outputs: array<StoredPair>;

fn load_input(i: u32) -> Tuple {
    let s = inputs[i];
    return Tuple(Pair(Particle(vec3<f32>(s.arg0_first_position_x, s.arg0_first_position_y, s.arg0_first_position_z), s.arg0_first_mass, (s.arg0_first_alive & 0xffu) != 0u, s.arg0_first_hits), Particle(vec3<f32>(s.arg0_second_position_x, s.arg0_second_position_y, s.arg0_second_position_z), s.arg0_second_mass, (s.arg0_second_alive & 0xffu) != 0u, s.arg0_second_hits), s.arg0_weight), s.arg1);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let result = element(load_input(index));
    outputs[index] = StoredPair(result.weight, result.first.position.x, result.first.position.y, result.first.position.z, result.first.mass, result.first.hits, (select(0u, 1u, result.first.alive)), result.second.position.x, result.second.position.y, result.second.position.z, result.second.mass, result.second.hits, (select(0u, 1u, result.second.alive)));
}
