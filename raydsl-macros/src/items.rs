//! The items that the macros write: kernels, twins, primitives.

use proc_macro2::{Ident, Span, TokenStream};
use quote::{ToTokens, format_ident, quote};
use syn::spanned::Spanned;

use crate::diag::Errors;
use crate::emit::Emitter;
use crate::model::Kernel;
use crate::parse;

/// The natural machines of a closure, by the names of their aliases in the runtime and of the
/// members of `Lifted` that hold their copies.
const NATURAL: [(&str, &str); 7] = [
    ("Native4", "native4"),
    ("Native8", "native8"),
    ("Native16", "native16"),
    ("Native16Halves", "native16_halves"),
    ("Baseline", "baseline"),
    ("Recorder", "recorder"),
    ("Margin", "margin"),
];

fn private() -> TokenStream {
    quote!(::raydsl::__private)
}

fn own(name: &str) -> Ident {
    Ident::new(name, Span::mixed_site())
}

/// A parameter in lifted code; `self` cannot name a local.
fn param_ident(name: &Ident) -> Ident {
    if name == "self" { own("this") } else { name.clone() }
}

/// The static description of a kernel.
fn info(kernel: &Kernel, name: &str) -> TokenStream {
    let p = private();
    let params: Vec<String> = kernel.params.iter().map(|p| p.name.to_string()).collect();
    quote! {
        static __INFO: #p::KernelInfo = #p::KernelInfo {
            name: #name,
            file: ::core::file!(),
            line: ::core::line!(),
            params: &[#(#params),*],
        };
    }
}

fn quiet() -> TokenStream {
    quote!(#[allow(
        unused, clippy::all, clippy::pedantic, clippy::nursery, non_snake_case,
        reason = "generated code"
    )])
}

/// The generic function that runs the lifted body on any machine.
fn lifted_function(
    kernel: &Kernel,
    fn_name: &Ident,
    wgsl_name: &str,
    self_ty: Option<&TokenStream>,
    vis: &TokenStream,
    errors: &mut Errors,
) -> TokenStream {
    let p = private();
    let m = own("m");
    let mut emitter = Emitter::new(kernel, quote!(__M), self_ty.cloned(), false, errors);
    let body = emitter.body();
    let names: Vec<Ident> = kernel.params.iter().map(|p| param_ident(&p.name)).collect();
    let types: Vec<TokenStream> = kernel.params.iter().map(|p| emitter.on(&p.ty)).collect();
    let result = kernel.result.as_ref().map(|t| emitter.on(t)).unwrap_or_else(|| quote!(()));
    let info = info(kernel, wgsl_name);
    let quiet = quiet();
    let changed: Vec<&Ident> =
        kernel.params.iter().zip(&names).filter(|(p, _)| p.by_mut).map(|(_, n)| n).collect();
    if !changed.is_empty() {
        return changing_function(
            kernel,
            fn_name,
            &quote!(#quiet #vis),
            &names,
            &types,
            &result,
            &info,
            &body,
        );
    }
    quote! {
        #[doc(hidden)]
        #[inline(always)]
        #quiet
        #vis fn #fn_name<__M: #p::Machine>(
            #m: &__M,
            #(#names: impl #p::Coerce<__M, #types>,)*
        ) -> #result {
            use #p::operations::*;
            #info
            #p::Machine::call(
                #m,
                &__INFO,
                (#(#p::Coerce::<__M, #types>::coerce(#names, #m),)*),
                #[inline(always)]
                |#m: &__M, (#(#names,)*): (#(#types,)*)| { #body },
            )
        }
    }
}

/// The lifted function of a kernel with `&mut` parameters: copies go in, and what became of them
/// comes out beside the result.
#[expect(clippy::too_many_arguments, reason = "the parts of one function")]
fn changing_function(
    kernel: &Kernel,
    fn_name: &Ident,
    head: &TokenStream,
    names: &[Ident],
    types: &[TokenStream],
    result: &TokenStream,
    info: &TokenStream,
    body: &TokenStream,
) -> TokenStream {
    let (p, m, out) = (private(), own("m"), own("out"));
    let all = || kernel.params.iter().zip(names).zip(types);
    let params = all().map(|((param, name), ty)| {
        if param.by_mut {
            quote!(#name: &#p::Var<#ty>)
        } else {
            quote!(#name: impl #p::Coerce<__M, #ty>)
        }
    });
    let changed: Vec<_> = all().filter(|((param, _), _)| param.by_mut).collect();
    let changed_types = changed.iter().map(|(_, ty)| ty);
    let results = changed.iter().enumerate().map(|(i, ((_, name), _))| {
        let i = syn::Index::from(i + 1);
        quote!(#name.set(#m, #out.#i);)
    });
    quote! {
        #[doc(hidden)]
        #[inline(always)]
        #head fn #fn_name<__M: #p::Machine>(#m: &__M, #(#params,)*) -> #result {
            use #p::operations::*;
            #info
            let #out: (#result, #(#changed_types,)*) = #p::Machine::call(
                #m,
                &__INFO,
                (#(#p::Coerce::<__M, #types>::coerce(#names, #m),)*),
                #[inline(always)]
                |#m: &__M, (#(#names,)*): (#(#types,)*)| { #body },
            );
            #(#results)*
            #out.0
        }
    }
}

/// `#[kernel] fn`.
pub(crate) fn kernel_fn(item: &syn::ItemFn) -> TokenStream {
    let mut errors = Errors::default();
    let kernel = parse::function(&item.sig, &item.block, None, &mut errors);
    let name = &kernel.name;
    let vis = item.vis.to_token_stream();
    let inner = visible_from_inside(&item.vis);
    let lifted = lifted_function(
        &kernel,
        &Ident::new("on", Span::call_site()),
        &name.to_string(),
        None,
        &inner,
        &mut errors,
    );
    if !errors.is_empty() {
        let errors = errors.into_tokens();
        let name = &item.sig.ident;
        // The type stays, so that calls of the kernel give no second error.
        return quote!(#item #[allow(non_camel_case_types, dead_code)] #vis enum #name {} #errors);
    }
    let p = private();
    let types: Vec<&TokenStream> = kernel.params.iter().map(|p| &p.ty).collect();
    let fields: Vec<syn::Index> = (0..types.len()).map(syn::Index::from).collect();
    let result = kernel.result.clone().unwrap_or_else(|| quote!(()));
    let refs = scalar_arguments(&item.sig, &fields);
    let doc = format!("The kernel of [`{name}()`]: `Kernel::of::<{name}>()`.");
    let info = info(&kernel, &name.to_string());
    let changes = kernel.params.iter().any(|p| p.by_mut);
    let entry = if types.is_empty() || kernel.result.is_none() || changes {
        TokenStream::new()
    } else {
        quote! {
            impl #p::KernelFn for #name {
                type Args = (#(#types,)*);
                type Output = #result;

                fn info() -> &'static #p::KernelInfo {
                    #info
                    &__INFO
                }

                #[inline]
                fn scalar(args: Self::Args) -> #result {
                    #name(#(#refs),*)
                }

                #[inline(always)]
                fn lifted<__M: #p::Machine>(
                    m: &__M,
                    args: <Self::Args as #p::Type>::On<__M>,
                ) -> <#result as #p::Type>::On<__M> {
                    #name::on(m, #(args.#fields),*)
                }
            }
        }
    };
    quote! {
        #item
        #[doc = #doc]
        #[allow(non_camel_case_types, reason = "it has the name of the function")]
        #vis enum #name {}
        impl #name { #lifted }
        #entry
    }
}

/// An inherent item of a type that is private to its module is as visible as the type.
fn visible_from_inside(vis: &syn::Visibility) -> TokenStream {
    match vis {
        syn::Visibility::Inherited => quote!(pub(self)),
        v => v.to_token_stream(),
    }
}

/// The arguments of the user's own function: references where it takes references.
fn scalar_arguments(sig: &syn::Signature, fields: &[syn::Index]) -> Vec<TokenStream> {
    let inputs = sig.inputs.iter().zip(fields);
    inputs
        .map(|(arg, i)| match arg {
            syn::FnArg::Typed(p) if matches!(&*p.ty, syn::Type::Reference(_)) => quote!(&args.#i),
            _ => quote!(args.#i),
        })
        .collect()
}

/// `kernel!(|ray: Ray| ...)`.
pub(crate) fn kernel_closure(closure: &syn::ExprClosure) -> TokenStream {
    let mut errors = Errors::default();
    let kernel = parse::closure(closure, "kernel", &mut errors);
    if kernel.params.is_empty() && errors.is_empty() {
        errors.at(closure.span(), "a kernel needs a parameter", "write for example `|ray: Ray|`");
    }
    let (p, m) = (private(), own("m"));
    let names: Vec<Ident> = kernel.params.iter().map(|p| p.name.clone()).collect();
    let types: Vec<&TokenStream> = kernel.params.iter().map(|p| &p.ty).collect();
    let (captures, quiet) = (own("captures"), quiet());
    let mut captured = Vec::new();
    let mut copies = Vec::new();
    for (alias, member) in NATURAL {
        let (alias, member) = (format_ident!("{alias}"), format_ident!("{member}"));
        let machine = quote!(#p::#alias);
        let mut seen = Errors::default();
        let mut emitter = Emitter::new(&kernel, machine.clone(), None, true, &mut seen);
        let body = emitter.body();
        captured = core::mem::take(&mut emitter.captures);
        let on: Vec<TokenStream> = kernel.params.iter().map(|p| emitter.on(&p.ty)).collect();
        // The copies have the same mistakes.
        if copies.is_empty() {
            errors.append(seen);
        }
        let index = (0..captured.len()).map(syn::Index::from);
        let texts = captured.iter().map(ToString::to_string);
        let list = &captured;
        copies.push(quote! {
            #member: ::std::boxed::Box::new(
                #quiet
                move |#m: &#machine, (#(#names,)*): (#(#on,)*)| {
                    use #p::operations::*;
                    #p::Machine::call(
                        #m,
                        &__INFO,
                        (#(#names,)*),
                        #[inline(always)]
                        |#m: &#machine, (#(#names,)*): (#(#on,)*)| {
                            #(let #list =
                                #p::Capture::<#machine>::capture(#captures.#index, #m, #texts);)*
                            #body
                        },
                    )
                }
            )
        });
    }
    if !errors.is_empty() {
        let errors = errors.into_tokens();
        // The closure itself stays, so that rustc and editors see its types.
        return quote!({ #errors let _ = #closure; ::core::unreachable!() });
    }
    let info = info(&kernel, "kernel");
    let scalar = own("scalar");
    let index = (0..captured.len()).map(syn::Index::from);
    quote! {{
        #info
        let #scalar = #closure;
        let #captures = (#(&#captured,)*);
        #p::Kernel::scalar(
            &__INFO,
            move |(#(#names,)*): (#(#types,)*)| #scalar(#(#names),*),
        )
        .lifted(
            #p::Lifted { #(#copies,)* },
            move |visit: &mut dyn FnMut(&dyn #p::Resource)| {
                #(#p::Capture::<#p::Recorder>::resources(#captures.#index, visit);)*
            },
        )
    }}
}

/// `#[kernel] impl T`, and the kernels of `#[primitive] impl T`.
pub(crate) fn kernel_impl(
    item: &syn::ItemImpl,
    host_only: &[&str],
    errors: &mut Errors,
) -> TokenStream {
    let self_ty = item.self_ty.to_token_stream();
    let type_name = match &*item.self_ty {
        syn::Type::Path(t) => t.path.segments.last().map(|s| s.ident.to_string()),
        _ => None,
    };
    let Some(type_name) = type_name else {
        errors.at(item.self_ty.span(), "kernels belong to a named type", "name a struct");
        return TokenStream::new();
    };
    if let Some((path, _)) = &item.trait_ {
        errors.at(
            path.span(),
            "kernels in trait impls are not supported",
            "write an inherent `impl`",
        );
    }
    if let Some(param) = item.generics.params.first() {
        errors.at(
            param.span(),
            "an impl of kernels cannot be generic",
            "write an impl for each type",
        );
    }
    let mut lifted = TokenStream::new();
    let mut methods = TokenStream::new();
    for f in item.items.iter().filter_map(|i| match i {
        syn::ImplItem::Fn(f) => Some(f),
        _ => None,
    }) {
        let name = f.sig.ident.to_string();
        if host_only.contains(&name.as_str()) {
            continue;
        }
        if let Some(cfg) = f.attrs.iter().find(|a| a.path().is_ident("cfg")) {
            errors.at(
                cfg.span(),
                "a method of kernels has no `#[cfg]`: its lifted form would stay",
                "put the method in an impl of its own, with the `#[cfg]` on the impl",
            );
        }
        let kernel = parse::function(&f.sig, &f.block, Some(&item.self_ty), errors);
        let fn_name = format_ident!("{name}_on");
        let wgsl_name = format!("{type_name}_{name}");
        let vis = f.vis.to_token_stream();
        lifted.extend(lifted_function(&kernel, &fn_name, &wgsl_name, Some(&self_ty), &vis, errors));
        if kernel.params.first().is_some_and(|p| p.name == "self") {
            methods.extend(method(&kernel, &self_ty, &name, &fn_name));
        }
    }
    quote!(impl #self_ty { #lifted } #methods)
}

fn method(kernel: &Kernel, self_ty: &TokenStream, name: &str, fn_name: &Ident) -> TokenStream {
    let p = private();
    let (receiver, rest) = kernel.params.split_first().expect("a method has a receiver");
    let names: Vec<&Ident> = rest.iter().map(|p| &p.name).collect();
    let resolve = |ty: &TokenStream| {
        if ty.to_string() == "Self" { self_ty.clone() } else { ty.clone() }
    };
    let twin = |ty: &TokenStream| {
        let ty = resolve(ty);
        quote!(<#ty as #p::Type>::On<__M>)
    };
    let mut generics = Vec::new();
    let mut arguments = Vec::new();
    for (i, q) in rest.iter().enumerate() {
        let ty = twin(&q.ty);
        if q.by_mut {
            arguments.push(quote!(&'__a #p::Var<#ty>));
        } else {
            let generic = format_ident!("__A{i}");
            generics.push(quote!(#generic: #p::Coerce<__M, #ty>));
            arguments.push(quote!(#generic));
        }
    }
    let lifetime = rest.iter().any(|q| q.by_mut).then(|| quote!('__a,));
    let result = kernel.result.as_ref().map(twin).unwrap_or_else(|| quote!(()));
    let quiet = quiet();
    let (m, this, variable) = (own("m"), own("this"), own("variable"));
    let of = quote!(<Self as #p::HostMethod<{ #p::name(#name) }, __M, (#(#arguments,)*)>>);
    let calls = if receiver.by_mut {
        quote! {
            const IS_MUT: bool = true;

            #[inline(always)]
            fn call(
                #this: <Self as #p::Type>::On<__M>,
                #m: &__M,
                (#(#names,)*): (#(#arguments,)*),
            ) -> #of::Output {
                <#self_ty>::#fn_name(#m, &#p::Var::new(#m, "self", #this), #(#names),*)
            }

            #[inline(always)]
            fn call_at(
                _: <Self as #p::Type>::On<__M>,
                #variable: &#p::Var<<Self as #p::Type>::On<__M>>,
                #m: &__M,
                (#(#names,)*): (#(#arguments,)*),
            ) -> #of::Output {
                <#self_ty>::#fn_name(#m, #variable, #(#names),*)
            }
        }
    } else {
        quote! {
            #[inline(always)]
            fn call(
                #this: <Self as #p::Type>::On<__M>,
                #m: &__M,
                (#(#names,)*): (#(#arguments,)*),
            ) -> #of::Output {
                <#self_ty>::#fn_name(#m, #this, #(#names),*)
            }
        }
    };
    quote! {
        #quiet
        impl<#lifetime __M: #p::Machine, #(#generics,)*>
            #p::HostMethod<{ #p::name(#name) }, __M, (#(#arguments,)*)> for #self_ty
        {
            type Output = #result;

            #calls
        }
    }
}

/// `#[primitive] impl T`.
pub(crate) fn primitive_impl(item: &syn::ItemImpl) -> TokenStream {
    let mut errors = Errors::default();
    let lifted = kernel_impl(item, &["get_bounds", "split_primitive"], &mut errors);
    let p = private();
    let self_ty = &item.self_ty;
    let has = |name: &str| {
        item.items.iter().any(|i| matches!(i, syn::ImplItem::Fn(f) if f.sig.ident == name))
    };
    for (name, signature) in [
        ("intersect", "fn intersect(&self, ray: Ray) -> Hit"),
        ("get_bounds", "fn get_bounds(&self) -> Aabb"),
    ] {
        if !has(name) {
            errors.at(
                self_ty.span(),
                format!("the primitive has no `{name}`"),
                &format!("add `{signature}` to this impl"),
            );
        }
    }
    let slack =
        item.items.iter().any(|i| matches!(i, syn::ImplItem::Const(c) if c.ident == "SLACK"));
    let slack = slack.then(|| quote!(const SLACK: f32 = <#self_ty>::SLACK;));
    if !errors.is_empty() {
        let errors = errors.into_tokens();
        return quote!(#item #errors);
    }
    quote! {
        #item
        #lifted
        impl #p::Primitive for #self_ty {
            #slack

            #[inline(always)]
            fn intersect(&self, ray: #p::Ray) -> #p::Hit {
                <#self_ty>::intersect(self, ray)
            }

            fn get_bounds(&self) -> #p::Aabb {
                <#self_ty>::get_bounds(self)
            }

            #[inline(always)]
            fn intersect_on<__M: #p::Machine>(
                m: &__M,
                prim: <Self as #p::Type>::On<__M>,
                ray: #p::RayOn<__M>,
            ) -> #p::HitOn<__M> {
                <#self_ty>::intersect_on(m, prim, ray)
            }
        }
    }
}
