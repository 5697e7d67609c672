//! Captures: values of the surrounding code that a kernel uses.

use std::borrow::Cow;

use glam::{
    Affine3, BVec2, BVec3, BVec4, IVec2, IVec3, IVec4, Mat3, Mat4, UVec2, UVec3, UVec4, Vec2, Vec3,
    Vec4,
};

use super::{Description, F, HostCapture, Machine, Recorder, Schema, Type, Value, wgsl::BufferKey};

/// Data that recorded kernels read from buffers.
pub trait Resource {
    /// Returns the bytes behind `key`, if they belong to this resource.
    fn bytes(&self, key: BufferKey) -> Option<Cow<'_, [u8]>>;

    /// Adds what a recording depends on: all numbers and buffers that it may read, under the names
    /// that they have there, and every fact that a branch of the host decides by. Unless a resource
    /// says otherwise it leaves the description open, and its kernels are recorded each for itself.
    /// A kernel with the same facts takes over a recording: a fact that is left out is a wrong
    /// program.
    fn describe(&self, out: &mut Description) {
        out.leave_open();
    }
}

/// What is not described.
struct Undescribed;

impl Resource for Undescribed {
    fn bytes(&self, _: BufferKey) -> Option<Cow<'_, [u8]>> {
        None
    }
}

/// A captured number or struct of numbers.
struct CapturedValue {
    name: &'static str,
    schema: &'static Schema,
    bytes: Vec<u8>,
}

impl Resource for CapturedValue {
    fn bytes(&self, _: BufferKey) -> Option<Cow<'_, [u8]>> {
        None
    }

    fn describe(&self, out: &mut Description) {
        out.value(self.name, self.schema, &self.bytes);
    }
}

/// Visits a captured value.
#[doc(hidden)]
pub fn visit_value<T: Type>(v: T, name: &'static str, visit: &mut dyn FnMut(&dyn Resource)) {
    let mut bytes = vec![0; T::SCHEMA.size().max(size_of::<T>())];
    v.write(&mut bytes);
    visit(&CapturedValue { name, schema: T::SCHEMA, bytes });
}

/// Visits a captured value that is known while a kernel is recorded.
#[doc(hidden)]
pub fn visit_known<T: Type>(v: T, visit: &mut dyn FnMut(&dyn Resource)) {
    visit_value(v, "known", &mut |resource| visit(&Constant(resource)));
}

/// A fact that a branch of the host decides by while a kernel is recorded: a truth value, a count.
pub struct HostFact(pub u64);

impl Resource for HostFact {
    fn bytes(&self, _: BufferKey) -> Option<Cow<'_, [u8]>> {
        None
    }

    fn describe(&self, out: &mut Description) {
        out.fact(self.0);
    }
}

/// What a constant of the source is: a part of what is recorded. A local may be spelled like one.
#[doc(hidden)]
pub struct ConstantFact<'c, T: ?Sized>(pub &'c T);

impl<T: Capture<Recorder> + ?Sized> ConstantFact<'_, T> {
    /// Visits the constant; method resolution prefers this to [`VisitConstant::visit`].
    pub fn visit(&self, visit: &mut dyn FnMut(&dyn Resource)) {
        self.0.resources("constant", &mut |resource| visit(&Constant(resource)));
    }
}

/// Visits constants of other types, such as those of the host alone.
#[doc(hidden)]
pub trait VisitConstant {
    /// Visits the constant.
    fn visit(&self, visit: &mut dyn FnMut(&dyn Resource));
}

impl<T: ?Sized> VisitConstant for ConstantFact<'_, T> {
    fn visit(&self, visit: &mut dyn FnMut(&dyn Resource)) {
        visit(&Undescribed);
    }
}

/// A resource of a constant, whose numbers are facts.
struct Constant<'r>(&'r dyn Resource);

impl Resource for Constant<'_> {
    fn bytes(&self, key: BufferKey) -> Option<Cow<'_, [u8]>> {
        self.0.bytes(key)
    }

    fn describe(&self, out: &mut Description) {
        out.constant(self.0);
    }
}

/// Visits a captured value that is used as one of the host.
#[doc(hidden)]
pub fn visit_host<T: HostCapture>(v: &T, visit: &mut dyn FnMut(&dyn Resource)) {
    match v.fact() {
        Some(fact) => visit(&HostFact(fact)),
        None => visit(&Undescribed),
    }
}

/// A value of the host that a kernel may capture.
#[diagnostic::on_unimplemented(
    message = "a kernel cannot capture a `{Self}`",
    note = "numbers, vectors, types with #[derive(Type)], arrays and slices of them, trees and textures can be captured",
    note = "a member of a struct that is no such type is captured by a name: `let spans = &scene.spans;`",
    note = "a function is passed to a kernel in a closure: `|x| half(x)`"
)]
pub trait Capture<M: Machine> {
    /// Its type inside the kernel.
    type On<'c>: Value<M>
    where
        Self: 'c;

    /// Brings the value to the machine under its name in the source.
    fn capture<'c>(&'c self, m: &M, name: &'static str) -> Self::On<'c>;

    /// Brings a constant of the source to the machine.
    fn constant<'c>(&'c self, m: &M) -> Self::On<'c>;

    /// Visits what recorded code may read, under its name in the source, and a [`HostFact`] for
    /// each value of the host by which it branches or that it writes down.
    fn resources(&self, name: &'static str, visit: &mut dyn FnMut(&dyn Resource)) {
        let _ = name;
        visit(&Undescribed);
    }
}

/// A type that a kernel may take by `&`: a value, which is copied, or data that it reads in place.
#[diagnostic::on_unimplemented(
    message = "a kernel cannot take a `&{Self}`",
    note = "values of the kernel language, slices of them, trees and textures can be parameters"
)]
pub trait Parameter {
    /// Its type inside the kernel.
    type On<'a, M: Machine>: Value<M>;
}

impl<T: Type> Parameter for T {
    type On<'a, M: Machine> = <T as Type>::On<M>;
}

#[diagnostic::do_not_recommend]
impl<M: Machine, T: Capture<M> + ?Sized> Capture<M> for &T {
    type On<'c>
        = T::On<'c>
    where
        Self: 'c;

    #[inline(always)]
    fn capture<'c>(&'c self, m: &M, name: &'static str) -> T::On<'c> {
        T::capture(self, m, name)
    }

    #[inline(always)]
    fn constant<'c>(&'c self, m: &M) -> T::On<'c> {
        T::constant(self, m)
    }

    fn resources(&self, name: &'static str, visit: &mut dyn FnMut(&dyn Resource)) {
        T::resources(self, name, visit);
    }
}

macro_rules! capture_number {
    ($($host:ty),+ $(,)?) => {
        $(
            #[diagnostic::do_not_recommend]
            impl<M: Machine> Capture<M> for $host {
                type On<'c> = <$host as Type>::On<M>;

                #[inline(always)]
                fn capture(&self, m: &M, name: &'static str) -> <$host as Type>::On<M> {
                    m.capture(name, *self)
                }

                #[inline(always)]
                fn constant(&self, m: &M) -> <$host as Type>::On<M> {
                    <$host as Type>::splat(m, *self)
                }

                fn resources(&self, name: &'static str, visit: &mut dyn FnMut(&dyn Resource)) {
                    visit_value(*self, name, visit);
                }
            }
        )+
    };
}

/// Distinguishes a constant from a captured number: it may have more digits than an `f32`.
#[diagnostic::do_not_recommend]
impl<M: Machine> Capture<M> for f32 {
    type On<'c> = F<M>;

    #[inline(always)]
    fn capture(&self, m: &M, name: &'static str) -> F<M> {
        m.capture(name, *self)
    }

    #[inline(always)]
    fn constant(&self, m: &M) -> F<M> {
        F(m.f32_constant(*self))
    }

    fn resources(&self, name: &'static str, visit: &mut dyn FnMut(&dyn Resource)) {
        visit_value(*self, name, visit);
    }
}

capture_number!(
    i32, u32, usize, Vec2, Vec3, Vec4, IVec2, IVec3, IVec4, UVec2, UVec3, UVec4, BVec2, BVec3,
    BVec4, Mat3, Mat4, Affine3,
);

/// Captures an array as a value: its elements are numbers of the kernel, and a computed index
/// selects one. A table is better captured as a slice.
#[diagnostic::do_not_recommend]
impl<M: Machine, T: Type, const N: usize> Capture<M> for [T; N] {
    type On<'c> = [T::On<M>; N];

    #[inline(always)]
    fn capture(&self, m: &M, name: &'static str) -> [T::On<M>; N] {
        m.capture(name, *self)
    }

    #[inline(always)]
    fn constant(&self, m: &M) -> [T::On<M>; N] {
        <[T; N]>::splat(m, *self)
    }

    fn resources(&self, name: &'static str, visit: &mut dyn FnMut(&dyn Resource)) {
        visit_value(*self, name, visit);
    }
}

/// Leaves a captured `bool` a value of the host: a branch on it is decided while recording.
#[diagnostic::do_not_recommend]
impl<M: Machine> Capture<M> for bool {
    type On<'c> = bool;

    #[inline(always)]
    fn capture(&self, _: &M, _: &'static str) -> bool {
        *self
    }

    #[inline(always)]
    fn constant(&self, _: &M) -> bool {
        *self
    }

    fn resources(&self, _: &'static str, visit: &mut dyn FnMut(&dyn Resource)) {
        visit(&HostFact((*self).into()));
    }
}
