//! Views of grids, transfer functions and volumes: what kernels capture, or take as parameters.

/// Implements the traits by which kernels capture a table, and take it by reference, for one that
/// has `named_view` and whose view is a `TableView`. `$name` is its name where it has none of its
/// own.
macro_rules! table {
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

            fn resources(&self, visit: &mut dyn FnMut(&dyn Resource)) {
                TableView::resources(&self.named_view($name), visit);
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

pub(super) use table;
