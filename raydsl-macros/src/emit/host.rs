//! Emission of host values: known before a kernel runs, and while it is recorded.

use proc_macro2::{Ident, TokenStream};
use quote::format_ident;

use super::{Binding, Emitter, own, private};
use crate::here::quote_here as quote;
use crate::model::{Expr, Kind, Let};

/// Returns the local that holds a captured number as a host value.
pub(crate) fn raw_capture(name: &Ident) -> Ident {
    format_ident!("__host_{name}")
}

impl Emitter<'_> {
    /// Returns `e` as plain Rust, if everything in it is known to the host.
    pub(super) fn host_value(&mut self, e: &Expr) -> Option<TokenStream> {
        match &e.kind {
            Kind::Int { tokens, .. } | Kind::Float(tokens) | Kind::Path(tokens) => {
                Some(tokens.clone())
            }
            Kind::Bool(b) => Some(quote!(#b)),
            Kind::Name(name) if self.lookup(name) == Some(Binding::Host) => Some(quote!(#name)),
            Kind::Name(name) => self.is_constant(name).then(|| quote!(#name)),
            Kind::Host(inner) => self.host_argument(inner),
            Kind::Neg(a) => self.host_value(a).map(|a| quote!((-#a))),
            Kind::Not(a) => self.host_value(a).map(|a| quote!((!#a))),
            Kind::Cast { value, ty } => {
                let value = self.host_value(value)?;
                Some(quote!((#value as #ty)))
            }
            Kind::Binary { op, a, b } => self.host_binary(op.symbol, a, b),
            Kind::Compare { op, a, b } => self.host_binary(comparison(op), a, b),
            Kind::Is { value, path, .. } => {
                let value = self.host_value(value)?;
                Some(quote!(::core::matches!(#value, #path)))
            }
            Kind::Logic { and, a, b } => self.host_binary(if *and { "&&" } else { "||" }, a, b),
            _ => None,
        }
    }

    fn host_binary(&mut self, symbol: &str, a: &Expr, b: &Expr) -> Option<TokenStream> {
        let (a, b) = (self.host_value(a)?, self.host_value(b)?);
        let symbol: TokenStream = symbol.parse().ok()?;
        Some(quote!((#a #symbol #b)))
    }

    /// Returns the argument of `host(..)`, which may also be a captured number.
    fn host_argument(&mut self, e: &Expr) -> Option<TokenStream> {
        let Kind::Name(name) = &e.kind else { return self.host_value(e) };
        if self.lookup(name).is_some() || !self.is_closure {
            return self.host_value(e);
        }
        self.capture(name);
        if !self.host_captures.contains(name) {
            self.host_captures.push(name.clone());
        }
        let raw = raw_capture(name);
        Some(quote!(#raw))
    }

    /// Emits `host(x)` used as a value.
    pub(super) fn host_use(&mut self, e: &Expr) -> TokenStream {
        let (p, m) = (private(), own("m"));
        match self.host_argument(e) {
            Some(value) => quote!(#p::HostUse::value(#value, #m)),
            None => {
                self.not_of_the_host(e);
                quote!(::core::unreachable!())
            }
        }
    }

    /// Emits `#[host] let`.
    pub(super) fn host_let(&mut self, l: &Let) -> TokenStream {
        let (Some(name), Some(init)) = (&l.name, &l.init) else { return TokenStream::new() };
        let Some(value) = self.host_value(init) else {
            self.not_of_the_host(init);
            return TokenStream::new();
        };
        self.bind(name, Binding::Host);
        let mutable = l.mutable.then(|| quote!(mut));
        let ty = l.ty.as_ref().map(|ty| quote!(: #ty));
        quote!(let #mutable #name #ty = #value;)
    }

    fn not_of_the_host(&mut self, e: &Expr) {
        self.errors.at(
            e.span,
            "this value is not known before the kernel runs",
            "a host value is made of numbers, constants, other host values and `host(captured)`",
        );
    }

    /// Emits an assignment to a host variable: all lanes must take part.
    pub(super) fn host_assign(
        &mut self,
        name: &Ident,
        op: Option<&str>,
        value: &Expr,
    ) -> TokenStream {
        if self.varying > 0 {
            self.errors.at(
                name.span(),
                format!("`{name}` is a host variable, and this code may run for some rays only"),
                "assign it outside of loops and of conditions that are not the host's, or remove \
                 `#[host]`",
            );
            return TokenStream::new();
        }
        let Some(value) = self.host_value(value) else {
            self.not_of_the_host(value);
            return TokenStream::new();
        };
        match op.and_then(|op| op.parse::<TokenStream>().ok()) {
            Some(op) => quote!(#name = #name #op #value;),
            None => quote!(#name = #value;),
        }
    }
}

fn comparison(op: &str) -> &'static str {
    match op {
        "Eq" => "==",
        "Ne" => "!=",
        "Lt" => "<",
        "Le" => "<=",
        "Gt" => ">",
        _ => ">=",
    }
}
