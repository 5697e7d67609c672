//! Lights: densities of samples, narrow cones, and paths that roulette ends.

use std::f64::consts::PI;

use raydsl::bsdf::{Lambert, Luminous};
use raydsl::geometry::Aabb;
use raydsl::integrators::{PathLimits, path};
use raydsl::light::{
    AnyLight, AreaLight, DiskShape, Environment, Light, LightShape, Lights, PointLight,
    RectangleShape, SphereShape, SpotLight,
};
use raydsl::prelude::*;
use raydsl::{Type, kernel};
use raydsl_tests::rng::Rng as Source;

use super::ball::Ball;
use super::bsdfs::formulas;
use super::largest;
use super::statistics::Mean;
use crate::outcome::Outcome;
use crate::row::{Bound, Group, Row, Unit};

pub(crate) const GROUP: Group = Group {
    name: "lights",
    title: "Lights and paths",
    clauses: &[
        "A sample's density is that of its direction, and the inverse of the solid angle where a \
         light is sampled by that, to 1e-4; seen from within the light's plane nothing is promised.",
        "Densities integrate to 1: the mean of their inverses is the solid angle to 1e-4 beyond 4.5 \
         standard errors.",
        "Cones are right to 4e-7 of themselves at any angle.",
        "Roulette changes no mean: it is right to 1e-5 beyond 4.5 standard errors.",
        "The lights of a tree are chosen with the probability that each is told, to 1e-5 of it, and \
         these add up to 1 to 1e-5, wherever they are asked from.",
    ],
    rows,
};

fn rows() -> Vec<Row> {
    vec![
        density("density, sphere", Some(angle_of_sphere), |rng| {
            let (center, radius) = (rng.point(1.0), 10f32.powf(rng.range(-3.0, 0.0)));
            let sphere = AnyLight::Sphere(area(SphereShape { center, radius }));
            (sphere, beside(rng, center, radius))
        }),
        density("density, triangle", Some(angle_of_triangles), |rng| {
            let (corners, from) = seen_from(rng);
            let [v0, v1, v2] = corners;
            (AnyLight::Triangle(area(Triangle { v0, v1, v2 })), from)
        }),
        density("density, rectangle", Some(angle_of_triangles), |rng| {
            let ([corner, a, b], from) = seen_from(rng);
            let shape = RectangleShape { corner, u_edge: a - corner, v_edge: b - corner };
            (AnyLight::Rectangle(area(shape)), from)
        }),
        density("density, disk", None, |rng| {
            let ([center, a, b], from) = seen_from(rng);
            let normal = (a - center).cross(b - center);
            let shape = DiskShape { center, normal, radius: rng.range(0.1, 1.0) };
            (AnyLight::Disk(area(shape)), from)
        }),
        disk_on_its_axis(),
        environment(),
        cone("cones: height", |found, s| (found.height, s * s / (1.0 + (1.0 - s * s).sqrt()))),
        cone("cones: rim", |found, s| (found.rim, s)),
        roulette(),
        choices(),
    ]
}

/// What a light says of a sample.
#[derive(Clone, Copy, Debug, Type)]
struct Lit {
    pdf: f32,
    /// The density of the sample's direction.
    again: f32,
}

#[kernel]
fn lit(light: AnyLight, from: Vec3, u: Vec2) -> Lit {
    let sample = light.sample(from, u);
    Lit { pdf: sample.pdf, again: light.pdf(from, sample.end) }
}

fn area<S: LightShape + Type>(shape: S) -> AreaLight<S> {
    AreaLight::<S> { shape, radiance: Vec3::ONE, is_two_sided: true }
}

/// A point outside of a ball, up to a thousand radii from it.
fn beside(rng: &mut Source, center: Vec3, radius: f32) -> Vec3 {
    center + rng.direction().normalize() * (radius * 10f32.powf(rng.range(0.05, 3.0)))
}

/// A triangle that is no sliver, and a point that sees it under more than a degree.
fn seen_from(rng: &mut Source) -> ([Vec3; 3], Vec3) {
    loop {
        let [a, b, c] = [(); 3].map(|()| rng.point(1.0));
        let normal = (b - a).cross(c - a);
        let from = beside(rng, (a + b + c) / 3.0, 1.0);
        let is_no_sliver = normal.length() > 0.1 * (b - a).length() * (c - a).length();
        let height = normal.normalize_or_zero().dot(a - from).abs();
        if is_no_sliver && height > 0.02 * (a - from).length() {
            return ([a, b, c], from);
        }
    }
}

fn angle_of_sphere(light: &AnyLight, from: Vec3) -> Option<f64> {
    let AnyLight::Sphere(light) = light else { return None };
    let (radius, way) = (f64::from(light.shape.radius), (light.shape.center - from).as_dvec3());
    let sine2 = radius * radius / way.length_squared();
    Some(2.0 * PI * sine2 / (1.0 + (1.0 - sine2).sqrt()))
}

/// Of triangles and rectangles; smaller ones are sampled by area, and larger ones by the hemisphere.
fn angle_of_triangles(light: &AnyLight, from: Vec3) -> Option<f64> {
    const SAMPLED: std::ops::Range<f64> = 1.01e-4..6.1;
    let angle = match light {
        AnyLight::Triangle(AreaLight { shape: t, .. }) => solid_angle(from, [t.v0, t.v1, t.v2]),
        AnyLight::Rectangle(AreaLight { shape: r, .. }) => {
            let (a, b) = (r.corner + r.u_edge, r.corner + r.v_edge);
            let far = a + r.v_edge;
            solid_angle(from, [r.corner, a, b]) + solid_angle(from, [a, far, b])
        }
        _ => return None,
    };
    Some(angle).filter(|angle| SAMPLED.contains(angle))
}

/// Van Oosterom and Strackee ("The Solid Angle of a Plane Triangle", 1983).
fn solid_angle(from: Vec3, corners: [Vec3; 3]) -> f64 {
    let [a, b, c] = corners.map(|v| v.as_dvec3() - from.as_dvec3());
    let (x, y, z) = (a.length(), b.length(), c.length());
    // Of differences of corners: the product of the corners themselves cancels from afar.
    let over = a.dot((b - a).cross(c - a));
    let under = x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y;
    2.0 * over.abs().atan2(under)
}

/// `draw` returns a light and a point that it is seen from, `angle` the solid angle of a light that is
/// sampled by that.
fn density(
    name: &'static str,
    angle: Option<fn(&AnyLight, Vec3) -> Option<f64>>,
    draw: fn(&mut Source) -> (AnyLight, Vec3),
) -> Row {
    Row::new(name, 1, Unit::Relative, Bound::all(1e-4), move |run| {
        let make = |rng: &mut Source| {
            let (light, from) = draw(rng);
            (light, from, vec2(rng.unit(), rng.unit()))
        };
        run.measure(&[Kernel::of::<lit>()], make, |(light, from, _), found| {
            let (pdf, again) = (f64::from(found.pdf), f64::from(found.again));
            let off = (again - pdf).abs() / pdf;
            let of_angle = angle.and_then(|angle| angle(light, *from));
            let of_angle = of_angle.map(|angle| (pdf * angle - 1.0).abs());
            // A NaN is not the lesser of two.
            Some(off + of_angle.unwrap_or(0.0))
        })
    })
}

/// A disk is sampled by its area.
fn disk_on_its_axis() -> Row {
    let name = "mean inverse density, disk";
    Row::new(name, 2, Unit::Relative, Bound::all(1e-4), |run| {
        let shape = DiskShape { center: Vec3::ZERO, normal: Vec3::Z, radius: 0.75 };
        let light = AnyLight::Disk(area(shape));
        let from = vec3(0.0, 0.0, 0.5);
        let angle = 2.0 * PI * (1.0 - 0.5 / 0.5f64.hypot(0.75));
        let none =
            Mean::new(angle, |_: &(AnyLight, Vec3, Vec2), found: &Lit| 1.0 / f64::from(found.pdf));
        run.gather(&Kernel::of::<lit>(), &none, |rng| (light, from, vec2(rng.unit(), rng.unit())))
    })
}

/// A sky that is bright in one spot, sampled by a table of its texels.
fn environment() -> Row {
    let name = "mean inverse density, environment";
    Row::new(name, 2, Unit::Relative, Bound::all(1e-4), |run| {
        let texels: Vec<Vec3> =
            (0..32 * 16).map(|i| vec3((i % 32) as f32 + 4.0, (i / 32) as f32 * 0.5, 1.0)).collect();
        let sky = Environment::new(&texels, uvec2(32, 16))?;
        let none: [AnyLight; 0] = [];
        let lights = Lights::new(&none, cube())?.with_environment(&sky);
        let kernel = kernel!(|u: Vec3| {
            let up = vec3(0.0, 0.0, 1.0);
            let point = SurfacePoint { position: vec3(0.0, 0.0, 0.0), normal: up, error: 0.0 };
            lights.sample(point, u).pdf
        });
        let none = Mean::new(4.0 * PI, |_: &(Vec3,), pdf: &f32| 1.0 / f64::from(*pdf));
        run.gather(&kernel, &none, |rng| (vec3(rng.unit(), rng.unit(), rng.unit()),))
    })
}

fn cube() -> Aabb {
    Aabb { min: Vec3::splat(-2.0), max: Vec3::splat(2.0) }
}

/// The textbook is `1 - sqrt(1 - s^2)`, and the sine of its angle.
fn cone(name: &'static str, of: fn(&super::bsdfs::Formulas, f64) -> (f32, f64)) -> Row {
    Row::new(name, 3, Unit::Relative, Bound::all(4e-7), move |run| {
        let make = |rng: &mut Source| (Vec3::Z, 0.5, 0.5, 1.5, 2f32.powf(rng.range(-60.0, 0.0)));
        let off = |found: f32, exact: f64| (f64::from(found) / exact - 1.0).abs();
        let kernel = [Kernel::of::<formulas>()];
        let outcome = run.measure(&kernel, make, |input, found| {
            let (found, exact) = of(found, input.4.into());
            Some(off(found, exact))
        })?;
        let mut rng = Source::new(run.seed);
        let textbook = (0..run.count.clamp(1000, 1_000_000)).map(|_| {
            let sine = make(&mut rng).4;
            let height = 1.0 - (1.0 - sine * sine).sqrt();
            let found = super::bsdfs::Formulas {
                height,
                rim: (height * (2.0 - height)).sqrt(),
                ggx: 0.0,
                split: Default::default(),
            };
            let (found, exact) = of(&found, sine.into());
            off(found, exact)
        });
        Ok(outcome.beside(largest(textbook)))
    })
}

/// Paths inside of a sphere that shines with the radiance 1 and scatters 4/5: all in all 5.
fn roulette() -> Row {
    Row::new("roulette from bounce 0, 3, never", 4, Unit::Relative, Bound::all(1e-5), |run| {
        let ball = [Ball { center: Vec3::ZERO, radius: 1.0 }];
        let scene = &ball[..];
        let shape = SphereShape { center: Vec3::ZERO, radius: 1.0 };
        let list = [AnyLight::Sphere(area(shape))];
        let lights = Lights::new(&list, cube())?;
        let paint = Luminous::<Lambert> { bsdf: Lambert { color: Vec3::splat(0.8) }, light: 0 };
        let ray = Ray::new(vec3(0.1, 0.2, 0.0), vec3(0.0, 0.6, 0.8));
        let mut all = Outcome::default();
        for (part, roulette) in [0, 3, u32::MAX].into_iter().enumerate() {
            let limits = PathLimits { bounces: 64, roulette };
            let kernel = kernel!(|i: u32, seed: u32| {
                let surface = |_hit: Hit, _point: ShadingPoint| paint;
                let sampler = Sampler::new(uvec2(i, seed), 7, 0, 1, SampleMethod::Random);
                path::<_, _, Luminous<Lambert>>(scene, surface, &lights, limits, ray, sampler)
                    .color
                    .x
            });
            let exact = (1.0 - 0.8f64.powi(65)) / 0.2;
            let none = Mean::new(exact, |_: &(u32, u32), light: &f32| f64::from(*light));
            let make = |rng: &mut Source| (rng.bits() as u32, rng.bits() as u32);
            all.merge(run.unit, run.part(1.0 / 3.0, part as u64).gather(&kernel, &none, make)?);
        }
        Ok(all)
    })
    .share(0.1)
}

/// Lights of five kinds, large and small, bright and dim, close together and far apart.
fn many_lights(rng: &mut Source) -> Vec<AnyLight> {
    let mut light = |i: usize| {
        let reach = 10f32.powf(rng.range(-3.0, 3.0));
        let position = rng.point(reach);
        let direction = rng.direction().normalize();
        let size = 10f32.powf(rng.range(-4.0, 1.0));
        let intensity = Vec3::splat(10f32.powf(rng.range(-6.0, 6.0)));
        match i % 5 {
            0 => AnyLight::Point(PointLight { position, intensity }),
            1 => {
                let cos_outer = 1.0 - 10f32.powf(rng.range(-6.0, 0.2));
                let cos_inner = 0.5 * (1.0 + cos_outer);
                AnyLight::Spot(SpotLight { position, intensity, direction, cos_inner, cos_outer })
            }
            2 => AnyLight::Sphere(area(SphereShape { center: position, radius: size })),
            3 => {
                let shape = DiskShape { center: position, normal: direction, radius: size };
                let radiance = intensity;
                AnyLight::Disk(AreaLight::<DiskShape> { shape, radiance, is_two_sided: false })
            }
            _ => {
                let [v0, v1, v2] = [(); 3].map(|()| position + size * rng.point(1.0));
                AnyLight::Triangle(area(Triangle { v0, v1, v2 }))
            }
        }
    };
    (0..61).map(&mut light).collect()
}

/// A choice among lights.
#[derive(Clone, Copy, Debug, Type)]
struct Chosen {
    chance: f32,
    /// The probability of the light that was chosen.
    again: f32,
    /// The probabilities of all lights.
    sum: f32,
}

/// Points at a light, inside of one, and far away from all; those of a medium have no normal.
fn choices() -> Row {
    let name = "choices of 61 lights by a tree";
    Row::new(name, 5, Unit::Relative, Bound::all(1e-5), |run| {
        let mut all = Outcome::default();
        for part in 0..8 {
            let run = run.part(1.0 / 8.0, part);
            let list = many_lights(&mut Source::new(run.seed));
            let lights = Lights::new(&list, cube())?.with_tree()?;
            let kernel = kernel!(|from: SurfacePoint, u: f32| {
                let choice = lights.choose(from, u);
                let mut sum = 0.0;
                for i in 0..lights.count() {
                    sum += lights.chance(i, from);
                }
                Chosen { chance: choice.chance, again: lights.chance(choice.light, from), sum }
            });
            let make = |rng: &mut Source| {
                let light = &list[rng.below(list.len())];
                let way = rng.direction() * 10f32.powf(rng.range(-5.0, 5.0));
                let extent = light.extent();
                let position = 0.5 * (extent.min + extent.max) + way;
                let is_in_medium = rng.below(4) == 0;
                let normal = if is_in_medium { Vec3::ZERO } else { rng.direction().normalize() };
                (SurfacePoint { position, normal, error: 0.0 }, rng.unit())
            };
            let found = run.measure(&[kernel], make, |_, found| {
                let [chance, again, sum] = [found.chance, found.again, found.sum].map(f64::from);
                // A NaN is not the lesser of two, and what has no chance is not chosen.
                Some((again - chance).abs() / chance + (sum - 1.0).abs())
            })?;
            all.merge(run.unit, found);
        }
        Ok(all)
    })
    .share(0.02)
}
