//! Values as words of 32 bits, one a scalar: how an enum of primitives keeps its kinds.

use super::{B, Branch, Compare, Leaves, Machine, Scalar, Type, U, Value};
use crate::geometry::Kinds;

/// The words of a value; those beyond its scalars are 0.
#[inline(always)]
pub fn to_words<T: Type, const N: usize>(v: T) -> [u32; N] {
    let m = Scalar::default();
    let on = T::splat(&m, v);
    let mut writer = Writer { words: [0; N], next: 0 };
    T::On::zip(&m, on, on, &mut writer);
    writer.words
}

/// The value of these words.
#[inline(always)]
pub fn of_words<M: Machine, T: Type, const N: usize>(m: &M, words: [U<M>; N]) -> T::On<M> {
    let zero = T::On::zero(m);
    T::On::zip(m, zero, zero, &mut Reader { words, next: 0 })
}

/// The value of these words, on the host.
pub fn host_of_words<T: Type, const N: usize>(words: [u32; N]) -> T {
    T::lane::<Scalar>(&of_words::<Scalar, T, N>(&Scalar::default(), words.map(U)), 0)
}

/// Runs `then` where the kind is `number`; not at all if no primitive of the scene is of that kind,
/// and unasked if all are.
#[inline(always)]
pub fn of_kind<M: Machine>(m: &M, kinds: Kinds, kind: U<M>, number: u32, then: impl FnOnce()) {
    if !kinds.has(number) {
        return;
    }
    if kinds.is_only(number) {
        return then();
    }
    let branch = Branch::new(m, B(m.u32_compare(Compare::Eq, kind.0, m.u32(number))));
    if branch.then(m) {
        then();
    }
    branch.end(m);
}

struct Writer<const N: usize> {
    words: [u32; N],
    next: usize,
}

impl<const N: usize> Writer<N> {
    #[inline(always)]
    fn put(&mut self, word: u32) {
        self.words[self.next] = word;
        self.next += 1;
    }
}

impl<const N: usize> Leaves<Scalar> for Writer<N> {
    #[inline(always)]
    fn f32(&mut self, _: &Scalar, a: f32, _: f32) -> f32 {
        self.put(a.to_bits());
        a
    }
    #[inline(always)]
    fn i32(&mut self, _: &Scalar, a: i32, _: i32) -> i32 {
        self.put(a as u32);
        a
    }
    #[inline(always)]
    fn u32(&mut self, _: &Scalar, a: u32, _: u32) -> u32 {
        self.put(a);
        a
    }
    #[inline(always)]
    fn bool(&mut self, _: &Scalar, a: bool, _: bool) -> bool {
        self.put(u32::from(a));
        a
    }
}

struct Reader<M: Machine, const N: usize> {
    words: [U<M>; N],
    next: usize,
}

impl<M: Machine, const N: usize> Reader<M, N> {
    #[inline(always)]
    fn take(&mut self) -> M::U32 {
        self.next += 1;
        self.words[self.next - 1].0
    }
}

impl<M: Machine, const N: usize> Leaves<M> for Reader<M, N> {
    #[inline(always)]
    fn f32(&mut self, m: &M, _: M::F32, _: M::F32) -> M::F32 {
        m.f32_from_bits(self.take())
    }
    #[inline(always)]
    fn i32(&mut self, m: &M, _: M::I32, _: M::I32) -> M::I32 {
        m.u32_to_i32(self.take())
    }
    #[inline(always)]
    fn u32(&mut self, _: &M, _: M::U32, _: M::U32) -> M::U32 {
        self.take()
    }
    #[inline(always)]
    fn bool(&mut self, m: &M, _: M::Bool, _: M::Bool) -> M::Bool {
        m.u32_compare(Compare::Ne, self.take(), m.u32(0))
    }
}
