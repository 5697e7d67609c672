//! Every BSDF of the library through its check.

use raydsl::bsdf::{
    Bsdf, Coated, ComplexIor, Conductor, Dielectric, Eon, F82, Lambert, MetallicRoughness, Mirror,
    Mix, Sheen, SheenCoated, ThinDielectric,
};
use raydsl::prelude::*;
use raydsl::testing::check::BsdfTest;

/// Checks that share the probability of a false alarm.
const CHECKS: u32 = 40;

#[track_caller]
fn assert_holds<B: Bsdf + Type + std::fmt::Debug>(test: BsdfTest, bsdf: B) {
    match test.of(CHECKS).run(bsdf) {
        Ok(report) => println!("{bsdf:?}\n{report}"),
        Err(failure) => panic!("{bsdf:?}\n{failure}"),
    }
}

const TEST: BsdfTest = BsdfTest::new();

fn white() -> BsdfTest {
    TEST.energy(0.99, 1.0001)
}

#[test]
fn lambert() {
    assert_holds(TEST, Lambert { color: vec3(0.2, 0.5, 1.0) });
    assert_holds(white(), Lambert { color: Vec3::ONE });
}

#[test]
fn eon() {
    for roughness in [0.0, 0.3, 1.0] {
        assert_holds(white(), Eon { color: Vec3::ONE, roughness });
    }
    assert_holds(TEST, Eon { color: vec3(0.0, 0.18, 0.8), roughness: 0.7 });
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
    assert_holds(TEST.not_reciprocal(), Conductor::<ComplexIor> { fresnel: gold, alpha: 0.2 });
}

#[test]
fn glass() {
    for alpha in [0.0, 0.01, 0.1, 0.5, 1.0] {
        let least = if alpha < 0.1 { 0.99 } else { 0.4 };
        for ior in [1.5, 1.0 / 1.5] {
            let test = TEST.energy(least, 1.0001).refracting(ior);
            assert_holds(test, Dielectric { ior, alpha, tint: Vec3::ONE });
        }
        assert_holds(white().not_reciprocal(), ThinDielectric { ior: 1.5, alpha, tint: Vec3::ONE });
    }
    assert_holds(TEST.energy(0.99, 1.0001), Dielectric { ior: 1.0, alpha: 0.3, tint: Vec3::ONE });
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
    assert_holds(TEST.not_reciprocal(), lacquer);
}

#[test]
fn cloth() {
    for alpha in [0.07, 0.3, 1.0] {
        assert_holds(TEST, Sheen { color: Vec3::ONE, alpha });
        let sheen = Sheen { color: vec3(1.0, 0.5, 0.2), alpha };
        let cloth = SheenCoated::<Lambert> { base: Lambert { color: Vec3::ONE }, sheen };
        assert_holds(TEST.energy(0.4, 1.0001).not_reciprocal(), cloth);
    }
}

#[test]
fn mixtures() {
    let under = Lambert { color: vec3(0.8, 0.2, 0.2) };
    let over = Mirror { color: vec3(0.9, 0.9, 0.9) };
    for share in [0.0, 0.3, 1.0] {
        assert_holds(TEST, Mix::<Lambert, Mirror> { under, over, share });
    }
}

#[test]
fn metallic_roughness() {
    let plain = MetallicRoughness { base_color: vec3(0.9, 0.5, 0.1), ..Default::default() };
    let test = TEST.not_reciprocal();
    assert_holds(test, MetallicRoughness { roughness: 0.4, ..plain });
    assert_holds(test, MetallicRoughness { metallic: 0.0, roughness: 0.3, ..plain });
    let all = MetallicRoughness {
        metallic: 0.4,
        roughness: 0.6,
        transmission: 0.5,
        clearcoat: 0.7,
        clearcoat_roughness: 0.2,
        sheen_color: vec3(0.2, 0.3, 0.4),
        sheen_roughness: 0.6,
        ..plain
    };
    assert_holds(test, all);
    assert_holds(test, MetallicRoughness { is_solid: true, ior: 1.4, ..all });
    let white = MetallicRoughness { base_color: Vec3::ONE, ..Default::default() };
    assert_holds(test.energy(0.98, 1.0001), MetallicRoughness { metallic: 0.5, ..white });
}
