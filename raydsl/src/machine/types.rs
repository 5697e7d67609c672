//! Host types that kernels understand, and their conversion to lanes and back.

use core::mem::MaybeUninit;

use glam::{BVec2, BVec3, BVec4, IVec2, IVec3, IVec4, UVec2, UVec3, UVec4, Vec2, Vec3, Vec4};

use super::schema::{Places, stride_of};
use super::{B, F, Field, I, Machine, Schema, U, Usize, Value, Varying, X2, X3, X4, fill};

/// A type that kernels may use: it has a twin on every machine.
///
/// `#[derive(Type)]` and `#[primitive]` write this for a struct of such types.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot be used in a kernel",
    label = "not a type that kernels understand",
    note = "derive it, if it is made of such types: #[derive(Clone, Copy, raydsl::Type)]"
)]
pub trait Type: Copy + Send + Sync + 'static {
    /// The twin: the type of such a value on machine `M`.
    type On<M: Machine>: Value<M> + Varying<M, Value = Self::On<M>>;

    /// The layout of the type.
    const SCHEMA: &'static Schema;

    /// Returns the same value in every lane.
    fn splat<M: Machine>(m: &M, v: Self) -> Self::On<M>;
    /// Returns a value per lane.
    fn from_lanes<M: LaneMachine>(m: &M, f: impl Fn(usize) -> Self + Copy) -> Self::On<M>;
    /// Returns the value of one lane.
    fn lane<M: LaneMachine>(v: &Self::On<M>, lane: usize) -> Self;
    /// Writes the value in the host's layout to the start of `out` (little-endian).
    fn write(&self, out: &mut [u8]);
    /// Reads a value in the host's layout from the start of `bytes`.
    fn read(bytes: &[u8]) -> Self;
}

/// A type of kernels by its own declaration, whatever a bound says: every [`Type`] has this.
///
/// Lifted functions state that their types are types of kernels, so that a type that is none is one
/// error, not one at each of its uses. But then their bodies know no more of it than that. Values of
/// this trait's twin are of a type about which rustc reports nothing.
#[diagnostic::on_unimplemented(
    message = "`{Self}` cannot be used in a kernel",
    label = "not a type that kernels understand",
    note = "derive it, if it is made of such types: #[derive(Clone, Copy, raydsl::Type)]"
)]
pub trait KernelType {
    /// The same as [`Type::On`].
    type Twin<M: Machine>;

    /// Returns the value.
    fn same<M: Machine>(v: <Self as Type>::On<M>) -> Self::Twin<M>
    where
        Self: Type;
}

/// [`Type`], as a bound that names a lifetime: rustc reports any other bound that is false where it
/// stands.
pub trait Stated<'a>: Type {}

impl<T: Type> Stated<'_> for T {}

/// Declares types of the library, which users may name anew.
macro_rules! kernel_type {
    ($(($($params:tt)*) $host:ty),+ $(,)?) => {
        $(
            #[diagnostic::do_not_recommend]
            impl<$($params)*> $crate::machine::KernelType for $host {
                type Twin<M: $crate::machine::Machine> = <Self as $crate::Type>::On<M>;

                #[inline(always)]
                fn same<M: $crate::machine::Machine>(v: Self::Twin<M>) -> Self::Twin<M> {
                    v
                }
            }
        )+
    };
}

pub(crate) use kernel_type;

/// A machine whose lanes hold numbers: all but the recorder.
#[expect(missing_docs, reason = "two methods a scalar type")]
pub trait LaneMachine: Machine {
    /// The number of lanes.
    const LANES: usize;
    fn f32_from_fn(&self, f: impl FnMut(usize) -> f32) -> Self::F32;
    fn i32_from_fn(&self, f: impl FnMut(usize) -> i32) -> Self::I32;
    fn u32_from_fn(&self, f: impl FnMut(usize) -> u32) -> Self::U32;
    fn bool_from_fn(&self, f: impl FnMut(usize) -> bool) -> Self::Bool;
    fn f32_lane(v: &Self::F32, lane: usize) -> f32;
    fn i32_lane(v: &Self::I32, lane: usize) -> i32;
    fn u32_lane(v: &Self::U32, lane: usize) -> u32;
    fn bool_lane(v: &Self::Bool, lane: usize) -> bool;
}

/// Returns a value per lane like [`Type::from_lanes`], which calls its function for each scalar of the
/// type: here `f` is called, and compiled, once. For values that are computed, not only read.
#[inline(always)]
pub fn from_each_lane<M: LaneMachine, T: Type>(m: &M, f: impl Fn(usize) -> T) -> T::On<M> {
    const { assert!(M::LANES <= 64) };
    let mut all = [const { MaybeUninit::<T>::uninit() }; 64];
    for (lane, value) in all.iter_mut().enumerate().take(M::LANES) {
        value.write(f(lane));
    }
    T::from_lanes(
        m,
        #[inline(always)]
        |lane| {
            assert!(lane < M::LANES);
            // SAFETY: the first `LANES` have been written.
            unsafe { all[lane].assume_init() }
        },
    )
}

macro_rules! read_scalar {
    (bool, $bytes:expr) => {
        $bytes[0] != 0
    };
    ($host:ty, $bytes:expr) => {
        bytemuck::pod_read_unaligned(&$bytes[..size_of::<$host>()])
    };
}

macro_rules! scalar_type {
    ($host:tt, $twin:ident, $schema:ident, $make:ident, $from:ident, $lane:ident) => {
        kernel_type!(() $host);

        #[diagnostic::do_not_recommend]
        impl Type for $host {
            type On<M: Machine> = $twin<M>;

            const SCHEMA: &'static Schema = &Schema::$schema;

            #[inline(always)]
            fn splat<M: Machine>(m: &M, v: Self) -> $twin<M> {
                $twin(m.$make(v))
            }

            #[inline(always)]
            fn from_lanes<M: LaneMachine>(m: &M, f: impl Fn(usize) -> Self + Copy) -> $twin<M> {
                $twin(m.$from(f))
            }

            #[inline(always)]
            fn lane<M: LaneMachine>(v: &$twin<M>, lane: usize) -> Self {
                M::$lane(&v.0, lane)
            }

            fn write(&self, out: &mut [u8]) {
                out[..size_of::<Self>()].copy_from_slice(bytemuck::bytes_of(self));
            }

            fn read(bytes: &[u8]) -> Self {
                read_scalar!($host, bytes)
            }
        }
    };
}

scalar_type!(f32, F, F32, f32, f32_from_fn, f32_lane);
scalar_type!(i32, I, I32, i32, i32_from_fn, i32_lane);
scalar_type!(u32, U, U32, u32, u32_from_fn, u32_lane);
scalar_type!(bool, B, Bool, bool, bool_from_fn, bool_lane);

kernel_type!(() usize, () (), (T: Type, const N: usize) [T; N]);

/// Indexes with 32 bits in a kernel; the upper bits of a host's `usize` are lost.
#[diagnostic::do_not_recommend]
impl Type for usize {
    type On<M: Machine> = Usize<M>;

    const SCHEMA: &'static Schema = &Schema::U32;

    #[inline(always)]
    fn splat<M: Machine>(m: &M, v: Self) -> Usize<M> {
        Usize(m.u32(v as u32))
    }

    #[inline(always)]
    fn from_lanes<M: LaneMachine>(m: &M, f: impl Fn(usize) -> Self + Copy) -> Usize<M> {
        Usize(m.u32_from_fn(
            #[inline(always)]
            |l| f(l) as u32,
        ))
    }

    #[inline(always)]
    fn lane<M: LaneMachine>(v: &Usize<M>, lane: usize) -> Self {
        M::u32_lane(&v.0, lane) as Self
    }

    fn write(&self, out: &mut [u8]) {
        (*self as u32).write(out);
    }

    fn read(bytes: &[u8]) -> Self {
        u32::read(bytes) as Self
    }
}

macro_rules! vector_type {
    ($twin:ident $n:literal $all:tt: $($host:ident of $element:ident),+) => {
        $(vector_type!(@one $twin $n $all $host $element);)+
    };
    (@one $twin:ident $n:literal ($($c:ident)+) $host:ident $element:ident) => {
        kernel_type!(() $host);

        #[diagnostic::do_not_recommend]
        impl Type for $host {
            type On<M: Machine> = $twin<<$element as Type>::On<M>>;

            const SCHEMA: &'static Schema = &Schema::Vector(<$element as Type>::SCHEMA, $n);

            #[inline(always)]
            fn splat<M: Machine>(m: &M, v: Self) -> Self::On<M> {
                $twin { $($c: <$element as Type>::splat(m, v.$c)),+ }
            }

            #[inline(always)]
            fn from_lanes<M: LaneMachine>(m: &M, f: impl Fn(usize) -> Self + Copy) -> Self::On<M> {
                $twin { $($c: <$element as Type>::from_lanes(m, #[inline(always)] |l| f(l).$c)),+ }
            }

            #[inline(always)]
            fn lane<M: LaneMachine>(v: &Self::On<M>, lane: usize) -> Self {
                Self::new($(<$element as Type>::lane(&v.$c, lane)),+)
            }

            fn write(&self, out: &mut [u8]) {
                let each = out.chunks_exact_mut(size_of::<$element>());
                for (v, out) in [$(self.$c),+].iter().zip(each) {
                    Type::write(v, out);
                }
            }

            fn read(bytes: &[u8]) -> Self {
                let mut each = bytes.chunks_exact(size_of::<$element>()).map(<$element as Type>::read);
                let mut next = || each.next().expect("one element for each component");
                $(let $c = next();)+
                Self::new($($c),+)
            }
        }
    };
}

vector_type!(X2 2 (x y): Vec2 of f32, IVec2 of i32, UVec2 of u32, BVec2 of bool);
vector_type!(X3 3 (x y z): Vec3 of f32, IVec3 of i32, UVec3 of u32, BVec3 of bool);
vector_type!(X4 4 (x y z w): IVec4 of i32, UVec4 of u32, BVec4 of bool, Vec4 of f32);

impl<T: Type, const N: usize> Type for [T; N] {
    type On<M: Machine> = [T::On<M>; N];

    const SCHEMA: &'static Schema =
        &Schema::Array { element: T::SCHEMA, count: N, stride: stride_of::<T>() };

    #[inline(always)]
    fn splat<M: Machine>(m: &M, v: Self) -> Self::On<M> {
        fill(
            #[inline(always)]
            |i| T::splat(m, v[i]),
        )
    }

    #[inline(always)]
    fn from_lanes<M: LaneMachine>(m: &M, f: impl Fn(usize) -> Self + Copy) -> Self::On<M> {
        fill(
            #[inline(always)]
            |i| {
                T::from_lanes(
                    m,
                    #[inline(always)]
                    |l| f(l)[i],
                )
            },
        )
    }

    #[inline(always)]
    fn lane<M: LaneMachine>(v: &Self::On<M>, lane: usize) -> Self {
        fill(
            #[inline(always)]
            |i| T::lane(&v[i], lane),
        )
    }

    fn write(&self, out: &mut [u8]) {
        for (x, chunk) in self.iter().zip(out.chunks_exact_mut(stride_of::<T>())) {
            x.write(chunk);
        }
    }

    fn read(bytes: &[u8]) -> Self {
        core::array::from_fn(|i| T::read(&bytes[i * stride_of::<T>()..]))
    }
}

/// The unit type, without data.
#[diagnostic::do_not_recommend]
impl Type for () {
    type On<M: Machine> = ();

    const SCHEMA: &'static Schema = &Schema::Host;

    #[inline(always)]
    fn splat<M: Machine>(_: &M, (): Self) {}

    #[inline(always)]
    fn from_lanes<M: LaneMachine>(_: &M, _: impl Fn(usize) -> Self + Copy) {}

    #[inline(always)]
    fn lane<M: LaneMachine>((): &(), _: usize) {}

    fn write(&self, _: &mut [u8]) {}

    fn read(_: &[u8]) {}
}

/// A tuple's places.
trait Tuple<const N: usize> {
    const PLACES: Places<N>;
}

macro_rules! tuple_type {
    ($($name:ident . $index:tt),+) => {
        impl<$($name: Type),+> Tuple<{ [$($index),+].len() }> for ($($name,)+) {
            const PLACES: Places<{ [$($index),+].len() }> = Places::new(
                size_of::<Self>(),
                [$(core::mem::offset_of!(Self, $index)),+],
                [$(size_of::<$name>()),+],
                [$($name::SCHEMA),+],
            );
        }

        kernel_type!(($($name: Type),+) ($($name,)+));

        impl<$($name: Type),+> Type for ($($name,)+) {
            type On<M: Machine> = ($($name::On<M>,)+);

            const SCHEMA: &'static Schema = &Schema::Struct {
                name: "Tuple",
                fields: &[$(Field {
                    name: concat!("_", stringify!($index)),
                    offset: Self::PLACES.offsets[$index],
                    schema: $name::SCHEMA,
                }),+],
                size: Self::PLACES.size,
            };

            #[inline(always)]
            fn splat<M: Machine>(m: &M, v: Self) -> Self::On<M> {
                ($($name::splat(m, v.$index),)+)
            }

            #[inline(always)]
            fn from_lanes<M: LaneMachine>(m: &M, f: impl Fn(usize) -> Self + Copy) -> Self::On<M> {
                ($($name::from_lanes(m, |l| f(l).$index),)+)
            }

            #[inline(always)]
            fn lane<M: LaneMachine>(v: &Self::On<M>, lane: usize) -> Self {
                ($($name::lane(&v.$index, lane),)+)
            }

            fn write(&self, out: &mut [u8]) {
                $(self.$index.write(&mut out[Self::PLACES.offsets[$index]..]);)+
            }

            fn read(bytes: &[u8]) -> Self {
                ($($name::read(&bytes[Self::PLACES.offsets[$index]..]),)+)
            }
        }
    };
}

tuple_type!(A.0);
tuple_type!(A.0, C.1);
tuple_type!(A.0, C.1, D.2);
tuple_type!(A.0, C.1, D.2, E.3);
tuple_type!(A.0, C.1, D.2, E.3, G.4);
tuple_type!(A.0, C.1, D.2, E.3, G.4, H.5);
tuple_type!(A.0, C.1, D.2, E.3, G.4, H.5, J.6);
tuple_type!(A.0, C.1, D.2, E.3, G.4, H.5, J.6, K.7);
