//! Attributes within kernels.

use proc_macro2::Ident;
use syn::spanned::Spanned;

use super::Parser;

/// Returns whether it is `#[host]`.
pub(super) fn is_host(a: &syn::Attribute) -> bool {
    a.path().is_ident("host")
}

/// Returns whether it is `#[inline(never)]`.
pub(super) fn is_never_inlined(a: &syn::Attribute) -> bool {
    a.path().is_ident("inline") && a.parse_args::<Ident>().is_ok_and(|how| how == "never")
}

/// Returns whether it is `#[inline(always)]`.
pub(super) fn is_always_inlined(a: &syn::Attribute) -> bool {
    a.path().is_ident("inline") && a.parse_args::<Ident>().is_ok_and(|how| how == "always")
}

/// Returns whether it is `#[coherent]`.
pub(super) fn is_coherent(a: &syn::Attribute) -> bool {
    a.path().is_ident("coherent")
}

/// Returns the attributes of an expression.
pub(super) fn attributes(e: &syn::Expr) -> &[syn::Attribute] {
    macro_rules! all {
        ($($kind:ident)+) => {
            match e {
                $(syn::Expr::$kind(x) => &x.attrs,)+
                _ => &[],
            }
        };
    }
    all!(
        Array Assign Async Await Binary Block Break Call Cast Closure Const Continue Field
        ForLoop Group If Index Infer Let Lit Loop Macro Match MethodCall Paren Path Range
        Reference Repeat Return Struct Try TryBlock Tuple Unary Unsafe While Yield
    )
}

impl Parser<'_> {
    /// Refuses attributes that the lifted code would ignore, such as `#[cfg]`.
    pub(super) fn no_attributes(&mut self, attrs: &[syn::Attribute]) {
        let is_known =
            |a: &&syn::Attribute| a.path().is_ident("allow") || is_host(a) || is_coherent(a);
        for a in attrs.iter().filter(|a| !is_known(a)) {
            self.errors.at(
                a.span(),
                "a kernel has no attributes on statements and expressions",
                "remove it; to leave code out, branch on a captured `bool` or a `const`",
            );
        }
    }
}
