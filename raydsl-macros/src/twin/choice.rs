//! Expansion of `#[primitive] enum`: one of several kinds of primitives, without virtual calls.
//!
//! The twin is that of an enum with fields, whose variants share words.

use proc_macro2::{Ident, TokenStream};
use quote::quote;
use syn::spanned::Spanned;

use super::copies;
use super::sum::Sum;
use crate::diag::Errors;
use crate::here::{At, in_one_place, private, private_here, quote_here};

/// The number of bits in the set of a scene's variants.
const MOST_KINDS: usize = 64;

/// Returns the enum, its twin, and its implementation of `Primitive`; and what `more` returns, if
/// there is no mistake. `several` are the types of the slices that it names as shared.
pub(crate) fn primitive_enum(
    item: &syn::DeriveInput,
    e: &syn::DataEnum,
    several: &[syn::Type],
    more: impl FnOnce() -> TokenStream,
) -> TokenStream {
    let mut errors = Errors::default();
    let kinds = kinds(item, e, &mut errors);
    if !errors.is_empty() {
        let errors = errors.into_tokens();
        return quote!(#item #errors);
    }
    let (copies, twin, more) = (copies(item), Sum::of_kinds(item, e).twin(), more());
    let primitive = Choice { name: &item.ident, kinds, several }.primitive_impl();
    quote! {
        #copies
        #item
        #twin
        #primitive
        #more
    }
}

struct Kind {
    name: Ident,
    ty: syn::Type,
}

/// Returns the variants, each of which has one field, its primitive.
fn kinds(item: &syn::DeriveInput, e: &syn::DataEnum, errors: &mut Errors) -> Vec<Kind> {
    if let Some(g) = item.generics.params.first() {
        errors.at(g.span(), "a primitive cannot be generic", "write an enum for each type");
    }
    if e.variants.is_empty() || e.variants.len() > MOST_KINDS {
        errors.at(
            item.ident.span(),
            format!("an enum of primitives has from 1 to {MOST_KINDS} kinds"),
            "put some kinds into an enum of their own, which is a primitive too",
        );
    }
    let mut kinds = Vec::new();
    for v in &e.variants {
        if let Some(cfg) = v.attrs.iter().find(|a| a.path().is_ident("cfg")) {
            errors.at(
                cfg.span(),
                "a kind of an enum of primitives has no `#[cfg]`: kinds are numbered and counted",
                "write an enum for each configuration",
            );
        }
        let ty = match &v.fields {
            syn::Fields::Unnamed(f) if f.unnamed.len() == 1 => &f.unnamed[0].ty,
            _ => {
                errors.at(
                    v.span(),
                    "a kind of an enum of primitives holds one primitive",
                    &format!("write `{}(Sphere)` with a type that is a primitive", v.ident),
                );
                continue;
            }
        };
        kinds.push(Kind { name: v.ident.clone(), ty: ty.clone() });
    }
    kinds
}

struct Choice<'a> {
    name: &'a Ident,
    kinds: Vec<Kind>,
    /// The types of the slices that the kinds share, where the enum names them.
    several: &'a [syn::Type],
}

impl Choice<'_> {
    fn names(&self) -> Vec<&Ident> {
        self.kinds.iter().map(|k| &k.name).collect()
    }

    fn types(&self) -> Vec<&syn::Type> {
        self.kinds.iter().map(|k| &k.ty).collect()
    }

    fn numbers(&self) -> Vec<u32> {
        (0..self.kinds.len() as u32).collect()
    }

    fn primitive_impl(&self) -> TokenStream {
        let (p, name) = (private(), self.name);
        let (record, shared, among) = (self.record(), self.shared(), self.shared_among());
        let count = self.kinds.len() as u32;
        let (slack, on_host, on_machine) =
            (self.constants(), self.host_functions(), self.machine_functions());
        quote! {
            impl #p::Primitive for #name {
                type Hit = #record;
                type Shared = #shared;
                #among

                const KINDS: u32 = #count;

                #slack
                #on_host
                #on_machine
            }
        }
    }

    /// Returns the hit record of the first variant, which all share.
    fn record(&self) -> TokenStream {
        let (p, first) = (private(), &self.kinds[0].ty);
        quote!(<#first as #p::Primitive>::Hit)
    }

    /// Returns the type of the data that the primitives of a scene share: those of the kinds that
    /// share some.
    fn shared(&self) -> TokenStream {
        match self.several {
            [] => self.shared_or(quote!(())),
            several => {
                let p = private();
                quote!(#p::Several<(#(#several,)*)>)
            }
        }
    }

    /// Returns the type of the slices of the host.
    fn slices(&self) -> TokenStream {
        let (p, shared) = (private(), self.shared());
        quote!(<#shared as #p::Shared>::Slices<'_>)
    }

    /// Returns the type of the slices in kernels.
    fn views(&self) -> TokenStream {
        let (p, shared) = (private(), self.shared());
        quote!(<#shared as #p::Shared>::Views<'_>)
    }

    fn shared_or(&self, none: TokenStream) -> TokenStream {
        let p = private();
        let around = |inner, ty| quote!(<#ty as #p::Primitive>::SharedOr<#inner>);
        self.types().into_iter().rev().fold(none, around)
    }

    /// Returns what the primitives share in an enum that this one is a kind of.
    fn shared_among(&self) -> TokenStream {
        let p = private();
        // What the enum names is what it shares in any other one.
        let (of_t, of_u, other, mapped) = if self.several.is_empty() {
            let none = (quote!(__T), quote!(__U), quote!(other(all)));
            let around = |(of_t, of_u, inner), ty| {
                let kind = quote!(<#ty as #p::Primitive>);
                let mapped = quote! {
                    #kind::map_shared::<#of_t, #of_u>(all, #[inline(always)] |all| #inner)
                };
                (quote!(#kind::SharedOr<#of_t>), quote!(#kind::SharedOr<#of_u>), mapped)
            };
            let (of_t, of_u, mapped) = self.types().into_iter().rev().fold(none, around);
            (of_t, of_u, quote!(other), mapped)
        } else {
            (self.shared(), self.shared(), quote!(_), quote!(all))
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

    /// Returns what the primitives of each kind share, of the slice `shared`. The span is that of the
    /// kind: there rustc reports kinds that share different data.
    fn shared_of_kinds(&self, shared: &TokenStream) -> Vec<TokenStream> {
        let of_kind = |ty: &syn::Type| {
            let _at = At::new(ty.span());
            let p = private_here();
            let (ty, all) = (in_one_place(quote!(#ty)), in_one_place(self.shared()));
            if self.several.is_empty() {
                quote_here!(#p::shared_of_kind::<#ty, #all>(#shared))
            } else {
                quote_here!(#p::shared_among::<#ty, #all, _>(#shared))
            }
        };
        self.types().into_iter().map(of_kind).collect()
    }

    /// Returns the same on the host.
    fn host_shared_of_kinds(&self) -> Vec<TokenStream> {
        let p = private();
        let all = self.shared();
        let views = self.shared_of_kinds(&quote!(#p::shared_views::<#all>(shared)));
        let of_kind =
            |(ty, own)| quote!(<<#ty as #p::Primitive>::Shared as #p::Shared>::of_views(#own));
        self.types().into_iter().zip(views).map(of_kind).collect()
    }

    fn constants(&self) -> TokenStream {
        let (p, types, numbers) = (private(), self.types(), self.numbers());
        let is_one = types.len() == 1;
        quote! {
            /// That of the kind, if there is one.
            const IS_SHORT: bool = #is_one && #(<#types as #p::Primitive>::IS_SHORT)&&*;

            /// The largest of all kinds.
            const SLACK: f32 = {
                let mut most = 0.0;
                #(
                    if <#types as #p::Primitive>::SLACK > most {
                        most = <#types as #p::Primitive>::SLACK;
                    }
                )*
                most
            };

            /// The largest of all kinds.
            const MAX_CROSSINGS: u32 = {
                let mut most = 1;
                #(
                    if <#types as #p::Primitive>::MAX_CROSSINGS > most {
                        most = <#types as #p::Primitive>::MAX_CROSSINGS;
                    }
                )*
                most
            };

            fn limits_of(kinds: #p::Kinds) -> (f32, u32) {
                let (mut slack, mut crossings) = (0.0f32, 1u32);
                #(
                    if kinds.has(#numbers) {
                        slack = slack.max(<#types as #p::Primitive>::SLACK);
                        crossings = crossings.max(<#types as #p::Primitive>::MAX_CROSSINGS);
                    }
                )*
                (slack, crossings)
            }
        }
    }

    /// Returns the functions of the host, which call those of a primitive's variant.
    fn host_functions(&self) -> TokenStream {
        let (p, record, slices) = (private(), self.record(), self.slices());
        let (names, types, numbers) = (self.names(), self.types(), self.numbers());
        let own = self.host_shared_of_kinds();
        quote! {
            #[inline(always)]
            fn intersect(&self, ray: #p::Ray, shared: #slices) -> #record {
                match self {
                    #(Self::#names(v) => <#types as #p::Primitive>::intersect(v, ray, #own),)*
                }
            }

            fn get_bounds(&self, shared: #slices) -> #p::Aabb {
                match self {
                    #(Self::#names(v) => <#types as #p::Primitive>::get_bounds(v, #own),)*
                }
            }

            fn split_primitive(
                &self,
                axis: usize,
                at: f32,
                shared: #slices,
            ) -> (#p::Aabb, #p::Aabb) {
                match self {
                    #(
                        Self::#names(v) => {
                            <#types as #p::Primitive>::split_primitive(v, axis, at, #own)
                        }
                    )*
                }
            }

            #[inline(always)]
            fn kind(&self) -> u32 {
                match self {
                    #(Self::#names(_) => #numbers,)*
                }
            }
        }
    }

    /// Returns intersection on a machine: with primitives of any variant, of one variant, and of
    /// some.
    fn machine_functions(&self) -> TokenStream {
        let (p, record, views) = (private(), self.record(), self.views());
        let (names, types) = (self.names(), self.types());
        let among = self.intersect_among();
        let own = self.shared_of_kinds(&quote!(shared));
        quote! {
            #[inline(always)]
            fn intersect_on<__M: #p::Machine>(
                m: &__M,
                prim: <Self as #p::Type>::On<__M>,
                ray: #p::RayOn<__M>,
                shared: #views,
            ) -> <#record as #p::Type>::On<__M> {
                Self::intersect_among_on(m, #p::Kinds::ALL, prim, ray, shared)
            }

            #[inline(always)]
            fn intersect_one_on<__M: #p::Machine>(
                m: &__M,
                prim: &Self,
                ray: #p::RayOn<__M>,
                shared: #views,
            ) -> <#record as #p::Type>::On<__M> {
                match prim {
                    #(
                        Self::#names(v) => {
                            <#types as #p::Primitive>::intersect_one_on(m, v, ray, #own)
                        }
                    )*
                }
            }

            #[inline(always)]
            fn intersect_among_on<__M: #p::Machine>(
                m: &__M,
                kinds: #p::Kinds,
                prim: <Self as #p::Type>::On<__M>,
                ray: #p::RayOn<__M>,
                shared: #views,
            ) -> <#record as #p::Type>::On<__M> {
                #among
            }
        }
    }

    /// Returns the body of `intersect_among_on`: each variant in turn, with the rays whose
    /// primitive is of that variant.
    fn intersect_among(&self) -> TokenStream {
        let (p, types, numbers) = (private(), self.types(), self.numbers());
        let count = self.kinds.len() as u32;
        let own = self.shared_of_kinds(&quote!(shared));
        let wgsl_name = format!("{}_intersect", self.name);
        let found: Vec<_> = types
            .iter()
            .zip(&own)
            .map(|(ty, own)| {
                quote! {{
                    let prim = #p::of_words::<_, #ty, _>(m, prim.words);
                    <#ty as #p::Primitive>::intersect_on(m, prim, ray, #own)
                }}
            })
            .collect();
        // One kind needs no variable, in which its lanes would be merged with those of others.
        let among = if let [found] = &found[..] {
            quote!(#found)
        } else {
            quote! {
                #(
                    // What is recorded of a scene with one kind is that of an enum of this kind.
                    if const { !__M::RUNS } && kinds.is_only(#numbers) {
                        return #found;
                    }
                )*
                let found = #p::Var::new(m, "found", #p::Value::zero(m));
                #(
                    #p::of_kind(
                        m,
                        kinds,
                        prim.kind,
                        #numbers,
                        #count,
                        #[inline(always)]
                        || found.set(m, #found),
                    );
                )*
                found.get(m)
            }
        };
        quote! {
            static __INFO: #p::KernelInfo = #p::KernelInfo {
                name: #wgsl_name,
                file: ::core::file!(),
                line: ::core::line!(),
                params: &["self", "ray", "shared"],
                known: ::core::option::Option::None,
            };
            #p::Machine::call(
                m,
                &__INFO,
                (prim, ray, shared),
                #[inline(always)]
                |m, (prim, ray, shared)| { #among },
            )
        }
    }
}
