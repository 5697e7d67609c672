//! What a kernel may give, rounding considered.

use super::{Bounded, Margin, Rounding, Truth};
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

    /// Whether `result`, a leaf without an error, may come of it.
    fn contains(self, result: Self) -> bool {
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
        let found = m.each_way(limit.max(1), &|| {
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

    /// The outcomes that were followed, the reference's first.
    pub fn iter(&self) -> impl Iterator<Item = &[Leaf]> {
        self.outcomes.iter().map(Vec::as_slice)
    }

    /// Whether `result` is within the bounds of an outcome: integers equal, floats between their
    /// ends.
    pub fn contains<R: Type>(&self, result: R) -> bool {
        let found = result_leaves(result);
        self.outcomes.iter().any(|o| o.iter().zip(&found).all(|(may, found)| may.contains(*found)))
    }
}

/// The leaves of a result of the host.
pub(crate) fn result_leaves<R: Type>(result: R) -> Vec<Leaf> {
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
    fn f32(&mut self, _: &Margin, a: Bounded, _: Bounded) -> Bounded {
        let (low, high) = (a.range.low, a.range.high);
        self.0.push(Leaf::Float { value: a.value, low, high, may_be_nan: a.range.nan });
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
