//! Spans of generated code: those of the source that it comes from.
//!
//! rustc reports errors in generated code at the spans of its tokens, and omits an error that
//! another one at the same place implies. So all code from one expression has one span: where a
//! reader of the source would look for the mistake.

use std::cell::Cell;

use proc_macro2::{Group, Ident, Span, TokenStream, TokenTree};
use quote::{format_ident, quote};

thread_local! {
    static HERE: Cell<Option<Span>> = const { Cell::new(None) };
}

/// A guard while which generated code has the span of a part of the source.
pub(crate) struct At(Option<Span>);

impl At {
    pub(crate) fn new(span: Span) -> Self {
        Self(HERE.replace(Some(span)))
    }
}

impl Drop for At {
    fn drop(&mut self) {
        HERE.set(self.0);
    }
}

/// Returns the span for names that are resolved at the macro's call.
pub(crate) fn here() -> Span {
    located(Span::call_site())
}

/// Returns a local of the macro's own, hygienic against the user's. Its text differs from theirs too,
/// since the variables that a closure mentions are told by their text.
pub(crate) fn own(name: &str) -> Ident {
    format_ident!("__{name}", span = located(Span::mixed_site()))
}

/// Returns a name of the library.
pub(crate) fn word(name: &str) -> Ident {
    Ident::new(name, here())
}

/// Returns the module of the items for generated code, with the span of the macro's call.
pub(crate) fn private() -> TokenStream {
    quote!(::raydsl::__private)
}

/// Returns the module of the items for generated code, with the span [`here()`].
pub(crate) fn private_here() -> TokenStream {
    quote_here!(::raydsl::__private)
}

/// Sets the span of generated code to that of the type.
pub(crate) fn of_type(ty: &TokenStream) -> At {
    At::new(ty.clone().into_iter().next().map_or_else(here, |t| t.span()))
}

/// Sets the span of every token to [`here()`]. The macro's name for its crate keeps its span, which
/// identifies the crate.
pub(crate) fn in_one_place(tokens: TokenStream) -> TokenStream {
    let token = |mut token: TokenTree| {
        if let TokenTree::Group(g) = &token {
            token = Group::new(g.delimiter(), in_one_place(g.stream())).into();
        }
        if token.to_string() != "$crate" {
            token.set_span(here());
        }
        token
    };
    tokens.into_iter().map(token).collect()
}

fn located(span: Span) -> Span {
    HERE.get().map_or(span, |at| span.located_at(at))
}

/// Works like [`quote::quote!`], with the span [`here()`].
macro_rules! quote_here {
    ($($tokens:tt)*) => { ::quote::quote_spanned!($crate::here::here()=> $($tokens)*) };
}

pub(crate) use quote_here;
