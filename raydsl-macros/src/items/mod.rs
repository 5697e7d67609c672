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
    let declared = declared(kernel, place);
    let call = call_of(&quote!(#declared #body), kernel, &emitter);
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
/// that is not give no errors. [`declared`] gives the error.
fn asserted(kernel: &Kernel) -> TokenStream {
    let is_value = |p: &&Param| !(p.data || p.scene || p.host || p.function.is_some());
    let values = kernel.params.iter().filter(is_value).map(|p| &p.ty);
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

/// Emits what begins a body: for each parameter, and for the result, whether its type is one of kernels.
/// The first time that one is not, all at the same place, rustc says so; values of it then have a type about
/// which rustc reports nothing.
fn declared(kernel: &Kernel, place: &Place<'_>) -> TokenStream {
    let own = place.self_ty.filter(|_| place.asserts_self);
    let of_signature = |ty: &TokenStream| {
        let text = ty.to_string();
        let own = own.filter(|own| text == "Self" || text == own.to_string());
        let asserted = match own {
            Some(own) => Some(own).filter(|own| is_asserted(own, place.around)),
            None => Some(ty).filter(|ty| !place.is_method && is_asserted(ty, &kernel.generics)),
        };
        asserted.cloned()
    };
    let is_value = |p: &&Param| !(p.data || p.scene || p.host || p.function.is_some());
    let mut seen = Vec::new();
    let params = kernel.params.iter().filter(is_value).filter_map(|param| {
        let ty = of_signature(&param.ty)?;
        seen.push(ty.to_string());
        let _at = of_type(&ty);
        let (p, name, ty) = (private_here(), param_ident(&param.name), in_one_place(ty));
        Some(quote_here!(let #name = <#ty as #p::Declared>::same::<__M>(#name);))
    });
    let params: TokenStream = params.collect();
    let result = kernel.result.as_ref().and_then(of_signature);
    let result = result.filter(|ty| !seen.contains(&ty.to_string())).map(|ty| {
        let _at = of_type(&ty);
        let (p, ty) = (private_here(), in_one_place(ty));
        quote_here!(let _ = <#ty as #p::Declared>::same::<__M>;)
    });
    quote!(#params #result)
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
    let unguided = is_declared(kernel, place).then(|| quote!((): #p::Coerce<__M, ()>,));
    quote! {
        #vis fn #fn_name<#lifetime __M: #p::Machine, #declared #results>(
            #m: &__M,
            #(#params,)*
        ) -> #result
        #clause #unguided
    }
}

/// Returns whether a type of the signature may be none of kernels. rustc then takes a value of an unknown
/// type for one of the only parameter with a bound; with two bounds it takes it for none.
fn is_declared(kernel: &Kernel, place: &Place<'_>) -> bool {
    let is_slice = |param: &Param| {
        let slice = syn::parse2::<syn::TypeSlice>(param.ty.clone());
        slice.is_ok_and(|slice| is_asserted(&slice.elem.to_token_stream(), &kernel.generics))
    };
    !declared(kernel, place).is_empty() || kernel.params.iter().any(|p| p.data && is_slice(p))
}
