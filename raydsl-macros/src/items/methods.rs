//! Expansion of `#[kernel]` on an `impl` or a trait.

use proc_macro2::{Ident, TokenStream};
use quote::{ToTokens, format_ident, quote};
use syn::spanned::Spanned;

use super::{
    Place, asserted_type, closure_bound, head, lifted_function, operators, own, private, quiet,
    result_of,
};
use crate::diag::Errors;
use crate::emit::Emitter;
use crate::generics::Generics;
use crate::model::{Kernel, Param};
use crate::parse;
use crate::rewrite::without_markers;

/// Expands to the lifted functions of an `impl`, and the items beside it.
pub(crate) fn kernel_impl(
    item: &syn::ItemImpl,
    host_only: &[&str],
    errors: &mut Errors,
) -> TokenStream {
    if operators::is_operator(item) {
        return operators::operator_impl(item, errors);
    }
    let Some(type_name) = parse::type_name(&item.self_ty) else {
        errors.at(item.self_ty.span(), "kernels belong to a named type", "name a struct");
        return without_markers(item.to_token_stream());
    };
    let Lifted { functions, methods } = lifted_impl(item, &type_name, host_only, errors);
    let around = Generics::new(&item.generics);
    let Generics { declared, predicates, .. } = &around;
    let self_ty = &item.self_ty;
    let Some((path, _)) = &item.trait_ else {
        let asserted = asserted_type(&self_ty.to_token_stream(), &around);
        let item = without_markers(item.to_token_stream());
        return quote! {
            #item
            impl<#declared> #self_ty where #predicates #asserted { #functions }
            #methods
        };
    };
    // The lifted functions belong to the trait too.
    let attrs = &item.attrs;
    let items = item.items.iter().map(|i| without_markers(i.to_token_stream()));
    quote! {
        #(#attrs)*
        impl<#declared> #path for #self_ty where #predicates {
            #(#items)*
            #functions
        }
        #methods
    }
}

struct Lifted {
    functions: TokenStream,
    methods: TokenStream,
}

fn lifted_impl(
    item: &syn::ItemImpl,
    type_name: &str,
    host_only: &[&str],
    errors: &mut Errors,
) -> Lifted {
    let mut lifted = Lifted { functions: TokenStream::new(), methods: TokenStream::new() };
    let self_ty = item.self_ty.to_token_stream();
    let around = Generics::new(&item.generics);
    let owner = match &item.trait_ {
        Some((path, _)) => quote!(<#self_ty as #path>),
        None => quote!(<#self_ty>),
    };
    for f in functions(&item.items, host_only, errors) {
        let name = f.sig.ident.to_string();
        let kernel = parse::function(&f.attrs, &f.sig, &f.block, Some(&item.self_ty), errors);
        if item.trait_.is_none() {
            check_recursion(&kernel, errors);
        }
        let fn_name = format_ident!("{name}_on");
        let place = Place {
            fn_name: &fn_name,
            wgsl_name: &format!("{type_name}_{name}"),
            self_ty: Some(&self_ty),
            around: &around,
            vis: &f.vis.to_token_stream(),
            is_method: true,
            asserts_self: item.trait_.is_none(),
        };
        let function = lifted_function(&kernel, &place, errors);
        if kernel.is_broken {
            continue;
        }
        lifted.functions.extend(function);
        if kernel.params.first().is_some_and(|p| p.name == "self") {
            let method = Method {
                self_ty: &self_ty,
                called: quote!(#owner::#fn_name),
                name: &name,
                around: &around,
                through: item.trait_.as_ref().map(|(path, _)| path),
            };
            lifted.methods.extend(method.implementation(&kernel));
        }
    }
    lifted
}

/// Returns the functions of an `impl` that are lifted.
fn functions<'a>(
    items: &'a [syn::ImplItem],
    host_only: &[&str],
    errors: &mut Errors,
) -> Vec<&'a syn::ImplItemFn> {
    let all = items.iter().filter_map(|i| match i {
        syn::ImplItem::Fn(f) => Some(f),
        _ => None,
    });
    let lifted = all.filter(|f| !host_only.iter().any(|h| f.sig.ident == h));
    lifted.filter(|f| check(&f.sig, &f.attrs, errors)).collect()
}

/// Reports what a method of kernels cannot have; returns whether it can be lifted.
fn check(sig: &syn::Signature, attrs: &[syn::Attribute], errors: &mut Errors) -> bool {
    if let Some(cfg) = attrs.iter().find(|a| a.path().is_ident("cfg")) {
        errors.at(
            cfg.span(),
            "a method of kernels has no `#[cfg]`: its lifted form would stay",
            "put the method in an impl of its own, with the `#[cfg]` on the impl",
        );
    }
    let clause = sig.generics.where_clause.as_ref();
    let own = Generics::new(&sig.generics);
    let is_scene = |name: &Ident| own.scenes.iter().any(|(scene, _)| scene == name);
    let is_inferred = |p: &syn::GenericParam| match p {
        syn::GenericParam::Type(t) => parse::is_function(t, clause) || is_scene(&t.ident),
        p => matches!(p, syn::GenericParam::Lifetime(_)),
    };
    let can_be_lifted = sig.generics.params.iter().all(is_inferred);
    if !can_be_lifted {
        errors.at(
            sig.generics.span(),
            "a method of kernels has no type parameters of its own but scenes and closures",
            "give them to the impl or the trait, or write a `#[kernel] fn`",
        );
    }
    can_be_lifted
}

/// Reports recursion. In a trait's impl the call may be of the type's own method of that name.
fn check_recursion(kernel: &Kernel, errors: &mut Errors) {
    for span in kernel.body.calls_on_self(&kernel.name) {
        errors.at(
            span,
            format!("the method `{}` calls itself", kernel.name),
            "write a loop: a GPU has no recursion",
        );
    }
}

/// A method, for calls that only know its name.
pub(super) struct Method<'a> {
    pub(super) self_ty: &'a TokenStream,
    /// The path of the lifted function.
    pub(super) called: TokenStream,
    pub(super) name: &'a str,
    pub(super) around: &'a Generics,
    /// Its trait.
    pub(super) through: Option<&'a syn::Path>,
}

impl Method<'_> {
    fn twin(&self, ty: &TokenStream) -> TokenStream {
        let p = private();
        let ty = if ty.to_string() == "Self" { self.self_ty } else { ty };
        quote!(<#ty as #p::Type>::On<__M>)
    }

    /// Returns the type of an argument, and the generic parameter that it needs.
    fn argument(&self, i: usize, param: &Param) -> (TokenStream, Option<TokenStream>) {
        let p = private();
        let ty = &param.ty;
        if let Some(function) = &param.function {
            let (generic, twin) = (format_ident!("__A{i}"), |ty: &TokenStream| self.twin(ty));
            let (name, result) = (result_of(i), twin(&function.result));
            let bound = closure_bound(i, function, &twin);
            let generics = quote!(#generic: #bound, #name: #p::Coerce<__M, #result>);
            return (quote!(#generic), Some(generics));
        }
        if param.host {
            return (quote!(#ty), None);
        }
        if param.by_mut {
            let ty = self.twin(ty);
            return (quote!(&'__a #p::Var<#ty>), None);
        }
        if param.scene {
            let generic = format_ident!("__A{i}");
            return (quote!(#generic), Some(quote!(#generic: #p::SceneArgument)));
        }
        if param.data {
            let ty = lent(ty.clone());
            return (quote!(<#ty as #p::Parameter>::On<'__a, __M>), None);
        }
        let ty = self.twin(ty);
        let generic = format_ident!("__A{i}");
        (quote!(#generic), Some(quote!(#generic: #p::Coerce<__M, #ty>)))
    }

    /// Returns a type that distinguishes the methods of two traits. Traits of one name may be in
    /// two modules.
    fn via(&self) -> TokenStream {
        let p = private();
        let Some(path) = self.through else { return quote!(()) };
        let text = path.to_token_stream().to_string();
        quote!(#p::Through<{ #p::name(::core::concat!(::core::module_path!(), " ", #text)) }>)
    }

    pub(super) fn implementation(&self, kernel: &Kernel) -> TokenStream {
        let p = private();
        let Self { self_ty, name, around, .. } = self;
        let via = self.via();
        let Generics { declared, predicates, .. } = around;
        let (receiver, rest) = kernel.params.split_first().expect("a method has a receiver");
        let names: Vec<&Ident> = rest.iter().map(|p| &p.name).collect();
        let (arguments, generics): (Vec<_>, Vec<_>) =
            rest.iter().enumerate().map(|(i, param)| self.argument(i, param)).unzip();
        let generics = generics.into_iter().flatten();
        // What the method asks of its scenes.
        let of_scenes =
            rest.iter().enumerate().filter(|(_, param)| param.scene).map(|(i, param)| {
                let (generic, ty) = (format_ident!("__A{i}"), param.ty.to_string());
                let bounds =
                    kernel.generics.scenes.iter().find(|(name, _)| *name == ty).map(|s| &s.1);
                quote!(<#generic as #p::SceneArgument>::Scene: #bounds,)
            });
        let of_scenes: TokenStream = of_scenes.collect();
        let asserted = asserted_type(self_ty, around);
        let lifetime = rest.iter().any(|q| q.by_mut || q.data).then(|| quote!('__a,));
        let result = kernel.result.as_ref().map(|ty| self.twin(ty)).unwrap_or_else(|| quote!(()));
        let quiet = quiet();
        let of = quote!(#p::HostMethod<{ #p::name(#name) }, __M, (#(#arguments,)*), #via>);
        let argument = quote!((#(#names,)*): (#(#arguments,)*));
        let output = quote!(<Self as #of>::Output);
        let calls = if receiver.by_mut {
            self.calls_by_mut(&names, &argument, &output)
        } else {
            self.call(&names, &argument, &output)
        };
        quote! {
            #quiet
            #[diagnostic::do_not_recommend]
            impl<#lifetime #declared __M: #p::Machine, #(#generics,)*> #of for #self_ty
            where
                #predicates
                #asserted
                #of_scenes
            {
                type This = <Self as #p::Type>::On<__M>;
                type Output = #result;

                #calls
            }
        }
    }

    /// Emits the call of a method that takes `self` or `&self`.
    fn call(&self, names: &[&Ident], argument: &TokenStream, output: &TokenStream) -> TokenStream {
        let (p, m, this, called) = (private(), own("m"), own("this"), &self.called);
        quote! {
            #[inline(always)]
            fn call(#this: <Self as #p::Type>::On<__M>, #m: &__M, #argument,) -> #output {
                #called(#m, #this, #(#names),*)
            }
        }
    }

    /// Emits the calls of a method that takes `&mut self`: on a value, and on a variable.
    fn calls_by_mut(
        &self,
        names: &[&Ident],
        argument: &TokenStream,
        output: &TokenStream,
    ) -> TokenStream {
        let (p, m, called) = (private(), own("m"), &self.called);
        let (this, variable) = (own("this"), own("variable"));
        quote! {
            const IS_MUT: bool = true;

            #[inline(always)]
            fn call(#this: <Self as #p::Type>::On<__M>, #m: &__M, #argument,) -> #output {
                #called(#m, &#p::Var::new(#m, "self", #this), #(#names),*)
            }

            #[inline(always)]
            fn call_at(
                _: <Self as #p::Type>::On<__M>,
                #variable: &#p::Var<<Self as #p::Type>::On<__M>>,
                #m: &__M,
                #argument,
            ) -> #output {
                #called(#m, #variable, #(#names),*)
            }
        }
    }
}

/// Returns a type whose lifetimes are that of the call.
fn lent(ty: TokenStream) -> TokenStream {
    let Ok(mut ty) = syn::parse2::<syn::TypePath>(ty.clone()) else { return ty };
    for segment in &mut ty.path.segments {
        if let syn::PathArguments::AngleBracketed(arguments) = &mut segment.arguments {
            for arg in &mut arguments.args {
                if let syn::GenericArgument::Lifetime(lifetime) = arg {
                    *lifetime = syn::parse_quote!('__a);
                }
            }
        }
    }
    ty.into_token_stream()
}

/// Expands `#[kernel] trait`: every function gets a lifted one beside it.
pub(crate) fn kernel_trait(item: &syn::ItemTrait) -> TokenStream {
    let mut errors = Errors::default();
    let mut around = Generics::new(&item.generics);
    // Within the trait `Self` is a type parameter like others.
    around.types.push(Ident::new("Self", item.ident.span()));
    let mut functions = TokenStream::new();
    let self_ty: syn::Type = syn::parse_quote!(Self);
    for f in item.items.iter().filter_map(|i| match i {
        syn::TraitItem::Fn(f) => Some(f),
        _ => None,
    }) {
        if !check(&f.sig, &f.attrs, &mut errors) {
            continue;
        }
        let place = Place {
            fn_name: &format_ident!("{}_on", f.sig.ident),
            wgsl_name: &format!("{}_{}", item.ident, f.sig.ident),
            self_ty: None,
            around: &around,
            vis: &TokenStream::new(),
            is_method: true,
            asserts_self: false,
        };
        match &f.default {
            Some(body) => {
                let kernel = parse::function(&f.attrs, &f.sig, body, Some(&self_ty), &mut errors);
                functions.extend(lifted_function(&kernel, &place, &mut errors));
            }
            None => {
                let body = syn::parse_quote!({});
                let kernel = parse::function(&f.attrs, &f.sig, &body, Some(&self_ty), &mut errors);
                let emitter = Emitter::new(&kernel, quote!(__M), None, false, &mut errors);
                let emitter = emitter.with_generics(&around);
                let (head, quiet) = (head(&kernel, &place, &emitter), quiet());
                functions.extend(quote!(#[doc(hidden)] #quiet #head;));
            }
        }
    }
    let errors = errors.into_tokens();
    let p = private();
    let mut item = item.clone();
    item.supertraits.push(syn::parse_quote!(#p::Type));
    item.items.push(syn::TraitItem::Verbatim(functions));
    let item = without_markers(item.to_token_stream());
    quote!(#item #errors)
}
