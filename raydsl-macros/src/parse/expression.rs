//! Parsing of expressions.

use proc_macro2::Span;
use quote::ToTokens;
use syn::spanned::Spanned;
use syn::{BinOp, Lit, UnOp};

use super::Parser;
use super::attributes::{attributes, is_coherent};
use super::condition::has_let;
use super::pattern::{none_of, variant_of};
use super::place::assignment;
use super::refused::is_absent;
use crate::model::{BinaryOp, Block, Expr, IntType, Kind, Step, Stmt};
use crate::ops;

pub(super) fn label(l: &Option<syn::Label>) -> Option<String> {
    l.as_ref().map(|l| l.name.ident.to_string())
}

fn lifetime(l: &Option<syn::Lifetime>) -> Option<String> {
    l.as_ref().map(|l| l.ident.to_string())
}

/// Returns the span for a mistake in `e`: the operator or the name, as in rustc.
fn shown_at(e: &syn::Expr) -> Span {
    match e {
        syn::Expr::Binary(b) => b.op.span(),
        syn::Expr::MethodCall(c) => c.method.span(),
        syn::Expr::Field(f) => f.member.span(),
        syn::Expr::Cast(c) => c.ty.span(),
        syn::Expr::Paren(p) => shown_at(&p.expr),
        _ => e.span(),
    }
}

pub(super) fn inside_parens(mut e: &syn::Expr) -> &syn::Expr {
    while let syn::Expr::Paren(p) = e {
        e = &p.expr;
    }
    e
}

/// Returns a labelled block as a loop of one iteration: only its label can leave it (E0695).
pub(super) fn run_once(label: Option<String>, mut block: Block, span: Span) -> Kind {
    let exit = Kind::Break(label.clone(), block.tail.take());
    block.stmts.push(Stmt::Expr(Expr { kind: exit, span }));
    Kind::Loop { label, body: block }
}

impl Parser<'_> {
    pub(super) fn boxed(&mut self, e: &syn::Expr) -> Box<Expr> {
        Box::new(self.expr(e))
    }

    fn exprs<'b>(&mut self, es: impl IntoIterator<Item = &'b syn::Expr>) -> Vec<Expr> {
        es.into_iter().map(|e| self.expr(e)).collect()
    }

    pub(super) fn expr(&mut self, e: &syn::Expr) -> Expr {
        self.no_attributes(attributes(e));
        Expr { kind: self.kind(e), span: shown_at(e) }
    }

    fn kind(&mut self, e: &syn::Expr) -> Kind {
        match e {
            syn::Expr::Lit(l) => self.literal(&l.lit),
            syn::Expr::Path(p) => self.path(p),
            syn::Expr::Paren(p) => self.expr(&p.expr).kind,
            syn::Expr::Group(g) => self.expr(&g.expr).kind,
            syn::Expr::Unary(u) => self.unary(u),
            syn::Expr::Binary(b) => self.binary(b),
            syn::Expr::Cast(c) => Kind::Cast { value: self.boxed(&c.expr), ty: self.ty(&c.ty) },
            syn::Expr::Call(c) => self.call(c),
            syn::Expr::MethodCall(c) => self.method(c),
            syn::Expr::Field(f) => {
                Kind::Field { base: self.boxed(&f.base), member: f.member.to_token_stream() }
            }
            syn::Expr::Index(i) => self.index(i),
            syn::Expr::Struct(s) => self.structure(s),
            syn::Expr::Tuple(t) => Kind::Tuple(self.exprs(&t.elems)),
            syn::Expr::If(i) => self.conditional(i),
            syn::Expr::While(w) if has_let(&w.cond) => self.while_let(w),
            syn::Expr::While(w) => Kind::While {
                label: label(&w.label),
                c: self.boxed(&w.cond),
                body: self.block(&w.body),
            },
            syn::Expr::Loop(l) => Kind::Loop { label: label(&l.label), body: self.block(&l.body) },
            syn::Expr::ForLoop(f) => self.for_loop(f),
            syn::Expr::Block(b) => match &b.label {
                None => Kind::Block(self.block(&b.block)),
                Some(_) => run_once(label(&b.label), self.block(&b.block), b.span()),
            },
            syn::Expr::Break(b) => {
                let value = b.expr.as_ref().map(|e| self.boxed(e));
                Kind::Break(lifetime(&b.label), value)
            }
            syn::Expr::Match(m) => self.matching(m),
            syn::Expr::Array(a) => Kind::Array(self.exprs(&a.elems)),
            syn::Expr::Repeat(r) => {
                Kind::Repeat { value: self.boxed(&r.expr), len: r.len.to_token_stream() }
            }
            syn::Expr::Continue(c) => Kind::Continue(lifetime(&c.label)),
            syn::Expr::Return(r) => self.return_of(r.expr.as_deref()),
            syn::Expr::Assign(a) => self.assign(a),
            // Values are copied: a reference is the value, and so is its referent.
            syn::Expr::Reference(r) if r.mutability.is_none() => self.expr(&r.expr).kind,
            syn::Expr::Try(t) => self.tried(t),
            syn::Expr::Macro(m) => self.macro_call(&m.mac),
            other => self.unsupported(other),
        }
    }

    /// Parses `return`, which in a closure leaves the closure.
    fn return_of(&mut self, value: Option<&syn::Expr>) -> Kind {
        let value = value.map(|e| self.boxed(e));
        match self.returns_to {
            Some(label) => Kind::Break(Some(label.to_owned()), value),
            None => Kind::Return(value),
        }
    }

    pub(super) fn literal(&mut self, lit: &Lit) -> Kind {
        match lit {
            Lit::Float(f) if f.suffix() == "f64" => self.error(
                f.span(),
                "kernels compute in `f32`",
                "write the number with the suffix `f32`, or without one",
            ),
            Lit::Float(f) => {
                let digits = syn::LitFloat::new(
                    &format!("{}f32", f.base10_digits().trim_end_matches('.')),
                    f.span(),
                );
                Kind::Float(digits.to_token_stream())
            }
            Lit::Int(i) => match i.suffix() {
                "" => Kind::Int { tokens: i.to_token_stream(), suffix: None },
                "i32" => Kind::Int { tokens: i.to_token_stream(), suffix: Some(IntType::I32) },
                "u32" => Kind::Int { tokens: i.to_token_stream(), suffix: Some(IntType::U32) },
                "usize" => Kind::Int { tokens: i.to_token_stream(), suffix: Some(IntType::Usize) },
                "f32" => Kind::Float(i.to_token_stream()),
                other => self.error(
                    i.span(),
                    format!("kernels have no `{other}`"),
                    "use `u32`, `i32`, `usize` or `f32`",
                ),
            },
            Lit::Bool(b) => Kind::Bool(b.value),
            _ => self.error(
                lit.span(),
                "a kernel has numbers and truth values only",
                "keep text outside the kernel",
            ),
        }
    }

    fn path(&mut self, p: &syn::ExprPath) -> Kind {
        if let Some(last) = p.path.segments.last().filter(|s| is_absent(&s.ident)) {
            return self.absent(&last.ident);
        }
        if let Some(none) = none_of(&p.path) {
            return none.value(vec![], p.span()).kind;
        }
        match p.path.get_ident() {
            Some(ident) => Kind::Name(ident.clone()),
            None => Kind::Path(p.to_token_stream()),
        }
    }

    fn unary(&mut self, u: &syn::ExprUnary) -> Kind {
        match u.op {
            UnOp::Neg(_) => Kind::Neg(self.boxed(&u.expr)),
            UnOp::Not(_) => Kind::Not(self.boxed(&u.expr)),
            _ => Kind::Deref(self.boxed(&u.expr)),
        }
    }

    fn binary(&mut self, b: &syn::ExprBinary) -> Kind {
        if let Some(op) = assignment(&b.op) {
            return self.op_assign(op, b);
        }
        let (left, right) = (self.boxed(&b.left), self.boxed(&b.right));
        let compare = match b.op {
            BinOp::And(_) => return Kind::Logic { and: true, a: left, b: right },
            BinOp::Or(_) => return Kind::Logic { and: false, a: left, b: right },
            BinOp::Eq(_) => Some("Eq"),
            BinOp::Ne(_) => Some("Ne"),
            BinOp::Lt(_) => Some("Lt"),
            BinOp::Le(_) => Some("Le"),
            BinOp::Gt(_) => Some("Gt"),
            BinOp::Ge(_) => Some("Ge"),
            _ => None,
        };
        match (compare, arithmetic(&b.op)) {
            (Some(op), _) => Kind::Compare { op, a: left, b: right },
            (None, Some(op)) => Kind::Binary { op, a: left, b: right },
            (None, None) => self.error(b.op.span(), "a kernel has no such operator", "rewrite it"),
        }
    }

    fn index(&mut self, i: &syn::ExprIndex) -> Kind {
        let base = self.boxed(&i.expr);
        match self.step(&i.index) {
            Some(Step::Element(index)) => Kind::Index { base, index },
            Some(Step::Computed(index)) => Kind::Element { base, index: Box::new(index) },
            _ => Kind::Error,
        }
    }

    fn structure(&mut self, s: &syn::ExprStruct) -> Kind {
        s.fields.iter().for_each(|f| self.no_attributes(&f.attrs));
        if let Some(variant) = variant_of(&s.path) {
            let named = |f: &syn::FieldValue| f.member.to_token_stream().to_string();
            let values = s.fields.iter().map(|f| (named(f), self.expr(&f.expr))).collect();
            return variant.structure(values, s.span()).kind;
        }
        let fields =
            s.fields.iter().map(|f| (f.member.to_token_stream(), self.expr(&f.expr))).collect();
        let rest = s.rest.as_ref().map(|e| self.boxed(e));
        Kind::Struct { path: s.path.to_token_stream(), fields, rest }
    }

    fn conditional(&mut self, i: &syn::ExprIf) -> Kind {
        if has_let(&i.cond) {
            return self.conditional_let(i);
        }
        Kind::If {
            coherent: self.is_coherent || i.attrs.iter().any(is_coherent),
            c: self.boxed(&i.cond),
            then: self.block(&i.then_branch),
            otherwise: i.else_branch.as_ref().map(|(_, e)| self.boxed(e)),
        }
    }
}

fn arithmetic(op: &BinOp) -> Option<BinaryOp> {
    Some(match op {
        BinOp::Add(_) => ops::ADD,
        BinOp::Sub(_) => ops::SUB,
        BinOp::Mul(_) => ops::MUL,
        BinOp::Div(_) => ops::DIV,
        BinOp::Rem(_) => ops::REM,
        BinOp::BitAnd(_) => ops::BIT_AND,
        BinOp::BitOr(_) => ops::BIT_OR,
        BinOp::BitXor(_) => ops::BIT_XOR,
        BinOp::Shl(_) => ops::SHL,
        BinOp::Shr(_) => ops::SHR,
        _ => return None,
    })
}
