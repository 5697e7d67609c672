//! Templates of statements that change a place.

use crate::fuzz::tree::Ty;

/// `place op= value` and what else changes a place, `{p}`. None of them may contain a block: it
/// could assign to the place.
pub(super) const fn compound(ty: Ty) -> &'static [&'static str] {
    match ty {
        Ty::F32 => &["{p} += {f};", "{p} -= {f};", "{p} *= {f};", "{p} /= {f};", "{p} *= 0.5;"],
        Ty::U32 => &[
            "{p} |= {u};",
            "{p} &= {u};",
            "{p} ^= {u};",
            "{p} <<= {u} & 31;",
            "{p} >>= {u} & 31;",
            "{p} /= {u} | 1;",
            "{p} %= {u} | 1;",
            "{p} >>= 1; {p} += {u} >> 1;",
            "{p} &= 0xffff; {p} *= {u} & 0xffff;",
            "{p} |= 0x8000_0000; {p} -= {u} >> 1;",
        ],
        Ty::I32 => &[
            "{p} |= {i};",
            "{p} &= {i};",
            "{p} ^= {i};",
            "{p} <<= {u} & 31;",
            "{p} >>= {u} & 31;",
            "{p} /= {i} & 255 | 1;",
            "{p} %= {i} & 255 | 1;",
            "{p} >>= 1; {p} += {i} >> 1;",
            "{p} >>= 1; {p} -= {i} >> 1;",
            "{p} &= 0x7fff; {p} *= {i} & 0x7fff;",
        ],
        Ty::Bool => &["{p} |= {b};", "{p} &= {b};", "{p} ^= {b};"],
        Ty::Vec3 => &["{p} += {v};", "{p} -= {v};", "{p} *= {v};", "{p} /= {v};", "{p} *= {f};"],
        Ty::Vec2 => &["{p} += {w};", "{p} *= {f};", "{p} -= {w} * 0.5;"],
        Ty::Vec4 => &["{p} += {q};", "{p} -= {q};", "{p} *= {f};"],
        Ty::IVec3 => {
            &["{p} &= {j};", "{p} ^= {j};", "{p} >>= 1i32; {p} += {j} >> 1i32;", "{p} %= 100i32;"]
        }
        Ty::UVec2 => &["{p} |= {d};", "{p} ^= {d};", "{p} >>= 1u32; {p} += {d} >> 1u32;"],
        Ty::Size => &["{p} /= 2;", "{p} %= 9; {p} += 1;"],
        Ty::Small => &["{p}.rise({f});", "{p}.m = {p}.fall({u});"],
        Ty::Own => &["{p}.raise({u});"],
        Ty::Any => &["{p}.push({f});"],
        Ty::Counts => &["add_to({u}, &mut {p}[1]);"],
        Ty::Row => &["{p}[2] += {f};"],
        Ty::Both => &["{p}[0].rise({f});"],
        Ty::Shape => &["{p} = Shape::Word({u});", "{p} = Shape::Ball({f}, 1);"],
        Ty::Maybe => &["{p} = None;", "{p} = Some({u});"],
        Ty::BVec3 | Ty::Kind | Ty::Pair | Ty::Nested | Ty::List | Ty::Outcome => &[],
    }
}
