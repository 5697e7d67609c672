//! Expansion of `#[primitive] impl T`.

use proc_macro2::{Ident, Span, TokenStream};
use quote::quote;
use syn::spanned::Spanned;

use super::{kernel_impl, private};
use crate::diag::Errors;
use crate::ops;
use crate::parse::type_name;

/// The functions that only run on the host, when a tree is built.
const ON_HOST: [&str; 2] = ["get_bounds", "split_primitive"];

const INTERSECT: &str = "fn intersect(&self, ray: Ray) -> Hit";
const GET_BOUNDS: &str = "fn get_bounds(&self) -> Aabb";
const SPLIT_PRIMITIVE: &str = "fn split_primitive(&self, axis: usize, at: f32) -> (Aabb, Aabb)";

pub(crate) fn primitive_impl(item: &syn::ItemImpl) -> TokenStream {
    let mut errors = Errors::default();
    let parts = Parts::of(item, &mut errors);
    let lifted = kernel_impl(item, &ON_HOST, &mut errors);
    if !errors.is_empty() {
        let (stub, errors) = (mistaken(item, &parts), errors.into_tokens());
        return quote!(#lifted #stub #errors);
    }
    let p = private();
    let self_ty = &item.self_ty;
    let constants = parts.constants.iter().map(|(name, ty)| {
        let (name, ty) = (Ident::new(name, Span::call_site()), Ident::new(ty, Span::call_site()));
        quote!(const #name: #ty = <#self_ty>::#name;)
    });
    let (record, shared, among) = (parts.record(), parts.shared(), parts.shared_among());
    // A function only gets the shared slice if it takes it.
    let given =
        |f: Option<&Function<'_>>| f.is_some_and(|f| f.shared.is_some()).then(|| quote!(, shared));
    let (met, bounded) = (given(parts.intersect.as_ref()), given(parts.get_bounds.as_ref()));
    let split = parts.split.as_ref().map(|f| {
        let cut = given(Some(f));
        quote! {
            fn split_primitive(
                &self,
                axis: usize,
                at: f32,
                shared: <#shared as #p::Shared>::Slices<'_>,
            ) -> (#p::Aabb, #p::Aabb) {
                <#self_ty>::split_primitive(self, axis, at #cut)
            }
        }
    });
    quote! {
        #lifted
        impl #p::Primitive for #self_ty {
            type Hit = #record;
            type Shared = #shared;
            #among
            #(#constants)*

            #[inline(always)]
            fn intersect(&self, ray: #p::Ray, shared: <#shared as #p::Shared>::Slices<'_>) -> #record {
                <#self_ty>::intersect(self, ray #met)
            }

            fn get_bounds(&self, shared: <#shared as #p::Shared>::Slices<'_>) -> #p::Aabb {
                <#self_ty>::get_bounds(self #bounded)
            }

            #split

            #[inline(always)]
            fn intersect_on<__M: #p::Machine>(
                m: &__M,
                prim: <Self as #p::Type>::On<__M>,
                ray: #p::RayOn<__M>,
                shared: <#shared as #p::Shared>::Views<'_>,
            ) -> <#record as #p::Type>::On<__M> {
                <#self_ty>::intersect_on(m, prim, ray #met)
            }
        }
    }
}

/// Expands a primitive with mistakes: it is a primitive all the same, so that its trees give no
/// second error.
fn mistaken(item: &syn::ItemImpl, parts: &Parts<'_>) -> TokenStream {
    let is_named = type_name(&item.self_ty).is_some();
    if item.trait_.is_some() || !item.generics.params.is_empty() || !is_named {
        return TokenStream::new();
    }
    let (p, self_ty) = (private(), &item.self_ty);
    let is_record = |ty: &&syn::Type| type_name(ty).is_some_and(|name| !ops::is_of_library(&name));
    let record = parts.intersect.as_ref().and_then(|f| f.result).filter(is_record);
    let record = record.map_or_else(|| quote!(#p::Hit), |ty| quote!(#ty));
    let (shared, among) = (parts.shared(), parts.shared_among());
    quote! {
        impl #p::Primitive for #self_ty {
            type Hit = #record;
            type Shared = #shared;
            #among

            fn intersect(&self, _: #p::Ray, _: <#shared as #p::Shared>::Slices<'_>) -> #record {
                ::core::unreachable!()
            }

            fn get_bounds(&self, _: <#shared as #p::Shared>::Slices<'_>) -> #p::Aabb {
                ::core::unreachable!()
            }

            fn intersect_on<__M: #p::Machine>(
                _: &__M,
                _: <Self as #p::Type>::On<__M>,
                _: #p::RayOn<__M>,
                _: <#shared as #p::Shared>::Views<'_>,
            ) -> <#record as #p::Type>::On<__M> {
                ::core::unreachable!()
            }
        }
    }
}

/// The constants that an `impl` may have, and their types.
const CONSTANTS: [(&str, &str); 3] =
    [("SLACK", "f32"), ("MAX_CROSSINGS", "u32"), ("IS_SHORT", "bool")];

/// The parts of a primitive in an `impl`.
struct Parts<'a> {
    intersect: Option<Function<'a>>,
    get_bounds: Option<Function<'a>>,
    split: Option<Function<'a>>,
    /// The names and types of the constants that it has.
    constants: Vec<(&'static str, &'static str)>,
}

/// One of a primitive's functions.
struct Function<'a> {
    sig: &'a syn::Signature,
    result: Option<&'a syn::Type>,
    /// `T` of a last parameter `shared: &[T]`.
    shared: Option<&'a syn::Type>,
}

impl<'a> Function<'a> {
    fn of(sig: &'a syn::Signature) -> Self {
        let result = match &sig.output {
            syn::ReturnType::Type(_, ty) => Some(&**ty),
            syn::ReturnType::Default => None,
        };
        let shared = match sig.inputs.last() {
            Some(syn::FnArg::Typed(last)) => slice_of(&last.ty),
            _ => None,
        };
        Self { sig, result, shared }
    }

    /// Returns the types of the parameters without that of the shared slice, and that of the
    /// result.
    fn types(&self) -> Vec<&'a syn::Type> {
        let parameters = self.sig.inputs.iter().filter_map(|arg| match arg {
            syn::FnArg::Typed(p) => Some(&*p.ty),
            syn::FnArg::Receiver(_) => None,
        });
        parameters.filter(|ty| slice_of(ty).is_none()).chain(self.result).collect()
    }
}

/// Returns `T` of `&[T]`.
fn slice_of(ty: &syn::Type) -> Option<&syn::Type> {
    match ty {
        syn::Type::Reference(r) => match &*r.elem {
            syn::Type::Slice(slice) => Some(&slice.elem),
            _ => None,
        },
        _ => None,
    }
}

impl<'a> Parts<'a> {
    /// Reads the parts and reports one error for each that is missing or of another form.
    fn of(item: &'a syn::ItemImpl, errors: &mut Errors) -> Self {
        check_head(item, errors);
        let find = |name: &str| {
            item.items.iter().find_map(|i| match i {
                syn::ImplItem::Fn(f) if f.sig.ident == name => Some(Function::of(&f.sig)),
                _ => None,
            })
        };
        let required = |name: &str, signature: &str, errors: &mut Errors| {
            let found = find(name);
            if found.is_none() {
                errors.at(
                    item.self_ty.span(),
                    format!("the primitive has no `{name}`"),
                    &format!("add `{signature}` to this impl"),
                );
            }
            found
        };
        let intersect = required("intersect", INTERSECT, errors);
        let get_bounds = required("get_bounds", GET_BOUNDS, errors);
        let split = find("split_primitive");
        for (function, wanted) in
            [(&intersect, INTERSECT), (&get_bounds, GET_BOUNDS), (&split, SPLIT_PRIMITIVE)]
        {
            if let Some(function) = function {
                check_signature(function, wanted, errors);
            }
        }
        let has = |name: &str| {
            item.items.iter().any(|i| matches!(i, syn::ImplItem::Const(c) if c.ident == name))
        };
        let constants = CONSTANTS.into_iter().filter(|(name, _)| has(name)).collect();
        let parts = Self { intersect, get_bounds, split, constants };
        parts.check_shared(errors);
        parts
    }

    fn functions(&self) -> impl Iterator<Item = &Function<'a>> {
        [&self.intersect, &self.get_bounds, &self.split].into_iter().flatten()
    }

    /// Returns the type of the record that `intersect` returns.
    fn record(&self) -> TokenStream {
        let p = private();
        let record = self.intersect.as_ref().and_then(|f| f.result);
        record.map_or_else(|| quote!(#p::Hit), |ty| quote!(#ty))
    }

    /// Returns the type of the data that the primitives of a scene share.
    fn shared(&self) -> TokenStream {
        let shared = self.functions().find_map(|f| f.shared);
        shared.map_or_else(|| quote!(()), |ty| quote!(#ty))
    }

    /// Returns what the primitives share in an enum of several kinds: their own data, or those of
    /// the others.
    fn shared_among(&self) -> TokenStream {
        let (p, shared) = (private(), self.functions().find_map(|f| f.shared));
        let (of_t, of_u, other, mapped) = match shared {
            Some(ty) => (quote!(#ty), quote!(#ty), quote!(_), quote!(all)),
            None => (quote!(__T), quote!(__U), quote!(other), quote!(other(all))),
        };
        quote! {
            type SharedOr<__T: #p::Shared> = #of_t;

            #[inline(always)]
            fn map_shared<'__a, __T: #p::Shared, __U: #p::Shared>(
                all: <#of_t as #p::Shared>::Views<'__a>,
                #other: impl FnOnce(__T::Views<'__a>) -> __U::Views<'__a>,
            ) -> <#of_u as #p::Shared>::Views<'__a> {
                #mapped
            }
        }
    }

    /// Checks that all functions take the same slice.
    fn check_shared(&self, errors: &mut Errors) {
        let mut types = self.functions().filter_map(|f| f.shared);
        let Some(first) = types.next() else { return };
        let text = |ty: &syn::Type| quote!(#ty).to_string();
        for other in types.filter(|ty| text(ty) != text(first)) {
            errors.at(
                other.span(),
                "the functions of a primitive share one slice",
                &format!("write `&[{}]` here too", quote!(#first)),
            );
        }
    }
}

/// Checks that a primitive is a struct without parameters, in an impl of its own.
fn check_head(item: &syn::ItemImpl, errors: &mut Errors) {
    if let Some((path, _)) = &item.trait_ {
        errors.at(
            path.span(),
            "`#[primitive]` stands on an impl of the struct, not of a trait",
            "write `#[primitive] impl Name { .. }`; on the trait's impl write `#[kernel]`",
        );
    }
    if let Some(g) = item.generics.params.first() {
        errors.at(g.span(), "a primitive cannot be generic", "write a struct for each type");
    }
}

/// Checks `&self`, the types of the parameters, and that of the result.
fn check_signature(function: &Function<'_>, signature: &str, errors: &mut Errors) {
    let sig = function.sig;
    let is_ref =
        matches!(sig.receiver().map(|r| &r.kind), Some(syn::ReceiverKind::Reference(_, _, None)));
    if !is_ref || !has_types(function, signature) {
        errors.at(
            sig.ident.span(),
            format!("`{}` of a primitive has another signature", sig.ident),
            &format!("write `{signature}`"),
        );
    }
    if let Some(g) = sig.generics.params.first() {
        errors.at(
            g.span(),
            format!("`{}` of a primitive cannot be generic", sig.ident),
            &format!("write `{signature}`"),
        );
    }
}

/// Returns whether the types may be those of `signature`. Unknown names may be aliases, or a record
/// of the user's.
fn has_types(function: &Function<'_>, signature: &str) -> bool {
    let wanted = syn::parse_str::<syn::Signature>(signature).expect("a signature");
    let (written, wanted) = (function.types(), Function::of(&wanted).types());
    written.len() == wanted.len() && written.iter().zip(&wanted).all(|(a, b)| may_be(a, b))
}

fn may_be(written: &syn::Type, wanted: &syn::Type) -> bool {
    match (written, wanted) {
        (syn::Type::Paren(p), _) => may_be(&p.elem, wanted),
        (syn::Type::Tuple(a), syn::Type::Tuple(b)) => {
            a.elems.len() == b.elems.len()
                && a.elems.iter().zip(&b.elems).all(|(a, b)| may_be(a, b))
        }
        (syn::Type::Path(_), _) => {
            let name = type_name(written).unwrap_or_default();
            type_name(wanted).is_some_and(|w| w == name)
                || !(ops::is_of_library(&name) || name == "Aabb")
        }
        _ => false,
    }
}
