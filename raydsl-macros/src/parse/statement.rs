//! Parsing of blocks and their statements.

use proc_macro2::TokenStream;
use quote::ToTokens;
use syn::Pat;
use syn::spanned::Spanned;

use super::Parser;
use super::attributes::is_host;
use super::closure::closure_in;
use super::refused::gives_struct;
use crate::model::{Block, Expr, Let, Stmt};

impl Parser<'_> {
    pub(super) fn block(&mut self, b: &syn::Block) -> Block {
        let mut stmts = Vec::new();
        let mut tail = None;
        let last = b.stmts.len().wrapping_sub(1);
        for (i, stmt) in b.stmts.iter().enumerate() {
            match stmt {
                syn::Stmt::Local(l) => stmts.extend(self.local(l)),
                syn::Stmt::Expr(e, None) if i == last => tail = Some(self.boxed(e)),
                syn::Stmt::Expr(e, _) => stmts.push(Stmt::Expr(self.expr(e))),
                syn::Stmt::Item(item) => stmts.extend(self.item(item)),
                syn::Stmt::Macro(m) => {
                    self.no_attributes(&m.attrs);
                    let kind = self.macro_call(&m.mac);
                    stmts.push(Stmt::Expr(Expr { kind, span: m.span() }));
                }
            }
        }
        Block { stmts, tail }
    }

    fn item(&mut self, item: &syn::Item) -> Option<Stmt> {
        match item {
            syn::Item::Const(_) | syn::Item::Use(_) => Some(Stmt::Item(item.to_token_stream())),
            _ => {
                self.errors.at(
                    item.span(),
                    "this item cannot stand inside a kernel",
                    "move it out of the kernel",
                );
                None
            }
        }
    }

    fn local(&mut self, l: &syn::Local) -> Vec<Stmt> {
        self.no_attributes(&l.attrs);
        let (pat, ty) = match &l.pat {
            Pat::Type(t) => (&*t.pat, Some(self.ty(&t.ty))),
            pat => (pat, None),
        };
        if let Some(init) = &l.init
            && let Some((_, diverging)) = &init.diverge
        {
            return self.let_else(&l.pat, &init.expr, diverging);
        }
        let init = l.init.as_ref().map(|init| match closure_in(&init.expr) {
            Some(c) if matches!(pat, Pat::Ident(_)) => self.named_closure(c),
            _ => self.expr(&init.expr),
        });
        let (name, mutable) = match pat {
            Pat::Ident(p) if p.by_ref.is_none() && p.subpat.is_none() => {
                (Some(p.ident.clone()), p.mutability.is_some())
            }
            Pat::Wild(_) => (None, false),
            pat => return self.local_parts(pat, ty, init),
        };
        let host = l.attrs.iter().any(is_host);
        if host && init.is_none() {
            self.errors.at(
                l.span(),
                "a host variable needs a value",
                "give it one: `let n = 4u32;`",
            );
        }
        vec![Stmt::Let(Let { host, is_pattern: false, name, mutable, ty, init })]
    }

    /// Parses `let (a, b) = init`.
    fn local_parts(&mut self, pat: &Pat, ty: Option<TokenStream>, init: Option<Expr>) -> Vec<Stmt> {
        let Some(init) = init else {
            self.errors.at(
                pat.span(),
                "a pattern of a kernel needs a value",
                "declare each name by itself: `let a; let b;`",
            );
            return Vec::new();
        };
        if matches!(pat, Pat::Tuple(_)) && gives_struct(&init.kind) {
            self.errors.leave_to_rustc();
        }
        self.destructure(pat, init, ty)
    }
}
