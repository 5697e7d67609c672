struct Casts {
    i: i32,
    u: u32,
    back: f32,
    wrapped: u32,
}

struct Tuple {
    _0: f32,
}

struct StoredTuple {
    arg0: f32,
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

/// As Rust's `as`: out of range gives the nearest number, NaN gives 0.
fn saturate_u32(x: f32) -> u32 {
    if ((bitcast<u32>(x) & 0x7fffffffu) > 0x7f800000u) { return 0u; }
    if (x >= 4294967296.0) { return 4294967295u; }
    if (x <= 0.0) { return 0u; }
    return u32(x);
}

fn from_float(x: f32) -> Casts {
    let i = saturate_i32(x);
    let u = saturate_u32(x);
    return Casts(i, u, f32(i), bitcast<u32>(i));
}

fn element(input: Tuple) -> Casts {
    return from_float(input._0);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple>;
@group(0) @binding(3) var<storage, read_write> outputs: array<Casts>;

fn load_input(i: u32) -> Tuple {
    let s = inputs[i];
    return Tuple(s.arg0);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let result = element(load_input(index));
    outputs[index] = result;
}
