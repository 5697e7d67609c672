//! What the primitives of a tree share: slices of the application.

use core::fmt;

use crate::machine::wgsl::BufferKey;
use crate::machine::{Description, Slice, Type, bytes_of};

/// Types of the slices that the primitives of a tree share: a [`Type`] for one slice of it, `()` for
/// none, or [`Several`].
///
/// It is implemented for both, and not for types of an application.
pub trait Shared: Copy + Send + Sync + 'static {
    /// The slices in the application's memory: `&[T]`, or a tuple of such.
    type Slices<'a>: Copy + Send + Sync + IntoShared<'a, Self>;

    /// The slices in kernels.
    #[doc(hidden)]
    type Views<'a>: Copy;

    /// The element types of the slices, and `()` for each that is not there.
    #[doc(hidden)]
    type First: Type;
    #[doc(hidden)]
    type Second: Type;
    #[doc(hidden)]
    type Third: Type;

    /// The number of slices.
    #[doc(hidden)]
    const COUNT: u32;

    #[doc(hidden)]
    fn store<'a>(all: Self::Slices<'a>) -> SharedStore<'a, Self>;

    #[doc(hidden)]
    fn load(stored: SharedStore<'_, Self>) -> Self::Slices<'_>;

    #[doc(hidden)]
    fn views<'a>(stored: SharedStore<'a, Self>, names: Names) -> Self::Views<'a>;

    /// Returns the slices of the host that kernels see.
    #[doc(hidden)]
    fn of_views<'a>(views: Self::Views<'a>) -> Self::Slices<'a>;
}

/// Several slices that the primitives of a tree share: `Several<(A, B)>`, or `Several<(A, B, C)>`.
///
/// An enum of primitives whose kinds share different data names it:
/// `#[primitive(shared(Vec3, f32))]`.
#[derive(Clone, Copy, Debug)]
pub struct Several<T>(core::marker::PhantomData<T>);

/// The slices that primitives of type `P` share.
pub type SharedSlices<'a, P> = <<P as super::Primitive>::Shared as Shared>::Slices<'a>;

/// The slices that primitives of type `P` share, in kernels.
#[doc(hidden)]
pub type SharedViews<'a, P> = <<P as super::Primitive>::Shared as Shared>::Views<'a>;

/// What an application passes as the data that primitives share: a reference to a slice, a vector or
/// an array; or a tuple of them where kinds of an enum share [several](Several).
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not what the primitives share",
    note = "primitives that share a `T` take a `&[T]` or a `&Vec<T>`, those without shared data \
            `&[]`, and an enum with `#[primitive(shared(A, B))]` a tuple `(&a, &b)`"
)]
pub trait IntoShared<'a, S: Shared> {
    /// Returns the slices.
    fn into_shared(self) -> S::Slices<'a>;
}

impl<'a, T: Type, C: AsRef<[T]> + ?Sized> IntoShared<'a, T> for &'a C {
    #[inline(always)]
    fn into_shared(self) -> &'a [T] {
        self.as_ref()
    }
}

/// The names of the slices, of which a kernel's text has some.
const SUFFIXES: [&str; 3] = ["shared", "shared_2", "shared_3"];

/// The name of the scene whose primitives share the slices, and the keys of their buffers: one
/// whose part differs.
#[doc(hidden)]
#[derive(Clone, Copy, Debug)]
pub struct Names {
    name: &'static str,
    key: Option<BufferKey>,
    parts: [u32; 3],
}

impl Names {
    /// Of slices that no buffer is made of.
    const NONE: Self = Self { name: "", key: None, parts: [0; 3] };

    /// Names slices after a scene.
    #[inline(always)]
    pub(crate) fn new(name: &'static str, key: Option<BufferKey>, parts: [u32; 3]) -> Self {
        Self { name, key, parts }
    }

    #[inline(always)]
    fn slice<T>(self, place: usize, elements: &[T]) -> Slice<'_, T> {
        let key = self.key.map(|key| BufferKey { part: self.parts[place], ..key });
        Slice::owned(elements, key, self.name).suffixed(SUFFIXES[place])
    }
}

/// The slices of a tree. A struct of references, since a tree may be lent for less time than its
/// slices: of `S::Slices<'a>` the compiler does not know that.
#[doc(hidden)]
pub struct SharedStore<'a, S: Shared> {
    first: &'a [S::First],
    second: &'a [S::Second],
    third: &'a [S::Third],
}

impl<S: Shared> Clone for SharedStore<'_, S> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<S: Shared> Copy for SharedStore<'_, S> {}

impl<S: Shared> fmt::Debug for SharedStore<'_, S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { first, second, third } = self;
        let lengths = [first.len(), second.len(), third.len()];
        f.debug_list().entries(&lengths[..S::COUNT as usize]).finish()
    }
}

impl<'a, S: Shared> SharedStore<'a, S> {
    /// No elements.
    pub(crate) const NONE: Self = Self { first: &[], second: &[], third: &[] };

    /// Returns the slices of the application.
    #[inline(always)]
    pub(crate) fn slices(self) -> S::Slices<'a> {
        S::load(self)
    }

    /// Returns the slices for a machine of the CPU, which needs no names.
    #[inline(always)]
    pub(crate) fn views(self) -> S::Views<'a> {
        S::views(self, Names::NONE)
    }

    /// Returns whether both are the same slices, or empty ones.
    pub(crate) fn is_same(self, other: Self) -> bool {
        fn same<T>(a: &[T], b: &[T]) -> bool {
            core::ptr::eq(a, b) || a.is_empty() && b.is_empty()
        }
        same(self.first, other.first)
            && same(self.second, other.second)
            && same(self.third, other.third)
    }

    /// Returns the bytes of the slice at `place`, in the host's layout; none if there is no such
    /// slice.
    pub(crate) fn bytes(self, place: u32) -> Option<Vec<u8>> {
        (place < S::COUNT).then(|| match place {
            0 => bytes_of(self.first),
            1 => bytes_of(self.second),
            _ => bytes_of(self.third),
        })
    }

    /// Describes the slices to a recording.
    pub(crate) fn describe(self, names: Names, out: &mut Description) {
        let Self { first, second, third } = self;
        out.data(&names.slice(0, first));
        if S::COUNT > 1 {
            out.data(&names.slice(1, second));
        }
        if S::COUNT > 2 {
            out.data(&names.slice(2, third));
        }
    }
}

impl<T: Type> Shared for T {
    type Slices<'a> = &'a [T];
    type Views<'a> = Slice<'a, T>;
    type First = T;
    type Second = ();
    type Third = ();

    const COUNT: u32 = 1;

    #[inline(always)]
    fn store<'a>(all: Self::Slices<'a>) -> SharedStore<'a, T> {
        SharedStore { first: all, second: &[], third: &[] }
    }

    #[inline(always)]
    fn load(stored: SharedStore<'_, T>) -> &[T] {
        stored.first
    }

    #[inline(always)]
    fn views<'a>(stored: SharedStore<'a, T>, names: Names) -> Slice<'a, T> {
        names.slice(0, stored.first)
    }

    #[inline(always)]
    fn of_views<'a>(views: Self::Views<'a>) -> &'a [T] {
        views.elements()
    }
}

/// Implements the traits for several slices; last come the third type, and the third slice if it is
/// not there.
macro_rules! several {
    ([$($t:ident $x:ident $at:tt $place:ident),+] $count:literal [$third:ty] [$($none:tt)*]) => {
        impl<$($t: Type),+> Shared for Several<($($t,)+)> {
            type Slices<'a> = ($(&'a [$t],)+);
            type Views<'a> = ($(Slice<'a, $t>,)+);
            type First = A;
            type Second = B;
            type Third = $third;

            const COUNT: u32 = $count;

            #[inline(always)]
            fn store<'a>(all: Self::Slices<'a>) -> SharedStore<'a, Self> {
                SharedStore { $($place: all.$at,)+ $($none)* }
            }

            #[inline(always)]
            fn load(stored: SharedStore<'_, Self>) -> Self::Slices<'_> {
                ($(stored.$place,)+)
            }

            #[inline(always)]
            fn views<'a>(stored: SharedStore<'a, Self>, names: Names) -> Self::Views<'a> {
                ($(names.slice($at, stored.$place),)+)
            }

            #[inline(always)]
            fn of_views<'a>(views: Self::Views<'a>) -> Self::Slices<'a> {
                ($(views.$at.elements(),)+)
            }
        }

        impl<'a, $($t: Type,)+ $($x: IntoShared<'a, $t>),+> IntoShared<'a, Several<($($t,)+)>>
            for ($($x,)+)
        {
            #[inline(always)]
            fn into_shared(self) -> ($(&'a [$t],)+) {
                ($(self.$at.into_shared(),)+)
            }
        }
    };
}

several!([A X 0 first, B Y 1 second] 2 [()] [third: &[]]);
several!([A X 0 first, B Y 1 second, C Z 2 third] 3 [C] []);

/// `Self` is `T`: the data that a kind of an enum shares are those that the other kinds share.
#[diagnostic::on_unimplemented(
    message = "the kinds of a primitive share `{Self}` and `{T}`, which the enum must name",
    label = "its primitives share `{Self}`, those of another kind `{T}`",
    note = "name each type of element once on the enum, `#[primitive(shared(A, B))]`, and pass a slice of \
            each to the tree: `Bvh::build_sharing(&prims, (&first, &second), &config)`"
)]
#[doc(hidden)]
pub trait SharedAs<T: Shared>: Shared {
    /// Returns the same slices.
    fn of<'a>(all: T::Views<'a>) -> Self::Views<'a>;
}

impl<S: Shared> SharedAs<S> for S {
    #[inline(always)]
    fn of<'a>(all: S::Views<'a>) -> S::Views<'a> {
        all
    }
}

/// Returns what the primitives of kind `K` share, of what an enum's share.
#[doc(hidden)]
#[inline(always)]
pub fn shared_of_kind<K: super::Primitive, S: Shared>(
    all: S::Views<'_>,
) -> <K::SharedOr<()> as Shared>::Views<'_>
where
    K::SharedOr<S>: SharedAs<S>,
{
    K::map_shared::<S, ()>(<K::SharedOr<S> as SharedAs<S>>::of(all), |_| shared_views::<()>(&[]))
}

/// The place of a type among several: see [`SharedAmong`].
#[doc(hidden)]
#[derive(Debug)]
pub struct Place<const I: usize>;

/// What a kind of an enum shares is among the `All` that the enum names; `At` says where.
#[diagnostic::on_unimplemented(
    message = "a kind of the primitive shares `{Self}`, which `shared(..)` of the enum lacks",
    label = "its primitives share `{Self}`",
    note = "name each type that kinds share once: `#[primitive(shared(A, B))]`"
)]
#[doc(hidden)]
pub trait SharedAmong<All: Shared, At>: Shared {
    /// Returns the slices of the kind.
    fn of<'a>(all: All::Views<'a>) -> Self::Views<'a>;
}

/// One slice of `Self` is among the `All` that an enum names.
#[doc(hidden)]
pub trait OneAmong<All: Shared, At>: Type {
    /// Returns the slice.
    fn of<'a>(all: All::Views<'a>) -> Slice<'a, Self>;
}

/// Implements the choice of a slice from among several.
macro_rules! among {
    ($(($($t:ident),+) $one:ident $at:tt;)+) => {
        $(
            impl<$($t: Type),+> OneAmong<Several<($($t,)+)>, Place<$at>> for $one {
                #[inline(always)]
                fn of<'a>(all: <Several<($($t,)+)> as Shared>::Views<'a>) -> Slice<'a, $one> {
                    all.$at
                }
            }
        )+
    };
}

among! {
    (A, B) A 0;
    (A, B) B 1;
    (A, B, C) A 0;
    (A, B, C) B 1;
    (A, B, C) C 2;
}

/// A kind that shares nothing.
impl<T> OneAmong<Several<T>, ()> for ()
where
    Several<T>: Shared,
{
    #[inline(always)]
    fn of<'a>(_: <Several<T> as Shared>::Views<'a>) -> Slice<'a, ()> {
        shared_views::<()>(&[])
    }
}

impl<All: Shared, T: OneAmong<All, At>, At> SharedAmong<All, At> for T {
    #[inline(always)]
    fn of<'a>(all: All::Views<'a>) -> Slice<'a, T> {
        <T as OneAmong<All, At>>::of(all)
    }
}

/// A kind that is an enum, and shares two of them.
impl<All: Shared, A, B, I, J> SharedAmong<All, (I, J)> for Several<(A, B)>
where
    A: OneAmong<All, I>,
    B: OneAmong<All, J>,
{
    #[inline(always)]
    fn of<'a>(all: All::Views<'a>) -> (Slice<'a, A>, Slice<'a, B>) {
        (<A as OneAmong<All, I>>::of(all), <B as OneAmong<All, J>>::of(all))
    }
}

/// A kind that is an enum, and shares three.
impl<All: Shared, A, B, C, I, J, K> SharedAmong<All, (I, J, K)> for Several<(A, B, C)>
where
    A: OneAmong<All, I>,
    B: OneAmong<All, J>,
    C: OneAmong<All, K>,
{
    #[inline(always)]
    fn of<'a>(all: All::Views<'a>) -> (Slice<'a, A>, Slice<'a, B>, Slice<'a, C>) {
        (
            <A as OneAmong<All, I>>::of(all),
            <B as OneAmong<All, J>>::of(all),
            <C as OneAmong<All, K>>::of(all),
        )
    }
}

/// Returns what the primitives of kind `K` share, of the several that an enum names.
#[doc(hidden)]
#[inline(always)]
pub fn shared_among<K: super::Primitive, All: Shared, At>(all: All::Views<'_>) -> SharedViews<'_, K>
where
    K::Shared: SharedAmong<All, At>,
{
    <K::Shared as SharedAmong<All, At>>::of(all)
}

/// Returns shared data of the host as slices of a machine.
#[doc(hidden)]
#[inline(always)]
pub fn shared_views<S: Shared>(all: S::Slices<'_>) -> S::Views<'_> {
    S::store(all).views()
}
