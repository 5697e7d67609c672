//! The twin of an enum with fields: a number for the variant, and room for the fields of any.
//!
//! Fields of one type share a slot: a variant has the first slots of each of its types. So a value
//! is as large as its largest variant where variants have the same types, and what a machine knows of
//! a number, its bounds of rounding, stays with it.

use std::collections::HashMap;

use proc_macro2::{Ident, TokenStream};
use quote::{ToTokens, format_ident, quote};
use syn::spanned::Spanned;

use super::shared::capture;
use super::structure::twin_of;
use super::{bound_parameters, check_types};
use crate::diag::Errors;
use crate::generics::Generics;
use crate::here::private;

/// A field of a variant.
struct Part {
    /// As patterns write it: a name, or a number.
    member: syn::Member,
    ty: syn::Type,
    slot: Ident,
}

struct Variant {
    name: Ident,
    number: u32,
    is_named: bool,
    parts: Vec<Part>,
}

/// An enum with fields.
pub(super) struct Sum {
    item: syn::DeriveInput,
    generics: Generics,
    variants: Vec<Variant>,
    /// The slots and their types.
    slots: Vec<(Ident, syn::Type)>,
}

impl Sum {
    /// Reads the variants; members that no kernel has are mistakes.
    pub(super) fn new(item: &syn::DeriveInput, e: &syn::DataEnum, errors: &mut Errors) -> Self {
        let fields: Vec<syn::Field> = e.variants.iter().flat_map(|v| v.fields.clone()).collect();
        check_types(&fields, errors);
        let mut item = item.clone();
        bound_parameters(&mut item.generics, &fields, errors);
        let mut slots: Vec<(Ident, syn::Type)> = Vec::new();
        // The slots of each type, by its text.
        let mut of_type: HashMap<String, Vec<Ident>> = HashMap::new();
        let mut variants = Vec::new();
        for (number, v) in e.variants.iter().enumerate() {
            let mut used: HashMap<String, usize> = HashMap::new();
            let mut parts = Vec::new();
            for (i, f) in v.fields.iter().enumerate() {
                let text = f.ty.to_token_stream().to_string();
                let at = used.entry(text.clone()).or_default();
                let known = of_type.entry(text).or_default();
                if *at == known.len() {
                    let slot = format_ident!("slot_{}", slots.len());
                    slots.push((slot.clone(), f.ty.clone()));
                    known.push(slot);
                }
                let slot = known[*at].clone();
                *at += 1;
                let member = match &f.ident {
                    Some(name) => syn::Member::Named(name.clone()),
                    None => syn::Member::Unnamed(i.into()),
                };
                parts.push(Part { member, ty: f.ty.clone(), slot });
            }
            let is_named = matches!(v.fields, syn::Fields::Named(_));
            if let Some((_, discriminant)) = &v.discriminant {
                errors.at(
                    discriminant.span(),
                    "a variant of an enum with fields has no number of its own",
                    "leave it out: variants are numbered from 0",
                );
            }
            variants.push(Variant {
                name: v.ident.clone(),
                number: number as u32,
                is_named,
                parts,
            });
        }
        let generics = Generics::new(&item.generics);
        Self { item, generics, variants, slots }
    }

    /// Returns the struct of the number and the slots, its twin, and the implementations that
    /// connect them with the enum.
    pub(super) fn twin(&self) -> TokenStream {
        let (data, conversions, r#type) = (self.data(), self.conversions(), self.type_impl());
        let host = self.host();
        let capture = capture(&self.twin_type(), &host, &self.generics);
        let (functions, comparison) = (self.functions(), self.comparison());
        quote!(#data #conversions #r#type #capture #functions #comparison)
    }

    fn count(&self) -> u32 {
        self.variants.len() as u32
    }

    /// Returns the name of the struct that represents the enum; no type of the user's has it.
    fn data_name(&self) -> Ident {
        format_ident!("__{}Data", self.item.ident)
    }

    fn host(&self) -> TokenStream {
        let (name, used) = (&self.item.ident, &self.generics.used);
        quote!(#name<#used>)
    }

    fn data_type(&self) -> TokenStream {
        let (data, used) = (self.data_name(), &self.generics.used);
        quote!(#data<#used>)
    }

    fn twin_type(&self) -> TokenStream {
        let (twin, used) = (format_ident!("{}On", self.data_name()), &self.generics.used);
        quote!(#twin<__M, #used>)
    }

    /// Returns the struct of the number and the slots, and its twin.
    fn data(&self) -> TokenStream {
        let (vis, data) = (&self.item.vis, self.data_name());
        let doc = format!("[`{}`] as the number of its variant and its fields.", self.item.ident);
        let (names, types): (Vec<_>, Vec<_>) = self.slots.iter().cloned().unzip();
        let (declared, clause) = (&self.item.generics.params, &self.item.generics.where_clause);
        let (p, count) = (private(), self.count());
        let data: syn::DeriveInput = syn::parse_quote! {
            #[doc = #doc]
            #[derive(Clone, Copy)]
            #[repr(C)]
            #vis struct #data<#declared> #clause {
                kind: #p::Kind<#count>,
                #(#names: #types,)*
            }
        };
        let fields: Vec<syn::Field> = match &data.data {
            syn::Data::Struct(s) => s.fields.iter().cloned().collect(),
            _ => Vec::new(),
        };
        let twin = twin_of(&data, &fields, &self.item.ident, &self.host());
        quote!(#data #twin)
    }

    /// Returns the slots that a variant does not use.
    fn unused(&self, variant: &Variant) -> Vec<&Ident> {
        let is_unused = |slot: &&Ident| variant.parts.iter().all(|part| part.slot != **slot);
        self.slots.iter().map(|(slot, _)| slot).filter(is_unused).collect()
    }

    /// Returns the conversions between the enum and the struct that represents it.
    fn conversions(&self) -> TokenStream {
        let p = private();
        let (host, data, data_type) = (self.host(), self.data_name(), self.data_type());
        let Generics { declared, predicates, .. } = &self.generics;
        let to = self.variants.iter().map(|v| {
            let (name, number, unused) = (&v.name, v.number, self.unused(v));
            let members = v.parts.iter().map(|part| &part.member);
            let slots: Vec<_> = v.parts.iter().map(|part| &part.slot).collect();
            quote! {
                Self::#name { #(#members: #slots,)* } => #data {
                    kind: #p::Kind(#number),
                    #(#slots,)*
                    #(#unused: #p::zero_of(),)*
                },
            }
        });
        let of = |v: &Variant| {
            let name = &v.name;
            let members = v.parts.iter().map(|part| &part.member);
            let slots = v.parts.iter().map(|part| &part.slot);
            quote!(Self::#name { #(#members: data.#slots,)* })
        };
        let (first, others) = self.variants.split_first().expect("there is a variant");
        let first = of(first);
        let (numbers, others): (Vec<_>, Vec<_>) = others.iter().map(|v| (v.number, of(v))).unzip();
        quote! {
            impl<#declared> #host where #predicates {
                #[inline(always)]
                fn __data(self) -> #data_type {
                    match self { #(#to)* }
                }

                /// The first variant for a number that no variant has.
                #[inline(always)]
                fn __of_data(data: #data_type) -> Self {
                    match data.kind.0 {
                        #(#numbers => #others,)*
                        _ => #first,
                    }
                }
            }
        }
    }

    /// Returns the implementation of the enum as a type of kernels.
    fn type_impl(&self) -> TokenStream {
        let p = private();
        let (host, data, twin) = (self.host(), self.data_type(), self.twin_type());
        let Generics { declared, predicates, .. } = &self.generics;
        quote! {
            #[diagnostic::do_not_recommend]
            impl<#declared> #p::Type for #host where #predicates {
                type On<__M: #p::Machine> = #twin;

                const SCHEMA: &'static #p::Schema = <#data as #p::Type>::SCHEMA;

                #[inline(always)]
                fn splat<__M: #p::Machine>(m: &__M, v: Self) -> #twin {
                    #p::Type::splat(m, v.__data())
                }

                #[inline(always)]
                fn from_lanes<__M: #p::LaneMachine>(
                    m: &__M,
                    f: impl Fn(usize) -> Self + Copy,
                ) -> #twin {
                    #p::Type::from_lanes(m, #[inline(always)] |lane| f(lane).__data())
                }

                #[inline(always)]
                fn lane<__M: #p::LaneMachine>(v: &#twin, lane: usize) -> Self {
                    Self::__of_data(<#data as #p::Type>::lane(v, lane))
                }

                fn write(&self, out: &mut [u8]) {
                    #p::Type::write(&self.__data(), out);
                }

                fn read(bytes: &[u8]) -> Self {
                    Self::__of_data(#p::Type::read(bytes))
                }
            }
        }
    }

    /// Returns the refusal of comparisons.
    fn comparison(&self) -> TokenStream {
        let (p, host, twin) = (private(), self.host(), self.twin_type());
        let Generics { declared, predicates, .. } = &self.generics;
        quote! {
            impl<__M: #p::Machine, #declared> #p::OpCompare<__M, Self> for #twin
            where
                #host: #p::Comparable<__M>,
                #predicates
            {
                type Output = #p::B<__M>;

                fn compare<__O: #p::Op<#p::Compare>>(
                    _: &__M,
                    _: __O,
                    _: Self,
                    _: Self,
                ) -> Self::Output {
                    ::core::unreachable!()
                }
            }
        }
    }

    /// Returns the functions for variants in patterns and expressions of kernels.
    fn functions(&self) -> TokenStream {
        let (host, Generics { declared, predicates, .. }) = (self.host(), &self.generics);
        let functions = self.variants.iter().map(|v| self.functions_of(v));
        quote! {
            #[doc(hidden)]
            #[allow(non_snake_case, dead_code, reason = "named as the variants")]
            impl<#declared> #host where #predicates {
                #(#functions)*
            }
        }
    }

    fn functions_of(&self, v: &Variant) -> TokenStream {
        let (p, twin, number, data) = (private(), self.twin_type(), v.number, self.data_type());
        let count = self.count();
        let (is, new) = (format_ident!("__is_{}_on", v.name), format_ident!("__new_{}_on", v.name));
        let parts = v.parts.iter().map(|part| {
            let (ty, slot, member) = (&part.ty, &part.slot, part.member.to_token_stream());
            let get = format_ident!("__{}_{}_on", v.name, member.to_string());
            let set = format_ident!("__set_{}_{}_on", v.name, member.to_string());
            let set = v.is_named.then(|| {
                quote! {
                    #[inline(always)]
                    pub fn #set<__M: #p::Machine>(
                        m: &__M,
                        value: #twin,
                        part: impl #p::Coerce<__M, <#ty as #p::Type>::On<__M>>,
                    ) -> #twin {
                        let mut value = value;
                        value.#slot = #p::Coerce::coerce(part, m);
                        value
                    }
                }
            });
            quote! {
                #[inline(always)]
                pub fn #get<__M: #p::Machine>(
                    _: &__M,
                    value: #twin,
                ) -> <#ty as #p::Type>::On<__M> {
                    value.#slot
                }

                #set
            }
        });
        let make = (!v.is_named).then(|| {
            let make = format_ident!("{}_on", v.name);
            let (slots, types): (Vec<_>, Vec<_>) =
                v.parts.iter().map(|part| (&part.slot, &part.ty)).unzip();
            quote! {
                #[inline(always)]
                pub fn #make<__M: #p::Machine>(
                    m: &__M,
                    #(#slots: impl #p::Coerce<__M, <#types as #p::Type>::On<__M>>,)*
                ) -> #twin {
                    let mut value = Self::#new(m);
                    #(value.#slots = #p::Coerce::coerce(#slots, m);)*
                    value
                }
            }
        });
        quote! {
            #[inline(always)]
            pub fn #is<__M: #p::Machine>(m: &__M, value: #twin) -> #p::B<__M> {
                #p::is_kind(m, value.kind, #number, #count)
            }

            #[inline(always)]
            pub fn #new<__M: #p::Machine>(m: &__M) -> #twin {
                let mut value: <#data as #p::Type>::On<__M> = #p::Value::zero(m);
                value.kind = #p::u32(m, #number);
                value
            }

            #(#parts)*

            #make
        }
    }
}
