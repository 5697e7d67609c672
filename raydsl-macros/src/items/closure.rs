//! Expansion of `kernel!(|ray: Ray| ...)`.

use proc_macro2::{Ident, TokenStream};
use quote::{ToTokens, format_ident, quote};
use syn::spanned::Spanned;

use super::{info, own, private, quiet};
use crate::diag::Errors;
use crate::emit::{Emitter, raw_capture};
use crate::here::{At, private_here, quote_here};
use crate::model::{Kernel, MOST_OF_ENTRY};
use crate::parse;
use crate::rewrite::without_markers;

/// A machine that a closure is lifted for.
struct Natural {
    /// Its alias in the runtime.
    alias: &'static str,
    /// The member of `Lifted` with its copy.
    member: &'static str,
    /// Its name in `RAYDSL_VARIANTS`.
    variant: &'static str,
}

const NATURAL: [Natural; 5] = [
    Natural { alias: "Native4", member: "native4", variant: "packet4" },
    Natural { alias: "Native8", member: "native8", variant: "packet8" },
    Natural { alias: "Native16", member: "native16", variant: "packet16" },
    Natural { alias: "Recorder", member: "recorder", variant: "wgsl" },
    Natural { alias: "Margin", member: "margin", variant: "reference" },
];

/// The copy that counts lanes, made only on request.
const COUNTED: Natural = Natural { alias: "Counting", member: "counted", variant: "counted" };

/// The environment variable with the copies to make, for those who edit a kernel and wait for
/// rustc: the others are omitted.
const VARIANTS: &str = "RAYDSL_VARIANTS";

/// The maximum number of tokens of a closure whose first copy is for a machine that rustc infers;
/// see [`copies`].
const INFERRED: usize = 256;

/// The input `kernel!(|ray: Ray| ...)` or `kernel!(counted |ray: Ray| ...)`.
pub(crate) struct ClosureKernel {
    counted: Option<Ident>,
    closure: syn::ExprClosure,
}

impl syn::parse::Parse for ClosureKernel {
    fn parse(input: syn::parse::ParseStream<'_>) -> syn::Result<Self> {
        let ahead = input.fork();
        let is_counted = ahead.parse::<Ident>().is_ok_and(|word| word == "counted");
        let is_counted = is_counted && ahead.peek(syn::Token![|]);
        let counted = if is_counted { Some(input.parse()?) } else { None };
        Ok(Self { counted, closure: input.parse()? })
    }
}

/// Expands `kernel!(|ray: Ray| ...)`.
pub(crate) fn kernel_closure(ClosureKernel { counted, closure }: &ClosureKernel) -> TokenStream {
    let mut errors = Errors::default();
    // Unit tests expand to all copies, whatever their own build was asked for.
    let names = if cfg!(test) { None } else { std::env::var(VARIANTS).ok() };
    let wanted = wanted(names.as_deref(), &mut errors);
    let kernel = parse::closure(closure, "kernel", &mut errors);
    if kernel.params.is_empty() && errors.is_empty() {
        errors.at(closure.span(), "a kernel needs a parameter", "write for example `|ray: Ray|`");
    }
    if kernel.params.len() > MOST_OF_ENTRY {
        errors.at(
            closure.span(),
            format!("a kernel that runs by itself has at most {MOST_OF_ENTRY} parameters"),
            "put some of them into a struct with `#[derive(Clone, Copy, Type)]`",
        );
    }
    let machines: Vec<&Natural> =
        wanted.iter().copied().chain(counted.as_ref().map(|_| &COUNTED)).collect();
    let (copies, captured) = copies(&kernel, closure, &machines, &mut errors);
    // The closure itself remains, so that rustc and editors see its types.
    let closure = without_markers(closure.to_token_stream());
    if !errors.is_empty() {
        let errors = errors.into_expression();
        return quote!({ let _ = #closure; #errors });
    }
    let (p, scalar, captures) = (private(), own("scalar"), own("captures"));
    let names: Vec<&Ident> = kernel.params.iter().map(|p| &p.name).collect();
    let types = kernel.params.iter().map(|p| &p.ty);
    let (info, resources) = (info(&kernel, "kernel"), resources(&captured));
    let all = &captured.all;
    let boxed = |machine: &&Natural| boxed(machine, machine.member == machines[0].member);
    let members = NATURAL.iter().map(|machine| {
        let name = format_ident!("{}", machine.member);
        let is_wanted = |other: &&&Natural| other.member == machine.member;
        match wanted.iter().find(is_wanted).map(boxed) {
            Some(copy) => quote!(#name: ::core::option::Option::Some(#copy)),
            None => quote!(#name: ::core::option::Option::None),
        }
    });
    let with_counted = counted.as_ref().map(|_| {
        let copy = boxed(&&COUNTED);
        quote!(.counted(#copy))
    });
    quote! {{
        #info
        // For cargo, which rebuilds when it changes.
        const _: ::core::option::Option<&str> = ::core::option_env!(#VARIANTS);
        let #scalar = #closure;
        let #scalar = #p::Kernel::scalar(
            &__INFO,
            move |(#(#names,)*): (#(#types,)*)| #scalar(#(#names),*),
        );
        let #captures = (#(&#all,)*);
        #(#copies)*
        #scalar.lifted(
            #p::Lifted { #(#members,)* },
            move |visit: &mut dyn FnMut(&dyn #p::Resource)| {
                #(#resources)*
            },
        )
        #with_counted
    }}
}

/// Returns the machines that closures are lifted for: all, or those named by the environment.
fn wanted(names: Option<&str>, errors: &mut Errors) -> Vec<&'static Natural> {
    let Some(names) = names else { return NATURAL.iter().collect() };
    let names: Vec<&str> = names.split(',').map(str::trim).filter(|n| !n.is_empty()).collect();
    let is_known = |name: &str| name == "scalar" || NATURAL.iter().any(|n| n.variant == name);
    for name in names.iter().filter(|name| !is_known(name)) {
        let all: Vec<&str> = NATURAL.iter().map(|n| n.variant).collect();
        errors.at(
            proc_macro2::Span::call_site(),
            format!("the environment variable {VARIANTS} names `{name}`, which is no variant"),
            &format!("it is a list of some of: scalar,{}", all.join(",")),
        );
    }
    NATURAL.iter().filter(|n| names.contains(&n.variant)).collect()
}

/// Returns a copy of the lifted closure for each machine, and the names that all capture.
///
/// rustc would report a mistake once per copy. The machine of the first copy of a short closure is
/// therefore inferred, from a cast. Casts are checked after everything else, so the errors of a
/// copy for any machine imply those of the others, and rustc omits these. But rustc reconsiders all
/// obligations of the first copy's machine again and again until the cast is reached: in a closure
/// of sixty lines for 19 of 20 seconds. So each copy of a long closure has its own errors.
fn copies(
    kernel: &Kernel,
    closure: &syn::ExprClosure,
    machines: &[&Natural],
    errors: &mut Errors,
) -> (Vec<TokenStream>, Captured) {
    let p = private();
    let is_short = tokens(closure.to_token_stream(), INFERRED) < INFERRED;
    let (mut copies, mut captured) = (Vec::new(), Captured::default());
    for machine in machines {
        let (alias, member) = (format_ident!("{}", machine.alias), own(machine.member));
        let machine = if copies.is_empty() && is_short { quote!(_) } else { quote!(#p::#alias) };
        let mut seen = Errors::default();
        let copy;
        (copy, captured) = copy_for(&machine, &member, kernel, &mut seen);
        // The copies have the same mistakes.
        if copies.is_empty() {
            errors.append(seen);
        } else {
            errors.append_repeated(seen);
        }
        copies.push(copy);
    }
    (copies, captured)
}

/// Returns the number of tokens, if it is no more than `most`.
fn tokens(stream: TokenStream, most: usize) -> usize {
    let mut count = 0;
    for token in stream {
        count += 1;
        if let proc_macro2::TokenTree::Group(group) = token {
            count += tokens(group.stream(), most - count.min(most));
        }
        if count >= most {
            break;
        }
    }
    count
}

/// The names that a kernel captures.
#[derive(Default)]
struct Captured {
    all: Vec<Ident>,
    /// Those among them that are used as the host's values.
    of_host: Vec<Ident>,
    /// Constants, by their spelling.
    constants: Vec<Ident>,
}

/// Returns the lifted closure for one machine, as the local `member`, and the names that it
/// captures.
fn copy_for(
    machine: &TokenStream,
    member: &Ident,
    kernel: &Kernel,
    errors: &mut Errors,
) -> (TokenStream, Captured) {
    let (p, m, quiet) = (private(), own("m"), quiet());
    let mut emitter = Emitter::new(kernel, machine.clone(), None, true, errors);
    let body = emitter.body();
    let captured = core::mem::take(&mut emitter.captures);
    let of_host = core::mem::take(&mut emitter.host_captures);
    let constants = core::mem::take(&mut emitter.constants);
    let raw = raw_captures(&of_host, &captured);
    let brought = brought(machine, &captured);
    let names: Vec<&Ident> = kernel.params.iter().map(|p| &p.name).collect();
    let types: Vec<TokenStream> = kernel.params.iter().map(|p| emitter.on(&p.ty)).collect();
    let copy = quote! {
        move |#m: &#machine, (#(#names,)*): (#(#types,)*)| {
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
        }
    };
    let copy = if kernel.gives_bare_integer() {
        let scalar = own("scalar");
        quote!(#scalar.like(#copy))
    } else {
        copy
    };
    (quote!(#quiet let #member = #copy;), Captured { all: captured, of_host, constants })
}

/// Returns the captures as values of the machine.
fn brought(machine: &TokenStream, captured: &[Ident]) -> Vec<TokenStream> {
    let bring = |(i, name): (usize, &Ident)| {
        let _at = At::new(name.span());
        let (p, m, capture, text) = (private_here(), own("m"), capture(i), name.to_string());
        quote_here!(let #name = #p::Capture::<#machine>::capture(#capture, #m, #text);)
    };
    captured.iter().enumerate().map(bring).collect()
}

/// Returns the captures that are also needed as host values.
fn raw_captures(names: &[Ident], captured: &[Ident]) -> Vec<TokenStream> {
    let raw = |name: &Ident| {
        let _at = At::new(name.span());
        let capture = capture(captured.iter().position(|c| c == name)?);
        let (p, raw) = (private_here(), raw_capture(name));
        Some(quote_here!(let #raw = #p::HostCapture::host(#capture);))
    };
    names.iter().filter_map(raw).collect()
}

/// Returns the code that passes the captures' resources to the runtime, the values among them that
/// are used as the host's, and constants, which are a part of what is recorded.
fn resources(Captured { all, of_host, constants }: &Captured) -> Vec<TokenStream> {
    let visit = |(i, name): (usize, &Ident)| {
        let _at = At::new(name.span());
        let (p, capture, text) = (private_here(), capture(i), name.to_string());
        quote_here!(#p::Capture::<#p::Recorder>::resources(#capture, #text, visit);)
    };
    let visit_host = |name: &Ident| {
        let _at = At::new(name.span());
        let capture = capture(all.iter().position(|c| c == name)?);
        let p = private_here();
        Some(quote_here!(#p::visit_host(#capture, visit);))
    };
    let visit_constant = |name: &Ident| {
        let _at = At::new(name.span());
        let p = private_here();
        quote_here!(#p::ConstantFact(&#name).visit(visit);)
    };
    // A constant that kernels can capture needs no trait to be visited.
    let import = (!constants.is_empty()).then(|| {
        let p = private();
        quote! {
            #[allow(unused_imports, reason = "for constants of the host alone")]
            use #p::VisitConstant as _;
        }
    });
    let values = all.iter().enumerate().map(visit).chain(of_host.iter().filter_map(visit_host));
    import.into_iter().chain(values).chain(constants.iter().map(visit_constant)).collect()
}

/// Returns one of the captures, which are stored in a tuple.
fn capture(i: usize) -> TokenStream {
    let (captures, i) = (own("captures"), syn::Index::from(i));
    quote_here!({ #captures.#i })
}

/// Returns a boxed copy. The cast of the first one determines its machine.
fn boxed(machine: &Natural, is_first: bool) -> TokenStream {
    let (p, copy, alias) = (private(), own(machine.member), format_ident!("{}", machine.alias));
    let cast =
        is_first.then(|| quote!(as ::std::boxed::Box<dyn Fn(&#p::#alias, _) -> _ + Send + Sync>));
    quote!(::std::boxed::Box::new(#copy) #cast)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn variants(names: Option<&str>) -> Result<Vec<&'static str>, String> {
        let mut errors = Errors::default();
        let wanted = wanted(names, &mut errors).iter().map(|n| n.variant).collect();
        if errors.is_empty() { Ok(wanted) } else { Err(errors.into_tokens().to_string()) }
    }

    #[test]
    fn the_environment_names_copies() {
        let all = ["packet4", "packet8", "packet16", "wgsl", "reference"];
        assert_eq!(variants(None).as_deref(), Ok(&all[..]));
        assert_eq!(variants(Some(" wgsl, packet8,")).as_deref(), Ok(&["packet8", "wgsl"][..]));
        assert_eq!(variants(Some("scalar")).as_deref(), Ok(&[][..]));
        assert_eq!(variants(Some("")).as_deref(), Ok(&[][..]));
        let error = variants(Some("packet8,packet9")).expect_err("there is no such variant");
        assert!(error.contains("RAYDSL_VARIANTS names `packet9`"), "{error}");
        assert!(error.contains("scalar,packet4,packet8,packet16,wgsl,reference"), "{error}");
    }

    #[test]
    fn only_long_closures_are_counted_to_the_end() {
        let few = quote!(|x: f32| x + 1.0);
        assert_eq!(tokens(few.clone(), 100), 8);
        let many = quote!({ #few; #few; #few; #few });
        assert!(tokens(many, 10) >= 10);
    }
}
