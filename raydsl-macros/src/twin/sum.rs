//! The twin of an enum with fields: a number for the variant, and room for the fields of any.
//!
//! Fields of one type share a slot: a variant has the first slots of each of its types. So a value
//! is as large as its largest variant where variants have the same types, and what a machine knows of
//! a number, its bounds of rounding, stays with it. The kinds of an enum of primitives are all of
//! different types: they share words instead, one for each scalar.

use std::collections::HashMap;

use proc_macro2::{Ident, TokenStream};
use quote::{ToTokens, format_ident, quote};
use syn::spanned::Spanned;

use super::shared::{capture, kernel_type, kinds};
use super::structure::twin_of;
use super::{bound_parameters, check_types};
use crate::diag::Errors;
use crate::generics::Generics;
use crate::here::private;
use crate::parse::unraw;

/// How the fields of variants are stored.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Storage {
    /// A slot of its type for each field.
    Slots,
    /// Words, which are those of the only field.
    Words,
}

/// A field of a variant.
struct Part {
    /// As patterns write it: a name, or a number.
    member: syn::Member,
    ty: syn::Type,
    slot: Ident,
    storage: Storage,
}

impl Part {
    /// Returns the slot's content for a value of the host.
    fn host_stored(&self, value: &Ident) -> TokenStream {
        let p = private();
        match self.storage {
            Storage::Slots => quote!(#value),
            Storage::Words => quote!(#p::to_words(#value)),
        }
    }

    /// Returns the value of the host that `data` holds.
    fn host_loaded(&self) -> TokenStream {
        let (p, ty, slot) = (private(), &self.ty, &self.slot);
        match self.storage {
            Storage::Slots => quote!(data.#slot),
            Storage::Words => quote!(#p::host_of_words::<#ty, _>(data.#slot)),
        }
    }

    /// Returns the slot's content for a value of the machine.
    fn stored(&self, value: &Ident) -> TokenStream {
        let (p, ty) = (private(), &self.ty);
        match self.storage {
            Storage::Slots => quote!(#p::Coerce::coerce(#value, m)),
            Storage::Words => {
                quote!(#p::to_words_on::<_, #ty, _>(m, #p::Coerce::coerce(#value, m)))
            }
        }
    }

    /// Returns the value of the machine that `self` holds.
    fn loaded(&self) -> TokenStream {
        let (p, ty, slot) = (private(), &self.ty, &self.slot);
        match self.storage {
            Storage::Slots => quote!(self.#slot),
            Storage::Words => quote!(#p::of_words::<_, #ty, _>(m, self.#slot)),
        }
    }
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

/// Slots of the types of fields.
#[derive(Default)]
struct Slots {
    all: Vec<(Ident, syn::Type)>,
    /// The slots of each type, by its text.
    of_type: HashMap<String, Vec<Ident>>,
}

impl Slots {
    /// Returns the slots for the fields of a variant.
    fn of(&mut self, fields: &syn::Fields) -> Vec<Ident> {
        let mut used: HashMap<String, usize> = HashMap::new();
        let slot = |f: &syn::Field| {
            let text = f.ty.to_token_stream().to_string();
            let at = used.entry(text.clone()).or_default();
            let known = self.of_type.entry(text).or_default();
            if *at == known.len() {
                let slot = format_ident!("slot_{}", self.all.len());
                self.all.push((slot.clone(), f.ty.clone()));
                known.push(slot);
            }
            *at += 1;
            known[*at - 1].clone()
        };
        fields.iter().map(slot).collect()
    }
}

impl Sum {
    /// Reads the variants; members that no kernel has are mistakes.
    pub(super) fn new(item: &syn::DeriveInput, e: &syn::DataEnum, errors: &mut Errors) -> Self {
        let fields: Vec<syn::Field> = e.variants.iter().flat_map(|v| v.fields.clone()).collect();
        check_types(&fields, errors);
        let mut item = item.clone();
        bound_parameters(&mut item.generics, &fields, errors);
        for (_, discriminant) in e.variants.iter().filter_map(|v| v.discriminant.as_ref()) {
            errors.at(
                discriminant.span(),
                "a kind of an enum with fields has no number of its own",
                "leave it out: kinds are numbered from 0",
            );
        }
        let mut slots = Slots::default();
        let variants = variants(e, Storage::Slots, |fields| slots.of(fields));
        let generics = Generics::new(&item.generics);
        Self { item, generics, variants, slots: slots.all }
    }

    /// Reads the variants of an enum of primitives: each has one field.
    pub(super) fn of_kinds(item: &syn::DeriveInput, e: &syn::DataEnum) -> Self {
        let words = format_ident!("words");
        let variants = variants(e, Storage::Words, |_| vec![words.clone()]);
        let (p, types) = (private(), e.variants.iter().flat_map(|v| &v.fields).map(|f| &f.ty));
        // As many as the largest kind has.
        let count = quote!({
            let mut most = 1;
            #(
                let words = <#types as #p::Type>::SCHEMA.leaves();
                if words > most {
                    most = words;
                }
            )*
            most
        });
        let slots = vec![(words, syn::parse_quote!([u32; #count]))];
        Self { item: item.clone(), generics: Generics::default(), variants, slots }
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

    /// Returns the name of the struct that represents the enum; no type of the user's has it, nor
    /// its twin's, whatever other enums are called.
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
        let (names, types): (Vec<_>, Vec<_>) = self.slots.iter().cloned().unzip();
        let (declared, clause) = (&self.item.generics.params, &self.item.generics.where_clause);
        let (p, count) = (private(), self.count());
        let data: syn::DeriveInput = syn::parse_quote! {
            #[doc(hidden)]
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
            let stored = v.parts.iter().map(|part| part.host_stored(&part.slot));
            quote! {
                Self::#name { #(#members: #slots,)* } => #data {
                    kind: #p::Kind(#number),
                    #(#slots: #stored,)*
                    #(#unused: #p::zero_of(),)*
                },
            }
        });
        let of = |v: &Variant| {
            let name = &v.name;
            let members = v.parts.iter().map(|part| &part.member);
            let loaded = v.parts.iter().map(Part::host_loaded);
            quote!(Self::#name { #(#members: #loaded,)* })
        };
        let (first, others) = self.variants.split_first().expect("there is a variant");
        let first = of(first);
        let (numbers, others): (Vec<_>, Vec<_>) = others.iter().map(|v| (v.number, of(v))).unzip();
        quote! {
            #[allow(clippy::redundant_field_names, reason = "some fields are stored as they are")]
            impl<#declared> #host where #predicates {
                #[inline]
                fn __data(self) -> #data_type {
                    match self { #(#to)* }
                }

                /// The first variant for a number that no variant has.
                #[inline]
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
        let kernel_type = kernel_type(&host.to_token_stream(), &self.generics);
        quote! {
            #kernel_type

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
                    #p::from_each_lane(m, #[inline(always)] |lane| f(lane).__data())
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
        let (p, host, twin, kinds) = (private(), self.host(), self.twin_type(), kinds());
        let Generics { declared, predicates, .. } = &self.generics;
        let (makers, methods): (Vec<_>, Vec<_>) =
            self.variants.iter().map(|v| (self.makers_of(v), self.methods_of(v))).unzip();
        quote! {
            #[doc(hidden)]
            #[allow(non_snake_case, unused, reason = "named as the variants")]
            impl<#declared> #host where #predicates {
                #(#makers)*
            }

            #[doc(hidden)]
            #[allow(non_snake_case, unused, reason = "named as the variants")]
            impl<__M: #p::Machine, #declared> #twin where #predicates {
                #[inline(always)]
                pub fn #kinds(self) -> Self {
                    self
                }

                #(#methods)*
            }
        }
    }

    /// Returns the functions that make values of a variant.
    fn makers_of(&self, v: &Variant) -> TokenStream {
        let (p, twin, number, data) = (private(), self.twin_type(), v.number, self.data_type());
        let new = format_ident!("__new_{}_on", v.name);
        let make = (!v.is_named).then(|| {
            let make = format_ident!("{}_on", v.name);
            let (slots, types): (Vec<_>, Vec<_>) =
                v.parts.iter().map(|part| (&part.slot, &part.ty)).unzip();
            let stored = v.parts.iter().map(|part| part.stored(&part.slot));
            quote! {
                #[inline(always)]
                pub fn #make<__M: #p::Machine>(
                    m: &__M,
                    #(#slots: impl #p::Coerce<__M, <#types as #p::Type>::On<__M>>,)*
                ) -> #twin {
                    let mut value = Self::#new(m);
                    #(value.#slots = #stored;)*
                    value
                }
            }
        });
        quote! {
            #[inline(always)]
            pub fn #new<__M: #p::Machine>(m: &__M) -> #twin {
                let mut value: <#data as #p::Type>::On<__M> = #p::Value::zero(m);
                value.kind = #p::u32(m, #number);
                value
            }

            #make
        }
    }

    /// Returns the methods of values that may be of a variant.
    fn methods_of(&self, v: &Variant) -> TokenStream {
        let (p, number, count) = (private(), v.number, self.count());
        let is = format_ident!("__is_{}_on", v.name);
        let parts = v.parts.iter().map(|part| {
            let (ty, slot, member) = (&part.ty, &part.slot, part.member.to_token_stream());
            let (stored, loaded) = (part.stored(&format_ident!("part")), part.loaded());
            let field = unraw(&member.to_string());
            let get = format_ident!("__{}_{field}_on", v.name);
            let set = format_ident!("__set_{}_{field}_on", v.name);
            let set = v.is_named.then(|| {
                quote! {
                    #[inline(always)]
                    pub fn #set(
                        mut self,
                        m: &__M,
                        part: impl #p::Coerce<__M, <#ty as #p::Type>::On<__M>>,
                    ) -> Self {
                        self.#slot = #stored;
                        self
                    }
                }
            });
            quote! {
                #[inline(always)]
                pub fn #get(self, m: &__M) -> <#ty as #p::Type>::On<__M> {
                    #loaded
                }

                #set
            }
        });
        quote! {
            #[inline(always)]
            pub fn #is(self, m: &__M) -> #p::B<__M> {
                #p::is_kind(m, self.kind, #number, #count)
            }

            #(#parts)*
        }
    }
}

/// Returns the variants with their fields, which lie in the slots that `slots` gives.
fn variants(
    e: &syn::DataEnum,
    storage: Storage,
    mut slots: impl FnMut(&syn::Fields) -> Vec<Ident>,
) -> Vec<Variant> {
    let variant = |(number, v): (usize, &syn::Variant)| {
        let members = v.fields.members().zip(&v.fields).zip(slots(&v.fields));
        let part = |((member, f), slot): ((syn::Member, &syn::Field), Ident)| Part {
            member,
            ty: f.ty.clone(),
            slot,
            storage,
        };
        Variant {
            name: v.ident.clone(),
            number: number as u32,
            is_named: matches!(v.fields, syn::Fields::Named(_)),
            parts: members.map(part).collect(),
        }
    };
    e.variants.iter().enumerate().map(variant).collect()
}
