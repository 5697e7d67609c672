//! Data that kernels read in place: slices of the host and anything else with elements.

use std::borrow::Cow;

use super::wgsl::BufferKey;
use super::{
    Capture, Description, Kinds, Leaves, Machine, Parameter, Resource, Schema, Type, Value, stride,
};

/// Elements in the host's memory: a value of the host on every machine.
pub trait Data: Copy {
    /// The element type.
    type Element: Type;

    /// Returns the number of elements.
    fn count(&self) -> usize;

    /// Returns the element `index`.
    ///
    /// # Panics
    ///
    /// If there is no such element.
    fn get(&self, index: u32) -> Self::Element;

    /// Returns the element `index` without asking whether there is one.
    ///
    /// # Safety
    ///
    /// `index` is less than [`count`](Self::count).
    #[inline(always)]
    unsafe fn get_unchecked(&self, index: u32) -> Self::Element {
        self.get(index)
    }

    /// Returns the kinds of the elements, enums, if they are known without reading all.
    fn kinds(&self) -> Option<Kinds> {
        None
    }

    /// Returns the key of the elements among a device's buffers.
    fn key(&self) -> BufferKey;

    /// Returns the name in the source.
    fn name(&self) -> Cow<'static, str>;
}

/// A slice as seen by kernels.
pub struct Slice<'a, T> {
    elements: &'a [T],
    /// The key of elements with a known owner: a device keeps them as long as the owner lives.
    key: Option<BufferKey>,
    name: &'static str,
    suffix: &'static str,
}

impl<T> Clone for Slice<'_, T> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Slice<'_, T> {}

impl<T> core::fmt::Debug for Slice<'_, T> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Slice").field("name", &self.name).field("len", &self.len()).finish()
    }
}

impl<'a, T> Slice<'a, T> {
    /// Creates a slice that is borrowed while kernels run.
    #[inline(always)]
    pub(crate) fn new(elements: &'a [T], name: &'static str) -> Self {
        Self { elements, key: None, name, suffix: "" }
    }

    /// Creates a slice under the key that its owner gives it.
    #[inline(always)]
    pub(crate) fn owned(elements: &'a [T], key: Option<BufferKey>, name: &'static str) -> Self {
        Self { key, ..Self::new(elements, name) }
    }

    /// Returns the slice with `suffix` appended to its name.
    #[inline(always)]
    pub(crate) fn suffixed(self, suffix: &'static str) -> Self {
        Self { suffix, ..self }
    }

    /// Returns the elements.
    #[inline(always)]
    pub fn elements(&self) -> &'a [T] {
        self.elements
    }

    /// Returns the number of elements.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.elements.len()
    }

    /// Returns whether there are no elements.
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.elements.is_empty()
    }

    /// Returns the source name of the value that it is a part of.
    #[inline(always)]
    pub(crate) fn source_name(&self) -> &'static str {
        self.name
    }
}

impl<T: Type> Data for Slice<'_, T> {
    type Element = T;

    #[inline(always)]
    fn count(&self) -> usize {
        self.elements.len()
    }

    #[inline(always)]
    fn get(&self, index: u32) -> T {
        self.elements[index as usize]
    }

    #[inline(always)]
    unsafe fn get_unchecked(&self, index: u32) -> T {
        // SAFETY: the caller says that `index` is less than the number of elements.
        unsafe { *self.elements.get_unchecked(index as usize) }
    }

    /// Returns the owner's key, or one made of address and length.
    fn key(&self) -> BufferKey {
        self.key.unwrap_or_else(|| borrowed_key(self.elements))
    }

    fn name(&self) -> Cow<'static, str> {
        match self.suffix {
            "" => self.name.into(),
            suffix => format!("{}_{suffix}", self.name).into(),
        }
    }
}

/// Returns the key of borrowed data: its address and length, which identify it while the borrow
/// lasts.
pub(crate) fn borrowed_key<T>(elements: &[T]) -> BufferKey {
    let address = elements.as_ptr() as usize as u64;
    let (version, part) = (elements.len() as u32, size_of::<T>() as u32);
    BufferKey { id: address | 1 << 63, version, part }
}

/// Returns whether a key identifies borrowed data.
#[cfg(feature = "gpu")]
pub(crate) fn is_borrowed(key: BufferKey) -> bool {
    key.id >> 63 == 1
}

/// Returns the bytes of elements in the host's layout.
pub(crate) fn bytes_of<T: Type>(elements: &[T]) -> Vec<u8> {
    let stride = stride(T::SCHEMA);
    let mut bytes = vec![0; stride * elements.len()];
    for (element, out) in elements.iter().zip(bytes.chunks_exact_mut(stride)) {
        element.write(out);
    }
    bytes
}

impl<T: Type> Resource for Slice<'_, T> {
    fn bytes(&self, key: BufferKey) -> Option<Cow<'_, [u8]>> {
        (key == self.key()).then(|| Cow::Owned(bytes_of(self.elements)))
    }
}

/// A slice of which kernels read elements and length, and nothing else.
pub(crate) struct DescribedSlice<'a, T>(pub(crate) Slice<'a, T>);

impl<T: Type> Resource for DescribedSlice<'_, T> {
    fn bytes(&self, key: BufferKey) -> Option<Cow<'_, [u8]>> {
        self.0.bytes(key)
    }

    fn describe(&self, out: &mut Description) {
        out.data(&self.0);
    }
}

impl<M: Machine, T> Value<M> for Slice<'_, T> {
    const SCHEMA: &'static Schema = &Schema::Host;

    #[inline(always)]
    fn zero(_: &M) -> Self {
        Self::new(&[], "table")
    }

    #[inline(always)]
    fn zip(_: &M, a: Self, b: Self, _: &mut impl Leaves<M>) -> Self {
        // A variable that was declared and not assigned yet.
        if a.is_empty() {
            return b;
        }
        assert!(
            b.is_empty() || core::ptr::eq(a.elements, b.elements),
            "a kernel cannot choose between two slices by a value of its rays: choose between what it \
             reads from them, or by a captured `bool`"
        );
        a
    }
}

impl<T: Type> Parameter for [T] {
    type On<'a, M: Machine> = Slice<'a, T>;
}

#[diagnostic::do_not_recommend]
impl<M: Machine, T: Type> Capture<M> for [T] {
    type On<'c>
        = Slice<'c, T>
    where
        Self: 'c;

    #[inline(always)]
    fn capture<'c>(&'c self, _: &M, name: &'static str) -> Slice<'c, T> {
        Slice::new(self, name)
    }

    #[inline(always)]
    fn constant<'c>(&'c self, _: &M) -> Slice<'c, T> {
        Slice::new(self, "table")
    }

    fn resources(&self, name: &'static str, visit: &mut dyn FnMut(&dyn Resource)) {
        visit(&DescribedSlice(Slice::new(self, name)));
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, T: Type> Capture<M> for Vec<T> {
    type On<'c>
        = Slice<'c, T>
    where
        Self: 'c;

    #[inline(always)]
    fn capture<'c>(&'c self, m: &M, name: &'static str) -> Slice<'c, T> {
        self.as_slice().capture(m, name)
    }

    #[inline(always)]
    fn constant<'c>(&'c self, m: &M) -> Slice<'c, T> {
        self.as_slice().constant(m)
    }

    fn resources(&self, name: &'static str, visit: &mut dyn FnMut(&dyn Resource)) {
        Capture::<M>::resources(self.as_slice(), name, visit);
    }
}

/// Implements the kernel operations of [`Data`]: its elements by `[]`, `len()` and `is_empty()`.
macro_rules! read_in_place {
    ([$($g:tt)*] $data:ty) => {
        #[diagnostic::do_not_recommend]
        impl<M: $crate::machine::Machine, $($g)*> $crate::machine::Indexed<M> for $data {
            type Element = T::On<M>;

            #[inline(always)]
            fn element(self, m: &M, i: $crate::machine::U<M>) -> T::On<M> {
                m.element(&self, i)
            }

            #[inline(always)]
            fn at(self, m: &M, i: usize) -> T::On<M> {
                m.element(&self, $crate::machine::U(m.u32(i as u32)))
            }

            #[inline(always)]
            fn in_step(self, m: &M, i: u32) -> T::On<M> {
                $crate::machine::element_in_step(m, self, i)
            }
        }

        #[diagnostic::do_not_recommend]
        impl<M: $crate::machine::Machine, $($g)*>
            $crate::machine::Method<{ $crate::machine::name("len") }, M, ()> for $data
        {
            type Output = $crate::machine::Usize<M>;

            #[inline(always)]
            fn call(self, m: &M, (): ()) -> $crate::machine::Usize<M> {
                $crate::machine::Usize(m.len(&self).0)
            }
        }

        #[diagnostic::do_not_recommend]
        impl<M: $crate::machine::Machine, $($g)*>
            $crate::machine::Method<{ $crate::machine::name("is_empty") }, M, ()> for $data
        {
            type Output = $crate::machine::B<M>;

            #[inline(always)]
            fn call(self, m: &M, (): ()) -> $crate::machine::B<M> {
                $crate::machine::B(m.u32_compare($crate::machine::op::Eq, m.len(&self).0, m.u32(0)))
            }
        }
    };
}

pub(crate) use read_in_place;

read_in_place!([T: Type] Slice<'_, T>);
