//! Enums with fields, `Option`, and the patterns that take them apart, in every variant.

use raydsl::prelude::*;
use raydsl::{Type, assert_variants_agree, kernel};

/// A surface's look: variants with members, with fields, and with none.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
enum Material {
    Diffuse { color: Vec3, roughness: f32 },
    Metal(Vec3, f32, u32),
    Glow(Vec3),
    Black,
}

fn materials() -> Vec<Material> {
    (0..60u32)
        .map(|i| {
            let x = i as f32 * 0.1;
            match i % 4 {
                0 => Material::Diffuse { color: vec3(x, 1.0, 0.5), roughness: x * 0.5 },
                1 => Material::Metal(vec3(1.0, x, 0.0), x, i),
                2 => Material::Glow(vec3(x, x, x)),
                _ => Material::Black,
            }
        })
        .collect()
}

#[kernel]
fn shade(material: Material, x: f32) -> Vec3 {
    match material {
        Material::Diffuse { color, roughness: r } => color * (1.0 - r) * x,
        Material::Metal(tint, sharpness, times) => {
            let mut light = tint;
            for _ in 0..times % 4 {
                light *= sharpness;
            }
            light
        }
        Material::Glow(light) if x > 0.5 => light,
        Material::Glow(..) | Material::Black => vec3(0.0, 0.0, 0.0),
    }
}

#[kernel]
fn mixed(a: Material, b: Material, x: f32) -> Material {
    let mut chosen = a;
    for i in 0..3 {
        if x > i as f32 * 0.3 {
            chosen = match chosen {
                Material::Diffuse { color, .. } => Material::Metal(color, x, 7),
                Material::Metal(tint, _, n) => Material::Glow(tint * n as f32),
                Material::Glow(light) => Material::Diffuse { roughness: 0.25, color: light },
                Material::Black => b,
            };
        }
    }
    chosen
}

#[kernel]
fn brightest(list: &[Material], x: f32) -> f32 {
    let mut best: f32 = 0.0;
    for material in list {
        if let Material::Glow(light) = *material {
            best = best.max(light.x);
        } else if let Material::Diffuse { roughness, .. } | Material::Metal(_, roughness, _) =
            material
            && *roughness < x
        {
            best = best.max(*roughness);
        }
    }
    best
}

/// Nested, with another enum and a struct in it.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
enum Node {
    Leaf(Material),
    Blend { a: Material, b: Material, share: f32 },
    Empty,
}

#[kernel]
fn light_of(node: Node, x: f32) -> Vec3 {
    match node {
        Node::Leaf(material) => shade(material, x),
        Node::Blend { a, b: Material::Glow(light), share } => shade(a, x) * share + light,
        Node::Blend { a, b, share } => shade(a, x) * share + shade(b, x) * (1.0 - share),
        Node::Empty => Vec3::ZERO,
    }
}

/// Generic.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
enum Either<A: Type, B: Type> {
    Left(A),
    Right(B),
}

#[kernel]
fn sum_of(either: Either<f32, Vec2>) -> f32 {
    match either {
        Either::Left(x) => x,
        Either::Right(v) => v.x + v.y,
    }
}

#[kernel]
fn sorted(x: f32, y: f32) -> Either<f32, Vec2> {
    if x < y { Either::Left(x) } else { Either::Right(vec2(x, y)) }
}

#[kernel]
fn root(x: f32) -> Option<f32> {
    if x < 0.0 {
        return None;
    }
    Some(x.sqrt())
}

#[kernel]
fn roots(x: f32, y: f32) -> f32 {
    let Some(first) = root(x) else {
        return -1.0;
    };
    let second = if let Some(r) = root(y) { r * 2.0 } else { 0.5 };
    let mut left = Some(first);
    let mut sum = 0.0;
    while let Some(value) = left {
        sum += value;
        left = if value > 0.5 { Some(value - 0.5) } else { None };
    }
    let third = match (root(x - 1.0), root(y - 1.0)) {
        (Some(a), Some(b)) => a + b,
        (Some(a), None) | (None, Some(a)) => a,
        (None, None) => 9.0,
    };
    let other = root(y);
    let fourth = if let Some(a) = root(x - 0.5)
        && a < 1.2
        && let Some(b) = other
        && b > a
    {
        a * b
    } else {
        3.0
    };
    let count = if root(y).is_some() { 2 } else { 1 };
    first + second + sum + third + fourth + root(y).unwrap_or(4.0) + count as f32
}

#[kernel]
impl Material {
    fn is_bright(self) -> bool {
        matches_bright(self)
    }
}

#[kernel]
fn matches_bright(material: Material) -> bool {
    match material {
        Material::Glow(light) => light.x > 1.0,
        _ => false,
    }
}

fn pairs() -> Vec<(f32, f32)> {
    (0..80).map(|i| (i as f32 * 0.07 - 1.5, (i * 7 % 40) as f32 * 0.11 - 1.0)).collect()
}

#[test]
fn variants_in_arguments_and_results() {
    let all = materials();
    let inputs: Vec<(Material, f32)> =
        all.iter().enumerate().map(|(i, m)| (*m, i as f32 * 0.03)).collect();
    assert_variants_agree!(shade, &inputs);
    let three: Vec<(Material, Material, f32)> =
        (0..60).map(|i| (all[i], all[(i * 7 + 3) % 60], i as f32 * 0.02)).collect();
    assert_variants_agree!(mixed, &three);
    let bright = kernel!(|material: Material| material.is_bright());
    let alone: Vec<(Material,)> = all.iter().map(|m| (*m,)).collect();
    assert_variants_agree!(&bright, &alone);
}

#[test]
fn variants_in_lists_and_captures() {
    let all = materials();
    let one = all[9];
    let kernel = kernel!(|x: f32| {
        let mut sum = brightest(&all, x);
        let mut last = Material::Black;
        for material in &all {
            if let Material::Glow(_) | Material::Black = last {
                last = *material;
            }
            sum += shade(*material, x).y;
        }
        (sum, shade(last, x), shade(one, x))
    });
    let inputs: Vec<(f32,)> = (0..40).map(|i| (i as f32 * 0.07,)).collect();
    assert_variants_agree!(&kernel, &inputs);
}

#[test]
fn nested_variants() {
    let all = materials();
    let inputs: Vec<(Node, f32)> = (0..60)
        .map(|i| {
            let (a, b) = (all[i], all[(i * 11 + 5) % 60]);
            let node = match i % 3 {
                0 => Node::Leaf(a),
                1 => Node::Blend { a, b, share: i as f32 * 0.01 },
                _ => Node::Empty,
            };
            (node, i as f32 * 0.04)
        })
        .collect();
    assert_variants_agree!(light_of, &inputs);
}

#[test]
fn generic_variants() {
    let inputs: Vec<(Either<f32, Vec2>,)> =
        (0..30)
            .map(|i| {
                if i % 2 == 0 { Either::Left(i as f32) } else { Either::Right(vec2(1.0, i as f32)) }
            })
            .map(|e| (e,))
            .collect();
    assert_variants_agree!(sum_of, &inputs);
    assert_variants_agree!(sorted, &pairs());
}

#[test]
fn options() {
    let roots_of: Vec<(f32,)> = pairs().into_iter().map(|(x, _)| (x,)).collect();
    assert_variants_agree!(root, &roots_of);
    assert_variants_agree!(roots, &pairs());
    let list: Vec<Option<u32>> = (0..20).map(|i| (i % 3 > 0).then_some(i)).collect();
    let kernel = kernel!(|x: f32| {
        let mut sum = 0;
        let mut largest = None;
        for item in &list {
            if let Some(n) = *item {
                sum += n;
                if n as f32 > x {
                    largest = Some(n);
                }
            }
        }
        (sum, largest)
    });
    let inputs: Vec<(f32,)> = (0..40).map(|i| (i as f32 * 0.7,)).collect();
    assert_variants_agree!(&kernel, &inputs);
}
