//! Tests that a mistake gives one error, with its remedy.

use proc_macro2::TokenStream;
use quote::quote;

use crate::{expand_closure, expand_kernel, expand_primitive, items, twin};

/// Returns the texts of the `compile_error!` calls in `tokens`.
pub(super) fn errors(tokens: TokenStream) -> Vec<String> {
    fn walk(tokens: TokenStream, found: &mut Vec<String>) {
        let all: Vec<_> = tokens.into_iter().collect();
        for (i, token) in all.iter().enumerate() {
            let proc_macro2::TokenTree::Group(g) = token else { continue };
            let before = |n: usize| i.checked_sub(n).map(|j| all[j].to_string());
            if before(1).as_deref() == Some("!") && before(2).as_deref() == Some("compile_error") {
                found.push(text(g.stream()));
            } else {
                walk(g.stream(), found);
            }
        }
    }
    let mut found = Vec::new();
    walk(tokens, &mut found);
    found
}

fn text(literal: TokenStream) -> String {
    syn::parse2::<syn::LitStr>(literal).map(|l| l.value()).unwrap_or_default()
}

/// Asserts that there is exactly one error, with a remedy.
#[track_caller]
fn assert_one(tokens: TokenStream, what: &str, help: &str) {
    let found = errors(tokens);
    assert_eq!(found.len(), 1, "{found:#?}");
    let (first, rest) = found[0].split_once("\n  help: ").unwrap_or((&found[0], ""));
    assert!(first.contains(what), "{first:?} does not say {what:?}");
    assert!(rest.contains(help), "{rest:?} does not say {help:?}");
    assert!(!rest.is_empty() && !found[0].contains("__"), "{}", found[0]);
}

/// Asserts the error of a mistake in the body of a kernel: the same for `fn`, method and closure.
#[track_caller]
fn assert_body(body: TokenStream, what: &str, help: &str) {
    let f = quote!(fn f(x: f32, n: u32) -> f32 { #body });
    assert_one(expand_kernel(quote!(), f), what, help);
    let method = quote!(impl T { fn f(&self, x: f32, n: u32) -> f32 { #body } });
    assert_one(expand_kernel(quote!(), method), what, help);
    assert_one(expand_closure(quote!(|x: f32, n: u32| { #body })), what, help);
}

macro_rules! bodies {
    ($($name:ident: { $($body:tt)* } $what:literal $help:literal;)+) => {
        $(
            #[test]
            fn $name() {
                assert_body(quote!($($body)*), $what, $help);
            }
        )+
    };
}

bodies! {
    double_literal: { x * 2.0f64 } "compute in `f32`" "suffix `f32`";
    other_integer: { x * 2u64 as f32 } "no `u64`" "`u32`";
    text_literal: { let _ = "text"; x } "numbers and truth values" "outside";
    sine_method: { x.sin() } "`sin`" "write `sin(x)`, the function of raydsl's prelude";
    power_method: { x.powf(2.0) } "`powf`" "write `pow(x, y)`";
    cube_root_method: { x.cbrt() } "`cbrt`" "capture the result";
    unwrapped: { g(x).unwrap() } "`unwrap`" "`unwrap_or(x)`";
    heap: { let v = vec![x]; x } "`vec!`" "no heap";
    printing: { println!("{x}"); x } "`println!`" "return the value";
    assertion: { assert!(x > 0.0); x } "`assert!`" "cannot stop";
    inner_closure: { let f = (|y: f32| y, x); x } "no closures" "let f =";
    moving_closure: { let f = move |y: f32| y * x; f(x) } "no `move`" "remove `move`";
    closure_without_type: { let f = |y| y * x; f(x) } "needs a type" "|ray: Ray|";
    rest_in_the_middle: { let [a, .., b] = [x, x, x]; a + b } "stands last" "write `_`";
    named_rest: { let [a, b @ ..] = [x, x, x]; a } "without a name" "write `_`";
    order_of_index: { let mut v = [x, x]; v[g(n)] += h(x); x } "comes first" "bind the index";
    no_range: { for i in list() {} x } "runs over a range" "list.iter()";
    mutable_reference: { let y = &mut x; *y } "`&mut` outside the arguments" "variable itself";
    half_range: { for i in 0u32.. {} x } "two bounds" "a..=b";
    empty_match: { match n {} } "needs an arm" "_ => value";
    pattern_without_value: { let (a, b); x } "needs a value" "each name by itself";
    by_reference: { let (ref a, b) = g(x); b } "no `ref`" "copied";
    rest_in_front: { let (.., a) = g(x); a } "stands last" "write `_`";
    tuple_struct: { Meters(x) } "no tuple structs" "named member";
    result: { Ok::<f32, u32>(x) } "no `Result`" "says what happened";
    mapped: { [x, x].map(|y| y * 2.0)[0] } "no `map`" "write a `for`";
    summed: { values.iter().map(|y| y * 2.0).sum() } "no `sum`" "sum += x";
    sine_of_type: { f32::sin(x) } "no `f32::sin`" "write `sin(x)`";
    maximum_of_std: { std::cmp::max(n, 2) as f32 } "no `std::cmp::max`" "write `max(a, b)`";
    swapped: { core::mem::swap(&mut v[g(n)], &mut v[0]); x } "evaluated twice" "bind the index";
    filled: { let mut v = [x, x]; v.fill(1.0); x } "no `fill`" "new array";
    inner_function: { fn g() {} x } "cannot stand inside a kernel" "move it out";
    assignment_to_a_call: { g(x) = 1.0; x } "cannot assign to this" "a variable";
    unsafe_block: { unsafe { x } } "no `unsafe`" "safe code";
    attribute_in_parentheses: { (#[cfg(any())] x) } "attributes on statements" "remove";
    attribute_behind_reference: { g(&#[cold] x) } "attributes on statements" "remove";
    statement_attribute: { #[cold] if x > 0.0 { } x } "attributes on statements" "remove";
}

#[test]
fn closures_are_refused_what_functions_are() {
    let of = expand_closure;
    assert_one(of(quote!(async |x: f32| x)), "cannot be `async`", "remove `async`");
    assert_one(of(quote!(|x: f32| -> &mut f32 { x })), "gives no `&mut`", "give the value");
    let host = quote!(|#[host] (a, b): (u32, u32)| a + b);
    assert_one(of(host), "`#[host]` parameter has one name", "size.0");
}

#[track_caller]
fn assert_kernel(item: TokenStream, what: &str, help: &str) {
    assert_one(expand_kernel(quote!(), item), what, help);
}

#[test]
fn signatures() {
    assert_kernel(
        quote!(
            fn f(light: impl Light) -> f32 {
                light.power()
            }
        ),
        "have names",
        "fn f<T: Light>(light: T)",
    );
    let f = quote!(
        fn f(s: &mut S) -> &mut S {
            s
        }
    );
    assert_kernel(f, "gives no `&mut`", "give the value");
    assert_kernel(
        quote!(
            async fn f(x: f32) -> f32 {
                x
            }
        ),
        "cannot be `async`",
        "remove",
    );
    assert_kernel(
        quote!(
            unsafe fn f(x: f32) -> f32 {
                x
            }
        ),
        "cannot be `unsafe`",
        "remove",
    );
    assert_kernel(
        quote!(
            impl S {
                fn f<T: Light>(&self, light: T) {}
            }
        ),
        "no type parameters of its own",
        "#[kernel] fn",
    );
    assert_kernel(quote!(impl S { #[cfg(test)] fn f(&self) {} }), "no `#[cfg]`", "impl of its own");
    let f = quote!(
        fn f<T>(&self, t: T);
    );
    assert_kernel(quote!(trait A { #f }), "no type parameters of its own", "#[kernel] fn");
    assert_kernel(
        quote!(
            struct S;
        ),
        "stands on a function",
        "kernel!",
    );
}

/// Tests that nothing may change through an alias of a `&mut` parameter.
#[test]
fn second_names() {
    let f = quote!(
        fn f(s: &mut S) {
            let r = s;
            r.x += 1.0;
        }
    );
    assert_kernel(f, "cannot assign through `r`", "parameter itself");
    let f = quote!(
        fn f(s: &mut S) {
            let S { x, y } = s;
            *x += *y;
        }
    );
    assert_kernel(f, "cannot assign through `x`", "parameter itself");
    let f = quote!(
        fn f(s: &mut S) {
            let mut r = s;
            r.x += 1.0;
        }
    );
    assert_kernel(f, "no second name", "copy the value");
    let f = quote!(
        fn f((x, y): &mut (f32, f32)) {
            *x += *y;
        }
    );
    assert_kernel(f, "has one name", "s: &mut S");
}

#[test]
fn recursion() {
    let f = quote!(
        fn f(x: f32) -> f32 {
            if x > 1.0 { f(x * 0.5) } else { x }
        }
    );
    assert_kernel(f, "calls itself", "write a loop");
}

#[test]
fn closures() {
    let one = |c: TokenStream, what, help| assert_one(expand_closure(c), what, help);
    one(quote!(|x: &mut f32| *x), "no `&mut` parameters", "return the new value");
    one(quote!(|x: f32| f(&mut total, x)), "assign to `total`", "inside the kernel");
    one(quote!(|ray| ray.t_min), "needs a type", "|ray: Ray|");
    one(quote!(|| 1.0), "needs a parameter", "|ray: Ray|");
    one(
        quote!(|x: f32| {
            total += x;
            x
        }),
        "assign to `total`",
        "inside the kernel",
    );
    one(
        quote!(|x: f32| {
            state.count = x;
            x
        }),
        "assign to `state`",
        "inside the kernel",
    );
    one(quote!(1 + 2), "", "kernel!(|ray: Ray|");
}

#[test]
fn primitives() {
    let one = |item: TokenStream, what, help| {
        assert_one(expand_primitive(quote!(), item), what, help);
    };
    let bounds = quote!(
        fn get_bounds(&self) -> Aabb {
            Aabb::EMPTY
        }
    );
    let intersect = quote!(
        fn intersect(&self, ray: Ray) -> Hit {
            Hit::miss()
        }
    );
    one(quote!(impl S { #bounds }), "no `intersect`", "fn intersect(&self, ray: Ray) -> Hit");
    one(quote!(impl S { #intersect }), "no `get_bounds`", "fn get_bounds(&self) -> Aabb");
    one(
        quote!(
            struct S(f32);
        ),
        "named member",
        "member: f32",
    );
    one(
        quote!(
            struct S;
        ),
        "named member",
        "member: f32",
    );
    one(
        quote!(
            enum S {
                A,
            }
        ),
        "holds one primitive",
        "write `A(Sphere)`",
    );
    one(
        quote!(
            struct S<T> {
                a: T,
            }
        ),
        "cannot be generic",
        "for each type",
    );
    one(
        quote!(
            fn f() {}
        ),
        "stands on a struct",
        "#[primitive] struct",
    );
}

#[test]
fn forwarded_methods() {
    let one = |args: TokenStream, what, help| {
        let item = quote!(
            enum S {
                A(Ball),
                B(Triangle),
            }
        );
        assert_one(expand_primitive(args, item), what, help);
    };
    one(quote!(normal, tangent), "cannot forward `tangent`", "`surface_point`, `normal`, `uv`");
    one(quote!(area, normal, area), "`area` is there twice", "leave one of them out");
    one(quote!(sphere(center, radius)), "takes names of methods", "`Surface`, or nothing");
    one(quote!(area = 1), "takes names of methods", "`sample`");
}

#[test]
fn data_that_kinds_share() {
    let one = |args: TokenStream, what, help| {
        let item = quote!(
            enum S {
                A(Ball),
                B(IndexedTriangle),
            }
        );
        assert_one(expand_primitive(args, item), what, help);
    };
    one(quote!(shared), "names the types of data", "write `shared(A, B)`");
    one(quote!(shared(Vec3)), "whose kinds share different data", "or nothing if there is one");
    one(quote!(shared(Vec3, f32, Vec3)), "`Vec3` is there twice", "name it once");
    one(quote!(shared(Vec3, f32, u32, i32)), "at most 3 types", "a tree of their own");
    one(quote!(shared(Vec3, f32), shared(u32, i32)), "`shared` is there twice", "into one");
}

/// Mistakes in the arguments and in the kinds are said at once.
#[test]
fn arguments_and_kinds() {
    for (args, what) in [
        (quote!(tangent), "cannot forward `tangent`"),
        (quote!(shared(Vec3)), "whose kinds share different data"),
    ] {
        let item = quote!(
            enum S {
                A(Ball),
                Nothing,
            }
        );
        let found = errors(expand_primitive(args, item));
        assert_eq!(found.len(), 2, "{found:#?}");
        assert!(found.iter().any(|e| e.contains(what)), "{found:#?}");
        assert!(found.iter().any(|e| e.contains("holds one primitive")), "{found:#?}");
    }
}

#[test]
fn derives() -> syn::Result<()> {
    for (item, what) in [
        (
            quote!(
                struct S(f32);
            ),
            "named member",
        ),
        (
            quote!(
                enum S {
                    A,
                }
            ),
            "two kinds or more",
        ),
        (
            quote!(
                enum S {
                    A = 3,
                    B(f32),
                }
            ),
            "no number of its own",
        ),
        (
            quote!(
                union S {
                    a: f32,
                }
            ),
            "only a struct or an enum",
        ),
    ] {
        let found = errors(twin::derive(&syn::parse2(item)?));
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].contains(what) && found[0].contains("help: "), "{found:?}");
    }
    for (item, what) in [
        (
            quote!(
                struct Both<'a> {
                    first: [P],
                    second: Bvh<'a, P>,
                }
            ),
            "of its own",
        ),
        (
            quote!(
                struct One<'a> {
                    only: dyn Scene + 'a,
                }
            ),
            "of any type",
        ),
    ] {
        let found = errors(items::scene(&syn::parse2(item)?, true));
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].contains(what) && found[0].contains("help: "), "{found:?}");
    }
    Ok(())
}

#[test]
fn arguments_of_attributes() {
    let f = quote!(
        fn f(x: f32) -> f32 {
            x
        }
    );
    assert_one(expand_kernel(quote!(fast), f), "takes no arguments", "#[kernel]");
    let s = quote!(
        struct S {
            a: f32,
        }
    );
    assert_one(expand_primitive(quote!(fast), s), "takes a shape, or nothing", "#[primitive]");
}

/// Tests names that only user types may have.
#[test]
fn names_of_methods() {
    for own in [
        quote!(
            fn f(s: Spectrum) -> f32 {
                s.exp() + s.clone().len() + Spectrum::iter(&s)
            }
        ),
        quote!(
            fn f(x: f32) -> f32 {
                let s = Spectrum { a: x };
                s.iter() + s.unwrap()
            }
        ),
    ] {
        assert!(errors(expand_kernel(quote!(), own)).is_empty());
    }
    let unknown = quote!(
        fn f(s: Holder) -> f32 {
            s.list.iter()
        }
    );
    assert_one(expand_kernel(quote!(), unknown), "no `iter`", "`Type::iter(&x)`");
    let local = quote!(
        fn f(v: Vec3) -> f32 {
            let a = v.x * 2.0;
            a.abs().exp()
        }
    );
    assert_one(expand_kernel(quote!(), local), "`exp`", "write `exp(x)`");
}

#[test]
fn operators_of_references() {
    let i = quote!(
        impl Add<&S> for S {
            type Output = S;
            fn add(self, o: &S) -> S {
                o
            }
        }
    );
    assert_one(expand_kernel(quote!(), i), "takes values", "`impl Add for Spectrum`");
}

/// Tests that all mistakes of a kernel are reported at once, each once.
#[test]
fn several_at_once() {
    let f = quote! {
        fn f(x: f32, y: impl Copy) -> f32 {
            let mut i = 0;
            let y = x.sin() + 2.0f64;
            for j in 0..4 {}
            [y][0..1] + y
        }
    };
    let found = errors(expand_kernel(quote!(), f));
    assert_eq!(found.len(), 4, "{found:#?}");
    assert!(found.iter().all(|e| e.contains("\n  help: ")), "{found:#?}");
    let c = quote!(|a, x: f32| {
        total = x;
        vec![x];
        x.cos()
    });
    let found = errors(expand_closure(c));
    assert_eq!(found.len(), 4, "{found:#?}");
    let i = quote!(impl S { fn rgb(&self, x: f32) -> f32 { x.exp() } });
    let found = errors(expand_primitive(quote!(), i));
    assert_eq!(found.len(), 3, "{found:#?}");
}

/// Tests that with an error the user's item is still there, so that nothing else is reported
/// missing.
#[test]
fn the_item_stays() {
    let f = quote!(
        fn f(x: f32) -> f32 {
            x.sin()
        }
    );
    assert!(expand_kernel(quote!(), f.clone()).to_string().starts_with(&f.to_string()));
    let s = quote!(
        struct S(f32);
    );
    assert!(expand_primitive(quote!(), s.clone()).to_string().contains(&s.to_string()));
}

#[test]
fn tests_of_variants_take_a_variant() {
    use crate::variant_test::{variant_test, wgsl_test};
    let of = |f| variant_test(&quote!(), f);
    let help = "fn agrees(variant: Variant)";
    assert_one(
        of(quote!(
            fn f() {}
        )),
        "takes one parameter",
        help,
    );
    assert_one(
        of(quote!(
            fn f<T>(variant: T) {}
        )),
        "cannot be generic",
        help,
    );
    assert_one(
        of(quote!(
            async fn f(variant: Variant) {}
        )),
        "cannot be `async`",
        help,
    );
    assert_one(
        of(quote!(
            struct S;
        )),
        "stands on a function",
        help,
    );
    let with_arguments = variant_test(
        &quote!(packets),
        quote!(
            fn f(variant: Variant) {}
        ),
    );
    assert_one(with_arguments, "takes no arguments", "#[variant_test]");
    assert_one(wgsl_test(quote!(1 + 1)), "expected identifier", "#[kernel] fn");
}
