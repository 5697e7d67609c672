//! Every BSDF of the library through its check.

use raydsl::bsdf::{
    Bsdf, BsdfSample, Coated, ComplexIor, Conductor, Dielectric, Eon, F82, Fresnel, Lambert,
    MetallicRoughness, Mirror, Mix, Sheen, SheenCoated, ThinDielectric, fresnel_dielectric,
    ggx_distribution, ggx_masking, ggx_shadowing, sample_ggx_normal,
};
use raydsl::kernel::{Kernel, Variant};
use raydsl::prelude::*;
use raydsl::testing::check::BsdfTest;
use raydsl::testing::{can_run, run};
use raydsl::volume::{henyey_greenstein, sample_henyey_greenstein};
use raydsl::{assert_variants_agree, kernel};
use raydsl_tests::scaled;

/// Checks that share the probability of a false alarm.
const CHECKS: u32 = 40;

#[track_caller]
fn assert_holds<B: Bsdf + Type + std::fmt::Debug>(test: BsdfTest, bsdf: B) {
    match test.of(CHECKS).run(bsdf) {
        Ok(report) => println!("{bsdf:?}\n{report}"),
        Err(failure) => panic!("{bsdf:?}\n{failure}"),
    }
}

/// A fifth of the usual samples, since numeric code is hardly optimised in tests: all of them with
/// `RAYDSL_TEST_SHARE=5`.
fn test() -> BsdfTest {
    BsdfTest::new().samples(scaled(200_000) as u32, 5).explained()
}

fn white() -> BsdfTest {
    test().energy(0.99, 1.0001)
}

#[test]
fn lambert() {
    assert_holds(test(), Lambert { color: vec3(0.2, 0.5, 1.0) });
    assert_holds(white(), Lambert { color: Vec3::ONE });
}

#[test]
fn eon() {
    for roughness in [0.0, 0.3, 1.0] {
        assert_holds(white(), Eon { color: Vec3::ONE, roughness });
    }
    assert_holds(test(), Eon { color: vec3(0.0, 0.18, 0.8), roughness: 0.7 });
}

#[test]
fn mirror() {
    assert_holds(white(), Mirror { color: Vec3::ONE });
}

#[test]
fn conductors() {
    let white_metal = F82 { normal: Vec3::ONE, tint: Vec3::ONE };
    for alpha in [0.0, 1e-4, 1e-3, 0.01, 0.1, 0.5, 1.0] {
        let test = white().not_reciprocal();
        assert_holds(test, Conductor::<F82> { fresnel: white_metal, alpha });
    }
    let gold = ComplexIor { n: vec3(0.143, 0.375, 1.442), k: vec3(3.983, 2.386, 1.603) };
    assert_holds(test().not_reciprocal(), Conductor::<ComplexIor> { fresnel: gold, alpha: 0.2 });
}

#[test]
fn glass() {
    for alpha in [0.0, 0.01, 0.1, 0.5, 1.0] {
        let least = if alpha < 0.1 { 0.99 } else { 0.4 };
        for ior in [1.5, 1.0 / 1.5] {
            let test = test().energy(least, 1.0001).refracting(ior);
            assert_holds(test, Dielectric { ior, alpha, tint: Vec3::ONE });
        }
        assert_holds(white().not_reciprocal(), ThinDielectric { ior: 1.5, alpha, tint: Vec3::ONE });
    }
    assert_holds(test().energy(0.99, 1.0001), Dielectric { ior: 1.0, alpha: 0.3, tint: Vec3::ONE });
}

#[test]
fn coats() {
    let base = Lambert { color: Vec3::ONE };
    for alpha in [0.0, 0.04, 0.3, 1.0] {
        let coat = Coated::<Lambert> { base, ior: 1.5, alpha, strength: Vec3::ONE };
        assert_holds(white().not_reciprocal(), coat);
    }
    let fresnel = F82 { normal: vec3(1.0, 0.7, 0.3), tint: Vec3::ONE };
    let base = Conductor::<F82> { fresnel, alpha: 0.3 };
    let lacquer = Coated::<Conductor<F82>> { base, ior: 1.5, alpha: 0.01, strength: Vec3::ONE };
    assert_holds(test().not_reciprocal(), lacquer);
    // Black metal under a smooth coat: what is sampled least is there all the same.
    let black = F82 { normal: Vec3::ZERO, tint: Vec3::ONE };
    let base = Conductor::<F82> { fresnel: black, alpha: 0.3 };
    let smooth = Coated::<Conductor<F82>> { base, ior: 1.5, alpha: 0.0, strength: Vec3::ONE };
    assert_holds(test().not_reciprocal(), smooth);
}

#[test]
fn cloth() {
    for alpha in [0.07, 0.3, 1.0] {
        assert_holds(test(), Sheen { color: Vec3::ONE, alpha });
        let sheen = Sheen { color: vec3(1.0, 0.5, 0.2), alpha };
        let cloth = SheenCoated::<Lambert> { base: Lambert { color: Vec3::ONE }, sheen };
        assert_holds(test().energy(0.4, 1.0001).not_reciprocal(), cloth);
    }
}

#[test]
fn mixtures() {
    let under = Lambert { color: vec3(0.8, 0.2, 0.2) };
    let over = Mirror { color: vec3(0.9, 0.9, 0.9) };
    for share in [0.0, 0.3, 1.0] {
        assert_holds(test(), Mix::<Lambert, Mirror> { under, over, share });
    }
    // Several delta lobes in one direction.
    let base = Mirror { color: vec3(0.9, 0.6, 0.3) };
    let coated = Coated::<Mirror> { base, ior: 1.5, alpha: 0.0, strength: Vec3::ONE };
    assert_holds(test().not_reciprocal(), coated);
}

fn orange() -> MetallicRoughness {
    MetallicRoughness { base_color: vec3(0.9, 0.5, 0.1), ..Default::default() }
}

#[test]
fn metallic_roughness() {
    let (plain, test) = (orange(), test().not_reciprocal());
    assert_holds(test, MetallicRoughness { roughness: 0.4, ..plain });
    assert_holds(test, MetallicRoughness { metallic: 0.0, roughness: 0.3, ..plain });
    let polished = MetallicRoughness { metallic: 0.5, roughness: 0.0, clearcoat: 1.0, ..plain };
    assert_holds(test, polished);
    let white = MetallicRoughness { base_color: Vec3::ONE, ..Default::default() };
    assert_holds(test.energy(0.98, 1.0001), MetallicRoughness { metallic: 0.5, ..white });
}

#[test]
fn metallic_roughness_with_all_layers() {
    let test = test().not_reciprocal();
    let all = MetallicRoughness {
        metallic: 0.4,
        roughness: 0.6,
        transmission: 0.5,
        clearcoat: 0.7,
        clearcoat_roughness: 0.2,
        sheen_color: vec3(0.2, 0.3, 0.4),
        sheen_roughness: 0.6,
        ..orange()
    };
    assert_holds(test, all);
    assert_holds(test, MetallicRoughness { is_solid: true, ior: 1.4, ..all });
}

/// A phase function as a BSDF: without a surface, all directions are as good.
#[derive(Clone, Copy, Debug, Type)]
struct Phase {
    anisotropy: f32,
}

#[kernel]
impl Bsdf for Phase {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Vec3 {
        Vec3::splat(henyey_greenstein(-wo.dot(wi), self.anisotropy))
    }

    fn sample(&self, wo: Vec3, u: Vec3) -> BsdfSample {
        let wi = sample_henyey_greenstein(-wo, vec2(u.x, u.y), self.anisotropy);
        BsdfSample::of(wi, Phase::eval(self, wo, wi), Phase::pdf(self, wo, wi))
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        henyey_greenstein(-wo.dot(wi), self.anisotropy)
    }
}

#[test]
fn phase_functions() {
    for anisotropy in [0.0, 0.3, 0.9, -0.7, 0.99, 1.0] {
        assert_holds(white().not_reciprocal(), Phase { anisotropy });
    }
}

/// Delta lobes go where Fresnel and Snell say, to rounding of the direction.
#[test]
fn smooth_surfaces_reflect_and_refract_exactly() {
    let mut rng = Rng::new(uvec2(1, 2), 3, 4);
    for i in 0..20_000 {
        let wo = sample_uniform_sphere(rng.next_2d());
        let u = vec3(rng.next_f32(), rng.next_f32(), rng.next_f32());
        let mirrored = glam::DVec3::new(-f64::from(wo.x), -f64::from(wo.y), f64::from(wo.z));
        let seen = Mirror { color: Vec3::ONE }.sample(wo, u);
        assert!(seen.is_delta && (seen.wi.as_dvec3() - mirrored).length() < 1e-6, "{wo}");
        let ior = [1.5f32, 1.0 / 1.5, 1.0, 2.4][i % 4];
        let eta = f64::from(if wo.z < 0.0 { 1.0 / ior } else { ior });
        // The tangential part over the index; what is left of unit length is the cosine beyond.
        let across = -glam::dvec2(wo.x.into(), wo.y.into()) / eta;
        let squared = 1.0 - across.length_squared();
        let sample = Dielectric { ior, alpha: 0.0, tint: Vec3::ONE }.sample(wo, u);
        let wi = sample.wi.as_dvec3();
        assert!(sample.is_delta);
        if sample.wi.z * wo.z > 0.0 {
            assert!((wi - mirrored).length() < 1e-6, "{wo} {ior}: {sample:?}");
        } else {
            let z = squared.max(0.0).sqrt() * -f64::from(wo.z.signum());
            let off = (wi - across.extend(z)).length();
            // The root makes rounding of the direction larger next to the critical angle.
            assert!(off < 1e-6 / squared.max(1e-6).sqrt(), "{wo} {ior}: {sample:?}, {off:.1e}");
        }
        if squared <= -1e-6 {
            assert_eq!(sample.pdf, 1.0, "total reflection");
        }
    }
}

/// P-M1: at 0, 45, 60, 80, 89, 89.9 and 89.999 degrees, and what is transmitted at the last.
#[test]
fn fresnel_is_exact() {
    let cases = [
        (0.0, 0.04),
        (45.0, 0.05023991101223594),
        (60.0, 0.08918671280221278),
        (80.0, 0.3877043546914727),
        (89.0, 0.9041849497801892),
        (89.9, 0.9899118769194296),
        (89.999, 0.9998985363631976),
    ];
    for (degrees, exact) in cases {
        let cos = f64::to_radians(degrees).cos() as f32;
        let split = fresnel_dielectric(cos, 1.5);
        assert!((f64::from(split.reflected) - exact).abs() < 1e-6, "{degrees}: {split:?}");
        // The cosine itself is rounded.
        let through = 1.0 - exact;
        assert!(
            (f64::from(split.transmitted) - through).abs() < 1e-4 * through + 1e-7,
            "{degrees}"
        );
    }
    let grazing = fresnel_dielectric(f64::to_radians(89.999).cos() as f32, 1.5).transmitted;
    assert!((f64::from(grazing) / 1.0146363680238e-4 - 1.0).abs() < 1e-4, "{grazing}");
    // From inside, beyond the critical angle, all is reflected.
    assert_eq!(fresnel_dielectric(0.5, 1.0 / 1.5).reflected, 1.0);
    // The same in every variant.
    let split = kernel!(|cos: f32, eta: f32| fresnel_dielectric(cos, eta));
    let inputs: Vec<(f32, f32)> = (0..2000u16)
        .map(|i| (f32::from(i) / 2000.0, [1.5, 1.0 / 1.5][usize::from(i % 2)]))
        .collect();
    assert_variants_agree!(&split, &inputs);
    let gold = ComplexIor { n: Vec3::splat(1.5), k: Vec3::ZERO };
    assert!((gold.reflectance(0.5).x - 0.089_186_71).abs() < 1e-6);
}

/// The means of a kernel's results for all inputs, by every variant that runs here.
fn means<A: Type>(kernel: &Kernel<'_, A, f32>, inputs: &[A]) -> Vec<(Variant, f64)> {
    let all = [Variant::Scalar, Variant::widest(), Variant::Wgsl];
    let runs = all.into_iter().filter(|v| can_run(*v, "means"));
    runs.map(|variant| {
        let results = run(kernel, variant, inputs);
        (variant, results.iter().map(|v| f64::from(*v)).sum::<f64>() / inputs.len() as f64)
    })
    .collect()
}

/// P-M2 and P-M3: what is reflected of diffuse light by glass, and by the facets of white metal at
/// normal incidence if each reflects once.
#[test]
fn mean_reflectances_are_exact() {
    let centers = |count: u32| -> Vec<(f32,)> {
        (0..count).map(|k| ((k as f32 + 0.5) / count as f32,)).collect()
    };
    let glass = kernel!(|cos: f32| 2.0 * cos * fresnel_dielectric(cos, 1.5).reflected);
    for (variant, mean) in means(&glass, &centers(4000)) {
        assert!((mean - 0.091_777_959_342_351_21).abs() < 1e-6, "{}: {mean}", variant.name());
    }

    // The same all around.
    let facets = kernel!(|v: f32| {
        let (o, alpha) = (vec3(0.0, 0.0, 1.0), 0.1f32);
        let m = sample_ggx_normal(o, vec2(0.3, v), alpha);
        let i = m * (2.0 * m.z) - o;
        let both = 4.0 * i.z * ggx_shadowing(o, i, alpha);
        if i.z > 0.0 { both / ggx_masking(o, alpha) } else { 0.0 }
    });
    for (variant, mean) in means(&facets, &centers(200_000)) {
        assert!((mean - 0.988_304_056_520_612).abs() < 1e-5, "{}: {mean}", variant.name());
    }
}

/// The distribution is within 2e-6 of itself, and the masking function makes it one of what is seen:
/// P-GI6.
#[test]
fn ggx_is_exact() {
    for alpha in [1e-4f32, 1e-3, 0.01, 0.1, 0.5, 1.0] {
        let mut worst: f64 = 0.0;
        for i in 0..2000 {
            let tan = f64::from(alpha) * 1.01f64.powi(i - 1000);
            let sin = tan / (1.0 + tan * tan).sqrt();
            let m = vec3((sin * 0.6) as f32, (sin * 0.8) as f32, (1.0 - sin * sin).sqrt() as f32);
            let (x, y, z) = (f64::from(m.x), f64::from(m.y), f64::from(m.z));
            let a = f64::from(alpha);
            let e = (x * x + y * y) / (a * a) + z * z;
            let exact = 1.0 / (std::f64::consts::PI * a * a * e * e);
            worst = worst.max((f64::from(ggx_distribution(m, alpha)) / exact - 1.0).abs());
        }
        assert!(worst < 2e-6, "{alpha}: {worst:.1e}");
        for cos in [0.05f32, 0.5, 1.0] {
            let v = vec3((1.0 - cos * cos).sqrt(), 0.0, cos);
            for (variant, seen) in weak_furnace(v, alpha) {
                assert!((seen - 1.0).abs() < 1e-4, "{} {alpha} {cos}: {seen}", variant.name());
            }
        }
    }
}

/// The integral of what is seen of all facets, over the cosine: in `tan / alpha` and turns.
fn weak_furnace(v: Vec3, alpha: f32) -> Vec<(Variant, f64)> {
    let (rows, columns) = (2000u32, 200u32);
    let inputs: Vec<(u32, u32)> =
        (0..rows).flat_map(|i| (0..columns).map(move |k| (i, k))).collect();
    let seen = kernel!(|i: u32, k: u32| {
        // The distribution times the cosine is uniform in u; 1 - u is a square, so that the tail is
        // smooth.
        let w = (i as f32 + 0.5) / rows as f32;
        let tan = alpha * ((1.0 - w * w) / (w * w)).sqrt();
        let cos = 1.0 / (1.0 + tan * tan).sqrt();
        let turn = sincos_2pi((k as f32 + 0.5) / columns as f32);
        let m = vec3(tan * cos * turn.cos, tan * cos * turn.sin, cos);
        ggx_masking(v, alpha) * 2.0 * w * max(m.dot(v), 0.0) / (cos * v.z)
    });
    means(&seen, &inputs)
}
