struct Tuple {
    _0: vec3<f32>,
    _1: f32,
    _2: vec3<f32>,
    _3: f32,
}

struct Tuple_1 {
    _0: vec3<f32>,
    _1: f32,
}

struct StoredTuple_1 {
    arg0: vec3<f32>,
    arg1: f32,
}

struct StoredTuple {
    arg0: vec3<f32>,
    arg1: f32,
    arg2: vec3<f32>,
    arg3: f32,
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

/// Returns a / b, rounded to nearest where the device's own quotient is up to 4 ulp off. Results that
/// are denormal are the device's.
fn exact_quotient(a: f32, b: f32) -> f32 {
    let x = bitcast<u32>(a);
    let y = bitcast<u32>(b);
    let of_a = (x >> 23u) & 255u;
    let of_b = (y >> 23u) & 255u;
    // 0, denormals, infinity and NaN have no rounding.
    if (of_a == 0u || of_b == 0u || of_a == 255u || of_b == 255u) { return a / b; }
    // Numbers in [1, 2), so that nothing underflows on the way.
    let m = bitcast<f32>((x & 0x7fffffu) | 0x3f800000u);
    let n = bitcast<f32>((y & 0x7fffffu) | 0x3f800000u);
    let near = m / n;
    let q = near + fma(-near, n, m) / n;
    // What is left is exact, and says which of three neighbours is the nearest.
    let left = fma(-q, n, m);
    let above = bitcast<f32>(bitcast<u32>(q) + 1u);
    let below = bitcast<f32>(bitcast<u32>(q) - 1u);
    var nearest = q;
    if (left + left > (above - q) * n) { nearest = above; }
    if (left + left < (below - q) * n) { nearest = below; }
    let sign = (x ^ y) & 0x80000000u;
    let bits = bitcast<u32>(nearest) + ((of_a - of_b) << 23u);
    let exponent = i32(bitcast<u32>(nearest) >> 23u) + i32(of_a) - i32(of_b);
    if (exponent <= 0) { return a / b; }
    if (exponent >= 255) { return bitcast<f32>(sign | 0x7f800000u); }
    return bitcast<f32>(sign | bits);
}

fn exact_quotient3(a: vec3<f32>, b: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(exact_quotient(a.x, b.x), exact_quotient(a.y, b.y), exact_quotient(a.z, b.z));
}

/// Returns the square root, rounded to nearest where the device's own is up to 5 ulp off.
fn exact_root(a: f32) -> f32 {
    let x = bitcast<u32>(a);
    let exponent = x >> 23u;
    // 0, denormals, infinity, NaN and negative numbers have no rounding.
    if (exponent == 0u || exponent >= 255u) { return sqrt(a); }
    // A number in [1, 4) whose exponent differs by an even number.
    let odd = (exponent & 1u) ^ 1u;
    let m = bitcast<f32>((x & 0x7fffffu) | ((127u + odd) << 23u));
    let near = sqrt(m);
    let s = near + fma(-near, near, m) / (near + near);
    // What is left is exact, and says which of three neighbours is the nearest.
    let left = fma(-s, s, m);
    let above = bitcast<f32>(bitcast<u32>(s) + 1u);
    let below = bitcast<f32>(bitcast<u32>(s) - 1u);
    var nearest = s;
    if (left > (above - s) * s) { nearest = above; }
    if (left <= (below - s) * s) { nearest = below; }
    return bitcast<f32>(bitcast<u32>(nearest) + (((exponent - 127u - odd) >> 1u) << 23u));
}

fn exact_root3(a: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(exact_root(a.x), exact_root(a.y), exact_root(a.z));
}

fn kernel(a: vec3<f32>, b: f32) -> Tuple {
    return Tuple(exact_quotient3(a, vec3<f32>(b)), exact_quotient(a.y, a.z), exact_root3(abs(a)), exact_root(b) / 4.0f);
}

fn element(input: Tuple_1) -> Tuple {
    return kernel(input._0, input._1);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple_1>;
@group(0) @binding(3) var<storage, read_write> outputs: array<StoredTuple>;

fn load_input(i: u32) -> Tuple_1 {
    let s = inputs[i];
    return Tuple_1(s.arg0, s.arg1);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let result = element(load_input(index));
    outputs[index] = StoredTuple(vec3<f32>(result._0.x, result._0.y, result._0.z), result._1, vec3<f32>(result._2.x, result._2.y, result._2.z), result._3);
}
