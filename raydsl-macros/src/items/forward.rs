//! Arguments of `#[primitive(normal, area)] enum T`, and methods of the enum that call those of its
//! kinds.

use proc_macro2::{Ident, Span, TokenStream};
use quote::{quote, quote_spanned};
use syn::parse::Parser as _;
use syn::punctuated::Punctuated;
use syn::spanned::Spanned as _;

use super::kernel_impl;
use crate::diag::Errors;
use crate::here::{At, in_one_place};

/// The methods of shapes that an enum can forward.
const METHODS: [&str; 5] = ["surface_point", "normal", "uv", "area", "sample"];

/// The trait that an enum can forward, and its functions.
const SURFACE: &str = "Surface";
const OF_SURFACE: [&str; 5] = ["surface", "albedo", "uv", "material", "crossing"];

/// The argument with the types that kinds share.
const SHARED: &str = "shared";

/// A variant of the enum: its name, and the type of its primitive.
type Variant<'a> = (&'a Ident, &'a syn::Type);

/// The largest number of types that kinds of an enum may share.
const MOST_SHARED: usize = 3;

/// What stands in the parentheses of the attribute on an enum.
pub(crate) struct EnumArguments {
    /// The methods and traits to forward.
    forwarded: Vec<Ident>,
    /// The types of `shared(A, B)`: none if the kinds share one type of data or none.
    pub(crate) shared: Vec<syn::Type>,
}

/// One of the arguments.
enum Argument {
    Forwarded(Ident),
    Shared(Ident, Vec<syn::Type>),
}

impl syn::parse::Parse for Argument {
    fn parse(input: syn::parse::ParseStream<'_>) -> syn::Result<Self> {
        let name: Ident = input.parse()?;
        if name != SHARED || !input.peek(syn::token::Paren) {
            return Ok(Self::Forwarded(name));
        }
        let types;
        syn::parenthesized!(types in input);
        let types = Punctuated::<syn::Type, syn::Token![,]>::parse_terminated(&types)?;
        Ok(Self::Shared(name, types.into_iter().collect()))
    }
}

impl EnumArguments {
    /// Reads the arguments.
    pub(crate) fn of(args: TokenStream, errors: &mut Errors) -> Self {
        let (mut forwarded, mut shared) = (Vec::new(), Vec::new());
        let all: Vec<String> =
            METHODS.iter().chain([&SURFACE]).map(|name| format!("`{name}`")).collect();
        let help = format!("write some of {}, or nothing", all.join(", "));
        let written = match Punctuated::<Argument, syn::Token![,]>::parse_terminated.parse2(args) {
            Ok(written) => written,
            Err(e) => {
                let what =
                    "`#[primitive]` on an enum takes names of methods that all its kinds have";
                errors.at(e.span(), what, &help);
                Punctuated::new()
            }
        };
        for argument in written {
            match argument {
                Argument::Shared(name, types) if shared.is_empty() => {
                    shared = checked_types(&name, types, errors);
                }
                Argument::Shared(name, _) => {
                    errors.at(name.span(), "`shared` is there twice", "write all types into one");
                }
                Argument::Forwarded(name) if name == SHARED => {
                    let what = "`shared` names the types of data that the kinds share";
                    errors.at(name.span(), what, "write `shared(A, B)`");
                }
                Argument::Forwarded(name)
                    if name != SURFACE && !METHODS.iter().any(|m| name == m) =>
                {
                    let what = format!("an enum of primitives cannot forward `{name}`");
                    errors.at(name.span(), what, &help);
                }
                Argument::Forwarded(name) if forwarded.contains(&name) => {
                    errors.at(
                        name.span(),
                        format!("`{name}` is there twice"),
                        "leave one of them out",
                    );
                }
                Argument::Forwarded(name) => forwarded.push(name),
            }
        }
        Self { forwarded, shared }
    }
}

/// Returns the types in `shared(..)`, each once and at most three, or none if they are no list.
fn checked_types(name: &Ident, types: Vec<syn::Type>, errors: &mut Errors) -> Vec<syn::Type> {
    let text = |ty: &syn::Type| quote!(#ty).to_string();
    let mut once: Vec<syn::Type> = Vec::new();
    for ty in &types {
        if once.iter().any(|before| text(before) == text(ty)) {
            let what = format!("`{}` is there twice", text(ty));
            errors.at(
                ty.span(),
                what,
                "kinds that share the same type share one slice: name it once",
            );
        } else {
            once.push(ty.clone());
        }
    }
    if types.len() < 2 {
        let what = "`shared` names the types of an enum whose kinds share different data";
        errors.at(name.span(), what, "write `shared(A, B)`, or nothing if there is one type");
        return Vec::new();
    }
    if once.len() > MOST_SHARED {
        let what = format!("the kinds of an enum share at most {MOST_SHARED} types of data");
        let help = "put some kinds into a tree of their own, and the trees into a struct of scenes: \
                    `#[derive(RayQuery)] struct Scenes<'a> { .. }`";
        errors.at(once[MOST_SHARED].span(), what, help);
        once.truncate(MOST_SHARED);
    }
    if once.len() < 2 { Vec::new() } else { once }
}

/// Returns the methods that the attribute names.
pub(crate) fn forwarded(
    arguments: &EnumArguments,
    item: &syn::DeriveInput,
    e: &syn::DataEnum,
) -> TokenStream {
    let names = &arguments.forwarded;
    if names.is_empty() {
        return TokenStream::new();
    }
    let mut errors = Errors::default();
    let variants: Vec<Variant<'_>> =
        e.variants.iter().flat_map(|v| v.fields.iter().map(|f| (&v.ident, &f.ty))).collect();
    let (of_trait, methods): (Vec<_>, Vec<_>) = names.iter().partition(|n| *n == SURFACE);
    let methods = methods.iter().map(|name| method(name, &item.vis, &variants));
    let of_trait = of_trait.iter().map(|name| surface(name, item, &variants));
    let ty = &item.ident;
    let own = syn::parse_quote! {
        #[allow(dead_code, unused_imports, reason = "not every program asks all of a kind")]
        impl #ty {
            #(#methods)*
        }
    };
    let impls = [own].into_iter().chain(of_trait);
    let lifted: TokenStream = impls.map(|i| kernel_impl(&i, &[], &mut errors)).collect();
    let errors = errors.into_tokens();
    quote!(#lifted #errors)
}

/// The parameters and the result of a function, its arguments, and what it returns in words.
struct Form {
    params: TokenStream,
    args: TokenStream,
    result: TokenStream,
    doc: &'static str,
}

impl Form {
    fn of(function: &str, span: Span) -> Self {
        let (ray, hit) = (quote!(::raydsl::geometry::Ray), quote!(::raydsl::geometry::Hit));
        let (vec2, vec3) = (quote!(::raydsl::prelude::Vec2), quote!(::raydsl::prelude::Vec3));
        let point = quote!(::raydsl::geometry::SurfacePoint);
        let (result, doc) = match function {
            "surface_point" | "surface" => {
                (point.clone(), "The point that `ray` hits, for rays that begin there.")
            }
            "normal" => (vec3, "The normal where `ray` hits it, with unit length."),
            "uv" => (vec2.clone(), "Surface coordinates where `ray` hits it, from 0 to 1."),
            "area" => (quote!(f32), "The area of its surface."),
            "sample" => (
                point.clone(),
                "A point of its surface; a uniform `u` in the unit square gives a uniform one.",
            ),
            "albedo" => (vec3, "The albedo where `ray` hits it."),
            "material" => (quote!(u32), "The number of its material."),
            _ => (quote!(i32), "Whether `ray` enters or leaves it."),
        };
        let (params, args) = match function {
            "area" => (TokenStream::new(), TokenStream::new()),
            "sample" => (quote_spanned!(span=> u: #vec2), quote_spanned!(span=> u)),
            _ => (quote_spanned!(span=> ray: #ray, hit: #hit), quote_spanned!(span=> ray, hit)),
        };
        Self { params, args, result, doc }
    }
}

/// Returns a method that calls the one of that name of each kind.
///
/// All has the span of the name: there rustc reports a kind without the method, which has that of
/// `Lacking`.
fn method(name: &Ident, vis: &syn::Visibility, variants: &[Variant<'_>]) -> TokenStream {
    let span = name.span();
    let Form { params, args, result, doc } = Form::of(&name.to_string(), span);
    let _at = At::new(span);
    let arms = variants
        .iter()
        .map(|(variant, kind)| quote!(Self::#variant(kind) => <#kind>::#name(kind, #args)));
    in_one_place(quote_spanned! {span=>
        #[doc = #doc]
        #vis fn #name(&self, #params) -> #result {
            use ::raydsl::__private::Lacking as _;
            match self {
                #(#arms,)*
            }
        }
    })
}

/// Returns the implementation of the trait `Surface`. All has the span of the name: there rustc
/// reports a kind without one, with the same words for the source and for lifted code, so once.
fn surface(name: &Ident, item: &syn::DeriveInput, variants: &[Variant<'_>]) -> syn::ItemImpl {
    let (ty, span) = (&item.ident, name.span());
    let _at = At::new(span);
    let of_trait = quote!(::raydsl::shading::Surface);
    let functions = OF_SURFACE.iter().map(|function| {
        let Form { params, args, result, .. } = Form::of(function, span);
        let function = Ident::new(function, span);
        let arms = variants.iter().map(|(variant, kind)| {
            quote!(Self::#variant(kind) => <#kind as #of_trait>::#function(kind, #args))
        });
        quote! {
            fn #function(&self, #params) -> #result {
                match self {
                    #(#arms,)*
                }
            }
        }
    });
    let all = in_one_place(quote! {
        impl #of_trait for #ty {
            #(#functions)*
        }
    });
    syn::parse_quote!(#all)
}
