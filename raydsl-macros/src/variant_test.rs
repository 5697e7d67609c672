//! Expansion of `#[variant_test]` and `wgsl_test!`: tests of kernels.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use syn::spanned::Spanned as _;

use crate::diag::{Errors, refused};

/// The variants, and the suffixes of their tests' names.
const VARIANTS: [(&str, &str); 5] = [
    ("Scalar", "scalar"),
    ("Packet4", "packet4"),
    ("Packet8", "packet8"),
    ("Packet16", "packet16"),
    ("Wgsl", "wgsl"),
];

/// The attributes that belong to the tests, not to the function that they call.
const OF_TESTS: [&str; 3] = ["ignore", "should_panic", "cfg"];

/// Returns the function, and a test for each variant that calls it.
pub(crate) fn variant_test(args: &TokenStream, item: TokenStream) -> TokenStream {
    let Ok(mut f) = syn::parse2::<syn::ItemFn>(item.clone()) else {
        let help = "write `#[variant_test] fn agrees(variant: Variant) { ... }`";
        return refused(&item, &item, "`#[variant_test]` stands on a function", help);
    };
    let mut errors = Errors::default();
    check_arguments(args, &mut errors);
    check_signature(&f.sig, &mut errors);
    if !errors.is_empty() {
        let errors = errors.into_tokens();
        return quote!(#[allow(dead_code, reason = "its tests have errors")] #f #errors);
    }
    let is_of_test = |a: &syn::Attribute| OF_TESTS.iter().any(|name| a.path().is_ident(name));
    let attributes: Vec<_> = f.attrs.iter().filter(|a| is_of_test(a)).cloned().collect();
    f.attrs.retain(|a| !is_of_test(a) || a.path().is_ident("cfg"));
    let tests = VARIANTS.iter().map(|variant| test(&f.sig, &attributes, variant));
    quote! {
        #[allow(dead_code, reason = "only tests call it")]
        #f
        #(#tests)*
    }
}

fn check_arguments(args: &TokenStream, errors: &mut Errors) {
    if !args.is_empty() {
        errors.at(args.span(), "`#[variant_test]` takes no arguments", "write `#[variant_test]`");
    }
}

fn check_signature(sig: &syn::Signature, errors: &mut Errors) {
    let help = "write `fn agrees(variant: Variant) { ... }`";
    if let Some(token) = &sig.asyncness {
        errors.at(token.span, "a test of variants cannot be `async`", help);
    }
    if !sig.generics.params.is_empty() {
        errors.at(sig.generics.span(), "a test of variants cannot be generic", help);
    }
    let takes_one = sig.inputs.len() == 1 && sig.receiver().is_none();
    if !takes_one {
        errors.at(sig.ident.span(), "a test of variants takes one parameter, the variant", help);
    }
}

/// Returns the text that `#[should_panic]` expects, if it is present.
fn expected_panic(attributes: &[syn::Attribute]) -> Option<String> {
    let attribute = attributes.iter().find(|a| a.path().is_ident("should_panic"))?;
    // `#[should_panic = "text"]`
    if let syn::Meta::NameValue(pair) = &attribute.meta
        && let syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Str(text), .. }) = &pair.value
    {
        return Some(text.value());
    }
    let mut expected = String::new();
    // A mistake in the attribute is reported by rustc.
    let _ = attribute.parse_nested_meta(|meta| {
        expected = meta.value()?.parse::<syn::LitStr>()?.value();
        Ok(())
    });
    Some(expected)
}

/// Returns the test of one variant. A function that returns a `Result` is skipped with `Ok(())`,
/// and one that should panic with that panic.
fn test(
    sig: &syn::Signature,
    attributes: &[syn::Attribute],
    (variant, end): &(&str, &str),
) -> TokenStream {
    let (function, output) = (&sig.ident, &sig.output);
    let name = format_ident!("{function}_{end}");
    let variant = format_ident!("{variant}");
    let skipped = match (expected_panic(attributes), output) {
        (Some(expected), _) => quote!(else { ::core::panic!("{}", #expected) }),
        (None, syn::ReturnType::Default) => quote!(),
        (None, syn::ReturnType::Type(..)) => quote!(else { ::core::result::Result::Ok(()) }),
    };
    quote! {
        #(#attributes)*
        #[test]
        fn #name() #output {
            let variant = ::raydsl::kernel::Variant::#variant;
            if ::raydsl::testing::can_run(variant, ::core::stringify!(#name)) {
                #function(variant)
            }
            #skipped
        }
    }
}

/// Returns a test that the WGSL of a `#[kernel] fn` is valid.
pub(crate) fn wgsl_test(input: TokenStream) -> TokenStream {
    let kernel = match syn::parse2::<syn::Path>(input) {
        Ok(kernel) => kernel,
        Err(e) => {
            let help = "write `wgsl_test!(name)` with the name of a `#[kernel] fn`";
            return syn::Error::new(e.span(), format!("{e}\n  help: {help}")).into_compile_error();
        }
    };
    let Some(last) = kernel.segments.last() else { return TokenStream::new() };
    let name = format_ident!("{}_has_valid_wgsl", last.ident);
    quote!(::raydsl::__wgsl_test!(#name, #kernel);)
}
