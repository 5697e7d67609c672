//! Expansion of `#[primitive(normal, area)] enum T`: methods of the enum that call those of its
//! kinds.

use proc_macro2::{Ident, Span, TokenStream};
use quote::{quote, quote_spanned};
use syn::parse::Parser as _;
use syn::punctuated::Punctuated;

use super::kernel_impl;
use crate::diag::Errors;
use crate::here::{At, in_one_place};

/// The methods of shapes that an enum can forward.
const METHODS: [&str; 5] = ["surface_point", "normal", "uv", "area", "sample"];

/// The trait that an enum can forward, and its functions.
const SURFACE: &str = "Surface";
const OF_SURFACE: [&str; 5] = ["surface", "albedo", "uv", "material", "crossing"];

/// A variant of the enum: its name, and the type of its primitive.
type Variant<'a> = (&'a Ident, &'a syn::Type);

/// Returns the methods that the attribute names.
pub(crate) fn forwarded(
    args: TokenStream,
    item: &syn::DeriveInput,
    e: &syn::DataEnum,
) -> TokenStream {
    if args.is_empty() {
        return TokenStream::new();
    }
    let mut errors = Errors::default();
    let names = names(args, &mut errors);
    let variants: Vec<Variant<'_>> =
        e.variants.iter().flat_map(|v| v.fields.iter().map(|f| (&v.ident, &f.ty))).collect();
    let (of_trait, methods): (Vec<_>, Vec<_>) = names.into_iter().partition(|n| n == SURFACE);
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

/// Returns the names in the parentheses of the attribute.
fn names(args: TokenStream, errors: &mut Errors) -> Vec<Ident> {
    let all: Vec<String> =
        METHODS.iter().chain([&SURFACE]).map(|name| format!("`{name}`")).collect();
    let help = format!("write some of {}, or nothing", all.join(", "));
    let parser = Punctuated::<Ident, syn::Token![,]>::parse_terminated;
    let written = match parser.parse2(args) {
        Ok(names) => names,
        Err(e) => {
            let what = "`#[primitive]` on an enum takes names of methods that all its kinds have";
            errors.at(e.span(), what, &help);
            return Vec::new();
        }
    };
    let mut names: Vec<Ident> = Vec::new();
    for name in written {
        if name != SURFACE && !METHODS.iter().any(|m| name == m) {
            let what = format!("an enum of primitives cannot forward `{name}`");
            errors.at(name.span(), what, &help);
        } else if names.contains(&name) {
            errors.at(name.span(), format!("`{name}` is there twice"), "leave one of them out");
        } else {
            names.push(name);
        }
    }
    names
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
    let arms = variants.iter().map(|(variant, kind)| {
        in_one_place(quote!(Self::#variant(kind) => <#kind>::#name(kind, #args)))
    });
    quote_spanned! {span=>
        #[doc = #doc]
        #vis fn #name(&self, #params) -> #result {
            use ::raydsl::__private::Lacking as _;
            match self {
                #(#arms,)*
            }
        }
    }
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
