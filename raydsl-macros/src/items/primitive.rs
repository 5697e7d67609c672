//! `#[primitive] impl T`.

use proc_macro2::TokenStream;
use quote::quote;
use syn::spanned::Spanned;

use super::{kernel_impl, private};
use crate::diag::Errors;

pub(crate) fn primitive_impl(item: &syn::ItemImpl) -> TokenStream {
    let mut errors = Errors::default();
    let lifted = kernel_impl(item, &["get_bounds", "split_primitive"], &mut errors);
    let p = private();
    let self_ty = &item.self_ty;
    let has = |name: &str| {
        item.items.iter().any(|i| matches!(i, syn::ImplItem::Fn(f) if f.sig.ident == name))
    };
    for (name, signature) in [
        ("intersect", "fn intersect(&self, ray: Ray) -> Hit"),
        ("get_bounds", "fn get_bounds(&self) -> Aabb"),
    ] {
        if !has(name) {
            errors.at(
                self_ty.span(),
                format!("the primitive has no `{name}`"),
                &format!("add `{signature}` to this impl"),
            );
        }
    }
    let slack =
        item.items.iter().any(|i| matches!(i, syn::ImplItem::Const(c) if c.ident == "SLACK"));
    let slack = slack.then(|| quote!(const SLACK: f32 = <#self_ty>::SLACK;));
    if !errors.is_empty() {
        let errors = errors.into_tokens();
        return quote!(#item #errors);
    }
    quote! {
        #lifted
        impl #p::Primitive for #self_ty {
            #slack

            #[inline(always)]
            fn intersect(&self, ray: #p::Ray) -> #p::Hit {
                <#self_ty>::intersect(self, ray)
            }

            fn get_bounds(&self) -> #p::Aabb {
                <#self_ty>::get_bounds(self)
            }

            #[inline(always)]
            fn intersect_on<__M: #p::Machine>(
                m: &__M,
                prim: <Self as #p::Type>::On<__M>,
                ray: #p::RayOn<__M>,
            ) -> #p::HitOn<__M> {
                <#self_ty>::intersect_on(m, prim, ray)
            }
        }
    }
}
