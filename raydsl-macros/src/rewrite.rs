//! Rewriting of source that remains Rust.

use proc_macro2::{Delimiter, Group, Ident, TokenStream, TokenTree};
use quote::{ToTokens, quote};
use syn::parse::Parser as _;

/// Returns whether `#` and what follows are the attribute `#[name]`.
fn is_attribute(hash: &TokenTree, brackets: &TokenTree, name: &str) -> bool {
    let TokenTree::Group(g) = brackets else { return false };
    matches!(hash, TokenTree::Punct(p) if p.as_char() == '#')
        && g.delimiter() == Delimiter::Bracket
        && g.stream().to_string() == name
}

fn within_groups(token: TokenTree, f: fn(TokenStream) -> TokenStream) -> TokenTree {
    let TokenTree::Group(g) = token else { return token };
    let mut inside = Group::new(g.delimiter(), f(g.stream()));
    inside.set_span(g.span());
    TokenTree::Group(inside)
}

/// Returns the source without the attributes `#[host]` and `#[coherent]`, which only the lowering
/// understands.
pub(crate) fn without_markers(source: TokenStream) -> TokenStream {
    let tokens: Vec<TokenTree> = source.into_iter().collect();
    let mut out = TokenStream::new();
    let mut rest = &tokens[..];
    while let Some((first, others)) = rest.split_first() {
        rest = others;
        let is_marker =
            |second| is_attribute(first, second, "host") || is_attribute(first, second, "coherent");
        if others.first().is_some_and(is_marker) {
            rest = &others[1..];
            continue;
        }
        out.extend([within_groups(first.clone(), without_markers)]);
    }
    out
}

/// The names of generated type parameters, and their names in messages. The user's own, of any
/// name, are beside them.
const READABLE: [(&str, &str); 5] = [
    ("__M", "AnyMachine"),
    ("__Args", "AnyArguments"),
    ("__Right", "AnyOperand"),
    ("__Via", "AnyTrait"),
    ("__NAME", "ANY_NAME"),
];

/// Returns generated code whose type parameters have readable names in rustc's messages; while it
/// is generated, they begin with `__`, like other generated names.
pub(crate) fn with_readable_names(generated: TokenStream) -> TokenStream {
    let token = |token| match token {
        TokenTree::Ident(i) => TokenTree::Ident(readable_name(i)),
        token => within_groups(token, with_readable_names),
    };
    generated.into_iter().map(token).collect()
}

fn readable_name(ident: Ident) -> Ident {
    let text = ident.to_string();
    if let Some((_, readable)) = READABLE.iter().find(|(name, _)| *name == text) {
        return Ident::new(readable, ident.span());
    }
    match text.strip_prefix("__A").map(str::parse::<u32>) {
        Some(Ok(i)) => Ident::new(&format!("Argument{i}"), ident.span()),
        _ => ident,
    }
}

/// Replaces `#[kernel] |ray: Ray| ...` by `kernel!(|ray: Ray| ...)`, at any depth.
pub(crate) fn kernel_closures(source: TokenStream) -> TokenStream {
    let tokens: Vec<TokenTree> = source.into_iter().collect();
    let mut out = TokenStream::new();
    let mut at = 0;
    while let Some(first) = tokens.get(at) {
        let marked = tokens.get(at + 1).is_some_and(|second| is_attribute(first, second, "kernel"));
        if marked && let Some((closure, rest)) = leading_closure(&tokens[at + 2..]) {
            let closure = kernel_closures(closure);
            out.extend(quote!(::raydsl::prelude::kernel!(#closure)));
            at = tokens.len() - rest;
            continue;
        }
        out.extend([within_groups(first.clone(), kernel_closures)]);
        at += 1;
    }
    out
}

/// Returns the closure that `tokens` begin with, and the number of tokens after it.
fn leading_closure(tokens: &[TokenTree]) -> Option<(TokenStream, usize)> {
    let begins = match tokens.first()? {
        TokenTree::Punct(p) => p.as_char() == '|',
        TokenTree::Ident(i) => i == "move",
        _ => false,
    };
    if !begins {
        return None;
    }
    let parse = |input: syn::parse::ParseStream<'_>| {
        let closure: syn::ExprClosure = input.parse()?;
        let rest: TokenStream = input.parse()?;
        Ok((closure.to_token_stream(), rest.into_iter().map(|token| leaves(&token)).sum::<usize>()))
    };
    let (closure, rest) = parse.parse2(tokens.iter().cloned().collect()).ok()?;
    // A closure that ends within a fragment of a macro is left to rustc.
    let mut after = 0;
    for (count, token) in tokens.iter().rev().enumerate() {
        if after == rest {
            return Some((closure, count));
        }
        after += leaves(token);
    }
    None
}

/// Returns how many tokens syn sees: a group without delimiters, which is a fragment of a macro, is
/// what it contains.
fn leaves(token: &TokenTree) -> usize {
    match token {
        TokenTree::Group(group) if group.delimiter() == Delimiter::None => {
            group.stream().into_iter().map(|token| leaves(&token)).sum()
        }
        _ => 1,
    }
}
