//! Agreement of results, number by number.

use super::Cause;
use crate::machine::{Schema, Type};

/// Upper bounds of the histogram's buckets in ulp; the last bucket holds the rest.
pub const BUCKETS: [u32; 8] = [0, 1, 2, 4, 16, 256, 65_536, u32::MAX];

/// The agreement of a variant's results with those of the scalar one.
#[must_use]
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Agreement {
    /// Results compared.
    pub results: u64,
    /// Results that differ in any bit; +0 equals -0 and NaN equals NaN.
    pub differing: u64,
    /// The largest distance of two `f32`, in ulp.
    pub max_ulp: u32,
    /// The number of `f32` within each of [`BUCKETS`].
    pub histogram: [u64; BUCKETS.len()],
    /// Results that differ by more than rounding: those of [`Self::explained`], of
    /// [`Self::undecided`] and of [`Self::unexplained`]. In [`Self::of`], which has no bounds, those in which an integer or a
    /// truth value differs (another primitive, hit for miss) or a number is NaN in one only.
    pub hit_mismatches: u64,
    /// Mismatches explained by an uncertain decision. Their numbers count in neither
    /// [`Self::max_ulp`] nor [`Self::histogram`].
    pub explained: u64,
    /// Mismatches with more uncertain decisions than are followed, or without bounds. Their numbers
    /// do not count either.
    pub undecided: u64,
    /// The other mismatches: mistakes.
    pub unexplained: u64,
}

impl Agreement {
    /// Compares `results` with those of the scalar variant, `expected`. Where integers agree,
    /// floats may differ; nothing is explained.
    ///
    /// # Panics
    ///
    /// If the lengths differ.
    pub fn of<R: Type>(expected: &[R], results: &[R]) -> Self {
        Self::judged(
            expected,
            results,
            |_, decided| {
                if decided { Cause::Unexplained } else { Cause::Rounding }
            },
        )
    }

    /// Compares `results` with those of the scalar variant, `expected`. `cause` returns why the
    /// results of an index differ; it is also told whether an integer does.
    pub fn judged<R: Type>(
        expected: &[R],
        results: &[R],
        cause: impl Fn(usize, bool) -> Cause,
    ) -> Self {
        assert_eq!(expected.len(), results.len(), "the same inputs give as many results");
        let mut agreement = Self {
            results: results.len() as u64,
            differing: 0,
            max_ulp: 0,
            histogram: [0; BUCKETS.len()],
            hit_mismatches: 0,
            explained: 0,
            undecided: 0,
            unexplained: 0,
        };
        let size = R::SCHEMA.size();
        let (mut a, mut b) = (vec![0; size], vec![0; size]);
        for (i, (x, y)) in expected.iter().zip(results).enumerate() {
            x.write(&mut a);
            y.write(&mut b);
            let pair = Pair::of(R::SCHEMA, &a, &b);
            let cause = if pair.is_same() { Cause::Same } else { cause(i, pair.differs) };
            agreement.add(pair, cause);
        }
        agreement
    }

    /// Returns whether every result has the same bits.
    pub fn is_bit_identical(&self) -> bool {
        self.differing == 0
    }

    fn add(&mut self, pair: Pair, cause: Cause) {
        self.differing += u64::from(cause != Cause::Same);
        match cause {
            Cause::Same | Cause::Rounding => {}
            Cause::Decision => {
                self.hit_mismatches += 1;
                self.explained += 1;
                return;
            }
            Cause::Undecided => {
                self.hit_mismatches += 1;
                self.undecided += 1;
                return;
            }
            Cause::Unexplained => {
                self.hit_mismatches += 1;
                self.unexplained += 1;
            }
        }
        for ulp in pair.ulps {
            let bucket = BUCKETS.iter().position(|end| ulp <= *end).unwrap_or(BUCKETS.len() - 1);
            self.histogram[bucket] += 1;
            self.max_ulp = self.max_ulp.max(ulp);
        }
    }
}

/// Returns the distance of neighbouring `f32` at `v`.
pub fn ulp(v: f64) -> f64 {
    let exponent = (v.to_bits() >> 52 & 0x7ff) as i32 - 1023;
    2f64.powi(exponent.clamp(-126, 127) - 23)
}

/// Returns the indices at which two lists of results differ in any bit.
pub(super) fn differing<R: Type>(expected: &[R], results: &[R]) -> Vec<usize> {
    let size = R::SCHEMA.size();
    let (mut a, mut b) = (vec![0; size], vec![0; size]);
    let mut differs = |x: &R, y: &R| {
        x.write(&mut a);
        y.write(&mut b);
        !Pair::of(R::SCHEMA, &a, &b).is_same()
    };
    let pairs = expected.iter().zip(results).enumerate();
    pairs.filter(|(_, (x, y))| differs(x, y)).map(|(i, _)| i).collect()
}

/// One result in two variants.
struct Pair {
    /// The distance of every `f32`.
    ulps: Vec<u32>,
    /// Whether an integer or a truth value differs.
    differs: bool,
}

impl Pair {
    fn of(schema: &Schema, a: &[u8], b: &[u8]) -> Self {
        let mut pair = Self { ulps: Vec::new(), differs: false };
        pair.compare(schema, a, b);
        pair
    }

    fn is_same(&self) -> bool {
        !self.differs && self.ulps.iter().all(|u| *u == 0)
    }

    fn compare(&mut self, schema: &Schema, a: &[u8], b: &[u8]) {
        match schema {
            Schema::Host => {}
            Schema::F32 => {
                let (a, b) = (float(a), float(b));
                self.differs |= a.is_nan() != b.is_nan();
                self.ulps.push(ulp_distance(a, b));
            }
            Schema::Vector(element, n) => {
                for i in (0..*n).map(|i| i * element.size()) {
                    self.compare(element, &a[i..], &b[i..]);
                }
            }
            Schema::Array { element, count, stride } => {
                for i in 0..*count {
                    self.compare(element, &a[i * stride..], &b[i * stride..]);
                }
            }
            Schema::Struct { fields, .. } => {
                for f in *fields {
                    self.compare(f.schema, &a[f.offset..], &b[f.offset..]);
                }
            }
            integer => {
                let n = integer.size();
                self.differs |= a[..n] != b[..n];
            }
        }
    }
}

fn float(bytes: &[u8]) -> f32 {
    let mut b = [0; 4];
    b.copy_from_slice(&bytes[..4]);
    f32::from_le_bytes(b)
}

/// Returns the distance of `a` and `b` in ulp; a NaN has the greatest distance from any number.
fn ulp_distance(a: f32, b: f32) -> u32 {
    if a == b || (a.is_nan() && b.is_nan()) {
        return 0;
    }
    if a.is_nan() || b.is_nan() {
        return u32::MAX;
    }
    // Maps the bits of a float to an integer in the order of the numbers.
    let ordered = |x: f32| {
        let bits = i64::from(x.to_bits() & 0x7fff_ffff);
        if x.is_sign_negative() { -bits } else { bits }
    };
    u32::try_from(ordered(a).abs_diff(ordered(b))).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances() {
        assert_eq!(ulp_distance(0.0, -0.0), 0);
        assert_eq!(ulp_distance(1.0, 1.0f32.next_up()), 1);
        assert_eq!(ulp_distance(f32::MIN_POSITIVE, -f32::MIN_POSITIVE), 2 << 23);
        assert_eq!(ulp_distance(f32::NAN, f32::NAN), 0);
        assert_eq!(ulp_distance(f32::NAN, 1.0), u32::MAX);
        assert_eq!(ulp_distance(f32::INFINITY, f32::MAX), 1);
    }

    #[test]
    fn an_integer_that_differs_is_a_mismatch_and_a_float_is_not() {
        let a = [(1u32, 1.0f32), (2, 2.0), (3, 3.0)];
        let b = [(1u32, 1.0f32), (2, 2.0f32.next_up()), (4, 3.0f32.next_down())];
        let found = Agreement::of(&a, &b);
        assert_eq!((found.differing, found.hit_mismatches, found.unexplained), (2, 1, 1));
        assert_eq!(found.max_ulp, 1);
        assert_eq!(found.histogram[..2], [1, 2]);
        assert!(!found.is_bit_identical());
        assert!(Agreement::of(&a, &a).is_bit_identical());
    }
}
