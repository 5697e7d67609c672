//! Emission of statements and structured control flow.

use std::collections::HashMap;

use proc_macro2::{Ident, Span, TokenStream};
use quote::{format_ident, quote_spanned};

use super::{Binding, Dest, Emitter, Loop, SlotType, own, private, shown};
use crate::here::{At, quote_here as quote, word};
use crate::model::{Block, Expr, Kind, Let, Stmt};

/// Emits a report of the lanes' place to the machine.
pub(super) fn place(what: &str, span: Span) -> TokenStream {
    let (p, m) = (private(), own("m"));
    let line = quote_spanned!(span=> ::core::file!(), ::core::line!());
    quote!(#p::here(#m, #what, #line);)
}

impl Emitter<'_> {
    /// Emits a block whose value goes to `dest`, with checks that leave it once no lane is left.
    pub(super) fn block(&mut self, block: &Block, dest: &Dest) -> TokenStream {
        self.scopes.push(HashMap::new());
        let (p, m) = (private(), own("m"));
        let label = self.next;
        self.next += 1;
        let label = syn::Lifetime::new(&format!("'block_{label}"), Span::mixed_site());
        let mut out = TokenStream::new();
        let mut checked = false;
        let mut ended = false;
        for (i, stmt) in block.stmts.iter().enumerate() {
            out.extend(self.stmt(stmt));
            if matches!(stmt, Stmt::Expr(e) if e.diverges()) {
                // The rest is unreachable; rustc reports that in the user's own function.
                out.extend(self.unreached(&block.stmts[i + 1..], block.tail.as_deref(), dest));
                ended = true;
                break;
            }
            let more = i + 1 < block.stmts.len() || block.tail.is_some();
            if stmt.ends_lanes() && more {
                out.extend(quote!(if !#p::Machine::alive(#m) { break #label; }));
                checked = true;
            }
        }
        if let (Some(tail), false) = (&block.tail, ended) {
            out.extend(self.into(tail, dest));
        }
        self.scopes.pop();
        if checked { quote!(#label: { #out }) } else { quote!({ #out }) }
    }

    /// Emits the code behind an exit: it never runs, but it determines the type of the block.
    fn unreached(&mut self, stmts: &[Stmt], tail: Option<&Expr>, dest: &Dest) -> TokenStream {
        let (Some(tail), Dest::Slot { .. }) = (tail, dest) else { return TokenStream::new() };
        let stmts: Vec<_> = stmts.iter().map(|s| self.stmt(s)).collect();
        let tail = self.into(tail, dest);
        quote!(if false { #(#stmts)* #tail })
    }

    pub(super) fn stmt(&mut self, stmt: &Stmt) -> TokenStream {
        match stmt {
            Stmt::Let(l) => self.let_stmt(l),
            Stmt::Expr(e) => self.into(e, &Dest::None),
            Stmt::Item(item) => item.clone(),
        }
    }

    fn let_stmt(&mut self, l: &Let) -> TokenStream {
        let (p, m) = (private(), own("m"));
        if l.host {
            return self.host_let(l);
        }
        let Some(name) = &l.name else {
            let value = l.init.as_ref().map(|e| self.value(e));
            return quote!(let _ = #value;);
        };
        if let Some(Expr { kind: Kind::Closure(kernel), .. }) = &l.init {
            let closure = self.closure(kernel);
            self.bind(name, Binding::Function);
            // Attributes are for the arguments of calls.
            return quote!(let #name = #p::with_name(#closure););
        }
        let text = shown(name);
        let ty = l.ty.as_ref().map(|t| self.on(t));
        let Some(init) = &l.init else {
            self.bind_typed(name, Binding::Var, l.ty.as_ref());
            let ty = ty.unwrap_or_else(|| quote!(_));
            return quote!(let #name = #p::Var::<#ty>::declare(#m, #text););
        };
        let value = match &l.ty {
            Some(ty) => self.wanted(init, &text, ty),
            None if l.mutable => self.varying(init, &text),
            None if matches!(init.kind, Kind::Tuple(_)) => self.tuple(init),
            None => self.named_value(init, &text),
        };
        self.bind_let(name, l, init);
        match (l.mutable, ty) {
            (true, Some(ty)) => quote!(let #name = #p::Var::<#ty>::new(#m, #text, #value);),
            (true, None) => {
                quote!(let #name = #p::Var::new(#m, #text, #value);)
            }
            (false, Some(ty)) => {
                quote!(let #name: #ty = #p::Machine::named(#m, #text, #value);)
            }
            (false, None) => quote!(let #name = #p::Machine::named(#m, #text, #value);),
        }
    }

    /// Binds the name of a `let`, with what its initial value determines about it.
    fn bind_let(&mut self, name: &Ident, l: &Let, init: &Expr) {
        // A part of a `&mut` is copied, unless a pattern takes it.
        let is_part = matches!(init.kind, Kind::Field { .. } | Kind::Index { .. });
        let is_alias = self.is_alias(init) && (l.is_pattern || !is_part);
        let owner = self.owner(init);
        let generic = self.generic_of(init);
        if is_alias && l.mutable && matches!(&init.kind, Kind::Name(_)) {
            self.errors.at(
                init.span,
                "a kernel has no second name for a `&mut`",
                "write `*x` to copy the value, or go on with the first name",
            );
        }
        let binding = if l.mutable { Binding::Var } else { Binding::Value };
        self.bind_typed(name, binding, l.ty.as_ref());
        let Some(local) = self.newest(name) else { return };
        if l.ty.is_none() {
            local.owner = owner;
            (local.generic, local.elements) = generic;
        }
        local.alias |= is_alias && !l.mutable;
        local.literal = !l.mutable && l.ty.is_none() && init.is_untyped_integer();
        local.bare = l.is_bare();
        local.bare_elements = match &init.kind {
            Kind::Tuple(items) if l.ty.is_none() => {
                items.iter().any(Expr::has_untyped_integer).then_some(items.len())
            }
            _ => None,
        };
    }

    /// Evaluates `e` and sends its value to `dest`.
    pub(super) fn into(&mut self, e: &Expr, dest: &Dest) -> TokenStream {
        let _at = At::new(e.span);
        match &e.kind {
            Kind::If { .. } if !matches!(dest, Dest::None) && e.is_selection() => {
                self.send(e, dest)
            }
            Kind::If { coherent, c, then, otherwise } => {
                self.branch(*coherent, c, then, otherwise.as_deref(), dest)
            }
            Kind::Block(b) => self.block(b, dest),
            Kind::While { label, c, body } => {
                self.while_loop(label.clone(), Some(c), body, &Dest::None, e.span)
            }
            Kind::Loop { label, body } => self.while_loop(label.clone(), None, body, dest, e.span),
            Kind::ForItems { label, item, items, body } => {
                self.for_items(label.clone(), item, items, body, e.span)
            }
            Kind::For { label, var, range, body } => {
                self.for_loop(label.clone(), var.as_ref(), range, body, e.span)
            }
            Kind::Break(label, value) => self.exit(label.as_deref(), "leave", value.as_deref()),
            Kind::Continue(label) => self.exit(label.as_deref(), "skip", None),
            Kind::Return(value) => self.return_stmt(value.as_deref()),
            Kind::Assign { place, value } => self.assign(place, None, value),
            Kind::OpAssign { op, place, value } => self.assign(place, Some(*op), value),
            _ => self.send(e, dest),
        }
    }

    pub(super) fn send(&mut self, e: &Expr, dest: &Dest) -> TokenStream {
        let m = own("m");
        match dest {
            Dest::None => {
                let value = self.value(e);
                quote!(#value;)
            }
            Dest::Slot { var, ty }
                if *ty == SlotType::Written
                    || *ty == SlotType::ByOthers && !e.has_typed_outcome() =>
            {
                let value = self.coerced(e);
                quote!(#var.set(#m, #value);)
            }
            Dest::Slot { var, .. } => {
                let value = self.varying(e, "value");
                let is_first = self.given.insert(var.to_string());
                let value = if is_first { value } else { self.like_others(value) };
                quote!(#var.set(#m, #value);)
            }
            Dest::Return => self.give(e),
        }
    }

    pub(super) fn give(&mut self, e: &Expr) -> TokenStream {
        let (m, ret) = (own("m"), own("ret"));
        let value = if self.kernel.result.is_some() {
            self.coerced(e)
        } else {
            match self.is_inferred() {
                true if self.gives_bare() => self.coerced(e),
                true => self.varying(e, "value"),
                false => self.value(e),
            }
        };
        let all = self.with_changed(value);
        quote!(#ret.give(#m, #all);)
    }

    pub(super) fn return_stmt(&mut self, value: Option<&Expr>) -> TokenStream {
        match value {
            Some(e) => self.into(e, &Dest::Return),
            None => {
                let (m, ret) = (own("m"), own("ret"));
                let all = self.with_changed(quote!(()));
                quote!(#ret.give(#m, #all);)
            }
        }
    }

    pub(super) fn branch(
        &mut self,
        coherent: bool,
        c: &Expr,
        then: &Block,
        otherwise: Option<&Expr>,
        dest: &Dest,
    ) -> TokenStream {
        let (p, m) = (private(), own("m"));
        let branch = self.fresh("branch");
        // Host values are the same for all rays.
        let host = self.host_value(c);
        self.varying += usize::from(host.is_none());
        let is_varying = host.is_none();
        let here = place("if", c.span);
        let c = host.unwrap_or_else(|| self.value(c));
        // Small arms run untested.
        let hook = |name: &str, is_small: bool| {
            let name =
                if !coherent && is_small { format!("{name}_small") } else { name.to_owned() };
            word(&name)
        };
        let enter = hook("then", then.is_small());
        let then = self.block(then, dest);
        let other = otherwise.map(|e| {
            let enter = hook("otherwise", e.is_small());
            let arm = self.into(e, dest);
            let here = place("else", e.span);
            quote!(if #branch.#enter(#m) { #here #arm })
        });
        self.varying -= usize::from(is_varying);
        quote! {
            let #branch = #p::Branch::new(#m, #c);
            if #branch.#enter(#m) { #here #then }
            #other
            #branch.end(#m);
        }
    }

    pub(super) fn while_loop(
        &mut self,
        label: Option<String>,
        c: Option<&Expr>,
        body: &Block,
        dest: &Dest,
        span: Span,
    ) -> TokenStream {
        let (p, m) = (private(), own("m"));
        let here = place("loop", span);
        let ident = self.fresh("repeat");
        let test = c.map(|c| {
            let c = self.value(c);
            quote!(if !#ident.test(#m, #c) { break; })
        });
        let inside = Loop { label, ident: ident.clone(), dest: dest.clone() };
        let body = self.loop_body(inside, body);
        quote! {
            let #ident = #p::Loop::new(#m);
            loop {
                #test
                #here
                #body
                #ident.continuing(#m);
                if !#ident.again(#m) { break; }
            }
            #ident.end(#m);
        }
    }

    /// Emits the body of a loop, which may leave it.
    pub(super) fn loop_body(&mut self, inside: Loop, body: &Block) -> TokenStream {
        self.loops.push(inside);
        self.varying += 1;
        let body = self.block(body, &Dest::None);
        self.varying -= 1;
        self.loops.pop();
        body
    }

    pub(super) fn exit(
        &mut self,
        label: Option<&str>,
        how: &str,
        value: Option<&Expr>,
    ) -> TokenStream {
        let mut loops = self.loops.iter().rev();
        let found = match label {
            None => loops.next(),
            Some(l) => loops.find(|x| x.label.as_deref() == Some(l)),
        };
        // An unknown label is reported by rustc, in the user's own function.
        let Some(Loop { ident, dest, .. }) = found else { return TokenStream::new() };
        let (m, how) = (own("m"), format_ident!("{how}"));
        let (ident, dest) = (ident.clone(), dest.clone());
        let value = value.map(|e| self.into(e, &dest));
        quote!(#value #ident.#how(#m);)
    }
}
