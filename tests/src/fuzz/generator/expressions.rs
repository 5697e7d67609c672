//! Expressions: variables, templates, calls, blocks with values.

use super::scope::{Callable, Exit, Place};
use super::vocabulary::{literals, of_letter, templates};
use super::{Generator, around, text};
use crate::fuzz::tree::{Block, Expr, Head, Mode, Param, Piece, Stmt, Ty};

impl Generator<'_> {
    pub(super) fn expr(&mut self, ty: Ty, depth: usize) -> Expr {
        self.work += self.rounds;
        self.size = self.size.saturating_sub(1);
        let lacks = ty.has_floats() && !self.traits.floats && ty != Ty::Outcome;
        if depth == 0 || self.is_full() || lacks || ty == Ty::Any {
            return self.leaf(ty);
        }
        let may_block = !self.plain && self.nest < 4;
        match self.rng.below(100) {
            0..17 => self.leaf(ty),
            17..20 => self.closure_call(ty).unwrap_or_else(|| self.leaf(ty)),
            20..32 => self.call(ty, depth).unwrap_or_else(|| self.leaf(ty)),
            32..37 if may_block => self.value_if(ty),
            37..40 if may_block => self.value_match(ty),
            40..42 if may_block => self.value_block(ty),
            42..43 if may_block && self.rounds < self.limit / 20 => self.value_loop(ty),
            _ => match self.template(templates(ty)) {
                Some(template) => Expr { ty, pieces: self.fill(template, "", depth - 1) },
                None => self.leaf(ty),
            },
        }
    }

    /// One of these that has nothing which the function lacks.
    pub(super) fn template(&mut self, from: &[&'static str]) -> Option<&'static str> {
        let fits = |t: &&&'static str| self.has_all_of(t) || t.starts_with("(Outcome");
        let found: Vec<&'static str> = from.iter().filter(fits).copied().collect();
        (!found.is_empty()).then(|| self.rng.pick(&found))
    }

    fn has_all_of(&self, template: &str) -> bool {
        let mut letters = template.match_indices('{').filter_map(|(at, _)| {
            let letter = template[at + 1..].chars().next()?;
            of_letter(letter).filter(|_| template[at + 2..].starts_with('}'))
        });
        let lists = ["floats", "words", "smalls", "shapes"];
        let has_types = letters.all(|ty| match ty {
            Ty::Own => self.traits.own,
            Ty::Any => self.head == Head::OfType,
            Ty::List => self.head == Head::OfCount,
            ty => self.traits.floats || !ty.has_floats(),
        });
        let of_type = template.contains("{G}") || template.contains("T::");
        let of_count = template == "N" || template.contains("(N as") || template.contains("% N");
        let of_entry = template == "scale" || template.contains("count)");
        let of_scene = template.contains("scene.");
        let has_floats = !["floats", "smalls", "shapes"].iter().any(|l| template.contains(l));
        has_types
            && (!template.contains("Own") || self.traits.own)
            && (!of_type || self.head == Head::OfType)
            && (!of_count || self.head == Head::OfCount)
            && (self.sliced || !lists.iter().any(|l| template.contains(l)))
            && (!of_scene || self.sliced || self.head == Head::OfScene)
            && (self.traits.floats || has_floats)
            && (!of_entry || self.sliced && self.entry)
    }

    pub(super) fn fill(&mut self, template: &str, place: &str, depth: usize) -> Vec<Piece> {
        if let Some(template) = template.strip_prefix('!') {
            return self.plainly(|g| g.fill(template, place, depth));
        }
        let mut pieces = Vec::new();
        let mut fixed: Vec<(char, String)> = Vec::new();
        let mut rest = template;
        while let Some(at) = rest.find('{') {
            let letter = rest[at + 1..].chars().next().unwrap_or(' ');
            if rest.get(at + 2..at + 3) != Some("}") {
                // A brace of Rust.
                pieces.push(text(&rest[..=at]));
                rest = &rest[at + 1..];
                continue;
            }
            pieces.push(text(&rest[..at]));
            rest = &rest[at + 3..];
            let piece = match (letter, of_letter(letter)) {
                ('p', _) => text(place),
                (_, Some(ty)) => Piece::Expr(self.expr(ty, depth)),
                _ => text(self.fixed(letter, &mut fixed)),
            };
            pieces.push(piece);
        }
        pieces.push(text(rest));
        pieces
    }

    /// What a capital letter stands for.
    fn fixed(&mut self, letter: char, fixed: &mut Vec<(char, String)>) -> String {
        if let Some((_, text)) = fixed.iter().find(|(l, _)| *l == letter) {
            return text.clone();
        }
        let of = |g: &mut Self, ty, other: &str| {
            let place = g.place_of(ty, |var| !var.mutable && !var.host);
            place.map_or(other.to_owned(), |p| p.text)
        };
        let text = match letter {
            'U' => of(self, Ty::U32, "7u32"),
            'I' => of(self, Ty::I32, "9i32"),
            'Z' => of(self, Ty::Size, "2usize"),
            'H' => self.host_value(),
            _ => self.place_of(Ty::Any, |_| true).map_or("p0".to_owned(), |p| p.root),
        };
        fixed.push((letter, text.clone()));
        text
    }

    /// A value of the host below 4.
    pub(super) fn host_value(&mut self) -> String {
        let place = self.place_of(Ty::U32, |var| var.host);
        place.map_or_else(|| format!("host({}u32)", self.rng.below(4)), |p| p.text)
    }

    pub(super) fn leaf(&mut self, ty: Ty) -> Expr {
        let from_scope = self.rng.below(5) != 0;
        let place = self.place_of(ty, |var| !var.host).filter(|_| from_scope || ty == Ty::Any);
        let text = match place {
            Some(place) => place.text,
            None => self.rng.pick(literals(ty)).to_owned(),
        };
        Expr::text(ty, text)
    }

    // Calls.

    fn call(&mut self, ty: Ty, depth: usize) -> Option<Expr> {
        let left = self.limit.saturating_sub(self.work) / self.rounds;
        let fits = |f: &&Callable| {
            let changes = f.params.iter().any(|p| p.mode == Mode::Changed);
            f.result == ty
                && f.work < left
                && (!f.sliced || self.sliced)
                && (f.head != Head::OfScene || self.sliced || self.head == Head::OfScene)
                && !(changes && self.plain)
        };
        let of_type: Vec<&Callable> = self.callable.iter().filter(fits).collect();
        if of_type.is_empty() {
            return None;
        }
        let f = of_type[self.rng.below(of_type.len())];
        let changed = self.changed_places(f)?;
        self.work += f.work * self.rounds;
        let pieces = if matches!(f.head, Head::Method | Head::Weight) {
            self.method_call(f, &changed, depth)
        } else {
            self.function_call(f, &changed, depth)
        };
        Some(Expr { ty, pieces })
    }

    /// A place for each parameter that the function changes, each of another variable.
    fn changed_places(&mut self, f: &Callable) -> Option<Vec<Place>> {
        let mut found: Vec<Place> = Vec::new();
        for p in f.params.iter().filter(|p| p.mode == Mode::Changed) {
            let roots: Vec<String> = found.iter().map(|p| p.root.clone()).collect();
            found.push(self.place_of(self.concrete(f, p.ty), |var| {
                var.mutable && !var.host && !roots.contains(&var.name)
            })?);
        }
        Some(found)
    }

    /// The type of an argument: type parameters are `Small`.
    fn concrete(&self, f: &Callable, ty: Ty) -> Ty {
        match (f.head, ty) {
            (Head::OfType, Ty::Any) => Ty::Small,
            (Head::OfCount, Ty::List) => Ty::Row,
            (_, ty) => ty,
        }
    }

    fn method_call(&mut self, f: &Callable, changed: &[Place], depth: usize) -> Vec<Piece> {
        let (receiver, rest) = f.params.split_first().expect("methods have receivers");
        // A receiver is borrowed while arguments are evaluated.
        let borrows = receiver.mode != Mode::Value;
        let mut pieces = match receiver.mode {
            Mode::Changed => {
                let place = &changed[0];
                vec![text(if place.reference { &place.root } else { &place.text })]
            }
            _ => {
                let receiver = |g: &mut Self| g.expr(Ty::Own, depth - 1);
                vec![Piece::Expr(if borrows { self.plainly(receiver) } else { receiver(self) })]
            }
        };
        pieces.push(text(format!(".{}(", f.name)));
        for (i, p) in rest.iter().enumerate() {
            let arg = |g: &mut Self| g.expr(p.ty, depth - 1);
            let arg = if borrows { self.plainly(arg) } else { arg(self) };
            pieces.extend(around(if i > 0 { ", " } else { "" }, arg, ""));
        }
        pieces.push(text(")"));
        pieces
    }

    fn function_call(&mut self, f: &Callable, changed: &[Place], depth: usize) -> Vec<Piece> {
        // Type parameters and the lengths of lists are those of the arguments, but a type may be
        // named.
        let nested = f.head == Head::OfType && !f.changes_any() && self.chance(40);
        let name = match f.head {
            Head::OfType if nested && self.chance(50) => format!("{}::<Nested>(", f.name),
            Head::OfCount if self.chance(30) => format!("{}::<4>(", f.name),
            _ => format!("{}(", f.name),
        };
        let mut pieces = vec![text(name)];
        if f.head == Head::OfScene {
            let world = self.sliced && self.chance(50);
            pieces.push(text(if world { "world" } else { "scene" }));
        }
        let mut changed = changed.iter();
        for (i, p) in f.params.iter().enumerate() {
            pieces.push(text(if i > 0 || f.head == Head::OfScene { ", " } else { "" }));
            let ty = match (nested, p.ty) {
                (true, Ty::Any) => Ty::Nested,
                _ => self.concrete(f, p.ty),
            };
            match p.mode {
                Mode::Changed => pieces.extend(changed.next().map(|p| text(by_mut(p)))),
                Mode::Host => pieces.push(text(self.host_argument())),
                Mode::Shared => {
                    let arg = self.plainly(|g| g.expr(ty, depth - 1));
                    pieces.extend(around("&", arg, ""));
                }
                Mode::Value | Mode::Mutable if f.borrows() => {
                    pieces.push(Piece::Expr(self.plainly(|g| g.expr(ty, depth - 1))));
                }
                Mode::Value | Mode::Mutable => pieces.push(Piece::Expr(self.expr(ty, depth - 1))),
            }
        }
        pieces.push(text(if f.sliced {
            ", floats, words, smalls, shapes, scene, world)"
        } else {
            ")"
        }));
        pieces
    }

    fn host_argument(&mut self) -> String {
        if self.chance(50) { self.rng.below(4).to_string() } else { self.host_value() }
    }

    // Expressions with blocks.

    fn value_if(&mut self, ty: Ty) -> Expr {
        let mut pieces = vec![text("(")];
        self.arms(Some(ty), &mut pieces);
        pieces.push(text(")"));
        Expr { ty, pieces }
    }

    fn value_match(&mut self, ty: Ty) -> Expr {
        let mut pieces = vec![text("(")];
        self.match_arms(Some(ty), &mut pieces);
        pieces.push(text(")"));
        Expr { ty, pieces }
    }

    /// `({ .. })`, or with a label that its statements may leave it by.
    fn value_block(&mut self, ty: Ty) -> Expr {
        if self.chance(40) {
            let block = self.inner_block(Some(ty));
            return Expr { ty, pieces: vec![text("("), Piece::Block(block), text(")")] };
        }
        let label = format!("b{}", self.number());
        let head = text(format!("('{label}: "));
        self.around.push(Exit { label: Some(label), is_loop: false, value: Some(ty) });
        let first = self.chance(70).then(|| self.guarded_exit());
        let mut block = self.inner_block(Some(ty));
        block.stmts.splice(0..0, first);
        self.around.pop();
        Expr { ty, pieces: vec![head, Piece::Block(block), text(")")] }
    }

    /// A `loop` whose `break`s have a value.
    fn value_loop(&mut self, ty: Ty) -> Expr {
        let number = self.number();
        let (rounds, scope) = (1 + self.rng.below(4), self.vars.len());
        let counter = format!("count{number}");
        let label = self.chance(40).then(|| format!("l{number}"));
        let prefix = label.as_ref().map(|l| format!("'{l}: ")).unwrap_or_default();
        let last = self.plainly(|g| g.expr(ty, 2));
        let outer = self.rounds;
        self.rounds *= rounds + 1;
        self.around.push(Exit { label, is_loop: true, value: Some(ty) });
        let mut block = self.inner_block(None);
        self.around.pop();
        self.rounds = outer;
        self.vars.truncate(scope);
        let step = Stmt { pieces: vec![text(format!("{counter} += 1;"))], removable: false };
        let leave = format!("if {counter} > {rounds} {{ break ");
        let leave = Stmt { pieces: around(leave, last, "; }"), removable: false };
        block.stmts.splice(0..0, [step, leave]);
        let head = format!("({{ let mut {counter} = 0u32; {prefix}loop ");
        Expr { ty, pieces: vec![text(head), Piece::Block(block), text(" })")] }
    }

    /// A block in a block.
    pub(super) fn inner_block(&mut self, ty: Option<Ty>) -> Block {
        self.nest += 1;
        let statements = match ty {
            Some(_) => self.rng.below(3),
            None => 1 + self.rng.below(3),
        };
        let block = self.block(ty, false, statements);
        self.nest -= 1;
        block
    }

    /// A block that has a value, or one that leaves instead.
    pub(super) fn arm_block(&mut self, ty: Option<Ty>, leaves: bool) -> Block {
        if !leaves {
            return self.inner_block(ty);
        }
        self.nest += 1;
        let statements = self.rng.below(3);
        let block = self.block(None, true, statements);
        self.nest -= 1;
        block
    }
}

impl Callable {
    fn borrows(&self) -> bool {
        self.params.iter().any(|p| p.mode == Mode::Shared)
    }

    /// Whether it changes a value of a type parameter's type.
    fn changes_any(&self) -> bool {
        let changes = |p: &Param| p.mode == Mode::Changed && p.ty == Ty::Any;
        self.params.iter().any(changes) || self.result == Ty::Any
    }
}

/// A place handed on to be changed.
fn by_mut(p: &Place) -> String {
    if p.reference { p.root.clone() } else { format!("&mut {}", p.text) }
}
