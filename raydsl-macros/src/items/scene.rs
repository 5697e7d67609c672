//! Expansion of `#[derive(RayQuery)]` and `#[derive(Scene)]`: a struct of scenes as one scene, with
//! tables.

use proc_macro2::{Ident, TokenStream};
use quote::{ToTokens, format_ident, quote, quote_spanned};
use syn::spanned::Spanned;

use crate::diag::Errors;
use crate::here::private;

/// Expands a struct whose members are scenes and tables: the queries, and with `shaded` the points
/// that rays hit.
pub(crate) fn scene(item: &syn::DeriveInput, shaded: bool) -> TokenStream {
    let mut errors = Errors::default();
    let (scenes, tables) = members(item, &mut errors);
    if !errors.is_empty() {
        return errors.into_tokens();
    }
    let scene = Struct { item, scenes, tables };
    let tables = scene.tables();
    let queries = scene.queries();
    let capture = scene.capture();
    let shading = shaded.then(|| scene.shading());
    let errors = errors.into_tokens();
    quote!(#tables #queries #capture #shading #errors)
}

struct Member {
    vis: syn::Visibility,
    name: Ident,
    ty: syn::Type,
}

/// Returns the members that are scenes, and those that are tables.
fn members(item: &syn::DeriveInput, errors: &mut Errors) -> (Vec<Member>, Vec<Member>) {
    let (mut scenes, mut tables) = (Vec::new(), Vec::new());
    let syn::Data::Struct(s) = &item.data else {
        errors.at(
            item.ident.span(),
            "a scene of several scenes is a struct",
            "write a struct with a member for each scene; what a ray hits is in one of them",
        );
        return (scenes, tables);
    };
    for f in &s.fields {
        let Some(name) = f.ident.clone() else { continue };
        let is_table = f.attrs.iter().any(|a| a.path().is_ident("table"));
        let member = Member { vis: f.vis.clone(), name, ty: f.ty.clone() };
        if is_table { tables.push(member) } else { scenes.push(member) }
    }
    if scenes.is_empty() {
        errors.at(
            item.ident.span(),
            "a scene has named members, one of them a scene",
            "write `struct Both<'a> { spheres: Bvh<'a, Ball>, mesh: Bvh<'a, Triangle> }`",
        );
    }
    for param in item.generics.type_params() {
        errors.at(
            param.ident.span(),
            "a struct of scenes has no type parameters",
            "write the types of its scenes",
        );
    }
    for param in item.generics.const_params().filter(|_| !tables.is_empty()) {
        errors.at(
            param.ident.span(),
            "a struct of scenes with tables has no constant parameters",
            "write the numbers",
        );
    }
    for Member { ty, .. } in scenes.iter().chain(&tables) {
        match ty {
            syn::Type::Slice(_) => {
                errors.at(
                    ty.span(),
                    "a member is a scene or a table of its own",
                    "write `&'a [P]`",
                );
            }
            syn::Type::TraitObject(_) => errors.at(
                ty.span(),
                "a member of any type is no scene or table that a kernel can read",
                "write the type itself",
            ),
            _ => {}
        }
    }
    (scenes, tables)
}

struct Struct<'a> {
    item: &'a syn::DeriveInput,
    scenes: Vec<Member>,
    tables: Vec<Member>,
}

impl Struct<'_> {
    /// Returns the struct's generic parameters as declared, as arguments, and their clause.
    fn generics(&self) -> (TokenStream, TokenStream, TokenStream) {
        let (declared, used, clause) = self.item.generics.split_for_impl();
        (declared.into_token_stream(), used.into_token_stream(), clause.into_token_stream())
    }

    /// Returns the struct's generic parameters as an `impl` declares them, without defaults.
    fn declared(&self) -> Vec<syn::GenericParam> {
        let mut all: Vec<_> = self.item.generics.params.iter().cloned().collect();
        for param in &mut all {
            if let syn::GenericParam::Const(param) = param {
                param.default = None;
            }
        }
        all
    }

    /// Returns the name of the struct of the views of all tables.
    fn tables_name(&self) -> Ident {
        format_ident!("__{}Tables", self.item.ident)
    }

    /// Returns the type of the view, as seen for this lifetime: that of the last scene, joined with
    /// the others one after another, and the tables.
    fn view(&self, lifetime: &syn::Lifetime) -> TokenStream {
        let p = private();
        let mut views = self.scenes.iter().rev().map(|Member { ty, .. }| {
            let ty = lent(ty, lifetime);
            quote!(<#ty as #p::RecordQuery>::View<#lifetime>)
        });
        let last = views.next().unwrap_or_default();
        let scenes = views.fold(last, |rest, view| quote!(#p::Joined<#view, #rest>));
        if self.tables.is_empty() {
            return scenes;
        }
        let tables = self.tables_name();
        quote!(#p::Tabled<#scenes, #tables<#lifetime>>)
    }

    /// Emits the struct of the views of all tables, through which kernels read them by name.
    fn tables(&self) -> Option<TokenStream> {
        if self.tables.is_empty() {
            return None;
        }
        let (p, name, vis) = (private(), self.tables_name(), &self.item.vis);
        let lifetime: syn::Lifetime = syn::parse_quote!('__v);
        let members = self.tables.iter().map(|Member { vis, name, ty }| {
            let ty = lent(ty, &lifetime);
            quote_spanned!(ty.span()=> #vis #name: <#ty as #p::Table>::View<'__v>)
        });
        let names = self.tables.iter().map(|member| &member.name);
        let all: Vec<_> = names.clone().collect();
        Some(quote! {
            #[doc(hidden)]
            #[derive(Clone, Copy)]
            #vis struct #name<'__v> {
                #(#members,)*
            }

            impl #p::TableView for #name<'_> {
                fn resources(&self, visit: &mut dyn ::core::ops::FnMut(&dyn #p::Resource)) {
                    #(#p::TableView::resources(&self.#names, visit);)*
                }

                fn is_same(&self, other: &Self) -> bool {
                    true #(&& #p::TableView::is_same(&self.#all, &other.#all))*
                }
            }
        })
    }

    fn queries(&self) -> TokenStream {
        let (p, name) = (private(), &self.item.ident);
        let (declared, used, clause) = self.generics();
        let view = self.view(&syn::parse_quote!('__v));
        let first = self.scenes.first().map(|member| &member.ty);
        let mut views = self.scenes.iter().rev().map(|Member { name, .. }| {
            let text = name.to_string();
            quote!(#p::RayQueryOn::named(#p::RecordQuery::view(&self.#name), #text))
        });
        let last = views.next().unwrap_or_default();
        let mut made = views.fold(last, |rest, view| quote!(#p::Joined::new(#view, #rest)));
        if !self.tables.is_empty() {
            let (tables, names) = (self.tables_name(), self.tables.iter().map(|t| &t.name));
            let texts = names.clone().map(Ident::to_string);
            let views = names
                .zip(texts)
                .map(|(name, text)| quote!(#name: #p::Table::view(&self.#name, #text)));
            made = quote!(#p::Tabled::new(#made, #tables { #(#views,)* }));
        }
        quote! {
            impl #declared #p::RecordQuery for #name #used #clause {
                type Hit = <#first as #p::RecordQuery>::Hit;
                type View<'__v>
                    = #view
                where
                    Self: '__v;

                #[inline(always)]
                fn view(&self) -> Self::View<'_> {
                    #made
                }
            }
        }
    }

    /// Emits what lets kernels capture the struct, and take it as `&T`.
    fn capture(&self) -> TokenStream {
        let (p, name) = (private(), &self.item.ident);
        let (_, used, clause) = self.generics();
        let params = self.declared();
        let view = self.view(&syn::parse_quote!('__v));
        quote! {
            #[diagnostic::do_not_recommend]
            impl<#(#params,)* __M: #p::Machine> #p::Capture<__M> for #name #used #clause {
                type On<'__v>
                    = <Self as #p::RecordQuery>::View<'__v>
                where
                    Self: '__v;

                #[inline(always)]
                fn capture<'__v>(&'__v self, _: &__M, _: &'static str) -> Self::On<'__v> {
                    #p::RecordQuery::view(self)
                }

                #[inline(always)]
                fn constant<'__v>(&'__v self, _: &__M) -> Self::On<'__v> {
                    #p::RecordQuery::view(self)
                }

                fn resources(
                    &self,
                    _: &'static str,
                    visit: &mut dyn ::core::ops::FnMut(&dyn #p::Resource),
                ) {
                    #p::RayQueryOn::resources(&#p::RecordQuery::view(self), visit);
                }
            }

            impl<#(#params,)*> #p::Parameter for #name #used #clause {
                type On<'__v, __M: #p::Machine> = #view;
            }
        }
    }

    fn shading(&self) -> TokenStream {
        let (p, name) = (private(), &self.item.ident);
        let (declared, used, clause) = self.generics();
        quote! {
            impl #declared #p::Scene for #name #used #clause {
                #[inline(always)]
                fn asked_on<__M: #p::Machine, __A: #p::Asked>(
                    m: &__M,
                    scene: &Self,
                    ray: #p::RayOn<__M>,
                    hit: #p::HitOn<__M>,
                ) -> __A::On<__M> {
                    #p::Scene::asked_on::<__M, __A>(m, &#p::RecordQuery::view(scene), ray, hit)
                }
            }
        }
    }
}

/// Returns a member's type with `lifetime` in the place of all its lifetimes.
fn lent(ty: &syn::Type, lifetime: &syn::Lifetime) -> TokenStream {
    fn replaced(tokens: TokenStream, lifetime: &syn::Lifetime) -> TokenStream {
        let mut out = TokenStream::new();
        let mut tokens = tokens.into_iter();
        while let Some(token) = tokens.next() {
            match token {
                proc_macro2::TokenTree::Punct(quote) if quote.as_char() == '\'' => {
                    tokens.next();
                    lifetime.to_tokens(&mut out);
                }
                proc_macro2::TokenTree::Group(group) => {
                    let inside = replaced(group.stream(), lifetime);
                    out.extend([proc_macro2::TokenTree::from(proc_macro2::Group::new(
                        group.delimiter(),
                        inside,
                    ))]);
                }
                token => out.extend([token]),
            }
        }
        out
    }
    replaced(ty.to_token_stream(), lifetime)
}
