//! Procedural macros of `raydsl`: `#[kernel]`, `kernel!`, `#[primitive]`, `#[derive(Type)]`.
//!
//! `parse` converts syn's syntax to `model`, `emit` lowers the model to the lifted Rust, `items`
//! and `twin` expand the items around it. `ops` is the table of the operations that a kernel may
//! call.

mod cost;
mod diag;
mod emit;
mod generics;
mod here;
mod items;
mod model;
mod ops;
mod parse;
mod rewrite;
#[cfg(test)]
mod tests;
mod twin;
mod variant_test;

use proc_macro::TokenStream;
use quote::quote;
use syn::spanned::Spanned;

use diag::refused;

/// Lifts a function, or every function of an `impl` or a trait, to all variants.
///
/// The function itself is unchanged: it is the scalar variant. Beside it there is a type of the
/// same name whose `on` runs the lifted body on any machine; `Kernel::of::<name>()` is the whole
/// kernel.
///
/// Packets inline kernels into the traversal that calls them. A kernel with `#[inline(never)]` is a
/// function of its own, compiled once for each width: for long code that is rarely reached.
#[proc_macro_attribute]
pub fn kernel(args: TokenStream, item: TokenStream) -> TokenStream {
    rewrite::with_readable_names(expand_kernel(args.into(), item.into())).into()
}

fn expand_kernel(
    args: proc_macro2::TokenStream,
    item: proc_macro2::TokenStream,
) -> proc_macro2::TokenStream {
    if let Ok(f) = syn::parse2::<syn::ItemFn>(item.clone()) {
        if args.is_empty() {
            return items::kernel_fn(&f, None);
        }
        if let Ok(known) = syn::parse2::<items::KnownBy>(args.clone()) {
            return items::kernel_fn(&f, Some(&known));
        }
    }
    if !args.is_empty() {
        return refused(&item, &args, "`#[kernel]` takes no arguments", "write `#[kernel]`");
    }
    if let Ok(i) = syn::parse2::<syn::ItemImpl>(item.clone()) {
        let mut errors = diag::Errors::default();
        let lifted = items::kernel_impl(&i, &[], &mut errors);
        let errors = errors.into_tokens();
        return quote!(#lifted #errors);
    }
    if let Ok(t) = syn::parse2::<syn::ItemTrait>(item.clone()) {
        return items::kernel_trait(&t);
    }
    if let Ok(closure) = syn::parse2::<syn::ExprClosure>(item.clone()) {
        let e = syn::Error::new(
            closure.span(),
            "stable Rust has no `#[kernel]` on a closure\n  help: write `kernel!(|ray: Ray| ...)`, \
             or `#[kernels]` on the function around it",
        );
        let e = e.into_compile_error();
        // For rustc it is a kernel all the same: its uses are right.
        return quote!({ #e ::raydsl::prelude::kernel!(#item) });
    }
    let what = "`#[kernel]` stands on a function, an impl or a trait";
    refused(&item, &item, what, "for a closure write `kernel!(|ray: Ray| ...)`")
}

/// Makes kernels of the closures marked `#[kernel]` inside a function, `impl`, trait or module.
///
/// An attribute macro cannot be on an expression by itself; within `#[kernels]`, `#[kernel] |ray:
/// Ray| ...` is `kernel!(|ray: Ray| ...)`.
#[proc_macro_attribute]
pub fn kernels(args: TokenStream, item: TokenStream) -> TokenStream {
    expand_kernels(args.into(), item.into()).into()
}

fn expand_kernels(
    args: proc_macro2::TokenStream,
    item: proc_macro2::TokenStream,
) -> proc_macro2::TokenStream {
    let rewritten = rewrite::kernel_closures(item);
    if args.is_empty() {
        return rewritten;
    }
    refused(&rewritten, &args, "`#[kernels]` takes no arguments", "write `#[kernels]`")
}

/// Makes a kernel of a closure: `kernel!(|ray: Ray| ...)`.
///
/// The closure's captures are borrowed; the kernel lives as long as they do.
///
/// `kernel!(counted |ray: Ray| ...)` also lifts it for `utilisation` of the crate `raydsl-report`:
/// one more copy to compile.
///
/// **Compile time**: each closure is compiled for packets of 4, 8 and 16 lanes, for WGSL and for
/// the reference. While you edit one, name the variants you need in the environment:
/// `RAYDSL_VARIANTS=packet8 cargo run --release`. The others are omitted: their packets run the
/// next narrower copy, or the scalar function; code that needs WGSL or the reference panics with a
/// message. See the book, "Compile time".
#[proc_macro]
pub fn kernel_closure(input: TokenStream) -> TokenStream {
    rewrite::with_readable_names(expand_closure(input.into())).into()
}

fn expand_closure(input: proc_macro2::TokenStream) -> proc_macro2::TokenStream {
    match syn::parse2::<items::ClosureKernel>(input) {
        Ok(c) => items::kernel_closure(&c),
        Err(e) => {
            let e = syn::Error::new(
                e.span(),
                format!("{e}\n  help: write `kernel!(|ray: Ray| {{ ... }})`"),
            );
            e.into_compile_error()
        }
    }
}

/// Makes a primitive of a struct, or of an `impl` with `intersect` and `get_bounds`.
///
/// `#[primitive(disk(center, normal, radius))]` on a struct suffices for a shape of the library:
/// `sphere`, `triangle`, `quad`, `rectangle` (any parallelogram), `disk`, `plane`, `cylinder`,
/// `tube`, `cone` or `cuboid`. Each is a module of `raydsl::geometry`.
///
/// An enum of primitives is a primitive. `#[primitive(normal, area)]` on it forwards these methods
/// to its kinds: some of `surface_point`, `normal`, `uv`, `area`, `sample`, and `Surface`, the trait
/// of what integrators shade. Where kinds share different data, the enum names the types:
/// `#[primitive(shared(Vec3, f32))]`, two or three, and a tree takes a tuple of their slices.
#[proc_macro_attribute]
pub fn primitive(args: TokenStream, item: TokenStream) -> TokenStream {
    rewrite::with_readable_names(expand_primitive(args.into(), item.into())).into()
}

fn expand_primitive(
    args: proc_macro2::TokenStream,
    item: proc_macro2::TokenStream,
) -> proc_macro2::TokenStream {
    if let Ok(i) = syn::parse2::<syn::ItemImpl>(item.clone()) {
        if args.is_empty() {
            return items::primitive_impl(&i);
        }
        let mut errors = diag::Errors::default();
        let help =
            "write `#[primitive]` here, or `#[primitive(sphere(center, radius))]` on the struct";
        errors.at(args.span(), "`#[primitive]` on an impl takes no arguments", help);
        let errors = errors.into_tokens();
        return quote!(#item #errors);
    }
    let Ok(s) = syn::parse2::<syn::DeriveInput>(item.clone()) else {
        let what = "`#[primitive]` stands on a struct and on its impl";
        return refused(&item, &item, what, "write `#[primitive] struct Name { ... }`");
    };
    if let syn::Data::Enum(e) = &s.data {
        let mut errors = diag::Errors::default();
        let arguments = items::EnumArguments::of(args, &mut errors);
        let forwarded = || items::forwarded(&arguments, &s, e);
        let primitive = twin::primitive_enum(&s, e, &arguments.shared, forwarded);
        let errors = errors.into_tokens();
        return quote!(#primitive #errors);
    }
    let twin = twin::primitive_item(&s);
    if args.is_empty() {
        return twin;
    }
    let mut errors = diag::Errors::default();
    let shape = items::Shape::of(args, &mut errors);
    let shape = shape.map(|shape| items::with_shape(&shape, &s));
    let errors = errors.into_tokens();
    quote!(#twin #shape #errors)
}

/// Makes a struct of kernel types a kernel type itself.
#[proc_macro_derive(Type)]
pub fn derive_type(input: TokenStream) -> TokenStream {
    match syn::parse::<syn::DeriveInput>(input) {
        Ok(item) => rewrite::with_readable_names(twin::derive(&item)).into(),
        Err(e) => e.into_compile_error().into(),
    }
}

/// Lets `intersect` of a primitive return a struct with a `Hit` in it.
#[proc_macro_derive(HitRecord)]
pub fn derive_hit_record(input: TokenStream) -> TokenStream {
    match syn::parse::<syn::DeriveInput>(input) {
        Ok(item) => rewrite::with_readable_names(twin::hit_record(&item)).into(),
        Err(e) => e.into_compile_error().into(),
    }
}

/// Makes a struct of scenes a scene to query, in kernels and on the host.
///
/// The members may have different primitives, with one record of hits. Instance ids count through
/// them in the order of declaration. Members marked `#[table]` are slices or textures that kernels
/// read by name.
#[proc_macro_derive(RayQuery, attributes(table))]
pub fn derive_ray_query(input: TokenStream) -> TokenStream {
    derived_scene(input, false)
}

/// Makes a struct of scenes a scene that integrators can shade: what `#[derive(RayQuery)]` does, and
/// the points that rays hit.
///
/// A table belongs to the scene: kernels read `world.materials[i]` of a captured `world`.
///
/// ```ignore
/// #[derive(Scene)]
/// struct World<'a> {
///     balls: Bvh<'a, Ball>,
///     mesh: Mesh<'a, Bvh<'a, IndexedTriangle>>,
///     #[table]
///     materials: &'a [Material],
/// }
/// ```
#[proc_macro_derive(Scene, attributes(table))]
pub fn derive_scene(input: TokenStream) -> TokenStream {
    derived_scene(input, true)
}

fn derived_scene(input: TokenStream, shaded: bool) -> TokenStream {
    match syn::parse::<syn::DeriveInput>(input) {
        Ok(item) => rewrite::with_readable_names(items::scene(&item, shaded)).into(),
        Err(e) => e.into_compile_error().into(),
    }
}

/// Makes a `#[test]` of each variant from one function of a `Variant`.
///
/// `fn agrees(variant: Variant)` expands to `agrees_scalar`, `agrees_packet4`, `agrees_packet8`,
/// `agrees_packet16` and `agrees_wgsl`. A variant that the machine lacks is skipped with a message;
/// with `RAYDSL_REQUIRE_GPU=1` in the environment a missing device is an error. `#[ignore]` and
/// `#[should_panic]` apply to the tests. The function may return a `Result<(), E>`.
#[proc_macro_attribute]
pub fn variant_test(args: TokenStream, item: TokenStream) -> TokenStream {
    variant_test::variant_test(&args.into(), item.into()).into()
}

/// Makes a `#[test]` that the WGSL of a `#[kernel] fn` is valid: `wgsl_test!(sky)` expands to
/// `sky_has_valid_wgsl`. It needs no device, but raydsl's feature `validate` or `gpu`.
#[proc_macro]
pub fn wgsl_test(input: TokenStream) -> TokenStream {
    variant_test::wgsl_test(input.into()).into()
}
