//! What the syntax tree says about a kernel: what runs, what ends lanes, which types are known.

use proc_macro2::{Ident, Span, TokenStream};

use super::{Block, Expr, Kind, Let, Step, Stmt};
use crate::here::quote_here as quote;

impl Kind {
    /// Returns the tokens of an integer of the source.
    pub(crate) fn int_tokens(&self) -> Option<&TokenStream> {
        match self {
            Self::Int { tokens, .. } => Some(tokens),
            _ => None,
        }
    }

    /// Returns every expression directly under this one.
    pub(crate) fn children(&self) -> Vec<&Expr> {
        match self {
            Self::Float(_)
            | Self::Int { .. }
            | Self::Bool(_)
            | Self::Name(_)
            | Self::Path(_)
            | Self::Break(_, None)
            | Self::Continue(_)
            | Self::Return(None)
            | Self::RefMut(_)
            | Self::NewVariant { .. }
            | Self::Closure(_)
            | Self::Error => vec![],
            Self::Deref(a)
            | Self::Host(a)
            | Self::Neg(a)
            | Self::Not(a)
            | Self::Return(Some(a))
            | Self::Break(_, Some(a))
            | Self::Cast { value: a, .. }
            | Self::Is { value: a, .. }
            | Self::Repeat { value: a, .. }
            | Self::Field { base: a, .. }
            | Self::Index { base: a, .. } => vec![a],
            Self::Element { base, index } => vec![base, index],
            Self::Assign { place, value } | Self::OpAssign { place, value, .. } => {
                let steps = place.steps.iter().filter_map(|s| match s {
                    Step::Computed(e) => Some(e),
                    _ => None,
                });
                core::iter::once(&**value).chain(steps).collect()
            }
            Self::Binary { a, b, .. } | Self::Logic { a, b, .. } | Self::Compare { a, b, .. } => {
                vec![a, b]
            }
            Self::Call { args, .. }
            | Self::Associated { args, .. }
            | Self::Tuple(args)
            | Self::Array(args) => args.iter().collect(),
            Self::Method { receiver: first, args, .. }
            | Self::OfVariant { value: first, args, .. } => {
                core::iter::once(&**first).chain(args).collect()
            }
            Self::Struct { fields, rest, .. } => {
                fields.iter().map(|f| &f.1).chain(rest.as_deref()).collect()
            }
            Self::If { c, then, otherwise, .. } => {
                let arms = then.children().into_iter().chain(otherwise.as_deref());
                core::iter::once(&**c).chain(arms).collect()
            }
            Self::While { c, body, .. } => core::iter::once(&**c).chain(body.children()).collect(),
            Self::For { range, body, .. } => {
                let bounds = [&*range.start, &*range.end].into_iter();
                bounds.chain(range.step.as_deref()).chain(body.children()).collect()
            }
            Self::ForItems { items, body, .. } => {
                core::iter::once(&**items).chain(body.children()).collect()
            }
            Self::Loop { body, .. } | Self::Block(body) => body.children(),
        }
    }
}

impl Block {
    pub(crate) fn children(&self) -> Vec<&Expr> {
        let stmts = self.stmts.iter().filter_map(|s| match s {
            Stmt::Let(l) => l.init.as_ref(),
            Stmt::Expr(e) => Some(e),
            Stmt::Item(_) => None,
        });
        stmts.chain(self.tail.as_deref()).collect()
    }
}

impl Expr {
    /// Returns whether running it can stop lanes in the code that follows.
    pub(crate) fn ends_lanes(&self) -> bool {
        self.ends(&mut Vec::new(), 0)
    }

    fn ends<'a>(&'a self, inside: &mut Vec<Option<&'a str>>, loops: usize) -> bool {
        match &self.kind {
            Kind::Return(_) => true,
            Kind::Break(label, _) | Kind::Continue(label) => match label {
                None => loops == 0,
                Some(l) => !inside.iter().flatten().any(|x| x == l),
            },
            Kind::While { label, .. }
            | Kind::Loop { label, .. }
            | Kind::For { label, .. }
            | Kind::ForItems { label, .. } => {
                inside.push(label.as_deref());
                let ends = self.kind.children().iter().any(|e| e.ends(inside, loops + 1));
                inside.pop();
                ends
            }
            kind => kind.children().iter().any(|e| e.ends(inside, loops)),
        }
    }

    /// Returns whether its value comes from control flow, not from an expression.
    pub(crate) fn is_structured(&self) -> bool {
        match &self.kind {
            Kind::If { .. } => true,
            Kind::Loop { label, body } => !body.break_values(label.as_deref()).is_empty(),
            Kind::Block(b) => b.ends_lanes() || b.tail.as_ref().is_some_and(|e| e.is_structured()),
            _ => false,
        }
    }

    /// Collects the values of `break` for the loop with `label`, `depth` loops further out.
    fn break_values<'a>(&'a self, label: Option<&str>, depth: usize, found: &mut Vec<&'a Expr>) {
        match &self.kind {
            Kind::Break(None, Some(value)) if depth == 0 => found.push(value),
            Kind::Break(Some(l), Some(value)) if Some(l.as_str()) == label => found.push(value),
            _ => {}
        }
        let is_loop = matches!(
            self.kind,
            Kind::While { .. } | Kind::For { .. } | Kind::ForItems { .. } | Kind::Loop { .. }
        );
        let depth = depth + usize::from(is_loop);
        self.kind.children().iter().for_each(|e| e.break_values(label, depth, found));
    }

    /// Collects the expressions that may become its value.
    fn outcomes<'a>(&'a self, found: &mut Vec<&'a Expr>) {
        let of_block = |b: &'a Block, found: &mut Vec<&'a Expr>| {
            b.tail.iter().for_each(|e| e.outcomes(found));
        };
        match &self.kind {
            Kind::If { then, otherwise, .. } => {
                of_block(then, found);
                otherwise.iter().for_each(|e| e.outcomes(found));
            }
            Kind::Block(b) => of_block(b, found),
            Kind::Loop { label, body } => {
                body.break_values(label.as_deref()).iter().for_each(|e| e.outcomes(found));
            }
            _ if self.diverges() => {}
            _ => found.push(self),
        }
    }

    /// Returns whether it is an integer of the source whose type is inferred.
    pub(crate) fn is_untyped_integer(&self) -> bool {
        match &self.kind {
            Kind::Int { suffix, .. } => suffix.is_none(),
            Kind::Neg(a) => a.is_untyped_integer(),
            Kind::Binary { a, b, .. } => a.is_untyped_integer() && b.is_untyped_integer(),
            _ => false,
        }
    }

    /// The tokens of such an integer: rustc computes it, and infers its type.
    pub(crate) fn integer_tokens(&self) -> Option<TokenStream> {
        match &self.kind {
            Kind::Int { tokens, suffix: None } => Some(tokens.clone()),
            Kind::Neg(a) => {
                let a = a.integer_tokens()?;
                Some(quote!((-#a)))
            }
            Kind::Binary { op, a, b } => {
                let (a, b) = (a.integer_tokens()?, b.integer_tokens()?);
                let symbol: TokenStream = op.symbol.parse().ok()?;
                Some(quote!((#a #symbol #b)))
            }
            _ => None,
        }
    }

    /// Whether an element of the array says what type the others have.
    pub(crate) fn has_typed_item(&self) -> bool {
        matches!(&self.kind, Kind::Array(items) if items.iter().any(Self::has_typed_outcome))
    }

    /// Returns whether it is, or lists, an integer of the source whose type is inferred.
    pub(crate) fn has_untyped_integer(&self) -> bool {
        match &self.kind {
            Kind::Tuple(items) | Kind::Array(items) => items.iter().any(Self::has_untyped_integer),
            _ => self.is_untyped_integer(),
        }
    }

    /// The expressions that may become its value; none of those that diverge.
    pub(crate) fn all_outcomes(&self) -> Vec<&Self> {
        let mut found = Vec::new();
        self.outcomes(&mut found);
        found
    }

    /// Whether one of its outcomes says what type those have that are bare integers.
    pub(crate) fn has_typed_outcome(&self) -> bool {
        self.all_outcomes().iter().any(|e| !e.has_untyped_integer())
    }

    /// Whether it is an integer, or a list or a tuple with one, that has no type of its own.
    pub(crate) fn is_bare(&self) -> bool {
        match &self.kind {
            Kind::Repeat { value, .. } => value.has_untyped_integer(),
            _ => !self.has_no_outcome() && !self.has_typed_outcome(),
        }
    }

    /// Returns whether no path through it has a value.
    pub(crate) fn has_no_outcome(&self) -> bool {
        self.all_outcomes().is_empty()
    }

    /// Returns whether no lane runs on behind it.
    pub(crate) fn diverges(&self) -> bool {
        matches!(self.kind, Kind::Return(_) | Kind::Break(..) | Kind::Continue(_))
    }

    /// Returns whether it may be evaluated where the source would not: it has no side effect and
    /// cannot trap.
    pub(crate) fn is_total(&self) -> bool {
        let this = match &self.kind {
            Kind::Binary { op, .. } => !op.may_trap,
            Kind::Call { .. }
            | Kind::Associated { .. }
            | Kind::Method { .. }
            | Kind::If { .. }
            | Kind::While { .. }
            | Kind::Loop { .. }
            | Kind::For { .. }
            | Kind::ForItems { .. }
            | Kind::Block(_)
            | Kind::Break(..)
            | Kind::Continue(_)
            | Kind::Return(_)
            | Kind::Element { .. }
            | Kind::Index { .. }
            | Kind::Closure(_)
            | Kind::Assign { .. }
            | Kind::OpAssign { .. } => false,
            _ => true,
        };
        this && self.kind.children().iter().all(|e| e.is_total())
    }

    /// Returns whether it calls or assigns something, so that its order matters.
    pub(crate) fn may_act(&self) -> bool {
        let this = matches!(
            self.kind,
            Kind::Call { .. }
                | Kind::Associated { .. }
                | Kind::Method { .. }
                | Kind::Assign { .. }
                | Kind::OpAssign { .. }
        );
        this || self.kind.children().iter().any(|e| e.may_act())
    }

    /// Returns whether it has arithmetic for which integer overflow is an error.
    pub(crate) fn may_overflow(&self) -> bool {
        let this = match &self.kind {
            Kind::Binary { op, .. } => op.may_overflow,
            Kind::Neg(a) => !matches!(a.kind, Kind::Float(_) | Kind::Int { .. }),
            _ => false,
        };
        this || self.kind.children().iter().any(|e| e.may_overflow())
    }
}

impl Let {
    /// Whether it is a variable whose integer type is inferred.
    pub(crate) fn is_bare(&self) -> bool {
        self.mutable && self.ty.is_none() && self.init.as_ref().is_some_and(Expr::is_bare)
    }
}

impl Stmt {
    /// Returns `let name = init`.
    pub(crate) fn bind(name: Ident, mutable: bool, init: Expr) -> Self {
        let (name, init) = (Some(name), Some(init));
        Self::Let(Let { host: false, is_pattern: true, name, mutable, ty: None, init })
    }

    pub(crate) fn ends_lanes(&self) -> bool {
        match self {
            Self::Let(l) => l.init.as_ref().is_some_and(Expr::ends_lanes),
            Self::Expr(e) => e.ends_lanes(),
            Self::Item(_) => false,
        }
    }
}

impl Block {
    pub(crate) fn ends_lanes(&self) -> bool {
        self.children().iter().any(|e| e.ends_lanes())
    }

    /// Returns the values of `break` for the loop with this label, whose body the block is.
    fn break_values(&self, label: Option<&str>) -> Vec<&Expr> {
        let mut found = Vec::new();
        self.children().iter().for_each(|e| e.break_values(label, 0, &mut found));
        found
    }

    /// Whether a variable, a counter or the value of the block is an integer that has no type of its
    /// own.
    pub(crate) fn has_bare_integer(&self) -> bool {
        fn within(e: &Expr) -> bool {
            let of_block = |b: &Block| b.has_bare_integer();
            let this = match &e.kind {
                Kind::For { range, body, .. } => {
                    range.start.is_bare() && range.end.is_bare() || of_block(body)
                }
                Kind::If { then, .. } => e.is_structured() && e.is_bare() || of_block(then),
                Kind::While { body, .. }
                | Kind::Loop { body, .. }
                | Kind::ForItems { body, .. }
                | Kind::Block(body) => of_block(body),
                Kind::Array(_) | Kind::Repeat { .. } => e.is_bare(),
                Kind::Associated { name, args, .. } => {
                    name == "Some" && args.iter().any(Expr::is_bare)
                }
                Kind::Method { name, args, .. } => {
                    name == "unwrap_or" && args.iter().any(Expr::is_bare)
                }
                _ => false,
            };
            this || e.kind.children().into_iter().any(within)
        }
        let is_bare_let = |s: &Stmt| matches!(s, Stmt::Let(l) if l.is_bare());
        self.stmts.iter().any(is_bare_let)
            || self.tail.as_ref().is_some_and(|e| e.is_bare())
            || self.children().into_iter().any(within)
    }

    /// Returns whether something inside leaves the block with this label.
    pub(crate) fn leaves(&self, label: &str) -> bool {
        fn leaves(e: &Expr, label: &str) -> bool {
            matches!(&e.kind, Kind::Break(Some(l), _) if l == label)
                || e.kind.children().into_iter().any(|e| leaves(e, label))
        }
        self.children().into_iter().any(|e| leaves(e, label))
    }

    /// Returns the calls of a method of this name on `self`.
    pub(crate) fn calls_on_self(&self, method: &Ident) -> Vec<Span> {
        fn find(e: &Expr, method: &Ident, found: &mut Vec<Span>) {
            if let Kind::Method { receiver, name, .. } = &e.kind
                && matches!(&receiver.kind, Kind::Name(r) if r == "self")
                && name == method
            {
                found.push(name.span());
            }
            e.kind.children().into_iter().for_each(|e| find(e, method, found));
        }
        let mut found = Vec::new();
        self.children().into_iter().for_each(|e| find(e, method, &mut found));
        found
    }

    /// Returns whether the function returns from within the block.
    pub(crate) fn returns(&self) -> bool {
        fn returns(e: &Expr) -> bool {
            matches!(e.kind, Kind::Return(_)) || e.kind.children().into_iter().any(returns)
        }
        self.children().into_iter().any(returns)
    }
}
