struct SinCos {
    sin: f32,
    cos: f32,
}

struct Words {
    a: u32,
    b: u32,
    c: u32,
    d: u32,
}

struct Reduced {
    rest: f32,
    tail: f32,
    quarters: u32,
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
    lit_0_01: f32,
    lit_0_5: f32,
    lit_m76_8646: f32,
    lit_81_62744: f32,
    lit_m41_341873: f32,
    lit_6_2831855: f32,
    lit_58_561153: f32,
    lit_m85_42312: f32,
    lit_64_93914: f32,
    lit_m19_739208: f32,
    lit_1_0: f32,
    lit_0_0: f32,
    lit_0_63661975: f32,
    lit_1_5703125: f32,
    lit_0_0004837513: f32,
    lit_7_5495336em8: f32,
    lit_2_563344em12: f32,
    lit_0_0004838268: f32,
    lit_1_5707964: f32,
    nan: f32,
    lit_m0_00019518605: f32,
    lit_0_008332191: f32,
    lit_m0_16666655: f32,
    lit_2_4432327em5: f32,
    lit_m0_001388731: f32,
    lit_0_041666646: f32,
    lit_0_41421357: f32,
    lit_m0_060903553: f32,
    lit_0_10599357: f32,
    lit_m0_14244422: f32,
    lit_0_1999853: f32,
    lit_m0_33333316: f32,
    lit_0_78515625: f32,
    lit_0_0002419134: f32,
    lit_0_04221983: f32,
    lit_0_024148121: f32,
    lit_0_04547666: f32,
    lit_0_07495249: f32,
    lit_0_16666754: f32,
    lit_4_371139em8: f32,
    lit_8_742278em8: f32,
    lit_3_1415927: f32,
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

fn turned(x: f32, sign_: u32) -> f32 {
    return bitcast<f32>(bitcast<u32>(x) ^ (sign_ & 2147483648u));
}

fn sincos_2pi(u: f32) -> SinCos {
    let a = abs(u);
    let turn = a - floor(a);
    let n = floor(4.0f * turn + params.lit_0_5);
    let r = turn - 0.25f * n;
    let z = r * r;
    let s = r * (params.lit_6_2831855 + z * (params.lit_m41_341873 + z * (params.lit_81_62744 + z * params.lit_m76_8646)));
    let c = params.lit_1_0 + z * (params.lit_m19_739208 + z * (params.lit_64_93914 + z * (params.lit_m85_42312 + z * params.lit_58_561153)));
    let quarters = saturate_u32(n);
    let is_odd = (quarters & 1u) != 0u;
    let sin_ = select(s, c, is_odd);
    let cos = select(c, s, is_odd);
    let sin__1 = turned(sin_, (quarters << 30u)) + params.lit_0_0;
    let cos_1 = turned(cos, ((quarters + 1u) << 30u)) + params.lit_0_0;
    return SinCos(turned(sin__1, bitcast<u32>(u)), cos_1);
}

fn two_over_pi(i: u32) -> Words {
    var result_a: u32;
    var result_b: u32;
    var result_c: u32;
    var result_d: u32;
    if (i == 0u) {
        result_a = 0u;
        result_b = 2734261102u;
        result_c = 1313084713u;
        result_d = 4230436817u;
    } else {
        var result_a_1: u32;
        var result_b_1: u32;
        var result_c_1: u32;
        var result_d_1: u32;
        if (i == 1u) {
            result_a_1 = 2734261102u;
            result_b_1 = 1313084713u;
            result_c_1 = 4230436817u;
            result_d_1 = 4113882560u;
        } else {
            var result_a_2: u32;
            var result_b_2: u32;
            var result_c_2: u32;
            var result_d_2: u32;
            if (i == 2u) {
                result_a_2 = 1313084713u;
                result_b_2 = 4230436817u;
                result_c_2 = 4113882560u;
                result_d_2 = 3680671129u;
            } else {
                var result_a_3: u32;
                var result_b_3: u32;
                var result_c_3: u32;
                var result_d_3: u32;
                if (i == 3u) {
                    result_a_3 = 4230436817u;
                    result_b_3 = 4113882560u;
                    result_c_3 = 3680671129u;
                    result_d_3 = 1011060801u;
                } else {
                    result_a_3 = 4113882560u;
                    result_b_3 = 3680671129u;
                    result_c_3 = 1011060801u;
                    result_d_3 = 4266746795u;
                }
                result_a_2 = result_a_3;
                result_b_2 = result_b_3;
                result_c_2 = result_c_3;
                result_d_2 = result_d_3;
            }
            result_a_1 = result_a_2;
            result_b_1 = result_b_2;
            result_c_1 = result_c_2;
            result_d_1 = result_d_2;
        }
        result_a = result_a_1;
        result_b = result_b_1;
        result_c = result_c_1;
        result_d = result_d_1;
    }
    return Words(result_a, result_b, result_c, result_d);
}

fn upper_half(m: u32, w: u32) -> u32 {
    let m_low = m & 65535u;
    let m_high = m >> 16u;
    let w_low = w & 65535u;
    let w_high = w >> 16u;
    let cross_ = m_low * w_high;
    let middle = ((m_low * w_low) >> 16u) + (cross_ & 65535u) + m_high * w_low;
    return m_high * w_high + (cross_ >> 16u) + (middle >> 16u);
}

fn reduced_large(a: f32) -> Reduced {
    let bits = bitcast<u32>(a);
    let m = (bits & 8388607u) | 8388608u;
    let first = (bits >> 23u) - 120u;
    let words = two_over_pi((first >> 5u));
    let shift = first & 31u;
    let back = shift ^ 31u;
    let w0 = (words.a << (shift & 31u)) | ((words.b >> 1u) >> (back & 31u));
    let w1 = (words.b << (shift & 31u)) | ((words.c >> 1u) >> (back & 31u));
    let w2 = (words.c << (shift & 31u)) | ((words.d >> 1u) >> (back & 31u));
    let product = m * w1;
    let low = product + upper_half(m, w2);
    let carry = u32(low < product);
    let high = m * w0 + upper_half(m, w1) + carry;
    let quarters = (high + 536870912u) >> 30u;
    let fraction = (high << 2u) | (low >> 30u);
    let flip = bitcast<u32>(bitcast<i32>(fraction) >> 31u);
    let upper = fraction ^ flip;
    let lower = (low << 2u) ^ flip;
    let v = f32(upper >> 16u) * 1.5258789e-5f;
    let w = f32(upper & 65535u) * 2.3283064e-10f + f32(lower) * 5.421011e-20f;
    let rest = v * params.lit_1_5703125 + (v * params.lit_0_0004838268 + w * params.lit_1_5707964);
    var value: f32;
    if (a <= 340282346638528859811704183484516925440.0f) {
        value = turned(rest, flip);
    } else {
        value = params.nan;
    }
    return Reduced(value, 0.0f, quarters);
}

fn reduced(a: f32) -> Reduced {
    var result_rest: f32;
    var result_tail: f32;
    var result_quarters: u32;
    if (a < 8192.0f) {
        let n = floor(a * params.lit_0_63661975 + params.lit_0_5);
        let rest = a - n * params.lit_1_5703125 - n * params.lit_0_0004837513 - n * params.lit_7_5495336em8;
        result_rest = rest;
        result_tail = n * params.lit_2_563344em12;
        result_quarters = saturate_u32(n);
    } else {
        let t = reduced_large(a);
        result_rest = t.rest;
        result_tail = t.tail;
        result_quarters = t.quarters;
    }
    return Reduced(result_rest, result_tail, result_quarters);
}

fn wave(angle: Reduced, quarters: u32) -> f32 {
    let z = angle.rest * angle.rest;
    let sin_series = angle.rest * z * (params.lit_m0_16666655 + z * (params.lit_0_008332191 + z * params.lit_m0_00019518605));
    let sin_ = angle.rest + (sin_series - angle.tail);
    let cos_series = z * z * (params.lit_0_041666646 + z * (params.lit_m0_001388731 + z * params.lit_2_4432327em5));
    let cos = params.lit_1_0 - (0.5f * z - (cos_series + angle.rest * angle.tail));
    let v = select(cos, sin_, ((quarters & 1u) == 0u));
    return turned(v, (quarters << 30u));
}

fn sin(x: f32) -> f32 {
    let angle = reduced(abs(x));
    return turned(wave(angle, angle.quarters), bitcast<u32>(x));
}

fn atan_of_parts(k: f32, q: f32) -> f32 {
    let z = q * q;
    let p = params.lit_m0_14244422 + z * (params.lit_0_10599357 + z * params.lit_m0_060903553);
    let rest = q * z * (params.lit_m0_33333316 + z * (params.lit_0_1999853 + z * p));
    return k * params.lit_0_78515625 + (q + (rest + k * params.lit_0_0002419134));
}

fn is_nan(x: f32) -> bool {
    return (bitcast<u32>(x) & 2147483647u) > 2139095040u;
}

fn atan2(y: f32, x: f32) -> f32 {
    let width = abs(x);
    let height = abs(y);
    var long: f32 = select(width, height, width < height);
    var short: f32 = select(width, height, height < width);
    if (long > 340282346638528859811704183484516925440.0f || long == 0.0f) {
        short = select(0.0f, 1.0f, (short > 340282346638528859811704183484516925440.0f));
        long = 1.0f;
    }
    let scale = select(1.0f, 0.25f, (long > 1e19f));
    let scale_1 = select(scale, 16777216.0f, (long < 7.888609e-31f));
    let long_1 = long * scale_1;
    let short_1 = short * scale_1;
    let is_middle = short_1 > params.lit_0_41421357 * long_1;
    let above = select(short_1, short_1 - long_1, is_middle);
    let below = select(long_1, short_1 + long_1, is_middle);
    let q = above / below;
    let k = u32(is_middle);
    let is_high = height > width;
    let k_1 = select(k, 2u - k, is_high);
    let is_left = (bitcast<u32>(x) >> 31u) != 0u;
    let k_2 = select(k_1, 4u - k_1, is_left);
    let mirrored = (u32(is_high) ^ u32(is_left)) << 31u;
    let angle = atan_of_parts(f32(k_2), turned(q, mirrored));
    var either: bool;
    if (is_nan(x)) {
        either = true;
    } else {
        either = is_nan(y);
    }
    var result: f32;
    if (either) {
        result = params.nan;
    } else {
        result = bitcast<f32>((bitcast<u32>(angle) & 2147483647u) | (bitcast<u32>(y) & 2147483648u));
    }
    return result;
}

fn asin_series(s: f32, z: f32) -> f32 {
    let p = params.lit_0_04547666 + z * (params.lit_0_024148121 + z * params.lit_0_04221983);
    return s + s * z * (params.lit_0_16666754 + z * (params.lit_0_07495249 + z * p));
}

fn acos(x: f32) -> f32 {
    let a = abs(x);
    let is_far = a > 0.5f;
    let z = select(a * a, (params.lit_1_0 - a) * 0.5f, is_far);
    var s: f32;
    if (is_far) {
        s = sqrt(z);
    } else {
        s = a;
    }
    let p = asin_series(s, z);
    let near = params.lit_1_5707964 - (bitcast<f32>((bitcast<u32>(p) & 2147483647u) | (bitcast<u32>(x) & 2147483648u)) + params.lit_4_371139em8);
    let far = select(params.lit_3_1415927 - (2.0f * p + params.lit_8_742278em8), 2.0f * p, (x > 0.0f));
    let v = select(near, far, is_far);
    return select(params.nan, v, (a <= 1.0f));
}

fn angles(x: f32, y: f32) -> vec4<f32> {
    let turn = sincos_2pi(x * params.lit_0_01);
    return vec4<f32>(sin(x), turn.cos, atan2(y, x), acos(turn.sin));
}

fn element(input: Tuple) -> vec4<f32> {
    return angles(input._0, input._1);
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
