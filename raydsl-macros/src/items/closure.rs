//! `kernel!(|ray: Ray| ...)`.

use proc_macro2::{Ident, TokenStream};
use quote::{ToTokens, format_ident, quote};
use syn::spanned::Spanned;

use super::{info, own, private, quiet};
use crate::diag::Errors;
use crate::emit::{Emitter, raw_capture};
use crate::here::{At, private_here, quote_here};
use crate::model::Kernel;
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
    let (copies, captured) = copies(&kernel, &mut errors);
    // The closure itself stays, so that rustc and editors see its types.
    let closure = without_markers(closure.to_token_stream());
    if !errors.is_empty() {
        let errors = errors.into_expression();
        return quote!({ let _ = #closure; #errors });
    }
    let (p, scalar, captures) = (private(), own("scalar"), own("captures"));
    let names: Vec<&Ident> = kernel.params.iter().map(|p| &p.name).collect();
    let types = kernel.params.iter().map(|p| &p.ty);
    let (info, lifted, resources) = (info(&kernel, "kernel"), lifted(), resources(&captured));
    quote! {{
        #info
        let #scalar = #closure;
        let #captures = (#(&#captured,)*);
        #p::Kernel::scalar(
            &__INFO,
            move |(#(#names,)*): (#(#types,)*)| #scalar(#(#names),*),
        )
        .lifted(
            {
                #(#copies)*
                #lifted
            },
            move |visit: &mut dyn FnMut(&dyn #p::Resource)| {
                #(#resources)*
            },
        )
    }}
}

/// A copy of the lifted closure for each natural machine, and the names that all capture.
fn copies(kernel: &Kernel, errors: &mut Errors) -> (Vec<TokenStream>, Vec<Ident>) {
    let p = private();
    let (mut copies, mut captured) = (Vec::new(), Vec::new());
    for (alias, member) in NATURAL {
        let (alias, member) = (format_ident!("{alias}"), own(member));
        // The machine of the first copy is inferred, from a cast. Casts come after all else, so the
        // errors of a copy for any machine imply those of the others, and rustc leaves these out.
        let machine = if copies.is_empty() { quote!(_) } else { quote!(#p::#alias) };
        let mut seen = Errors::default();
        let copy;
        (copy, captured) = copy_for(&machine, &member, kernel, &mut seen);
        // The copies have the same mistakes.
        if copies.is_empty() {
            errors.append(seen);
        }
        copies.push(copy);
    }
    (copies, captured)
}

/// The lifted closure for one machine, as the local `member`, and the names that it captures.
fn copy_for(
    machine: &TokenStream,
    member: &Ident,
    kernel: &Kernel,
    errors: &mut Errors,
) -> (TokenStream, Vec<Ident>) {
    let (p, m, quiet) = (private(), own("m"), quiet());
    let mut emitter = Emitter::new(kernel, machine.clone(), None, true, errors);
    let body = emitter.body();
    let captured = core::mem::take(&mut emitter.captures);
    let raw = raw_captures(&emitter.host_captures, &captured);
    let brought = brought(machine, &captured);
    let names: Vec<&Ident> = kernel.params.iter().map(|p| &p.name).collect();
    let types: Vec<TokenStream> = kernel.params.iter().map(|p| emitter.on(&p.ty)).collect();
    let copy = quote! {
        #quiet
        let #member = move |#m: &#machine, (#(#names,)*): (#(#types,)*)| {
                use #p::operations::*;
                #p::Machine::call(
                    #m,
                    &__INFO,
                    (#(#names,)*),
                    #[inline(always)]
                    |#m: &#machine, (#(#names,)*): (#(#types,)*)| {
                        #(#raw)*
                        #(#brought)*
                        #body
                    },
                )
            };
    };
    (copy, captured)
}

/// The captures as values of the machine.
fn brought(machine: &TokenStream, captured: &[Ident]) -> Vec<TokenStream> {
    let bring = |(i, name): (usize, &Ident)| {
        let _at = At::new(name.span());
        let (p, m, capture, text) = (private_here(), own("m"), capture(i), name.to_string());
        quote_here!(let #name = #p::Capture::<#machine>::capture(#capture, #m, #text);)
    };
    captured.iter().enumerate().map(bring).collect()
}

/// The captures that are also wanted as the host has them.
fn raw_captures(names: &[Ident], captured: &[Ident]) -> Vec<TokenStream> {
    let raw = |name: &Ident| {
        let _at = At::new(name.span());
        let capture = capture(captured.iter().position(|c| c == name)?);
        let (p, raw) = (private_here(), raw_capture(name));
        Some(quote_here!(let #raw = #p::HostCapture::host(#capture);))
    };
    names.iter().filter_map(raw).collect()
}

/// What shows the resources of the captures to the runtime.
fn resources(captured: &[Ident]) -> Vec<TokenStream> {
    let visit = |(i, name): (usize, &Ident)| {
        let _at = At::new(name.span());
        let (p, capture) = (private_here(), capture(i));
        quote_here!(#p::Capture::<#p::Recorder>::resources(#capture, visit);)
    };
    captured.iter().enumerate().map(visit).collect()
}

/// One of the captures, which are kept in a tuple.
fn capture(i: usize) -> TokenStream {
    let (captures, i) = (own("captures"), syn::Index::from(i));
    quote_here!({ #captures.#i })
}

/// The copies for all machines, boxed. The cast of the first one says what machine it is for.
fn lifted() -> TokenStream {
    let p = private();
    let mut others: Vec<Ident> = NATURAL.iter().map(|n| own(n.1)).collect();
    let (first, machine) = (others.remove(0), format_ident!("{}", NATURAL[0].0));
    quote! {
        #p::Lifted {
            #(#others: ::std::boxed::Box::new(#others),)*
            #first: ::std::boxed::Box::new(#first)
                as ::std::boxed::Box<dyn Fn(&#p::#machine, _) -> _ + Send + Sync>,
        }
    }
}
