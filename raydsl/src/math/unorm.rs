//! Unsigned normalised integers: `0..=1` in 8, 16 or 32 bits.
//!
//! Encoding rounds to the nearest code, as WGSL's `pack4x8unorm` does; decoding is
//! `bits as f32 / (2^n - 1) as f32`.

use super::code::code;
use crate::machine::{
    Capture, F, LaneMachine, Leaves, Machine, Method, Resource, Schema, Type, U, Value, Varying,
    name, visit_value,
};

macro_rules! unorm {
    ($name:ident, $twin:ident, $bits:ty, $n:literal, $schema:expr) => {
        code!(
            #[doc = concat!("A number from 0 to 1 in ", $n, " bits.")]
            #[derive(PartialEq, Eq, PartialOrd, Ord, Hash)]
            $name,
            $twin,
            $bits,
            $schema
        );

        impl $name {
            /// 0.
            pub const ZERO: Self = Self(0);
            /// 1.
            pub const ONE: Self = Self(<$bits>::MAX);

            /// Encodes `v`, clamped to `[0, 1]`, as the nearest code; NaN becomes 0.
            pub fn new(v: f32) -> Self {
                // f64 holds every code exactly; `as` saturates and turns NaN into 0.
                Self((f64::from(v) * f64::from(<$bits>::MAX) + 0.5).floor() as $bits)
            }

            /// Returns the number.
            pub fn to_f32(self) -> f32 {
                self.0 as f32 / <$bits>::MAX as f32
            }
        }

        impl From<f32> for $name {
            fn from(v: f32) -> Self {
                Self::new(v)
            }
        }

        #[diagnostic::do_not_recommend]
        impl<M: Machine> Method<{ name("to_f32") }, M, ()> for $twin<M> {
            type Output = F<M>;

            #[inline(always)]
            fn call(self, m: &M, (): ()) -> F<M> {
                F(m.unorm(self.bits.0, u32::from(<$bits>::MAX)))
            }
        }
    };
}

unorm!(Unorm8, Unorm8On, u8, 8, &Schema::Small { bytes: 1 });
unorm!(Unorm16, Unorm16On, u16, 16, &Schema::Small { bytes: 2 });
unorm!(Unorm32, Unorm32On, u32, 32, &Schema::U32);
