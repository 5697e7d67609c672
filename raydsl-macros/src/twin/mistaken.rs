//! The twin of a type with mistakes, so that its uses give no second error.

use proc_macro2::TokenStream;
use quote::quote;

use super::shared::kernel_type;
use crate::diag::Errors;
use crate::generics::Generics;
use crate::here::private;
use crate::parse;

/// Returns the errors, with implementations whose twin is a type about which rustc reports nothing.
pub(super) fn mistaken(item: &syn::DeriveInput, errors: Errors) -> TokenStream {
    if !can_have_twin(item) {
        return errors.into_tokens();
    }
    let (p, name) = (private(), &item.ident);
    let (others, mistaken) = errors.into_type();
    let kernel_type = kernel_type(&quote!(#name), &Generics::default());
    quote! {
        const _: () = {
            type Mistaken = #mistaken;

            #kernel_type

            impl #p::Type for #name {
                type On<__M: #p::Machine> = Mistaken;

                const SCHEMA: &'static #p::Schema = <u32 as #p::Type>::SCHEMA;

                fn splat<__M: #p::Machine>(_: &__M, _: Self) -> Mistaken {
                    ::core::unreachable!()
                }

                fn from_lanes<__M: #p::LaneMachine>(
                    _: &__M,
                    _: impl Fn(usize) -> Self + Copy
                ) -> Mistaken {
                    ::core::unreachable!()
                }

                fn lane<__M: #p::LaneMachine>(_: &Mistaken, _: usize) -> Self {
                    ::core::unreachable!()
                }

                fn write(&self, _: &mut [u8]) {}

                fn read(_: &[u8]) -> Self {
                    ::core::unreachable!()
                }
            }

            impl<__M: #p::Machine> #p::Capture<__M> for #name {
                type On<'c> = Mistaken;

                fn capture(&self, _: &__M, _: &'static str) -> Mistaken {
                    ::core::unreachable!()
                }

                fn constant(&self, _: &__M) -> Mistaken {
                    ::core::unreachable!()
                }
            }
        };
        #others
    }
}

/// Returns whether it may be `Copy`, and has no lifetimes.
pub(super) fn can_have_twin(item: &syn::DeriveInput) -> bool {
    item.generics.params.is_empty() && item_is_copied(item)
}

/// Returns whether the members may be `Copy`, judging by the names of their types.
fn item_is_copied(item: &syn::DeriveInput) -> bool {
    let copied = |fields: &syn::Fields| fields.iter().all(|f| is_copied(&f.ty));
    match &item.data {
        syn::Data::Struct(s) => copied(&s.fields),
        syn::Data::Enum(e) => e.variants.iter().all(|v| copied(&v.fields)),
        syn::Data::Union(_) => false,
    }
}

fn is_copied(ty: &syn::Type) -> bool {
    let is_number = |name: &String| name != "isize" && name.starts_with(['f', 'u', 'i']);
    match parse::refused_type(ty) {
        Some(_) => parse::type_name(ty).is_some_and(|name| is_number(&name)),
        None => !matches!(ty, syn::Type::Reference(_)),
    }
}
