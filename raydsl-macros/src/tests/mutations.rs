//! Items that are changed at random: the macros give Rust that parses or errors with a remedy, and
//! never panic.
//!
//! `RAYDSL_FUZZ_MACROS` is the number of variants of each item, `RAYDSL_FUZZ_SEED` says which ones. Cargo
//! does not optimise crates of macros in release either, if it is not asked to:
//!
//! ```text
//! CARGO_PROFILE_RELEASE_BUILD_OVERRIDE_OPT_LEVEL=3 RAYDSL_FUZZ_MACROS=600000 RAYDSL_FUZZ_SEED=7 \
//!     cargo test --release -p raydsl-macros mutations
//! ```

use std::mem::discriminant;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};
use quote::quote;

use super::corpus::{CORPUS, Entry, STRAY};
use super::diagnostics::errors;
use crate::{expand_closure, expand_kernel, expand_kernels, expand_primitive, items, twin};

/// More than any of these small items takes, whatever else the machine does.
const LONGEST: Duration = Duration::from_secs(10);

fn number(name: &str, default: u64) -> u64 {
    match std::env::var(name) {
        Ok(text) => text.parse().unwrap_or_else(|e| panic!("{name}={text}: {e}")),
        Err(_) => default,
    }
}

/// Random numbers: SplitMix64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() % count.max(1) as u64) as usize
    }
}

fn tokens(text: &str) -> TokenStream {
    text.parse().unwrap_or_else(|e| panic!("{text}: {e}"))
}

/// A token or a group, somewhere in a stream.
fn any_token(random: &mut Random, stream: &TokenStream) -> Option<TokenTree> {
    let all: Vec<TokenTree> = stream.clone().into_iter().collect();
    let token = all.get(random.below(all.len()))?.clone();
    match &token {
        TokenTree::Group(group) if random.below(3) > 0 => {
            any_token(random, &group.stream()).or(Some(token))
        }
        _ => Some(token),
    }
}

/// Changes one place of a stream; tokens may come from another.
fn changed(random: &mut Random, stream: TokenStream, other: &TokenStream) -> TokenStream {
    let mut all: Vec<TokenTree> = stream.into_iter().collect();
    let at = random.below(all.len());
    if let Some(TokenTree::Group(group)) = all.get(at)
        && random.below(6) > 0
    {
        let within = changed(random, group.stream(), other);
        all[at] = Group::new(group.delimiter(), within).into();
        return all.into_iter().collect();
    }
    match random.below(14) {
        _ if all.is_empty() => all.extend(any_token(random, other)),
        // Most items stay items if a token is replaced by one of its kind.
        7.. => {
            let of_its_kind = |t: &TokenTree| discriminant(t) == discriminant(&all[at]);
            let mut tries = (0..20).filter_map(|_| any_token(random, other));
            if let Some(token) = tries.find(of_its_kind) {
                all[at] = token;
            }
        }
        0 => drop(all.remove(at)),
        1 => all.insert(at, all[at].clone()),
        2 => {
            let with = random.below(all.len());
            all.swap(at, with);
        }
        3 => all.extend(any_token(random, other)),
        4 => {
            if let Some(token) = any_token(random, other) {
                all[at] = token;
            }
        }
        5 => {
            let stray = tokens(STRAY[random.below(STRAY.len())]);
            all.splice(at..=at, stray);
        }
        _ => {
            let kinds =
                [Delimiter::Parenthesis, Delimiter::Brace, Delimiter::Bracket, Delimiter::None];
            let count = 1 + random.below((all.len() - at).min(6));
            let within: TokenStream = all.drain(at..at + count).collect();
            all.insert(at, Group::new(kinds[random.below(kinds.len())], within).into());
        }
    }
    all.into_iter().collect()
}

/// Whether a generic parameter or a field is `_`: syn takes it for a name, rustc does not.
fn has_nameless(item: &syn::Item) -> bool {
    let of = |fields: &syn::Fields| fields.iter().filter_map(|f| f.ident.clone()).collect();
    let (generics, fields): (_, Vec<syn::Ident>) = match item {
        syn::Item::Fn(f) => (&f.sig.generics, Vec::new()),
        syn::Item::Impl(i) => (&i.generics, Vec::new()),
        syn::Item::Trait(t) => (&t.generics, Vec::new()),
        syn::Item::Struct(s) => (&s.generics, of(&s.fields)),
        syn::Item::Enum(e) => {
            (&e.generics, e.variants.iter().flat_map(|v| -> Vec<_> { of(&v.fields) }).collect())
        }
        _ => return false,
    };
    generics.type_params().map(|p| &p.ident).chain(&fields).any(|name| name == "_")
}

/// What a macro makes of an item; `None` of what rustc refuses before it asks a macro.
fn expanded(entry: Entry, item: TokenStream) -> Option<TokenStream> {
    let is_item = || syn::parse2::<syn::Item>(item.clone()).is_ok_and(|item| !has_nameless(&item));
    let derived = |f: fn(&syn::DeriveInput) -> TokenStream| {
        syn::parse2::<syn::DeriveInput>(item.clone())
            .ok()
            .filter(|_| is_item())
            .map(|item| f(&item))
    };
    match entry {
        Entry::Closure => Some(expand_closure(item)),
        Entry::Kernel => is_item().then(|| expand_kernel(quote!(), item)),
        Entry::Kernels => is_item().then(|| expand_kernels(quote!(), item)),
        Entry::Primitive(args) => is_item().then(|| expand_primitive(tokens(args), item)),
        Entry::Type => derived(twin::derive),
        Entry::HitRecord => derived(twin::hit_record),
        Entry::Scene => derived(|item| items::scene(item, true)),
        Entry::RayQuery => derived(|item| items::scene(item, false)),
    }
}

/// Panics if the expansion is no Rust, or an error has no remedy.
fn check(entry: Entry, expansion: &TokenStream) {
    let is_rust = match entry {
        Entry::Closure => syn::parse2::<syn::Expr>(expansion.clone()).map(drop),
        _ => syn::parse2::<syn::File>(expansion.clone()).map(drop),
    };
    if let Err(e) = is_rust {
        panic!("it expands to what is no Rust ({e}): {expansion}");
    }
    for error in errors(expansion.clone()) {
        assert!(!error.is_empty() && !error.contains("__"), "{error:?}");
    }
}

#[test]
fn mutations() {
    let count = number("RAYDSL_FUZZ_MACROS", 300);
    let seed = number("RAYDSL_FUZZ_SEED", 1);
    let items: Vec<TokenStream> = CORPUS.iter().map(|(_, text)| tokens(text)).collect();
    let mut expansions = 0u64;
    for (index, (entry, _)) in CORPUS.iter().enumerate() {
        for round in 0..count {
            let mut random = Random((seed << 40) + ((index as u64) << 32) + round);
            let other = &items[random.below(items.len())];
            let mut item = items[index].clone();
            for _ in 0..=random.below(2) {
                item = changed(&mut random, item, other);
            }
            let start = Instant::now();
            let text = item.to_string();
            let expand = || {
                if let Some(expansion) = expanded(*entry, item) {
                    check(*entry, &expansion);
                    return 1;
                }
                0
            };
            let case = format!("seed {seed}, item {index}, round {round}: {text}");
            match catch_unwind(AssertUnwindSafe(expand)) {
                Ok(one) => expansions += one,
                Err(panic) => {
                    eprintln!("{case}");
                    std::panic::resume_unwind(panic);
                }
            }
            assert!(start.elapsed() < LONGEST, "it took {:?}: {case}", start.elapsed());
        }
    }
    println!("{expansions} of {} variants reached a macro", count * CORPUS.len() as u64);
    assert!(expansions > count, "hardly any variant is an item");
}

/// They once expanded to what is no Rust.
#[test]
fn variants_that_failed() {
    let cases = [
        (Entry::Kernel, "impl Particle + { fn mass(self) -> f32 { 1.0 } }"),
        (Entry::Kernel, "impl Shade for Particle + { fn shade(self) -> f32 { 1.0 } }"),
        (Entry::Scene, "struct Both<'a> { first: List<'a, Ball>, second: Bvh<'a, Wall> + }"),
        (Entry::RayQuery, "struct One<'a> { only: Bvh<'a, Wall> + }"),
        (Entry::Type, "struct Pair { a: f32, b: Vec3 + }"),
        (Entry::HitRecord, "struct Met { t: f32, id: u32, is_hit: bool, b: Vec3 + }"),
        (Entry::Primitive(""), "impl Sphere + { fn get_bounds(&self) -> Aabb { Aabb::EMPTY } }"),
    ];
    for (entry, text) in cases {
        let Some(expansion) = expanded(entry, tokens(text)) else { panic!("no item: {text}") };
        check(entry, &expansion);
        assert_ne!(errors(expansion), Vec::<String>::new(), "{text}");
    }
}

/// Unchanged, all of them are right.
#[test]
fn the_items_that_are_changed_are_right() {
    for (entry, text) in CORPUS {
        let Some(expansion) = expanded(*entry, tokens(text)) else { panic!("no item: {text}") };
        check(*entry, &expansion);
        assert_eq!(errors(expansion), Vec::<String>::new(), "{text}");
    }
}
