//! Tables: data that kernels read as a member of the value that they capture.

use super::{DescribedSlice, Resource, Slice, Type};

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
    /// Visits the buffers that recorded code may read, and a [`HostFact`](super::HostFact) for each
    /// value of the host by which it branches.
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
        visit(&DescribedSlice(*self));
    }

    fn is_same(&self, other: &Self) -> bool {
        core::ptr::eq(self.elements(), other.elements())
    }
}

/// Implements the traits by which kernels capture a table, and take it by reference, for one that
/// has `named_view` and whose view is a `TableView`. `$name` is its name where it has none of its
/// own.
macro_rules! table_view {
    ([$($t:ident: $bound:ident)?] $host:ty, $view:ident, $name:literal, $plural:literal) => {
        impl<$($t: $bound)?> Parameter for $host {
            type On<'a, M: Machine> = $view<'a $(, $t)?>;
        }

        impl<M: Machine $(, $t: $bound)?> Value<M> for $view<'_ $(, $t)?> {
            const SCHEMA: &'static Schema = &Schema::Host;

            fn zero(_: &M) -> Self {
                panic!(concat!(
                    "a kernel cannot choose between ",
                    $plural,
                    ": choose between what it reads from them"
                ))
            }

            #[inline(always)]
            fn zip(_: &M, a: Self, b: Self, _: &mut impl Leaves<M>) -> Self {
                assert!(
                    TableView::is_same(&a, &b),
                    concat!(
                        "a kernel cannot choose between ",
                        $plural,
                        ": choose between what it reads from them"
                    )
                );
                a
            }
        }

        #[diagnostic::do_not_recommend]
        impl<M: Machine $(, $t: $bound)?> Capture<M> for $host {
            type On<'c>
                = $view<'c $(, $t)?>
            where
                Self: 'c;

            #[inline(always)]
            fn capture<'c>(&'c self, _: &M, name: &'static str) -> Self::On<'c> {
                self.named_view(name)
            }

            #[inline(always)]
            fn constant<'c>(&'c self, _: &M) -> Self::On<'c> {
                self.named_view($name)
            }

            fn resources(&self, name: &'static str, visit: &mut dyn FnMut(&dyn Resource)) {
                TableView::resources(&self.named_view(name), visit);
            }
        }

        impl<$($t: $bound)?> Table for $host {
            type View<'v>
                = $view<'v $(, $t)?>
            where
                Self: 'v;

            #[inline(always)]
            fn view(&self, name: &'static str) -> Self::View<'_> {
                self.named_view(name)
            }
        }
    };
}

pub(crate) use table_view;
