//! Types of the host with a code of at most 32 bits, and their forms on a machine.

macro_rules! code {
    ($(#[$doc:meta])* $name:ident, $twin:ident, $bits:ty, $schema:expr) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
        #[repr(transparent)]
        pub struct $name($bits);

        impl $name {
            /// Creates the number with this code.
            pub const fn from_bits(bits: $bits) -> Self {
                Self(bits)
            }

            /// Returns the code.
            pub const fn to_bits(self) -> $bits {
                self.0
            }
        }

        #[doc = concat!("[`", stringify!($name), "`] on machine `M`: its code.")]
        pub struct $twin<M: Machine> {
            pub(crate) bits: U<M>,
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

        $crate::machine::kernel_type!(() $name);

        impl Type for $name {
            type On<M: Machine> = $twin<M>;

            const SCHEMA: &'static Schema = $schema;

            #[inline(always)]
            fn splat<M: Machine>(m: &M, v: Self) -> $twin<M> {
                $twin { bits: U(m.u32(u32::from(v.0))) }
            }

            #[inline(always)]
            fn from_lanes<M: LaneMachine>(m: &M, f: impl Fn(usize) -> Self + Copy) -> $twin<M> {
                $twin { bits: U(m.u32_from_fn(
                    #[inline(always)]
                    |l| u32::from(f(l).0),
                )) }
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

            fn resources(&self, name: &'static str, visit: &mut dyn FnMut(&dyn Resource)) {
                visit_value(*self, name, visit);
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

pub(super) use code;
