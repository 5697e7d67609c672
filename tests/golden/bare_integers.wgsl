struct Tuple {
    _0: f32,
    _1: u32,
}

struct StoredTuple {
    arg0: f32,
    arg1: u32,
}

struct Params {
    lit_0_01: f32,
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
fn saturate_u32(x: f32) -> u32 {
    if ((bitcast<u32>(x) & 0x7fffffffu) > 0x7f800000u) { return 0u; }
    if (x >= 4294967296.0) { return 4294967295u; }
    if (x <= 0.0) { return 0u; }
    return u32(x);
}

fn bare_integers(a: f32, n: u32) -> u32 {
    var inner: u32;
    if (a > 0.0f) {
        let value_1 = n % 4u;
        inner = select(select(3u, 2u, (value_1 == 1u)), 1u, (value_1 == 0u));
    } else {
        inner = n / 3u;
    }
    var parts_2_0: f32;
    var parts_2_1: u32;
    if (a > 1.0f) {
        parts_2_0 = a;
        parts_2_1 = 1u;
    } else {
        parts_2_0 = -a;
        parts_2_1 = 2u;
    }
    if (parts_2_0 > 50.0f) {
        return select(8u, 7u, (n == 0u));
    }
    let t = select(2u, 1u, (n > 9u));
    var last: u32;
    if (a > 1.0f) {
        last = select(inner, 1u, (a > 3.0f));
    } else {
        last = select(t, parts_2_1, (saturate_u32(abs(parts_2_0) * params.lit_0_01) % 2u >= 1u));
    }
    return last;
}

fn element(input: Tuple) -> u32 {
    return bare_integers(input._0, input._1);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple>;
@group(0) @binding(3) var<storage, read_write> outputs: array<u32>;

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
    outputs[index] = result;
}
