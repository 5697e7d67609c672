//! The operators of a twin, the same as the host type's.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use crate::generics::Generics;
use crate::here::private;
use crate::ops::{self, Overloaded};

/// Forwards every operator to the method that `#[kernel] impl Add for Type` and the like expand to.
pub(super) fn operators(
    twin: &TokenStream,
    host: &TokenStream,
    generics: &Generics,
) -> TokenStream {
    let p = private();
    let Generics { declared, predicates, .. } = generics;
    let binary = ops::OVERLOADED.iter().map(|op| binary(op, twin, host, generics));
    let (negated, assigned) = (negated(twin, host, generics), assigned(twin, host, generics));
    quote! {
        #(#binary)*
        #negated
        #assigned

        impl<__M: #p::Machine, #declared> #p::RightOperand for #twin where #predicates {
            type Host = #host;
        }
    }
}

/// Returns `a + b` and its like.
fn binary(
    op: &Overloaded,
    twin: &TokenStream,
    host: &TokenStream,
    generics: &Generics,
) -> TokenStream {
    let p = private();
    let Generics { declared, predicates, .. } = generics;
    let (operator, method) = (format_ident!("{}", op.operator), format_ident!("{}", op.method));
    let symbol = op.symbol;
    let of = quote!(<#host as #p::HostMethod<{ #p::name(#symbol) }, __M, (__Right,), __Via>>);
    quote! {
        #[diagnostic::do_not_recommend]
        impl<__M: #p::Machine, __Right, __Via, #declared>
            #p::#operator<__M, __Right, __Via> for #twin
        where
            #host: #p::HostMethod<{ #p::name(#symbol) }, __M, (__Right,), __Via, This = Self>,
            #predicates
        {
            type Output = #of::Output;

            #[inline(always)]
            fn #method(m: &__M, a: Self, b: __Right) -> Self::Output {
                #of::call(a, m, (b,))
            }
        }
    }
}

/// Returns `-a`.
fn negated(twin: &TokenStream, host: &TokenStream, generics: &Generics) -> TokenStream {
    let p = private();
    let Generics { declared, predicates, .. } = generics;
    let of = quote!(<#host as #p::HostMethod<{ #p::name("-x") }, __M, ()>>);
    quote! {
        #[diagnostic::do_not_recommend]
        impl<__M: #p::Machine, #declared> #p::OpNeg<__M> for #twin
        where
            #host: #p::HostMethod<{ #p::name("-x") }, __M, (), This = Self, Output = Self>,
            #predicates
        {
            #[inline(always)]
            fn neg(m: &__M, a: Self) -> Self {
                #of::call(a, m, ())
            }
        }
    }
}

/// Returns `a += b` and its like.
fn assigned(twin: &TokenStream, host: &TokenStream, generics: &Generics) -> TokenStream {
    let p = private();
    let Generics { declared, predicates, .. } = generics;
    let of = quote!(<#host as #p::HostMethod<__NAME, __M, (__Right,), __Via>>);
    quote! {
        #[diagnostic::do_not_recommend]
        impl<const __NAME: u64, __M: #p::Machine, __Right, __Via, #declared>
            #p::Assigned<__NAME, __M, __Right, __Via> for #twin
        where
            #host: #p::HostMethod<__NAME, __M, (__Right,), __Via, This = Self, Output = ()>,
            #predicates
        {
            #[inline(always)]
            fn assigned(m: &__M, a: Self, b: __Right) -> Self {
                let variable = #p::Var::new(m, "self", a);
                #of::call_at(a, &variable, m, (b,));
                variable.get(m)
            }
        }
    }
}
