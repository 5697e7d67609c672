//! The twin of an enum without fields: the number of its variant.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};
use syn::spanned::Spanned;

use super::{methods, private};
use crate::diag::Errors;
use crate::generics::Generics;

/// The names of the variants.
pub(super) fn variants(e: &syn::DataEnum, errors: &mut Errors) -> Vec<Ident> {
    for v in e.variants.iter().filter(|v| !matches!(v.fields, syn::Fields::Unit)) {
        errors.at(
            v.span(),
            "an enum of the kernel language has no fields",
            "write a struct with a member that says which kind it is",
        );
    }
    if e.variants.len() < 2 {
        errors.at(
            e.brace_token.span.join(),
            "an enum of the kernel language has two variants or more",
            "leave it out: it says nothing",
        );
    }
    e.variants.iter().map(|v| v.ident.clone()).collect()
}

pub(super) fn twin(item: &syn::DeriveInput, variants: &[Ident]) -> TokenStream {
    let p = private();
    let (vis, name) = (&item.vis, &item.ident);
    let twin = format_ident!("{name}On");
    let doc = format!("[`{name}`] on a machine: the number of its variant.");
    let methods = methods(&quote!(#twin<__M>), &quote!(#name), &Generics::default());
    let (first, others) = variants.split_first().expect("there is a variant");
    let casts = [quote!(u32), quote!(i32), quote!(usize)].map(|to| {
        quote! {
            impl<__M: #p::Machine> #p::OpCast<__M, #to> for #twin<__M> {
                #[inline(always)]
                fn cast(m: &__M, a: Self) -> <#to as #p::Type>::On<__M> {
                    #p::cast::<_, _, #to>(m, a.number)
                }
            }
        }
    });
    quote! {
        const _: () = {
            #(assert!(
                #name::#variants as i128 >= 0 && #name::#variants as i128 <= u32::MAX as i128,
                concat!(
                    "the variant `", stringify!(#variants), "` of `", stringify!(#name),
                    "` has a number that a kernel's `u32` does not have",
                ),
            );)*
        };

        #[doc = #doc]
        #vis struct #twin<__M: #p::Machine> {
            number: <u32 as #p::Type>::On<__M>,
        }

        impl<__M: #p::Machine> Clone for #twin<__M> {
            #[inline(always)]
            fn clone(&self) -> Self {
                *self
            }
        }

        impl<__M: #p::Machine> Copy for #twin<__M> {}

        impl #name {
            /// The variant of a number; the first one for numbers that no variant has.
            fn __of_number(number: u32) -> Self {
                #(if number == Self::#others as u32 { return Self::#others; })*
                Self::#first
            }
        }

        impl<__M: #p::Machine> #p::Value<__M> for #twin<__M> {
            const SCHEMA: &'static #p::Schema = <#name as #p::Type>::SCHEMA;

            #[inline(always)]
            fn zero(m: &__M) -> Self {
                #p::Type::splat(m, #name::#first)
            }

            #[inline(always)]
            fn zip(m: &__M, a: Self, b: Self, f: &mut impl #p::Leaves<__M>) -> Self {
                Self { number: #p::Value::zip(m, a.number, b.number, f) }
            }
        }

        #methods

        impl<__M: #p::Machine> #p::OpCompare<__M, Self> for #twin<__M> {
            type Output = <bool as #p::Type>::On<__M>;

            #[inline(always)]
            fn compare<__O: #p::Op<#p::Compare>>(m: &__M, op: __O, a: Self, b: Self) -> Self::Output {
                #p::OpCompare::compare(m, op, a.number, b.number)
            }
        }

        #(#casts)*

        impl #p::Type for #name {
            type On<__M: #p::Machine> = #twin<__M>;

            const SCHEMA: &'static #p::Schema = #p::number_schema(::core::mem::size_of::<Self>());

            #[inline(always)]
            fn splat<__M: #p::Machine>(m: &__M, v: Self) -> #twin<__M> {
                #twin { number: <u32 as #p::Type>::splat(m, v as u32) }
            }

            #[inline(always)]
            fn from_lanes<__M: #p::LaneMachine>(m: &__M, f: impl Fn(usize) -> Self + Copy) -> #twin<__M> {
                #twin { number: <u32 as #p::Type>::from_lanes(m, #[inline(always)] |lane| f(lane) as u32) }
            }

            #[inline(always)]
            fn lane<__M: #p::LaneMachine>(v: &#twin<__M>, lane: usize) -> Self {
                Self::__of_number(<u32 as #p::Type>::lane(&v.number, lane))
            }

            fn write(&self, out: &mut [u8]) {
                #p::write_number(*self as u32, ::core::mem::size_of::<Self>(), out);
            }

            fn read(bytes: &[u8]) -> Self {
                Self::__of_number(#p::read_number(::core::mem::size_of::<Self>(), bytes))
            }
        }

        /// A captured variant is known while the kernel is recorded: a `match` on it is decided.
        impl<__M: #p::Machine> #p::Capture<__M> for #name {
            type On<'c> = #twin<__M>;

            #[inline(always)]
            fn capture(&self, m: &__M, _: &'static str) -> #twin<__M> {
                #p::Type::splat(m, *self)
            }

            #[inline(always)]
            fn constant(&self, m: &__M) -> #twin<__M> {
                #p::Type::splat(m, *self)
            }
        }
    }
}
