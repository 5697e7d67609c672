//! Arithmetic of the [`Recorder`]: constant folding, and expressions for the rest.

use super::Recorder;
use super::ir::{Expr, Id, Type};
use crate::machine::scalar;
use crate::machine::{BoolBinary, Compare, F32Binary, F32Unary, IntBinary, Machine, U32Unary};

/// Returns whether dividing by `v` and multiplying by its reciprocal give the same bits.
fn is_power_of_two(v: f32) -> bool {
    v.is_normal() && v.to_bits() & 0x007f_ffff == 0
}

impl Recorder {
    fn is_exact_factor(&self, id: Id) -> bool {
        matches!(self.node(id).expr, Expr::F32(bits) if is_power_of_two(f32::from_bits(bits)))
    }

    fn floats(&self, op: F32Binary, a: Id, b: Id, ty: Type) -> Id {
        let (a, b) = match op {
            F32Binary::Add | F32Binary::Sub => (self.opaque(a), self.opaque(b)),
            F32Binary::Mul if self.is_exact_factor(a) || self.is_exact_factor(b) => (a, b),
            F32Binary::Mul => (self.opaque(a), self.opaque(b)),
            F32Binary::Div if self.is_exact_factor(b) => (a, b),
            F32Binary::Div => (a, self.opaque(b)),
            F32Binary::Min | F32Binary::Max => (a, b),
        };
        self.add(Expr::F32Binary(op, a, b), ty)
    }

    /// Returns a vector operand: the number itself if all components are one number.
    pub(super) fn operand(&self, v: &[Id]) -> Id {
        if v.iter().all(|x| *x == v[0]) && v.len() > 1 { v[0] } else { self.vector(v) }
    }

    pub(super) fn float_unary(&self, op: F32Unary, a: Id) -> Id {
        if let Some(a) = self.literal(a) {
            return self.f32(op.of(a));
        }
        self.add(Expr::F32Unary(op, a), Type::F32)
    }

    pub(super) fn float_binary(&self, op: F32Binary, a: Id, b: Id) -> Id {
        if let (Some(a), Some(b)) = (self.literal(a), self.literal(b)) {
            return self.f32(op.of(a, b));
        }
        self.floats(op, a, b, Type::F32)
    }

    pub(super) fn signed_binary(&self, op: IntBinary, a: Id, b: Id) -> Id {
        if let (Some(a), Some(b)) = (self.i32_literal(a), self.i32_literal(b)) {
            return self.i32(scalar::i32_binary(op, a, b).1);
        }
        // WGSL refuses a literal 0 divisor, even in code that never runs.
        match (op, self.i32_literal(b)) {
            (IntBinary::Div, Some(0)) => return a,
            (IntBinary::Rem, Some(0)) => return self.i32(0),
            _ => {}
        }
        self.add(Expr::IntBinary(op, a, b), Type::I32)
    }

    pub(super) fn unsigned_binary(&self, op: IntBinary, a: Id, b: Id) -> Id {
        if let (Some(a), Some(b)) = (self.u32_literal(a), self.u32_literal(b)) {
            return self.u32(scalar::u32_binary(op, a, b).1);
        }
        match (op, self.u32_literal(b)) {
            (IntBinary::Div, Some(0)) => return a,
            (IntBinary::Rem, Some(0)) => return self.u32(0),
            _ => {}
        }
        self.add(Expr::IntBinary(op, a, b), Type::U32)
    }

    pub(super) fn truth_binary(&self, op: BoolBinary, a: Id, b: Id) -> Id {
        // A condition decided by the host prunes the expressions that depend on it.
        for (known, other) in [(a, b), (b, a)] {
            match (op, self.truth(known)) {
                (BoolBinary::And, Some(true)) | (BoolBinary::Or, Some(false)) => return other,
                (BoolBinary::And, Some(false)) | (BoolBinary::Or, Some(true)) => return known,
                (BoolBinary::Xor, Some(false)) => return other,
                (BoolBinary::Xor, Some(true)) => return self.bool_not(other),
                (_, None) => {}
            }
        }
        self.add(Expr::BoolBinary(op, a, b), Type::Bool)
    }

    pub(super) fn float_compare(&self, op: Compare, a: Id, b: Id) -> Id {
        if let (Some(a), Some(b)) = (self.literal(a), self.literal(b)) {
            return self.bool(op.of(a, b));
        }
        self.add(Expr::Compare(op, a, b), Type::Bool)
    }

    pub(super) fn signed_compare(&self, op: Compare, a: Id, b: Id) -> Id {
        if let (Some(a), Some(b)) = (self.i32_literal(a), self.i32_literal(b)) {
            return self.bool(op.of(a, b));
        }
        self.add(Expr::Compare(op, a, b), Type::Bool)
    }

    pub(super) fn unsigned_compare(&self, op: Compare, a: Id, b: Id) -> Id {
        if let (Some(a), Some(b)) = (self.u32_literal(a), self.u32_literal(b)) {
            return self.bool(op.of(a, b));
        }
        if let Compare::Eq | Compare::Ne = op
            && let Some(is) = self.is_kind(a, b)
        {
            return self.bool(is == (op == Compare::Eq));
        }
        self.add(Expr::Compare(op, a, b), Type::Bool)
    }

    pub(super) fn bits_unary(&self, op: U32Unary, a: Id) -> Id {
        if let Some(a) = self.u32_literal(a) {
            return self.u32(op.of(a));
        }
        self.add(Expr::U32Unary(op, a), Type::U32)
    }

    /// Computes `a[i] = op(a[i], b[i])` for vectors of any length, compiled once.
    pub(super) fn float_vectors(&self, op: F32Binary, a: &mut [Id], b: &[Id]) {
        if a.iter().chain(b).all(|x| self.literal(*x).is_some()) {
            a.iter_mut().zip(b).for_each(|(a, b)| *a = self.float_binary(op, *a, *b));
            return;
        }
        let (mut x, mut y) = (self.operand(a), self.operand(b));
        // `min` and `max` are selects by component; two splats are still a vector.
        let selects = matches!(op, F32Binary::Min | F32Binary::Max);
        if selects || !(self.is_vector(x) || self.is_vector(y)) {
            (x, y) = (self.vector(a), self.vector(b));
        }
        let v = self.floats(op, x, y, Type::F32.times(a.len()));
        self.components(v, a);
    }

    pub(super) fn float_vector(&self, op: F32Unary, a: &mut [Id]) {
        if a.iter().all(|x| self.literal(*x).is_some()) {
            a.iter_mut().for_each(|x| *x = self.float_unary(op, *x));
            return;
        }
        let v = self.vector(a);
        let v = self.add(Expr::F32Unary(op, v), Type::F32.times(a.len()));
        self.components(v, a);
    }

    /// Records arithmetic on integer vectors; a shift goes component by component, as its amount
    /// must have another type.
    pub(super) fn int_vectors(&self, op: IntBinary, ty: Type, a: &mut [Id], b: &[Id]) {
        let is_number = |x: &Id| matches!(self.node(*x).expr, Expr::I32(_) | Expr::U32(_));
        let is_shift = matches!(op, IntBinary::Shl | IntBinary::Shr);
        if is_shift || a.iter().chain(b).all(is_number) {
            let binary = |a, b| match ty {
                Type::I32 => self.signed_binary(op, a, b),
                _ => self.unsigned_binary(op, a, b),
            };
            a.iter_mut().zip(b).for_each(|(a, b)| *a = binary(*a, *b));
            return;
        }
        let (mut x, mut y) = (self.operand(a), self.operand(b));
        // Bitwise operators need two vectors.
        let bits = matches!(op, IntBinary::And | IntBinary::Or | IntBinary::Xor);
        if bits || !(self.is_vector(x) || self.is_vector(y)) {
            (x, y) = (self.vector(a), self.vector(b));
        }
        let v = self.add(Expr::IntBinary(op, x, y), ty.times(a.len()));
        self.components(v, a);
    }

    pub(super) fn is_vector(&self, id: Id) -> bool {
        matches!(self.node(id).ty, Type::Vector(..))
    }

    fn components(&self, v: Id, to: &mut [Id]) {
        let ty = self.node(v).ty.component();
        for (to, name) in to.iter_mut().zip(["x", "y", "z", "w"]) {
            *to = self.add(Expr::Member(v, name), ty);
        }
    }
}
