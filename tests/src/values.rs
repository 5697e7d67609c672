//! Random values of any kernel type, and what "the same bits" means.

use raydsl::machine::{Schema, Type};

use crate::rng::Rng;

/// Where random numbers come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Numbers {
    /// Special bit patterns, random bits, small numbers.
    Any,
    /// Small numbers: `u32` up to 20, `i32` and `f32` of either sign.
    Tame,
}

/// Bit patterns with which arithmetic goes wrong first.
pub const SPECIAL_F32: &[f32] = &[
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    -0.5,
    1.5,
    -1.5,
    2.5,
    0.499_999_97,
    f32::NAN,
    -f32::NAN,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::MAX,
    f32::MIN,
    f32::MIN_POSITIVE,
    -f32::MIN_POSITIVE,
    f32::EPSILON,
    1e10,
    -1e10,
    1e-30,
    16_777_215.0,
    8_388_607.5,
    2_147_483_520.0,
    2_147_483_648.0,
    -2_147_483_648.0,
    -2_147_483_904.0,
    4_294_967_040.0,
    4_294_967_296.0,
];

/// Integers with which arithmetic goes wrong first.
pub const SPECIAL_U32: &[u32] = &[
    0,
    1,
    2,
    3,
    31,
    32,
    33,
    255,
    65_535,
    16_777_217,
    0x7fff_ffff,
    0x8000_0000,
    0x8000_0001,
    0xffff_ff80,
    0xffff_fffe,
    0xffff_ffff,
];

impl Numbers {
    fn f32(self, rng: &mut Rng) -> f32 {
        match (self, rng.below(4)) {
            (Self::Any, 0) => rng.pick(SPECIAL_F32),
            (Self::Any, 1) => normal(f32::from_bits(rng.bits() as u32)),
            (_, 2) => rng.range(-8.0, 8.0).round() * 0.5,
            _ => rng.range(-100.0, 100.0),
        }
    }

    fn u32(self, rng: &mut Rng) -> u32 {
        match (self, rng.below(3)) {
            (Self::Any, 0) => rng.pick(SPECIAL_U32),
            (Self::Any, 1) => rng.bits() as u32,
            _ => rng.below(21) as u32,
        }
    }

    fn i32(self, rng: &mut Rng) -> i32 {
        match (self, rng.below(3)) {
            (Self::Any, 0) => rng.pick(SPECIAL_U32) as i32,
            (Self::Any, 1) => rng.bits() as i32,
            _ => rng.below(41) as i32 - 20,
        }
    }
}

/// Subnormal numbers become 0: a GPU may flush them.
fn normal(x: f32) -> f32 {
    if x.is_subnormal() { 0.0 } else { x }
}

/// Shows every scalar of a type with its offset in the host's memory.
pub fn each_leaf(schema: &Schema, offset: usize, visit: &mut dyn FnMut(usize, &Schema)) {
    match schema {
        Schema::Host => {}
        Schema::Vector(element, n) => {
            (0..*n).for_each(|i| visit(offset + element.size() * i, element));
        }
        Schema::Array { element, count, stride } => {
            (0..*count).for_each(|i| each_leaf(element, offset + i * stride, visit));
        }
        Schema::Struct { fields, .. } => {
            for f in *fields {
                each_leaf(f.schema, offset + f.offset, visit);
            }
        }
        leaf => visit(offset, leaf),
    }
}

fn from_words<T: Type>(mut word: impl FnMut(&Schema) -> u32) -> T {
    T::read(&bytes_of_words(T::SCHEMA, &mut word))
}

/// The bytes of a value. As all that takes a schema here, it is compiled once, not once a type.
fn bytes_of_words(schema: &Schema, word: &mut dyn FnMut(&Schema) -> u32) -> Vec<u8> {
    let mut bytes = vec![0u8; schema.size()];
    each_leaf(schema, 0, &mut |offset, leaf| {
        let n = leaf.size();
        bytes[offset..offset + n].copy_from_slice(&word(leaf).to_le_bytes()[..n]);
    });
    bytes
}

/// Numbers next to the ends of the range of `f32`, beside [`SPECIAL_F32`].
const DENORMAL: &[f32] = &[1e-45, -1e-45, 1.175_494_2e-38, -1e-40];

/// Operands number `i` of an operation: first every special value with every other, then random
/// ones of all kinds. Unlike [`random`] it knows denormal numbers.
pub fn operands<T: Type>(rng: &mut Rng, numbers: Numbers, i: usize) -> T {
    let special = SPECIAL_F32.len() + DENORMAL.len();
    let float = |k: usize| *SPECIAL_F32.iter().chain(DENORMAL).nth(k).unwrap_or(&0.0);
    let kind = if i < special * special { 0 } else { rng.below(4) };
    let mut place = i;
    from_words(|leaf| {
        let mut next = |n: usize| {
            let k = if i < special * special { place % special } else { rng.below(n) };
            place /= special;
            k
        };
        match (numbers, kind, leaf) {
            (Numbers::Any, 0, Schema::F32) => float(next(special)).to_bits(),
            (Numbers::Any, 0, Schema::I32 | Schema::U32) => {
                SPECIAL_U32[next(SPECIAL_U32.len()) % SPECIAL_U32.len()]
            }
            (Numbers::Any, 1, Schema::F32 | Schema::I32 | Schema::U32) => rng.bits() as u32,
            (_, _, Schema::F32) => numbers.f32(rng).to_bits(),
            (_, _, Schema::I32) => numbers.i32(rng) as u32,
            (_, _, Schema::U32) => numbers.u32(rng),
            (_, _, Schema::Bool) => rng.below(2) as u32,
            _ => rng.bits() as u32,
        }
    })
}

/// A random value.
pub fn random<T: Type>(rng: &mut Rng, numbers: Numbers) -> T {
    from_words(|leaf| match leaf {
        Schema::F32 => numbers.f32(rng).to_bits(),
        Schema::I32 => numbers.i32(rng) as u32,
        Schema::U32 => numbers.u32(rng),
        Schema::Bool => rng.below(2) as u32,
        _ => rng.bits() as u32,
    })
}

/// A value for a lane that does not run: NaN, and integers that overflow in any operation.
pub fn garbage<T: Type>() -> T {
    from_words(|leaf| match leaf {
        Schema::F32 => 0x7fe1_2345,
        Schema::I32 => 0x8000_0000,
        Schema::U32 => 0xffff_ffff,
        Schema::Bool => 1,
        _ => 0xffff,
    })
}

/// The scalars of a value, made so that equal ones have equal words: +0 for -0, one NaN for all.
pub fn words<T: Type>(v: &T) -> Vec<u32> {
    let mut bytes = vec![0u8; T::SCHEMA.size()];
    v.write(&mut bytes);
    words_of_bytes(T::SCHEMA, &bytes)
}

fn words_of_bytes(schema: &Schema, bytes: &[u8]) -> Vec<u32> {
    let mut words = Vec::new();
    each_leaf(schema, 0, &mut |offset, leaf| {
        let mut word = [0; 4];
        let n = leaf.size();
        word[..n].copy_from_slice(&bytes[offset..offset + n]);
        let word = u32::from_le_bytes(word);
        words.push(if *leaf == Schema::F32 { same_zero_and_nan(word) } else { word });
    });
    words
}

/// The floats among the scalars of a value.
pub fn floats<T: Type>(v: &T) -> Vec<f32> {
    floats_of_words(T::SCHEMA, &words(v))
}

fn floats_of_words(schema: &Schema, words: &[u32]) -> Vec<f32> {
    let words = words.iter().zip(are_floats(schema));
    words.filter(|(_, is_float)| *is_float).map(|(w, _)| f32::from_bits(*w)).collect()
}

/// Whether each leaf is a float.
fn are_floats(schema: &Schema) -> Vec<bool> {
    let mut all = Vec::new();
    each_leaf(schema, 0, &mut |_, leaf| all.push(*leaf == Schema::F32));
    all
}

fn same_zero_and_nan(bits: u32) -> u32 {
    let x = f32::from_bits(bits);
    if x.is_nan() {
        f32::NAN.to_bits()
    } else if x == 0.0 {
        0
    } else {
        bits
    }
}

/// What came of comparing two lists of results.
#[must_use = "a comparison that nobody looks at proves nothing"]
#[derive(Debug)]
pub struct Comparison {
    who: String,
    compared: usize,
    differing: Vec<(usize, Vec<u32>, Vec<u32>)>,
}

/// Compares results; -0 equals +0, and every NaN every other.
pub fn compare<T: Type>(who: impl Into<String>, expected: &[T], found: &[T]) -> Comparison {
    assert_eq!(expected.len(), found.len(), "one result for each input");
    let write = |i: usize, a: &mut [u8], b: &mut [u8]| {
        expected[i].write(a);
        found[i].write(b);
    };
    compare_bytes(who.into(), T::SCHEMA, expected.len(), &write)
}

/// Writes an expected result and the one that was found.
type Write<'a> = &'a dyn Fn(usize, &mut [u8], &mut [u8]);

fn compare_bytes(who: String, schema: &Schema, count: usize, write: Write<'_>) -> Comparison {
    let (mut a, mut b) = (vec![0u8; schema.size()], vec![0u8; schema.size()]);
    let mut differing = Vec::new();
    for i in 0..count {
        write(i, &mut a, &mut b);
        // Most results are equal byte by byte: those need no second look.
        if a != b {
            let (expected, found) = (words_of_bytes(schema, &a), words_of_bytes(schema, &b));
            if expected != found {
                differing.push((i, expected, found));
            }
        }
    }
    Comparison { who, compared: count, differing }
}

/// Compares results, of which floats may be `ulps` apart; denormals are zeros, as on many GPUs, and unless
/// `keeps_denormals` so are those that are terms of a sum.
pub fn compare_within<T: Type>(
    who: impl Into<String>,
    ulps: u32,
    keeps_denormals: bool,
    expected: &[T],
    found: &[T],
) -> Comparison {
    let mut all = compare(who, expected, found);
    let is_near = |a: u32, b: u32| {
        let lost = (f32::from_bits(a) - f32::from_bits(b)).abs();
        distance(a, b) <= ulps || !keeps_denormals && lost < f32::MIN_POSITIVE
    };
    all.allow(is_near, &are_floats(T::SCHEMA));
    all
}

/// How many floats lie from one to the other; a NaN is far from all others.
fn distance(a: u32, b: u32) -> u32 {
    let place = |bits: u32| {
        let size = ((bits & 0x7fff_ffff) as i32 - 0x007f_ffff).max(0);
        if bits >> 31 == 0 { size } else { -size }
    };
    if f32::from_bits(a).is_nan() || f32::from_bits(b).is_nan() {
        return u32::MAX;
    }
    place(a).abs_diff(place(b))
}

impl Comparison {
    /// How many results differ.
    pub fn count(&self) -> usize {
        self.differing.len()
    }

    /// Forgets results whose floats are near each other, and all else equal.
    fn allow(&mut self, is_near: impl Fn(u32, u32) -> bool, are_floats: &[bool]) {
        self.differing.retain(|(i, e, f)| {
            assert_eq!(are_floats.len(), e.len(), "one word for each leaf of result {i}");
            let near =
                |(k, is_float): (usize, &bool)| e[k] == f[k] || *is_float && is_near(e[k], f[k]);
            !are_floats.iter().enumerate().all(near)
        });
    }

    /// Panics if any result differs; `input` describes the input of a number.
    ///
    /// # Panics
    ///
    /// If any result differs, or if nothing was compared.
    #[track_caller]
    pub fn assert_same(self, input: impl Fn(usize) -> String) {
        self.assert_none(&input);
    }

    #[track_caller]
    fn assert_none(self, input: &dyn Fn(usize) -> String) {
        assert!(self.compared > 0, "{}: nothing was compared", self.who);
        let Some((i, expected, found)) = self.differing.first() else { return };
        let float = |words: &[u32]| words.iter().map(|w| f32::from_bits(*w)).collect::<Vec<_>>();
        panic!(
            "{}: {} of {} results differ; the first is number {i}, input {}\n expected {expected:x?} {:?}\n    found {found:x?} {:?}",
            self.who,
            self.differing.len(),
            self.compared,
            input(*i),
            float(expected),
            float(found),
        );
    }
}

#[cfg(test)]
mod tests {
    use super::{compare, floats};

    /// The bits of -1 are those of a NaN, but it is no float.
    #[test]
    fn integers_are_no_floats() {
        assert_eq!(floats(&(-1i32, 1.5f32, u32::MAX)), [1.5]);
    }

    #[test]
    fn zeros_and_nans_are_equal_and_nothing_else_is() {
        let a = [0.0f32, f32::NAN, 1.0, 2.0, f32::NAN];
        let b = [-0.0f32, -f32::NAN, 1.0, 2.000_000_2, 3.0];
        assert_eq!(compare("floats", &a, &b).count(), 2);
        assert_eq!(compare("integers", &[0u32, 7], &[0x8000_0000, 7]).count(), 1);
    }
}
