//! What there is of each type: templates, constants, members; and the names of variables.

use super::{composites, numbers};
use crate::fuzz::tree::Ty;

/// The templates of a type's expressions.
pub(super) const fn templates(ty: Ty) -> &'static [&'static str] {
    match ty {
        Ty::F32 => numbers::F32,
        Ty::U32 => numbers::U32,
        Ty::I32 => numbers::I32,
        Ty::Bool => numbers::BOOL,
        Ty::Size => numbers::SIZE,
        Ty::Vec2 => composites::VEC2,
        Ty::Vec3 => composites::VEC3,
        Ty::Vec4 => composites::VEC4,
        Ty::IVec3 => composites::IVEC3,
        Ty::UVec2 => composites::UVEC2,
        Ty::BVec3 => composites::BVEC3,
        Ty::Kind => composites::KIND,
        Ty::Shape => composites::SHAPE,
        Ty::Maybe => composites::MAYBE,
        Ty::Pair => composites::PAIR,
        Ty::Row => composites::ROW,
        Ty::Counts => composites::COUNTS,
        Ty::Both => composites::BOTH,
        Ty::Small => composites::SMALL,
        Ty::Nested => composites::NESTED,
        Ty::Own => composites::OWN,
        Ty::Any => composites::ANY,
        Ty::List => composites::LIST,
        Ty::Outcome => composites::OUTCOME,
    }
}

/// The type that a small letter stands for.
pub(super) const fn of_letter(letter: char) -> Option<Ty> {
    Some(match letter {
        'f' => Ty::F32,
        'u' => Ty::U32,
        'i' => Ty::I32,
        'b' => Ty::Bool,
        'z' => Ty::Size,
        'w' => Ty::Vec2,
        'v' => Ty::Vec3,
        'q' => Ty::Vec4,
        'j' => Ty::IVec3,
        'd' => Ty::UVec2,
        'm' => Ty::BVec3,
        'e' => Ty::Kind,
        'k' => Ty::Shape,
        'l' => Ty::Maybe,
        't' => Ty::Pair,
        'r' => Ty::Row,
        'c' => Ty::Counts,
        'h' => Ty::Both,
        's' => Ty::Small,
        'n' => Ty::Nested,
        'o' => Ty::Own,
        'g' => Ty::Any,
        'y' => Ty::List,
        _ => return None,
    })
}

const F32_LITERALS: &[&str] = &[
    "0.0f32",
    "1.0f32",
    "0.5f32",
    "2.0f32",
    "3.25f32",
    "100.0f32",
    "0.1f32",
    "1e10f32",
    "16777216.0f32",
    "(-1.0f32)",
    "(-0.75f32)",
    "(-8.0f32)",
    "(-0.0f32)",
    "f32::MAX",
];

const U32_LITERALS: &[&str] = &[
    "0u32",
    "1u32",
    "2u32",
    "3u32",
    "7u32",
    "13u32",
    "31u32",
    "0xffu32",
    "0x8000_0000u32",
    "4294967295u32",
    "u32::MAX",
];

const I32_LITERALS: &[&str] = &[
    "0i32",
    "1i32",
    "2i32",
    "5i32",
    "100i32",
    "(-1i32)",
    "(-2i32)",
    "(-77i32)",
    "2147483647i32",
    "(-2147483647i32)",
    "i32::MIN",
];

/// Constants of a type.
pub(super) const fn literals(ty: Ty) -> &'static [&'static str] {
    match ty {
        Ty::F32 => F32_LITERALS,
        Ty::U32 => U32_LITERALS,
        Ty::I32 => I32_LITERALS,
        Ty::Bool => &["true", "false"],
        Ty::Vec3 => &["Vec3::X", "vec3(1.0, -2.0, 0.5)", "Vec3::splat(3.0)"],
        Ty::Size => &["0usize", "1usize", "3usize", "6usize"],
        Ty::Vec2 => &["Vec2::Y", "vec2(1.5, -3.0)"],
        Ty::Vec4 => &["Vec4::W", "vec4(1.0, 2.0, -0.5, 8.0)"],
        Ty::IVec3 => &["IVec3::ONE", "ivec3(-4, 0, 9)", "IVec3::splat(-1)"],
        Ty::UVec2 => &["UVec2::X", "uvec2(7, 300)"],
        Ty::BVec3 => &["bvec3(true, false, true)", "BVec3::splat(false)"],
        Ty::Kind => &["Kind::Red", "Kind::Green", "Kind::Blue"],
        Ty::Shape => &["Shape::Nothing", "Shape::Ball(0.5, 3)", "Shape::of(5u32)"],
        Ty::Maybe => &["Some(3u32)", "halved(Some(8), 1u32)", "half(6u32)"],
        Ty::Pair => &["(2.5f32, 3u32)", "(-1.0f32, 0u32)"],
        Ty::Row => &["[1.0f32, -2.0, 0.25, 8.0]", "[0.5f32; 4]"],
        Ty::Counts => &["[1u32, 2, 3]", "[9u32; 3]"],
        Ty::Both => &["[Small::of(1u32), Small::of(6u32)]"],
        Ty::Own => &["Own::of(4u32)", "Own::of(1u32)"],
        Ty::Any => &["p0"],
        Ty::List => &["[1.5f32; N]"],
        Ty::Small => &["Small::of(5u32)", "Small::of(0u32)"],
        Ty::Nested => &["Nested::of(9u32)", "Nested::of(2u32)"],
        Ty::Outcome => &["Outcome::of(7u32)", "Outcome::of(1u32)"],
    }
}

/// The members of a type, with their types.
pub(super) const fn members(ty: Ty) -> &'static [(&'static str, Ty)] {
    match ty {
        Ty::Vec3 => &[("x", Ty::F32), ("y", Ty::F32), ("z", Ty::F32)],
        Ty::Small => &[("i", Ty::I32), ("t", Ty::Bool), ("y", Ty::F32), ("m", Ty::U32)],
        Ty::Nested => &[("v", Ty::Vec3), ("s", Ty::Small), ("k", Ty::U32)],
        Ty::Vec2 => &[("x", Ty::F32), ("y", Ty::F32)],
        Ty::Vec4 => &[("x", Ty::F32), ("y", Ty::F32), ("z", Ty::F32), ("w", Ty::F32)],
        Ty::IVec3 => &[("x", Ty::I32), ("y", Ty::I32), ("z", Ty::I32)],
        Ty::UVec2 => &[("x", Ty::U32), ("y", Ty::U32)],
        Ty::Pair => &[("0", Ty::F32), ("1", Ty::U32)],
        Ty::Own => &[("a", Ty::F32), ("k", Ty::U32), ("p", Ty::Vec2), ("kind", Ty::Kind)],
        Ty::Outcome => &[("n", Ty::Nested), ("x", Ty::F32), ("t", Ty::Bool)],
        Ty::F32
        | Ty::U32
        | Ty::I32
        | Ty::Bool
        | Ty::Size
        | Ty::BVec3
        | Ty::Kind
        | Ty::Shape
        | Ty::Maybe
        | Ty::Row
        | Ty::Counts
        | Ty::Both
        | Ty::Any
        | Ty::List => &[],
    }
}

/// Names of variables. Some are words of WGSL, some could be those of lifted code.
pub(super) const NAMES: &[&str] = &[
    "a", "b", "c", "d", "e", "sum", "m", "params", "args", "result", "branch", "out", "array",
    "texture", "discard", "sampler", "var", "abs", "function", "active", "u", "f", "i", "value",
    "lanes", "filter", "private",
];
