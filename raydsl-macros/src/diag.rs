//! Errors, collected: a user sees all mistakes of a kernel at once.

use proc_macro2::{Ident, Span, TokenStream};
use quote::quote;

/// An item that a macro leaves as it is, with an error at all of `place`.
pub(crate) fn refused(
    item: &TokenStream,
    place: &TokenStream,
    what: &str,
    help: &str,
) -> TokenStream {
    let e = syn::Error::new_spanned(place, format!("{what}\n  help: {help}"));
    let e = e.into_compile_error();
    quote!(#item #e)
}

/// Collects the errors of one macro call.
#[derive(Default)]
pub(crate) struct Errors {
    first: Option<syn::Error>,
    count: usize,
    /// Whether the source has a mistake that rustc reports there.
    is_rustcs: bool,
}

impl Errors {
    /// `what` is wrong at `span`; `help` says what to write instead.
    pub(crate) fn at(&mut self, span: Span, what: impl core::fmt::Display, help: &str) {
        self.push(syn::Error::new(span, format!("{what}\n  help: {help}")));
    }

    pub(crate) fn push(&mut self, e: syn::Error) {
        self.count += 1;
        match &mut self.first {
            Some(first) => first.combine(e),
            None => self.first = Some(e),
        }
    }

    /// Notes a mistake that rustc reports in the user's own function or closure: the lifted code is
    /// left out, which would repeat it.
    pub(crate) fn leave_to_rustc(&mut self) {
        self.is_rustcs = true;
    }

    /// Takes over the errors of another collection.
    pub(crate) fn append(&mut self, other: Self) {
        self.is_rustcs |= other.is_rustcs;
        if let Some(e) = other.first {
            self.push(e);
        }
    }

    /// How many there are.
    pub(crate) fn count(&self) -> usize {
        self.count
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.first.is_none() && !self.is_rustcs
    }

    /// The errors as `compile_error!` calls, or nothing.
    pub(crate) fn into_tokens(self) -> TokenStream {
        self.first.map(|e| e.into_compile_error()).unwrap_or_default()
    }

    /// The errors as items and a type. The type has a mistake in it, so that rustc asks nothing
    /// more of what is made of it; a `compile_error!` in its place would be a `()`.
    pub(crate) fn into_type(self) -> (TokenStream, TokenStream) {
        let mut all = self.first.into_iter().flatten().map(syn::Error::into_compile_error);
        let first = all.next();
        (all.collect(), quote!([f32; #first]))
    }

    /// The errors as an expression: one of them stands for its value, of whatever type, so that
    /// rustc asks nothing more of it.
    pub(crate) fn into_expression(self) -> TokenStream {
        let mut all = self.first.into_iter().flatten().map(syn::Error::into_compile_error);
        let Some(first) = all.next() else { return quote!(::core::unreachable!()) };
        let value = Ident::new("value", Span::mixed_site());
        quote!({ let #value = #first; #(#all)* #value })
    }
}
