//! Faults that are put into BSDFs and lights, and what the checks say of them. Many are those of
//! other renderers. More of theirs have tests elsewhere:
//!
//! | fault | test |
//! |---|---|
//! | roulette divides by a throughput above 1 | `light_transport`, "inside a sphere, roulette 0" |
//! | rays leave a surface along its shading normal; light leaks at grazing angles | `raydsl::bsdf::frame`, `light_does_not_leak` |
//! | metal and dielectric are mixed before what is scattered several times is compensated | `bsdfs`, `metallic_roughness` |
//! | glass transmits nothing; the furnace is above or below 1 | `bsdfs`, `glass`, `coats`, `conductors` |
//! | light is counted twice where it is sampled and hit | `light_transport`, every mean with weights and without |
//! | a volume's light has the density of a surface's | `light_transport`, "lamp" |
//! | opacity is taken for extinction | `volumes` |

use std::f32::consts::{FRAC_1_PI, PI};

use raydsl::bsdf::{
    Bsdf, BsdfSample, Coated, Dielectric, Lambert, ggx_distribution, ggx_shadowing,
    sample_ggx_normal,
};
use raydsl::kernel;
use raydsl::light::{DistantLight, Light, LightExtent, LightSample};
use raydsl::prelude::*;
use raydsl::testing::check::{BsdfTest, EstimatorsTest, LightTest};

/// A BSDF with one fault, by its number in the test below.
#[derive(Clone, Copy, Debug, Type)]
struct Broken {
    fault: u32,
}

const ALPHA: f32 = 0.3;

/// White paint.
#[kernel]
fn diffuse(fault: u32, wo: Vec3, wi: Vec3) -> f32 {
    let is_reflected = wo.z * wi.z > 0.0;
    let cosine = if fault == 1 { 1.0 } else { wi.z.abs() };
    let one_sided = if fault == 6 { wo.z > 0.0 } else { true };
    let grazing = if fault == 4 { 1.0 + 0.0 * (wo.z.abs() - 1e-5).sqrt() } else { 1.0 };
    let uneven = if fault == 5 { wo.z.abs() } else { 1.0 };
    let value = FRAC_1_PI * cosine * grazing * uneven;
    if is_reflected && one_sided { value } else { 0.0 }
}

/// White metal, both directions above the surface.
#[kernel]
fn rough(fault: u32, wo: Vec3, wi: Vec3) -> (f32, f32) {
    let m = normalize(wo + wi);
    let facets = ggx_distribution(m, ALPHA);
    let seen = if fault == 11 { 0.25 / (wo.z * wi.z) } else { ggx_shadowing(wo, wi, ALPHA) };
    let eval = facets * seen * wi.z;
    let wrong = if fault == 12 { eval / facets.sqrt() } else { eval };
    let stretched = (ALPHA * ALPHA * (1.0 - wo.z * wo.z) + wo.z * wo.z).sqrt();
    let jacobian = if fault == 13 { wo.dot(m) } else { 0.25 };
    let pdf = facets * 2.0 * jacobian / (wo.z + stretched);
    let is_lobe = wo.z > 0.0 && wi.z > 0.0;
    (if is_lobe { wrong } else { 0.0 }, if is_lobe { pdf } else { 0.0 })
}

/// Glass whose shares of reflected and transmitted light are exchanged, but not in its samples.
#[kernel]
fn exchanged(wo: Vec3, wi: Vec3) -> Vec3 {
    let glass = Dielectric { ior: 1.5, alpha: ALPHA, tint: Vec3::ONE };
    let factor = if wo.z * wi.z > 0.0 { 8.0 } else { 0.5 };
    Dielectric::eval(&glass, wo, wi) * factor
}

/// What a coat reflects, above nothing.
#[kernel]
fn coat(wo: Vec3, wi: Vec3) -> Vec3 {
    let base = Lambert { color: Vec3::ZERO };
    let coated = Coated::<Lambert> { base, ior: 1.5, alpha: ALPHA, strength: Vec3::ONE };
    Coated::<Lambert>::eval(&coated, wo, wi)
}

#[kernel]
impl Bsdf for Broken {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Vec3 {
        if self.fault == 21 {
            return exchanged(wo, wi);
        }
        if self.fault == 22 {
            // Diffuse light is not reduced by what is reflected above it.
            return coat(wo, wi) + Vec3::splat(diffuse(0, wo, wi));
        }
        if self.fault == 25 {
            return Vec3::splat(0.25 * FRAC_1_PI);
        }
        if self.fault >= 23 {
            return Vec3::splat(0.0);
        }
        if self.fault >= 10 {
            let (eval, _) = rough(self.fault, wo, wi);
            return Vec3::splat(eval);
        }
        Vec3::splat(diffuse(self.fault, wo, wi))
    }

    fn sample(&self, wo: Vec3, u: Vec3) -> BsdfSample {
        let square = vec2(u.x, u.y);
        if self.fault == 21 {
            let glass = Dielectric { ior: 1.5, alpha: ALPHA, tint: Vec3::ONE };
            return Dielectric::sample(&glass, wo, u);
        }
        if self.fault >= 10 && self.fault < 20 {
            let m = sample_ggx_normal(wo, square, ALPHA);
            let wi = m * (2.0 * wo.dot(m)) - wo;
            // The wrong exponent is that of `eval` alone.
            let (eval, pdf) = rough(if self.fault == 12 { 10 } else { self.fault }, wo, wi);
            if pdf <= 0.0 {
                return BsdfSample::absorbed();
            }
            return BsdfSample::of(wi, Vec3::splat(eval), pdf);
        }
        let up = if self.fault == 3 {
            sample_uniform_hemisphere(square)
        } else {
            sample_cosine_hemisphere(square)
        };
        let wi = vec3(up.x, up.y, if wo.z < 0.0 { -up.z } else { up.z });
        let pdf = Broken::pdf(self, wo, wi);
        let sample = BsdfSample::of(wi, Broken::eval(self, wo, wi), pdf);
        let weight = if self.fault == 7 { sample.weight * 0.5 } else { sample.weight };
        let direction = if self.fault == 8 { wi * 0.5 } else { wi };
        if self.fault == 23 {
            // One direction, with half of its probability.
            let mirrored = vec3(-wo.x, -wo.y, wo.z);
            return BsdfSample::delta(mirrored, Vec3::splat(1.0), 0.5);
        }
        if self.fault == 24 {
            return BsdfSample::delta(wi, Vec3::splat(1.0), 1.0);
        }
        if self.fault == 9 {
            return BsdfSample {
                wi: vec3(-wo.x, -wo.y, wo.z),
                weight: Vec3::ONE,
                pdf: 1.0,
                is_delta: false,
            };
        }
        BsdfSample { weight, wi: direction, ..sample }
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        if self.fault == 21 {
            let glass = Dielectric { ior: 1.5, alpha: ALPHA, tint: Vec3::ONE };
            return Dielectric::pdf(&glass, wo, wi);
        }
        if self.fault >= 10 && self.fault < 20 {
            let (_, pdf) = rough(self.fault, wo, wi);
            return pdf;
        }
        let factor = if self.fault == 2 { 2.0 } else { 1.0 };
        if wo.z * wi.z > 0.0 { factor * cosine_hemisphere_pdf(wi.z.abs()) } else { 0.0 }
    }
}

/// What a check says of each fault.
#[test]
fn faults_of_bsdfs_are_found() {
    let found = "samples and pdf differ";
    let unlike = "a sample's pdf or weight is not that of its direction";
    let unsound = "a sample is negative, not finite or not of unit length";
    let cases = [
        (1, "light is created", "the cosine is missing"),
        (2, "pdf integrates to more than 1", "the density is not normalised"),
        (3, found, "samples are uniform, the density is that of the cosine"),
        (4, "a value is negative or not finite", "NaN at grazing directions"),
        (5, "not reciprocal", "one direction alone has a factor"),
        (7, unlike, "the weight has another factor than the value"),
        (8, unsound, "directions are not of unit length"),
        (9, unlike, "a delta lobe is not marked as one"),
        (11, "light is created", "shadowing is missing"),
        (12, unlike, "the distribution has another exponent where it is evaluated"),
        (13, found, "the Jacobian of the reflection is missing"),
        (21, "weights and eval differ", "reflected and transmitted light are exchanged"),
        (22, "light is created", "diffuse light is not reduced by what is reflected above it"),
        (23, "delta samples are not as frequent as their pdf says", "a mirror with half a pdf"),
        (24, "delta samples are of many kinds", "diffuse samples are marked as a mirror's"),
        (25, "weights and eval differ", "an isotropic phase function with the density of a cosine"),
    ];
    let test = BsdfTest { variants: false, ..BsdfTest::new().samples(100_000, 4) };
    for (fault, expected, name) in cases {
        let Err(failure) = test.run(Broken { fault }) else { panic!("not found: {name}") };
        let faults: Vec<&str> = failure.faults().collect();
        println!("{name}: {failure}");
        assert!(faults.contains(&expected), "{name}: {failure}");
    }
    // Without a fault nothing is found, but for the light that metal loses between its facets.
    assert!(test.run(Broken { fault: 0 }).is_ok());
    let metal = test.not_reciprocal();
    let above = metal.run(Broken { fault: 10 });
    assert!(above.is_ok_and(|r| r.rows.iter().all(|row| row.albedo.x < 1.0)));
    let failure = test.energy(0.99, 1.0001).run(Broken { fault: 10 }).expect_err("light is lost");
    assert!(failure.faults().any(|f| f == "light is lost"), "{failure}");
    // One that reflects on the front alone loses all light on the back.
    let failure =
        test.energy(0.99, 1.0001).run(Broken { fault: 6 }).expect_err("the back is black");
    assert!(failure.to_string().contains("light is lost"), "{failure}");
}

/// A sky with one fault, by its number in the test below.
#[derive(Clone, Copy, Debug, Type)]
struct BrokenSky {
    fault: u32,
}

#[kernel]
impl BrokenSky {
    fn radiance(self, direction: Vec3) -> Vec3 {
        Vec3::splat(0.2 + max(direction.z, 0.0))
    }
}

#[kernel]
impl Light for BrokenSky {
    fn sample(&self, _from: Vec3, u: Vec2) -> LightSample {
        // Latitudes are as frequent as each other: the sine is forgotten.
        let latitude = PI * u.x;
        let turn = sincos_2pi(u.y);
        let poles = vec3(sin(latitude) * turn.cos, sin(latitude) * turn.sin, cos(latitude));
        let even = sample_uniform_sphere(u);
        let wi = if self.fault == 1 { poles } else { even };
        let length = if self.fault == 4 { 2.0 } else { 1.0 };
        LightSample::distant(wi * length, BrokenSky::radiance(*self, wi), 0.25 * FRAC_1_PI, false)
    }

    fn distant(&self, direction: Vec3) -> DistantLight {
        let factor = if self.fault == 2 { 2.0 } else { 1.0 };
        let pdf = if self.fault == 3 { FRAC_1_PI } else { 0.25 * FRAC_1_PI };
        DistantLight { radiance: BrokenSky::radiance(*self, direction) * factor, pdf }
    }

    fn is_distant(&self) -> bool {
        true
    }

    fn power(&self, radius: f32) -> f32 {
        if self.fault == 5 { -1.0 } else { radius * radius }
    }

    fn extent(&self) -> LightExtent {
        let (min, max) = (Vec3::ZERO, Vec3::ZERO);
        LightExtent { min, max, axis: vec3(0.0, 0.0, 1.0), cos_normals: -1.0, cos_emitted: 0.0 }
    }
}

#[test]
fn faults_of_lights_are_found() {
    let nothing: [Triangle; 0] = [];
    let test = LightTest { variants: false, ..LightTest::new().samples(100_000, 2) };
    let cases = [
        (1, "samples and pdf differ", "no sine in the density"),
        (2, "a sample's pdf or radiance is not that of its direction", "counted twice"),
        (3, "pdf integrates to more than 1", "the density of a cosine for a sphere"),
        (4, "a sample is negative, not finite or not of unit length", "a long direction"),
        (5, "the power is negative or not finite", "negative power"),
    ];
    for (fault, expected, name) in cases {
        let Err(failure) = test.run(BrokenSky { fault }, &nothing[..]) else {
            panic!("not found: {name}")
        };
        assert!(failure.faults().any(|f| f == expected), "{name}: {failure}");
    }
    assert!(test.run(BrokenSky { fault: 0 }, &nothing[..]).is_ok());
    // What is counted twice, or weighted wrongly, has other means with and without weights.
    let paint = Lambert { color: Vec3::ONE };
    let means = EstimatorsTest { samples: 100_000, ..EstimatorsTest::new() };
    for fault in [1, 2, 3] {
        assert!(means.run(paint, BrokenSky { fault }, &nothing[..]).is_err(), "{fault}");
    }
    let report = means.run(paint, BrokenSky { fault: 0 }, &nothing[..]).expect("one mean");
    assert!(report.to_string().contains("both"), "{report}");
}
