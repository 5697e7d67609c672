//! Parsing of conditions with patterns: `if let`, `while let`, `let else`.

use quote::ToTokens as _;
use syn::Pat;
use syn::spanned::Spanned;

use super::Parser;
use super::attributes::is_coherent;
use super::expression::{inside_parens, label};
use super::pattern::{logic, name};
use crate::model::{Block, Expr, Kind, Stmt};

/// Returns whether a condition has a `let`.
pub(super) fn has_let(e: &syn::Expr) -> bool {
    match inside_parens(e) {
        syn::Expr::Let(_) => true,
        syn::Expr::Binary(b) => has_let(&b.left) || has_let(&b.right),
        _ => false,
    }
}

/// Returns whether it is a variable or its fields: evaluated twice, it is the same.
fn is_place(e: &syn::Expr) -> bool {
    match inside_parens(e) {
        syn::Expr::Path(_) => true,
        syn::Expr::Field(f) => is_place(&f.base),
        syn::Expr::Reference(r) => is_place(&r.expr),
        syn::Expr::Unary(u) => matches!(u.op, syn::UnOp::Deref(_)) && is_place(&u.expr),
        _ => false,
    }
}

impl Parser<'_> {
    /// Parses a condition that may have `let PATTERN = e`, alone or joined by `&&`. What it binds is
    /// added to `lets`, for the code behind it; what must be evaluated before it, to `before`.
    pub(super) fn condition(
        &mut self,
        e: &syn::Expr,
        before: &mut Vec<Stmt>,
        lets: &mut Vec<Stmt>,
    ) -> Expr {
        match inside_parens(e) {
            syn::Expr::Let(l) => {
                let from = self.expr(&l.expr);
                let from = self.read_often(from, &l.pat.to_token_stream(), before);
                let test = self.pattern(&l.pat, &from, lets);
                test.unwrap_or(Expr { kind: Kind::Bool(true), span: l.span() })
            }
            syn::Expr::Binary(b) if matches!(b.op, syn::BinOp::And(_)) && has_let(e) => {
                let left = self.condition(&b.left, before, lets);
                if let syn::Expr::Let(l) = inside_parens(&b.right)
                    && !is_place(&l.expr)
                {
                    return self.behind_and(left, l, before, lets);
                }
                let (mut inner, mut bound) = (Vec::new(), Vec::new());
                let right = self.condition(&b.right, &mut inner, &mut bound);
                // The right side sees what the left one binds, and is not evaluated before it.
                let mut stmts = lets.clone();
                stmts.extend(inner.iter().cloned());
                lets.extend(inner);
                lets.extend(bound);
                let right = if stmts.is_empty() {
                    right
                } else {
                    let span = right.span;
                    let block = Block { stmts, tail: Some(Box::new(right)) };
                    Expr { kind: Kind::Block(block), span }
                };
                logic(true, left, right)
            }
            e => self.expr(e),
        }
    }

    /// Parses the `let` of `left && let PATTERN = e`. `e` sees what the left side binds, and is
    /// evaluated once, where the left side holds.
    fn behind_and(
        &mut self,
        left: Expr,
        l: &syn::ExprLet,
        before: &mut Vec<Stmt>,
        lets: &mut Vec<Stmt>,
    ) -> Expr {
        let (flag, value, span) = (self.temporary("left"), self.temporary("value"), l.span());
        before.push(Stmt::bind(flag.clone(), false, left));
        let then = Block { stmts: lets.clone(), tail: Some(self.boxed(&l.expr)) };
        let (coherent, c) = (self.is_coherent, Box::new(name(&flag)));
        // Elsewhere the value is any, and nothing depends on it.
        let evaluated = Kind::If { coherent, c, then, otherwise: None };
        before.push(Stmt::bind(value.clone(), false, Expr { kind: evaluated, span }));
        match self.pattern(&l.pat, &name(&value), lets) {
            Some(test) => logic(true, name(&flag), test),
            None => name(&flag),
        }
    }

    /// Parses `if let PATTERN = e { .. } else { .. }`.
    pub(super) fn conditional_let(&mut self, i: &syn::ExprIf) -> Kind {
        let (mut before, mut lets) = (Vec::new(), Vec::new());
        let coherent = self.is_coherent || i.attrs.iter().any(is_coherent);
        let c = Box::new(self.condition(&i.cond, &mut before, &mut lets));
        let mut then = self.block(&i.then_branch);
        then.stmts.splice(0..0, lets);
        let otherwise = i.else_branch.as_ref().map(|(_, e)| self.boxed(e));
        let kind = Kind::If { coherent, c, then, otherwise };
        if before.is_empty() {
            return kind;
        }
        let tail = Some(Box::new(Expr { kind, span: i.span() }));
        Kind::Block(Block { stmts: before, tail })
    }

    /// Parses `while let PATTERN = e { .. }`.
    pub(super) fn while_let(&mut self, w: &syn::ExprWhile) -> Kind {
        let (mut stmts, mut lets) = (Vec::new(), Vec::new());
        let (span, coherent) = (w.span(), self.is_coherent);
        let c = Box::new(self.condition(&w.cond, &mut stmts, &mut lets));
        let mut then = self.block(&w.body);
        then.stmts.splice(0..0, lets);
        let exit = Expr { kind: Kind::Break(None, None), span };
        let exit = Block { stmts: vec![Stmt::Expr(exit)], tail: None };
        let otherwise = Some(Box::new(Expr { kind: Kind::Block(exit), span }));
        let kind = Kind::If { coherent, c, then, otherwise };
        stmts.push(Stmt::Expr(Expr { kind, span }));
        Kind::Loop { label: label(&w.label), body: Block { stmts, tail: None } }
    }

    /// Parses `e?` of an `Option`: its value, or the kernel gives `None`.
    pub(super) fn tried(&mut self, t: &syn::ExprTry) -> Kind {
        // In parentheses, for a `let else` takes no value that ends in a brace.
        let e = &t.expr;
        let block = syn::parse_quote_spanned! {t.question_token.span=>
            {
                let Some(__tried) = (#e) else {
                    return None;
                };
                __tried
            }
        };
        self.expr(&block).kind
    }

    /// Parses `let PATTERN = init else { .. };`.
    pub(super) fn let_else(
        &mut self,
        pat: &Pat,
        init: &syn::Expr,
        diverging: &syn::Expr,
    ) -> Vec<Stmt> {
        let (mut stmts, mut lets) = (Vec::new(), Vec::new());
        let span = pat.span();
        let from = self.expr(init);
        let from = self.read_often(from, &pat.to_token_stream(), &mut stmts);
        let test = self.pattern(pat, &from, &mut lets);
        let body = self.expr(diverging);
        if let Some(test) = test {
            let then = match body.kind {
                Kind::Block(block) => block,
                kind => Block { stmts: vec![Stmt::Expr(Expr { kind, span })], tail: None },
            };
            let c = Box::new(Expr { kind: Kind::Not(Box::new(test)), span });
            let kind = Kind::If { coherent: self.is_coherent, c, then, otherwise: None };
            stmts.push(Stmt::Expr(Expr { kind, span }));
        }
        stmts.extend(lets);
        stmts
    }
}
