//! Errors, collected: a user sees all mistakes of a kernel at once.

use proc_macro2::{Span, TokenStream};

/// Collects the errors of one macro call.
#[derive(Default)]
pub(crate) struct Errors {
    first: Option<syn::Error>,
    count: usize,
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

    /// Takes over the errors of another collection.
    pub(crate) fn append(&mut self, other: Self) {
        if let Some(e) = other.first {
            self.push(e);
        }
    }

    /// How many there are.
    pub(crate) fn count(&self) -> usize {
        self.count
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.first.is_none()
    }

    /// The errors as `compile_error!` calls, or nothing.
    pub(crate) fn into_tokens(self) -> TokenStream {
        self.first.map(|e| e.into_compile_error()).unwrap_or_default()
    }
}
