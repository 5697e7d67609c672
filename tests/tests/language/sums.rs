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

/// Fields with names that are words of Rust.
#[derive(Clone, Copy, Type)]
enum Worded {
    Glow { r#type: u32, power: f32 },
    Dark(f32),
}

#[kernel]
fn worded(n: u32, x: f32) -> f32 {
    let made =
        if n.is_multiple_of(2) { Worded::Glow { r#type: n, power: x } } else { Worded::Dark(x) };
    match made {
        Worded::Glow { r#type, power } => power * r#type as f32,
        Worded::Dark(y) => -y,
    }
}

#[test]
fn fields_may_be_words_of_rust() {
    let inputs: Vec<(u32, f32)> = (0..40).map(|i| (i % 5, i as f32 * 0.3)).collect();
    assert_variants_agree!(worded, &inputs);
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

/// The same kernel over an enum of three kinds, and over one of the first of them alone.
macro_rules! kinds {
    ($module:ident, {$($others:tt)*}, $shade:item) => {
        mod $module {
            use raydsl::prelude::*;
            use raydsl::{Type, assert_variants_agree, kernel};

            #[derive(Clone, Copy, Debug, PartialEq, Type)]
            pub(super) enum Surface {
                Glow(Vec3, f32),
                $($others)*
            }

            #[kernel]
            $shade

            #[kernel]
            #[allow(irrefutable_let_patterns, reason = "of one kind")]
            fn brightness(surface: Surface, x: f32) -> f32 {
                let Surface::Glow(light, _) = surface else {
                    return -1.0;
                };
                light.dot(shade(surface, x))
            }

            /// What a kernel makes of a list, of a captured value, of its own, of a variable that
            /// changes, and of one that arms choose.
            pub(super) fn wgsl(list: &[Surface]) -> String {
                let one = list[0];
                let kernel = kernel!(|x: f32| {
                    let mut sum = shade(one, x);
                    for surface in list {
                        sum += shade(*surface, x);
                        let dimmed = match *surface {
                            Surface::Glow(light, share) if x > 0.0 => {
                                Surface::Glow(light * 0.5, share)
                            }
                            other => other,
                        };
                        sum.x += brightness(dimmed, x);
                    }
                    let mut last = list[x as usize];
                    if x > 2.0 {
                        last = Surface::Glow(sum, x);
                    }
                    sum + shade(last, x)
                });
                let inputs: Vec<(f32,)> = (0..40).map(|i| (i as f32 * 0.1 - 1.0,)).collect();
                assert_variants_agree!(&kernel, &inputs);
                kernel.wgsl()
            }
        }
    };
}

kinds!(
    alone,
    {},
    fn shade(surface: Surface, x: f32) -> Vec3 {
        match surface {
            Surface::Glow(light, share) => light * share * x,
        }
    }
);

kinds!(of_three, { Matte { color: Vec3, roughness: f32 }, Black },
    fn shade(surface: Surface, x: f32) -> Vec3 {
        match surface {
            Surface::Black => vec3(0.25, 0.0, 0.0),
            Surface::Matte { color, roughness } if roughness > x => color,
            Surface::Glow(light, share) => light * share * x,
            Surface::Matte { color, .. } => color.zyx(),
        }
    }
);

#[test]
fn kinds_that_the_data_lacks_leave_no_trace() {
    let lights: Vec<(Vec3, f32)> = (0..5).map(|i| (Vec3::splat(i as f32), 0.5)).collect();
    let of_one: Vec<_> = lights.iter().map(|l| alone::Surface::Glow(l.0, l.1)).collect();
    let mut of_three: Vec<_> = lights.iter().map(|l| of_three::Surface::Glow(l.0, l.1)).collect();
    let expected = alone::wgsl(&of_one);
    assert_eq!(of_three::wgsl(&of_three), expected);
    for one_more in
        [of_three::Surface::Black, of_three::Surface::Matte { color: Vec3::Y, roughness: 0.5 }]
    {
        of_three.truncate(5);
        of_three.push(one_more);
        assert_ne!(of_three::wgsl(&of_three), expected);
    }
}

#[kernel]
fn next(material: &mut Material, x: f32) {
    *material = match *material {
        Material::Black => Material::Glow(Vec3::splat(x)),
        Material::Glow(light) => Material::Metal(light, x, 2),
        Material::Metal(color, roughness, _) => Material::Diffuse { color, roughness },
        Material::Diffuse { .. } => Material::Black,
    };
}

/// Variables that have one kind where a loop begins, and any where its body runs again.
#[kernel]
fn changed_in_loops(x: f32) -> Vec3 {
    let (mut stepped, mut set, mut late) = (Material::Black, Material::Black, Material::Black);
    let mut sum = Vec3::ZERO;
    for i in 0..5 {
        sum += shade(stepped, x) + shade(set, 1.5 * x);
        next(&mut stepped, x);
        let mut inner = Material::Glow(sum);
        for k in 0..3 {
            sum.x += shade(inner, x).y;
            if k as f32 > x {
                inner = Material::Metal(sum, 0.5, 1);
                continue;
            }
            if let Material::Black = late {
                sum.z += 1.0;
            }
        }
        sum.y += shade(inner, x).x;
        set = if i == 1 { Material::Diffuse { color: sum, roughness: x } } else { set };
        while let Material::Metal(_, _, n) = inner {
            inner = if n > 3 { Material::Black } else { Material::Metal(sum, x, n + 1) };
        }
        if let Material::Black = inner {
            late = Material::Glow(sum);
        }
    }
    sum + shade(stepped, x) + shade(late, x)
}

/// What branches exclude, and what they do not.
#[kernel]
fn excluded(a: Material, x: f32) -> f32 {
    let mut b = if x > 0.5 { Material::Black } else { Material::Glow(vec3(x, 1.0, 2.0)) };
    let mut sum = 0.0;
    if let Material::Glow(light) = b {
        b = Material::Metal(light, x, 1);
        if let Material::Metal(..) = b {
            sum += 1.0;
        }
        if let Material::Glow(_) = b {
            sum += 10.0;
        }
    } else if let Material::Glow(_) = b {
        sum += 100.0;
    }
    if let Material::Metal(..) | Material::Black = b {
        sum += 0.5;
    }
    if matches_bright(a) || x > 1.0 {
        if let Material::Black = a {
            sum += 1000.0;
        }
    } else if let Material::Black | Material::Glow(_) = a {
        if let Material::Glow(_) = a {
            sum += 2000.0;
        }
        if let Material::Diffuse { .. } = a {
            sum += 4000.0;
        }
    }
    sum
}

/// A member of a member that is an enum.
#[derive(Clone, Copy, Debug, Type)]
struct Walker {
    steps: u32,
    skin: Skin,
}

#[derive(Clone, Copy, Debug, Type)]
struct Skin {
    outer: Material,
    inner: Material,
}

#[kernel]
impl Walker {
    /// Changes one member, where its kind says so.
    fn step(&mut self, x: f32) -> f32 {
        self.steps += 1;
        if let Material::Metal(..) = self.skin.outer {
            next(&mut self.skin.inner, x);
        }
        next(&mut self.skin.outer, x);
        shade(self.skin.inner, x).x
    }
}

/// A member changes its kind two loops further in than it is read, in a called kernel.
#[kernel]
fn changed_members(x: f32) -> f32 {
    let skin = Skin { outer: Material::Black, inner: Material::Black };
    let mut walker = Walker { steps: 0, skin };
    let mut sum = 0.0;
    for i in 0..3 {
        sum += shade(walker.skin.inner, x).y + 0.5 * shade(walker.skin.outer, x).z;
        for k in 0..4 {
            if let Material::Diffuse { roughness, .. } = walker.skin.inner {
                sum += roughness;
            }
            if k as f32 * 0.3 > x {
                continue;
            }
            sum += walker.step(x + i as f32 * 0.1);
        }
    }
    sum + walker.steps as f32
}

/// Kinds go from one variable to the next, so that one pass over the body shows but one of them.
#[kernel]
fn swapped(count: u32, x: f32) -> f32 {
    let (mut a, mut b) = (Material::Glow(vec3(x, 1.0, 2.0)), Material::Black);
    let (mut c, mut d) = (Material::Metal(Vec3::X, x, 3), Material::Black);
    let mut sum = 0.0;
    for _ in 0..count {
        sum = 0.5 * sum + shade(a, x).x;
        (a, b) = (b, a);
        let old = c;
        c = d;
        d = b;
        b = old;
    }
    sum + shade(b, x).y + shade(c, x).z + shade(d, x).x
}

/// A kind that changes behind the loop that it is read in, in the loop around that.
#[kernel]
fn changed_behind(x: f32) -> f32 {
    let mut look = Material::Black;
    let mut sum = 0.0;
    for i in 0..3 {
        for k in 0..2 {
            sum += shade(look, x + k as f32).x;
        }
        look = Material::Glow(vec3(x, sum, i as f32));
    }
    sum
}

/// The same for a variable made in the outermost loop.
#[kernel]
fn changed_in_the_middle(x: f32) -> f32 {
    let mut sum = 0.0;
    for i in 0..2 {
        let mut look = Material::Black;
        for _ in 0..4 {
            for k in 0..2 {
                sum += shade(look, x + k as f32).y;
            }
            next(&mut look, x + i as f32);
        }
        sum += shade(look, x).x;
    }
    sum
}

/// Ways out of loops behind which a kind changes, or before.
#[kernel]
fn left_early(count: u32, x: f32) -> f32 {
    let mut kind = Material::Black;
    let mut sum = 0.0;
    'outer: for i in 0..count {
        let mut local = kind;
        loop {
            if let Material::Glow(light) = local {
                sum += light.x;
                kind = Material::Metal(light, x, i);
                continue 'outer;
            }
            if let Material::Metal(_, roughness, n) = local {
                if n > 2 {
                    return sum + roughness;
                }
                local = Material::Diffuse { color: Vec3::ONE, roughness };
                continue;
            }
            if let Material::Diffuse { .. } = local {
                sum += 3.0;
                break 'outer;
            }
            if sum > 4.0 {
                break;
            }
            local = Material::Glow(vec3(x, 0.5, sum));
        }
        kind = Material::Glow(vec3(sum, x, 1.0));
    }
    let change = |material: Material, x: f32| {
        let mut changed = material;
        next(&mut changed, x);
        changed
    };
    let mut left = count;
    while {
        kind = change(kind, x);
        left -= if left > 0 { 1 } else { 0 };
        left > 0
    } {
        sum += shade(kind, x).x;
    }
    sum
}

#[test]
fn variables_change_their_kind_in_loops() {
    let inputs: Vec<(f32,)> = (0..40).map(|i| (i as f32 * 0.07 - 0.5,)).collect();
    assert_variants_agree!(changed_in_loops, &inputs);
    assert_variants_agree!(changed_members, &inputs);
    assert_variants_agree!(changed_behind, &inputs);
    assert_variants_agree!(changed_in_the_middle, &inputs);
    let counted: Vec<(u32, f32)> = (0..60).map(|i| (i % 12, i as f32 * 0.05 - 0.5)).collect();
    assert_variants_agree!(swapped, &counted);
    assert_variants_agree!(left_early, &counted);
}

#[primitive(sphere(center, radius))]
struct Ball {
    center: Vec3,
    radius: f32,
}

/// Kinds that the condition of a query reads, and that change in the loop around it; and a loop over
/// hits.
#[kernel]
fn changed_around_queries(balls: &[Ball], ray: Ray) -> f32 {
    let mut look = Material::Black;
    let mut sum = 0.0;
    for i in 0..4 {
        let now = look;
        let hit = balls.closest_hit_where(ray, |hit: Hit| shade(now, hit.t).x > i as f32);
        sum += if hit.is_hit { hit.t } else { 0.25 };
        next(&mut look, hit.t);
    }
    for hit in balls.hits(ray) {
        sum += shade(look, hit.t).x;
        if hit.t > 1.0 {
            next(&mut look, hit.t);
        }
    }
    sum
}

#[test]
fn variables_change_their_kind_around_queries() {
    let balls: Vec<Ball> =
        (0..9).map(|i| Ball { center: vec3(0.0, 0.1 * i as f32, i as f32), radius: 0.7 }).collect();
    let bvh = Bvh::build(&balls).expect("finite bounds");
    let rays: Vec<(Ray,)> = (0..40)
        .map(|i| (Ray::new(vec3(0.0, i as f32 * 0.04 - 0.5, -3.0), vec3(0.0, 0.02, 1.0)),))
        .collect();
    let listed = kernel!(|ray: Ray| changed_around_queries(&balls, ray));
    assert_variants_agree!(&listed, &rays);
    let tree = kernel!(|ray: Ray| {
        let mut look = Material::Black;
        let mut sum = 0.0;
        for i in 0..4 {
            let now = look;
            let hit = bvh.closest_hit_where(ray, |hit: Hit| {
                let mut other = now;
                for _ in 0..i {
                    next(&mut other, hit.t);
                }
                shade(other, hit.t).x < 4.0
            });
            sum += if hit.is_hit { hit.t } else { 0.25 };
            next(&mut look, hit.t);
        }
        for hit in bvh.hits(ray) {
            sum += shade(look, hit.t).y;
            next(&mut look, hit.t);
        }
        sum
    });
    assert_variants_agree!(&tree, &rays);
}

/// A state that goes through many kinds, one at a time, more than a body is recorded.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
enum Stage {
    Start,
    Left(f32),
    Right(f32),
    Up(f32),
    Down(f32),
    Near(f32),
    Far(f32),
    Last(f32),
}

#[kernel]
fn following(stage: Stage, x: f32) -> Stage {
    match stage {
        Stage::Start => Stage::Left(x),
        Stage::Left(y) => Stage::Right(y + 1.0),
        Stage::Right(y) => Stage::Up(y * 2.0),
        Stage::Up(y) => Stage::Down(y - x),
        Stage::Down(y) => Stage::Near(y * x),
        Stage::Near(y) => Stage::Far(y + 0.5),
        Stage::Far(y) => Stage::Last(y * 3.0),
        Stage::Last(_) => Stage::Start,
    }
}

#[kernel]
fn stages(count: u32, x: f32) -> (Stage, Stage) {
    let (mut stage, mut behind) = (Stage::Start, Stage::Start);
    for i in 0..count {
        let mut k = 0;
        while k < 3 {
            if i % 2 == 0 {
                stage = following(stage, x);
            }
            k += 1;
        }
        behind = stage;
    }
    (stage, behind)
}

#[test]
fn variables_go_through_many_kinds() {
    let inputs: Vec<(u32, f32)> = (0..60).map(|i| (i % 15, i as f32 * 0.05)).collect();
    assert_variants_agree!(stages, &inputs);
}

#[test]
fn branches_exclude_kinds() {
    let inputs: Vec<(Material, f32)> =
        materials().iter().enumerate().map(|(i, m)| (*m, i as f32 * 0.03)).collect();
    assert_variants_agree!(excluded, &inputs);
}

/// A generator of numbers by one of several methods.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
enum Method {
    Constant,
    Counting(u32),
    Hashed { seed: u32, factor: u32 },
}

#[derive(Clone, Copy, Debug, Type)]
struct Generator {
    method: Method,
    drawn: u32,
}

#[kernel]
impl Generator {
    fn draw(&mut self) -> u32 {
        self.drawn += 1;
        match self.method {
            Method::Constant => 7717,
            Method::Counting(first) => self.drawn.wrapping_add(first).wrapping_mul(8819),
            Method::Hashed { seed, factor } => (self.drawn ^ seed).wrapping_mul(factor) ^ 9929,
        }
    }
}

#[kernel]
fn walked(generator: &mut Generator, length: u32) -> u32 {
    let mut sum = 0u32;
    for _ in 0..length {
        sum = sum.wrapping_add(generator.draw());
        if sum.is_multiple_of(3) {
            continue;
        }
        sum ^= generator.draw();
    }
    sum
}

#[kernel]
fn walks(generator: Generator, count: u32) -> u32 {
    let mut generator = generator;
    let mut stage = Stage::Start;
    let mut sum = 0u32;
    for i in 0..count {
        let mut copy = generator;
        let mut k = 0;
        // Other variables change their kinds, and the body is recorded more than once.
        stage = following(stage, 1.0);
        loop {
            k += 1;
            if generator.draw().is_multiple_of(2) || k > 3 {
                break;
            }
            sum ^= copy.draw();
        }
        sum = sum.wrapping_add(walked(&mut generator, i));
        if let Stage::Start = stage {
            return sum;
        }
        generator = Generator { method: copy.method, ..generator };
    }
    sum
}

/// The WGSL of a kernel has the kinds that variables may have in loops, and those alone.
#[test]
fn kinds_that_loops_leave_alone_leave_no_trace() {
    let inputs: Vec<(u32,)> = (0..30).map(|i| (i % 9,)).collect();
    let methods =
        [Method::Constant, Method::Counting(3), Method::Hashed { seed: 5, factor: 0x9e37_79b1 }];
    let traces = ["7717u", "8819u", "9929u"];
    for (method, own) in methods.into_iter().zip(traces) {
        let generator = Generator { method, drawn: 0 };
        let kernel = kernel!(|n: u32| walks(generator, n));
        assert_variants_agree!(&kernel, &inputs);
        let text = kernel.wgsl();
        for trace in traces {
            assert_eq!(text.contains(trace), trace == own, "{trace}\n{text}");
        }
        let tests = text.lines().filter(|line| line.contains("==") && line.contains("method"));
        assert_eq!(tests.count(), 0, "{text}");
    }
    // A kind that a loop may set, and one that it reads behind.
    let kernel = kernel!(|n: u32| {
        let mut generator = Generator { method: Method::Constant, drawn: 0 };
        let mut sum = 0u32;
        for i in 0..n {
            sum = sum.wrapping_add(generator.draw());
            for _ in 0..i {
                if sum.is_multiple_of(5) {
                    generator.method = Method::Counting(i);
                }
            }
        }
        sum
    });
    assert_variants_agree!(&kernel, &inputs);
    let text = kernel.wgsl();
    let found = traces.map(|trace| text.contains(trace));
    assert_eq!(found, [true, true, false], "{text}");
}

/// Enums without fields that are kinds, and that are numbers: of one byte, or numbered otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
#[repr(u32)]
enum Side {
    Front,
    Back,
    Edge,
}

#[derive(Clone, Copy, Debug, PartialEq, Type)]
enum Small {
    Front,
    Back,
}

#[derive(Clone, Copy, Debug, PartialEq, Type)]
#[repr(u32)]
enum Numbered {
    Front = 70,
    Back = 0,
    Edge = 4_000_000_000,
}

#[kernel]
fn of_side(side: Side, x: f32) -> f32 {
    match side {
        Side::Front => x * 7717.0,
        Side::Back => x * 8819.0,
        Side::Edge => x * 9929.0,
    }
}

#[kernel]
fn of_numbers(small: Small, numbered: Numbered, x: f32) -> f32 {
    let mut numbered = numbered;
    let mut sum = x;
    for i in 0..4u32 {
        sum += match (small, numbered) {
            (Small::Front, Numbered::Front) => 1.0,
            (Small::Back, Numbered::Front) => 2.0,
            (Small::Front, Numbered::Back) => 3.0,
            (_, Numbered::Edge) => 4.0,
            _ => 5.0,
        };
        numbered = match numbered {
            Numbered::Front => Numbered::Back,
            Numbered::Back => Numbered::Edge,
            Numbered::Edge => Numbered::Front,
        };
        if numbered as u32 == 70 {
            sum += i as f32;
        }
    }
    sum
}

#[test]
fn enums_without_fields_are_kinds() {
    let sides = [Side::Front, Side::Back, Side::Edge];
    let both: Vec<(Side, f32)> = (0..30).map(|i| (sides[i % 3], i as f32)).collect();
    assert_variants_agree!(of_side, &both);
    let text = |list: &[Side]| {
        let kernel = kernel!(|i: u32, x: f32| {
            let mut side = list[i as usize % list.len()];
            let mut sum = 0.0;
            for k in 0..5 {
                sum += of_side(side, x);
                if k == 3 {
                    side = list[0];
                }
            }
            if side == list[0] { sum } else { -sum }
        });
        let inputs: Vec<(u32, f32)> = (0..30).map(|i| (i, i as f32 * 0.25)).collect();
        assert_variants_agree!(&kernel, &inputs);
        let text = kernel.wgsl();
        ["7717", "8819", "9929"].map(|trace| text.contains(trace))
    };
    assert_eq!(text(&sides[1..2]), [false, true, false]);
    assert_eq!(text(&sides[1..]), [false, true, true]);
    assert_eq!(text(&sides), [true, true, true]);
    let smalls = [Small::Front, Small::Back];
    let numbers = [Numbered::Front, Numbered::Back, Numbered::Edge];
    let inputs: Vec<(Small, Numbered, f32)> =
        (0..36).map(|i| (smalls[i % 2], numbers[i % 3], i as f32)).collect();
    assert_variants_agree!(of_numbers, &inputs);
    let (smalls, numbers) = (&smalls[..], &numbers[..]);
    let listed = kernel!(|i: u32, x: f32| {
        of_numbers(smalls[i as usize % 2], numbers[i as usize % 3], x)
    });
    assert_variants_agree!(&listed, &(0..36).map(|i| (i, i as f32)).collect::<Vec<(u32, f32)>>());
}

/// A part of its callers in packets, with ways out that are not those of its callers.
#[kernel]
#[inline(always)]
fn collatz(n: &mut u32, most: u32) -> u32 {
    for step in 0..most {
        if *n <= 1 {
            return step;
        }
        if n.is_multiple_of(2) {
            *n /= 2;
            continue;
        }
        *n = 3 * *n + 1;
    }
    most
}

#[kernel]
fn twice_inlined(n: u32) -> (u32, u32) {
    let mut n = n;
    let mut sum = 0;
    while n > 1 {
        let steps = collatz(&mut n, 5);
        if steps < 3 {
            return (sum, n);
        }
        sum += steps;
        if sum > 40 {
            break;
        }
        sum += collatz(&mut n, 2);
    }
    (sum, n)
}

#[test]
fn inlined_kernels_return_to_their_callers() {
    assert_variants_agree!(twice_inlined, &(0..100).map(|n| (n,)).collect::<Vec<(u32,)>>());
}

/// More variants than a set of kinds has members.
macro_rules! many {
    ($($name:ident $number:literal)+) => {
        #[derive(Clone, Copy, Debug, Type)]
        enum Many {
            $($name(u32),)+
        }

        #[kernel]
        fn of_many(x: Many) -> u32 {
            match x {
                $(Many::$name(n) => n + $number,)+
            }
        }

        fn all_of_many() -> Vec<Many> {
            vec![$(Many::$name(1)),+]
        }
    };
}

many!(
    Kind0 0 Kind1 1 Kind2 2 Kind3 3 Kind4 4 Kind5 5 Kind6 6 Kind7 7 Kind8 8 Kind9 9 Kind10 10 Kind11 11 Kind12 12 Kind13 13 Kind14 14 Kind15 15
    Kind16 16 Kind17 17 Kind18 18 Kind19 19 Kind20 20 Kind21 21 Kind22 22 Kind23 23 Kind24 24 Kind25 25 Kind26 26 Kind27 27 Kind28 28
    Kind29 29 Kind30 30 Kind31 31 Kind32 32 Kind33 33 Kind34 34 Kind35 35 Kind36 36 Kind37 37 Kind38 38 Kind39 39 Kind40 40 Kind41 41
    Kind42 42 Kind43 43 Kind44 44 Kind45 45 Kind46 46 Kind47 47 Kind48 48 Kind49 49 Kind50 50 Kind51 51 Kind52 52 Kind53 53 Kind54 54
    Kind55 55 Kind56 56 Kind57 57 Kind58 58 Kind59 59 Kind60 60 Kind61 61 Kind62 62 Kind63 63 Kind64 64 Kind65 65 Kind66 66 Kind67 67
);

#[test]
fn enums_of_many_variants() {
    let all = all_of_many();
    let inputs: Vec<(Many,)> = all.iter().map(|x| (*x,)).collect();
    assert_variants_agree!(of_many, &inputs);
    for part in [&all[..2], &all[62..64], &all[63..65], &all[64..], &all[66..]] {
        let kernel = kernel!(|i: u32| of_many(part[i as usize % part.len()]));
        assert_variants_agree!(&kernel, &(0..5).map(|i| (i,)).collect::<Vec<(u32,)>>());
    }
}

/// Types with the names that those of generated code might have.
mod names {
    use raydsl::prelude::*;
    use raydsl::{Type, assert_variants_agree, kernel};

    #[derive(Clone, Copy, Debug, PartialEq, Type)]
    enum Material {
        Glow(MaterialData),
        Matte(Vec3),
    }

    #[derive(Clone, Copy, Debug, PartialEq, Type)]
    struct MaterialData {
        light: Vec3,
    }

    #[primitive(sphere(center, radius))]
    #[derive(Debug)]
    struct ShapeData {
        center: Vec3,
        radius: f32,
    }

    #[primitive]
    enum Shape {
        Ball(ShapeData),
    }

    #[kernel]
    fn light_of(material: Material, x: f32) -> Vec3 {
        match material {
            Material::Glow(data) => data.light * x,
            Material::Matte(color) => color,
        }
    }

    /// WGSL has the name of the enum.
    #[test]
    fn names_of_generated_types_are_free() {
        let all = [Material::Glow(MaterialData { light: Vec3::X }), Material::Matte(Vec3::Y)];
        let shapes = [Shape::Ball(ShapeData { center: Vec3::Z, radius: 0.5 })];
        let (list, shapes) = (&all[..], &shapes[..]);
        let kernel = kernel!(|ray: Ray, i: u32| {
            let hit = shapes.closest_hit(ray);
            light_of(list[i as usize], if hit.is_hit { hit.t } else { 3.0 })
        });
        let inputs: Vec<(Ray, u32)> =
            (0..20).map(|i| (Ray::new(Vec3::X * i as f32 * 0.1, Vec3::Z), i % 2)).collect();
        assert_variants_agree!(&kernel, &inputs);
        let text = kernel.wgsl();
        for name in ["struct Material {", "struct MaterialData {", "struct Shape {"] {
            assert!(text.contains(name), "{name}\n{text}");
        }
        assert!(!text.contains("__"), "{text}");
    }
}
