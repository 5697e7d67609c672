//! What a kernel may give, rounding considered.

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
        /// The least `f32` result that rounding may lead to.
        low: f64,
        /// The greatest.
        high: f64,
        /// Whether it may be NaN; if `low > high` it is NaN for certain.
        may_be_nan: bool,
    },
    /// An integer or a truth value, as a number.
    Whole(i64),
}

impl Leaf {
    /// The reference.
    pub fn value(self) -> f64 {
        match self {
            Self::Float { value, .. } => value,
            Self::Whole(v) => v as f64,
        }
    }

    /// How far apart the results are that rounding may lead to; 0 for integers and where it is NaN
    /// for certain, infinity where there is no limit or NaN is one of them.
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

    /// Whether `result`, a leaf without an error, may come of it.
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

/// Everything that a kernel may give for one input, whatever rounding does: one outcome for each
/// way in which its uncertain decisions may go.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcomes {
    outcomes: Vec<Vec<Leaf>>,
    is_uncertain: bool,
    is_complete: bool,
}

impl Outcomes {
    /// Those of `f`, up to `limit` ways.
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

    /// The outcome on the path that `f64` takes; its values are the reference.
    pub fn reference(&self) -> &[Leaf] {
        &self.outcomes[0]
    }

    /// Whether the path that `f64` takes met a decision whose sides lie within the rounding error.
    pub fn is_uncertain(&self) -> bool {
        self.is_uncertain
    }

    /// Whether every way was followed: no more than the limit, and no integer that was open in too
    /// many ways.
    pub fn is_complete(&self) -> bool {
        self.is_complete
    }

    /// Whether a result may be nearly anything on the path that `f64` takes: a float has no limit,
    /// may be NaN, or its interval is wider than 2^-10 of the result's largest number. Then most
    /// mistakes are within the bounds too.
    pub fn is_vague(&self) -> bool {
        let sizes = self.reference().iter().map(|leaf| match leaf {
            Leaf::Float { low, high, .. } if low <= high => low.abs().max(high.abs()),
            _ => 0.0,
        });
        // Next to 0, where denormals may be flushed, every rounding is wide.
        let least = 16.0 * f64::from(f32::MIN_POSITIVE);
        let limit = (sizes.fold(0.0, f64::max) / 1024.0).max(least);
        self.reference().iter().any(|leaf| {
            let width = leaf.width();
            width == f64::INFINITY || width > limit
        })
    }

    /// The number of the first leaf of `result` that lies outside of the outcome that is nearest to
    /// it, the one with the fewest such leaves, and what was allowed there.
    pub(crate) fn outside(&self, result: &[Leaf]) -> Option<(usize, Leaf)> {
        let outside = |o: &&Vec<Leaf>| -> Vec<usize> {
            let pairs = o.iter().zip(result).enumerate();
            pairs.filter(|(_, (may, found))| !may.contains(**found)).map(|(i, _)| i).collect()
        };
        let nearest = self.outcomes.iter().min_by_key(|o| outside(o).len())?;
        let first = *outside(&nearest).first()?;
        Some((first, nearest[first]))
    }

    /// The outcomes that were followed, the reference's first.
    pub fn iter(&self) -> impl Iterator<Item = &[Leaf]> {
        self.outcomes.iter().map(Vec::as_slice)
    }

    /// Whether `result` is within the bounds of an outcome: integers equal, floats between their
    /// ends.
    pub fn contains<R: Type>(&self, result: R) -> bool {
        self.contains_leaves(&result_leaves(result))
    }

    /// [`Outcomes::contains`] of the leaves of a result.
    pub(crate) fn contains_leaves(&self, result: &[Leaf]) -> bool {
        self.outcomes.iter().any(|o| o.iter().zip(result).all(|(may, found)| may.contains(*found)))
    }
}

/// The leaves of a result of the host.
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
