//! Geometry in a volume: a surface is dimmed by exactly what is in front of it.

use raydsl::machine::Type;
use raydsl::prelude::*;
use raydsl::testing;
use raydsl::volume::{Cut, ExactCell, Grid, GridConfig, TransferFunction, Volume, VolumeLight};

use super::Ball;

/// A box of smoke, 8 units wide around the origin, that has this extinction at value 1.
fn config() -> GridConfig {
    GridConfig::new().origin(Vec3::splat(-4.0))
}

const SIZE: UVec3 = uvec3(9, 9, 9);

fn smoke(extinction: f32) -> TransferFunction {
    let knots = [(0.0, 0.0), (1.0, extinction)];
    TransferFunction::from_extinction(&[(0.0, SMOKE)], &knots).expect("a function")
}

const SMOKE: Vec3 = vec3(0.25, 0.5, 1.0);
const SURFACE: Vec3 = vec3(1.0, 0.125, 0.0);
const SKY: Vec3 = vec3(0.0, 0.0, 0.0625);

/// Rays towards the origin, on all sides; some begin in the smoke, some miss the ball.
fn rays() -> Vec<(Ray,)> {
    let mut rng = raydsl_tests::rng::Rng::of("order");
    let ray = |i| {
        let direction = rng.direction().normalize();
        let aside = rng.point(if i % 4 == 0 { 6.0 } else { 1.0 });
        let distance = if i % 3 == 0 { 2.5 } else { 9.0 };
        (Ray::new(aside - direction * distance, direction),)
    };
    (0..400).map(ray).collect()
}

/// Where a ray is inside of a ball.
fn inside(ball: &Ball, ray: Ray) -> Option<(f64, f64)> {
    let (to, d) = ((ball.center - ray.origin).as_dvec3(), ray.direction.as_dvec3());
    let (a, b) = (d.dot(d), to.dot(d));
    let root = b * b - a * (to.dot(to) - f64::from(ball.radius).powi(2));
    let ends = (root > 0.0).then(|| ((b - root.sqrt()) / a, (b + root.sqrt()) / a))?;
    (ends.1 > 0.0).then_some((ends.0.max(0.0), ends.1))
}

/// Where a ray is inside of the box of smoke.
fn in_smoke(ray: Ray) -> (f64, f64) {
    let (o, d) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let (a, b) = ((-4.0 - o) / d, (4.0 - o) / d);
    (a.min(b).max_element().max(0.0), a.max(b).min_element())
}

/// What is seen: all that the smoke in front of the ball dims and adds, less what is cut away.
fn expected(ball: &Ball, cut: Option<&Ball>, extinction: f64, ray: Ray) -> Vec4 {
    // From within a ball its far side is seen.
    let hit = inside(ball, ray).map(|(enter, leave)| if enter > 0.0 { enter } else { leave });
    let (from, to) = in_smoke(ray);
    let to = hit.map_or(to, |hit| to.min(hit));
    let hidden = cut
        .and_then(|cut| inside(cut, ray))
        .map_or(0.0, |(a, b)| (b.min(to) - a.max(from)).max(0.0));
    let transmitted = (-extinction * ((to - from).max(0.0) - hidden)).exp() as f32;
    let behind = if hit.is_some() { SURFACE } else { SKY };
    (SMOKE + (behind - SMOKE) * transmitted).extend(transmitted)
}

#[track_caller]
fn check<A: Type + Copy>(kernel: &Kernel<'_, A, Vec4>, inputs: &[A], expected: &[Vec4]) {
    for variant in Variant::ALL {
        if !testing::can_run(variant, "order") {
            continue;
        }
        let found = testing::run(kernel, variant, inputs);
        for (i, (a, b)) in found.iter().zip(expected).enumerate() {
            let off = (*a - *b).abs().max_element();
            assert!(off < 1e-4, "{}, ray {i}: {a}, not {b}", variant.name());
        }
    }
}

/// Leaves out rays whose picture rounding decides: those along the rim of a ball.
fn is_clear(balls: &[&Ball], ray: Ray) -> bool {
    balls.iter().all(|ball| {
        let to = ball.center - ray.origin;
        (to.cross(ray.direction).length() - ball.radius).abs() > 1e-3
            && (to.length() - ball.radius).abs() > 1e-3
    })
}

#[test]
fn smoke_dims_what_is_in_it() {
    let half = vec![0.5f32; SIZE.element_product() as usize];
    let thick = vec![0.75f32; half.len()];
    let grid = |v| Grid::new(v, SIZE, config()).expect("a small grid");
    let (half, thick) = (grid(&half[..]), grid(&thick[..]));
    // Constant too, between the two: 0.6 times 0.5.
    let now = Grid::between(&half, &thick, 0.4).expect("steps that match");
    let volume = Volume::new(&now, smoke(0.5));
    let balls = vec![Ball { center: vec3(0.3, -0.2, 0.1), radius: 1.5 }];
    let cuts = [Ball { center: vec3(-0.5, 0.5, 1.0), radius: 2.75 }];
    let bvh = Bvh::build(&balls).expect("a tree");
    let exact = ExactCell::new().least(0.0);

    let inputs = rays();
    let inputs: Vec<(Ray,)> =
        inputs.into_iter().filter(|(ray,)| is_clear(&[&balls[0], &cuts[0]], *ray)).collect();
    assert!(inputs.len() > 350, "{} rays", inputs.len());

    let whole = kernel!(|ray: Ray| {
        let hit = bvh.closest_hit(ray);
        let end = if hit.is_hit { hit.t } else { ray.t_max };
        let front = ray.with_range(ray.t_min, end);
        let light = volume.integrate(&exact, front, VolumeLight::new());
        let color = light.over(if hit.is_hit { SURFACE } else { SKY });
        vec4(color.x, color.y, color.z, 1.0 - light.opacity())
    });
    let found: Vec<Vec4> =
        inputs.iter().map(|(ray,)| expected(&balls[0], None, 0.3, *ray)).collect();
    check(&whole, &inputs, &found);

    let scene = &cuts[..];
    let cut = kernel!(|ray: Ray| {
        let hit = bvh.closest_hit(ray);
        let end = if hit.is_hit { hit.t } else { ray.t_max };
        let mut light = VolumeLight::new();
        let mut walk = Cut::new(scene, ray.with_range(ray.t_min, end));
        while let Some(part) = walk.next_outside(scene) {
            light = volume.integrate(&exact, part, light);
        }
        let color = light.over(if hit.is_hit { SURFACE } else { SKY });
        vec4(color.x, color.y, color.z, 1.0 - light.opacity())
    });
    let found: Vec<Vec4> =
        inputs.iter().map(|(ray,)| expected(&balls[0], Some(&cuts[0]), 0.3, *ray)).collect();
    let dimmer = found
        .iter()
        .zip(&inputs)
        .filter(|(v, (ray,))| v.w > expected(&balls[0], None, 0.3, *ray).w + 1e-3);
    assert!(dimmer.count() > 100, "the cut takes away smoke in front of the ball");
    check(&cut, &inputs, &found);
}
