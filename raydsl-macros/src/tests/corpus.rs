//! Small items that use every feature of the language, for `mutations`.

/// Which macro an item is for.
#[derive(Clone, Copy, Debug)]
pub(super) enum Entry {
    Kernel,
    Kernels,
    Closure,
    /// With these arguments.
    Primitive(&'static str),
    Type,
    HitRecord,
    Scene,
    RayQuery,
}

/// What may stand anywhere, and mostly should not.
pub(super) const STRAY: [&str; 32] = [
    "mut",
    "&",
    "*",
    "?",
    "..",
    "..=",
    "|",
    "||",
    "self",
    "Self",
    "'a",
    "1e400",
    "-1",
    "0u64",
    "\"text\"",
    "async",
    "unsafe",
    "loop {}",
    "match x {}",
    "return",
    "break 'a",
    "<T>",
    "::<f32>",
    "#[cfg(any())]",
    "as f64",
    "dyn",
    "_",
    "@",
    "=>",
    "const",
    "x?",
    "macro!()",
];

/// Items that the macros take.
pub(super) const CORPUS: &[(Entry, &str)] = &[
    (
        Entry::Kernel,
        "pub fn walk(x: f32, n: u32, table: &[f32], at: Vec3) -> f32 {
            const LIMIT: f32 = 2.5;
            let mut sum = 0.0;
            let mut list = [0.0; 4];
            'outer: for i in 0..n {
                let mut y = x * table[i as usize % table.len()];
                while y < LIMIT && sum > -1e3 {
                    y += 1.0;
                    if y > 10.0 { break 'outer; } else if x < 0.0 || !(n == 3) { continue; }
                }
                list[(i % 4) as usize] += y;
                sum -= list[0] * at.x.abs() + -at.dot(vec3(1.0, x, y));
            }
            let again = loop { sum *= 0.5; if sum < 1.0 { break sum; } };
            for (a, b) in list.iter().zip(table) { sum += a * b; }
            if sum > 1.0 { return again; }
            clamp(sum, 0.0, 1.0) + n as f32
        }",
    ),
    (
        Entry::Kernel,
        "fn choose<S: RayQuery>(scene: &S, shape: Shape, ray: Ray, mut left: Option<f32>) -> Vec3 {
            let Some(first) = left else { return Vec3::ZERO };
            let hit = scene.closest_hit(ray);
            let color = match shape {
                Shape::Ball { center, radius: r } if r > 0.0 => center * r,
                Shape::Pair(a, Inner { b, .. }) => vec3(a, b, first),
                Shape::Nothing | Shape::Other => Vec3::splat(first),
                _ => Vec3::X,
            };
            if let Some(t) = left { left = None; return color * t; }
            for other in scene.hits(ray) { if other.t > hit.t { break; } }
            Ray { t_max: 1.0, ..ray }.at(hit.t) + color
        }",
    ),
    (
        Entry::Kernel,
        "fn apply(f: impl Fn(f32, u32) -> f32, x: f32, at: &mut Vec2) -> (f32, bool) {
            let twice = |y: f32| f(y, 2) * 2.0;
            at.x += twice(x);
            *at = vec2(at.y, at.x);
            let (a, b) = (at.x, at.y < x);
            (a as u32 as f32, b & (a > 1.0))
        }",
    ),
    (
        Entry::Kernel,
        "impl<const N: usize, T: Shade> Particle<N, T> {
            const MASS: f32 = 1.5;
            pub fn moved(&self, by: Vec3) -> Self { Self { at: self.at + by, ..*self } }
            pub fn push(&mut self, x: f32) { self.mass = x; self.list[N - 1] ^= 3; }
            fn shade(self, x: f32) -> f32 { self.inner.shade(x) * Self::MASS }
        }",
    ),
    (
        Entry::Kernel,
        "pub trait Shade: Type {
            const WEIGHT: f32;
            fn shade(&self, x: f32) -> f32;
            fn twice(&self, x: f32) -> f32 { self.shade(x) + self.shade(x) * Self::WEIGHT }
        }",
    ),
    (
        Entry::Kernel,
        "impl Shade for Matte { const WEIGHT: f32 = 1.0; fn shade(&self, x: f32) -> f32 { x } }",
    ),
    (
        Entry::Kernels,
        "fn render(scene: &Bvh<'_, Ball>) {
            let k = #[kernel] |ray: Ray, pixel: Pixel| { scene.closest_hit(ray).t };
            drop(k);
        }",
    ),
    (
        Entry::Closure,
        "|ray: Ray, mut sampler: Sampler| {
            let hit = bvh.closest_hit(ray);
            if !hit.is_hit { return sky(ray.direction); }
            let n = host(count);
            let mut light = Vec3::ZERO;
            for _ in 0..n { light += lamps[sampler.next() as usize].color; }
            tex2(&picture, vec2(hit.u, hit.v)).truncate() * light
        }",
    ),
    (Entry::Closure, "counted |x: f32| -> f32 { if x > 0.5 { 1.0 } else { sin(x) } }"),
    (
        Entry::Primitive("sphere(center, radius)"),
        "/// Coloured.
        #[derive(Debug)]
        pub struct Ball { pub center: Vec3, radius: f32, #[doc(hidden)] color: [u32; 2] }",
    ),
    (
        Entry::Primitive(""),
        "impl Ball {
            const SLACK: f32 = 4.0;
            pub fn intersect(&self, ray: Ray) -> Hit { sphere::intersect(ray, self.center, 1.0) }
            pub fn get_bounds(&self) -> Aabb { Aabb { min: self.center, max: self.center } }
        }",
    ),
    (Entry::Primitive(""), "enum Any { Ball(Ball), Wall(Wall) }"),
    (
        Entry::Type,
        "#[derive(Clone, Copy)] #[repr(C)] pub struct Cell<T: Type> { at: UVec3, list: [T; 3], on: bool }",
    ),
    (Entry::Type, "enum Shape { Ball { center: Vec3, radius: f32 }, Pair(f32, Inner), Nothing }"),
    (Entry::HitRecord, "struct Found { hit: Hit, color: Vec3, count: u32 }"),
    (
        Entry::Scene,
        "struct World<'a> { balls: Bvh<'a, Ball>, #[table(Matte)] walls: &'a [Wall], sun: Lamp }",
    ),
    (Entry::RayQuery, "struct Both<'a> { first: List<'a, Ball>, second: Bvh<'a, Wall> }"),
];
