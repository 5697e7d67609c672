//! `kernel!(|ray: Ray| ...)`.

use proc_macro2::{Ident, TokenStream};
use quote::{ToTokens, format_ident, quote};
use syn::spanned::Spanned;

use super::{info, own, private, quiet};
use crate::diag::Errors;
use crate::emit::{Emitter, raw_capture};
use crate::here::{At, private_here, quote_here};
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
        let (alias, member) = (format_ident!("{alias}"), own(member));
        // The machine of the first copy is inferred, from a cast. Casts come after all else, so the
        // errors of a copy for any machine imply those of the others, and rustc leaves these out.
        let machine = if copies.is_empty() { quote!(_) } else { quote!(#p::#alias) };
        let mut seen = Errors::default();
        let mut emitter = Emitter::new(&kernel, machine.clone(), None, true, &mut seen);
        let body = emitter.body();
        captured = core::mem::take(&mut emitter.captures);
        let raw = core::mem::take(&mut emitter.host_captures);
        let raw_index = raw.iter().filter_map(|r| captured.iter().position(|c| c == r));
        let raw = raw.iter().zip(raw_index).map(|(name, i)| {
            let _at = At::new(name.span());
            let (p, captures) = (private_here(), own("captures"));
            let (i, raw) = (syn::Index::from(i), raw_capture(name));
            quote_here!(let #raw = #p::HostCapture::host({ #captures.#i });)
        });
        let on: Vec<TokenStream> = kernel.params.iter().map(|p| emitter.on(&p.ty)).collect();
        // The copies have the same mistakes.
        if copies.is_empty() {
            errors.append(seen);
        }
        let brought = captured.iter().enumerate().map(|(i, name)| {
            let _at = At::new(name.span());
            let p = private_here();
            let (captures, m, i) = (own("captures"), own("m"), syn::Index::from(i));
            let text = name.to_string();
            quote_here!(
                let #name = #p::Capture::<#machine>::capture({ #captures.#i }, #m, #text);
            )
        });
        copies.push(quote! {
            #quiet
            let #member = move |#m: &#machine, (#(#names,)*): (#(#on,)*)| {
                    use #p::operations::*;
                    #p::Machine::call(
                        #m,
                        &__INFO,
                        (#(#names,)*),
                        #[inline(always)]
                        |#m: &#machine, (#(#names,)*): (#(#on,)*)| {
                            #(#raw)*
                            #(#brought)*
                            #body
                        },
                    )
                };
        });
    }
    if !errors.is_empty() {
        let errors = errors.into_expression();
        // The closure itself stays, so that rustc and editors see its types.
        let closure = without_markers(closure.to_token_stream());
        return quote!({ let _ = #closure; #errors });
    }
    let info = info(&kernel, "kernel");
    let closure = without_markers(closure.to_token_stream());
    let scalar = own("scalar");
    let mut others: Vec<Ident> = NATURAL.iter().map(|n| own(n.1)).collect();
    let (first, first_machine) = (others.remove(0), format_ident!("{}", NATURAL[0].0));
    let resources = captured.iter().enumerate().map(|(i, name)| {
        let _at = At::new(name.span());
        let p = private_here();
        let (captures, i) = (own("captures"), syn::Index::from(i));
        quote_here!(#p::Capture::<#p::Recorder>::resources({ #captures.#i }, visit);)
    });
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
                #p::Lifted {
                    #(#others: ::std::boxed::Box::new(#others),)*
                    #first: ::std::boxed::Box::new(#first)
                        as ::std::boxed::Box<dyn Fn(&#p::#first_machine, _) -> _ + Send + Sync>,
                }
            },
            move |visit: &mut dyn FnMut(&dyn #p::Resource)| {
                #(#resources)*
            },
        )
    }}
}
