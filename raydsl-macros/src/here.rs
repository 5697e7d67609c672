//! Where generated code seems to stand: at the part of the source that it is made of.
//!
//! rustc shows errors in generated code at the spans of its tokens, and leaves out an error that
//! another one at the same place implies. So everything that comes from one expression stands at
//! one place: where a reader of the source would look for the mistake.

use std::cell::Cell;

use proc_macro2::{Group, Ident, Span, TokenStream, TokenTree};
use quote::quote;

thread_local! {
    static HERE: Cell<Option<Span>> = const { Cell::new(None) };
}

/// Until it is dropped, generated code stands at a part of the source.
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

/// The place for names that are resolved where the macro is called.
pub(crate) fn here() -> Span {
    located(Span::call_site())
}

/// A local of the macro's own: it cannot meet one of the user's.
pub(crate) fn own(name: &str) -> Ident {
    Ident::new(name, located(Span::mixed_site()))
}

/// A name of the library's.
pub(crate) fn word(name: &str) -> Ident {
    Ident::new(name, here())
}

/// The module with all that generated code uses, standing where the macro is called.
pub(crate) fn private() -> TokenStream {
    quote!(::raydsl::__private)
}

/// The module with all that generated code uses, standing [`here()`].
pub(crate) fn private_here() -> TokenStream {
    quote_here!(::raydsl::__private)
}

/// Code stands where the type does.
pub(crate) fn of_type(ty: &TokenStream) -> At {
    At::new(ty.clone().into_iter().next().map_or_else(here, |t| t.span()))
}

/// Every token [`here()`]. What a macro calls its crate stays: its place says which crate it is.
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

/// [`quote::quote!`], standing [`here()`].
macro_rules! quote_here {
    ($($tokens:tt)*) => { ::quote::quote_spanned!($crate::here::here()=> $($tokens)*) };
}

pub(crate) use quote_here;
