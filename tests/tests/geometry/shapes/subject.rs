//! What the tests ask of a shape, and the shapes.

use raydsl::geometry::SurfacePoint;
use raydsl::prelude::*;
use raydsl_tests::rng::Rng;

use super::exact::{D3, Exact, along, minus};

/// A primitive of a shape of the library.
pub(crate) trait Subject: Primitive<Hit = Hit, Shared = ()> + std::fmt::Debug {
    /// One of about this size, near `offset`.
    fn random(rng: &mut Rng, size: f32, offset: Vec3) -> Self;
    /// The same shape in `f64`.
    fn exact(&self) -> Exact;
    /// Those that are no surface.
    fn degenerate() -> Vec<Self>;

    fn normal_at(&self, ray: Ray, hit: Hit) -> Vec3;
    fn uv_at(&self, ray: Ray, hit: Hit) -> Vec2;
    fn whole_area(&self) -> f32;
    fn point(&self, u: Vec2) -> SurfacePoint;
    fn point_at(&self, ray: Ray, hit: Hit) -> SurfacePoint;
}

pub(crate) fn wide(v: Vec3) -> D3 {
    v.to_array().map(f64::from)
}

/// The struct of a shape, and what the macro gives it.
macro_rules! subject {
    ($name:ident = $shape:ident($($part:ident: $ty:ty),+);
     $rng:ident $size:ident $offset:ident => $random:expr; $exact:expr; $bad:expr) => {
        #[primitive($shape($($part),+))]
        #[derive(Debug)]
        pub(crate) struct $name {
            $(pub(crate) $part: $ty,)+
        }

        impl Subject for $name {
            fn random($rng: &mut Rng, $size: f32, $offset: Vec3) -> Self {
                let ($($part,)+) = $random;
                Self { $($part),+ }
            }
            fn exact(&self) -> Exact {
                let Self { $($part),+ } = *self;
                $exact
            }
            fn degenerate() -> Vec<Self> {
                $bad.map(|($($part),+)| Self { $($part),+ }).to_vec()
            }
            fn normal_at(&self, ray: Ray, hit: Hit) -> Vec3 {
                self.normal(ray, hit)
            }
            fn uv_at(&self, ray: Ray, hit: Hit) -> Vec2 {
                self.uv(ray, hit)
            }
            fn whole_area(&self) -> f32 {
                self.area()
            }
            fn point(&self, u: Vec2) -> SurfacePoint {
                self.sample(u)
            }
            fn point_at(&self, ray: Ray, hit: Hit) -> SurfacePoint {
                self.surface_point(ray, hit)
            }
        }
    };
}

const O: Vec3 = Vec3::ZERO;
const X: Vec3 = Vec3::X;

subject!(Ball = sphere(center: Vec3, radius: f32);
    rng size offset => (offset + rng.point(size), size * rng.range(0.1, 1.0));
    Exact::Sphere { center: wide(center), radius: radius.into() };
    [(O, 0.0), (O, -1.0)]);

subject!(Face = triangle(v0: Vec3, v1: Vec3, v2: Vec3);
    rng size offset => {
        let v0 = offset + rng.point(size);
        (v0, v0 + rng.direction() * size, v0 + rng.direction() * size)
    };
    Exact::Triangle([v0, v1, v2].map(wide));
    [(O, O, O), (O, X, X), (O, X, 2.0 * X)]);

subject!(Leaf = quad(v0: Vec3, v1: Vec3, v2: Vec3, v3: Vec3);
    rng size offset => {
        // A parallelogram, and in every other case a corner of it moved.
        let (v0, u, v) = (offset + rng.point(size), rng.direction() * size, rng.direction() * size);
        let skew = if rng.below(2) == 0 { O } else { rng.point(size * 0.3) };
        (v0, v0 + u, v0 + u + v + skew, v0 + v)
    };
    Exact::Quad([v0, v1, v2, v3].map(wide));
    [(O, O, O, O), (O, X, O, X), (O, O, X, X)]);

subject!(Panel = rectangle(corner: Vec3, u_edge: Vec3, v_edge: Vec3);
    rng size offset => {
        let (u, v) = (rng.direction(), rng.direction());
        (offset + rng.point(size), u * size, (v + u.cross(v)) * size)
    };
    {
        let (c, u, v) = (wide(corner), wide(u_edge), wide(v_edge));
        Exact::Quad([c, along(c, u, 1.0), along(along(c, u, 1.0), v, 1.0), along(c, v, 1.0)])
    };
    [(O, O, X), (O, X, O), (O, X, X), (O, O, O)]);

subject!(Disk = disk(center: Vec3, normal: Vec3, radius: f32);
    rng size offset => {
        let normal = rng.direction() * 10f32.powi(rng.below(9) as i32 - 4);
        (offset + rng.point(size), normal, size * rng.range(0.1, 1.0))
    };
    Exact::Disk { center: wide(center), normal: wide(normal), radius: radius.into() };
    [(O, X, 0.0), (O, X, -1.0), (O, O, 1.0)]);

subject!(Plane = plane(normal: Vec3, offset: f32);
    rng size near => {
        let normal = rng.direction() * 10f32.powi(rng.below(9) as i32 - 4);
        (normal, normal.dot(near) + normal.length() * rng.range(-size, size))
    };
    Exact::Plane { normal: wide(normal), offset: offset.into() };
    [(O, 0.0), (O, 1.0)]);

/// The two ends of an axis, and a radius.
fn axis(rng: &mut Rng, size: f32, offset: Vec3) -> (Vec3, Vec3, f32) {
    let p0 = offset + rng.point(size);
    let (length, radius) = (rng.range(0.1, 2.0), rng.range(0.05, 1.0));
    (p0, p0 + rng.direction() * (size * length), size * radius)
}

subject!(Rod = cylinder(p0: Vec3, p1: Vec3, radius: f32);
    rng size offset => axis(rng, size, offset);
    Exact::Cylinder { p0: wide(p0), p1: wide(p1), radius: radius.into(), has_caps: true };
    [(O, X, 0.0), (O, X, -1.0), (X, X, 1.0)]);

subject!(Tube = tube(p0: Vec3, p1: Vec3, radius: f32);
    rng size offset => axis(rng, size, offset);
    Exact::Cylinder { p0: wide(p0), p1: wide(p1), radius: radius.into(), has_caps: false };
    [(O, X, 0.0), (O, X, -1.0), (X, X, 1.0)]);

subject!(Cone = cone(base: Vec3, apex: Vec3, radius: f32);
    rng size offset => axis(rng, size, offset);
    Exact::Cone { base: wide(base), apex: wide(apex), radius: radius.into() };
    [(O, X, 0.0), (O, X, -1.0), (X, X, 1.0)]);

subject!(Crate = cuboid(min: Vec3, max: Vec3);
    rng size offset => {
        let mut extent = rng.point(size).abs();
        // Some are flat.
        if rng.below(4) == 0 {
            extent[rng.below(3)] = 0.0;
        }
        let min = offset + rng.point(size);
        (min, min + extent)
    };
    Exact::Cuboid { min: wide(min), max: wide(max) };
    [(X, O), (O, -X), (O, vec3(1.0, 1.0, -1.0))]);

/// The box in `f64`, from the closed form.
pub(crate) fn reach(exact: &Exact, o: D3, d: D3, t: f64) -> f64 {
    let largest = |v: D3| v.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    if let Exact::Plane { normal, offset } = exact {
        return largest(o) + offset.abs() / largest(*normal) + largest(d) * t.abs();
    }
    let (mut low, mut high) = ([0.0; 3], [0.0; 3]);
    for i in 0..3 {
        [low[i], high[i]] = exact.extent(i);
    }
    largest(minus(low, o)).max(largest(minus(high, o)))
}
