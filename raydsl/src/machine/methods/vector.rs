//! Methods of glam's vectors, each in glam's order of operations.
//!
//! Operations that glam computes alike on every platform are here for all vectors. `Vec4` is stored
//! in a register of SSE2, NEON or wasm, where its sums over components have another order than in
//! scalar code, and its `min` another result for NaN: those methods are denied, and the error names
//! the prelude's replacement.

use core::cell::Cell;

use super::super::{
    B, BoolBinary, Coerce, Compare, F, I, Machine, Op, U, V2, V3, V4, X2, X3, X4, op,
    vector::{Arithmetic, Component, Floats, IsVector, Vector, cast_each},
};
use super::float::{
    Signed, add, beside_infinity, compare, copysign, div, mul, number, round, select, sign_bit,
    sub, unary,
};
use super::{Method, name};

/// Returns the sum of products, left to right.
#[inline(always)]
pub(crate) fn dot<M, C, V>(m: &M, a: V, b: V) -> C
where
    M: Machine,
    C: Arithmetic<M>,
    V: Vector<M, Component = C, Of<C> = V>,
{
    let products = a.both(
        b,
        #[inline(always)]
        |x: C, y: C| C::binary(m, op::Mul, x, y),
    );
    sum(m, products)
}

#[inline(always)]
fn sum<M: Machine, V: Vector<M>>(m: &M, a: V) -> V::Component
where
    V::Component: Arithmetic<M>,
{
    a.fold(
        #[inline(always)]
        |x, y| V::Component::binary(m, op::Add, x, y),
    )
}

#[inline(always)]
fn length<M: Machine, V: Floats<M>>(m: &M, a: V) -> F<M> {
    unary(m, op::Sqrt, dot(m, a, a))
}

#[inline(always)]
fn reciprocal_length<M: Machine, V: Floats<M>>(m: &M, a: V) -> F<M> {
    div(m, number(m, 1.0), length(m, a))
}

#[inline(always)]
pub(crate) fn normalize<M: Machine, V: Floats<M>>(m: &M, a: V) -> V {
    scaled(m, a, reciprocal_length(m, a))
}

#[inline(always)]
fn scaled<M: Machine, V: Floats<M>>(m: &M, a: V, s: F<M>) -> V {
    V::arithmetic(m, op::Mul, a, V::of_one(s))
}

#[inline(always)]
fn plus<M: Machine, V: Floats<M>>(m: &M, a: V, b: V) -> V {
    V::arithmetic(m, op::Add, a, b)
}

#[inline(always)]
fn minus<M: Machine, V: Vector<M, Component: Arithmetic<M>>>(m: &M, a: V, b: V) -> V {
    V::arithmetic(m, op::Sub, a, b)
}

#[inline(always)]
fn choose<M: Machine, V: Floats<M>>(m: &M, c: B<M>, a: V, b: V) -> V {
    a.both(
        b,
        #[inline(always)]
        |x, y| select(m, c, x, y),
    )
}

#[inline(always)]
fn normalize_or<M: Machine, V: Floats<M>>(m: &M, a: V, fallback: V) -> V {
    let scale = reciprocal_length(m, a);
    choose(m, is_usable(m, scale), scaled(m, a, scale), fallback)
}

/// Returns whether `scale` is the reciprocal of a length that is neither 0 nor infinite.
#[inline(always)]
fn is_usable<M: Machine>(m: &M, scale: F<M>) -> B<M> {
    let finite = beside_infinity(m, op::Lt, scale);
    let positive = compare(m, op::Gt, scale, number(m, 0.0));
    B(m.bool_binary(op::And, finite.0, positive.0))
}

#[inline(always)]
fn project_onto<M: Machine, V: Floats<M>>(m: &M, a: V, b: V) -> V {
    let size = dot(m, b, b);
    scaled(m, b, div(m, dot(m, a, b), size))
}

#[inline(always)]
fn refract<M: Machine, V: Floats<M>>(m: &M, a: V, normal: V, eta: F<M>) -> V {
    let cosine = dot(m, normal, a);
    let one = number(m, 1.0);
    let k = mul(m, mul(m, eta, eta), sub(m, one, mul(m, cosine, cosine)));
    let k = sub(m, one, k);
    let along = add(m, mul(m, eta, cosine), unary(m, op::Sqrt, k));
    let bent = minus(m, scaled(m, a, eta), scaled(m, normal, along));
    choose(m, compare(m, op::Ge, k, number(m, 0.0)), bent, V::zero(m))
}

/// Returns `limit * (a / length)` where the comparison of the squares holds.
#[inline(always)]
fn limit_length<M: Machine, V: Floats<M>, O: Op<Compare>>(
    m: &M,
    op: O,
    a: V,
    limit: F<M>,
    other: V,
) -> V {
    let square = dot(m, a, a);
    let unit = V::arithmetic(m, op::Div, a, V::of_one(unary(m, op::Sqrt, square)));
    let beyond = compare(m, op, square, mul(m, limit, limit));
    choose(m, beyond, scaled(m, unit, limit), other)
}

#[inline(always)]
fn clamp<M: Machine, V: Vector<M, Component: Arithmetic<M>>>(m: &M, a: V, low: V, high: V) -> V {
    V::extreme(m, op::Min, high, V::extreme(m, op::Max, low, a))
}

#[inline(always)]
fn join<M: Machine, V: Vector<M, Component = B<M>>>(m: &M, op: impl Op<BoolBinary>, a: V) -> B<M> {
    a.fold(
        #[inline(always)]
        |x, y| B(m.bool_binary(op, x.0, y.0)),
    )
}

macro_rules! each {
    ($($name:literal $bound:ident |$m:ident, $x:ident $(, $y:ident)?| -> $out:ident { $e:expr };)+) => {
        $(each!(@one $name $bound |$m, $x $(, $y)?| $out $e);)+
    };
    (@one $name:literal $bound:ident |$m:ident, $x:ident| $out:ident $e:expr) => {
        method!([C: $bound<M>, V: IsVector + Vector<M, Component = C>] V, $name,
            |$m, a| -> each!(@out $out C V) { a.each(#[inline(always)] |$x: C| $e) });
    };
    (@one $name:literal $bound:ident |$m:ident, $x:ident, $y:ident| $out:ident $e:expr) => {
        method!([C: $bound<M>, V: IsVector + Vector<M, Component = C, Of<C> = V>] V, $name,
            |$m, a, b: V| -> each!(@out $out C V) { a.both(b, #[inline(always)] |$x: C, $y: C| $e) });
    };
    (@out same $c:ident $v:ident) => { <$v as Vector<M>>::Of<$c> };
    (@out mask $c:ident $v:ident) => { <$v as Vector<M>>::Of<B<M>> };
}

each! {
    "cmpeq" Arithmetic |m, x, y| -> mask { C::compare(m, op::Eq, x, y) };
    "cmpne" Arithmetic |m, x, y| -> mask { C::compare(m, op::Ne, x, y) };
    "cmplt" Arithmetic |m, x, y| -> mask { C::compare(m, op::Lt, x, y) };
    "cmple" Arithmetic |m, x, y| -> mask { C::compare(m, op::Le, x, y) };
    "cmpgt" Arithmetic |m, x, y| -> mask { C::compare(m, op::Gt, x, y) };
    "cmpge" Arithmetic |m, x, y| -> mask { C::compare(m, op::Ge, x, y) };
    "signum" Signed |m, x| -> same { C::signum(m, x) };
}

/// Implements methods of float vectors of any size.
macro_rules! floats {
    ($($name:literal, |$m:ident, $s:ident $(, $a:ident: $at:ty)*| -> $out:ty { $e:expr };)+) => {
        $(method!([V: IsVector + Floats<M>] V, $name, |$m, $s $(, $a: $at)*| -> $out { $e });)+
    };
}

floats! {
    "floor", |m, a| -> V { V::unary(m, op::Floor, a) };
    "ceil", |m, a| -> V { V::unary(m, op::Ceil, a) };
    "trunc", |m, a| -> V { V::unary(m, op::Trunc, a) };
    "sqrt", |m, a| -> V { V::unary(m, op::Sqrt, a) };
    "round", |m, a| -> V { a.each(#[inline(always)] |x| round(m, x)) };
    "fract", |m, a| -> V { minus(m, a, V::unary(m, op::Trunc, a)) };
    "fract_gl", |m, a| -> V { minus(m, a, V::unary(m, op::Floor, a)) };
    "recip", |m, a| -> V {
        V::arithmetic(m, op::Div, V::of_one(number(m, 1.0)), a)
    };
    "copysign", |m, a, b: V| -> V { a.both(b, #[inline(always)] |x, y| copysign(m, x, y)) };
    "lerp", |m, a, b: V, s: F<M>| -> V {
        plus(m, scaled(m, a, sub(m, number(m, 1.0), s)), scaled(m, b, s))
    };
    "midpoint", |m, a, b: V| -> V { scaled(m, plus(m, a, b), number(m, 0.5)) };
    "step", |m, edge, a: V| -> V {
        edge.both(a, #[inline(always)] |edge, a| {
            select(m, compare(m, op::Lt, a, edge), number(m, 0.0), number(m, 1.0))
        })
    };
    "is_nan_mask", |m, a| -> V::Of<B<M>> {
        a.each(#[inline(always)] |x| beside_infinity(m, op::Gt, x))
    };
    "is_finite_mask", |m, a| -> V::Of<B<M>> {
        a.each(#[inline(always)] |x| beside_infinity(m, op::Lt, x))
    };
    "is_negative_mask", |m, a| -> V::Of<B<M>> {
        a.each(#[inline(always)] |x| sign_bit(m, op::Lt, x))
    };
    "is_nan", |m, a| -> B<M> {
        join(m, op::Or, a.each(#[inline(always)] |x| beside_infinity(m, op::Gt, x)))
    };
    "is_finite", |m, a| -> B<M> {
        join(m, op::And, a.each(#[inline(always)] |x| beside_infinity(m, op::Lt, x)))
    };
    "abs_diff_eq", |m, a, b: V, most: F<M>| -> B<M> {
        join(m, op::And, V::unary(m, op::Abs, minus(m, a, b)).each(
            #[inline(always)]
            |x| compare(m, op::Le, x, most),
        ))
    };
}

/// Implements sums over components and the least and greatest component: for every vector but
/// `Vec4`.
macro_rules! in_order {
    ($([$($g:tt)*] $v:ty, $c:ty;)+) => {
        $(
            method!([$($g)*] $v, "dot", |m, a, b: $v| -> $c { dot(m, a, b) });
            method!([$($g)*] $v, "length_squared", |m, a| -> $c { dot(m, a, a) });
            method!([$($g)*] $v, "distance_squared", |m, a, b: $v| -> $c {{
                let way = minus(m, a, b);
                dot(m, way, way)
            }});
            method!([$($g)*] $v, "element_sum", |m, a| -> $c { sum(m, a) });
            method!([$($g)*] $v, "element_product", |m, a| -> $c {
                a.fold(#[inline(always)] |x, y| <$c>::binary(m, op::Mul, x, y))
            });
            method!([$($g)*] $v, "min", |m, a, b: $v| -> $v { Vector::extreme(m, op::Min, b, a) });
            method!([$($g)*] $v, "max", |m, a, b: $v| -> $v { Vector::extreme(m, op::Max, b, a) });
            method!([$($g)*] $v, "clamp", |m, a, low: $v, high: $v| -> $v {
                clamp(m, a, low, high)
            });
            method!([$($g)*] $v, "min_element", |m, a| -> $c {
                a.fold_back(#[inline(always)] |x, y| Arithmetic::extreme(m, op::Min, x, y))
            });
            method!([$($g)*] $v, "max_element", |m, a| -> $c {
                a.fold_back(#[inline(always)] |x, y| Arithmetic::extreme(m, op::Max, x, y))
            });
        )+
    };
}

in_order! {
    [E: Arithmetic<M>] X2<E>, E;
    [E: Arithmetic<M>] X3<E>, E;
    [] X4<I<M>>, I<M>;
    [] X4<U<M>>, U<M>;
}

macro_rules! floats_in_order {
    ($v:ident: $($name:literal, |$m:ident, $s:ident $(, $a:ident: $at:ty)*| -> $out:ty { $e:expr };)+) => {
        $(method!([] $v<M>, $name, |$m, $s $(, $a: $at)*| -> $out { $e });)+
    };
    ($($v:ident),+) => {
        $(
            floats_in_order! { $v:
                "length", |m, a| -> F<M> { length(m, a) };
                "length_recip", |m, a| -> F<M> { reciprocal_length(m, a) };
                "distance", |m, a, b: $v<M>| -> F<M> { length(m, minus(m, a, b)) };
                "normalize", |m, a| -> $v<M> { normalize(m, a) };
                "normalize_or", |m, a, b: $v<M>| -> $v<M> { normalize_or(m, a, b) };
                "normalize_or_zero", |m, a| -> $v<M> {
                    normalize_or(m, a, $v::splat(number(m, 0.0)))
                };
                "is_normalized", |m, a| -> B<M> {{
                    let off = sub(m, dot(m, a, a), number(m, 1.0));
                    compare(m, op::Le, unary(m, op::Abs, off), number(m, 2e-4))
                }};
                "project_onto", |m, a, b: $v<M>| -> $v<M> { project_onto(m, a, b) };
                "reject_from", |m, a, b: $v<M>| -> $v<M> { minus(m, a, project_onto(m, a, b)) };
                "project_onto_normalized", |m, a, b: $v<M>| -> $v<M> {
                    scaled(m, b, dot(m, a, b))
                };
                "reject_from_normalized", |m, a, b: $v<M>| -> $v<M> {
                    minus(m, a, scaled(m, b, dot(m, a, b)))
                };
                "reflect", |m, a, normal: $v<M>| -> $v<M> {{
                    let twice = mul(m, number(m, 2.0), dot(m, a, normal));
                    minus(m, a, scaled(m, normal, twice))
                }};
                "refract", |m, a, normal: $v<M>, eta: F<M>| -> $v<M> {
                    refract(m, a, normal, eta)
                };
                "lerp_monotonic", |m, a, b: $v<M>, s: F<M>| -> $v<M> {
                    plus(m, a, scaled(m, minus(m, b, a), s))
                };
                "saturate", |m, a| -> $v<M> {
                    clamp(m, a, $v::splat(number(m, 0.0)), $v::splat(number(m, 1.0)))
                };
                "smoothstep", |m, a, edge0: $v<M>, edge1: $v<M>| -> $v<M> {{
                    let of = |v| $v::splat(number(m, v));
                    let t = Vector::arithmetic(
                        m, op::Div, minus(m, a, edge0), minus(m, edge1, edge0),
                    );
                    let t = clamp(m, t, of(0.0), of(1.0));
                    let times = |a, b| Vector::arithmetic(m, op::Mul, a, b);
                    times(times(t, t), minus(m, of(3.0), times(of(2.0), t)))
                }};
                "clamp_length_max", |m, a, most: F<M>| -> $v<M> {
                    limit_length(m, op::Gt, a, most, a)
                };
                "clamp_length_min", |m, a, least: F<M>| -> $v<M> {
                    limit_length(m, op::Lt, a, least, a)
                };
                "clamp_length", |m, a, least: F<M>, most: F<M>| -> $v<M> {
                    limit_length(m, op::Lt, a, least, limit_length(m, op::Gt, a, most, a))
                };
            }
        )+
    };
}

floats_in_order!(V2, V3);

method!([] V2<M>, "perp", |m, a| -> V2<M> { V2 { x: Arithmetic::neg(m, a.y), y: a.x } });
method!([] V2<M>, "perp_dot", |m, a, b: V2<M>| -> F<M> {
    sub(m, mul(m, a.x, b.y), mul(m, a.y, b.x))
});

#[inline(always)]
pub(crate) fn cross<M: Machine, E: Arithmetic<M>>(m: &M, a: X3<E>, b: X3<E>) -> X3<E> {
    let mul = |x, y| E::binary(m, op::Mul, x, y);
    let minor = |x, y, z, w| E::binary(m, op::Sub, mul(x, y), mul(z, w));
    X3 { x: minor(a.y, b.z, b.y, a.z), y: minor(a.z, b.x, b.z, a.x), z: minor(a.x, b.y, b.x, a.y) }
}

method!([E: Arithmetic<M>] X3<E>, "cross", |m, a, b: X3<E>| -> X3<E> { cross(m, a, b) });
method!([] V3<M>, "any_orthogonal_vector", |m, a| -> V3<M> {{
    let size = |x| unary(m, op::Abs, x);
    let (zero, neg) = (number(m, 0.0), |x| Arithmetic::neg(m, x));
    let c = compare(m, op::Gt, size(a.x), size(a.y));
    choose(m, c, V3 { x: neg(a.z), y: zero, z: a.x }, V3 { x: zero, y: a.z, z: neg(a.y) })
}});
method!([] V3<M>, "any_orthonormal_vector", |m, a| -> V3<M> { orthonormal_pair(m, a).1 });
method!([] V3<M>, "any_orthonormal_pair", |m, a| -> (V3<M>, V3<M>) { orthonormal_pair(m, a) });

/// Builds an orthonormal basis as glam does, after Duff and others, "Building an Orthonormal Basis,
/// Revisited", JCGT 2017.
#[inline(always)]
fn orthonormal_pair<M: Machine>(m: &M, v: V3<M>) -> (V3<M>, V3<M>) {
    let sign = Signed::signum(m, v.z);
    let a = div(m, number(m, -1.0), add(m, sign, v.z));
    let b = mul(m, mul(m, v.x, v.y), a);
    let neg = |x| Arithmetic::neg(m, x);
    let along = mul(m, mul(m, mul(m, sign, v.x), v.x), a);
    let across = mul(m, mul(m, v.y, v.y), a);
    (
        V3 { x: add(m, number(m, 1.0), along), y: mul(m, sign, b), z: mul(m, neg(sign), v.x) },
        V3 { x: b, y: add(m, sign, across), z: neg(v.y) },
    )
}

macro_rules! absolute {
    ($($v:ident),+) => {
        $(
            method!([] $v<F<M>>, "abs", |m, a| -> $v<F<M>> {
                Floats::unary(m, op::Abs, a)
            });
            method!([] $v<I<M>>, "abs", |m, a| -> $v<I<M>> {
                a.each(#[inline(always)] |x| Signed::abs(m, x))
            });
        )+
    };
}

absolute!(X2, X3, X4);

macro_rules! fused {
    ($($v:ident: $($c:ident)+;)+) => {
        $(method!([] $v<M>, "mul_add", |m, a, b: $v<M>, c: $v<M>| -> $v<M> {
            $v { $($c: F(m.f32_mul_add(a.$c.0, b.$c.0, c.$c.0))),+ }
        });)+
    };
}

fused!(V2: x y; V3: x y z; V4: x y z w;);

// Masks

method!([V: IsVector + Vector<M, Component = B<M>>] V, "any", |m, a| -> B<M> { join(m, op::Or, a) });
method!([V: IsVector + Vector<M, Component = B<M>>] V, "all", |m, a| -> B<M> { join(m, op::And, a) });
method!([V: IsVector + Vector<M, Component = B<M>>] V, "bitmask", |m, a| -> U<M> {{
    let place = Cell::new(0);
    let bits = a.each(#[inline(always)] |c| {
        let to = place.replace(place.get() + 1);
        U(m.u32_binary(op::Shl, m.bool_to_u32(c.0), m.u32(to)))
    });
    bits.fold(#[inline(always)] |x, y| U(m.u32_binary(op::Or, x.0, y.0)))
}});

// Sizes and parts

method!([E: Component<M>] X2<E>, "extend", |_m, a, z: E| -> X3<E> { X3 { x: a.x, y: a.y, z } });
method!([E: Component<M>] X3<E>, "extend", |_m, a, w: E| -> X4<E> {
    X4 { x: a.x, y: a.y, z: a.z, w }
});
method!([E: Component<M>] X3<E>, "truncate", |_m, a| -> X2<E> { X2 { x: a.x, y: a.y } });
method!([E: Component<M>] X4<E>, "truncate", |_m, a| -> X3<E> { X3 { x: a.x, y: a.y, z: a.z } });

macro_rules! parts {
    ($($v:ident $n:literal: $($name:literal $c:ident)+;)+) => {
        $(
            $(
                method!([E: Component<M>] $v<E>, $name, |_m, a, c: E| -> $v<E> {
                    $v { $c: c, ..a }
                });
            )+
            method!([E: Component<M>] $v<E>, "to_array", |_m, a| -> [E; $n] { a.components() });
        )+
    };
}

parts! {
    X2 2: "with_x" x "with_y" y;
    X3 3: "with_x" x "with_y" y "with_z" z;
    X4 4: "with_x" x "with_y" y "with_z" z "with_w" w;
}

macro_rules! conversions {
    ($($v:ident: $($name:literal $to:ident $host:ty),+;)+) => {
        $($(
            #[diagnostic::do_not_recommend]
            impl<M: Machine, E: Component<M> + super::super::OpCast<M, $host>>
                Method<{ name($name) }, M, ()> for $v<E>
            {
                type Output = $v<$to<M>>;

                #[inline(always)]
                fn call(self, m: &M, (): ()) -> $v<$to<M>> {
                    cast_each::<M, $v<E>, $host>(m, self)
                }
            }
        )+)+
    };
}

conversions! {
    X2: "as_vec2" F f32, "as_ivec2" I i32, "as_uvec2" U u32;
    X3: "as_vec3" F f32, "as_ivec3" I i32, "as_uvec3" U u32;
    X4: "as_vec4" F f32, "as_ivec4" I i32, "as_uvec4" U u32;
}

// Methods of `Vec4` whose result differs on another machine.

denied! { V4<M>:
    DotInOrder "`Vec4::dot` adds in another order on other machines"
        "write `dot(a, b)`, the function of raydsl's prelude, which adds left to right"
        "dot" -> F<M>;
    LengthInOrder "the length of a `Vec4` is another on other machines"
        "write `length(v)` or `distance(a, b)`, the functions of raydsl's prelude; the square of \
         a length is `dot(v, v)`"
        "length" "length_squared" "length_recip" "distance" "distance_squared" -> F<M>;
    LengthLimits "the length of a `Vec4` is another on other machines"
        "spell it out with `length(v)`, the function of raydsl's prelude"
        "clamp_length" "clamp_length_min" "clamp_length_max" "move_towards" -> V4<M>;
    NormalizeInOrder "`Vec4::normalize` has other results on other machines"
        "write `normalize(v)`, the function of raydsl's prelude"
        "normalize" "normalize_or" "normalize_or_zero" -> V4<M>;
    NormalizedInOrder "the length of a `Vec4` is another on other machines"
        "write `(dot(v, v) - 1.0).abs() <= 2e-4`, with `dot` of raydsl's prelude"
        "is_normalized" -> B<M>;
    ProjectInOrder "this method of `Vec4` adds in another order on other machines"
        "spell it out with `dot(a, b)`, the function of raydsl's prelude"
        "project_onto" "project_onto_normalized" "reject_from" "reject_from_normalized" "reflect"
        "refract" -> V4<M>;
    SumInOrder "this method of `Vec4` takes the components in another order on other machines"
        "write `v.x + v.y + v.z + v.w`, or the like with `*`"
        "element_sum" "element_product" -> F<M>;
    ExtremeOfNumbers "`min` and `max` of `Vec4` have other results for NaN on other machines"
        "write `min(a, b)`, `max(a, b)` or `clamp(v, low, high)`, the functions of raydsl's prelude"
        "min" "max" "clamp" "saturate" "smoothstep" -> V4<M>;
    ExtremeElement "the least element of a `Vec4` is another for NaN on other machines"
        "write `min(min(v.x, v.y), min(v.z, v.w))`, or `max`, of raydsl's prelude"
        "min_element" "max_element" -> F<M>;
    Unfused "`Vec4::lerp_monotonic` is fused on some machines"
        "write `a + (b - a) * s`"
        "lerp_monotonic" -> V4<M>;
}
