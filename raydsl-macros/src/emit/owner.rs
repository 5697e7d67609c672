//! Origin of a value's methods, by its syntax.
//!
//! A kernel refuses `x.exp()` for a number, while a user's own type may have a method of that name.

use proc_macro2::{Ident, TokenStream, TokenTree};

use super::Emitter;
use crate::model::{Expr, Kind};
use crate::ops;

/// The origin of a value's type.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Owner {
    /// The library: a number, a vector or the like.
    Library,
    /// The user: a type written out, and none of the library's.
    User,
    Unknown,
}

impl Owner {
    pub(super) fn of_type(ty: &TokenStream) -> Self {
        let mut name = None;
        for token in ty.clone() {
            match token {
                TokenTree::Ident(i) => name = Some(i.to_string()),
                TokenTree::Punct(p) if p.as_char() == '<' => break,
                TokenTree::Punct(_) => {}
                // An array, a slice or a tuple.
                _ => return Self::Library,
            }
        }
        match name {
            Some(name) if ops::is_of_library(&name) => Self::Library,
            Some(name) if !ops::is_data(&name) => Self::User,
            _ => Self::Unknown,
        }
    }
}

impl Emitter<'_> {
    pub(super) fn owner(&self, e: &Expr) -> Owner {
        let if_library = |owner| if owner == Owner::Library { owner } else { Owner::Unknown };
        match &e.kind {
            Kind::Float(_)
            | Kind::Int { .. }
            | Kind::Bool(_)
            | Kind::Compare { .. }
            | Kind::Is { .. }
            | Kind::Logic { .. }
            | Kind::Cast { .. }
            | Kind::Tuple(_)
            | Kind::Array(_)
            | Kind::Repeat { .. } => Owner::Library,
            Kind::Struct { .. } => Owner::User,
            Kind::Name(name) => self.find(name).map_or(Owner::Unknown, |local| local.owner),
            Kind::Deref(a) | Kind::Neg(a) | Kind::Not(a) => self.owner(a),
            Kind::Binary { a, b, .. } => match (self.owner(a), self.owner(b)) {
                (Owner::Library, Owner::Library) => Owner::Library,
                _ => Owner::Unknown,
            },
            Kind::OfVariant { .. } | Kind::NewVariant { .. } => Owner::Unknown,
            Kind::Associated { ty, .. } => Owner::of_type(ty),
            Kind::Field { base, member } if is_component(member) => if_library(self.owner(base)),
            Kind::Method { receiver, name, .. }
                if ops::cheap_method(&name.to_string()).is_some() =>
            {
                if_library(self.owner(receiver))
            }
            _ => Owner::Unknown,
        }
    }

    /// Returns the type parameter that is the type of `e`, and that of its elements.
    pub(super) fn generic_of(&self, e: &Expr) -> (Option<Ident>, Option<Ident>) {
        match &e.kind {
            Kind::Name(name) => self
                .find(name)
                .map_or((None, None), |local| (local.generic.clone(), local.elements.clone())),
            Kind::Deref(a) => self.generic_of(a),
            Kind::Element { base, .. } | Kind::Index { base, .. } => {
                (self.generic_of(base).1, None)
            }
            Kind::Call { path, .. } => match self.function_called(path) {
                Some((_, Some(result))) => self.generics_in(&result),
                _ => (None, None),
            },
            _ => (None, None),
        }
    }

    /// Refuses a method that kernels do not have, if the receiver's type is not a user's.
    pub(super) fn refuse(&mut self, receiver: &Expr, name: &Ident) {
        let Some(denied) = ops::denied(&name.to_string()) else { return };
        let (what, mut help) = (denied.what, denied.help);
        match self.owner(receiver) {
            Owner::User => return,
            Owner::Library => {}
            Owner::Unknown if denied.seen_by_type => return,
            Owner::Unknown => {
                help +=
                    &format!("; a method of a type of your own is called by `Type::{name}(&x)`");
            }
        }
        self.errors.at(name.span(), what, &help);
    }
}

/// Returns whether it is a component of a vector: members of tuples and of `Ray` may be anything.
fn is_component(member: &TokenStream) -> bool {
    matches!(member.to_string().as_str(), "x" | "y" | "z" | "w")
}
