//! `if`, `match`, and what leaves.

use super::scope::{Exit, Var};
use super::{Generator, around, text};
use crate::fuzz::tree::{Block, Piece, Stmt, Ty};

impl Generator<'_> {
    pub(super) fn conditional(&mut self) -> Stmt {
        let mut pieces = Vec::new();
        if self.chance(20) {
            pieces.push(text("#[coherent] "));
        }
        self.arms(None, &mut pieces);
        Stmt { pieces, removable: true }
    }

    /// `if c { } else if d { } else { }`; an `if` without a value may have no `else`.
    pub(super) fn arms(&mut self, ty: Option<Ty>, pieces: &mut Vec<Piece>) {
        let mut word = "if ";
        loop {
            if self.chance(8) {
                // Decided before the kernel runs.
                let (value, least) = (self.host_value(), self.rng.below(4));
                pieces.push(text(format!("{word}{value} > {least} ")));
            } else {
                let condition = self.expr(Ty::Bool, 3);
                pieces.extend(around(word, condition, " "));
            }
            pieces.push(Piece::Block(self.inner_block(ty)));
            word = " else if ";
            if self.rng.below(5) != 0 {
                break;
            }
        }
        if ty.is_some() || self.chance(50) {
            pieces.push(text(" else "));
            // The last arm of an `if` with a value may leave instead.
            let leaves = ty.is_some() && self.chance(15);
            pieces.push(Piece::Block(self.arm_block(ty, leaves)));
        }
    }

    pub(super) fn matching(&mut self) -> Stmt {
        let mut pieces = Vec::new();
        self.match_arms(None, &mut pieces);
        Stmt { pieces, removable: true }
    }

    /// `match n { 0 => { }, .. }`.
    pub(super) fn match_arms(&mut self, ty: Option<Ty>, pieces: &mut Vec<Piece>) {
        let kind = self.rng.below(if self.traits.floats { 6 } else { 5 });
        let of = [Ty::U32, Ty::I32, Ty::Kind, Ty::Bool, Ty::U32, Ty::Small][kind];
        let value = self.expr(of, 2);
        match kind {
            // A tuple.
            4 => {
                let second = self.expr(Ty::Kind, 2);
                pieces.extend(around("match (", value, " % 3, "));
                pieces.extend(around("", second, ") {"));
            }
            0 => pieces.extend(around("match ", value, " % 12 {")),
            _ => pieces.extend(around("match ", value, " {")),
        }
        let arms: &[(&str, Ty)] = match kind {
            0 => {
                &[("0", Ty::U32), ("1 | 4", Ty::U32), ("NAME @ 2..=6", Ty::U32), ("NAME", Ty::U32)]
            }
            1 => &[
                ("0", Ty::I32),
                ("-9..=-1", Ty::I32),
                ("NAME @ (1 | 3)", Ty::I32),
                ("i32::MIN..=-10", Ty::I32),
                ("_", Ty::I32),
            ],
            2 => &[("Kind::Red", Ty::Kind), ("Kind::Blue | Kind::Green", Ty::Kind)],
            3 => &[("true", Ty::Bool), ("false", Ty::Bool)],
            4 => &[
                ("(0, Kind::Red)", Ty::U32),
                ("(NAME, Kind::Blue)", Ty::U32),
                ("(1, _)", Ty::U32),
                ("(NAME, _)", Ty::U32),
            ],
            _ => &[
                ("Small { t: true, i: 0..=9, m: NAME, .. }", Ty::U32),
                ("Small { m: NAME, t: false, .. }", Ty::U32),
                ("_", Ty::U32),
            ],
        };
        for (i, (pattern, bound)) in arms.iter().enumerate() {
            let last = i + 1 == arms.len();
            // Enums and truth values need all of their arms.
            if !last && !matches!(kind, 2 | 3) && self.chance(30) {
                continue;
            }
            self.match_arm(pattern, *bound, matches!(kind, 2 | 3) || last, ty, pieces);
        }
        pieces.push(text(" }"));
    }

    fn match_arm(
        &mut self,
        pattern: &str,
        bound: Ty,
        is_needed: bool,
        ty: Option<Ty>,
        pieces: &mut Vec<Piece>,
    ) {
        let scope = self.vars.len();
        let mut shown = pattern.to_owned();
        if pattern.contains("NAME") {
            let name = self.new_name();
            shown = pattern.replace("NAME", &name);
            self.vars.push(Var::new(name, bound, false));
        }
        pieces.push(text(format!(" {shown} ")));
        if !is_needed && self.chance(30) {
            let guard = self.plainly(|g| g.expr(Ty::Bool, 2));
            pieces.extend(around("if ", guard, " "));
        }
        pieces.push(text("=> "));
        let leaves = ty.is_some() && !is_needed && self.chance(20);
        pieces.push(Piece::Block(self.arm_block(ty, leaves)));
        self.vars.truncate(scope);
    }

    pub(super) fn guarded_exit(&mut self) -> Stmt {
        let condition = self.expr(Ty::Bool, 2);
        let mut pieces = around("if ", condition, " ");
        let exit = self.exit();
        pieces.push(Piece::Block(Block { stmts: vec![exit], tail: None }));
        Stmt { pieces, removable: true }
    }

    /// `return`, `break` or `continue`, by a label or without.
    pub(super) fn exit(&mut self) -> Stmt {
        let kind = self.rng.below(4);
        let labelled = self.chance(50);
        let continues = kind == 1;
        let mut found = self.around.iter().rev();
        let found: Vec<(Option<String>, Option<Ty>)> = if labelled {
            let fits = |e: &&Exit| e.label.is_some() && (e.is_loop || !continues);
            found.filter(fits).map(|e| (e.label.clone(), e.value)).collect()
        } else {
            // It is the innermost loop, and no labelled block may stand between.
            found.next().filter(|e| e.is_loop).map(|e| (None, e.value)).into_iter().collect()
        };
        if found.is_empty() || kind == 0 {
            let value = self.expr(self.result, 2);
            return Stmt { pieces: around("return ", value, ";"), removable: true };
        }
        let (label, value) = found[self.rng.below(found.len())].clone();
        let word = if continues { "continue" } else { "break" };
        let label = label.map(|l| format!(" '{l}")).unwrap_or_default();
        let pieces = match value {
            Some(ty) if !continues => {
                let value = self.expr(ty, 2);
                around(format!("{word}{label} "), value, ";")
            }
            _ => vec![text(format!("{word}{label};"))],
        };
        Stmt { pieces, removable: true }
    }
}
