struct Split {
    mantissa: f32,
    exponent: f32,
}

struct Tuple {
    _0: f32,
    _1: f32,
}

struct StoredTuple {
    arg0: f32,
    arg1: f32,
}

struct StoredVec4 {
    value: vec4<f32>,
}

struct Params {
    lit_1_0: f32,
    lit_2_0: f32,
    lit_0_2987146: f32,
    lit_0_39977568: f32,
    lit_0_66666776: f32,
    lit_3_1946183em5: f32,
    lit_0_69311523: f32,
    infinity: f32,
    nan: f32,
    lit_1_442695: f32,
    lit_0_5: f32,
    lit_0_0001994595: f32,
    lit_0_0013932673: f32,
    lit_0_008333206: f32,
    lit_0_04166649: f32,
    lit_0_16666667: f32,
    lit_0_0013838839: f32,
    lit_0_008369193: f32,
    lit_0_041668102: f32,
    lit_0_16666517: f32,
    lit_0_49999994: f32,
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
    infinity_1: f32,
    infinity_2: f32,
    lit_0_0003122284: f32,
    lit_1_4423828: f32,
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

fn split(x: f32) -> Split {
    let is_denormal = x < 1.1754944e-38f;
    let normal = select(x, x * 33554432.0f, is_denormal);
    let shift = select(0.0f, 25.0f, is_denormal);
    let above = bitcast<u32>(normal) - 1060439283u;
    let mantissa = bitcast<f32>((above & 8388607u) + 1060439283u);
    return Split(mantissa, f32(bitcast<i32>(above) >> 23u) - shift);
}

fn log_rest(z: f32) -> f32 {
    return z * (params.lit_0_66666776 + z * (params.lit_0_39977568 + z * params.lit_0_2987146));
}

fn log_of_parts(f: f32, k: f32) -> f32 {
    let s = f / (params.lit_2_0 + f);
    let half = 0.5f * f * f;
    let small = s * (half + log_rest(s * s)) + k * params.lit_3_1946183em5;
    return k * params.lit_0_69311523 + (f - (half - small));
}

fn log_at_the_ends(x: f32) -> f32 {
    return select(select(x, params.nan, (x < 0.0f)), params.infinity, (x == 0.0f));
}

fn log(x: f32) -> f32 {
    let parts = split(x);
    let v = log_of_parts(parts.mantissa - params.lit_1_0, parts.exponent);
    var result: f32;
    if (x > 0.0f && x <= 340282346638528859811704183484516925440.0f) {
        result = v;
    } else {
        result = log_at_the_ends(x);
    }
    return result;
}

fn power_of_two(n: i32) -> f32 {
    return bitcast<f32>(bitcast<u32>(n + 127i) << 23u);
}

fn scaled(x: f32, n: i32) -> f32 {
    let half = n >> 1u;
    return x * power_of_two(half) * power_of_two(n - half);
}

fn expm1(x: f32) -> f32 {
    let t = select(x, -18.0f, x < -18.0f);
    let y = select(t, 90.0f, 90.0f < t);
    let n = floor(y * params.lit_1_442695 + params.lit_0_5);
    let r = y - n * params.lit_0_69311523 - n * params.lit_3_1946183em5;
    let q = params.lit_0_04166649 + r * (params.lit_0_008333206 + r * (params.lit_0_0013932673 + r * params.lit_0_0001994595));
    let e = r + r * r * (params.lit_0_5 + r * (params.lit_0_16666667 + r * q));
    let whole = saturate_i32(n);
    let rest = params.lit_1_0 - power_of_two(-select(whole, 60i, (60i < whole)));
    return bitcast<f32>((bitcast<u32>(scaled(e + rest, whole)) & 2147483647u) | (bitcast<u32>(x) & 2147483648u));
}

fn exp(x: f32) -> f32 {
    let t = select(x, -105.0f, x < -105.0f);
    let y = select(t, 90.0f, 90.0f < t);
    let n = floor(y * params.lit_1_442695 + params.lit_0_5);
    let r = y - n * params.lit_0_69311523 - n * params.lit_3_1946183em5;
    let p = params.lit_0_49999994 + r * (params.lit_0_16666517 + r * (params.lit_0_041668102 + r * (params.lit_0_008369193 + r * params.lit_0_0013838839)));
    return scaled(params.lit_1_0 + (r + r * r * p), saturate_i32(n));
}

fn head(x: f32) -> f32 {
    return bitcast<f32>(bitcast<u32>(x) & 4294963200u);
}

fn exp2_near_zero(r: f32) -> f32 {
    let p = params.lit_0_2402265 + r * (params.lit_0_055503596 + r * (params.lit_0_0096180625 + r * (params.lit_0_001339101 + r * params.lit_0_00015462885)));
    return params.lit_1_0 + r * (params.lit_0_6931472 + r * p);
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
        return select(0.0f, params.infinity_1, !((a > 1.0f) != (y > 0.0f)));
    }
    if (a > 0.0f && a <= 340282346638528859811704183484516925440.0f) {
        return params.nan;
    }
    let size = select(0.0f, params.infinity_2, !((a > 0.0f) != (y > 0.0f)));
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

fn log2(x: f32) -> f32 {
    let parts = split(x);
    let f = parts.mantissa - params.lit_1_0;
    let s = f / (params.lit_2_0 + f);
    let half = 0.5f * f * f;
    let high = head(f - half);
    let low = f - high - half + s * (half + log_rest(s * s));
    let small = (low + high) * params.lit_0_0003122284 + low * params.lit_1_4423828;
    let v = small + high * params.lit_1_4423828 + parts.exponent;
    var result: f32;
    if (x > 0.0f && x <= 340282346638528859811704183484516925440.0f) {
        result = v;
    } else {
        result = log_at_the_ends(x);
    }
    return result;
}

fn growth(x: f32, y: f32) -> vec4<f32> {
    var z: f32;
    if (x > 0.0f) {
        z = log(x);
    } else {
        z = expm1(x);
    }
    return vec4<f32>(exp(y), z, pow_(x, y), log2(abs(x)));
}

fn element(input: Tuple) -> vec4<f32> {
    return growth(input._0, input._1);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple>;
@group(0) @binding(3) var<storage, read_write> outputs: array<StoredVec4>;

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
    outputs[index] = StoredVec4(vec4<f32>(result.x, result.y, result.z, result.w));
}
