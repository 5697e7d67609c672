//! Expansion of `#[kernel] fn`.

use proc_macro2::{Ident, Span, TokenStream};
use quote::{ToTokens, format_ident, quote};

use super::{
    Place, asserted, closure_bound, closure_results, info, lifted_function, own, param_ident,
    private, quiet,
};
use crate::diag::Errors;
use crate::generics::Generics;
use crate::here::{of_type, private_here, quote_here};
use crate::model::{Kernel, MOST_OF_ENTRY, Param};
use crate::parse;
use crate::rewrite::without_markers;

/// The argument `known = Function::Sin`: for the library's own functions, about which machines know
/// more than their code says.
pub(crate) struct KnownBy(syn::Expr);

impl syn::parse::Parse for KnownBy {
    fn parse(input: syn::parse::ParseStream<'_>) -> syn::Result<Self> {
        let name: Ident = input.parse()?;
        input.parse::<syn::Token![=]>()?;
        let known = input.parse()?;
        if name == "known" { Ok(Self(known)) } else { Err(input.error("no such argument")) }
    }
}

/// Expands to the unchanged function, a type of the same name, and the lifted body as the type's
/// `on`.
pub(crate) fn kernel_fn(item: &syn::ItemFn, known: Option<&KnownBy>) -> TokenStream {
    let mut errors = Errors::default();
    let mut kernel = parse::function(&item.attrs, &item.sig, &item.block, None, &mut errors);
    kernel.known = known.map(|by| by.0.clone());
    let name = &kernel.name;
    let vis = item.vis.to_token_stream();
    let source = without_markers(item.to_token_stream());
    let is_generic = !kernel.generics.is_empty();
    let fn_name = if is_generic { "on_values" } else { "on" };
    let place = Place {
        fn_name: &Ident::new(fn_name, Span::call_site()),
        wgsl_name: &name.to_string(),
        self_ty: None,
        around: &Generics::default(),
        vis: &visible_from_inside(&item.vis),
        is_method: false,
        asserts_self: false,
    };
    let mut lifted = lifted_function(&kernel, &place, &mut errors);
    if is_generic {
        lifted.extend(inferring_function(&kernel, place.vis));
    }
    let never = never(&kernel.generics);
    let Generics { declared, bare, used, predicates, .. } = &kernel.generics;
    let (declared, bare, used) = (angled(declared), angled(bare), angled(used));
    if kernel.is_broken {
        // The type remains, so that there is something to call.
        let mistaken = mistaken(&kernel, errors);
        return quote! {
            #source
            #[allow(non_camel_case_types, dead_code, reason = "it stands for a kernel with errors")]
            #vis enum #name #bare { #never }
            #mistaken
        };
    }
    let errors = errors.into_tokens();
    let doc = format!("The kernel of [`{name}()`]: `Kernel::of::<{name}>()`.");
    let entry = has_entry(&kernel, &item.sig).then(|| entry(&kernel, &item.sig));
    quote! {
        #source
        #[doc = #doc]
        #[allow(non_camel_case_types, reason = "it has the name of the function")]
        #vis enum #name #bare { #never }
        impl #declared #name #used where #predicates { #lifted }
        #entry
        #errors
    }
}

/// Expands a kernel whose signature has mistakes: its result has a type about which rustc reports
/// nothing.
fn mistaken(kernel: &Kernel, errors: Errors) -> TokenStream {
    let (p, name) = (private(), &kernel.name);
    let Generics { declared, used, predicates, .. } = &kernel.generics;
    let (declared, used) = (angled(declared), angled(used));
    let (others, mistaken) = errors.into_type();
    let types: Vec<Ident> = (0..kernel.params.len()).map(|i| format_ident!("__A{i}")).collect();
    let parameters = &kernel.generics.types;
    let ons = ["on", "on_values"].map(|on| {
        let on = Ident::new(on, Span::call_site());
        quote! {
            pub fn #on<__M: #p::Machine, #(#types),*>(_: &__M, #(_: #types),*) -> Mistaken {
                ::core::unreachable!()
            }
        }
    });
    quote! {
        const _: () = {
            type Mistaken = #mistaken;

            #[allow(dead_code, reason = "generated code")]
            impl #declared #name #used where #predicates {
                #(#ons)*
            }

            impl #declared #p::KernelFn for #name #used
            where
                #predicates #(#parameters: 'static,)*
            {
                type Args = Mistaken;
                type Output = Mistaken;

                fn info() -> &'static #p::KernelInfo {
                    ::core::unreachable!()
                }

                fn scalar(_: Mistaken) -> Mistaken {
                    ::core::unreachable!()
                }

                fn lifted<__M: #p::Machine>(_: &__M, _: Mistaken) -> Mistaken {
                    ::core::unreachable!()
                }
            }
        };
        #others
    }
}

fn angled(list: &TokenStream) -> TokenStream {
    if list.is_empty() { TokenStream::new() } else { quote!(<#list>) }
}

/// Returns a variant that cannot be constructed, since type parameters must be used.
fn never(generics: &Generics) -> TokenStream {
    let types = &generics.types;
    if types.is_empty() {
        return TokenStream::new();
    }
    quote! {
        #[doc(hidden)]
        __Never(::core::convert::Infallible, #(::core::marker::PhantomData<fn(&#types)>,)*)
    }
}

/// Returns whether it can run by itself: on values, for a value.
fn has_entry(kernel: &Kernel, sig: &syn::Signature) -> bool {
    let syn::ReturnType::Type(_, result) = &sig.output else { return false };
    if matches!(**result, syn::Type::Reference(_)) {
        return false;
    }
    let is_value = |p: &Param| !(p.by_mut || p.host || p.data || p.scene || p.function.is_some());
    (1..=MOST_OF_ENTRY).contains(&kernel.params.len())
        && kernel.result.is_some()
        && kernel.params.iter().all(is_value)
}

/// Returns `on` of a generic kernel: the types are inferred from the arguments.
fn inferring_function(kernel: &Kernel, vis: &TokenStream) -> TokenStream {
    let (p, m, out, quiet) = (private(), own("m"), own("out"), quiet());
    let all: Vec<Passed> =
        kernel.params.iter().enumerate().map(|(i, param)| passed(i, param, kernel)).collect();
    let params = all.iter().map(|passed| &passed.param);
    let values = all.iter().map(|passed| &passed.value);
    let before = all.iter().map(|passed| &passed.before);
    let after = all.iter().map(|passed| &passed.after);
    let lifetime = kernel.params.iter().any(|p| p.data).then(|| quote!('__a,));
    let result = kernel.result.as_ref().map(on_any).unwrap_or_else(|| quote!(()));
    let results = closure_results(kernel, &on_any);
    quote! {
        #[doc(hidden)]
        #[inline(always)]
        #quiet
        #vis fn on<#lifetime __M: #p::Machine, #results>(#m: &__M, #(#params,)*) -> #result {
            #(#before)*
            let #out = Self::on_values(#m, #(#values,)*);
            #(#after)*
            #out
        }
    }
}

/// A parameter of [`inferring_function`] passed on to `on_values`.
struct Passed {
    param: TokenStream,
    value: TokenStream,
    /// The code before the call, and behind it.
    before: TokenStream,
    after: TokenStream,
}

fn passed(i: usize, param: &Param, kernel: &Kernel) -> Passed {
    let (p, m) = (private(), own("m"));
    let (name, ty) = (param_ident(&param.name), &param.ty);
    let as_it_is = |param| Passed {
        param,
        value: quote!(#name),
        before: TokenStream::new(),
        after: TokenStream::new(),
    };
    if let Some(function) = &param.function {
        let bound = closure_bound(i, function, &on_any);
        return as_it_is(quote!(#name: impl #bound));
    }
    if param.host {
        return as_it_is(quote!(#name: #ty));
    }
    if param.scene {
        return as_it_is(quote!(#name: impl #p::SceneArgument<Scene = #ty>));
    }
    if param.data {
        return as_it_is(quote!(#name: <#ty as #p::Parameter>::On<'__a, __M>));
    }
    let is_inferred = kernel.generics.has_type_in(ty);
    if is_inferred && param.by_mut {
        let (copy, text) = (format_ident!("{name}_copy"), name.to_string());
        return Passed {
            param: quote!(#name: &#p::Var<impl #p::Twin<__M, Host = #ty>>),
            value: quote!(&#copy),
            before: quote! {
                let #copy = #p::Var::new(#m, #text, #p::Inferred::give(#name, #m));
            },
            after: quote!(#name.set(#m, #p::Twin::from_host(#copy.get(#m)));),
        };
    }
    if is_inferred {
        let value = quote!(#p::Inferred::give(#name, #m));
        let param = quote!(#name: impl #p::Inferred<__M, Host = #ty>);
        return Passed { value, ..as_it_is(param) };
    }
    let ty = on_any(ty);
    match param.by_mut {
        true => as_it_is(quote!(#name: &#p::Var<#ty>)),
        false => as_it_is(quote!(#name: impl #p::Coerce<__M, #ty>)),
    }
}

/// Returns the twin of a type on any machine.
fn on_any(ty: &TokenStream) -> TokenStream {
    let p = private();
    quote!(<#ty as #p::Type>::On<__M>)
}

fn entry(kernel: &Kernel, sig: &syn::Signature) -> TokenStream {
    let name = &kernel.name;
    let Generics { declared, used, predicates, .. } = &kernel.generics;
    let (declared, used) = (angled(declared), angled(used));
    let types: Vec<&TokenStream> = kernel.params.iter().map(|p| &p.ty).collect();
    let _at = types.first().map(|ty| of_type(ty));
    let p = private_here();
    let fields: Vec<syn::Index> = (0..types.len()).map(syn::Index::from).collect();
    let result = &kernel.result;
    let refs = scalar_arguments(sig, &fields);
    let info = info(kernel, &name.to_string());
    let arguments = &kernel.generics.used;
    let called =
        if kernel.generics.is_empty() { quote!(#name) } else { quote!(#name::<#arguments>) };
    let asserted = asserted(kernel);
    let on = format_ident!("{}", if kernel.generics.is_empty() { "on" } else { "on_values" });
    quote_here! {
        #[diagnostic::do_not_recommend]
        impl #declared #p::KernelFn for #name #used where #predicates #asserted {
            type Args = (#(#types,)*);
            type Output = #result;

            fn info() -> &'static #p::KernelInfo {
                #info
                &__INFO
            }

            #[inline]
            fn scalar(args: Self::Args) -> #result {
                #called(#(#refs),*)
            }

            #[inline(always)]
            fn lifted<__M: #p::Machine>(
                m: &__M,
                args: <Self::Args as #p::Type>::On<__M>,
            ) -> <#result as #p::Type>::On<__M> {
                Self::#on(m, #(args.#fields),*)
            }
        }
    }
}

/// Returns the visibility within a type private to its module: an inherent item is as visible as
/// the type.
fn visible_from_inside(vis: &syn::Visibility) -> TokenStream {
    match vis {
        syn::Visibility::Inherited => quote!(pub(self)),
        v => v.to_token_stream(),
    }
}

/// Returns the arguments of the user's own function: references where it takes references.
fn scalar_arguments(sig: &syn::Signature, fields: &[syn::Index]) -> Vec<TokenStream> {
    let inputs = sig.inputs.iter().zip(fields);
    inputs
        .map(|(arg, i)| match arg {
            syn::FnArg::Typed(p) if matches!(&*p.ty, syn::Type::Reference(_)) => quote!(&args.#i),
            _ => quote!(args.#i),
        })
        .collect()
}
