//! Tests of the macros' output against `golden/*.rs`.

use std::path::Path;

use proc_macro2::TokenStream;
use quote::quote;

use crate::{expand_closure, expand_kernel, expand_primitive, twin};

/// Compares with the file, or writes it.
#[track_caller]
fn assert_golden(name: &str, tokens: TokenStream) {
    let file = match syn::parse2::<syn::File>(tokens.clone()) {
        Ok(file) => file,
        Err(e) => panic!("{name}: {e}\n{tokens}"),
    };
    let text = prettyplease::unparse(&file);
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("golden").join(format!("{name}.rs"));
    if std::env::var("RAYDSL_BLESS").is_ok_and(|v| v == "1") {
        if let Err(e) = std::fs::write(&path, text) {
            panic!("{}: {e}", path.display());
        }
        return;
    }
    let expected = match std::fs::read_to_string(&path) {
        Ok(text) => text,
        Err(e) => panic!("{}: {e}; RAYDSL_BLESS=1 writes it", path.display()),
    };
    let differs = expected.lines().zip(text.lines()).position(|(a, b)| a != b);
    let line = differs.unwrap_or_else(|| expected.lines().count().min(text.lines().count()));
    assert!(
        expected == text,
        "{} differs from line {} on; RAYDSL_BLESS=1 rewrites it\n expected {:?}\n    found {:?}",
        path.display(),
        line + 1,
        expected.lines().nth(line),
        text.lines().nth(line),
    );
}

#[test]
fn straight_line() {
    let f = quote! {
        /// Documented.
        pub fn smooth(x: f32, n: u32) -> f32 {
            let t = clamp(x, 0.0, 1.0);
            t * t * (3.0 - 2.0 * t) + n as f32
        }
    };
    assert_golden("straight_line", expand_kernel(quote!(), f));
}

#[test]
fn control_flow() {
    let f = quote! {
        fn walk(x: f32, n: u32) -> f32 {
            let mut sum = 0.0;
            'outer: for i in 0..n {
                while sum < x {
                    sum += 1.0;
                    if sum > 10.0 {
                        break 'outer;
                    } else if x < 0.0 && 1u32 / i > 0 {
                        continue;
                    }
                    if i == 3 {
                        return sum;
                    }
                    sum *= 2.0;
                }
            }
            let last;
            if sum > x {
                last = if x > 0.0 { x } else { -x };
            } else {
                last = 0.0;
            }
            sum + last
        }
    };
    assert_golden("control_flow", expand_kernel(quote!(), f));
}

#[test]
fn places() {
    let f = quote! {
        fn push(p: &Particle, mut by: Vec3) -> Particle {
            let mut q = *p;
            by.x = -by.x;
            q.position.y += by.y;
            q = Particle { mass: 1.0, ..q };
            q
        }
    };
    assert_golden("places", expand_kernel(quote!(), f));
}

#[test]
fn methods() {
    let i = quote! {
        impl Particle {
            pub fn moved(&self, by: Vec3) -> Self {
                Self { position: self.position + by, ..*self }
            }
            fn at_rest() -> Particle {
                Particle::new(0.0).moved(Vec3::ZERO)
            }
        }
    };
    assert_golden("methods", expand_kernel(quote!(), i));
}

#[test]
fn closure() {
    let c = quote! {
        |ray: Ray| {
            let hit = bvh.closest_hit(ray);
            if hit.is_hit { bvh.primitive(hit).rgb() } else { background }
        }
    };
    let tokens = expand_closure(c);
    assert_golden("closure", quote!(fn main() { #tokens; }));
}

#[test]
fn primitive() {
    let s = quote! {
        /// A sphere.
        #[derive(Debug)]
        pub struct ColorSphere {
            pub center: Vec3,
            radius: Unorm8,
            color: [Unorm8; 3],
        }
    };
    assert_golden("primitive", expand_primitive(quote!(), s));
    let i = quote! {
        impl ColorSphere {
            const SLACK: f32 = sphere::SLACK;
            fn intersect(&self, ray: Ray) -> Hit {
                sphere::intersect(ray, self.center, self.radius.to_f32())
            }
            fn get_bounds(&self) -> Aabb {
                Aabb::from_sphere(self.center, self.radius.to_f32())
            }
        }
    };
    assert_golden("primitive_impl", expand_primitive(quote!(), i));
}

#[test]
fn derived_type() -> syn::Result<()> {
    let item = syn::parse2(quote! {
        struct Sample { value: f32, count: u32 }
    })?;
    assert_golden("derived_type", twin::derive(&item));
    Ok(())
}

/// Tests that the user's own function is unchanged and in front of everything.
#[test]
fn the_source_stays() {
    let f = quote!(
        fn twice(x: f32) -> f32 {
            2.0 * x
        }
    );
    let text = expand_kernel(quote!(), f.clone()).to_string();
    assert!(text.starts_with(&f.to_string()), "{text}");
}

#[test]
fn variant_test() {
    let f = quote! {
        /// Kernels agree.
        #[ignore = "slow"]
        fn agrees(variant: Variant) -> Result<(), Error> {
            check(variant)
        }
    };
    let tests = crate::variant_test::variant_test(&quote!(), f);
    let f = quote! {
        #[should_panic(expected = "too far")]
        fn panics(variant: Variant) {
            check(variant);
        }
    };
    let panics = crate::variant_test::variant_test(&quote!(), f);
    let valid = crate::variant_test::wgsl_test(quote!(scene::sky));
    assert_golden("variant_test", quote!(#tests #panics #valid));
}

/// A name of the macro is none of a variable in scope, whatever the user calls it.
#[test]
fn generated_names_are_new() {
    let f = quote! {
        fn f(x: f32) -> f32 {
            let branch_1 = x;
            let branch_2 = x;
            if x > 0.0 {
                return branch_2;
            }
            branch_1
        }
    };
    let text = expand_kernel(quote!(), f).to_string();
    // Once in the source, and once in lifted code.
    for name in ["let branch_1 =", "let branch_2 ="] {
        assert_eq!(text.matches(name).count(), 2, "{name}: {text}");
    }
    assert!(text.contains("let __branch2 ="), "{text}");
}
