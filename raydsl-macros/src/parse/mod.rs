//! Parser from syn's syntax to the model. Only this module knows syn's expressions.

mod attributes;
mod call;
mod closure;
mod condition;
mod expression;
mod function;
mod iteration;
mod pattern;
mod place;
mod refused;
mod statement;
mod types;

pub(crate) use closure::{closure, is_function};
pub(crate) use function::function;
pub(crate) use pattern::unraw;
pub(crate) use types::{refused_type, type_name};

use proc_macro2::{Ident, Span};

use crate::diag::Errors;
use crate::model::{Kind, Signature};
use attributes::is_coherent;

struct Parser<'a> {
    errors: &'a mut Errors,
    /// The number of temporary names.
    temporaries: usize,
    /// The label that a `return` leaves, in code that is a part of another function.
    returns_to: Option<&'static str>,
    /// The type parameters of the kernel that are closures.
    functions: Vec<(Ident, Signature)>,
    /// Whether the whole kernel is `#[coherent]`.
    is_coherent: bool,
}

impl<'a> Parser<'a> {
    fn new(attrs: &[syn::Attribute], errors: &'a mut Errors) -> Self {
        let is_coherent = attrs.iter().any(is_coherent);
        Self { errors, temporaries: 0, returns_to: None, functions: Vec::new(), is_coherent }
    }

    /// Returns a name that the source cannot have.
    fn temporary(&mut self, hint: &str) -> Ident {
        self.temporaries += 1;
        Ident::new(&format!("__{hint}_{}", self.temporaries), Span::mixed_site())
    }

    fn error(&mut self, span: Span, what: impl core::fmt::Display, help: &str) -> Kind {
        self.errors.at(span, what, help);
        Kind::Error
    }
}
