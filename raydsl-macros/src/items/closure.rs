//! `kernel!(|ray: Ray| ...)`.

use proc_macro2::{Ident, TokenStream};
use quote::{ToTokens, format_ident, quote};
use syn::spanned::Spanned;

use super::{info, own, private, quiet};
use crate::diag::Errors;
use crate::emit::{Emitter, raw_capture};
use crate::parse;
use crate::rewrite::without_markers;

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
        let raw = core::mem::take(&mut emitter.host_captures);
        let raw_index =
            raw.iter().filter_map(|r| captured.iter().position(|c| c == r)).map(syn::Index::from);
        let raw_index: Vec<_> = raw_index.collect();
        let raw: Vec<_> = raw.iter().map(raw_capture).collect();
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
                            #(let #raw = #p::HostCapture::host(#captures.#raw_index);)*
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
        let closure = without_markers(closure.to_token_stream());
        return quote!({ #errors let _ = #closure; ::core::unreachable!() });
    }
    let info = info(&kernel, "kernel");
    let closure = without_markers(closure.to_token_stream());
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
