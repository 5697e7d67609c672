//! Type and constant parameters of kernels and types.

use proc_macro2::{Ident, TokenStream, TokenTree};
use quote::{ToTokens, quote};

use crate::model::Signature;

/// Generic parameters, formatted for angle brackets: each list ends with a comma.
///
/// Lifetimes are omitted: values on a machine are copied.
#[derive(Clone, Default)]
pub(crate) struct Generics {
    /// With their bounds: `T: Light, const N: usize,`.
    pub(crate) declared: TokenStream,
    /// Without bounds: `T, const N: usize,`.
    pub(crate) bare: TokenStream,
    /// As arguments: `T, N,`.
    pub(crate) used: TokenStream,
    /// The types' names.
    pub(crate) types: Vec<Ident>,
    /// The types that are scenes, and their bounds.
    pub(crate) scenes: Vec<(Ident, TokenStream)>,
    /// Each parameter's name, and its declaration without bounds.
    names: Vec<(Ident, TokenStream)>,
    /// The predicates of a `where` clause.
    pub(crate) predicates: TokenStream,
}

impl Generics {
    pub(crate) fn new(generics: &syn::Generics) -> Self {
        Self::without(generics, &[])
    }

    /// Returns the parameters that are not closures, which are no types of kernels.
    pub(crate) fn without(generics: &syn::Generics, closures: &[(Ident, Signature)]) -> Self {
        let mut all = Self::default();
        let is_closure = |name: &str| closures.iter().any(|c| c.0 == name);
        for param in &generics.params {
            match param {
                syn::GenericParam::Type(t) if is_closure(&t.ident.to_string()) => {}
                syn::GenericParam::Type(t) => {
                    let (name, bounds) = (&t.ident, &t.bounds);
                    all.declared.extend(quote!(#name: #bounds,));
                    let unsized_too = bounds.iter().any(is_maybe_sized).then(|| quote!(: ?Sized));
                    all.bare.extend(quote!(#name #unsized_too,));
                    if bounds.iter().any(is_of_scenes) {
                        let bounds = bounds.iter().filter(|b| !is_maybe_sized(b));
                        all.scenes.push((name.clone(), quote!(#(#bounds)+*)));
                    }
                    all.used.extend(quote!(#name,));
                    all.types.push(name.clone());
                    all.names.push((name.clone(), quote!(#name)));
                }
                syn::GenericParam::Const(c) => {
                    let (name, ty) = (&c.ident, &c.ty);
                    all.declared.extend(quote!(const #name: #ty,));
                    all.bare.extend(quote!(const #name: #ty,));
                    all.used.extend(quote!(#name,));
                    all.names.push((name.clone(), quote!(const #name: #ty)));
                }
                syn::GenericParam::Lifetime(_) => {}
            }
        }
        let clause = generics.where_clause.iter().flat_map(|w| &w.predicates);
        for p in clause {
            match p {
                syn::WherePredicate::Lifetime(_) => continue,
                syn::WherePredicate::Type(t)
                    if is_closure(&t.bounded_ty.to_token_stream().to_string()) =>
                {
                    continue;
                }
                syn::WherePredicate::Type(t) if t.bounds.iter().any(is_of_scenes) => {
                    let ty = t.bounded_ty.to_token_stream().to_string();
                    let name = all.types.iter().find(|name| **name == ty);
                    let bounds = t.bounds.iter().filter(|b| !is_maybe_sized(b));
                    all.scenes.extend(name.cloned().map(|name| (name, quote!(#(#bounds)+*))));
                }
                _ => {}
            }
            let p = p.to_token_stream();
            all.predicates.extend(quote!(#p,));
        }
        all
    }

    /// Adds the parameters of another item.
    pub(crate) fn extend(&mut self, other: &Self) {
        self.declared.extend(other.declared.clone());
        self.bare.extend(other.bare.clone());
        self.used.extend(other.used.clone());
        self.types.extend_from_slice(&other.types);
        self.scenes.extend_from_slice(&other.scenes);
        self.names.extend_from_slice(&other.names);
        self.predicates.extend(other.predicates.clone());
    }

    /// Returns the parameters that `tokens` mention.
    pub(crate) fn mentioned_in(&self, tokens: &TokenStream) -> Self {
        let mut found = Self::default();
        for (name, bare) in self.names.iter().filter(|(name, _)| mentions(tokens, name)) {
            found.bare.extend(quote!(#bare,));
            found.used.extend(quote!(#name,));
        }
        found
    }

    /// Returns whether `tokens` mention one of the types.
    pub(crate) fn has_type_in(&self, tokens: &TokenStream) -> bool {
        self.types.iter().any(|t| mentions(tokens, t))
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.used.is_empty()
    }
}

/// Bounds that do not imply a type of kernels.
const OTHER_BOUNDS: &[&str] = &[
    "Clone",
    "Copy",
    "Debug",
    "Default",
    "Eq",
    "Hash",
    "Ord",
    "PartialEq",
    "PartialOrd",
    "Send",
    "Sized",
    "Sync",
];

/// Returns whether a bound does not say that the type is one that kernels have.
pub(crate) fn says_nothing_of_kernels(bound: &syn::TypeParamBound) -> bool {
    match bound {
        syn::TypeParamBound::Trait(t) => {
            t.path.segments.last().is_some_and(|s| OTHER_BOUNDS.iter().any(|o| s.ident == o))
        }
        _ => true,
    }
}

/// Returns whether a bound is `?Sized`.
fn is_maybe_sized(bound: &syn::TypeParamBound) -> bool {
    bound.to_token_stream().to_string().starts_with('?')
}

/// Returns whether a bound says that the type is a scene: `RayQuery`, `RecordQuery`, `Scene`, or a
/// trait whose name ends so. A reference to such a type is data, which kernels read in place.
fn is_of_scenes(bound: &syn::TypeParamBound) -> bool {
    let syn::TypeParamBound::Trait(t) = bound else { return false };
    t.path.segments.last().is_some_and(|last| {
        let name = last.ident.to_string();
        matches!(name.as_str(), "RayQuery" | "RecordQuery") || name.ends_with("Scene")
    })
}

/// Returns whether an identifier is among the tokens.
pub(crate) fn mentions(tokens: &TokenStream, name: &Ident) -> bool {
    let mut found = false;
    identifiers(tokens, &mut |i| found |= i == *name);
    found
}

/// Visits every identifier among the tokens.
pub(crate) fn identifiers(tokens: &TokenStream, visit: &mut dyn FnMut(Ident)) {
    for token in tokens.clone() {
        match token {
            TokenTree::Ident(i) => visit(i),
            TokenTree::Group(g) => identifiers(&g.stream(), visit),
            _ => {}
        }
    }
}
