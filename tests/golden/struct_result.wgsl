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
    _0: f32,
    _1: u32,
}

struct StoredTuple {
    arg0: f32,
    arg1: u32,
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

fn struct_result(x: f32, n: u32) -> Pair {
    let t = x > 0.0f;
    let second = -vec3<f32>(x, 1.0f, 2.0f);
    return Pair(Particle(vec3<f32>(x, 1.0f, 2.0f), x, t, n), Particle(second, x, t, ~n), bitcast<i32>(n));
}

fn element(input: Tuple) -> Pair {
    return struct_result(input._0, input._1);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple>;
@group(0) @binding(3) var<storage, read_write> outputs: array<StoredPair>;

fn load_input(i: u32) -> Tuple {
    let s = inputs[i];
    return Tuple(s.arg0, s.arg1);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let result = element(load_input(index));
    outputs[index] = StoredPair(result.weight, result.first.position.x, result.first.position.y, result.first.position.z, result.first.mass, result.first.hits, (select(0u, 1u, result.first.alive)), result.second.position.x, result.second.position.y, result.second.position.z, result.second.mass, result.second.hits, (select(0u, 1u, result.second.alive)));
}
