//! Expansion of `#[derive(HitRecord)]`.

use proc_macro2::TokenStream;
use quote::quote;

use super::named_fields;
use crate::diag::Errors;
use crate::generics::Generics;
use crate::here::private;

/// Expands a struct with one member of the type `Hit`.
pub(crate) fn hit_record(item: &syn::DeriveInput) -> TokenStream {
    let mut errors = Errors::default();
    let fields = named_fields(item, &mut errors);
    let member = the_hit(item, &fields, &mut errors);
    let Some(member) = member else { return errors.into_tokens() };
    let (p, name, text) = (private(), &item.ident, member.to_string());
    let Generics { declared, used, predicates, .. } = &Generics::new(&item.generics);
    quote! {
        impl<#declared> #p::HitRecord for #name<#used> where #predicates {
            const PATH: &'static [&'static str] = &[#text];

            #[inline(always)]
            fn hit(&self) -> #p::Hit {
                self.#member
            }

            #[inline(always)]
            fn with_hit(self, hit: #p::Hit) -> Self {
                Self { #member: hit, ..self }
            }

            #[inline(always)]
            fn hit_on<__M: #p::Machine>(record: Self::On<__M>) -> #p::HitOn<__M> {
                record.#member
            }

            #[inline(always)]
            fn with_hit_on<__M: #p::Machine>(
                mut record: Self::On<__M>,
                hit: #p::HitOn<__M>,
            ) -> Self::On<__M> {
                record.#member = hit;
                record
            }
        }
    }
}

fn the_hit<'a>(
    item: &syn::DeriveInput,
    fields: &'a [syn::Field],
    errors: &mut Errors,
) -> Option<&'a syn::Ident> {
    let is_hit = |f: &&syn::Field| match &f.ty {
        syn::Type::Path(t) => t.path.segments.last().is_some_and(|s| s.ident == "Hit"),
        _ => false,
    };
    let mut hits = fields.iter().filter(is_hit);
    let first = hits.next();
    if first.is_none() && errors.is_empty() {
        errors.at(
            item.ident.span(),
            "a hit record has a member of the type `Hit`",
            "add `hit: Hit`, where traversal finds the distance",
        );
    }
    if let Some(second) = hits.next().and_then(|f| f.ident.as_ref()) {
        errors.at(
            second.span(),
            "a hit record has one member of the type `Hit`",
            "leave this one out: traversal would not know which to compare",
        );
    }
    first.filter(|_| errors.is_empty())?.ident.as_ref()
}
