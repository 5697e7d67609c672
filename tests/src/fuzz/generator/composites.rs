//! Templates of vectors, structs, tuples, arrays and enums.

/// Of `Vec3`.
pub(super) const VEC3: &[&str] = &[
    "vec3({f}, {f}, {f})",
    "Vec3::new({f}, {f}, {f})",
    "Vec3::splat({f})",
    "({v} + {v})",
    "({v} - {v})",
    "({v} * {v})",
    "({v} / {v})",
    "({v} * {f})",
    "({f} * {v})",
    "({v} / {f})",
    "(2.0 * {v})",
    "(-{v})",
    "{v}.cross({v})",
    "{v}.min({v})",
    "{v}.max({v})",
    "{v}.abs()",
    "{v}.floor()",
    "{v}.ceil()",
    "{v}.trunc()",
    "{v}.normalize()",
    "{v}.extend({f}).truncate()",
    "{n}.v",
    "{v}.zyx()",
    "{v}.yyx()",
    "{w}.xyx()",
    "{q}.xyz()",
    "{q}.truncate()",
    "{v}.lerp({v}, 0.5)",
    "{v}.fract()",
    "{v}.signum()",
    "{v}.with_y({f})",
    "select({b}, {v}, {v})",
    "Vec3::select({m}, {v}, {v})",
    "{j}.as_vec3()",
    "{w}.extend({f})",
    "clamp({v}, {v}, {v})",
];

/// Of `Small`.
pub(super) const SMALL: &[&str] = &[
    "(Small { i: {i}, t: {b}, y: {f}, m: {u} })",
    "(Small { m: {u}, y: {f}, i: {i}, t: {b} })",
    "(Small { y: {f}, ..{s} })",
    "(Small { m: {u}, t: {b}, ..{s} })",
    "Small::of({u})",
    "!{s}.chosen({s}, {f})",
    "{n}.s",
    "{h}[0]",
    "!{h}[{u} as usize & 1]",
    "smalls[{u} as usize % smalls.len()]",
    "(if {Z} < smalls.len() { smalls[{Z}] } else { {s} })",
];

/// Of `Nested`.
pub(super) const NESTED: &[&str] = &[
    "(Nested { v: {v}, s: {s}, k: {u} })",
    "(Nested { s: {s}, ..{n} })",
    "(Nested { v: {v}, k: {u}, ..{n} })",
    "Nested::of({u})",
    "!{n}.moved({v}, {u})",
];

/// Of `Vec2`.
pub(super) const VEC2: &[&str] = &[
    "vec2({f}, {f})",
    "Vec2::new({f}, {f})",
    "Vec2::splat({f})",
    "({w} + {w})",
    "({w} - {w})",
    "({w} * {w})",
    "({w} * {f})",
    "({w} / {f})",
    "(-{w})",
    "{w}.yx()",
    "{v}.xz()",
    "{w}.min({w})",
    "{w}.perp()",
    "{w}.floor()",
    "{w}.normalize_or_zero()",
    "select({b}, {w}, {w})",
    "{o}.p",
    "{d}.as_vec2()",
];

/// Of `Vec4`.
pub(super) const VEC4: &[&str] = &[
    "vec4({f}, {f}, {f}, {f})",
    "Vec4::splat({f})",
    "{v}.extend({f})",
    "({q} + {q})",
    "({q} - {q})",
    "({q} * {q})",
    "({q} * {f})",
    "({f} * {q})",
    "({q} / {f})",
    "{q}.wzyx()",
    "{q}.zzxy()",
    "{q}.abs()",
    "{q}.round()",
    "{w}.xyyx()",
    "select({b}, {q}, {q})",
    "{q}.with_z({f})",
];

/// Of `IVec3`.
pub(super) const IVEC3: &[&str] = &[
    "ivec3({i}, {i}, {i})",
    "IVec3::splat({i})",
    "{j}.wrapping_add({j})",
    "{j}.wrapping_mul({j})",
    "{j}.wrapping_sub({j})",
    "({j} & {j})",
    "({j} | {j})",
    "({j} ^ {j})",
    "({j} & 0xffi32)",
    "(!{j})",
    "({j} >> 2i32)",
    "({j} << 3i32)",
    "(-({j} >> 1i32))",
    "(({j} & 0xffffi32) + ({j} & 0xffffi32))",
    "(({j} & 0xfffi32) - 7)",
    "({j} / 7i32)",
    "({j} % ivec3(3, 5, 7))",
    "{j}.zyx()",
    "{j}.yyx()",
    "{j}.min({j})",
    "{j}.clamp(IVec3::splat(-5), IVec3::splat(9))",
    "{j}.signum()",
    "({j} >> 1i32).abs()",
    "{j}.rem_euclid(IVec3::splat(5))",
    "IVec3::select({m}, {j}, {j})",
    "select({b}, {j}, {j})",
    "{v}.as_ivec3()",
    "{v}.floor().as_ivec3()",
    "{d}.extend({u}).as_ivec3()",
];

/// Of `UVec2`.
pub(super) const UVEC2: &[&str] = &[
    "uvec2({u}, {u})",
    "UVec2::splat({u})",
    "{d}.wrapping_add({d})",
    "{d}.wrapping_mul({d})",
    "({d} & {d})",
    "({d} ^ {d})",
    "({d} >> 3u32)",
    "({d} | 1u32)",
    "({d} / 7u32)",
    "({d} % ({d} | 1u32))",
    "(({d} & 0xffffu32) * uvec2(3, 5))",
    "{d}.yx()",
    "{d}.xx()",
    "{d}.max({d})",
    "{d}.saturating_sub({d})",
    "select({b}, {d}, {d})",
    "{w}.as_uvec2()",
];

/// Of `BVec3`.
pub(super) const BVEC3: &[&str] = &[
    "bvec3({b}, {b}, {b})",
    "BVec3::splat({b})",
    "{v}.cmplt({v})",
    "{v}.cmpge({v})",
    "{j}.cmpeq({j})",
    "{j}.cmpgt({j})",
    "({m} & {m})",
    "({m} | {m})",
    "({m} ^ {m})",
    "(!{m})",
];

/// Of `Kind`.
pub(super) const KIND: &[&str] = &[
    "Kind::of({u})",
    "Kind::of(({i} & 3) as u32)",
    "{e}.next({u})",
    "{o}.kind",
    "(match {e} { Kind::Red => Kind::Blue, other => other })",
    "(match {u} { 0 => Kind::Red, 1..=9 => {e}, _ => Kind::Green })",
];

/// Of the enum with fields.
pub(super) const SHAPE: &[&str] = &[
    "Shape::Ball({f}, {u})",
    "Shape::Ball({f}, 7)",
    "(Shape::Block { low: {v}, kind: {e}, inner: {s} })",
    "(Shape::Block { inner: {s}, kind: {e}, low: {v} })",
    "Shape::Word({u})",
    "Shape::of({u})",
    "shapes[{u} as usize % shapes.len()]",
    "shapes[{Z} % shapes.len()]",
    "(if {b} { {k} } else { Shape::Nothing })",
    "(match {k} { Shape::Ball(r, n) => Shape::Word(n ^ r as u32), Shape::Nothing => Shape::Ball(1.0, 3), other => other })",
];

/// Of `Option<u32>`.
pub(super) const MAYBE: &[&str] = &[
    "Some({u})",
    "(if {b} { Some({u}) } else { None })",
    "half({u})",
    "halved({l}, {u})",
    "quarter({u}, {l})",
    "!{k}.word()",
    "(match {l} { Some(n) if n > 3 => Some(n - 1), Some(_) => None, None => Some(2) })",
];

/// Of `(f32, u32)`.
pub(super) const PAIR: &[&str] =
    &["({f}, {u})", "({f}, {u})", "({t}.0, {u})", "swapped({t}, {f})", "!{s}.parts({u})"];

/// Of `[f32; 4]`.
pub(super) const ROW: &[&str] =
    &["[{f}, {f}, {f}, {f}]", "[{f}; 4]", "[{t}.0, {v}.x, {f}, 0.5]", "{q}.to_array()"];

/// Of `[u32; 3]`.
pub(super) const COUNTS: &[&str] =
    &["[{u}, {u}, {u}]", "[{u}; 3]", "[{u}, {e} as u32, 1]", "[{c}[2], {c}[0], {u}]"];

/// Of `[Small; 2]`.
pub(super) const BOTH: &[&str] = &["[{s}, {s}]", "[{s}; 2]", "[{h}[1], {h}[0]]"];

/// Of the struct of the module.
pub(super) const OWN: &[&str] = &[
    "(Own { a: {f}, k: {u}, p: {w}, kind: {e} })",
    "(Own { kind: {e}, a: {f}, k: {u}, p: {w} })",
    "(Own { p: {w}, ..{o} })",
    "(Own { a: {f}, k: {u}, ..{o} })",
    "Own::of({u})",
];

/// Of a type parameter.
pub(super) const ANY: &[&str] = &["{G}.turned({u})", "{g}", "T::made({u})"];

/// Of `[f32; N]`.
pub(super) const LIST: &[&str] = &["[{f}; N]", "{y}"];

/// What `entry` gives.
pub(super) const OUTCOME: &[&str] = &[
    "(Outcome { n: {n}, x: {f}, t: {b}, e: {e}, c: {c}, j: {j} })",
    "(Outcome { n: Nested { v: {v}, s: Small { i: {i}, t: {b}, y: {f}, m: {u} }, k: {u} }, x: {f}, t: {b}, e: {e}, c: [{u}, {u}, {u}], j: {j} })",
];
