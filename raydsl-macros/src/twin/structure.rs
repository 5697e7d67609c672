//! The twin of a struct: a struct of the members' twins.

use proc_macro2::{Ident, TokenStream};
use quote::{ToTokens, format_ident, quote};

use super::shared::{capture, kernel_type, methods};
use crate::generics::Generics;
use crate::here::private;

/// Returns the twin struct and the implementations that connect it with the host's type.
pub(super) fn twin(item: &syn::DeriveInput, fields: &[syn::Field]) -> TokenStream {
    let structure = Structure::new(item, fields, &item.ident);
    structure.twin(&structure.host)
}

/// Returns [`twin()`] of the struct that represents an enum: it has the enum's name in WGSL, and its
/// methods, those of `owner`.
pub(super) fn twin_of(
    item: &syn::DeriveInput,
    fields: &[syn::Field],
    name: &Ident,
    owner: &TokenStream,
) -> TokenStream {
    Structure::new(item, fields, name).twin(owner)
}

struct Structure<'a> {
    item: &'a syn::DeriveInput,
    fields: &'a [syn::Field],
    generics: Generics,
    /// The name of the type in WGSL and in documentation.
    shown: &'a Ident,
    /// The twin's name.
    name: Ident,
    /// The host's type, with its parameters.
    host: TokenStream,
    /// The twin's type, with its parameters.
    twin: TokenStream,
}

impl<'a> Structure<'a> {
    fn new(item: &'a syn::DeriveInput, fields: &'a [syn::Field], shown: &'a Ident) -> Self {
        let generics = Generics::new(&item.generics);
        let (host, used) = (&item.ident, &generics.used);
        let name = format_ident!("{host}On");
        let (host, twin) = (quote!(#host<#used>), quote!(#name<__M, #used>));
        Self { item, fields, generics, shown, name, host, twin }
    }

    fn names(&self) -> Vec<&Ident> {
        self.fields.iter().filter_map(|f| f.ident.as_ref()).collect()
    }

    fn types(&self) -> Vec<&syn::Type> {
        self.fields.iter().map(|f| &f.ty).collect()
    }

    fn twin(&self, owner: &TokenStream) -> TokenStream {
        let (declaration, places, value) = (self.declaration(), self.places(), self.value_impl());
        let methods = methods(&self.twin, owner, &self.generics);
        let r#type = self.type_impl();
        let capture = capture(&self.twin, &self.host, &self.generics);
        quote! {
            #declaration
            #places
            #value
            #methods
            #r#type
            #capture
        }
    }

    /// Returns the twin, which is `Copy`.
    fn declaration(&self) -> TokenStream {
        let (p, twin, name, vis) = (private(), &self.twin, &self.name, &self.item.vis);
        let Generics { declared, predicates, .. } = &self.generics;
        let (names, types) = (self.names(), self.types());
        let visible = self.fields.iter().map(|f| &f.vis);
        let doc = format!("[`{}`] on a machine.", self.shown);
        // As the struct itself.
        let hidden = self.item.attrs.iter().filter(|a| {
            a.path().is_ident("doc") && a.to_token_stream().to_string().contains("hidden")
        });
        quote! {
            #[doc = #doc]
            #(#hidden)*
            #[allow(missing_docs, reason = "the members are those of the struct")]
            #vis struct #name<__M: #p::Machine, #declared> where #predicates {
                #(#visible #names: <#types as #p::Type>::On<__M>,)*
            }

            impl<__M: #p::Machine, #declared> Clone for #twin where #predicates {
                #[inline(always)]
                fn clone(&self) -> Self {
                    *self
                }
            }

            impl<__M: #p::Machine, #declared> Copy for #twin where #predicates {}
        }
    }

    /// Returns where the members lie.
    fn places(&self) -> TokenStream {
        let (p, host, types, names) = (private(), &self.host, self.types(), self.names());
        let Generics { declared, predicates, .. } = &self.generics;
        let count = names.len();
        quote! {
            #[doc(hidden)]
            impl<#declared> #host where #predicates {
                const __PLACES: #p::Places<#count> = #p::Places::new(
                    ::core::mem::size_of::<Self>(),
                    [#(::core::mem::offset_of!(Self, #names)),*],
                    [#(::core::mem::size_of::<#types>()),*],
                    [#(<#types as #p::Type>::SCHEMA),*],
                );
            }
        }
    }

    fn schema(&self) -> TokenStream {
        let (p, types) = (private(), self.types());
        let (name, names) = (self.shown.to_string(), self.names());
        let texts = names.iter().map(ToString::to_string);
        let numbers = 0..names.len();
        quote! {
            &#p::Schema::Struct {
                name: #name,
                fields: &[#(#p::Field {
                    name: #texts,
                    offset: Self::__PLACES.offsets[#numbers],
                    schema: <#types as #p::Type>::SCHEMA,
                }),*],
                size: Self::__PLACES.size,
            }
        }
    }

    /// Returns the implementation of the twin as a value of a machine.
    fn value_impl(&self) -> TokenStream {
        let (p, twin, names, host) = (private(), &self.twin, self.names(), &self.host);
        let Generics { declared, predicates, .. } = &self.generics;
        quote! {
            impl<__M: #p::Machine, #declared> #p::Value<__M> for #twin where #predicates {
                const SCHEMA: &'static #p::Schema = <#host as #p::Type>::SCHEMA;

                #[inline(always)]
                fn zero(m: &__M) -> Self {
                    Self { #(#names: #p::Value::zero(m),)* }
                }

                #[inline(always)]
                fn zip(m: &__M, a: Self, b: Self, f: &mut impl #p::Leaves<__M>) -> Self {
                    Self { #(#names: #p::Value::zip(m, a.#names, b.#names, f),)* }
                }
            }
        }
    }

    /// Returns the implementation of the host's type as one of kernels.
    fn type_impl(&self) -> TokenStream {
        let (p, host, twin, name) = (private(), &self.host, &self.twin, &self.name);
        let Generics { declared, predicates, .. } = &self.generics;
        let (names, schema, bytes) = (self.names(), self.schema(), self.bytes());
        let kernel_type = kernel_type(&quote!(#host), &self.generics);
        quote! {
            #kernel_type

            #[diagnostic::do_not_recommend]
            impl<#declared> #p::Type for #host where #predicates {
                type On<__M: #p::Machine> = #twin;

                const SCHEMA: &'static #p::Schema = #schema;

                #[inline(always)]
                fn splat<__M: #p::Machine>(m: &__M, v: Self) -> #twin {
                    #name { #(#names: #p::Type::splat(m, v.#names),)* }
                }

                #[inline(always)]
                fn from_lanes<__M: #p::LaneMachine>(
                    m: &__M,
                    f: impl Fn(usize) -> Self + Copy,
                ) -> #twin {
                    #name {
                        #(
                            #names: #p::Type::from_lanes(
                                m,
                                #[inline(always)] |lane| f(lane).#names
                            ),
                        )*
                    }
                }

                #[inline(always)]
                fn lane<__M: #p::LaneMachine>(v: &#twin, lane: usize) -> Self {
                    Self { #(#names: #p::Type::lane(&v.#names, lane),)* }
                }

                #bytes
            }
        }
    }

    /// Returns the functions that write a host value to bytes, and read one.
    fn bytes(&self) -> TokenStream {
        let (p, names) = (private(), self.names());
        let offsets: Vec<_> =
            (0..names.len()).map(|i| quote!(Self::__PLACES.offsets[#i])).collect();
        quote! {
            fn write(&self, out: &mut [u8]) {
                #(#p::Type::write(&self.#names, &mut out[#offsets..]);)*
            }

            fn read(bytes: &[u8]) -> Self {
                Self { #(#names: #p::Type::read(&bytes[#offsets..]),)* }
            }
        }
    }
}
