//! Conversions with `as`.

use super::OpCast;
use crate::machine::{B, F, I, Machine, Type, U, Usize};

macro_rules! cast {
    ($($a:ty => $t:ident: |$m:ident, $x:ident| $e:expr),+ $(,)?) => {
        $(
            #[diagnostic::do_not_recommend]
            impl<M: Machine> OpCast<M, $t> for $a {
                #[inline(always)]
                fn cast($m: &M, $x: $a) -> <$t as Type>::On<M> {
                    $e
                }
            }
        )+
    };
}

cast!(
    F<M> => f32: |_m, a| a,
    F<M> => i32: |m, a| I(m.f32_to_i32(a.0)),
    F<M> => u32: |m, a| U(m.f32_to_u32(a.0)),
    I<M> => f32: |m, a| F(m.i32_to_f32(a.0)),
    I<M> => i32: |_m, a| a,
    I<M> => u32: |m, a| U(m.i32_to_u32(a.0)),
    U<M> => f32: |m, a| F(m.u32_to_f32(a.0)),
    U<M> => i32: |m, a| I(m.u32_to_i32(a.0)),
    U<M> => u32: |_m, a| a,
    B<M> => u32: |m, a| U(m.bool_to_u32(a.0)),
    B<M> => i32: |m, a| I(m.u32_to_i32(m.bool_to_u32(a.0))),
    i32 => f32: |m, a| F(m.f32(a as f32)),
    i32 => i32: |m, a| I(m.i32(a)),
    i32 => u32: |m, a| U(m.u32(a as u32)),
    u32 => f32: |m, a| F(m.f32(a as f32)),
    u32 => i32: |m, a| I(m.i32(a as i32)),
    u32 => u32: |m, a| U(m.u32(a)),
    bool => u32: |m, a| U(m.u32(u32::from(a))),
    bool => i32: |m, a| I(m.i32(i32::from(a))),
    bool => usize: |m, a| Usize(m.u32(u32::from(a))),
    F<M> => usize: |m, a| Usize(m.f32_to_u32(a.0)),
    I<M> => usize: |m, a| Usize(m.i32_to_u32(a.0)),
    U<M> => usize: |_m, a| Usize(a.0),
    B<M> => usize: |m, a| Usize(m.bool_to_u32(a.0)),
    Usize<M> => f32: |m, a| F(m.u32_to_f32(a.0)),
    Usize<M> => i32: |m, a| I(m.u32_to_i32(a.0)),
    Usize<M> => u32: |_m, a| U(a.0),
    Usize<M> => usize: |_m, a| a,
    i32 => usize: |m, a| Usize(m.u32(a as u32)),
    u32 => usize: |m, a| Usize(m.u32(a)),
    usize => f32: |m, a| F(m.f32(a as f32)),
    usize => i32: |m, a| I(m.i32(a as i32)),
    usize => u32: |m, a| U(m.u32(a as u32)),
    usize => usize: |m, a| Usize(m.u32(a as u32)),
);
