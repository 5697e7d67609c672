//! Expansion of items: kernels and primitives.

mod closure;
mod forward;
mod function;
mod methods;
mod operators;
mod primitive;
mod scene;
mod shape;

pub(crate) use closure::{ClosureKernel, kernel_closure};
pub(crate) use forward::{EnumArguments, forwarded};
pub(crate) use function::{KnownBy, kernel_fn};
pub(crate) use methods::{kernel_impl, kernel_trait};
pub(crate) use primitive::primitive_impl;
pub(crate) use scene::scene;
pub(crate) use shape::{Shape, with_shape};

use proc_macro2::{Ident, TokenStream};
use quote::{ToTokens, format_ident, quote};

use crate::diag::Errors;
use crate::emit::Emitter;
use crate::generics::Generics;
use crate::here::{in_one_place, of_type, own, private, private_here, quote_here};
use crate::model::{Kernel, Param, Signature};
use crate::ops;

/// Returns a parameter's name in lifted code; `self` cannot name a local.
fn param_ident(name: &Ident) -> Ident {
    if name == "self" { own("this") } else { name.clone() }
}

/// Returns the static description of a kernel.
fn info(kernel: &Kernel, name: &str) -> TokenStream {
    let p = private();
    // Host values are no arguments on a machine.
    let values = kernel.params.iter().filter(|p| !p.host);
    let params: Vec<String> = values.map(|p| p.name.to_string()).collect();
    let known = match &kernel.known {
        Some(known) => quote!(::core::option::Option::Some(#p::KnownBy(&#known))),
        None => quote!(::core::option::Option::None),
    };
    quote! {
        static __INFO: #p::KernelInfo = #p::KernelInfo {
            name: #name,
            file: ::core::file!(),
            line: ::core::line!(),
            params: &[#(#params),*],
            known: #known,
        };
    }
}

fn quiet() -> TokenStream {
    quote!(#[allow(
        unused, clippy::all, clippy::pedantic, clippy::nursery, non_snake_case,
        reason = "generated code"
    )])
}

/// The surroundings of a lifted function.
struct Place<'a> {
    /// Its name.
    fn_name: &'a Ident,
    /// Its name in WGSL.
    wgsl_name: &'a str,
    /// The type of the `impl` around it.
    self_ty: Option<&'a TokenStream>,
    /// The generic parameters of the item around it.
    around: &'a Generics,
    vis: &'a TokenStream,
    /// Whether it has a `where` clause of its own; that of a free kernel is the type's.
    is_method: bool,
    /// Whether the `impl` around it asserts that its type is one of kernels.
    asserts_self: bool,
}

/// Returns the generic function that runs the lifted body on any machine.
fn lifted_function(kernel: &Kernel, place: &Place<'_>, errors: &mut Errors) -> TokenStream {
    let p = private();
    let mut seen = Errors::default();
    let emitter = Emitter::new(kernel, quote!(__M), place.self_ty.cloned(), false, &mut seen);
    let mut emitter = emitter.with_generics(place.around);
    let mut body = emitter.body();
    // With a mistake in it the function still exists, so that its calls give no second error.
    if emitter.has_errors() || !errors.is_empty() {
        body = quote!(::core::unreachable!());
    }
    let head = head(kernel, place, &emitter);
    let info = info(kernel, place.wgsl_name);
    let quiet = quiet();
    let checks = checks(kernel, place);
    let call = call_of(&quote!(#checks #body), kernel, &emitter);
    let call = with_changes_set(call, kernel, &emitter);
    errors.append(seen);
    quote! {
        #[doc(hidden)]
        #[inline(always)]
        #quiet
        #head {
            use #p::operations::*;
            #info
            #call
        }
    }
}

/// Emits the machine's call of the body with its arguments. Host values are no arguments: the body
/// uses them directly.
fn call_of(body: &TokenStream, kernel: &Kernel, emitter: &Emitter<'_>) -> TokenStream {
    let (p, m) = (private(), own("m"));
    let values = || kernel.params.iter().filter(|p| !p.host && p.function.is_none());
    let names: Vec<Ident> = values().map(|p| param_ident(&p.name)).collect();
    let types: Vec<TokenStream> = values().map(|p| emitter.param(p)).collect();
    let arguments = values().zip(&names).zip(&types).map(|((param, name), ty)| {
        let _at = of_type(&param.ty);
        let (p, m) = (private_here(), own("m"));
        if param.scene {
            return quote_here!(#p::SceneArgument::scene(&#name));
        }
        quote_here!(#p::Coerce::<__M, #ty>::coerce(#name, #m))
    });
    // In WGSL a closure reads the variables of the function around it.
    if kernel.takes_function() {
        return quote!({ #(let #names: #types = #arguments;)* #body });
    }
    let call = match (kernel.is_apart, kernel.is_within) {
        (true, _) => quote!(call_apart),
        (_, true) => quote!(call_within),
        _ => quote!(call),
    };
    quote! {
        #p::Machine::#call(
            #m,
            &__INFO,
            (#(#arguments,)*),
            #[inline(always)]
            |#m: &__M, (#(#names,)*): (#(#types,)*)| { #body },
        )
    }
}

/// Emits copies of the `&mut` parameters as arguments, and assigns their final values from beside
/// the result.
fn with_changes_set(call: TokenStream, kernel: &Kernel, emitter: &Emitter<'_>) -> TokenStream {
    let changed: Vec<&Param> = kernel.params.iter().filter(|p| p.by_mut && !p.host).collect();
    if changed.is_empty() {
        return call;
    }
    let (m, out) = (own("m"), own("out"));
    let result = kernel.result.as_ref().map(|t| emitter.on(t)).unwrap_or_else(|| quote!(()));
    let types = changed.iter().map(|p| emitter.param(p));
    let sets = changed.iter().enumerate().map(|(i, param)| {
        let (name, i) = (param_ident(&param.name), syn::Index::from(i + 1));
        quote!(#name.set(#m, #out.#i);)
    });
    quote! {
        let #out: (#result, #(#types,)*) = #call;
        #(#sets)*
        #out.0
    }
}

/// Returns assertions that the user's own types in a signature are types of kernels, so that uses of one
/// that is not give no errors. [`checks`] give the error.
fn asserted(kernel: &Kernel) -> TokenStream {
    let values = kernel.params.iter().filter(|p| is_value(p)).map(|p| &p.ty);
    let mut seen = Vec::new();
    let asserted = values.chain(&kernel.result).filter_map(|ty| {
        let text = ty.to_string();
        let is_new = !seen.contains(&text);
        seen.push(text);
        is_new.then(|| asserted_type(ty, &kernel.generics))
    });
    asserted.collect()
}

/// Returns an assertion that a user's own type is one of kernels.
fn asserted_type(ty: &TokenStream, generics: &Generics) -> TokenStream {
    if !is_asserted(ty, generics) {
        return TokenStream::new();
    }
    let _at = of_type(ty);
    let (p, ty) = (private_here(), in_one_place(ty.clone()));
    quote_here!(for<'__t> #ty: #p::Stated<'__t>,)
}

/// Returns whether a type of a signature is a user's own, which may be no type of kernels.
fn is_asserted(ty: &TokenStream, generics: &Generics) -> bool {
    is_users_own(ty) && !generics.has_type_in(ty)
}

/// Returns the parameters and the result whose types are asserted to be types of kernels: the names of
/// parameters, and the types. Equal types are the tokens of the first, and the result is left out if a
/// parameter has its type. Each method of a type checks that type, which may be in its body alone.
fn asserted_here(kernel: &Kernel, place: &Place<'_>) -> Vec<(Option<Ident>, TokenStream)> {
    let own = place.self_ty.filter(|own| place.asserts_self && is_asserted(own, place.around));
    let own_text = place.self_ty.map(ToString::to_string);
    let asserted = |ty: &TokenStream| {
        let text = ty.to_string();
        if text == "Self" || Some(&text) == own_text.as_ref() {
            return own.cloned();
        }
        (!place.is_method && is_asserted(ty, &kernel.generics)).then(|| ty.clone())
    };
    let mut found: Vec<(Option<Ident>, TokenStream)> = Vec::new();
    for param in kernel.params.iter().filter(|p| is_value(p)) {
        let Some(ty) = asserted(&param.ty) else { continue };
        let text = ty.to_string();
        let first = found.iter().find(|(_, other)| other.to_string() == text);
        let ty = first.map_or(ty, |(_, first)| first.clone());
        found.push((Some(param_ident(&param.name)), ty));
    }
    for ty in kernel.result.as_ref().and_then(asserted).into_iter().chain(own.cloned()) {
        let text = ty.to_string();
        if !found.iter().any(|(_, other)| other.to_string() == text) {
            found.push((None, ty));
        }
    }
    found
}

/// Emits what begins a body: whether the asserted types are types of kernels. Where one is not, rustc says
/// so, once for all that are at the same place; the value then has a type about which rustc reports nothing.
fn checks(kernel: &Kernel, place: &Place<'_>) -> TokenStream {
    let check = |(name, ty): (Option<Ident>, TokenStream)| {
        let _at = of_type(&ty);
        let (p, ty) = (private_here(), in_one_place(ty));
        let same = quote_here!(<#ty as #p::KernelType>::same::<__M>);
        match name {
            Some(name) => quote_here!(let #name = #same(#name);),
            None => quote_here!(let _ = #same;),
        }
    };
    asserted_here(kernel, place).into_iter().map(check).collect()
}

/// Returns bounds that are true, for signatures with a type that may be none of kernels. rustc would take
/// a value of unknown type for what the only bound is about, and report that it is not what is wanted; of
/// two bounds it takes none.
fn two_bounds(kernel: &Kernel, place: &Place<'_>) -> TokenStream {
    let is_slice = |param: &Param| {
        let slice = syn::parse2::<syn::TypeSlice>(param.ty.clone());
        slice.is_ok_and(|slice| is_asserted(&slice.elem.to_token_stream(), &kernel.generics))
    };
    let has_slice = kernel.params.iter().any(|p| p.data && is_slice(p));
    if !has_slice && asserted_here(kernel, place).is_empty() {
        return TokenStream::new();
    }
    let p = private();
    quote!((): #p::Coerce<__M, ()>, ((),): #p::Coerce<__M, ((),)>,)
}

/// Returns whether a parameter is a value.
fn is_value(param: &Param) -> bool {
    !(param.data || param.scene || param.host || param.function.is_some())
}

/// Returns whether it is a path without parameters that names none of the library's types.
fn is_users_own(ty: &TokenStream) -> bool {
    let parsed = syn::parse2::<syn::TypePath>(ty.clone());
    let Some(last) = parsed.ok().and_then(|t| t.path.segments.last().cloned()) else {
        return false;
    };
    last.arguments.is_none() && last.ident != "Self" && !ops::is_of_library(&last.ident.to_string())
}

/// Returns the bound of parameter `i`, which is a closure; `on` gives the twin of a type.
fn closure_bound(
    i: usize,
    function: &Signature,
    on: &dyn Fn(&TokenStream) -> TokenStream,
) -> TokenStream {
    let (params, result) = (function.params.iter().map(on), result_of(i));
    quote!(Fn(&__M, #(#params),*) -> #result)
}

/// Returns the type parameter for what the closure that is parameter `i` gives.
fn result_of(i: usize) -> Ident {
    format_ident!("__R{i}")
}

/// Returns the type parameters for what closures give: values that become those of the machine.
fn closure_results(kernel: &Kernel, on: &dyn Fn(&TokenStream) -> TokenStream) -> TokenStream {
    let p = private();
    let params = kernel.params.iter().enumerate();
    params
        .filter_map(|(i, param)| Some((i, param.function.as_ref()?)))
        .map(|(i, function)| {
            let (name, result) = (result_of(i), on(&function.result));
            quote!(#name: #p::Coerce<__M, #result>,)
        })
        .collect()
}

/// Returns the signature of a lifted function.
fn head(kernel: &Kernel, place: &Place<'_>, emitter: &Emitter<'_>) -> TokenStream {
    let (p, m) = (private(), own("m"));
    let Place { fn_name, vis, .. } = place;
    let params = kernel.params.iter().enumerate().map(|(i, param)| {
        let (name, ty) = (param_ident(&param.name), emitter.param(param));
        if let Some(function) = &param.function {
            let bound = closure_bound(i, function, &|ty| emitter.on(ty));
            quote!(#name: impl #bound)
        } else if param.host {
            let ty = &param.ty;
            quote!(#name: #ty)
        } else if param.scene {
            let ty = &param.ty;
            quote!(#name: impl #p::SceneArgument<Scene = #ty>)
        } else if param.data {
            quote!(#name: #ty)
        } else if param.by_mut {
            quote!(#name: &#p::Var<#ty>)
        } else {
            quote!(#name: impl #p::Coerce<__M, #ty>)
        }
    });
    let result = kernel.result.as_ref().map(|t| emitter.on(t)).unwrap_or_else(|| quote!(()));
    let lifetime = kernel.params.iter().any(|p| p.data).then(|| quote!('__a,));
    let Generics { declared, predicates, .. } = &kernel.generics;
    // The parameters of a free kernel are those of its type.
    let declared = place.is_method.then_some(declared);
    let asserted = asserted(kernel);
    let results = closure_results(kernel, &|ty| emitter.on(ty));
    let clause = if place.is_method { quote!(where #predicates) } else { quote!(where #asserted) };
    let two_bounds = two_bounds(kernel, place);
    quote! {
        #vis fn #fn_name<#lifetime __M: #p::Machine, #declared #results>(
            #m: &__M,
            #(#params,)*
        ) -> #result
        #clause #two_bounds
    }
}
