//! Choosing lights by a tree: probabilities, frequencies, and how much noise is left.

use std::time::Instant;

use raydsl::assert_variants_agree;
use raydsl::geometry::Aabb;
use raydsl::light::{
    AnyLight, AreaLight, DirectionalLight, DiskShape, Environment, Light, LightChoice, LightSample,
    Lights, LightsError, PointLight, RectangleShape, SphereShape, SpotLight, luminance,
};
use raydsl::prelude::*;
use raydsl::testing::{can_run, run};
use raydsl_tests::rng::Rng;

const HALL: Vec3 = vec3(100.0, 10.0, 100.0);

fn bounds() -> Aabb {
    Aabb { min: Vec3::ZERO, max: HALL }
}

fn point_in(random: &mut Rng, size: Vec3) -> Vec3 {
    vec3(random.unit(), random.unit(), random.unit()) * size
}

fn direction_in(random: &mut Rng) -> Vec3 {
    random.direction().normalize()
}

fn small_triangle(random: &mut Rng) -> AreaLight<Triangle> {
    let v0 = point_in(random, HALL);
    let v1 = v0 + direction_in(random) * 0.05;
    let v2 = v0 + direction_in(random) * 0.05;
    let radiance = vec3(1.0, 0.8, 0.5) * 10f32.powf(random.range(0.0, 2.0));
    AreaLight { shape: Triangle { v0, v1, v2 }, radiance, is_two_sided: false }
}

fn triangles(count: usize, name: &str) -> Vec<AreaLight<Triangle>> {
    let mut random = Rng::of(name);
    (0..count).map(|_| small_triangle(&mut random)).collect()
}

/// Of every kind, some black and some far away.
fn mixed(count: usize, name: &str) -> Vec<AnyLight> {
    let mut random = Rng::of(name);
    let mut of_kind = |i: usize| {
        let random = &mut random;
        let (position, direction) = (point_in(random, HALL), direction_in(random));
        let bright = vec3(1.0, 2.0, 0.5) * 10f32.powf(random.range(-1.0, 1.0));
        let light = if i % 31 == 5 { Vec3::ZERO } else { bright };
        let is_two_sided = i.is_multiple_of(2);
        match i % 8 {
            0 => AnyLight::Point(PointLight { position, intensity: light }),
            1 | 2 => {
                let cos_outer = random.range(-0.9, 0.9);
                let cos_inner = cos_outer + 0.1 * random.unit();
                let intensity = light;
                AnyLight::Spot(SpotLight { position, intensity, direction, cos_inner, cos_outer })
            }
            3 if i % 16 == 3 => {
                let (irradiance, sine) = (light * 1e-4, random.range(0.0, 0.1));
                AnyLight::Directional(DirectionalLight { direction, irradiance, sine })
            }
            3 | 4 => {
                let shape = SphereShape { center: position, radius: random.range(0.01, 1.0) };
                AnyLight::Sphere(AreaLight { shape, radiance: light, is_two_sided: false })
            }
            5 => {
                let (u_edge, v_edge) = (direction, direction_in(random) * 2.0);
                let shape = RectangleShape { corner: position, u_edge, v_edge };
                AnyLight::Rectangle(AreaLight { shape, radiance: light, is_two_sided })
            }
            6 => {
                let (v1, v2) = (position + direction, position + direction_in(random));
                let shape = Triangle { v0: position, v1, v2 };
                AnyLight::Triangle(AreaLight { shape, radiance: light, is_two_sided })
            }
            _ => {
                let shape = DiskShape { center: position, normal: direction, radius: 0.3 };
                AnyLight::Disk(AreaLight { shape, radiance: light, is_two_sided })
            }
        }
    };
    (0..count).map(&mut of_kind).collect()
}

fn receiver(random: &mut Rng) -> SurfacePoint {
    let position = point_in(random, HALL);
    SurfacePoint { position, normal: direction_in(random), error: 1e-6 }
}

fn with_tree<L: Light + Type>(list: &[L]) -> Lights<'_, L> {
    Lights::new(list, bounds()).expect("powers").with_tree().expect("extents")
}

#[test]
fn probabilities_add_up_to_1() {
    let mut random = Rng::of("probabilities");
    for count in [1, 2, 3, 40, 3000] {
        let list = mixed(count, "of any kind");
        let lights = with_tree(&list);
        for _ in 0..40 {
            let at = receiver(&mut random);
            let sum: f64 = (0..count as u32).map(|i| f64::from(lights.chance(i, at))).sum();
            assert!((sum - 1.0).abs() < 1e-5, "{count} lights: {sum}");
        }
    }
}

/// Over a grid of numbers each light is chosen as often as its probability says, up to a cell or two,
/// and with that probability, to the bit.
#[test]
fn frequencies_are_probabilities() {
    let list = mixed(300, "of any kind");
    let lights = with_tree(&list);
    let mut random = Rng::of("frequencies");
    const CELLS: u32 = 1 << 18;
    for _ in 0..5 {
        let at = receiver(&mut random);
        let mut counts = vec![0u32; list.len()];
        for k in 0..CELLS {
            let LightChoice { light, chance } = lights.choose(at, (k as f32 + 0.5) / CELLS as f32);
            counts[light as usize] += 1;
            if k % 64 == 0 {
                assert_eq!(chance, lights.chance(light, at));
            }
        }
        for (i, count) in counts.into_iter().enumerate() {
            let chance = lights.chance(i as u32, at);
            let difference = count as f32 - chance * CELLS as f32;
            assert!(difference.abs() < 4.5, "light {i}: {count} times, {chance}");
        }
    }
}

/// Where light arrives from a light there is a chance of choosing it, no less than a share of that by
/// power.
#[test]
fn a_light_that_is_seen_has_a_chance() {
    let mut random = Rng::of("seen");
    let list = mixed(500, "of any kind");
    let lights = with_tree(&list);
    let by_power = Lights::new(&list, bounds()).expect("powers");
    let mut seen = 0;
    for _ in 0..200 {
        let at = receiver(&mut random);
        for i in 0..list.len() as u32 {
            let u = vec2(random.unit(), random.unit());
            let chance = lights.chance(i, at);
            if lights.sample_light(i, at, u).light != Vec3::ZERO {
                seen += 1;
                assert!(chance >= 0.06 * by_power.chance(i, at) && chance > 0.0, "light {i}");
            }
            let is_black = list[i as usize].power(1.0) == 0.0;
            assert_eq!(chance == 0.0, is_black, "light {i} from {at:?}");
        }
    }
    assert!(seen > 10_000, "{seen}");
}

/// Returns the irradiance that a sample stands for.
fn irradiance(sample: LightSample, at: SurfacePoint) -> f64 {
    let cos = f64::from(sample.wi.dot(at.normal).max(0.0));
    if sample.pdf > 0.0 {
        f64::from(luminance(sample.light)) * cos / f64::from(sample.pdf)
    } else {
        0.0
    }
}

/// Returns the irradiance by all lights, and the variances of its estimates by one sample, by power
/// and by the tree. Each light is sampled in its middle: there is no other noise than that of the
/// choice.
fn variances<L: Light + Type>(list: &[L], at: SurfacePoint) -> (f64, f64, f64) {
    let (by_power, by_tree) = (Lights::new(list, bounds()).expect("powers"), with_tree(list));
    let (mut sum, mut of_power, mut of_tree) = (0.0, 0.0, 0.0);
    for i in 0..list.len() as u32 {
        let own = irradiance(by_tree.sample_light(i, at, Vec2::splat(0.5)), at);
        if own > 0.0 {
            sum += own;
            of_power += own * own / f64::from(by_power.chance(i, at));
            of_tree += own * own / f64::from(by_tree.chance(i, at));
        }
    }
    (sum, of_power - sum * sum, of_tree - sum * sum)
}

#[test]
fn estimates_are_the_sum_with_less_noise() {
    let list = triangles(10_000, "hall");
    let lights = with_tree(&list);
    let mut random = Rng::of("estimates");
    let mut ratios = Vec::new();
    for k in 0..8 {
        // On the floor, and in the middle of the room.
        let mut at = receiver(&mut random);
        if k % 2 == 0 {
            at =
                SurfacePoint { position: at.position * vec3(1.0, 0.0, 1.0), normal: Vec3::Y, ..at };
        }
        let (sum, by_power, by_tree) = variances(&list, at);
        ratios.push(by_power / by_tree);
        let count = 20_000;
        let mut next = || {
            let u = vec3(0.5, 0.5, random.unit());
            irradiance(lights.sample(at, u), at)
        };
        let mean = (0..count).map(|_| next()).sum::<f64>() / f64::from(count);
        let deviation = (by_tree / f64::from(count)).sqrt();
        assert!((mean - sum).abs() < 4.0 * deviation, "{mean} and not {sum}, off by {deviation}");
        let of = |variance: f64| variance.sqrt() / sum;
        println!(
            "relative deviation {:.2} by power, {:.2} by the tree: variance {:.1} times lower",
            of(by_power),
            of(by_tree),
            by_power / by_tree
        );
    }
    let mean = (ratios.iter().map(|r| r.ln()).sum::<f64>() / ratios.len() as f64).exp();
    println!("geometric mean {mean:.1}");
    assert!(mean > 5.0, "{ratios:?}");
}

#[test]
fn many_lights_are_built_quickly() {
    let list = triangles(100_000, "many");
    let start = Instant::now();
    let lights = with_tree(&list);
    let seconds = start.elapsed().as_secs_f64();
    println!("100000 lights: {seconds:.2} s");
    assert!(seconds < 60.0, "{seconds} s");
    let at = receiver(&mut Rng::of("many lights"));
    let sum: f64 = (0..100_000).map(|i| f64::from(lights.chance(i, at))).sum();
    assert!((sum - 1.0).abs() < 1e-5, "{sum}");
}

#[test]
fn lights_that_coincide_share() {
    let lamp = PointLight { position: vec3(1.0, 2.0, 3.0), intensity: Vec3::ONE };
    let list = [lamp; 77];
    let lights = with_tree(&list);
    let at = SurfacePoint { position: Vec3::ZERO, normal: Vec3::Z, error: 0.0 };
    // Next to them, on them, and so far away that nothing is left.
    for position in [Vec3::ZERO, lamp.position, Vec3::splat(1e30), Vec3::splat(f32::MAX)] {
        for i in 0..77 {
            let chance = lights.chance(i, SurfacePoint { position, ..at });
            assert!((chance * 77.0 - 1.0).abs() < 1e-5, "{chance}");
        }
    }
}

#[test]
fn few_lights_need_no_tree() {
    let at = SurfacePoint { position: Vec3::ZERO, normal: Vec3::Z, error: 0.0 };
    let none: [PointLight; 0] = [];
    assert_eq!(with_tree(&none).choose(at, 0.5).chance, 0.0);
    let lamp = PointLight { position: Vec3::ONE, intensity: Vec3::ZERO };
    assert_eq!(with_tree(&[lamp; 4]).chance(2, at), 0.25);
    let one = [PointLight { intensity: Vec3::ONE, ..lamp }];
    let lights = with_tree(&one);
    assert_eq!((lights.chance(0, at), lights.choose(at, 0.99).light), (1.0, 0));
    let suns = [DirectionalLight { direction: Vec3::X, irradiance: Vec3::ONE, sine: 0.0 }; 2];
    assert_eq!(with_tree(&suns).chance(1, at), 0.5);
    let error = |position| {
        let list = [one[0], PointLight { position, ..one[0] }];
        Lights::new(&list, bounds()).expect("powers").with_tree().err()
    };
    assert_eq!(error(vec3(f32::NAN, 0.0, 0.0)), Some(LightsError::NotFinite(1)));
    assert_eq!(error(vec3(f32::INFINITY, 0.0, 0.0)), Some(LightsError::NotFinite(1)));
    assert_eq!(error(Vec3::ZERO), None);
}

/// The environment and distant lights keep their shares.
#[test]
fn what_is_far_away_is_outside_of_the_tree() {
    let list = mixed(200, "of any kind");
    let sky = Environment::constant(Vec3::splat(0.01)).expect("radiance");
    let plain = Lights::new(&list, bounds()).expect("powers").with_environment(&sky);
    let before = with_tree(&list).with_environment(&sky);
    let after = Lights::new(&list, bounds()).expect("powers").with_environment(&sky);
    let after = after.with_tree().expect("extents");
    let mut random = Rng::of("far away");
    let mut of_the_sky = 0;
    for _ in 0..2000 {
        let at = receiver(&mut random);
        let u = point_in(&mut random, Vec3::ONE);
        assert_eq!(before.sample(at, u), after.sample(at, u));
        of_the_sky += u32::from(plain.sample(at, u) == after.sample(at, u));
        for (i, light) in (0..).zip(&list).filter(|(_, l)| l.is_distant()) {
            let ratio = plain.chance(i, at) / after.chance(i, at);
            assert!((ratio - 1.0).abs() < 1e-3 || light.power(1.0) == 0.0, "{ratio}");
        }
    }
    assert!(of_the_sky > 150);
}

#[test]
fn every_variant_agrees() {
    let list = mixed(150, "of any kind");
    let sky = Environment::constant(Vec3::splat(0.01)).expect("radiance");
    let lights = with_tree(&list).with_environment(&sky);
    let mut random = Rng::of("variants");
    let mut inputs = Vec::new();
    for _ in 0..1000 {
        let at = receiver(&mut random);
        inputs.push((at, point_in(&mut random, Vec3::ONE)));
    }
    let choose = kernel!(|at: SurfacePoint, u: Vec3| lights.choose(at, u.x));
    assert_variants_agree!(&choose, &inputs);
    let chance = kernel!(|at: SurfacePoint, u: Vec3| lights.chance((u.x * 150.0) as u32, at));
    assert_variants_agree!(&chance, &inputs);
    let emitted = kernel!(|at: SurfacePoint, u: Vec3| {
        let i = (u.x * 150.0) as u32;
        let seen = SurfacePoint { position: u, normal: Vec3::Y, error: 0.0 };
        lights.emitted(i, seen, at, Vec3::X, u.y).x
    });
    // Rounding leaves too many decisions open for an explanation: nearly all results are close.
    let expected = run(&emitted, Variant::Scalar, &inputs);
    for variant in [Variant::Packet4, Variant::Packet8, Variant::Packet16] {
        assert_eq!(run(&emitted, variant, &inputs), expected, "{variant:?}");
    }
    if can_run(Variant::Wgsl, "emitted") {
        let found = run(&emitted, Variant::Wgsl, &inputs);
        let is_far = |(a, b): &(&f32, &f32)| (*a - *b).abs() > 1e-3 * (a.abs() + 1e-3);
        let far = expected.iter().zip(&found).filter(is_far).count();
        assert!(far < inputs.len() / 50, "{far} of {}", inputs.len());
    }
}

#[test]
fn without_a_tree_there_is_no_trace_of_it() {
    let list = triangles(20, "few");
    let at = SurfacePoint { position: Vec3::ZERO, normal: Vec3::Y, error: 0.0 };
    let of = |lights: &Lights<'_, AreaLight<Triangle>>| {
        kernel!(|u: Vec3| lights.sample(at, u)).wgsl().to_string()
    };
    let plain = of(&Lights::new(&list, bounds()).expect("powers"));
    assert!(!plain.contains("tree") && !plain.contains("table_share"), "{plain}");
    assert!(of(&with_tree(&list)).contains("lights_tree"));
}

/// Not run by itself: what a choice costs.
#[test]
#[ignore = "measures time"]
fn cost() {
    let list = triangles(10_000, "hall");
    let (by_power, by_tree) = (Lights::new(&list, bounds()).expect("powers"), with_tree(&list));
    let mut random = Rng::of("cost");
    let mut inputs = Vec::new();
    for _ in 0..1 << 16 {
        inputs.push((receiver(&mut random), random.unit()));
    }
    let mut found = vec![LightChoice::default(); inputs.len()];
    for variant in [Variant::Scalar, Variant::Packet4, Variant::Packet8, Variant::Packet16] {
        let mut time = |lights: &Lights<'_, AreaLight<Triangle>>| {
            let kernel = kernel!(|at: SurfacePoint, u: f32| lights.choose(at, u));
            let mut best = f64::INFINITY;
            for _ in 0..5 {
                let start = Instant::now();
                kernel.run(variant, &inputs, &mut found);
                best = best.min(start.elapsed().as_secs_f64());
            }
            best / inputs.len() as f64 * 1e9
        };
        println!(
            "{variant:?}: {:.0} ns by power, {:.0} ns by the tree",
            time(&by_power),
            time(&by_tree)
        );
    }
}
