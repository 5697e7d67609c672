//! Parsing of types, and refusal of those that kernels do not have.

use proc_macro2::{Ident, Span, TokenStream};
use quote::{ToTokens, quote};
use syn::spanned::Spanned;

use super::Parser;
use crate::ops;

/// Returns the last name of a type that is a path.
pub(crate) fn type_name(ty: &syn::Type) -> Option<String> {
    match ty {
        syn::Type::Path(t) => t.path.segments.last().map(|s| s.ident.to_string()),
        _ => None,
    }
}

/// Returns a type that no kernel can have: its span, its description, and its replacement.
pub(crate) fn refused_type(ty: &syn::Type) -> Option<(Span, String, &'static str)> {
    match ty {
        syn::Type::Reference(r) => refused_type(&r.elem),
        syn::Type::Paren(p) => refused_type(&p.elem),
        syn::Type::Slice(s) => refused_type(&s.elem),
        syn::Type::Array(a) => refused_type(&a.elem),
        syn::Type::Tuple(t) => t.elems.iter().find_map(refused_type),
        syn::Type::TraitObject(t) => Some((
            t.span(),
            "trait objects".to_owned(),
            "give the trait `#[kernel]` and write `fn f<T: Light>(light: T)`",
        )),
        syn::Type::Ptr(t) => Some((t.span(), "pointers".to_owned(), "take the value or a slice")),
        syn::Type::Path(t) => {
            let name = &t.path.segments.last()?.ident;
            let help = ops::refused_type(&name.to_string())?;
            Some((name.span(), format!("`{name}`"), help))
        }
        _ => None,
    }
}

/// Returns the type without references: values on a machine are copied.
fn value_type(ty: &syn::Type) -> TokenStream {
    match ty {
        syn::Type::Reference(r) => value_type(&r.elem),
        syn::Type::Paren(p) => value_type(&p.elem),
        _ => ty.to_token_stream(),
    }
}

pub(super) fn without_references(mut ty: &syn::Type) -> &syn::Type {
    while let syn::Type::Reference(r) = ty {
        ty = &r.elem;
    }
    ty
}

/// Returns whether it is `&mut T`.
pub(super) fn is_mut_reference(ty: &syn::Type) -> bool {
    matches!(ty, syn::Type::Reference(r) if r.mutability.is_some())
}

pub(super) fn is_unit(ty: &syn::Type) -> bool {
    matches!(ty, syn::Type::Tuple(t) if t.elems.is_empty())
}

/// Returns whether it is a slice, a tree or a texture, which are not copied: a type with a lifetime,
/// or one of the library's, whose lifetime may be left out.
pub(super) fn is_data(ty: &syn::Type) -> bool {
    match ty {
        syn::Type::Reference(r) => is_data(&r.elem),
        syn::Type::Slice(_) => true,
        syn::Type::Path(path) => {
            has_lifetime(path) || type_name(ty).is_some_and(|name| ops::is_data(&name))
        }
        _ => false,
    }
}

/// Returns whether a type borrows: no value of a kernel does.
fn has_lifetime(path: &syn::TypePath) -> bool {
    let arguments = path.path.segments.last().map(|last| &last.arguments);
    let Some(syn::PathArguments::AngleBracketed(arguments)) = arguments else { return false };
    arguments.args.iter().any(|arg| matches!(arg, syn::GenericArgument::Lifetime(_)))
}

/// Returns whether a path segment names a type rather than a module.
pub(super) fn is_type_name(ident: &Ident) -> bool {
    let name = ident.to_string();
    name.starts_with(|c: char| c.is_ascii_uppercase())
        || matches!(name.as_str(), "f32" | "i32" | "u32" | "usize" | "bool")
}

/// Returns a generic argument as a type; numbers have a type of their own.
pub(super) fn generic_argument(arg: &syn::GenericArgument) -> TokenStream {
    let constant = |n: &dyn ToTokens| quote!(::raydsl::__private::Const<{ #n }>);
    match arg {
        syn::GenericArgument::Const(n) => constant(n),
        // The name of a constant parameter looks like a type.
        syn::GenericArgument::Type(syn::Type::Path(t))
            if t.path.get_ident().is_some_and(|i| *i == i.to_string().to_uppercase()) =>
        {
            constant(t)
        }
        arg => arg.to_token_stream(),
    }
}

impl Parser<'_> {
    /// Returns the type without references; refuses known types that kernels do not have.
    pub(super) fn ty(&mut self, ty: &syn::Type) -> TokenStream {
        if let Some((span, what, help)) = refused_type(ty) {
            self.errors.at(span, format!("a kernel has no {what}"), help);
        }
        value_type(ty)
    }
}
