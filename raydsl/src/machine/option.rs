//! `Option` in kernels: whether there is a value, and the value.

use core::marker::PhantomData;

use super::ops::{Comparable, OpCompare};
use super::types::from_each_lane;
use super::{
    B, Compare, Field, Inferred, LaneMachine, Leaves, Machine, Method, Op, Scalar, Schema, Twin,
    Type, Value, Varying, index, kernel_type, name,
};

/// Returns a value of the host whose scalars are 0.
#[inline]
pub fn zero_of<T: Type>() -> T {
    T::lane::<Scalar>(&T::On::zero(&Scalar::default()), 0)
}

/// Where the value of an `Option` lies in buffers: behind a word that says whether there is one.
const VALUE: usize = 4;

/// An `Option<T>` on machine `M`.
pub struct OptionOn<M: Machine, T: Type> {
    is_some: B<M>,
    /// Zero where there is none.
    value: T::On<M>,
    host: PhantomData<T>,
}

impl<M: Machine, T: Type> Clone for OptionOn<M, T> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<M: Machine, T: Type> Copy for OptionOn<M, T> {}

#[inline(always)]
fn of<M: Machine, T: Type>(is_some: B<M>, value: T::On<M>) -> OptionOn<M, T> {
    OptionOn { is_some, value, host: PhantomData }
}

/// The functions that make values of the variants, as the derive of an enum writes them.
#[derive(Debug)]
pub enum Options {}

#[expect(non_snake_case, missing_docs, reason = "named as the variants")]
impl Options {
    #[inline(always)]
    pub fn Some_on<M: Machine, V: Inferred<M>>(m: &M, v: V) -> OptionOn<M, V::Host> {
        of(B(m.bool(true)), v.give(m))
    }

    #[inline(always)]
    pub fn None_on<M: Machine, T: Type>(m: &M) -> OptionOn<M, T> {
        of(B(m.bool(false)), Value::zero(m))
    }
}

/// The methods for the variants in patterns, as the derive of an enum writes them.
#[expect(non_snake_case, missing_docs, reason = "named as the variants")]
impl<M: Machine, T: Type> OptionOn<M, T> {
    #[inline(always)]
    pub fn __kinds_by_derive_Type(self) -> Self {
        self
    }

    #[inline(always)]
    pub fn __is_Some_on(self, _: &M) -> B<M> {
        self.is_some
    }

    #[inline(always)]
    pub fn __is_None_on(self, m: &M) -> B<M> {
        B(m.bool_not(self.is_some.0))
    }

    #[inline(always)]
    pub fn __Some_0_on(self, _: &M) -> T::On<M> {
        self.value
    }
}

impl<M: Machine, T: Type> Value<M> for OptionOn<M, T> {
    const SCHEMA: &'static Schema = <Option<T> as Type>::SCHEMA;

    #[inline(always)]
    fn zero(m: &M) -> Self {
        of(Value::zero(m), Value::zero(m))
    }

    #[inline(always)]
    fn zip(m: &M, a: Self, b: Self, f: &mut impl Leaves<M>) -> Self {
        of(Value::zip(m, a.is_some, b.is_some, f), Value::zip(m, a.value, b.value, f))
    }
}

kernel_type!((T: Type) Option<T>);

#[diagnostic::do_not_recommend]
impl<T: Type> Type for Option<T> {
    type On<M: Machine> = OptionOn<M, T>;

    const SCHEMA: &'static Schema = &Schema::Struct {
        name: "Option",
        fields: &[
            Field { name: "is_some", offset: 0, schema: &Schema::Bool },
            Field { name: "value", offset: VALUE, schema: T::SCHEMA },
        ],
        size: VALUE + T::SCHEMA.size().next_multiple_of(4),
    };

    #[inline(always)]
    fn splat<M: Machine>(m: &M, v: Self) -> OptionOn<M, T> {
        of(Type::splat(m, v.is_some()), T::splat(m, v.unwrap_or_else(zero_of)))
    }

    #[inline(always)]
    fn from_lanes<M: LaneMachine>(m: &M, f: impl Fn(usize) -> Self + Copy) -> OptionOn<M, T> {
        of(
            Type::from_lanes(
                m,
                #[inline(always)]
                |lane| f(lane).is_some(),
            ),
            from_each_lane(
                m,
                #[inline(always)]
                |lane| f(lane).unwrap_or_else(zero_of),
            ),
        )
    }

    #[inline(always)]
    fn lane<M: LaneMachine>(v: &OptionOn<M, T>, lane: usize) -> Self {
        bool::lane::<M>(&v.is_some, lane).then(|| T::lane(&v.value, lane))
    }

    fn write(&self, out: &mut [u8]) {
        self.is_some().write(out);
        self.unwrap_or_else(zero_of).write(&mut out[VALUE..]);
    }

    fn read(bytes: &[u8]) -> Self {
        let value = || T::read(&bytes[VALUE..]);
        bool::read(bytes).then(value)
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, T: Type> Varying<M> for OptionOn<M, T> {
    type Value = Self;

    #[inline(always)]
    fn varying(self, _: &M) -> Self {
        self
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, T: Type> Inferred<M> for OptionOn<M, T> {
    type Host = Option<T>;

    #[inline(always)]
    fn give(self, _: &M) -> Self {
        self
    }
}

impl<M: Machine, T: Type> Twin<M> for OptionOn<M, T> {
    #[inline(always)]
    fn from_host(v: Self) -> Self {
        v
    }
}

impl<M: Machine, T: Type> OpCompare<M, Self> for OptionOn<M, T>
where
    Option<T>: Comparable<M>,
{
    type Output = B<M>;

    fn compare<O: Op<Compare>>(_: &M, _: O, _: Self, _: Self) -> B<M> {
        unreachable!("no enum with fields is comparable")
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, T: Type> Method<{ name("is_some") }, M, ()> for OptionOn<M, T> {
    type Output = B<M>;

    #[inline(always)]
    fn call(self, _: &M, (): ()) -> B<M> {
        self.is_some
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, T: Type> Method<{ name("is_none") }, M, ()> for OptionOn<M, T> {
    type Output = B<M>;

    #[inline(always)]
    fn call(self, m: &M, (): ()) -> B<M> {
        B(m.bool_not(self.is_some.0))
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, T: Type, V: Inferred<M, Host = T>> Method<{ name("unwrap_or") }, M, (V,)>
    for OptionOn<M, T>
{
    type Output = T::On<M>;

    #[inline(always)]
    fn call(self, m: &M, (other,): (V,)) -> T::On<M> {
        index::choose(m, self.is_some.0, self.value, other.give(m))
    }
}
