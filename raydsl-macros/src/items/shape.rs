//! Expansion of `#[primitive(sphere(center, radius))] struct T`: a primitive of a shape of the
//! library.

use proc_macro2::{Delimiter, Group, Ident, TokenStream, TokenTree};
use quote::{ToTokens, quote};
use syn::parse::{Parse, ParseStream};
use syn::punctuated::Punctuated;

use crate::diag::Errors;

/// The shapes and their parameters. Each is a module of `raydsl::geometry`.
const SHAPES: &[(&str, &[&str])] = &[
    ("sphere", &["center", "radius"]),
    ("triangle", &["v0", "v1", "v2"]),
    ("quad", &["v0", "v1", "v2", "v3"]),
    ("rectangle", &["corner", "u_edge", "v_edge"]),
    ("disk", &["center", "normal", "radius"]),
    ("plane", &["normal", "offset"]),
    ("cylinder", &["p0", "p1", "radius"]),
    ("tube", &["p0", "p1", "radius"]),
    ("cone", &["base", "apex", "radius"]),
    ("cuboid", &["min", "max"]),
];

/// Other names of shapes, and what makes the shape one of that name.
const OTHER_NAMES: &[(&str, &str, &str)] = &[
    ("circle", "disk", "it has the points inside too"),
    ("cube", "cuboid", "its edges are parallel to the axes"),
    ("parallelogram", "rectangle", "its edges may meet at any angle"),
];

/// Returns what to write instead of a shape of this name.
fn instead_of(name: &Ident) -> String {
    let other = OTHER_NAMES.iter().find(|other| name == other.0);
    let parts = |shape: &str| SHAPES.iter().find(|s| s.0 == shape).map(|s| s.1.join(", "));
    if let Some((_, shape, why)) = other
        && let Some(parts) = parts(shape)
    {
        return format!("write `{shape}({parts})`: {why}");
    }
    let names: Vec<String> = SHAPES.iter().map(|s| format!("`{}`", s.0)).collect();
    format!("write {}, or an impl of your own", names.join(", "))
}

/// A shape with its arguments, such as `sphere(center, radius.to_f32())`.
pub(crate) struct Shape {
    name: Ident,
    arguments: Punctuated<syn::Expr, syn::Token![,]>,
}

impl Parse for Shape {
    fn parse(input: ParseStream<'_>) -> syn::Result<Self> {
        let name = input.parse()?;
        let inner;
        syn::parenthesized!(inner in input);
        let arguments = Punctuated::parse_terminated(&inner)?;
        if input.is_empty() { Ok(Self { name, arguments }) } else { Err(input.error("one shape")) }
    }
}

impl Shape {
    /// Parses the shape in the parentheses of the attribute.
    pub(crate) fn of(args: TokenStream, errors: &mut Errors) -> Option<Self> {
        let help = "write for example `#[primitive(sphere(center, radius))]`, or `#[primitive]` \
                    and an impl of your own";
        match syn::parse2::<Self>(args) {
            Ok(shape) => shape.checked(errors),
            Err(e) => {
                errors.at(e.span(), "`#[primitive]` takes a shape, or nothing", help);
                None
            }
        }
    }

    fn checked(self, errors: &mut Errors) -> Option<Self> {
        let Some((name, parts)) = SHAPES.iter().find(|s| self.name == s.0) else {
            let what = format!("no shape is called `{}`", self.name);
            errors.at(self.name.span(), what, &instead_of(&self.name));
            return None;
        };
        if self.arguments.len() != parts.len() {
            errors.at(
                self.name.span(),
                format!("a {name} is made of {} parts", parts.len()),
                &format!("write `{name}({})`, with members of the struct", parts.join(", ")),
            );
            return None;
        }
        Some(self)
    }

    /// Returns the `impl` that a user would write.
    fn implementation(&self, ty: &Ident, members: &[&Ident]) -> syn::ItemImpl {
        let shape = &self.name;
        let shape = quote!(::raydsl::geometry::#shape);
        let arguments = of_self(self.arguments.to_token_stream(), members);
        let (hits, surface) = (hits(&shape, &arguments), surface(&shape, &arguments));
        let boxes = boxes(&shape, &arguments);
        // A hundred operations or so, without a loop.
        let short = ["triangle", "sphere", "disk", "rectangle", "plane", "cuboid"];
        let is_short = short.iter().any(|name| self.name == name);
        let is_short = is_short.then(|| {
            quote!(
                const IS_SHORT: bool = true;
            )
        });
        syn::parse_quote! {
            #[allow(dead_code, reason = "not every program asks all of a shape")]
            impl #ty {
                const SLACK: f32 = #shape::SLACK;
                const MAX_CROSSINGS: u32 = #shape::MAX_CROSSINGS;
                #is_short

                #hits
                #surface
                #boxes
            }
        }
    }
}

/// Returns the functions that intersect a shape and compute its surface points.
fn hits(shape: &TokenStream, arguments: &TokenStream) -> TokenStream {
    quote! {
        #[doc = "Where `ray` meets it."]
        #[inline]
        pub fn intersect(&self, ray: ::raydsl::geometry::Ray) -> ::raydsl::geometry::Hit {
            #shape::intersect(ray, #arguments)
        }

        #[doc = "The normal where `ray` hits it, with unit length."]
        pub fn normal(
            &self,
            ray: ::raydsl::geometry::Ray,
            hit: ::raydsl::geometry::Hit,
        ) -> ::raydsl::prelude::Vec3 {
            #shape::normal(ray, hit, #arguments)
        }

        #[doc = "Surface coordinates where `ray` hits it, from 0 to 1."]
        pub fn uv(
            &self,
            ray: ::raydsl::geometry::Ray,
            hit: ::raydsl::geometry::Hit,
        ) -> ::raydsl::prelude::Vec2 {
            #shape::uv(ray, hit, #arguments)
        }

        #[doc = "The point that `ray` hits, for rays that begin there."]
        pub fn surface_point(
            &self,
            ray: ::raydsl::geometry::Ray,
            hit: ::raydsl::geometry::Hit,
        ) -> ::raydsl::geometry::SurfacePoint {
            #shape::surface_point(ray, hit, #arguments)
        }
    }
}

/// Returns the functions for the area of a shape and for points on it.
fn surface(shape: &TokenStream, arguments: &TokenStream) -> TokenStream {
    quote! {
        #[doc = "The area of its surface."]
        pub fn area(&self) -> f32 {
            #shape::area(#arguments)
        }

        #[doc = "A point of its surface; a uniform `u` in the unit square gives a uniform one."]
        pub fn sample(&self, u: ::raydsl::prelude::Vec2) -> ::raydsl::geometry::SurfacePoint {
            #shape::sample(u, #arguments)
        }
    }
}

/// Returns the functions for the bounding boxes of a shape and of its parts.
fn boxes(shape: &TokenStream, arguments: &TokenStream) -> TokenStream {
    quote! {
        #[doc = "A box around it."]
        pub fn get_bounds(&self) -> ::raydsl::geometry::Aabb {
            #shape::get_bounds(#arguments)
        }

        #[doc = "Boxes around its parts below and above a plane."]
        pub fn split_primitive(
            &self,
            axis: usize,
            at: f32,
        ) -> (::raydsl::geometry::Aabb, ::raydsl::geometry::Aabb) {
            #shape::split_primitive(axis, at, #arguments)
        }
    }
}

/// Returns `self.radius` in place of the member `radius`.
fn of_self(tokens: TokenStream, members: &[&Ident]) -> TokenStream {
    let mut out = TokenStream::new();
    let mut is_member = false;
    let mut tokens = tokens.into_iter().peekable();
    while let Some(token) = tokens.next() {
        // A name before parentheses or `::` is that of a function or a type.
        let is_called = match tokens.peek() {
            Some(TokenTree::Group(g)) => g.delimiter() == Delimiter::Parenthesis,
            Some(TokenTree::Punct(p)) => p.as_char() == ':',
            _ => false,
        };
        match token {
            TokenTree::Ident(name) if !is_member && !is_called && members.contains(&&name) => {
                out.extend(quote!(self.#name));
                is_member = false;
                continue;
            }
            TokenTree::Group(g) => {
                let mut inner = Group::new(g.delimiter(), of_self(g.stream(), members));
                inner.set_span(g.span());
                out.extend([TokenTree::Group(inner)]);
                is_member = false;
                continue;
            }
            _ => {}
        }
        is_member = matches!(&token, TokenTree::Punct(p) if matches!(p.as_char(), '.' | ':'));
        out.extend([token]);
    }
    out
}

/// Expands the struct of a primitive of this shape.
pub(crate) fn with_shape(shape: &Shape, item: &syn::DeriveInput) -> TokenStream {
    let members: Vec<&Ident> = match &item.data {
        syn::Data::Struct(s) => s.fields.iter().filter_map(|f| f.ident.as_ref()).collect(),
        _ => Vec::new(),
    };
    let implementation = shape.implementation(&item.ident, &members);
    super::primitive_impl(&implementation)
}
