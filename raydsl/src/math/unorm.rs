//! Unsigned normalised integers: `0..=1` in 8, 16 or 32 bits.
//!
//! Encoding rounds to the nearest code, as WGSL's `pack4x8unorm` does; decoding is
//! `bits as f32 / (2^n - 1) as f32`.

use crate::machine::{
    Capture, F, F32Binary, LaneMachine, Leaves, Machine, Method, Schema, Type, U, Value, Varying,
    name,
};

macro_rules! unorm {
    ($name:ident, $twin:ident, $bits:ty, $n:literal, $schema:expr) => {
        #[doc = concat!("A number from 0 to 1 in ", $n, " bits.")]
        #[derive(
            Clone,
            Copy,
            Debug,
            Default,
            PartialEq,
            Eq,
            PartialOrd,
            Ord,
            Hash,
            bytemuck::Pod,
            bytemuck::Zeroable,
        )]
        #[repr(transparent)]
        pub struct $name($bits);

        impl $name {
            /// 0.
            pub const ZERO: Self = Self(0);
            /// 1.
            pub const ONE: Self = Self(<$bits>::MAX);

            /// The nearest code to `v` clamped to `[0, 1]`; NaN gives 0.
            pub fn new(v: f32) -> Self {
                // f64 holds every code exactly; `as` saturates and turns NaN into 0.
                Self((f64::from(v) * f64::from(<$bits>::MAX) + 0.5).floor() as $bits)
            }

            /// The number with this code.
            pub const fn from_bits(bits: $bits) -> Self {
                Self(bits)
            }

            /// The code.
            pub const fn to_bits(self) -> $bits {
                self.0
            }

            /// The number.
            pub fn to_f32(self) -> f32 {
                self.0 as f32 / <$bits>::MAX as f32
            }
        }

        impl From<f32> for $name {
            fn from(v: f32) -> Self {
                Self::new(v)
            }
        }

        #[doc = concat!("[`", stringify!($name), "`] on machine `M`: its code.")]
        pub struct $twin<M: Machine> {
            bits: U<M>,
        }

        impl<M: Machine> Clone for $twin<M> {
            #[inline(always)]
            fn clone(&self) -> Self {
                *self
            }
        }

        impl<M: Machine> Copy for $twin<M> {}

        impl<M: Machine> Value<M> for $twin<M> {
            const SCHEMA: &'static Schema = $schema;

            #[inline(always)]
            fn zero(m: &M) -> Self {
                Self { bits: U::zero(m) }
            }

            #[inline(always)]
            fn zip(m: &M, a: Self, b: Self, f: &mut impl Leaves<M>) -> Self {
                Self { bits: U::zip(m, a.bits, b.bits, f) }
            }
        }

        #[diagnostic::do_not_recommend]
        impl<M: Machine> Varying<M> for $twin<M> {
            type Value = Self;

            #[inline(always)]
            fn varying(self, _: &M) -> Self {
                self
            }
        }

        impl Type for $name {
            type On<M: Machine> = $twin<M>;

            const SCHEMA: &'static Schema = $schema;

            #[inline(always)]
            fn splat<M: Machine>(m: &M, v: Self) -> $twin<M> {
                $twin { bits: U(m.u32(u32::from(v.0))) }
            }

            #[inline(always)]
            fn from_lanes<M: LaneMachine>(m: &M, f: &impl Fn(usize) -> Self) -> $twin<M> {
                $twin { bits: U(m.u32_from_fn(|l| u32::from(f(l).0))) }
            }

            #[inline(always)]
            fn lane<M: LaneMachine>(v: &$twin<M>, lane: usize) -> Self {
                Self(M::u32_lane(&v.bits.0, lane) as $bits)
            }

            fn write(&self, out: &mut [u8]) {
                out[..size_of::<Self>()].copy_from_slice(&self.0.to_le_bytes());
            }

            fn read(bytes: &[u8]) -> Self {
                Self(bytemuck::pod_read_unaligned(&bytes[..size_of::<Self>()]))
            }
        }

        #[diagnostic::do_not_recommend]
        impl<M: Machine> Capture<M> for $name {
            type On<'c> = $twin<M>;

            #[inline(always)]
            fn capture(&self, m: &M, name: &'static str) -> $twin<M> {
                m.capture(name, *self)
            }

            #[inline(always)]
            fn constant(&self, m: &M) -> $twin<M> {
                Self::splat(m, *self)
            }
        }

        #[diagnostic::do_not_recommend]
        impl<M: Machine> Method<{ name("to_f32") }, M, ()> for $twin<M> {
            type Output = F<M>;

            #[inline(always)]
            fn call(self, m: &M, (): ()) -> F<M> {
                let d = m.f32(<$bits>::MAX as f32);
                F(m.f32_binary(F32Binary::Div, m.u32_to_f32(self.bits.0), d))
            }
        }

        #[diagnostic::do_not_recommend]
        impl<M: Machine> Method<{ name("to_bits") }, M, ()> for $twin<M> {
            type Output = U<M>;

            #[inline(always)]
            fn call(self, _: &M, (): ()) -> U<M> {
                self.bits
            }
        }
    };
}

unorm!(Unorm8, Unorm8On, u8, 8, &Schema::Small { bytes: 1 });
unorm!(Unorm16, Unorm16On, u16, 16, &Schema::Small { bytes: 2 });
unorm!(Unorm32, Unorm32On, u32, 32, &Schema::U32);
