//! Expansion of `#[kernel] impl Add for Spectrum`, and the other operators of a user's own type.

use proc_macro2::TokenStream;
use quote::{ToTokens, format_ident, quote};
use syn::spanned::Spanned;

use super::methods::Method;
use super::{Place, lifted_function, private};
use crate::diag::Errors;
use crate::generics::Generics;
use crate::ops;
use crate::parse;
use crate::rewrite::without_markers;

/// The function of an operator's trait, and its name in lifted code.
struct Operator {
    function: &'static str,
    symbol: String,
}

/// Returns the operator of the std trait `path`.
fn operator(path: &syn::Path) -> Option<Operator> {
    let name = path.segments.last()?.ident.to_string();
    if name == "Neg" {
        return Some(Operator { function: "neg", symbol: "-x".to_owned() });
    }
    let (name, assigns) = match name.strip_suffix("Assign") {
        Some(name) => (name.to_owned(), true),
        None => (name, false),
    };
    let op = ops::OVERLOADED.iter().find(|op| op.operator.strip_prefix("Op") == Some(&name))?;
    Some(match assigns {
        true => Operator { function: op.assigning, symbol: format!("{}=", op.symbol) },
        false => Operator { function: op.method, symbol: op.symbol.to_owned() },
    })
}

/// Returns whether the trait is an operator's.
pub(super) fn is_operator(item: &syn::ItemImpl) -> bool {
    item.trait_.as_ref().is_some_and(|(path, _)| operator(path).is_some())
}

/// Expands to the unchanged `impl`, the lifted function, and the items by which lifted code finds
/// it.
pub(super) fn operator_impl(item: &syn::ItemImpl, errors: &mut Errors) -> TokenStream {
    let source = without_markers(item.to_token_stream());
    let lifted = lifted_operator(item, errors).unwrap_or_default();
    quote!(#source #lifted)
}

fn lifted_operator(item: &syn::ItemImpl, errors: &mut Errors) -> Option<TokenStream> {
    let (path, _) = item.trait_.as_ref()?;
    let operator = operator(path)?;
    let right = right_operand(path);
    let are_values = check_operands(&item.self_ty, right.as_ref(), errors);
    // Without the function rustc's own error is the better one.
    let f = item.items.iter().find_map(|i| match i {
        syn::ImplItem::Fn(f) if f.sig.ident == operator.function => Some(f),
        _ => None,
    })?;
    if !are_values {
        return None;
    }
    let around = Generics::new(&item.generics);
    let sig = with_output(&f.sig, item);
    let self_ty = item.self_ty.to_token_stream();
    let kernel = parse::function(&f.attrs, &sig, &f.block, Some(&item.self_ty), errors);
    // A number has no impls of its own: the type on its right has them.
    let is_number = ["f32", "i32", "u32"].contains(&self_ty.to_string().as_str());
    let owner = match (&right, is_number) {
        (Some(right), true) => right.to_token_stream(),
        _ => self_ty.clone(),
    };
    let number = ops::hash(&quote!(#path for #self_ty).to_string());
    let fn_name = format_ident!("__{}_{number:x}", operator.function);
    let type_name = parse::type_name(&item.self_ty)?;
    let place = Place {
        fn_name: &fn_name,
        wgsl_name: &format!("{type_name}_{}", operator.function),
        self_ty: Some(&self_ty),
        around: &around,
        vis: &TokenStream::new(),
        is_method: true,
        asserts_self: false,
    };
    let function = lifted_function(&kernel, &place, errors);
    if kernel.is_broken {
        return None;
    }
    let Generics { declared, predicates, .. } = &around;
    let found = if is_number {
        on_the_right(&operator, &self_ty, &owner, &fn_name, &kernel, &around)
    } else {
        let method = Method {
            self_ty: &self_ty,
            called: quote!(<#self_ty>::#fn_name),
            name: &operator.symbol,
            around: &around,
            // There is one `Neg`; there is a `Mul` for each type on the right.
            through: (operator.symbol != "-x").then_some(path),
        };
        method.implementation(&kernel)
    };
    Some(quote! {
        impl<#declared> #owner where #predicates { #function }
        #found
    })
}

/// Checks that the operands are values: lifted code cannot distinguish references from them.
fn check_operands(left: &syn::Type, right: Option<&syn::Type>, errors: &mut Errors) -> bool {
    let is_reference = |ty: &&syn::Type| matches!(ty, syn::Type::Reference(_));
    let references: Vec<_> =
        [Some(left), right].into_iter().flatten().filter(is_reference).collect();
    for ty in &references {
        errors.at(
            ty.span(),
            "an operator of kernels takes values: the types of kernels are copied",
            "implement it for the type itself: `impl Add for Spectrum`, and write `a + b`",
        );
    }
    references.is_empty()
}

/// Returns `f32 * Spectrum`, as a method of `Spectrum`.
fn on_the_right(
    operator: &Operator,
    number: &TokenStream,
    owner: &TokenStream,
    fn_name: &proc_macro2::Ident,
    kernel: &crate::model::Kernel,
    around: &Generics,
) -> TokenStream {
    let p = private();
    let Generics { declared, predicates, .. } = around;
    let name = format!("{number} {}", operator.symbol);
    let own = |ty: &TokenStream| if ty.to_string() == "Self" { number.clone() } else { ty.clone() };
    let result = kernel.result.as_ref().map(own).unwrap_or_else(|| quote!(()));
    quote! {
        #[diagnostic::do_not_recommend]
        impl<#declared __M: #p::Machine>
            #p::HostMethod<{ #p::name(#name) }, __M, (<#number as #p::Type>::On<__M>,)> for #owner
        where
            #predicates
        {
            type This = <Self as #p::Type>::On<__M>;
            type Output = <#result as #p::Type>::On<__M>;

            #[inline(always)]
            fn call(
                this: <Self as #p::Type>::On<__M>,
                m: &__M,
                (number,): (<#number as #p::Type>::On<__M>,),
            ) -> <#result as #p::Type>::On<__M> {
                <#owner>::#fn_name(m, number, this)
            }
        }
    }
}

/// Returns the type between the angle brackets of `Mul<f32>`.
fn right_operand(path: &syn::Path) -> Option<syn::Type> {
    let syn::PathArguments::AngleBracketed(args) = &path.segments.last()?.arguments else {
        return None;
    };
    args.args.iter().find_map(|arg| match arg {
        syn::GenericArgument::Type(ty) => Some(ty.clone()),
        _ => None,
    })
}

/// Returns the signature with the `impl`'s type for `Self::Output`: the lifted function is outside
/// of the trait.
fn with_output(sig: &syn::Signature, item: &syn::ItemImpl) -> syn::Signature {
    let mut sig = sig.clone();
    let output = item.items.iter().find_map(|i| match i {
        syn::ImplItem::Type(t) if t.ident == "Output" => Some(&t.ty),
        _ => None,
    });
    if let (syn::ReturnType::Type(_, ty), Some(output)) = (&mut sig.output, output)
        && ty.to_token_stream().to_string() == quote!(Self::Output).to_string()
    {
        **ty = output.clone();
    }
    sig
}
