//! Cost model of code, by its syntax: the branch policy of packets.
//!
//! An `if` of a packet can test whether any ray takes an arm and skip it, or run the arm under a
//! mask without a test. The test costs about as much as a few operations, and a misprediction when
//! rays disagree; so arms that are *small* are not tested, and an `if` that only chooses between
//! small values is a selection.

use crate::model::{BinaryOp, Block, Expr, Kind, Step};
use crate::ops;

/// The maximum cost of an arm of statements that runs untested.
const SMALL_ARM: u32 = 5;

/// The maximum cost of a value that is evaluated whether or not it is taken.
const SMALL_VALUE: u32 = 16;

/// The cost of an integer division, a call, a loop: never small.
const LARGE: u32 = 1000;

impl Expr {
    /// Returns whether it costs less than a test whether it is needed.
    pub(crate) fn is_small(&self) -> bool {
        self.cost() <= SMALL_ARM
    }

    fn cost(&self) -> u32 {
        let own = match &self.kind {
            Kind::Float(_)
            | Kind::Int { .. }
            | Kind::Bool(_)
            | Kind::Name(_)
            | Kind::Path(_)
            | Kind::Deref(_)
            | Kind::Host(_)
            | Kind::Field { .. }
            | Kind::Tuple(_)
            | Kind::Array(_)
            | Kind::Struct { .. }
            | Kind::Block(_) => 0,
            Kind::Neg(_)
            | Kind::Not(_)
            | Kind::Compare { .. }
            | Kind::Is { .. }
            | Kind::OfVariant { .. }
            | Kind::NewVariant { .. }
            | Kind::Logic { .. } => 1,
            Kind::Binary { op, .. } => operator(*op),
            Kind::Cast { .. } => 3,
            Kind::If { .. } | Kind::Break(..) | Kind::Continue(_) | Kind::Return(_) => 2,
            Kind::Call { path, .. } => ops::cheap_function(&path.to_string()).unwrap_or(LARGE),
            Kind::Method { name, .. } => ops::cheap_method(&name.to_string()).unwrap_or(LARGE),
            Kind::Assign { place, .. } => assignment(&place.steps),
            Kind::OpAssign { op, place, .. } => assignment(&place.steps) + operator(*op),
            _ => LARGE,
        };
        self.kind.children().into_iter().fold(own, |sum, e| sum.saturating_add(e.cost()))
    }

    /// Returns whether it is small and has no side effect, so that it may be evaluated
    /// speculatively.
    pub(crate) fn is_free(&self) -> bool {
        self.cost() <= SMALL_VALUE && self.has_no_effect()
    }

    /// Returns whether it is an `if` that only chooses between small values.
    pub(crate) fn is_selection(&self) -> bool {
        match &self.kind {
            Kind::If { coherent: false, c, then, otherwise: Some(other) } => {
                let arm = |e: &Expr| e.is_selection() || e.is_free();
                c.has_no_effect() && then.free_value().is_some() && arm(other)
            }
            Kind::Block(b) => b.free_value().is_some_and(Self::is_selection),
            _ => false,
        }
    }

    fn has_no_effect(&self) -> bool {
        let own = match &self.kind {
            Kind::If { then, otherwise: Some(_), .. } => then.is_value(),
            Kind::Block(b) => b.is_value(),
            Kind::If { .. }
            | Kind::Break(..)
            | Kind::Continue(_)
            | Kind::Return(_)
            | Kind::Assign { .. }
            | Kind::OpAssign { .. } => false,
            Kind::Binary { op, .. } => !op.may_trap,
            _ => true,
        };
        own && self.kind.children().into_iter().all(Expr::has_no_effect)
    }
}

/// Returns the cost of an operator. A division may be one of integers, which is done lane by lane.
fn operator(op: BinaryOp) -> u32 {
    if op.may_trap { LARGE } else { 1 }
}

fn assignment(steps: &[Step]) -> u32 {
    if steps.iter().any(|s| matches!(s, Step::Computed(_))) { LARGE } else { 1 }
}

impl Block {
    /// Returns whether it costs less than a test whether it is needed.
    pub(crate) fn is_small(&self) -> bool {
        let cost = self.children().into_iter().fold(0u32, |sum, e| sum.saturating_add(e.cost()));
        cost <= SMALL_ARM
    }

    /// Returns whether it is only a value.
    fn is_value(&self) -> bool {
        self.stmts.is_empty() && self.tail.is_some()
    }

    /// Returns the value, if it is nothing else, small, and has no side effect.
    pub(crate) fn free_value(&self) -> Option<&Expr> {
        self.tail.as_deref().filter(|e| self.stmts.is_empty() && e.is_free())
    }
}
