//! Outcomes: the possible results of a kernel under rounding.

use core::cell::Cell;

use super::arena::{Bounded, Known};
use super::interval::Interval;
use super::{Margin, Rounding, Truth};
use crate::machine::{Leaves, Type, Value};

/// A scalar of a result.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Leaf {
    /// An `f32`.
    Float {
        /// Its `f64` reference.
        value: f64,
        /// The least possible `f32` result.
        low: f64,
        /// The greatest possible `f32` result.
        high: f64,
        /// Whether it may be NaN; if `low > high` it is NaN for certain.
        may_be_nan: bool,
    },
    /// An integer or a truth value, as a number.
    Whole(i64),
}

impl Leaf {
    /// Returns the reference.
    pub fn value(self) -> f64 {
        match self {
            Self::Float { value, .. } => value,
            Self::Whole(v) => v as f64,
        }
    }

    /// Returns the width of the interval of possible results; 0 for integers and a certain NaN,
    /// infinity for an unbounded interval or a possible NaN.
    pub fn width(self) -> f64 {
        match self {
            Self::Float { low, high, may_be_nan, .. } if low <= high => {
                let is_open = may_be_nan || low != high && !(high - low).is_finite();
                if is_open {
                    f64::INFINITY
                } else if low == high {
                    0.0
                } else {
                    high - low
                }
            }
            _ => 0.0,
        }
    }

    /// Returns whether `result`, a leaf without an error, is possible.
    pub(crate) fn contains(self, result: Self) -> bool {
        match self {
            Self::Float { low, high, may_be_nan, .. } => {
                let v = result.value();
                if v.is_nan() { may_be_nan } else { low <= v && v <= high }
            }
            whole => whole == result,
        }
    }
}

/// All possible results of a kernel for one input under any rounding: one outcome per path through
/// its uncertain decisions.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcomes {
    outcomes: Vec<Vec<Leaf>>,
    is_uncertain: bool,
    is_complete: bool,
}

impl Outcomes {
    /// Computes the outcomes of `f`, on up to `limit` paths.
    pub fn of<V: Value<Margin>>(
        rounding: Rounding,
        limit: usize,
        f: impl Fn(&Margin) -> V,
    ) -> Self {
        Self::explored(rounding, limit, &|m| leaves(m, f(m)))
    }

    fn explored(rounding: Rounding, limit: usize, f: &dyn Fn(&Margin) -> Vec<Leaf>) -> Self {
        let m = Margin::new(rounding);
        let is_first = Cell::new(true);
        let found = m.each_way(limit.max(1), &|| {
            if !is_first.replace(false) {
                m.decisions.turn_aside();
            }
            m.forms.truncate(0);
            f(&m)
        });
        Self {
            outcomes: found.results,
            is_uncertain: found.is_uncertain,
            is_complete: found.is_complete,
        }
    }

    /// Returns the outcome on the path of `f64`; its values are the reference.
    pub fn reference(&self) -> &[Leaf] {
        &self.outcomes[0]
    }

    /// Returns whether the path of `f64` had a decision whose sides lie within the rounding error.
    pub fn is_uncertain(&self) -> bool {
        self.is_uncertain
    }

    /// Returns whether every path was followed: there were no more than the limit, and no integer
    /// was open in too many ways.
    pub fn is_complete(&self) -> bool {
        self.is_complete
    }

    /// Returns whether a result on the path of `f64` is nearly arbitrary: a float is unbounded, may
    /// be NaN, or has an interval wider than 2^-10 of the result's largest number. Then most
    /// mistakes are within the bounds too.
    pub fn is_vague(&self) -> bool {
        let sizes = self.reference().iter().map(|leaf| match leaf {
            Leaf::Float { low, high, .. } if low <= high => low.abs().max(high.abs()),
            _ => 0.0,
        });
        // Near 0, where denormals may be flushed, every rounding is wide.
        let least = 16.0 * f64::from(f32::MIN_POSITIVE);
        let limit = (sizes.fold(0.0, f64::max) / 1024.0).max(least);
        self.reference().iter().any(|leaf| {
            let width = leaf.width();
            width == f64::INFINITY || width > limit
        })
    }

    /// Returns the index of the first leaf of `result` outside of the nearest outcome, the one with
    /// the fewest such leaves, and the leaf allowed there.
    pub(crate) fn outside(&self, result: &[Leaf]) -> Option<(usize, Leaf)> {
        let outside = |o: &&Vec<Leaf>| -> Vec<usize> {
            let pairs = o.iter().zip(result).enumerate();
            pairs.filter(|(_, (may, found))| !may.contains(**found)).map(|(i, _)| i).collect()
        };
        let nearest = self.outcomes.iter().min_by_key(|o| outside(o).len())?;
        let first = *outside(&nearest).first()?;
        Some((first, nearest[first]))
    }

    /// Returns the outcomes that were followed, the reference's first.
    pub fn iter(&self) -> impl Iterator<Item = &[Leaf]> {
        self.outcomes.iter().map(Vec::as_slice)
    }

    /// Returns whether `result` is within the bounds of an outcome: integers equal, floats between
    /// their ends.
    pub fn contains<R: Type>(&self, result: R) -> bool {
        self.contains_leaves(&result_leaves(result))
    }

    /// Does the same as [`Outcomes::contains`] for the leaves of a result.
    pub(crate) fn contains_leaves(&self, result: &[Leaf]) -> bool {
        self.outcomes.iter().any(|o| o.iter().zip(result).all(|(may, found)| may.contains(*found)))
    }
}

/// Returns the leaves of a result of the host.
pub fn result_leaves<R: Type>(result: R) -> Vec<Leaf> {
    let m = Margin::new(Rounding::IEEE);
    leaves(&m, R::splat(&m, result))
}

fn leaves<V: Value<Margin>>(m: &Margin, v: V) -> Vec<Leaf> {
    let mut all = Collect(Vec::new());
    V::zip(m, v, v, &mut all);
    all.0
}

struct Collect(Vec<Leaf>);

impl Leaves<Margin> for Collect {
    fn f32(&mut self, m: &Margin, a: Bounded, _: Bounded) -> Bounded {
        let Known { value, range: Interval { low, high, nan }, .. } = m.get(a);
        self.0.push(Leaf::Float { value, low, high, may_be_nan: nan });
        a
    }

    fn i32(&mut self, _: &Margin, a: i32, _: i32) -> i32 {
        self.0.push(Leaf::Whole(a.into()));
        a
    }

    fn u32(&mut self, _: &Margin, a: u32, _: u32) -> u32 {
        self.0.push(Leaf::Whole(a.into()));
        a
    }

    fn bool(&mut self, m: &Margin, a: Truth, _: Truth) -> Truth {
        self.0.push(Leaf::Whole(m.decided(a).into()));
        a
    }
}
