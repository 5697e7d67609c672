//! Lights without area, mirrors, grids of one voxel and functions of one knot.

use raydsl::Type;
use raydsl::bsdf::{Bsdf, BsdfSample, Conductor, F82};
use raydsl::light::{AreaLight, DiskShape, Light, LightSample, RectangleShape, SphereShape};
use raydsl::prelude::*;
use raydsl::volume::{
    Centering, ExactCell, Grid, GridConfig, TransferFunction, Volume, VolumeLight,
};
use raydsl_tests::rng::Rng;

use super::super::fault;
use crate::row::{Bound, Row, Unit};

pub(super) fn rows() -> Vec<Row> {
    vec![no_area(), mirror(), one_voxel(), one_knot()]
}

/// Lights without area, at a point.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
struct NoAreas {
    sphere: AreaLight<SphereShape>,
    disk: AreaLight<DiskShape>,
    rectangle: AreaLight<RectangleShape>,
    triangle: AreaLight<Triangle>,
}

impl NoAreas {
    fn new(at: Vec3, edge: Vec3) -> Self {
        let (radiance, is_two_sided) = (vec3(1.0, 2.0, 3.0), true);
        let sphere = SphereShape { center: at, radius: 0.0 };
        let disk = DiskShape { center: at, normal: edge, radius: 0.0 };
        let rectangle = RectangleShape { corner: at, u_edge: edge, v_edge: edge };
        let triangle = Triangle { v0: at, v1: at + edge, v2: at + edge };
        Self {
            sphere: AreaLight { shape: sphere, radiance, is_two_sided },
            disk: AreaLight { shape: disk, radiance, is_two_sided },
            rectangle: AreaLight { shape: rectangle, radiance, is_two_sided },
            triangle: AreaLight { shape: triangle, radiance, is_two_sided },
        }
    }
}

/// Samples of them.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
struct Samples {
    sphere: LightSample,
    disk: LightSample,
    rectangle: LightSample,
    triangle: LightSample,
}

fn no_area() -> Row {
    let row = Row::new("lights without area", 5, Unit::Faults, Bound::NONE, |run| {
        let kernel = kernel!(|from: Vec3, u: Vec2, lights: NoAreas| Samples {
            sphere: lights.sphere.sample(from, u),
            disk: lights.disk.sample(from, u),
            rectangle: lights.rectangle.sample(from, u),
            triangle: lights.triangle.sample(from, u),
        });
        let make = |rng: &mut Rng| {
            let at = rng.point(3.0);
            // Sometimes from the light itself.
            let from = if rng.below(8) == 0 { at } else { rng.point(3.0) };
            (from, vec2(rng.unit(), rng.unit()), NoAreas::new(at, rng.direction()))
        };
        run.measure(&[kernel], make, |_, s| {
            let lights_nothing = |s: &LightSample| {
                let is_number = s.wi.is_finite() && s.light.is_finite() && !s.pdf.is_nan();
                is_number && (s.light == Vec3::ZERO || s.pdf == 0.0)
            };
            fault(![s.sphere, s.disk, s.rectangle, s.triangle].iter().all(lights_nothing))
        })
    });
    row.share(0.2)
}

/// What a lobe says.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
struct Lobe {
    sample: BsdfSample,
    eval: Vec3,
    pdf: f32,
}

fn mirror() -> Row {
    let row = Row::new("roughness 0", 5, Unit::Faults, Bound::NONE, |run| {
        let kernel = kernel!(|wo: Vec3, wi: Vec3, u: Vec3, metal: Conductor<F82>| Lobe {
            sample: metal.sample(wo, u),
            eval: metal.eval(wo, wi),
            pdf: metal.pdf(wo, wi),
        });
        let make = |rng: &mut Rng| {
            let wo = rng.direction().normalize();
            // Every other other direction is the mirrored one.
            let wi = match rng.below(2) {
                0 => rng.direction().normalize(),
                _ => vec3(-wo.x, -wo.y, wo.z),
            };
            let fresnel = F82 { normal: vec3(0.25, 0.5, 1.0), tint: Vec3::ONE };
            let metal = Conductor { fresnel, alpha: rng.pick(&[0.0, -0.0]) };
            (wo, wi, vec3(rng.unit(), rng.unit(), rng.unit()), metal)
        };
        run.measure(&[kernel], make, |&(wo, ..), lobe| {
            let Lobe { sample, eval, pdf } = *lobe;
            let is_mirror = sample.is_delta
                && sample.wi == vec3(-wo.x, -wo.y, wo.z)
                && sample.pdf == 1.0
                && sample.weight.cmpge(vec3(0.249, 0.499, 0.999)).all()
                && sample.weight.cmple(Vec3::splat(1.0 + 1e-6)).all();
            fault(!(is_mirror && eval == Vec3::ZERO && pdf == 0.0))
        })
    });
    row.share(0.2)
}

/// The opacity of a cube of one voxel, against the length of the ray in it.
fn one_voxel() -> Row {
    let row = Row::new("a grid of one voxel", 8, Unit::Absolute, Bound::all(1e-5), |run| {
        let config = GridConfig::new().centering(Centering::Cell);
        let grid = Grid::new(&[0.5f32][..], UVec3::ONE, config)?;
        let function = TransferFunction::from_extinction(&[(0.0, Vec3::ONE)], &[(0.0, 1.5)])?;
        let volume = Volume::new(&grid, function);
        let exact = ExactCell::new().least(0.0);
        let kernel = kernel!(|ray: Ray| {
            let light = volume.integrate(&exact, ray, VolumeLight::new());
            light.transmittance()
        });
        let (low, high) = (Vec3::splat(-0.5), Vec3::splat(0.5));
        let make = |rng: &mut Rng| {
            let target = rng.point(0.6);
            let way = rng.direction().normalize();
            (Ray::new(target - way * rng.range(0.0, 5.0), way),)
        };
        run.measure(&[kernel], make, |(ray,), transmittance| {
            let (mut near, mut far) = (0.0f64, f64::INFINITY);
            for axis in 0..3 {
                let (o, d) = (f64::from(ray.origin[axis]), f64::from(ray.direction[axis]));
                let (a, b) = ((f64::from(low[axis]) - o) / d, (f64::from(high[axis]) - o) / d);
                (near, far) = (near.max(a.min(b)), far.min(a.max(b)));
            }
            let exact = (-1.5 * (far - near).max(0.0)).exp();
            Some((f64::from(*transmittance) - exact).abs())
        })
    });
    row.share(0.1)
}

fn one_knot() -> Row {
    Row::new("a function of one knot", 8, Unit::Faults, Bound::NONE, |run| {
        let color = vec3(0.25, 0.5, 0.75);
        let function = TransferFunction::from_extinction(&[(3.0, color)], &[(-2.0, 1.5)])?;
        let kernel = kernel!(|value: f32| {
            let sample = function.at(value);
            (sample.color, sample.extinction)
        });
        let make = |rng: &mut Rng| {
            let large = f32::from_bits(rng.bits() as u32);
            let value = if large.is_finite() { large } else { rng.range(-9.0, 9.0) };
            (rng.pick(&[value, 3.0, -2.0, 0.0, f32::MAX, -f32::MAX]),)
        };
        run.measure(&[kernel], make, |_, found| fault(*found != (color, 1.5)))
    })
}
