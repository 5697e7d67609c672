//! Diagnostics: errors are collected, so that a user sees all mistakes of a kernel at once.

use proc_macro2::{Ident, Span, TokenStream};
use quote::quote;

/// Returns an item unchanged, with an error that spans all of `place`.
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
///
/// A user must see every one of them: a collection that is dropped with errors in it panics. It is
/// consumed by [`into_tokens`](Self::into_tokens) and the like, or appended to another.
#[derive(Default)]
#[must_use = "errors that are dropped are seen by nobody"]
pub(crate) struct Errors {
    first: Option<syn::Error>,
    count: usize,
    /// Whether the source has a mistake that rustc reports.
    is_rustcs: bool,
}

impl Errors {
    /// Adds an error: `what` is wrong at `span`; `help` is the remedy.
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

    /// Records a mistake that rustc reports in the user's own function or closure: the lifted code,
    /// which would repeat it, is omitted.
    pub(crate) fn leave_to_rustc(&mut self) {
        self.is_rustcs = true;
    }

    /// Appends the errors of another collection.
    pub(crate) fn append(&mut self, mut other: Self) {
        self.is_rustcs |= other.is_rustcs;
        if let Some(e) = other.first.take() {
            self.push(e);
            // The first error contains all of them.
            self.count += other.count - 1;
        }
    }

    /// Appends the errors of a collection with the same mistakes found again: if there are errors
    /// here already, only these are kept.
    pub(crate) fn append_repeated(&mut self, mut other: Self) {
        if self.first.is_none() {
            self.append(other);
        } else {
            other.first = None;
        }
    }

    /// Returns the number of errors.
    pub(crate) fn count(&self) -> usize {
        self.count
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.first.is_none() && !self.is_rustcs
    }

    /// Returns the errors as `compile_error!` calls, or nothing.
    #[must_use = "tokens that are dropped are seen by nobody"]
    pub(crate) fn into_tokens(mut self) -> TokenStream {
        self.first.take().map(|e| e.into_compile_error()).unwrap_or_default()
    }

    /// Returns the errors as items and a type. The type has a mistake in it, so that rustc reports
    /// nothing more about its uses; a `compile_error!` in its place would be a `()`.
    #[must_use = "tokens that are dropped are seen by nobody"]
    pub(crate) fn into_type(mut self) -> (TokenStream, TokenStream) {
        let mut all = self.first.take().into_iter().flatten().map(syn::Error::into_compile_error);
        let first = all.next();
        (all.collect(), quote!([f32; #first]))
    }

    /// Returns the errors as an expression: one of them is its value, of any type, so that rustc
    /// reports nothing more about it.
    #[must_use = "tokens that are dropped are seen by nobody"]
    pub(crate) fn into_expression(mut self) -> TokenStream {
        let mut all = self.first.take().into_iter().flatten().map(syn::Error::into_compile_error);
        let Some(first) = all.next() else { return quote!(::core::unreachable!()) };
        let value = Ident::new("value", Span::mixed_site());
        quote!({ let #value = #first; #(#all)* #value })
    }
}

impl Drop for Errors {
    fn drop(&mut self) {
        let Some(unread) = &self.first else { return };
        // A second panic would abort the compiler, without the message of the first.
        if !std::thread::panicking() {
            panic!("a bug in raydsl-macros: an error was dropped: {unread}");
        }
    }
}

#[cfg(test)]
mod tests {
    use std::panic::{AssertUnwindSafe, catch_unwind};

    use super::*;

    fn one() -> Errors {
        let mut errors = Errors::default();
        errors.at(Span::call_site(), "no such thing", "write another");
        errors
    }

    /// Returns the message of a panic in `f`, if there is one.
    fn panic_of(f: impl FnOnce()) -> Option<String> {
        let payload = catch_unwind(AssertUnwindSafe(f)).err()?;
        let literal = payload.downcast_ref::<&str>().map(|text| (*text).to_owned());
        literal.or_else(|| payload.downcast_ref::<String>().cloned())
    }

    #[test]
    fn unread_errors_panic() {
        let message = panic_of(|| drop(one())).expect("a panic");
        assert!(message.contains("was dropped: no such thing"), "{message}");
        let mut kept = Errors::default();
        let message = panic_of(|| {
            let mut lost = Errors::default();
            lost.append(one());
            kept.append_repeated(one());
        });
        assert!(message.is_some_and(|m| m.contains("no such thing")));
        assert!(kept.into_tokens().to_string().contains("no such thing"));
    }

    #[test]
    fn read_errors_do_not_panic() {
        let mut rustcs = Errors::default();
        rustcs.leave_to_rustc();
        drop((Errors::default(), rustcs));
        let all = [one().into_tokens(), one().into_type().1, one().into_expression()];
        assert!(all.iter().all(|tokens| tokens.to_string().contains("no such thing")));
        let mut errors = one();
        errors.append_repeated(one());
        assert_eq!(errors.into_tokens().to_string().matches("no such thing").count(), 1);
        let mut errors = one();
        errors.append(one());
        assert_eq!(errors.into_tokens().to_string().matches("no such thing").count(), 2);
    }

    /// Tests that a drop during unwinding does not abort: the first panic is what a user sees.
    #[test]
    fn a_panic_is_not_hidden_by_unread_errors() {
        let message = panic_of(|| {
            let _errors = one();
            panic!("another bug");
        });
        assert_eq!(message.as_deref(), Some("another bug"));
    }
}
