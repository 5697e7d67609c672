//! Array elements at computed indices.
//!
//! An array on a machine is a list of its elements, so an index is a chain of selections: the last
//! element whose index it reaches. An index out of range is an error of the kernel. With debug
//! assertions it panics and names the lane; without, it means the last element, in every variant.

use super::{Coerce, Data, Leaves, Machine, Type, U, Usize, Value, Varying, op};

/// An integer that can be an index.
#[diagnostic::on_unimplemented(
    message = "a kernel cannot index by this value",
    label = "not a `usize`",
    note = "write `a[i as usize]`"
)]
pub trait Index<M: Machine> {
    /// Returns the index as 32 bits.
    fn index(self, m: &M) -> U<M>;
}

#[diagnostic::do_not_recommend]
impl<M: Machine> Index<M> for Usize<M> {
    #[inline(always)]
    fn index(self, _: &M) -> U<M> {
        U(self.0)
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine> Index<M> for usize {
    #[inline(always)]
    fn index(self, m: &M) -> U<M> {
        U(m.u32(self as u32))
    }
}

/// A value that can be indexed.
#[diagnostic::on_unimplemented(
    message = "a kernel cannot index this value",
    label = "neither an array nor a slice of types that kernels understand"
)]
pub trait Indexed<M: Machine> {
    /// The element type.
    type Element;
    /// Returns the element at `i`.
    fn element(self, m: &M, i: U<M>) -> Self::Element;
    /// Returns the element at an index written in the source.
    fn at(self, m: &M, i: usize) -> Self::Element;
    /// Returns the element at an index that is the same in all running lanes.
    fn in_step(self, m: &M, i: u32) -> Self::Element;
}

#[diagnostic::do_not_recommend]
impl<M: Machine, V: Varying<M> + Copy, const N: usize> Indexed<M> for [V; N] {
    type Element = V::Value;

    #[inline(always)]
    fn element(self, m: &M, i: U<M>) -> V::Value {
        const { assert!(N > 0, "an array without elements cannot be indexed") };
        m.check_index(&i.0, N as u32);
        let all = self.map(
            #[inline(always)]
            |v| v.varying(m),
        );
        let mut found = all[0];
        for (k, v) in all.into_iter().enumerate().skip(1) {
            let reached = m.u32_compare(op::Ge, i.0, m.u32(k as u32));
            found = choose(m, reached, v, found);
        }
        found
    }

    #[inline(always)]
    fn at(self, m: &M, i: usize) -> V::Value {
        self[i].varying(m)
    }

    #[inline(always)]
    fn in_step(self, m: &M, i: u32) -> V::Value {
        const { assert!(N > 0, "an array without elements cannot be indexed") };
        m.check_index(&m.u32(i), N as u32);
        self[(i as usize).min(N - 1)].varying(m)
    }
}

/// Returns the element at an index that is the same in all running lanes.
#[inline(always)]
pub(crate) fn element_in_step<M: Machine, D: Data>(
    m: &M,
    data: D,
    i: u32,
) -> <D::Element as Type>::On<M> {
    let len = u32::try_from(data.count()).unwrap_or(u32::MAX);
    m.check_index(&m.u32(i), len);
    // An empty slice has no last element to return.
    if len == 0 {
        return Value::zero(m);
    }
    D::Element::splat(m, data.get(i.min(len - 1)))
}

/// Returns `array` with `v` at `i`.
#[inline(always)]
pub fn with_element<M: Machine, V: Value<M>, const N: usize>(
    m: &M,
    array: [V; N],
    i: impl Index<M>,
    v: impl Coerce<M, V>,
) -> [V; N] {
    const { assert!(N > 0, "an array without elements cannot be indexed") };
    let (i, v) = (i.index(m), v.coerce(m));
    m.check_index(&i.0, N as u32);
    let mut k = 0;
    array.map(
        #[inline(always)]
        |old| {
            // The last element also serves indices out of range.
            let number = m.u32(k as u32);
            k += 1;
            let here = if k < N {
                m.u32_compare(op::Eq, i.0, number)
            } else {
                m.u32_compare(op::Ge, i.0, number)
            };
            choose(m, here, v, old)
        },
    )
}

struct Choose<M: Machine>(M::Bool);

macro_rules! choose {
    ($($leaf:ident $repr:ident $select:ident),+) => {
        impl<M: Machine> Leaves<M> for Choose<M> {
            $(
                #[inline(always)]
                fn $leaf(&mut self, m: &M, a: M::$repr, b: M::$repr) -> M::$repr {
                    m.$select(self.0, a, b)
                }
            )+
        }
    };
}

choose!(f32 F32 f32_select, i32 I32 i32_select, u32 U32 u32_select, bool Bool bool_select);

/// Returns `a` in the lanes that have `c`, else `b`.
#[inline(always)]
pub(crate) fn choose<M: Machine, V: Value<M>>(m: &M, c: M::Bool, a: V, b: V) -> V {
    V::zip(m, a, b, &mut Choose(c))
}
