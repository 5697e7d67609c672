//! Every operation of glam's types and of numbers that kernels have, against its own source.
//!
//! A row is an operation: an expression whose source is compared with its lifted form on a million
//! operands, special values among them, on the scalar machine, packets of every natural level, and
//! (fewer) in WGSL.

use raydsl::prelude::*;

macro_rules! operations {
    ($module:ident: $numbers:ident $wgsl:ident;
     $($name:ident($($a:ident: $t:ty),+) -> $r:ty { $($body:tt)+ })+) => {
        mod $module {
            $(
                mod $name {
                    #[allow(unused_imports, reason = "not every operation needs them")]
                    use super::super::*;

                    #[raydsl::kernel]
                    pub(super) fn operation($($a: $t),+) -> $r {
                        $($body)+
                    }
                }

                #[test]
                fn $name() {
                    raydsl_tests::operations::operation::<$name::operation>(
                        stringify!($name),
                        raydsl_tests::values::Numbers::$numbers,
                        raydsl_tests::check::Wgsl::$wgsl,
                    );
                }
            )+
        }
    };
}

operations! { of_float: Any SameIfFinite;
    abs(a: f32) -> f32 { a.abs() }
    floor(a: f32) -> f32 { a.floor() }
    ceil(a: f32) -> f32 { a.ceil() }
    trunc(a: f32) -> f32 { a.trunc() }
    round(a: f32) -> f32 { a.round() }
    fract(a: f32) -> f32 { a.fract() }
    sqrt(a: f32) -> f32 { a.sqrt() }
    recip(a: f32) -> f32 { a.recip() }
    signum(a: f32) -> f32 { a.signum() }
    to_radians(a: f32) -> f32 { a.to_radians() }
    to_degrees(a: f32) -> f32 { a.to_degrees() }
    fract_gl(a: f32) -> f32 { a.fract_gl() }
    saturate(a: f32) -> f32 { a.saturate() }
    is_nan(a: f32) -> bool { a.is_nan() }
    is_infinite(a: f32) -> bool { a.is_infinite() }
    is_finite(a: f32) -> bool { a.is_finite() }
    is_sign_negative(a: f32) -> bool { a.is_sign_negative() }
    is_sign_positive(a: f32) -> bool { a.is_sign_positive() }
    copysign(a: f32, b: f32) -> f32 { a.copysign(b) }
    step(a: f32, b: f32) -> f32 { a.step(b) }
    min_method(a: f32, b: f32) -> f32 { a.min(b) }
    max_method(a: f32, b: f32) -> f32 { a.max(b) }
    clamp_method(a: f32) -> f32 { a.clamp(-2.5, 7.0) }
    to_bits_and_back(a: f32, n: u32) -> f32 { f32::from_bits(a.to_bits() ^ (n & 0x7f_ffff)) }
    lerp(a: f32, b: f32, s: f32) -> f32 { a.lerp(b, s) }
    lerp_monotonic(a: f32, b: f32, s: f32) -> f32 { a.lerp_monotonic(b, s) }
    smoothstep(a: f32, b: f32, c: f32) -> f32 { a.smoothstep(b, c) }
    min_function(a: f32, b: f32) -> f32 { min(a, b) }
    max_function(a: f32, b: f32) -> f32 { max(a, b) }
    clamp_function(a: f32, b: f32, c: f32) -> f32 { clamp(a, b, c) }
    select_function(c: bool, a: f32, b: f32) -> f32 { select(c, a, b) }
}

operations! { of_fused: Any Explained;
    mul_add(a: f32, b: f32, c: f32) -> f32 { a.mul_add(b, c) }
    vec3(a: Vec3, b: Vec3, c: Vec3) -> Vec3 { a.mul_add(b, c) }
    vec4(a: Vec4, b: Vec4, c: Vec4) -> Vec4 { a.mul_add(b, c) }
}

operations! { of_signed: Any Same;
    wrapping_add(a: i32, b: i32) -> i32 { a.wrapping_add(b) }
    wrapping_sub(a: i32, b: i32) -> i32 { a.wrapping_sub(b) }
    wrapping_mul(a: i32, b: i32) -> i32 { a.wrapping_mul(b) }
    saturating_add(a: i32, b: i32) -> i32 { a.saturating_add(b) }
    saturating_sub(a: i32, b: i32) -> i32 { a.saturating_sub(b) }
    min(a: i32, b: i32) -> i32 { a.min(b) }
    max(a: i32, b: i32) -> i32 { a.max(b) }
    abs_diff(a: i32, b: i32) -> u32 { a.abs_diff(b) }
    wrapping_shl(a: i32, n: u32) -> i32 { a.wrapping_shl(n) }
    wrapping_shr(a: i32, n: u32) -> i32 { a.wrapping_shr(n) }
    rotate_left(a: i32, n: u32) -> i32 { a.rotate_left(n) }
    rotate_right(a: i32, n: u32) -> i32 { a.rotate_right(n) }
    wrapping_neg(a: i32) -> i32 { a.wrapping_neg() }
    swap_bytes(a: i32) -> i32 { a.swap_bytes() }
    reverse_bits(a: i32) -> i32 { a.reverse_bits() }
    count_ones(a: i32) -> u32 { a.count_ones() }
    count_zeros(a: i32) -> u32 { a.count_zeros() }
    leading_zeros(a: i32) -> u32 { a.leading_zeros() }
    trailing_zeros(a: i32) -> u32 { a.trailing_zeros() }
    clamp_method(a: i32) -> i32 { a.clamp(3, 900) }
    functions(a: i32, b: i32) -> [i32; 3] { [min(a, b), max(a, b), clamp(a, 7, 70)] }
    select_function(c: bool, a: i32) -> i32 { select(c, a, 7) }
    unsigned_abs(a: i32) -> u32 { a.unsigned_abs() }
    wrapping_abs(a: i32) -> i32 { a.wrapping_abs() }
    signum(a: i32) -> i32 { a.signum() }
    is_negative(a: i32) -> bool { a.is_negative() }
    is_positive(a: i32) -> bool { a.is_positive() }
}

operations! { of_unsigned: Any Same;
    wrapping_add(a: u32, b: u32) -> u32 { a.wrapping_add(b) }
    wrapping_sub(a: u32, b: u32) -> u32 { a.wrapping_sub(b) }
    wrapping_mul(a: u32, b: u32) -> u32 { a.wrapping_mul(b) }
    saturating_add(a: u32, b: u32) -> u32 { a.saturating_add(b) }
    saturating_sub(a: u32, b: u32) -> u32 { a.saturating_sub(b) }
    min(a: u32, b: u32) -> u32 { a.min(b) }
    max(a: u32, b: u32) -> u32 { a.max(b) }
    abs_diff(a: u32, b: u32) -> u32 { a.abs_diff(b) }
    wrapping_shl(a: u32, n: u32) -> u32 { a.wrapping_shl(n) }
    wrapping_shr(a: u32, n: u32) -> u32 { a.wrapping_shr(n) }
    rotate_left(a: u32, n: u32) -> u32 { a.rotate_left(n) }
    rotate_right(a: u32, n: u32) -> u32 { a.rotate_right(n) }
    wrapping_neg(a: u32) -> u32 { a.wrapping_neg() }
    swap_bytes(a: u32) -> u32 { a.swap_bytes() }
    reverse_bits(a: u32) -> u32 { a.reverse_bits() }
    count_ones(a: u32) -> u32 { a.count_ones() }
    count_zeros(a: u32) -> u32 { a.count_zeros() }
    leading_zeros(a: u32) -> u32 { a.leading_zeros() }
    trailing_zeros(a: u32) -> u32 { a.trailing_zeros() }
    clamp_method(a: u32) -> u32 { a.clamp(3, 900) }
    functions(a: u32, b: u32) -> [u32; 3] { [min(a, b), max(a, b), clamp(a, 7, 70)] }
    select_function(c: bool, a: u32) -> u32 { select(c, a, 7) }
    is_multiple_of(a: u32, b: u32) -> bool { a.is_multiple_of(b) || 6u32.is_multiple_of(b & 7) }
    is_power_of_two(a: u32) -> bool { a.is_power_of_two() }
}

operations! { of_division: Tame Same;
    abs(a: i32) -> i32 { a.abs() }
    rem_euclid(a: i32, b: i32) -> i32 { a.rem_euclid(b | 1) }
    div_euclid(a: i32, b: i32) -> i32 { a.div_euclid(b | 1) }
    rem_euclid_unsigned(a: u32, b: u32) -> u32 { a.rem_euclid(b | 1) }
    div_euclid_unsigned(a: u32, b: u32) -> u32 { a.div_euclid(b | 1) }
    rem_euclid_vector(a: IVec3, b: IVec3) -> IVec3 { a.rem_euclid(b | 1) }
    div_euclid_vector(a: IVec2, b: IVec2) -> IVec2 { a.div_euclid(b | 1) }
}

operations! { of_vec2: Any SameIfFinite;
    add(a: Vec2, b: Vec2) -> Vec2 { a + b }
    add_number(a: Vec2, b: f32) -> [Vec2; 2] { [a + b, b + a] }
    sub(a: Vec2, b: Vec2) -> Vec2 { a - b }
    sub_number(a: Vec2, b: f32) -> [Vec2; 2] { [a - b, b - a] }
    mul(a: Vec2, b: Vec2) -> Vec2 { a * b }
    mul_number(a: Vec2, b: f32) -> [Vec2; 2] { [a * b, b * a] }
    div(a: Vec2, b: Vec2) -> Vec2 { a / b }
    div_number(a: Vec2, b: f32) -> [Vec2; 2] { [a / b, b / a] }
    neg(a: Vec2) -> Vec2 { -a }
    equal(a: Vec2, b: Vec2) -> [bool; 2] { [a == b, a != b] }
    abs(a: Vec2) -> Vec2 { a.abs() }
    floor(a: Vec2) -> Vec2 { a.floor() }
    ceil(a: Vec2) -> Vec2 { a.ceil() }
    trunc(a: Vec2) -> Vec2 { a.trunc() }
    round(a: Vec2) -> Vec2 { a.round() }
    sqrt(a: Vec2) -> Vec2 { a.sqrt() }
    fract(a: Vec2) -> Vec2 { a.fract() }
    fract_gl(a: Vec2) -> Vec2 { a.fract_gl() }
    signum(a: Vec2) -> Vec2 { a.signum() }
    recip(a: Vec2) -> Vec2 { a.recip() }
    copysign(a: Vec2, b: Vec2) -> Vec2 { a.copysign(b) }
    step(a: Vec2, b: Vec2) -> Vec2 { a.step(b) }
    midpoint(a: Vec2, b: Vec2) -> Vec2 { a.midpoint(b) }
    lerp(a: Vec2, b: Vec2, s: f32) -> Vec2 { a.lerp(b, s) }
    classes(a: Vec2) -> [bool; 5] { [a.is_nan(), a.is_finite(), a.is_nan_mask().any(), a.is_finite_mask().all(), a.is_negative_mask().any()] }
    abs_diff_eq(a: Vec2, b: Vec2, c: f32) -> bool { a.abs_diff_eq(b, c) }
    comparisons(a: Vec2, b: Vec2) -> [u32; 6] { [a.cmpeq(b).bitmask(), a.cmpne(b).bitmask(), a.cmplt(b).bitmask(), a.cmple(b).bitmask(), a.cmpgt(b).bitmask(), a.cmpge(b).bitmask()] }
    masked(a: Vec2, b: Vec2) -> Vec2 { Vec2::select(a.cmplt(b) | !b.cmpge(a), a, b) }
    any_and_all(a: Vec2, b: Vec2) -> [bool; 2] { [any(a.cmplt(b)), all(a.cmplt(b) ^ a.cmpgt(b))] }
    select_function(c: bool, a: Vec2, b: Vec2) -> Vec2 { select(c, a, b) }
    min_and_max(a: Vec2, b: Vec2) -> [Vec2; 2] { [min(a, b), max(a, b)] }
    clamp_function(a: Vec2, b: Vec2, c: Vec2) -> Vec2 { clamp(a, b, c) }
    to_integers(a: Vec2) -> (IVec2, UVec2) { (a.as_ivec2(), a.as_uvec2()) }
    to_array(a: Vec2) -> [f32; 2] { a.to_array() }
    members(a: Vec2, b: f32) -> Vec2 { let mut v = a; v.x = v.y * b; v.y = v.x * b; v += b; v.x -= a.y; v }
    with_components(a: Vec2, b: f32) -> Vec2 { a.with_x(a.y - b).with_y(a.x - b) }
    extend(a: Vec2, b: f32) -> Vec3 { a.extend(b) }
    constants(a: Vec2) -> [Vec2; 2] { [a * Vec2::ZERO + Vec2::ONE, Vec2::splat(a.x) - Vec2::Y] }
    dot_function(a: Vec2, b: Vec2) -> f32 { dot(a, b) }
    length_function(a: Vec2) -> f32 { length(a) }
    distance_function(a: Vec2, b: Vec2) -> f32 { distance(a, b) }
    normalize_function(a: Vec2) -> Vec2 { normalize(a) }
    length(a: Vec2) -> f32 { a.length() }
    length_squared(a: Vec2) -> f32 { a.length_squared() }
    length_recip(a: Vec2) -> f32 { a.length_recip() }
    element_sum(a: Vec2) -> f32 { a.element_sum() }
    element_product(a: Vec2) -> f32 { a.element_product() }
    min_element(a: Vec2) -> f32 { a.min_element() }
    max_element(a: Vec2) -> f32 { a.max_element() }
    dot(a: Vec2, b: Vec2) -> f32 { a.dot(b) }
    distance(a: Vec2, b: Vec2) -> f32 { a.distance(b) }
    distance_squared(a: Vec2, b: Vec2) -> f32 { a.distance_squared(b) }
    normalize(a: Vec2) -> Vec2 { a.normalize() }
    normalize_or_zero(a: Vec2) -> Vec2 { a.normalize_or_zero() }
    saturate(a: Vec2) -> Vec2 { a.saturate() }
    is_normalized(a: Vec2) -> [bool; 2] { [a.is_normalized(), a.normalize().is_normalized()] }
    normalize_or(a: Vec2, b: Vec2) -> Vec2 { a.normalize_or(b) }
    min(a: Vec2, b: Vec2) -> Vec2 { a.min(b) }
    max(a: Vec2, b: Vec2) -> Vec2 { a.max(b) }
    project_onto(a: Vec2, b: Vec2) -> Vec2 { a.project_onto(b) }
    reject_from(a: Vec2, b: Vec2) -> Vec2 { a.reject_from(b) }
    project_onto_normalized(a: Vec2, b: Vec2) -> Vec2 { a.project_onto_normalized(b) }
    reject_from_normalized(a: Vec2, b: Vec2) -> Vec2 { a.reject_from_normalized(b) }
    reflect(a: Vec2, b: Vec2) -> Vec2 { a.reflect(b) }
    clamp(a: Vec2, b: Vec2, c: Vec2) -> Vec2 { a.clamp(b, c) }
    refract(a: Vec2, b: Vec2, c: f32) -> Vec2 { a.refract(b, c) }
    refract_units(a: Vec2, b: Vec2, c: f32) -> Vec2 { a.normalize().refract(b.normalize(), c) }
    lerp_monotonic(a: Vec2, b: Vec2, s: f32) -> Vec2 { a.lerp_monotonic(b, s) }
    smoothstep(a: Vec2, b: Vec2, c: Vec2) -> Vec2 { a.smoothstep(b, c) }
    clamp_length(a: Vec2, b: f32, c: f32) -> [Vec2; 3] { [a.clamp_length(b, c), a.clamp_length_min(b), a.clamp_length_max(c)] }
    perp(a: Vec2) -> Vec2 { a.perp() }
    perp_dot(a: Vec2, b: Vec2) -> f32 { a.perp_dot(b) }
    swizzles(a: Vec2) -> [Vec4; 4] { [a.yx().extend(a.x).extend(a.y), a.xxyy(), a.yyxy().zwxy(), a.xyx().extend(a.x)] }
}

operations! { of_vec3: Any SameIfFinite;
    add(a: Vec3, b: Vec3) -> Vec3 { a + b }
    add_number(a: Vec3, b: f32) -> [Vec3; 2] { [a + b, b + a] }
    sub(a: Vec3, b: Vec3) -> Vec3 { a - b }
    sub_number(a: Vec3, b: f32) -> [Vec3; 2] { [a - b, b - a] }
    mul(a: Vec3, b: Vec3) -> Vec3 { a * b }
    mul_number(a: Vec3, b: f32) -> [Vec3; 2] { [a * b, b * a] }
    div(a: Vec3, b: Vec3) -> Vec3 { a / b }
    div_number(a: Vec3, b: f32) -> [Vec3; 2] { [a / b, b / a] }
    neg(a: Vec3) -> Vec3 { -a }
    equal(a: Vec3, b: Vec3) -> [bool; 2] { [a == b, a != b] }
    abs(a: Vec3) -> Vec3 { a.abs() }
    floor(a: Vec3) -> Vec3 { a.floor() }
    ceil(a: Vec3) -> Vec3 { a.ceil() }
    trunc(a: Vec3) -> Vec3 { a.trunc() }
    round(a: Vec3) -> Vec3 { a.round() }
    sqrt(a: Vec3) -> Vec3 { a.sqrt() }
    fract(a: Vec3) -> Vec3 { a.fract() }
    fract_gl(a: Vec3) -> Vec3 { a.fract_gl() }
    signum(a: Vec3) -> Vec3 { a.signum() }
    recip(a: Vec3) -> Vec3 { a.recip() }
    copysign(a: Vec3, b: Vec3) -> Vec3 { a.copysign(b) }
    step(a: Vec3, b: Vec3) -> Vec3 { a.step(b) }
    midpoint(a: Vec3, b: Vec3) -> Vec3 { a.midpoint(b) }
    lerp(a: Vec3, b: Vec3, s: f32) -> Vec3 { a.lerp(b, s) }
    classes(a: Vec3) -> [bool; 5] { [a.is_nan(), a.is_finite(), a.is_nan_mask().any(), a.is_finite_mask().all(), a.is_negative_mask().any()] }
    abs_diff_eq(a: Vec3, b: Vec3, c: f32) -> bool { a.abs_diff_eq(b, c) }
    comparisons(a: Vec3, b: Vec3) -> [u32; 6] { [a.cmpeq(b).bitmask(), a.cmpne(b).bitmask(), a.cmplt(b).bitmask(), a.cmple(b).bitmask(), a.cmpgt(b).bitmask(), a.cmpge(b).bitmask()] }
    masked(a: Vec3, b: Vec3) -> Vec3 { Vec3::select(a.cmplt(b) | !b.cmpge(a), a, b) }
    any_and_all(a: Vec3, b: Vec3) -> [bool; 2] { [any(a.cmplt(b)), all(a.cmplt(b) ^ a.cmpgt(b))] }
    select_function(c: bool, a: Vec3, b: Vec3) -> Vec3 { select(c, a, b) }
    min_and_max(a: Vec3, b: Vec3) -> [Vec3; 2] { [min(a, b), max(a, b)] }
    clamp_function(a: Vec3, b: Vec3, c: Vec3) -> Vec3 { clamp(a, b, c) }
    to_integers(a: Vec3) -> (IVec3, UVec3) { (a.as_ivec3(), a.as_uvec3()) }
    to_array(a: Vec3) -> [f32; 3] { a.to_array() }
    members(a: Vec3, b: f32) -> Vec3 { let mut v = a; v.x = v.y * b; v.y = v.z * b; v.z = v.x * b; v += b; v.x -= a.y; v }
    with_components(a: Vec3, b: f32) -> Vec3 { a.with_x(a.z - b).with_y(a.y - b).with_z(a.x - b) }
    extend(a: Vec3, b: f32) -> Vec4 { a.extend(b) }
    truncate(a: Vec3) -> Vec2 { a.truncate() }
    constants(a: Vec3) -> [Vec3; 2] { [a * Vec3::ZERO + Vec3::ONE, Vec3::splat(a.x) - Vec3::Y] }
    dot_function(a: Vec3, b: Vec3) -> f32 { dot(a, b) }
    length_function(a: Vec3) -> f32 { length(a) }
    distance_function(a: Vec3, b: Vec3) -> f32 { distance(a, b) }
    normalize_function(a: Vec3) -> Vec3 { normalize(a) }
    length(a: Vec3) -> f32 { a.length() }
    length_squared(a: Vec3) -> f32 { a.length_squared() }
    length_recip(a: Vec3) -> f32 { a.length_recip() }
    element_sum(a: Vec3) -> f32 { a.element_sum() }
    element_product(a: Vec3) -> f32 { a.element_product() }
    min_element(a: Vec3) -> f32 { a.min_element() }
    max_element(a: Vec3) -> f32 { a.max_element() }
    dot(a: Vec3, b: Vec3) -> f32 { a.dot(b) }
    distance(a: Vec3, b: Vec3) -> f32 { a.distance(b) }
    distance_squared(a: Vec3, b: Vec3) -> f32 { a.distance_squared(b) }
    normalize(a: Vec3) -> Vec3 { a.normalize() }
    normalize_or_zero(a: Vec3) -> Vec3 { a.normalize_or_zero() }
    saturate(a: Vec3) -> Vec3 { a.saturate() }
    is_normalized(a: Vec3) -> [bool; 2] { [a.is_normalized(), a.normalize().is_normalized()] }
    normalize_or(a: Vec3, b: Vec3) -> Vec3 { a.normalize_or(b) }
    min(a: Vec3, b: Vec3) -> Vec3 { a.min(b) }
    max(a: Vec3, b: Vec3) -> Vec3 { a.max(b) }
    project_onto(a: Vec3, b: Vec3) -> Vec3 { a.project_onto(b) }
    reject_from(a: Vec3, b: Vec3) -> Vec3 { a.reject_from(b) }
    project_onto_normalized(a: Vec3, b: Vec3) -> Vec3 { a.project_onto_normalized(b) }
    reject_from_normalized(a: Vec3, b: Vec3) -> Vec3 { a.reject_from_normalized(b) }
    reflect(a: Vec3, b: Vec3) -> Vec3 { a.reflect(b) }
    clamp(a: Vec3, b: Vec3, c: Vec3) -> Vec3 { a.clamp(b, c) }
    refract(a: Vec3, b: Vec3, c: f32) -> Vec3 { a.refract(b, c) }
    refract_units(a: Vec3, b: Vec3, c: f32) -> Vec3 { a.normalize().refract(b.normalize(), c) }
    lerp_monotonic(a: Vec3, b: Vec3, s: f32) -> Vec3 { a.lerp_monotonic(b, s) }
    smoothstep(a: Vec3, b: Vec3, c: Vec3) -> Vec3 { a.smoothstep(b, c) }
    clamp_length(a: Vec3, b: f32, c: f32) -> [Vec3; 3] { [a.clamp_length(b, c), a.clamp_length_min(b), a.clamp_length_max(c)] }
    cross(a: Vec3, b: Vec3) -> Vec3 { a.cross(b) }
    any_orthogonal_vector(a: Vec3) -> Vec3 { a.any_orthogonal_vector() }
    any_orthonormal_vector(a: Vec3) -> Vec3 { a.any_orthonormal_vector() }
    any_orthonormal_pair(a: Vec3) -> (Vec3, Vec3) { a.any_orthonormal_pair() }
    swizzles(a: Vec3) -> [Vec3; 4] { [a.zyx(), a.xy().extend(a.z), a.zzy(), a.yxzx().yzw()] }
}

operations! { of_vec4: Any SameIfFinite;
    add(a: Vec4, b: Vec4) -> Vec4 { a + b }
    add_number(a: Vec4, b: f32) -> [Vec4; 2] { [a + b, b + a] }
    sub(a: Vec4, b: Vec4) -> Vec4 { a - b }
    sub_number(a: Vec4, b: f32) -> [Vec4; 2] { [a - b, b - a] }
    mul(a: Vec4, b: Vec4) -> Vec4 { a * b }
    mul_number(a: Vec4, b: f32) -> [Vec4; 2] { [a * b, b * a] }
    div(a: Vec4, b: Vec4) -> Vec4 { a / b }
    div_number(a: Vec4, b: f32) -> [Vec4; 2] { [a / b, b / a] }
    neg(a: Vec4) -> Vec4 { -a }
    equal(a: Vec4, b: Vec4) -> [bool; 2] { [a == b, a != b] }
    abs(a: Vec4) -> Vec4 { a.abs() }
    floor(a: Vec4) -> Vec4 { a.floor() }
    ceil(a: Vec4) -> Vec4 { a.ceil() }
    trunc(a: Vec4) -> Vec4 { a.trunc() }
    round(a: Vec4) -> Vec4 { a.round() }
    sqrt(a: Vec4) -> Vec4 { a.sqrt() }
    fract(a: Vec4) -> Vec4 { a.fract() }
    fract_gl(a: Vec4) -> Vec4 { a.fract_gl() }
    signum(a: Vec4) -> Vec4 { a.signum() }
    recip(a: Vec4) -> Vec4 { a.recip() }
    copysign(a: Vec4, b: Vec4) -> Vec4 { a.copysign(b) }
    step(a: Vec4, b: Vec4) -> Vec4 { a.step(b) }
    midpoint(a: Vec4, b: Vec4) -> Vec4 { a.midpoint(b) }
    lerp(a: Vec4, b: Vec4, s: f32) -> Vec4 { a.lerp(b, s) }
    classes(a: Vec4) -> [bool; 5] { [a.is_nan(), a.is_finite(), a.is_nan_mask().any(), a.is_finite_mask().all(), a.is_negative_mask().any()] }
    abs_diff_eq(a: Vec4, b: Vec4, c: f32) -> bool { a.abs_diff_eq(b, c) }
    comparisons(a: Vec4, b: Vec4) -> [u32; 6] { [a.cmpeq(b).bitmask(), a.cmpne(b).bitmask(), a.cmplt(b).bitmask(), a.cmple(b).bitmask(), a.cmpgt(b).bitmask(), a.cmpge(b).bitmask()] }
    masked(a: Vec4, b: Vec4) -> Vec4 { Vec4::select(a.cmplt(b) | !b.cmpge(a), a, b) }
    any_and_all(a: Vec4, b: Vec4) -> [bool; 2] { [any(a.cmplt(b)), all(a.cmplt(b) ^ a.cmpgt(b))] }
    select_function(c: bool, a: Vec4, b: Vec4) -> Vec4 { select(c, a, b) }
    min_and_max(a: Vec4, b: Vec4) -> [Vec4; 2] { [min(a, b), max(a, b)] }
    clamp_function(a: Vec4, b: Vec4, c: Vec4) -> Vec4 { clamp(a, b, c) }
    to_integers(a: Vec4) -> (IVec4, UVec4) { (a.as_ivec4(), a.as_uvec4()) }
    to_array(a: Vec4) -> [f32; 4] { a.to_array() }
    members(a: Vec4, b: f32) -> Vec4 { let mut v = a; v.x = v.y * b; v.y = v.z * b; v.z = v.w * b; v.w = v.x * b; v += b; v.x -= a.y; v }
    with_components(a: Vec4, b: f32) -> Vec4 { a.with_x(a.w - b).with_y(a.z - b).with_z(a.y - b).with_w(a.x - b) }
    truncate(a: Vec4) -> Vec3 { a.truncate() }
    constants(a: Vec4) -> [Vec4; 2] { [a * Vec4::ZERO + Vec4::ONE, Vec4::splat(a.x) - Vec4::Y] }
    dot_function(a: Vec4, b: Vec4) -> f32 { dot(a, b) }
    length_function(a: Vec4) -> f32 { length(a) }
    distance_function(a: Vec4, b: Vec4) -> f32 { distance(a, b) }
    normalize_function(a: Vec4) -> Vec4 { normalize(a) }
    swizzles(a: Vec4) -> [Vec4; 4] { [a.wzyx(), a.xyz().extend(a.w), a.zw().xyxy(), a.wwwx()] }
}

operations! { of_ivec2: Any Same;
    and(a: IVec2, b: IVec2) -> IVec2 { a & b }
    and_number(a: IVec2, b: i32) -> IVec2 { (a & b) & 5 }
    or(a: IVec2, b: IVec2) -> IVec2 { a | b }
    or_number(a: IVec2, b: i32) -> IVec2 { (a | b) | 5 }
    xor(a: IVec2, b: IVec2) -> IVec2 { a ^ b }
    xor_number(a: IVec2, b: i32) -> IVec2 { (a ^ b) ^ 5 }
    not(a: IVec2) -> IVec2 { !a }
    equal(a: IVec2, b: IVec2) -> [bool; 2] { [a == b, a != b] }
    shl(a: IVec2, n: u32, k: i32, b: UVec2, c: IVec2) -> [IVec2; 4] { [a << (n & 31), a << (k & 31), a << (b & 31), a << (c & 31)] }
    shr(a: IVec2, n: u32, k: i32, b: UVec2, c: IVec2) -> [IVec2; 4] { [a >> (n & 31), a >> (k & 31), a >> (b & 31), a >> (c & 31)] }
    wrapping_add(a: IVec2, b: IVec2) -> IVec2 { a.wrapping_add(b) }
    wrapping_sub(a: IVec2, b: IVec2) -> IVec2 { a.wrapping_sub(b) }
    wrapping_mul(a: IVec2, b: IVec2) -> IVec2 { a.wrapping_mul(b) }
    saturating_add(a: IVec2, b: IVec2) -> IVec2 { a.saturating_add(b) }
    saturating_sub(a: IVec2, b: IVec2) -> IVec2 { a.saturating_sub(b) }
    min(a: IVec2, b: IVec2) -> IVec2 { a.min(b) }
    max(a: IVec2, b: IVec2) -> IVec2 { a.max(b) }
    min_element(a: IVec2) -> i32 { a.min_element() }
    max_element(a: IVec2) -> i32 { a.max_element() }
    min_and_max(a: IVec2, b: IVec2) -> [IVec2; 2] { [min(a, b), max(a, b)] }
    clamp(a: IVec2) -> IVec2 { a.clamp(IVec2::ONE, IVec2::splat(9)) }
    comparisons(a: IVec2, b: IVec2) -> [u32; 6] { [a.cmpeq(b).bitmask(), a.cmpne(b).bitmask(), a.cmplt(b).bitmask(), a.cmple(b).bitmask(), a.cmpgt(b).bitmask(), a.cmpge(b).bitmask()] }
    masked(a: IVec2, b: IVec2) -> IVec2 { IVec2::select(a.cmplt(b), a, b) }
    conversions(a: IVec2) -> (Vec2, UVec2) { (a.as_vec2(), a.as_uvec2()) }
    signum(a: IVec2) -> IVec2 { a.signum() }
    swizzles(a: IVec2) -> [IVec2; 3] { [a.yx(), a.xx(), a.yxy().zy()] }
    constants(a: IVec2) -> [IVec2; 3] { [a ^ IVec2::ONE, IVec2::splat(a.y), IVec2::MAX] }
}

operations! { of_ivec2_tame: Tame Same;
    add(a: IVec2, b: IVec2) -> IVec2 { a + b }
    add_number(a: IVec2, b: i32) -> [IVec2; 3] { [a + b, b + a, 7 + a] }
    sub(a: IVec2, b: IVec2) -> IVec2 { a - b }
    sub_number(a: IVec2, b: i32) -> [IVec2; 3] { [a - b, b - a, 7 - a] }
    mul(a: IVec2, b: IVec2) -> IVec2 { a * b }
    mul_number(a: IVec2, b: i32) -> [IVec2; 3] { [a * b, b * a, 7 * a] }
    div(a: IVec2, b: IVec2) -> IVec2 { a / (b | 1) }
    div_number(a: IVec2, b: i32) -> [IVec2; 2] { [a / (b | 1), b / (a | 1)] }
    rem(a: IVec2, b: IVec2) -> IVec2 { a % (b | 1) }
    rem_number(a: IVec2, b: i32) -> [IVec2; 2] { [a % (b | 1), b % (a | 1)] }
    dot(a: IVec2, b: IVec2) -> i32 { a.dot(b) }
    distance_squared(a: IVec2, b: IVec2) -> i32 { a.distance_squared(b) }
    length_squared(a: IVec2) -> i32 { a.length_squared() }
    element_sum(a: IVec2) -> i32 { a.element_sum() }
    element_product(a: IVec2) -> i32 { (a % 9).element_product() }
    dot_function(a: IVec2, b: IVec2) -> i32 { dot(a, b) }
    neg(a: IVec2) -> IVec2 { -a }
    abs(a: IVec2) -> IVec2 { a.abs() }
    members(a: IVec2, b: i32) -> IVec2 { let mut v = ivec2(a.y, a.x); v.y += b; v *= 3; v.x <<= 2; v }
    parts(a: IVec2, b: i32) -> IVec2 { a.extend(b).truncate() }
}

operations! { of_ivec3: Any Same;
    and(a: IVec3, b: IVec3) -> IVec3 { a & b }
    and_number(a: IVec3, b: i32) -> IVec3 { (a & b) & 5 }
    or(a: IVec3, b: IVec3) -> IVec3 { a | b }
    or_number(a: IVec3, b: i32) -> IVec3 { (a | b) | 5 }
    xor(a: IVec3, b: IVec3) -> IVec3 { a ^ b }
    xor_number(a: IVec3, b: i32) -> IVec3 { (a ^ b) ^ 5 }
    not(a: IVec3) -> IVec3 { !a }
    equal(a: IVec3, b: IVec3) -> [bool; 2] { [a == b, a != b] }
    shl(a: IVec3, n: u32, k: i32, b: UVec3, c: IVec3) -> [IVec3; 4] { [a << (n & 31), a << (k & 31), a << (b & 31), a << (c & 31)] }
    shr(a: IVec3, n: u32, k: i32, b: UVec3, c: IVec3) -> [IVec3; 4] { [a >> (n & 31), a >> (k & 31), a >> (b & 31), a >> (c & 31)] }
    wrapping_add(a: IVec3, b: IVec3) -> IVec3 { a.wrapping_add(b) }
    wrapping_sub(a: IVec3, b: IVec3) -> IVec3 { a.wrapping_sub(b) }
    wrapping_mul(a: IVec3, b: IVec3) -> IVec3 { a.wrapping_mul(b) }
    saturating_add(a: IVec3, b: IVec3) -> IVec3 { a.saturating_add(b) }
    saturating_sub(a: IVec3, b: IVec3) -> IVec3 { a.saturating_sub(b) }
    min(a: IVec3, b: IVec3) -> IVec3 { a.min(b) }
    max(a: IVec3, b: IVec3) -> IVec3 { a.max(b) }
    min_element(a: IVec3) -> i32 { a.min_element() }
    max_element(a: IVec3) -> i32 { a.max_element() }
    min_and_max(a: IVec3, b: IVec3) -> [IVec3; 2] { [min(a, b), max(a, b)] }
    clamp(a: IVec3) -> IVec3 { a.clamp(IVec3::ONE, IVec3::splat(9)) }
    comparisons(a: IVec3, b: IVec3) -> [u32; 6] { [a.cmpeq(b).bitmask(), a.cmpne(b).bitmask(), a.cmplt(b).bitmask(), a.cmple(b).bitmask(), a.cmpgt(b).bitmask(), a.cmpge(b).bitmask()] }
    masked(a: IVec3, b: IVec3) -> IVec3 { IVec3::select(a.cmplt(b), a, b) }
    conversions(a: IVec3) -> (Vec3, UVec3) { (a.as_vec3(), a.as_uvec3()) }
    signum(a: IVec3) -> IVec3 { a.signum() }
    swizzles(a: IVec3) -> [IVec3; 3] { [a.zyx(), a.xxz(), a.yz().yxx()] }
    constants(a: IVec3) -> [IVec3; 3] { [a ^ IVec3::ONE, IVec3::splat(a.y), IVec3::MAX] }
}

operations! { of_ivec3_tame: Tame Same;
    add(a: IVec3, b: IVec3) -> IVec3 { a + b }
    add_number(a: IVec3, b: i32) -> [IVec3; 3] { [a + b, b + a, 7 + a] }
    sub(a: IVec3, b: IVec3) -> IVec3 { a - b }
    sub_number(a: IVec3, b: i32) -> [IVec3; 3] { [a - b, b - a, 7 - a] }
    mul(a: IVec3, b: IVec3) -> IVec3 { a * b }
    mul_number(a: IVec3, b: i32) -> [IVec3; 3] { [a * b, b * a, 7 * a] }
    div(a: IVec3, b: IVec3) -> IVec3 { a / (b | 1) }
    div_number(a: IVec3, b: i32) -> [IVec3; 2] { [a / (b | 1), b / (a | 1)] }
    rem(a: IVec3, b: IVec3) -> IVec3 { a % (b | 1) }
    rem_number(a: IVec3, b: i32) -> [IVec3; 2] { [a % (b | 1), b % (a | 1)] }
    dot(a: IVec3, b: IVec3) -> i32 { a.dot(b) }
    distance_squared(a: IVec3, b: IVec3) -> i32 { a.distance_squared(b) }
    length_squared(a: IVec3) -> i32 { a.length_squared() }
    element_sum(a: IVec3) -> i32 { a.element_sum() }
    element_product(a: IVec3) -> i32 { (a % 9).element_product() }
    dot_function(a: IVec3, b: IVec3) -> i32 { dot(a, b) }
    neg(a: IVec3) -> IVec3 { -a }
    abs(a: IVec3) -> IVec3 { a.abs() }
    cross(a: IVec3, b: IVec3) -> IVec3 { a.cross(b) }
    members(a: IVec3, b: i32) -> IVec3 { let mut v = ivec3(a.z, a.y, a.x); v.y += b; v *= 3; v.x <<= 2; v }
    parts(a: IVec3, b: i32) -> IVec3 { a.truncate().extend(b) }
}

operations! { of_ivec4: Any Same;
    and(a: IVec4, b: IVec4) -> IVec4 { a & b }
    and_number(a: IVec4, b: i32) -> IVec4 { (a & b) & 5 }
    or(a: IVec4, b: IVec4) -> IVec4 { a | b }
    or_number(a: IVec4, b: i32) -> IVec4 { (a | b) | 5 }
    xor(a: IVec4, b: IVec4) -> IVec4 { a ^ b }
    xor_number(a: IVec4, b: i32) -> IVec4 { (a ^ b) ^ 5 }
    not(a: IVec4) -> IVec4 { !a }
    equal(a: IVec4, b: IVec4) -> [bool; 2] { [a == b, a != b] }
    shl(a: IVec4, n: u32, k: i32, b: UVec4, c: IVec4) -> [IVec4; 4] { [a << (n & 31), a << (k & 31), a << (b & 31), a << (c & 31)] }
    shr(a: IVec4, n: u32, k: i32, b: UVec4, c: IVec4) -> [IVec4; 4] { [a >> (n & 31), a >> (k & 31), a >> (b & 31), a >> (c & 31)] }
    wrapping_add(a: IVec4, b: IVec4) -> IVec4 { a.wrapping_add(b) }
    wrapping_sub(a: IVec4, b: IVec4) -> IVec4 { a.wrapping_sub(b) }
    wrapping_mul(a: IVec4, b: IVec4) -> IVec4 { a.wrapping_mul(b) }
    saturating_add(a: IVec4, b: IVec4) -> IVec4 { a.saturating_add(b) }
    saturating_sub(a: IVec4, b: IVec4) -> IVec4 { a.saturating_sub(b) }
    min(a: IVec4, b: IVec4) -> IVec4 { a.min(b) }
    max(a: IVec4, b: IVec4) -> IVec4 { a.max(b) }
    min_element(a: IVec4) -> i32 { a.min_element() }
    max_element(a: IVec4) -> i32 { a.max_element() }
    min_and_max(a: IVec4, b: IVec4) -> [IVec4; 2] { [min(a, b), max(a, b)] }
    clamp(a: IVec4) -> IVec4 { a.clamp(IVec4::ONE, IVec4::splat(9)) }
    comparisons(a: IVec4, b: IVec4) -> [u32; 6] { [a.cmpeq(b).bitmask(), a.cmpne(b).bitmask(), a.cmplt(b).bitmask(), a.cmple(b).bitmask(), a.cmpgt(b).bitmask(), a.cmpge(b).bitmask()] }
    masked(a: IVec4, b: IVec4) -> IVec4 { IVec4::select(a.cmplt(b), a, b) }
    conversions(a: IVec4) -> (Vec4, UVec4) { (a.as_vec4(), a.as_uvec4()) }
    signum(a: IVec4) -> IVec4 { a.signum() }
    swizzles(a: IVec4) -> [IVec4; 3] { [a.wzyx(), a.xxyw(), a.yz().extend(a.w).extend(a.x)] }
    constants(a: IVec4) -> [IVec4; 3] { [a ^ IVec4::ONE, IVec4::splat(a.y), IVec4::MAX] }
}

operations! { of_ivec4_tame: Tame Same;
    add(a: IVec4, b: IVec4) -> IVec4 { a + b }
    add_number(a: IVec4, b: i32) -> [IVec4; 3] { [a + b, b + a, 7 + a] }
    sub(a: IVec4, b: IVec4) -> IVec4 { a - b }
    sub_number(a: IVec4, b: i32) -> [IVec4; 3] { [a - b, b - a, 7 - a] }
    mul(a: IVec4, b: IVec4) -> IVec4 { a * b }
    mul_number(a: IVec4, b: i32) -> [IVec4; 3] { [a * b, b * a, 7 * a] }
    div(a: IVec4, b: IVec4) -> IVec4 { a / (b | 1) }
    div_number(a: IVec4, b: i32) -> [IVec4; 2] { [a / (b | 1), b / (a | 1)] }
    rem(a: IVec4, b: IVec4) -> IVec4 { a % (b | 1) }
    rem_number(a: IVec4, b: i32) -> [IVec4; 2] { [a % (b | 1), b % (a | 1)] }
    dot(a: IVec4, b: IVec4) -> i32 { a.dot(b) }
    distance_squared(a: IVec4, b: IVec4) -> i32 { a.distance_squared(b) }
    length_squared(a: IVec4) -> i32 { a.length_squared() }
    element_sum(a: IVec4) -> i32 { a.element_sum() }
    element_product(a: IVec4) -> i32 { (a % 9).element_product() }
    dot_function(a: IVec4, b: IVec4) -> i32 { dot(a, b) }
    neg(a: IVec4) -> IVec4 { -a }
    abs(a: IVec4) -> IVec4 { a.abs() }
    members(a: IVec4, b: i32) -> IVec4 { let mut v = ivec4(a.w, a.z, a.y, a.x); v.y += b; v *= 3; v.x <<= 2; v }
    parts(a: IVec4, b: i32) -> IVec4 { a.truncate().extend(b).with_y(a.w) }
}

operations! { of_uvec2: Any Same;
    and(a: UVec2, b: UVec2) -> UVec2 { a & b }
    and_number(a: UVec2, b: u32) -> UVec2 { (a & b) & 5 }
    or(a: UVec2, b: UVec2) -> UVec2 { a | b }
    or_number(a: UVec2, b: u32) -> UVec2 { (a | b) | 5 }
    xor(a: UVec2, b: UVec2) -> UVec2 { a ^ b }
    xor_number(a: UVec2, b: u32) -> UVec2 { (a ^ b) ^ 5 }
    not(a: UVec2) -> UVec2 { !a }
    equal(a: UVec2, b: UVec2) -> [bool; 2] { [a == b, a != b] }
    shl(a: UVec2, n: u32, k: i32, b: UVec2, c: IVec2) -> [UVec2; 4] { [a << (n & 31), a << (k & 31), a << (b & 31), a << (c & 31)] }
    shr(a: UVec2, n: u32, k: i32, b: UVec2, c: IVec2) -> [UVec2; 4] { [a >> (n & 31), a >> (k & 31), a >> (b & 31), a >> (c & 31)] }
    wrapping_add(a: UVec2, b: UVec2) -> UVec2 { a.wrapping_add(b) }
    wrapping_sub(a: UVec2, b: UVec2) -> UVec2 { a.wrapping_sub(b) }
    wrapping_mul(a: UVec2, b: UVec2) -> UVec2 { a.wrapping_mul(b) }
    saturating_add(a: UVec2, b: UVec2) -> UVec2 { a.saturating_add(b) }
    saturating_sub(a: UVec2, b: UVec2) -> UVec2 { a.saturating_sub(b) }
    min(a: UVec2, b: UVec2) -> UVec2 { a.min(b) }
    max(a: UVec2, b: UVec2) -> UVec2 { a.max(b) }
    min_element(a: UVec2) -> u32 { a.min_element() }
    max_element(a: UVec2) -> u32 { a.max_element() }
    min_and_max(a: UVec2, b: UVec2) -> [UVec2; 2] { [min(a, b), max(a, b)] }
    clamp(a: UVec2) -> UVec2 { a.clamp(UVec2::ONE, UVec2::splat(9)) }
    comparisons(a: UVec2, b: UVec2) -> [u32; 6] { [a.cmpeq(b).bitmask(), a.cmpne(b).bitmask(), a.cmplt(b).bitmask(), a.cmple(b).bitmask(), a.cmpgt(b).bitmask(), a.cmpge(b).bitmask()] }
    masked(a: UVec2, b: UVec2) -> UVec2 { UVec2::select(a.cmplt(b), a, b) }
    conversions(a: UVec2) -> (Vec2, IVec2) { (a.as_vec2(), a.as_ivec2()) }
    swizzles(a: UVec2) -> [UVec2; 3] { [a.yx(), a.xx(), a.yxy().zy()] }
    constants(a: UVec2) -> [UVec2; 3] { [a ^ UVec2::ONE, UVec2::splat(a.y), UVec2::MAX] }
}

operations! { of_uvec2_tame: Tame Same;
    add(a: UVec2, b: UVec2) -> UVec2 { a + b }
    add_number(a: UVec2, b: u32) -> [UVec2; 3] { [a + b, b + a, 7 + a] }
    sub(a: UVec2, b: UVec2) -> UVec2 { (a + 100) - b }
    sub_number(a: UVec2, b: u32) -> [UVec2; 3] { [(a + 100) - b, (b + 100) - a, 100 - a] }
    mul(a: UVec2, b: UVec2) -> UVec2 { a * b }
    mul_number(a: UVec2, b: u32) -> [UVec2; 3] { [a * b, b * a, 7 * a] }
    div(a: UVec2, b: UVec2) -> UVec2 { a / (b | 1) }
    div_number(a: UVec2, b: u32) -> [UVec2; 2] { [a / (b | 1), b / (a | 1)] }
    rem(a: UVec2, b: UVec2) -> UVec2 { a % (b | 1) }
    rem_number(a: UVec2, b: u32) -> [UVec2; 2] { [a % (b | 1), b % (a | 1)] }
    dot(a: UVec2, b: UVec2) -> u32 { a.dot(b) }
    length_squared(a: UVec2) -> u32 { a.length_squared() }
    element_sum(a: UVec2) -> u32 { a.element_sum() }
    element_product(a: UVec2) -> u32 { (a % 9).element_product() }
    dot_function(a: UVec2, b: UVec2) -> u32 { dot(a, b) }
    members(a: UVec2, b: u32) -> UVec2 { let mut v = uvec2(a.y, a.x); v.y += b; v *= 3; v.x <<= 2; v }
    parts(a: UVec2, b: u32) -> UVec2 { a.extend(b).truncate() }
}

operations! { of_uvec3: Any Same;
    and(a: UVec3, b: UVec3) -> UVec3 { a & b }
    and_number(a: UVec3, b: u32) -> UVec3 { (a & b) & 5 }
    or(a: UVec3, b: UVec3) -> UVec3 { a | b }
    or_number(a: UVec3, b: u32) -> UVec3 { (a | b) | 5 }
    xor(a: UVec3, b: UVec3) -> UVec3 { a ^ b }
    xor_number(a: UVec3, b: u32) -> UVec3 { (a ^ b) ^ 5 }
    not(a: UVec3) -> UVec3 { !a }
    equal(a: UVec3, b: UVec3) -> [bool; 2] { [a == b, a != b] }
    shl(a: UVec3, n: u32, k: i32, b: UVec3, c: IVec3) -> [UVec3; 4] { [a << (n & 31), a << (k & 31), a << (b & 31), a << (c & 31)] }
    shr(a: UVec3, n: u32, k: i32, b: UVec3, c: IVec3) -> [UVec3; 4] { [a >> (n & 31), a >> (k & 31), a >> (b & 31), a >> (c & 31)] }
    wrapping_add(a: UVec3, b: UVec3) -> UVec3 { a.wrapping_add(b) }
    wrapping_sub(a: UVec3, b: UVec3) -> UVec3 { a.wrapping_sub(b) }
    wrapping_mul(a: UVec3, b: UVec3) -> UVec3 { a.wrapping_mul(b) }
    saturating_add(a: UVec3, b: UVec3) -> UVec3 { a.saturating_add(b) }
    saturating_sub(a: UVec3, b: UVec3) -> UVec3 { a.saturating_sub(b) }
    min(a: UVec3, b: UVec3) -> UVec3 { a.min(b) }
    max(a: UVec3, b: UVec3) -> UVec3 { a.max(b) }
    min_element(a: UVec3) -> u32 { a.min_element() }
    max_element(a: UVec3) -> u32 { a.max_element() }
    min_and_max(a: UVec3, b: UVec3) -> [UVec3; 2] { [min(a, b), max(a, b)] }
    clamp(a: UVec3) -> UVec3 { a.clamp(UVec3::ONE, UVec3::splat(9)) }
    comparisons(a: UVec3, b: UVec3) -> [u32; 6] { [a.cmpeq(b).bitmask(), a.cmpne(b).bitmask(), a.cmplt(b).bitmask(), a.cmple(b).bitmask(), a.cmpgt(b).bitmask(), a.cmpge(b).bitmask()] }
    masked(a: UVec3, b: UVec3) -> UVec3 { UVec3::select(a.cmplt(b), a, b) }
    conversions(a: UVec3) -> (Vec3, IVec3) { (a.as_vec3(), a.as_ivec3()) }
    swizzles(a: UVec3) -> [UVec3; 3] { [a.zyx(), a.xxz(), a.yz().yxx()] }
    constants(a: UVec3) -> [UVec3; 3] { [a ^ UVec3::ONE, UVec3::splat(a.y), UVec3::MAX] }
}

operations! { of_uvec3_tame: Tame Same;
    add(a: UVec3, b: UVec3) -> UVec3 { a + b }
    add_number(a: UVec3, b: u32) -> [UVec3; 3] { [a + b, b + a, 7 + a] }
    sub(a: UVec3, b: UVec3) -> UVec3 { (a + 100) - b }
    sub_number(a: UVec3, b: u32) -> [UVec3; 3] { [(a + 100) - b, (b + 100) - a, 100 - a] }
    mul(a: UVec3, b: UVec3) -> UVec3 { a * b }
    mul_number(a: UVec3, b: u32) -> [UVec3; 3] { [a * b, b * a, 7 * a] }
    div(a: UVec3, b: UVec3) -> UVec3 { a / (b | 1) }
    div_number(a: UVec3, b: u32) -> [UVec3; 2] { [a / (b | 1), b / (a | 1)] }
    rem(a: UVec3, b: UVec3) -> UVec3 { a % (b | 1) }
    rem_number(a: UVec3, b: u32) -> [UVec3; 2] { [a % (b | 1), b % (a | 1)] }
    dot(a: UVec3, b: UVec3) -> u32 { a.dot(b) }
    length_squared(a: UVec3) -> u32 { a.length_squared() }
    element_sum(a: UVec3) -> u32 { a.element_sum() }
    element_product(a: UVec3) -> u32 { (a % 9).element_product() }
    dot_function(a: UVec3, b: UVec3) -> u32 { dot(a, b) }
    members(a: UVec3, b: u32) -> UVec3 { let mut v = uvec3(a.z, a.y, a.x); v.y += b; v *= 3; v.x <<= 2; v }
    parts(a: UVec3, b: u32) -> UVec3 { a.truncate().extend(b) }
}

operations! { of_uvec4: Any Same;
    and(a: UVec4, b: UVec4) -> UVec4 { a & b }
    and_number(a: UVec4, b: u32) -> UVec4 { (a & b) & 5 }
    or(a: UVec4, b: UVec4) -> UVec4 { a | b }
    or_number(a: UVec4, b: u32) -> UVec4 { (a | b) | 5 }
    xor(a: UVec4, b: UVec4) -> UVec4 { a ^ b }
    xor_number(a: UVec4, b: u32) -> UVec4 { (a ^ b) ^ 5 }
    not(a: UVec4) -> UVec4 { !a }
    equal(a: UVec4, b: UVec4) -> [bool; 2] { [a == b, a != b] }
    shl(a: UVec4, n: u32, k: i32, b: UVec4, c: IVec4) -> [UVec4; 4] { [a << (n & 31), a << (k & 31), a << (b & 31), a << (c & 31)] }
    shr(a: UVec4, n: u32, k: i32, b: UVec4, c: IVec4) -> [UVec4; 4] { [a >> (n & 31), a >> (k & 31), a >> (b & 31), a >> (c & 31)] }
    wrapping_add(a: UVec4, b: UVec4) -> UVec4 { a.wrapping_add(b) }
    wrapping_sub(a: UVec4, b: UVec4) -> UVec4 { a.wrapping_sub(b) }
    wrapping_mul(a: UVec4, b: UVec4) -> UVec4 { a.wrapping_mul(b) }
    saturating_add(a: UVec4, b: UVec4) -> UVec4 { a.saturating_add(b) }
    saturating_sub(a: UVec4, b: UVec4) -> UVec4 { a.saturating_sub(b) }
    min(a: UVec4, b: UVec4) -> UVec4 { a.min(b) }
    max(a: UVec4, b: UVec4) -> UVec4 { a.max(b) }
    min_element(a: UVec4) -> u32 { a.min_element() }
    max_element(a: UVec4) -> u32 { a.max_element() }
    min_and_max(a: UVec4, b: UVec4) -> [UVec4; 2] { [min(a, b), max(a, b)] }
    clamp(a: UVec4) -> UVec4 { a.clamp(UVec4::ONE, UVec4::splat(9)) }
    comparisons(a: UVec4, b: UVec4) -> [u32; 6] { [a.cmpeq(b).bitmask(), a.cmpne(b).bitmask(), a.cmplt(b).bitmask(), a.cmple(b).bitmask(), a.cmpgt(b).bitmask(), a.cmpge(b).bitmask()] }
    masked(a: UVec4, b: UVec4) -> UVec4 { UVec4::select(a.cmplt(b), a, b) }
    conversions(a: UVec4) -> (Vec4, IVec4) { (a.as_vec4(), a.as_ivec4()) }
    swizzles(a: UVec4) -> [UVec4; 3] { [a.wzyx(), a.xxyw(), a.yz().extend(a.w).extend(a.x)] }
    constants(a: UVec4) -> [UVec4; 3] { [a ^ UVec4::ONE, UVec4::splat(a.y), UVec4::MAX] }
}

operations! { of_uvec4_tame: Tame Same;
    add(a: UVec4, b: UVec4) -> UVec4 { a + b }
    add_number(a: UVec4, b: u32) -> [UVec4; 3] { [a + b, b + a, 7 + a] }
    sub(a: UVec4, b: UVec4) -> UVec4 { (a + 100) - b }
    sub_number(a: UVec4, b: u32) -> [UVec4; 3] { [(a + 100) - b, (b + 100) - a, 100 - a] }
    mul(a: UVec4, b: UVec4) -> UVec4 { a * b }
    mul_number(a: UVec4, b: u32) -> [UVec4; 3] { [a * b, b * a, 7 * a] }
    div(a: UVec4, b: UVec4) -> UVec4 { a / (b | 1) }
    div_number(a: UVec4, b: u32) -> [UVec4; 2] { [a / (b | 1), b / (a | 1)] }
    rem(a: UVec4, b: UVec4) -> UVec4 { a % (b | 1) }
    rem_number(a: UVec4, b: u32) -> [UVec4; 2] { [a % (b | 1), b % (a | 1)] }
    dot(a: UVec4, b: UVec4) -> u32 { a.dot(b) }
    length_squared(a: UVec4) -> u32 { a.length_squared() }
    element_sum(a: UVec4) -> u32 { a.element_sum() }
    element_product(a: UVec4) -> u32 { (a % 9).element_product() }
    dot_function(a: UVec4, b: UVec4) -> u32 { dot(a, b) }
    members(a: UVec4, b: u32) -> UVec4 { let mut v = uvec4(a.w, a.z, a.y, a.x); v.y += b; v *= 3; v.x <<= 2; v }
    parts(a: UVec4, b: u32) -> UVec4 { a.truncate().extend(b).with_y(a.w) }
}

operations! { of_masks: Any Same;
    operators(a: BVec3, b: BVec3) -> [BVec3; 4] { [a & b, a | b, a ^ b, !a] }
    equal(a: BVec4, b: BVec4) -> [bool; 2] { [a == b, a != b] }
    reductions(a: BVec2, b: BVec3, c: BVec4) -> [bool; 6] {
        [a.any(), a.all(), b.any(), b.all(), any(c), all(c)]
    }
    made(a: bool, b: bool) -> (BVec2, BVec3, BVec4) {
        (bvec2(a, b), BVec3::new(a, true, b), bvec4(a, b, a & b, false))
    }
    chosen(c: BVec3, a: IVec3, b: IVec3) -> IVec3 { IVec3::select(c, a, b) }
    select_of_masks(c: bool, a: BVec3, b: BVec3) -> BVec3 { select(c, a, b) }
}

operations! { of_matrices: Any SameIfFinite;
    mat3_mul_vec3(m: Mat3, v: Vec3) -> [Vec3; 2] { [m * v, m.mul_vec3(v)] }
    mat3_mul_mat3(a: Mat3, b: Mat3) -> Mat3 { a * b }
    mat3_sums(a: Mat3, b: Mat3, s: f32) -> [Mat3; 5] { [a + b, a - b, a * s, s * a, -a] }
    mat3_transpose(m: Mat3) -> Mat3 { m.transpose() }
    mat3_determinant(m: Mat3) -> [f32; 2] { [m.determinant(), determinant(m)] }
    mat3_inverse(m: Mat3) -> Mat3 { m.inverse() }
    mat3_inverse_function(m: Mat3) -> Mat3 { inverse(m) }
    mat3_made(a: Vec3, m: Mat4) -> [Mat3; 4] {
        [
            Mat3::from_cols(a, a.zyx(), a.xxx()),
            Mat3::from_diagonal(a),
            Mat3::from_mat4(m),
            mat3(a, m.x_axis.xyz(), Vec3::Y),
        ]
    }
    mat3_members(m: Mat3, v: Vec3) -> Mat3 {
        let mut m = m;
        m.x_axis = v;
        m.y_axis.z *= 2.0;
        m
    }
    mat4_mul_vec4(m: Mat4, v: Vec4) -> [Vec4; 2] { [m * v, m.mul_vec4(v)] }
    mat4_mul_mat4(a: Mat4, b: Mat4) -> Mat4 { a * b }
    mat4_sums(a: Mat4, b: Mat4, s: f32) -> [Mat4; 5] { [a + b, a - b, a * s, s * a, -a] }
    mat4_transpose(m: Mat4) -> Mat4 { m.transpose() }
    mat4_transform(m: Mat4, v: Vec3) -> [Vec3; 3] {
        [m.transform_point3(v), m.transform_vector3(v), m.project_point3(v)]
    }
    mat4_transform_function(m: Mat4, v: Vec3) -> [Vec3; 2] {
        [transform_point(m, v), transform_vector(m, v)]
    }
    mat4_determinant_function(m: Mat4) -> f32 { determinant(m) }
    mat4_inverse_function(m: Mat4) -> Mat4 { inverse(m) }
    mat4_made(a: Vec4, m: Mat3) -> [Mat4; 5] {
        [
            Mat4::from_cols(a, a.wzyx(), a.xxxx(), Vec4::W),
            Mat4::from_diagonal(a),
            Mat4::from_mat3(m),
            Mat4::from_scale(a.truncate()),
            Mat4::from_translation(a.xyz()) * Mat4::IDENTITY,
        ]
    }
    affine3_mul(a: Affine3, b: Affine3) -> Affine3 { a * b }
    affine3_transform(a: Affine3, v: Vec3) -> [Vec3; 2] {
        [a.transform_point3(v), a.transform_vector3(v)]
    }
    affine3_transform_function(a: Affine3, v: Vec3) -> [Vec3; 2] {
        [transform_point(a, v), transform_vector(a, v)]
    }
    affine3_inverse(a: Affine3) -> Affine3 { a.inverse() }
    affine3_inverse_function(a: Affine3) -> Affine3 { inverse(a) }
    affine3_made(m: Mat3, v: Vec3) -> [Affine3; 5] {
        [
            Affine3::from_cols(v, m.x_axis, m.y_axis, m.z_axis),
            Affine3::from_mat3(m),
            Affine3::from_mat3_translation(m, v),
            Affine3::from_scale(v),
            Affine3::from_translation(v),
        ]
    }
}
