//! Values as 32-bit words, one per scalar: the storage of an enum's variants.

use super::{B, Branch, Kinds, Leaves, Machine, Scalar, Type, U, Value, op};

/// Converts a value to words; those beyond its scalars are 0.
#[inline]
pub fn to_words<T: Type, const N: usize>(v: T) -> [u32; N] {
    let m = Scalar::default();
    to_words_on::<Scalar, T, N>(&m, T::splat(&m, v)).map(|w| w.0)
}

/// Converts like [`to_words`], on any machine.
#[inline(always)]
pub fn to_words_on<M: Machine, T: Type, const N: usize>(m: &M, v: T::On<M>) -> [U<M>; N] {
    let mut writer = Writer { words: [U(m.u32(0)); N], next: 0 };
    T::On::zip(m, v, v, &mut writer);
    writer.words
}

/// Converts words to a value.
#[inline(always)]
pub fn of_words<M: Machine, T: Type, const N: usize>(m: &M, words: [U<M>; N]) -> T::On<M> {
    let zero = T::On::zero(m);
    T::On::zip(m, zero, zero, &mut Reader { words, next: 0 })
}

/// Converts words to a value of the host.
#[inline]
pub fn host_of_words<T: Type, const N: usize>(words: [u32; N]) -> T {
    T::lane::<Scalar>(&of_words::<Scalar, T, N>(&Scalar::default(), words.map(U)), 0)
}

/// Returns whether the kind is `number`, of `count` variants.
#[inline(always)]
pub fn is_kind<M: Machine>(m: &M, kind: U<M>, number: u32, count: u32) -> B<M> {
    if count == 1 {
        return B(m.bool(true));
    }
    B(m.u32_compare(op::Eq, kind.0, m.u32(number)))
}

/// Runs `then` where the kind is `number`, of `count` kinds: never if no primitive of the scene has
/// that kind, and without a test if all have it.
#[inline(always)]
pub fn of_kind<M: Machine>(
    m: &M,
    kinds: Kinds,
    kind: U<M>,
    number: u32,
    count: u32,
    then: impl FnOnce(),
) {
    if !kinds.has(number) {
        return;
    }
    if count == 1 || kinds.is_only(number) {
        return then();
    }
    let branch = Branch::new(m, is_kind(m, kind, number, count));
    if branch.then(m) {
        then();
    }
    branch.end(m);
}

struct Writer<M: Machine, const N: usize> {
    words: [U<M>; N],
    next: usize,
}

impl<M: Machine, const N: usize> Writer<M, N> {
    #[inline(always)]
    fn put(&mut self, word: M::U32) {
        self.words[self.next] = U(word);
        self.next += 1;
    }
}

impl<M: Machine, const N: usize> Leaves<M> for Writer<M, N> {
    #[inline(always)]
    fn f32(&mut self, m: &M, a: M::F32, _: M::F32) -> M::F32 {
        self.put(m.f32_to_bits(a));
        a
    }
    #[inline(always)]
    fn i32(&mut self, m: &M, a: M::I32, _: M::I32) -> M::I32 {
        self.put(m.i32_to_u32(a));
        a
    }
    #[inline(always)]
    fn u32(&mut self, _: &M, a: M::U32, _: M::U32) -> M::U32 {
        self.put(a);
        a
    }
    #[inline(always)]
    fn bool(&mut self, m: &M, a: M::Bool, _: M::Bool) -> M::Bool {
        self.put(m.bool_to_u32(a));
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
        m.u32_compare(op::Ne, self.take(), m.u32(0))
    }
}
