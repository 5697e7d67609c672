//! Blocks and statements without inner control flow.

use super::changes::compound;
use super::composites::ANY;
use super::scope::Var;
use super::{Generator, around, text};
use crate::fuzz::tree::{Block, Expr, Piece, Stmt, Ty};

impl Generator<'_> {
    /// With a value, or not; `leaves` it in any case, or not.
    pub(super) fn block(&mut self, ty: Option<Ty>, leaves: bool, statements: usize) -> Block {
        let scope = self.vars.len();
        let mut stmts: Vec<Stmt> = (0..statements).map(|_| self.stmt()).collect();
        // A block that leaves the function or a loop.
        if ty.is_none() && self.chance(15) {
            stmts.push(self.exit());
        }
        if leaves {
            stmts.push(Stmt { removable: false, ..self.exit() });
        }
        if self.nest == 0 {
            // However long the statements are, the result depends on several of them.
            self.size += 12;
        }
        let tail = ty.map(|ty| Box::new(self.expr(ty, if self.nest == 0 { 3 } else { 2 })));
        self.vars.truncate(scope);
        Block { stmts, tail }
    }

    fn stmt(&mut self) -> Stmt {
        let may_nest = self.nest < 4 && !self.is_full();
        match self.rng.below(100) {
            0..16 => self.binding(),
            16..20 => self.parts_binding(),
            20..22 => self.host_binding(),
            22..38 => self.assignment().unwrap_or_else(|| self.binding()),
            38..41 => self.element_assignment().unwrap_or_else(|| self.binding()),
            41..43 => self.exchange().unwrap_or_else(|| self.binding()),
            43..55 => self.compound().unwrap_or_else(|| self.binding()),
            55..66 if may_nest => self.conditional(),
            66..71 if may_nest => self.matching(),
            71..84 if may_nest && self.rounds < self.limit / 20 => self.repetition(),
            84..90 => self.guarded_exit(),
            90..93 => self.declared_later(),
            93..95 if may_nest => {
                let block = self.inner_block(None);
                Stmt { pieces: vec![Piece::Block(block)], removable: true }
            }
            95..96 => self.ignored(),
            _ => self.binding(),
        }
    }

    fn binding(&mut self) -> Stmt {
        let ty = self.any_type();
        let value = if ty == Ty::Any { self.given_by_trait() } else { self.expr(ty, 3) };
        let (pattern, var) = self.new_binding(ty);
        // The macro is told by the text what is of a type parameter's type.
        let head = if ty == Ty::Any || self.rng.below(3) == 0 {
            format!("let {pattern}: {} = ", ty.name())
        } else {
            format!("let {pattern} = ")
        };
        self.vars.push(var);
        Stmt { pieces: around(head, value, ";"), removable: false }
    }

    /// Of a type parameter's type. A call of the trait must be all of the initialiser.
    fn given_by_trait(&mut self) -> Expr {
        let template = self.rng.pick(ANY);
        Expr { ty: Ty::Any, pieces: self.fill(template, "", 2) }
    }

    /// A tuple or a struct taken apart.
    fn parts_binding(&mut self) -> Stmt {
        let kind = if self.traits.floats { self.rng.below(4) } else { 0 };
        let mut pieces = Vec::new();
        match kind {
            0 | 1 => {
                let (one, two) = (self.any_plain_type(), self.any_plain_type());
                let (first, second) = (self.expr(one, 2), self.expr(two, 2));
                let [a, b] = self.two_bindings(one, two);
                pieces.extend(around(format!("let ({a}, {b}) = ("), first, ", "));
                pieces.extend(around("", second, ");"));
            }
            2 => {
                let value = self.expr(Ty::Pair, 2);
                let [a, b] = self.two_bindings(Ty::F32, Ty::U32);
                pieces.extend(around(format!("let ({a}, {b}) = "), value, ";"));
            }
            _ => {
                let value = self.expr(Ty::Small, 2);
                let [a, b] = self.two_bindings(Ty::I32, Ty::U32);
                pieces.extend(around(format!("let Small {{ i: {a}, m: {b}, .. }} = "), value, ";"));
            }
        }
        Stmt { pieces, removable: false }
    }

    fn any_plain_type(&mut self) -> Ty {
        match self.any_type() {
            Ty::Any | Ty::List => Ty::U32,
            ty => ty,
        }
    }

    fn two_bindings(&mut self, one: Ty, two: Ty) -> [String; 2] {
        let (first, var) = self.new_binding(one);
        let taken = var.name.clone();
        self.vars.push(var);
        let (mut second, mut var) = self.new_binding(two);
        while var.name == taken {
            (second, var) = self.new_binding(two);
        }
        self.vars.push(var);
        [first, second]
    }

    fn host_binding(&mut self) -> Stmt {
        let name = format!("turns{}", self.number());
        let value = match self.rng.below(3) {
            0 => format!("{}u32", self.rng.below(4)),
            1 if self.sliced && self.entry => "host(count) & 3".to_owned(),
            _ => self.host_value(),
        };
        let stmt = text(format!("#[host] let {name} = {value};"));
        self.vars.push(Var { host: true, ..Var::new(name, Ty::U32, false) });
        Stmt { pieces: vec![stmt], removable: false }
    }

    fn declared_later(&mut self) -> Stmt {
        let ty = self.any_plain_type();
        // The condition must not see it, so it shadows nothing.
        let name = format!("later{}", self.number());
        let condition = self.expr(Ty::Bool, 2);
        let (first, second) = (self.expr(ty, 2), self.expr(ty, 2));
        let mut pieces = around(format!("let {name}: {}; if ", ty.name()), condition, " {");
        pieces.extend(around(format!(" {name} = "), first, "; } else {"));
        pieces.extend(around(format!(" {name} = "), second, "; }"));
        self.vars.push(Var::new(name, ty, false));
        Stmt { pieces, removable: false }
    }

    fn assignment(&mut self) -> Option<Stmt> {
        let place = self.target()?;
        let value = self.expr(place.ty, 3);
        let target = place.text.trim_start_matches('(').trim_end_matches(')');
        Some(Stmt { pieces: around(format!("{target} = "), value, ";"), removable: true })
    }

    /// `a[i] = x;`
    fn element_assignment(&mut self) -> Option<Stmt> {
        let kinds =
            [(Ty::Counts, Ty::U32, "% 3"), (Ty::Row, Ty::F32, "& 3"), (Ty::Both, Ty::Small, "& 1")];
        let (ty, element, within) = self.rng.pick(&kinds);
        let place = self.place_of(ty, |var| var.mutable)?.text;
        let value = self.expr(element, 2);
        let index = self.plainly(|g| g.expr(Ty::U32, 2));
        let mut pieces = around(format!("{place}["), index, &format!(" as usize {within}] = "));
        pieces.extend(around("", value, ";"));
        Some(Stmt { pieces, removable: true })
    }

    /// `(a, b) = (b, a);`
    fn exchange(&mut self) -> Option<Stmt> {
        let a = self.target()?;
        let b = self.place_of(a.ty, |var| var.mutable && !var.host)?;
        let line = match self.rng.below(3) {
            0 => format!("({}, {}) = ({}, {});", a.text, b.text, b.text, a.text),
            _ if a.text == b.text => return None,
            1 => format!("({}, _, {}) = ({}, 1u32, {});", b.text, a.text, a.text, b.text),
            _ => format!("({}, {}) = ({}, {});", a.text, b.text, b.text, a.text),
        };
        (a.text != b.text).then(|| Stmt { pieces: vec![text(line)], removable: true })
    }

    fn compound(&mut self) -> Option<Stmt> {
        let place = self.target()?;
        let template = self.template(compound(place.ty))?;
        let pieces = self.plainly(|g| g.fill(template, &place.text, 2));
        Some(Stmt { pieces, removable: true })
    }

    fn ignored(&mut self) -> Stmt {
        let ty = self.any_type();
        let value = self.expr(ty, 2);
        Stmt { pieces: around("let _ = ", value, ";"), removable: true }
    }
}
