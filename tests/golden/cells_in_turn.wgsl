struct Cell {
    at: vec3<i32>,
    inside: vec3<bool>,
    seed: vec2<u32>,
}

struct Tuple {
    _0: vec3<f32>,
    _1: Cell,
    _2: u32,
}

struct StoredTuple {
    arg1_at_x: i32,
    arg1_at_y: i32,
    arg1_at_z: i32,
    arg1_inside_x_arg1_inside_y_arg1_inside_z: u32,
    arg1_seed: vec2<u32>,
    arg0_x: f32,
    arg0_y: f32,
    arg0_z: f32,
    arg2: u32,
}

struct StoredCell {
    at_x: i32,
    at_y: i32,
    at_z: i32,
    inside_x_inside_y_inside_z: u32,
    seed: vec2<u32>,
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

/// As Rust's `as`: out of range gives the nearest number, NaN gives 0.
fn saturate_i32(x: f32) -> i32 {
    if ((bitcast<u32>(x) & 0x7fffffffu) > 0x7f800000u) { return 0i; }
    if (x >= 2147483648.0) { return 2147483647i; }
    if (x < -2147483648.0) { return (-2147483647i - 1i); }
    return i32(x);
}

fn cells_in_turn(p: vec3<f32>, cell: Cell, n: u32) -> Cell {
    let t = vec3<f32>(-1000000.0f);
    let t_1 = select(t, p, t < p);
    let t_2 = vec3<f32>(1000000.0f);
    let t_3 = floor(select(t_2, t_1, t_1 < t_2));
    var at: vec3<i32> = vec3<i32>(saturate_i32(t_3.x), saturate_i32(t_3.y), saturate_i32(t_3.z)) & vec3<i32>(4095i);
    var seed: vec2<u32> = cell.seed ^ vec2<u32>(n, 40503u);
    let t_4 = n & 3u;
    var i: u32 = 0u;
    for (; i < t_4; i = i + 1u) {
        let t_5 = seed * 747796405u;
        seed = t_5.yx;
        at = vec3<i32>(at.x, at.y, at.z + bitcast<i32>(seed.x >> 28u));
        if (at.x > 300i || at.y > 200i || at.z > 100i) {
            at = at.zxy % 100i - bitcast<i32>(i);
        }
    }
    let t_6 = cell.inside.x && at.x < 64i;
    let t_7 = cell.inside.y && at.y < 64i;
    let t_8 = cell.inside.z && at.z < 64i;
    let t_9 = vec3<i32>(-at.x, -at.y, -at.z) / 2i;
    let t_10 = select(t_9.x, at.x, t_6);
    let t_11 = select(t_9.y, at.y, t_7);
    let t_12 = select(t_9.z, at.z, t_8);
    let t_13 = t_6 && t_7 && t_8;
    let t_14 = vec3<i32>(t_10, t_11, t_12) + 1i;
    return Cell(vec3<i32>(select(t_14.x, t_10, t_13), select(t_14.y, t_11, t_13), select(t_14.z, t_12, t_13)), vec3<bool>(t_6, t_7, t_8), seed);
}

fn element(input: Tuple) -> Cell {
    return cells_in_turn(input._0, input._1, input._2);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple>;
@group(0) @binding(3) var<storage, read_write> outputs: array<StoredCell>;

fn load_input(i: u32) -> Tuple {
    let s = inputs[i];
    return Tuple(vec3<f32>(s.arg0_x, s.arg0_y, s.arg0_z), Cell(vec3<i32>(s.arg1_at_x, s.arg1_at_y, s.arg1_at_z), vec3<bool>((s.arg1_inside_x_arg1_inside_y_arg1_inside_z & 0xffu) != 0u, ((s.arg1_inside_x_arg1_inside_y_arg1_inside_z >> 8u) & 0xffu) != 0u, ((s.arg1_inside_x_arg1_inside_y_arg1_inside_z >> 16u) & 0xffu) != 0u), s.arg1_seed), s.arg2);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let result = element(load_input(index));
    outputs[index] = StoredCell(result.at.x, result.at.y, result.at.z, (select(0u, 1u, result.inside.x)) | ((select(0u, 1u, result.inside.y)) << 8u) | ((select(0u, 1u, result.inside.z)) << 16u), vec2<u32>(result.seed.x, result.seed.y));
}
