//! Every variant gives the same numbers.

use raydsl::machine::Type as KernelType;
use raydsl::prelude::*;
use raydsl::sampling::{
    invert_bilinear, invert_concentric_disk, invert_cone, invert_power_cosine, invert_table,
    invert_table_2d, invert_triangle, owen_scramble, pcg4d, permuted, philox4x32, radical_inverse,
    scrambled_sobol_1d, scrambled_sobol_2d, sobol_2d, stratified_1d, stratified_2d, unit_f32,
    van_der_corput,
};
use raydsl::{assert_variants_agree, kernel};
use raydsl_tests::check::{Wgsl, every_variant, wgsl_agrees};
use raydsl_tests::rng::Rng as Source;
use raydsl_tests::scaled;
use raydsl_tests::values::compare;

/// Words at the ends of their range, and random ones.
fn words(seed: u64) -> Vec<(u32, u32, u32, u32)> {
    let ends = [0, 1, 2, 0x7fff_ffff, 0x8000_0000, 0xffff_00ff, u32::MAX - 1, u32::MAX];
    let mut rng = Source::new(seed);
    let mut word = |i: usize| if i < 200 { rng.pick(&ends) } else { rng.bits() as u32 };
    (0..scaled(2000) | 1).map(|i| (word(i), word(i), word(i), word(i))).collect()
}

/// Points of the unit square, its edges among them.
fn points(seed: u64) -> Vec<(Vec2, f32, f32)> {
    let ends = [0.0, 5.9604645e-8, 0.25, 0.5, 0.75, 0.49999997, 0.50000006, 0.99999994];
    let mut rng = Source::new(seed);
    let mut unit = |i: usize| if i < 300 { rng.pick(&ends) } else { rng.unit() };
    (0..scaled(2000) | 1).map(|i| (vec2(unit(i), unit(i)), unit(i), unit(i))).collect()
}

#[kernel]
fn hashes(a: u32, b: u32, c: u32, d: u32) -> (UVec4, UVec4, UVec2, u32, u32) {
    let order = permuted(a, b % 5000, c);
    (
        pcg4d(uvec4(a, b, c, d)),
        philox4x32(uvec4(a, b, c, d), uvec2(d, a)),
        sobol_2d(a),
        owen_scramble(b, c),
        order,
    )
}

/// Advances a generator that belongs to another kernel.
#[kernel]
fn walk(rng: &mut Rng, steps: u32) -> f32 {
    let mut sum = 0.0;
    for _ in 0..steps {
        if rng.next_f32() < 0.75 {
            sum += rng.next_3d().z;
        }
    }
    sum
}

#[kernel]
fn draws(a: u32, b: u32, c: u32, d: u32) -> (f32, Vec2, u32, Rng) {
    let mut rng = Rng::new(uvec2(a, b), c, d);
    let sum = walk(&mut rng, c % 7);
    let point = rng.next_2d();
    (sum, point, rng.next_u32(), rng)
}

#[kernel]
fn sequences(a: u32, b: u32, c: u32, d: u32) -> (f32, f32, Vec2, f32, Vec2, f32) {
    let seeds = pcg4d(uvec4(b, c, d, a));
    let (u, v) = (unit_f32(b), unit_f32(c));
    (
        van_der_corput(a),
        radical_inverse(b % 50, a),
        scrambled_sobol_2d(a, seeds),
        scrambled_sobol_1d(a, seeds),
        stratified_2d(a, c % 3000, seeds, vec2(u, v)),
        stratified_1d(a, c % 3000, d, v),
    )
}

#[test]
fn integers_and_sequences() {
    every_variant(&Kernel::of::<hashes>(), &words(1));
    every_variant(&Kernel::of::<draws>(), &words(2));
    every_variant(&Kernel::of::<sequences>(), &words(3));
}

const METHODS: [SampleMethod; 3] =
    [SampleMethod::Random, SampleMethod::Stratified, SampleMethod::Sobol];

/// Asserts that WGSL has the method, and of the others nothing.
fn assert_only(method: SampleMethod, wgsl: &str) {
    // Jitter in strata is random.
    let [random, stratified, sobol] =
        ["fn random_", "fn stratified_", "sobol"].map(|name| wgsl.contains(name));
    assert_eq!(stratified, method == SampleMethod::Stratified, "{wgsl}");
    assert_eq!(sobol, method == SampleMethod::Sobol, "{wgsl}");
    assert_eq!(random, method != SampleMethod::Sobol, "{wgsl}");
    let tests = wgsl.lines().filter(|line| line.contains("method") && line.contains("if ("));
    assert_eq!(tests.count(), 0, "{wgsl}");
}

/// The host knows the method.
#[test]
fn samplers() {
    for method in METHODS {
        let kernel = kernel!(|a: u32, b: u32, c: u32, d: u32| {
            let mut sampler = Sampler::new(uvec2(a, b), d, c % 100, d % 60, method);
            let first = sampler.next_2d();
            let second = sampler.next_1d();
            (first, second, sampler.next_2d(), sampler.dimension)
        });
        every_variant(&kernel, &words(4));
        assert_only(method, &kernel.wgsl());
    }
}

#[kernel]
fn wandered(sampler: &mut Sampler, steps: u32) -> f32 {
    let mut length = 0.0;
    for _ in 0..steps {
        let step = sampler.next_2d();
        if step.x > 0.7 {
            continue;
        }
        length += step.y + sampler.next_1d();
    }
    length
}

/// Numbers drawn in loops within loops, by a sampler made outside, as a path tracer has it.
#[test]
fn samplers_in_loops() {
    for method in METHODS {
        let kernel = kernel!(|a: u32, b: u32, c: u32, d: u32| {
            let mut sampler = Sampler::new(uvec2(a, b), d, c % 100, d % 60, method);
            let mut sum = Vec2::ZERO;
            for i in 0..c % 5 {
                sum += sampler.next_2d();
                let mut copy = sampler;
                while copy.next_1d() < 0.5 {
                    sum.x += copy.next_1d();
                }
                sum.y += wandered(&mut sampler, i);
                if sum.y > 4.0 {
                    break;
                }
            }
            (sum, sampler.dimension)
        });
        assert_variants_agree!(&kernel, &words(4));
        assert_only(method, &kernel.wgsl());
    }
}

/// A kernel may change the method, and may be given samplers of several.
#[test]
fn samplers_of_several_methods() {
    let kernel = kernel!(|a: u32, b: u32, c: u32, d: u32| {
        let mut sampler = Sampler::new(uvec2(a, b), d, c % 100, d % 60, SampleMethod::Sobol);
        let mut sum = Vec2::ZERO;
        for _ in 0..3 {
            sum += sampler.next_2d();
            if sum.x > 0.7 {
                sampler.method = SampleMethod::Random;
            }
        }
        (sum, sampler.next_1d())
    });
    assert_variants_agree!(&kernel, &words(4));
    let wgsl = kernel.wgsl();
    assert!(wgsl.contains("sobol") && wgsl.contains("random_"), "{wgsl}");
    assert!(!wgsl.contains("stratified"), "{wgsl}");
    let given: Vec<(Sampler,)> = (0..300)
        .map(|i| (Sampler::new(uvec2(i, i / 7), 3, i % 16, 16, METHODS[i as usize % 3]),))
        .collect();
    let kernel = kernel!(|sampler: Sampler| {
        let mut sampler = sampler;
        let first = sampler.next_2d();
        (first, sampler.next_1d(), wandered(&mut sampler, 3))
    });
    assert_variants_agree!(&kernel, &given);
    // And a list of samplers of one method has that alone.
    for (i, method) in METHODS.into_iter().enumerate() {
        let of_one: Vec<Sampler> = given.iter().skip(i).step_by(3).map(|g| g.0).collect();
        let list = &of_one[..];
        let kernel = kernel!(|i: u32| {
            let mut sampler = list[i as usize % list.len()];
            wandered(&mut sampler, 4)
        });
        assert_variants_agree!(&kernel, &(0..50).map(|i| (i,)).collect::<Vec<(u32,)>>());
        assert_only(method, &kernel.wgsl());
    }
}

/// Packets give the source's bits, WGSL numbers within so many ulp: a device may order sums and
/// divisions otherwise.
fn agree<A, R>(name: &str, kernel: &Kernel<'_, A, R>, inputs: &[A], ulps: u32)
where
    A: KernelType + std::fmt::Debug + Sync,
    R: KernelType,
{
    let expected: Vec<R> = inputs.iter().map(|a| kernel.call(*a)).collect();
    for variant in [Variant::Packet4, Variant::Packet8, Variant::Packet16] {
        let found = raydsl::testing::run(kernel, variant, inputs);
        compare(variant.name(), &expected, &found).assert_same(|i| format!("{:?}", inputs[i]));
    }
    wgsl_agrees(name, kernel, inputs, &expected, Wgsl::Ulps(ulps));
}

#[kernel]
fn round_warps(u: Vec2, a: f32, b: f32) -> (Vec2, Vec2, Vec3, Vec3, Vec3, Vec3, Vec2) {
    let disk = sample_concentric_disk(u);
    let cone = sample_cone(u, one_minus_cos(a + 1e-3));
    (
        disk,
        invert_concentric_disk(disk),
        sample_cosine_hemisphere(u),
        sample_uniform_hemisphere(u),
        sample_uniform_sphere(u),
        cone,
        invert_cone(cone, one_minus_cos(b + 1e-3)),
    )
}

#[kernel]
fn other_warps(u: Vec2, a: f32, b: f32) -> (Vec3, Vec2, f32, Vec2, Vec2, f32, Vec2, Vec2) {
    let lobe = sample_power_cosine(u, 100.0 * a);
    let weights = vec4(a, b, 1.0, a * b);
    let bent = sample_bilinear(u, weights);
    let corners = sample_triangle(u);
    (
        lobe,
        invert_power_cosine(lobe, 100.0 * a),
        power_cosine_pdf(b, 20.0 * a),
        bent,
        invert_bilinear(bent, weights),
        bilinear_pdf(vec2(a, b), weights),
        corners,
        invert_triangle(corners),
    )
}

#[kernel]
fn framed(u: Vec2, a: f32, b: f32) -> (Frame, Vec3, Vec3, f32, f32, f32) {
    let z = sample_uniform_sphere(u);
    let frame = Frame::around(z);
    let local = vec3(a, b, 0.5);
    let (v0, v1, v2) = (vec3(-1.0, 0.0, 0.0), vec3(1.0 + a, 0.0, 0.0), vec3(0.0, 1.0 + b, 0.0));
    (
        frame,
        frame.to_world(local),
        frame.to_local(local),
        balance_heuristic(1.0, a, 2.0, b),
        power_heuristic(1.0, a, 2.0, b),
        solid_angle_pdf(1.0 / triangle::area(v0, v1, v2), local, z.abs()),
    )
}

#[test]
fn warps() {
    agree("round warps", &Kernel::of::<round_warps>(), &points(5), 4);
    agree("other warps", &Kernel::of::<other_warps>(), &points(6), 4);
    agree("frames", &Kernel::of::<framed>(), &points(7), 4);
}

/// -0 counts as 0: a device may lose its sign.
#[test]
fn frames_of_zeros() {
    #[kernel]
    fn frame(z: Vec3) -> Frame {
        Frame::around(z)
    }
    let zeros = [0.0, -0.0, 1.0, -1.0];
    let normals = zeros.iter().flat_map(|x| zeros.iter().map(move |y| (*x, *y)));
    let normals = normals.flat_map(|(x, y)| zeros.iter().map(move |z| (vec3(x, y, *z),)));
    let normals: Vec<(Vec3,)> = normals.collect();
    every_variant(&Kernel::of::<frame>(), &normals);
    assert_eq!(Frame::around(vec3(1.0, 0.0, -0.0)), Frame::around(vec3(1.0, 0.0, 0.0)));
    let nothing = Frame::around(Vec3::ZERO);
    assert_eq!((nothing.x, nothing.y), (Vec3::X, Vec3::Y));
}

#[test]
fn tables() -> Result<(), Box<dyn std::error::Error>> {
    let mut rng = Source::new(8);
    let weights: Vec<f32> =
        (0..37 * 11).map(|i| if i % 5 == 0 { 0.0 } else { rng.unit() * 3.0 }).collect();
    let line = Distribution1d::new(&weights)?;
    let square = Distribution2d::new(&weights, uvec2(37, 11))?;
    let (line, table, size) = (line.cdf(), square.cdf(), square.size());
    let kernel = kernel!(|u: Vec2, a: f32, b: f32| {
        let first = sample_table(a, line);
        let second = sample_table_2d(u, table, size);
        let point = vec2(a, b);
        (
            first,
            second,
            table_pdf(b, line),
            invert_table(b, line),
            table_2d_pdf(point, table, size),
            invert_table_2d(point, table, size),
        )
    });
    every_variant(&kernel, &points(9));
    Ok(())
}
