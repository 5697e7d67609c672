//! The twin of a struct or an enum: its values on a machine.

mod choice;
mod enumeration;
mod mistaken;
mod operators;
mod record;
mod shared;
mod structure;
mod sum;

use proc_macro2::TokenStream;
use quote::{ToTokens, quote, quote_spanned};
use syn::spanned::Spanned;

use crate::diag::Errors;
use crate::generics::{mentions, says_nothing_of_kernels};
use crate::parse;

pub(crate) use choice::primitive_enum;
pub(crate) use record::hit_record;
pub(crate) use shared::kinds;

/// Expands `#[derive(Type)]`.
pub(crate) fn derive(item: &syn::DeriveInput) -> TokenStream {
    let mut errors = Errors::default();
    if let syn::Data::Enum(e) = &item.data
        && e.variants.iter().any(|v| !v.fields.is_empty())
    {
        let sum = sum::Sum::new(item, e, &mut errors);
        if errors.is_empty() {
            return sum.twin();
        }
        return mistaken::mistaken(item, errors);
    }
    if let syn::Data::Enum(e) = &item.data {
        let variants = enumeration::variants(e, &mut errors);
        if errors.is_empty() {
            return enumeration::twin(item, &variants);
        }
        return mistaken::mistaken(item, errors);
    }
    let fields = named_fields(item, &mut errors);
    check_types(&fields, &mut errors);
    if !errors.is_empty() {
        return mistaken::mistaken(item, errors);
    }
    let mut item = item.clone();
    bound_parameters(&mut item.generics, &fields, &mut errors);
    let twin = structure::twin(&item, &fields);
    let errors = errors.into_tokens();
    quote!(#twin #errors)
}

/// Requires a type parameter that is a member's type to be a type of kernels. If it is not bounded
/// so, the twin has the bound all the same, so that there is one error.
fn bound_parameters(generics: &mut syn::Generics, fields: &[syn::Field], errors: &mut Errors) {
    let clause = generics.where_clause.to_token_stream();
    for param in generics.params.iter_mut() {
        let syn::GenericParam::Type(t) = param else { continue };
        let is_member = fields.iter().any(|f| mentions(&f.ty.to_token_stream(), &t.ident));
        if !is_member
            || mentions(&clause, &t.ident)
            || !t.bounds.iter().all(says_nothing_of_kernels)
        {
            continue;
        }
        errors.at(
            t.ident.span(),
            format!("`{}` may be a type that kernels do not have", t.ident),
            &format!("write `{0}: Type`, or `{0}: Light` with a `#[kernel]` trait", t.ident),
        );
        t.bounds.push(syn::parse_quote!(::raydsl::__private::Type));
    }
}

/// Expands `#[primitive] struct`.
pub(crate) fn primitive_item(item: &syn::DeriveInput) -> TokenStream {
    let mut errors = Errors::default();
    let fields = named_fields(item, &mut errors);
    check_types(&fields, &mut errors);
    if let Some(g) = item.generics.params.first() {
        errors.at(g.span(), "a primitive cannot be generic", "write a struct for each type");
    }
    let copies = copies(item);
    if !errors.is_empty() {
        let derives = mistaken::can_have_twin(item).then_some(&copies);
        let mistaken = mistaken::mistaken(item, errors);
        return quote!(#derives #item #mistaken);
    }
    let repr = (!item.attrs.iter().any(|a| a.path().is_ident("repr"))).then(|| quote!(#[repr(C)]));
    let (twin, dense) = (structure::twin(item, &fields), dense(&item.ident, &fields));
    quote! {
        #copies
        #repr
        #item
        #twin
        #dense
    }
}

/// Returns an assertion that a primitive has no gaps between its members.
fn dense(name: &syn::Ident, fields: &[syn::Field]) -> TokenStream {
    let types = fields.iter().map(|f| &f.ty);
    quote_spanned! {name.span()=>
        const _: () = ::core::assert!(
            ::core::mem::size_of::<#name>() == #(::core::mem::size_of::<#types>())+*,
            ::core::concat!(
                "the primitive `", ::core::stringify!(#name), "` has gaps between its members\n",
                "  help: order them by size, or fill the gaps with members of your own",
            ),
        );
    }
}

/// Returns the derives by which a primitive is copied, if the user has not written them.
fn copies(item: &syn::DeriveInput) -> TokenStream {
    let clone = (!derives(item, "Clone")).then(|| quote!(#[derive(Clone)]));
    let copy = (!derives(item, "Copy")).then(|| quote!(#[derive(Copy)]));
    quote!(#clone #copy)
}

/// Returns whether the user derives a trait.
fn derives(item: &syn::DeriveInput, what: &str) -> bool {
    let found = |a: &syn::Attribute| {
        let check = |m: syn::meta::ParseNestedMeta<'_>| {
            if m.path.is_ident(what) { Err(m.error("found")) } else { Ok(()) }
        };
        a.path().is_ident("derive") && a.parse_nested_meta(check).is_err()
    };
    item.attrs.iter().any(found)
}

/// Refuses members of types that no kernel has.
fn check_types(fields: &[syn::Field], errors: &mut Errors) {
    for (span, what, help) in fields.iter().filter_map(|f| parse::refused_type(&f.ty)) {
        errors.at(span, format!("a type of the kernel language has no {what}"), help);
    }
}

fn named_fields(item: &syn::DeriveInput, errors: &mut Errors) -> Vec<syn::Field> {
    match &item.data {
        syn::Data::Struct(s) => match &s.fields {
            syn::Fields::Named(f) if !f.named.is_empty() => f.named.iter().cloned().collect(),
            _ => {
                errors.at(
                    item.ident.span(),
                    "a type of the kernel language has at least one named member",
                    "write `struct Name { member: f32 }`",
                );
                vec![]
            }
        },
        _ => {
            errors.at(
                item.ident.span(),
                "only a struct or an enum can be a type of the kernel language",
                "write a struct with named members",
            );
            vec![]
        }
    }
}
