//! Code common to the twins of structs and enums.

use proc_macro2::{Ident, Span, TokenStream};
use quote::quote;

use super::operators;
use crate::generics::Generics;
use crate::here::private;

/// Returns the name of the method of twins of enums that returns the value itself.
///
/// Patterns call the methods of variants on what it returns, and it has the span of the macro's call: of an
/// enum that is no type of kernels, rustc says once in a kernel that there is no such method, instead of
/// each time that a pattern tests a variant or binds a field.
pub(crate) fn kinds() -> Ident {
    Ident::new("__kinds_by_derive_Type", Span::call_site())
}

/// Returns the implementation that says of a type that it is one of kernels, whatever bounds say.
pub(super) fn kernel_type(host: &TokenStream, generics: &Generics) -> TokenStream {
    let p = private();
    let Generics { declared, predicates, .. } = generics;
    quote! {
        #[diagnostic::do_not_recommend]
        impl<#declared> #p::KernelType for #host where #predicates {
            type Twin<__M: #p::Machine> = <Self as #p::Type>::On<__M>;

            #[inline(always)]
            fn same<__M: #p::Machine>(v: Self::Twin<__M>) -> Self::Twin<__M> {
                v
            }
        }
    }
}

/// Returns the implementations of a twin in variables, and of its methods, the same as the host
/// type's.
pub(super) fn methods(twin: &TokenStream, host: &TokenStream, generics: &Generics) -> TokenStream {
    let p = private();
    let Generics { declared, predicates, .. } = generics;
    let of = quote!(<#host as #p::HostMethod<__NAME, __M, __Args, __Via>>);
    let operators = operators::operators(twin, host, generics);
    quote! {
        #operators

        #[diagnostic::do_not_recommend]
        impl<__M: #p::Machine, #declared> #p::Inferred<__M> for #twin where #predicates {
            type Host = #host;

            #[inline(always)]
            fn give(self, _: &__M) -> Self {
                self
            }
        }

        impl<__M: #p::Machine, #declared> #p::Twin<__M> for #twin where #predicates {
            #[inline(always)]
            fn from_host(v: Self) -> Self {
                v
            }
        }

        #[diagnostic::do_not_recommend]
        impl<__M: #p::Machine, #declared> #p::Varying<__M> for #twin where #predicates {
            type Value = Self;

            #[inline(always)]
            fn varying(self, _: &__M) -> Self {
                self
            }
        }

        impl<const __NAME: u64, __M: #p::Machine, __Args, __Via, #declared>
            #p::Method<__NAME, __M, __Args, __Via> for #twin
        where
            #host: #p::HostMethod<__NAME, __M, __Args, __Via, This = Self>,
            #predicates
        {
            type Output = #of::Output;

            const IS_MUT: bool = #of::IS_MUT;

            #[inline(always)]
            fn call(self, m: &__M, args: __Args) -> Self::Output {
                #of::call(self, m, args)
            }

            #[inline(always)]
            fn call_at(self, variable: &#p::Var<Self>, m: &__M, args: __Args) -> Self::Output {
                #of::call_at(self, variable, m, args)
            }
        }
    }
}

/// Returns the implementations of the capture of a host value, and of its use as a constant.
pub(super) fn capture(twin: &TokenStream, host: &TokenStream, generics: &Generics) -> TokenStream {
    let p = private();
    let Generics { declared, predicates, .. } = generics;
    quote! {
        #[diagnostic::do_not_recommend]
        impl<__M: #p::Machine, #declared> #p::Capture<__M> for #host where #predicates {
            type On<'c> = #twin;

            #[inline(always)]
            fn capture(&self, m: &__M, name: &'static str) -> #twin {
                #p::Machine::capture(m, name, *self)
            }

            #[inline(always)]
            fn constant(&self, m: &__M) -> #twin {
                #p::Type::splat(m, *self)
            }

            fn resources(
                &self,
                name: &'static str,
                visit: &mut dyn ::core::ops::FnMut(&dyn #p::Resource),
            ) {
                #p::visit_value(*self, name, visit);
            }
        }
    }
}
