struct Dual {
    x: f32,
    dx: f32,
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
    _1: Dual,
}

struct Tuple_1 {
    _0: f32,
    _1: f32,
}

struct StoredTuple_1 {
    arg0: f32,
    arg1: f32,
}

struct Params {
    lit_1_442695: f32,
    lit_0_5: f32,
    lit_0_69311523: f32,
    lit_3_1946183em5: f32,
    lit_0_0013838839: f32,
    lit_0_008369193: f32,
    lit_0_041668102: f32,
    lit_0_16666517: f32,
    lit_0_49999994: f32,
    lit_1_0: f32,
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

fn power_of_two(n: i32) -> f32 {
    return bitcast<f32>(bitcast<u32>(n + 127i) << 23u);
}

fn scaled(x: f32, n: i32) -> f32 {
    let half = n >> 1u;
    return x * power_of_two(half) * power_of_two(n - half);
}

fn exp(x: f32) -> f32 {
    let t = select(x, -105.0f, x < -105.0f);
    let y = select(t, 90.0f, 90.0f < t);
    let n = floor(y * params.lit_1_442695 + params.lit_0_5);
    let r = y - n * params.lit_0_69311523 - n * params.lit_3_1946183em5;
    let p = params.lit_0_49999994 + r * (params.lit_0_16666517 + r * (params.lit_0_041668102 + r * (params.lit_0_008369193 + r * params.lit_0_0013838839)));
    return scaled(params.lit_1_0 + (r + r * r * p), saturate_i32(n));
}

fn Dual_exp(self_: Dual) -> Dual {
    let e = exp(self_.x);
    return Dual(e, e * self_.dx);
}

fn turned(x: f32, sign_: u32) -> f32 {
    return bitcast<f32>(bitcast<u32>(x) ^ (sign_ & 2147483648u));
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

fn Dual_sin(self_: Dual, scale: f32) -> f32 {
    return sin(self_.x * scale);
}

fn Dual_clone(self_: Dual) -> f32 {
    return self_.x * 0.5f;
}

fn Dual_iter(self_: Dual) -> Tuple {
    var self_x: f32 = self_.x;
    self_x = self_x + params.lit_1_0;
    return Tuple(self_x, Dual(self_x, 0.0f));
}

fn Dual_len() -> u32 {
    return 2u;
}

fn own_names(a: f32, b: f32) -> f32 {
    var s_x: f32 = a * 0.125f;
    let s_dx = b;
    let s_x_1 = s_x;
    let s_dx_1 = s_dx;
    let s_x_2 = s_x;
    let s_dx_2 = s_dx;
    let e = Dual_exp(Dual(s_x_2, s_dx_2));
    let s_x_3 = s_x;
    let first = e.dx + Dual_exp(Dual(s_x_1, s_dx_1)).x + Dual_sin(Dual(s_x_1, 0.0f), 0.5f) + Dual_clone(Dual(s_x_3, 0.0f));
    let s_x_4 = s_x;
    let t = Dual_iter(Dual(s_x_4, 0.0f));
    s_x = t._1.x;
    let s_x_5 = s_x;
    let t_1 = Dual_iter(Dual(s_x_5, 0.0f));
    s_x = t_1._1.x;
    let second = t._0 + t_1._0 + Dual_clone(Dual(s_x_1, 0.0f)) + Dual_sin(Dual(s_x, 0.0f), 2.0f);
    return first + second + s_x * f32(Dual_len());
}

fn element(input: Tuple_1) -> f32 {
    return own_names(input._0, input._1);
}

@group(0) @binding(2) var<storage, read> inputs: array<StoredTuple_1>;
@group(0) @binding(3) var<storage, read_write> outputs: array<f32>;

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
    outputs[index] = result;
}
