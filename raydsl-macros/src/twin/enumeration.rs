//! The twin of an enum without fields: the discriminant of its variant.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::shared::{kernel_type, kinds, methods};
use crate::diag::Errors;
use crate::generics::Generics;
use crate::here::private;

/// Returns the names of the variants.
pub(super) fn variants(e: &syn::DataEnum, errors: &mut Errors) -> Vec<Ident> {
    if e.variants.len() < 2 {
        errors.at(
            e.brace_token.span.join(),
            "an enum of the kernel language has two kinds or more",
            "leave it out: it says nothing",
        );
    }
    e.variants.iter().map(|v| v.ident.clone()).collect()
}

/// Returns the twin and the implementations that connect it with the host's type.
pub(super) fn twin(item: &syn::DeriveInput, variants: &[Ident]) -> TokenStream {
    let name = &item.ident;
    let enumeration = Enumeration { item, twin: format_ident!("{name}On"), variants };
    let twin = &enumeration.twin;
    let parts = [
        enumeration.fits(),
        enumeration.declaration(),
        enumeration.of_number(),
        enumeration.tests(),
        enumeration.value_impl(),
        methods(&quote!(#twin<__M>), &quote!(#name), &Generics::default()),
        enumeration.operations(),
        enumeration.type_impl(),
        capture(name, twin),
    ];
    quote!(#(#parts)*)
}

struct Enumeration<'a> {
    item: &'a syn::DeriveInput,
    /// The twin's name.
    twin: Ident,
    variants: &'a [Ident],
}

impl Enumeration<'_> {
    fn first_and_others(&self) -> (&Ident, &[Ident]) {
        self.variants.split_first().expect("there is a variant")
    }

    /// Returns an assertion that the discriminants fit in the numbers of kernels.
    fn fits(&self) -> TokenStream {
        let (name, variants) = (&self.item.ident, self.variants);
        quote! {
            const _: () = {
                #(::core::assert!(
                    #name::#variants as i128 >= 0 && #name::#variants as i128 <= u32::MAX as i128,
                    ::core::concat!(
                        "the kind `", ::core::stringify!(#variants), "` of `", ::core::stringify!(#name),
                        "` has a number that a kernel's `u32` does not have",
                    ),
                );)*
            };
        }
    }

    /// Returns the twin, which is `Copy`.
    fn declaration(&self) -> TokenStream {
        let (p, twin, vis) = (private(), &self.twin, &self.item.vis);
        let doc = format!("[`{}`] on a machine: the number of its variant.", self.item.ident);
        quote! {
            #[doc = #doc]
            #vis struct #twin<__M: #p::Machine> {
                number: <u32 as #p::Type>::On<__M>,
            }

            impl<__M: #p::Machine> Clone for #twin<__M> {
                #[inline(always)]
                fn clone(&self) -> Self {
                    *self
                }
            }

            impl<__M: #p::Machine> Copy for #twin<__M> {}
        }
    }

    /// Returns the methods of values for variants in patterns of kernels.
    fn tests(&self) -> TokenStream {
        let (p, name, twin, variants) = (private(), &self.item.ident, &self.twin, self.variants);
        let (count, kinds) = (variants.len() as u32, kinds());
        let tests = variants.iter().map(|v| format_ident!("__is_{v}_on"));
        quote! {
            #[doc(hidden)]
            #[allow(non_snake_case, dead_code, reason = "named as the variants")]
            impl<__M: #p::Machine> #twin<__M> {
                #[inline(always)]
                pub fn #kinds(self) -> Self {
                    self
                }

                #(
                    #[inline(always)]
                    pub fn #tests(self, m: &__M) -> #p::B<__M> {
                        #p::is_kind(m, self.number, #name::#variants as u32, #count)
                    }
                )*
            }
        }
    }

    fn of_number(&self) -> TokenStream {
        let (name, (first, others)) = (&self.item.ident, self.first_and_others());
        quote! {
            impl #name {
                /// The variant of a number; the first one for numbers that no variant has.
                fn __of_number(number: u32) -> Self {
                    #(if number == Self::#others as u32 { return Self::#others; })*
                    Self::#first
                }
            }
        }
    }

    /// Returns the implementation of the twin as a value of a machine.
    fn value_impl(&self) -> TokenStream {
        let (p, name, twin) = (private(), &self.item.ident, &self.twin);
        let (first, _) = self.first_and_others();
        quote! {
            impl<__M: #p::Machine> #p::Value<__M> for #twin<__M> {
                const SCHEMA: &'static #p::Schema = <#name as #p::Type>::SCHEMA;

                #[inline(always)]
                fn zero(m: &__M) -> Self {
                    #p::Type::splat(m, #name::#first)
                }

                #[inline(always)]
                fn zip(m: &__M, a: Self, b: Self, f: &mut impl #p::Leaves<__M>) -> Self {
                    Self { number: #p::Value::zip(m, a.number, b.number, f) }
                }
            }
        }
    }

    /// Returns comparisons, and casts to integer types.
    fn operations(&self) -> TokenStream {
        let (p, twin) = (private(), &self.twin);
        let integers = [quote!(u32), quote!(i32), quote!(usize)];
        quote! {
            impl<__M: #p::Machine> #p::OpCompare<__M, Self> for #twin<__M> {
                type Output = <bool as #p::Type>::On<__M>;

                #[inline(always)]
                fn compare<__O: #p::Op<#p::Compare>>(
                    m: &__M,
                    op: __O,
                    a: Self,
                    b: Self
                ) -> Self::Output {
                    #p::OpCompare::compare(m, op, a.number, b.number)
                }
            }

            #(
                impl<__M: #p::Machine> #p::OpCast<__M, #integers> for #twin<__M> {
                    #[inline(always)]
                    fn cast(m: &__M, a: Self) -> <#integers as #p::Type>::On<__M> {
                        #p::cast::<_, _, #integers>(m, a.number)
                    }
                }
            )*
        }
    }

    /// Returns the implementation of the enum as a type of kernels.
    fn type_impl(&self) -> TokenStream {
        let (p, name, twin, variants) = (private(), &self.item.ident, &self.twin, self.variants);
        let (count, numbers) = (variants.len() as u32, 0u32..);
        let kernel_type = kernel_type(&quote!(#name), &Generics::default());
        quote! {
            #kernel_type

            impl #p::Type for #name {
                type On<__M: #p::Machine> = #twin<__M>;

                const SCHEMA: &'static #p::Schema = {
                    let is_counted = true #(&& Self::#variants as u32 == #numbers)*;
                    #p::number_schema::<#count>(::core::mem::size_of::<Self>(), is_counted)
                };

                #[inline(always)]
                fn splat<__M: #p::Machine>(m: &__M, v: Self) -> #twin<__M> {
                    #twin { number: <u32 as #p::Type>::splat(m, v as u32) }
                }

                #[inline(always)]
                fn from_lanes<__M: #p::LaneMachine>(
                    m: &__M,
                    f: impl Fn(usize) -> Self + Copy
                ) -> #twin<__M> {
                    #twin {
                        number: <u32 as #p::Type>::from_lanes(
                            m,
                            #[inline(always)] |lane| f(lane) as u32
                        )
                    }
                }

                #[inline(always)]
                fn lane<__M: #p::LaneMachine>(v: &#twin<__M>, lane: usize) -> Self {
                    Self::__of_number(<u32 as #p::Type>::lane(&v.number, lane))
                }

                fn write(&self, out: &mut [u8]) {
                    #p::write_number(*self as u32, ::core::mem::size_of::<Self>(), out);
                }

                fn read(bytes: &[u8]) -> Self {
                    Self::__of_number(#p::read_number(::core::mem::size_of::<Self>(), bytes))
                }
            }
        }
    }
}

/// Returns the implementation of the capture of a host value.
fn capture(name: &Ident, twin: &Ident) -> TokenStream {
    let p = private();
    quote! {
        /// A captured variant is known while the kernel is recorded: a `match` on it is decided.
        #[diagnostic::do_not_recommend]
        impl<__M: #p::Machine> #p::Capture<__M> for #name {
            type On<'c> = #twin<__M>;

            #[inline(always)]
            fn capture(&self, m: &__M, _: &'static str) -> #twin<__M> {
                #p::Type::splat(m, *self)
            }

            #[inline(always)]
            fn constant(&self, m: &__M) -> #twin<__M> {
                #p::Type::splat(m, *self)
            }

            fn resources(
                &self,
                _: &'static str,
                visit: &mut dyn ::core::ops::FnMut(&dyn #p::Resource),
            ) {
                #p::visit_known(*self, visit);
            }
        }
    }
}
