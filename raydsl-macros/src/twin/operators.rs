//! The operators of a twin, which are those of the host's type.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::private;
use crate::generics::Generics;
use crate::ops;

/// Forwards every operator to what `#[kernel] impl Add for Type` and the like make of it.
pub(super) fn operators(
    twin: &TokenStream,
    host: &TokenStream,
    generics: &Generics,
) -> TokenStream {
    let p = private();
    let Generics { declared, predicates, .. } = generics;
    let binary = ops::OVERLOADED.iter().map(|op| {
        let (operator, method) = (format_ident!("{}", op.operator), format_ident!("{}", op.method));
        let symbol = op.symbol;
        let of = quote!(<#host as #p::HostMethod<{ #p::name(#symbol) }, M, (R,), Via>>);
        quote! {
            #[diagnostic::do_not_recommend]
            impl<M: #p::Machine, R, Via, #declared> #p::#operator<M, R, Via> for #twin
            where
                #host: #p::HostMethod<{ #p::name(#symbol) }, M, (R,), Via, This = Self>,
                #predicates
            {
                type Output = #of::Output;

                #[inline(always)]
                fn #method(m: &M, a: Self, b: R) -> Self::Output {
                    #of::call(a, m, (b,))
                }
            }
        }
    });
    let negated = quote!(<#host as #p::HostMethod<{ #p::name("-x") }, M, ()>>);
    let assigned = quote!(<#host as #p::HostMethod<NAME, M, (R,), Via>>);
    quote! {
        #(#binary)*

        #[diagnostic::do_not_recommend]
        impl<M: #p::Machine, #declared> #p::OpNeg<M> for #twin
        where
            #host: #p::HostMethod<{ #p::name("-x") }, M, (), This = Self, Output = Self>,
            #predicates
        {
            #[inline(always)]
            fn neg(m: &M, a: Self) -> Self {
                #negated::call(a, m, ())
            }
        }

        #[diagnostic::do_not_recommend]
        impl<const NAME: u64, M: #p::Machine, R, Via, #declared> #p::Assigned<NAME, M, R, Via>
            for #twin
        where
            #host: #p::HostMethod<NAME, M, (R,), Via, This = Self, Output = ()>,
            #predicates
        {
            #[inline(always)]
            fn assigned(m: &M, a: Self, b: R) -> Self {
                let variable = #p::Var::new(m, "self", a);
                #assigned::call_at(a, &variable, m, (b,));
                variable.get(m)
            }
        }

        impl<M: #p::Machine, #declared> #p::RightOperand for #twin where #predicates {
            type Host = #host;
        }
    }
}
