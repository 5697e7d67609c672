struct Pair {
    first: u32,
    second: u32,
    share: f32,
}

struct Split {
    mantissa: f32,
    exponent: f32,
}

struct Tuple {
    _0: vec2<f32>,
    _1: f32,
}

struct StoredArray {
    arg0_arg1_arg2: u32,
}

struct StoredTuple {
    arg0_x: f32,
    arg0_y: f32,
    arg1: f32,
}

struct StoredVec3 {
    value_x: f32,
    value_y: f32,
    value_z: f32,
}

struct Params {
    floor_last_level: u32,
    floor_size: vec2<u32>,
    lit_0_5: f32,
    lit_255_0: f32,
    lit_12_92: f32,
    lit_0_055: f32,
    lit_1_055: f32,
    lit_1_0: f32,
    lit_0_35129592: f32,
    lit_0_42820632: f32,
    lit_0_6000023: f32,
    lit_3_0: f32,
    lit_0_9616699: f32,
    lit_0_00012677205: f32,
    lit_0_9617967: f32,
    lit_0_00015462885: f32,
    lit_0_001339101: f32,
    lit_0_0096180625: f32,
    lit_0_055503596: f32,
    lit_0_2402265: f32,
    lit_0_6931472: f32,
    nan: f32,
    infinity: f32,
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

@group(0) @binding(4) var<storage, read> floor_: array<StoredArray>;

fn floor__at(i: u32) -> array<u32, 3> {
    let s = floor_[i];
    return array<u32, 3>(s.arg0_arg1_arg2 & 0xffu, (s.arg0_arg1_arg2 >> 8u) & 0xffu, (s.arg0_arg1_arg2 >> 16u) & 0xffu);
}

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

fn level_within(level: f32, last: u32) -> f32 {
    let t = select(0.0f, level, 0.0f < level);
    let t_1 = f32(last);
    return select(t, t_1, t_1 < t);
}

fn Vec3_blend(self_: vec3<f32>, to: vec3<f32>, w: f32) -> vec3<f32> {
    return self_ + (to - self_) * w;
}

fn size_at(size: u32, level: u32) -> u32 {
    let t = size >> (level & 31u);
    return select(t, 1u, (t < 1u));
}

fn level_start(size: vec3<u32>, level: u32) -> u32 {
    var start: u32 = 0u;
    var finer: u32 = 0u;
    for (; finer < level; finer = finer + 1u) {
        start = start + size_at(size.x, finer) * size_at(size.y, finer) * size_at(size.z, finer);
    }
    return start;
}

fn reduced(x: f32) -> f32 {
    let c = select(0.0f, x, ((bitcast<u32>(x) & 2147483647u) < 2139095040u));
    return c - floor(c);
}

fn texel_at(i: i32, n: i32) -> u32 {
    let last = n - 1i;
    let j = select(i, i + n, (i < 0i));
    let k = select(j, j - n, (j > last));
    let t = select(k, 0i, (k < 0i));
    return bitcast<u32>(select(t, last, (last < t)));
}

fn pair(x: f32, size: u32) -> Pair {
    let n = bitcast<i32>(size);
    let place = reduced(x) * f32(size) - params.lit_0_5;
    let below = floor(place);
    let i = saturate_i32(below);
    return Pair(texel_at(i, n), texel_at(i + 1i, n), place - below);
}

fn part(first: u32, size: u32, i: u32) -> u32 {
    return first + i * size;
}

fn split(x: f32) -> Split {
    let is_denormal = x < 1.1754944e-38f;
    let normal = select(x, x * 33554432.0f, is_denormal);
    let shift = select(0.0f, 25.0f, is_denormal);
    let above = bitcast<u32>(normal) - 1060439283u;
    let mantissa = bitcast<f32>((above & 8388607u) + 1060439283u);
    return Split(mantissa, f32(bitcast<i32>(above) >> 23u) - shift);
}

fn head(x: f32) -> f32 {
    return bitcast<f32>(bitcast<u32>(x) & 4294963200u);
}

fn exp2_near_zero(r: f32) -> f32 {
    let p = params.lit_0_2402265 + r * (params.lit_0_055503596 + r * (params.lit_0_0096180625 + r * (params.lit_0_001339101 + r * params.lit_0_00015462885)));
    return params.lit_1_0 + r * (params.lit_0_6931472 + r * p);
}

fn power_of_two(n: i32) -> f32 {
    return bitcast<f32>(bitcast<u32>(n + 127i) << 23u);
}

fn scaled(x: f32, n: i32) -> f32 {
    let half = n >> 1u;
    return x * power_of_two(half) * power_of_two(n - half);
}

fn is_nan(x: f32) -> bool {
    return (bitcast<u32>(x) & 2147483647u) > 2139095040u;
}

fn pow_at_the_ends(x: f32, y: f32, is_odd: bool) -> f32 {
    let a = abs(x);
    if (x == 1.0f || y == 0.0f) {
        return 1.0f;
    }
    var either: bool;
    if (is_nan(x)) {
        either = true;
    } else {
        either = is_nan(y);
    }
    if (either) {
        return params.nan;
    }
    if (abs(y) > 340282346638528859811704183484516925440.0f) {
        if (a == 1.0f) {
            return 1.0f;
        }
        return select(0.0f, params.infinity, !((a > 1.0f) != (y > 0.0f)));
    }
    if (a > 0.0f && a <= 340282346638528859811704183484516925440.0f) {
        return params.nan;
    }
    let size = select(0.0f, params.infinity, !((a > 0.0f) != (y > 0.0f)));
    return bitcast<f32>((bitcast<u32>(size) & 2147483647u) | (bitcast<u32>(select(1.0f, x, is_odd)) & 2147483648u));
}

fn pow_(x: f32, y: f32) -> f32 {
    let a = abs(x);
    let b = abs(y);
    let is_whole = floor(b) == b;
    var both: bool;
    if (is_whole) {
        both = floor(b * 0.5f) != b * 0.5f;
    } else {
        both = false;
    }
    let parts = split(a);
    let f = parts.mantissa - params.lit_1_0;
    let d = parts.mantissa + params.lit_1_0;
    let s = f / d;
    let s_high = head(s);
    let d_high = head(d);
    let d_low = parts.mantissa - (d_high - params.lit_1_0);
    let s_low = (f - s_high * d_high - s_high * d_low) / d;
    let z = s * s;
    let z_high = s_high * s_high;
    let g = params.lit_0_6000023 + z * (params.lit_0_42820632 + z * params.lit_0_35129592);
    let rest = z * z * g + s_low * (s_high + s);
    let t_high = head(params.lit_3_0 + z_high + rest);
    let t_low = rest - (t_high - params.lit_3_0 - z_high);
    let u = s_high * t_high;
    let v = s_low * t_high + t_low * s;
    let p_high = head(u + v);
    let p_low = v - (p_high - u);
    let q_high = params.lit_0_9616699 * p_high;
    let q_low = params.lit_0_00012677205 * p_high + p_low * params.lit_0_9617967;
    let log_high = head(q_low + q_high + parts.exponent);
    let log_low = q_low - (log_high - parts.exponent - q_high);
    let t = select(y, -1000000000000.0f, y < -1000000000000.0f);
    let e = select(t, 1000000000000.0f, 1000000000000.0f < t);
    let e_high = head(e);
    let high = e_high * log_high;
    let low = (e - e_high) * log_high + e * log_low;
    let t_1 = high + low;
    let t_2 = select(t_1, -152.0f, t_1 < -152.0f);
    let n = floor(select(t_2, 130.0f, 130.0f < t_2) + params.lit_0_5);
    let t_3 = high - n + low;
    let t_4 = select(t_3, -1.0f, t_3 < -1.0f);
    let r = select(t_4, 1.0f, 1.0f < t_4);
    let size = scaled(exp2_near_zero(r), saturate_i32(n));
    var power: f32;
    if (both) {
        power = bitcast<f32>((bitcast<u32>(size) & 2147483647u) | (bitcast<u32>(x) & 2147483648u));
    } else {
        power = size;
    }
    let is_usual = a > 0.0f && a <= 340282346638528859811704183484516925440.0f && b <= 340282346638528859811704183484516925440.0f && (x > 0.0f || is_whole);
    var result: f32;
    if (is_usual) {
        result = power;
    } else {
        result = pow_at_the_ends(x, y, both);
    }
    return result;
}

fn srgb_to_linear(x: f32) -> f32 {
    var result: f32;
    if (x <= 0.04045f) {
        result = x / params.lit_12_92;
    } else {
        result = pow_((x + params.lit_0_055) / params.lit_1_055, 2.4f);
    }
    return result;
}

fn texel(row: u32, i: u32) -> vec3<f32> {
    let t = floor__at(row + i);
    return vec3<f32>(srgb_to_linear(f32(t[0]) / params.lit_255_0), srgb_to_linear(f32(t[1]) / params.lit_255_0), srgb_to_linear(f32(t[2]) / params.lit_255_0));
}

fn linear_row(row: u32, x: Pair) -> vec3<f32> {
    let a = texel(row, x.first);
    let b = texel(row, x.second);
    return Vec3_blend(a, b, x.share);
}

fn linear_image(first: u32, width: u32, x: Pair, y: Pair) -> vec3<f32> {
    let a = linear_row(part(first, width, y.first), x);
    let b = linear_row(part(first, width, y.second), x);
    return Vec3_blend(a, b, y.share);
}

fn filter2(size: vec2<u32>, first: u32, uv: vec2<f32>) -> vec3<f32> {
    let x = pair(uv.x, size.x);
    let y = pair(uv.y, size.y);
    return linear_image(first, size.x, x, y);
}

fn at_level2(uv: vec2<f32>, level: u32) -> vec3<f32> {
    let first = level_start(vec3<u32>(params.floor_size.x, params.floor_size.y, 1u), level);
    return filter2(vec2<u32>(size_at(params.floor_size.x, level), size_at(params.floor_size.y, level)), first, uv);
}

fn tex2_level(at: vec2<f32>, level: f32) -> vec3<f32> {
    let place = level_within(level, params.floor_last_level);
    let finer = floor(place);
    let below = at_level2(at, saturate_u32(finer));
    let t = saturate_u32(finer) + 1u;
    let above = at_level2(at, select(t, params.floor_last_level, (params.floor_last_level < t)));
    return Vec3_blend(below, above, place - finer);
}

fn kernel(uv: vec2<f32>, level: f32) -> vec3<f32> {
    return tex2_level(uv, level);
}

fn element(input: Tuple) -> vec3<f32> {
    return kernel(input._0, input._1);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple>;
@group(0) @binding(3) var<storage, read_write> outputs: array<StoredVec3>;

fn load_input(i: u32) -> Tuple {
    let s = inputs[i];
    return Tuple(vec2<f32>(s.arg0_x, s.arg0_y), s.arg1);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (any(id.xy >= job.count)) { return; }
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let result = element(load_input(index));
    outputs[index] = StoredVec3(result.x, result.y, result.z);
}
