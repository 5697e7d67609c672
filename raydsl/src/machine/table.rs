//! Tables: data that kernels read as a member of the value that they capture.

use super::{Resource, Slice, Type};

/// A member of a struct of scenes that is data, marked `#[table]`: kernels read
/// `scene.materials[i]`.
#[diagnostic::on_unimplemented(
    message = "a `{Self}` is not a table of a scene",
    note = "a table is a slice, `&'a [T]` or a `Vec<T>`, or a texture; a scene has no `#[table]`"
)]
pub trait Table {
    /// The view that kernels work on.
    type View<'v>: TableView
    where
        Self: 'v;

    /// Returns the view under the member's name.
    fn view(&self, name: &'static str) -> Self::View<'_>;
}

/// A table as kernels see it, or several: a host value on every machine.
pub trait TableView: Copy + Send + Sync {
    /// Visits the buffers that recorded code may read.
    fn resources(&self, visit: &mut dyn FnMut(&dyn Resource));

    /// Returns whether it is the same data, not only equal.
    fn is_same(&self, other: &Self) -> bool;
}

impl<T: Table + ?Sized> Table for &T {
    type View<'v>
        = T::View<'v>
    where
        Self: 'v;

    #[inline(always)]
    fn view(&self, name: &'static str) -> T::View<'_> {
        T::view(self, name)
    }
}

impl<T: Type> Table for [T] {
    type View<'v>
        = Slice<'v, T>
    where
        Self: 'v;

    #[inline(always)]
    fn view(&self, name: &'static str) -> Slice<'_, T> {
        Slice::new(self, name)
    }
}

impl<T: Type> Table for Vec<T> {
    type View<'v>
        = Slice<'v, T>
    where
        Self: 'v;

    #[inline(always)]
    fn view(&self, name: &'static str) -> Slice<'_, T> {
        Slice::new(self, name)
    }
}

impl<T: Type> TableView for Slice<'_, T> {
    fn resources(&self, visit: &mut dyn FnMut(&dyn Resource)) {
        visit(self);
    }

    fn is_same(&self, other: &Self) -> bool {
        core::ptr::eq(self.elements(), other.elements())
    }
}
