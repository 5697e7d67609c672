//! The twin of a struct: what stands for its values on a machine.

mod choice;
mod enumeration;
mod mistaken;
mod operators;
mod record;

use proc_macro2::TokenStream;
use quote::{ToTokens, format_ident, quote, quote_spanned};
use syn::spanned::Spanned;

use crate::diag::Errors;
use crate::generics::{Generics, mentions};
use crate::parse;

pub(crate) use record::hit_record;

fn private() -> TokenStream {
    quote!(::raydsl::__private)
}

/// `#[derive(Type)]`.
pub(crate) fn derive(item: &syn::DeriveInput) -> TokenStream {
    let mut errors = Errors::default();
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
    let twin = twin(&item, &fields);
    let errors = errors.into_tokens();
    quote!(#twin #errors)
}

/// Bounds that say nothing of kernels.
const OTHER_BOUNDS: &[&str] = &[
    "Clone",
    "Copy",
    "Debug",
    "Default",
    "Eq",
    "Hash",
    "Ord",
    "PartialEq",
    "PartialOrd",
    "Send",
    "Sized",
    "Sync",
];

/// A type parameter that is a member's type must be a type of kernels. Where nothing says so, the
/// twin has the bound all the same, so that there is one error.
fn bound_parameters(generics: &mut syn::Generics, fields: &[syn::Field], errors: &mut Errors) {
    let says_nothing = |b: &syn::TypeParamBound| match b {
        syn::TypeParamBound::Trait(t) => {
            t.path.segments.last().is_some_and(|s| OTHER_BOUNDS.iter().any(|o| s.ident == o))
        }
        _ => true,
    };
    let clause = generics.where_clause.to_token_stream();
    for param in generics.params.iter_mut() {
        let syn::GenericParam::Type(t) = param else { continue };
        let is_member = fields.iter().any(|f| mentions(&f.ty.to_token_stream(), &t.ident));
        if !is_member || mentions(&clause, &t.ident) || !t.bounds.iter().all(says_nothing) {
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

/// `#[primitive] struct`, or `enum` of primitives.
pub(crate) fn primitive_item(item: &syn::DeriveInput) -> TokenStream {
    let mut errors = Errors::default();
    if let syn::Data::Enum(e) = &item.data {
        return choice::choice(item, e);
    }
    let fields = named_fields(item, &mut errors);
    check_types(&fields, &mut errors);
    if let Some(g) = item.generics.params.first() {
        errors.at(g.span(), "a primitive cannot be generic", "write a struct for each type");
    }
    let name = &item.ident;
    let copies = copies(item);
    if !errors.is_empty() {
        let derives = mistaken::can_have_twin(item).then_some(&copies);
        let mistaken = mistaken::mistaken(item, errors);
        return quote!(#derives #item #mistaken);
    }
    let repr = (!item.attrs.iter().any(|a| a.path().is_ident("repr"))).then(|| quote!(#[repr(C)]));
    let types = fields.iter().map(|f| &f.ty);
    let twin = twin(item, &fields);
    let dense = quote_spanned! {name.span()=>
        const _: () = assert!(
            ::core::mem::size_of::<#name>() == #(::core::mem::size_of::<#types>())+*,
            concat!(
                "the primitive `", stringify!(#name), "` has gaps between its members\n",
                "  help: order them by size, or fill the gaps with members of your own",
            ),
        );
    };
    quote! {
        #copies
        #repr
        #item
        #twin
        #dense
    }
}

/// That a primitive is copied, where the user has not written it.
fn copies(item: &syn::DeriveInput) -> TokenStream {
    let clone = (!derives(item, "Clone")).then(|| quote!(#[derive(Clone)]));
    let copy = (!derives(item, "Copy")).then(|| quote!(#[derive(Copy)]));
    quote!(#clone #copy)
}

/// Whether the user derives a trait.
fn derives(item: &syn::DeriveInput, what: &str) -> bool {
    let found = |a: &syn::Attribute| {
        let check = |m: syn::meta::ParseNestedMeta<'_>| {
            if m.path.is_ident(what) { Err(m.error("found")) } else { Ok(()) }
        };
        a.path().is_ident("derive") && a.parse_nested_meta(check).is_err()
    };
    item.attrs.iter().any(found)
}

/// Members of types that no kernel has.
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

/// The twin struct and the implementations that connect it with the host's.
fn twin(item: &syn::DeriveInput, fields: &[syn::Field]) -> TokenStream {
    let (name, generics) = (&item.ident, Generics::new(&item.generics));
    let used = &generics.used;
    twin_of(item, fields, &quote!(#name<#used>))
}

/// [`twin`], with the methods of `owner`.
fn twin_of(item: &syn::DeriveInput, fields: &[syn::Field], owner: &TokenStream) -> TokenStream {
    let p = private();
    let (vis, name) = (&item.vis, &item.ident);
    let generics = Generics::new(&item.generics);
    let Generics { declared, used, predicates, .. } = &generics;
    let twin = format_ident!("{name}On");
    let text = name.to_string();
    let names: Vec<_> = fields.iter().filter_map(|f| f.ident.as_ref()).collect();
    let texts: Vec<String> = names.iter().map(ToString::to_string).collect();
    let types: Vec<_> = fields.iter().map(|f| &f.ty).collect();
    let visible: Vec<_> = fields.iter().map(|f| &f.vis).collect();
    let doc = format!("[`{name}`] on a machine.");
    let host = quote!(#name<#used>);
    let schema = quote! {
        &#p::Schema::Struct {
            name: #text,
            fields: &[#(#p::Field {
                name: #texts,
                offset: ::core::mem::offset_of!(#host, #names),
                schema: <#types as #p::Type>::SCHEMA,
            }),*],
            size: ::core::mem::size_of::<#host>(),
        }
    };
    let methods = methods(&quote!(#twin<__M, #used>), owner, &generics);
    let capture = capture(&quote!(#twin<__M, #used>), &host, &generics);
    quote! {
        #[doc = #doc]
        #[allow(missing_docs, reason = "the members are those of the struct")]
        #vis struct #twin<__M: #p::Machine, #declared> where #predicates {
            #(#visible #names: <#types as #p::Type>::On<__M>,)*
        }

        impl<__M: #p::Machine, #declared> Clone for #twin<__M, #used> where #predicates {
            #[inline(always)]
            fn clone(&self) -> Self {
                *self
            }
        }

        impl<__M: #p::Machine, #declared> Copy for #twin<__M, #used> where #predicates {}

        impl<__M: #p::Machine, #declared> #p::Value<__M> for #twin<__M, #used> where #predicates {
            const SCHEMA: &'static #p::Schema = #schema;

            #[inline(always)]
            fn zero(m: &__M) -> Self {
                Self { #(#names: #p::Value::zero(m),)* }
            }

            #[inline(always)]
            fn zip(m: &__M, a: Self, b: Self, f: &mut impl #p::Leaves<__M>) -> Self {
                Self { #(#names: #p::Value::zip(m, a.#names, b.#names, f),)* }
            }
        }

        #methods

        #[diagnostic::do_not_recommend]
        impl<#declared> #p::Type for #host where #predicates {
            type On<__M: #p::Machine> = #twin<__M, #used>;

            const SCHEMA: &'static #p::Schema = #schema;

            #[inline(always)]
            fn splat<__M: #p::Machine>(m: &__M, v: Self) -> #twin<__M, #used> {
                #twin { #(#names: #p::Type::splat(m, v.#names),)* }
            }

            #[inline(always)]
            fn from_lanes<__M: #p::LaneMachine>(
                m: &__M,
                f: impl Fn(usize) -> Self + Copy,
            ) -> #twin<__M, #used> {
                #twin { #(#names: #p::Type::from_lanes(m, #[inline(always)] |lane| f(lane).#names),)* }
            }

            #[inline(always)]
            fn lane<__M: #p::LaneMachine>(v: &#twin<__M, #used>, lane: usize) -> Self {
                Self { #(#names: #p::Type::lane(&v.#names, lane),)* }
            }

            fn write(&self, out: &mut [u8]) {
                #(#p::Type::write(&self.#names, &mut out[::core::mem::offset_of!(#host, #names)..]);)*
            }

            fn read(bytes: &[u8]) -> Self {
                Self {
                    #(#names: #p::Type::read(&bytes[::core::mem::offset_of!(#host, #names)..]),)*
                }
            }
        }

        #capture
    }
}

/// How a twin is kept in variables, and its methods, which are those of the host's type.
fn methods(twin: &TokenStream, host: &TokenStream, generics: &Generics) -> TokenStream {
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

        impl<const __NAME: u64, __M: #p::Machine, __Args, __Via, #declared> #p::Method<__NAME, __M, __Args, __Via>
            for #twin
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

/// How kernels capture a value of the host, and read it where it is a constant.
fn capture(twin: &TokenStream, host: &TokenStream, generics: &Generics) -> TokenStream {
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
        }
    }
}
