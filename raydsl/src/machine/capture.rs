//! What a kernel may take from the code around it.

use std::borrow::Cow;

use glam::{Vec2, Vec3, Vec4};

use super::{F, I, Machine, Type, U, V2, V3, V4, Value, wgsl::BufferKey};

/// Data that recorded kernels read from buffers.
pub trait Resource {
    /// The bytes behind `key`, if they belong to this resource.
    fn bytes(&self, key: BufferKey) -> Option<Cow<'_, [u8]>>;
}

/// A value of the host that a kernel may capture.
#[diagnostic::on_unimplemented(
    message = "a kernel cannot capture a `{Self}`",
    note = "numbers, vectors, types with #[derive(Type)], trees and slices of primitives can be captured"
)]
pub trait Capture<M: Machine> {
    /// What stands for it inside the kernel.
    type On<'c>: Value<M>
    where
        Self: 'c;

    /// Brings the value to the machine under the name that it has in the source.
    fn capture<'c>(&'c self, m: &M, name: &'static str) -> Self::On<'c>;

    /// Brings a constant of the source to the machine.
    fn constant<'c>(&'c self, m: &M) -> Self::On<'c>;

    /// Shows the buffers that recorded code may read.
    fn resources(&self, visit: &mut dyn FnMut(&dyn Resource)) {
        let _ = visit;
    }
}

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

    fn resources(&self, visit: &mut dyn FnMut(&dyn Resource)) {
        T::resources(self, visit);
    }
}

macro_rules! capture_number {
    ($($host:ty => $twin:ident),+) => {
        $(
            impl<M: Machine> Capture<M> for $host {
                type On<'c> = $twin<M>;

                #[inline(always)]
                fn capture(&self, m: &M, name: &'static str) -> $twin<M> {
                    m.capture(name, *self)
                }

                #[inline(always)]
                fn constant(&self, m: &M) -> $twin<M> {
                    <$host as Type>::splat(m, *self)
                }
            }
        )+
    };
}

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
}

capture_number!(i32 => I, u32 => U, Vec2 => V2, Vec3 => V3, Vec4 => V4);

/// A captured `bool` stays a value of the host: a branch on it is decided while recording.
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
}
