//! Two lenses on a chequered floor, in a ring of columns.

use raydsl::kernel;
use raydsl::prelude::*;
use raydsl_examples::lens::{Passage, State, Stepper, through};

#[primitive(cylinder(foot, top, radius))]
pub(crate) struct Column {
    pub(crate) foot: Vec3,
    pub(crate) radius: f32,
    pub(crate) top: Vec3,
    pub(crate) color: [Unorm8; 4],
}

#[kernel]
impl Column {
    fn rgb(&self) -> Vec3 {
        vec3(self.color[0].to_f32(), self.color[1].to_f32(), self.color[2].to_f32())
    }
}

/// A ball of radius 1, whose rays an integrator follows.
#[derive(Clone, Copy, Debug, Type)]
pub(crate) struct Lens<S: Stepper> {
    pub(crate) center: Vec3,
    pub(crate) stepper: S,
}

/// A colour of the rainbow, from 0 to 1 around.
pub(crate) fn rainbow(hue: f32) -> Vec3 {
    let channel = |shift: f32| 0.55 + 0.4 * (std::f32::consts::TAU * (hue + shift)).cos();
    vec3(channel(0.0), channel(-0.33), channel(-0.67))
}

/// Columns all around, so that a lens has something to show on all sides.
pub(crate) fn columns() -> Vec<Column> {
    let count = 22u8;
    let column = |i: u8| {
        let share = (f32::from(i) + 0.5) / f32::from(count);
        let (sin, cos) = (std::f32::consts::TAU * share).sin_cos();
        let foot = vec3(11.0 * sin, 0.0, -11.0 * cos);
        let top = foot + Vec3::Y * if i.is_multiple_of(2) { 5.0 } else { 3.4 };
        let color = rainbow(share).extend(1.0).to_array().map(Unorm8::from);
        Column { foot, radius: 0.55, top, color }
    };
    (0..count).map(column).collect()
}

/// What is seen in a direction without columns.
#[kernel]
pub(crate) fn sky(direction: Vec3, sun: Vec3) -> Vec3 {
    let height = clamp(direction.y, 0.0, 1.0).sqrt();
    let air = vec3(0.86, 0.88, 0.90).lerp(vec3(0.16, 0.34, 0.66), height);
    let toward = max(direction.dot(sun), 0.0);
    air + vec3(0.5, 0.42, 0.3) * pow(toward, 24.0) + vec3(2.0, 1.9, 1.6) * pow(toward, 1500.0)
}

/// A chequered floor that fades into its mean, and then into the air.
#[kernel]
pub(crate) fn floor(at: Vec3, far: f32) -> Vec3 {
    let is_dark = (((at.x + 0.5).floor() + at.z.floor()) * 0.5).fract_gl() > 0.25;
    let tile = if is_dark { vec3(0.16, 0.17, 0.20) } else { vec3(0.80, 0.76, 0.70) };
    let mean = vec3(0.48, 0.465, 0.45);
    tile.lerp(mean, clamp(far / 60.0, 0.0, 1.0))
}

/// Which of a list of lenses a ray meets, and where.
#[derive(Clone, Copy, Debug, Type)]
struct Nearest {
    index: u32,
    t: f32,
    is_hit: bool,
}

// ANCHOR: lens
/// A ray's way through a lens: `from` is where it enters. No light is reflected, since the index is
/// 1 at the surface.
#[kernel]
pub(crate) fn behind<S: Stepper>(
    lens: Lens<S>,
    from: Vec3,
    direction: Vec3,
    first: f32,
) -> Passage {
    let stepper: S = lens.stepper;
    let entry = State { at: from - lens.center, momentum: direction };
    let passage = through::<S>(stepper, 1.0, entry, first, 200);
    let end = State { at: passage.end.at + lens.center, momentum: passage.end.momentum };
    Passage { end, ..passage }
}
// ANCHOR_END: lens

#[kernel]
fn nearest<S: Stepper>(lenses: &[Lens<S>], ray: Ray) -> Nearest {
    let mut found = Nearest { index: 0, t: ray.t_max, is_hit: false };
    for (i, lens) in lenses.iter().enumerate() {
        let hit = sphere::intersect(ray, lens.center, 1.0);
        if hit.is_hit && hit.t < found.t {
            found = Nearest { index: i as u32, t: hit.t, is_hit: true };
        }
    }
    found
}

/// The light that a camera ray brings, through up to four lenses.
#[kernel]
pub(crate) fn shade<S: Stepper>(
    columns: &Bvh<Column>,
    lenses: &[Lens<S>],
    sun: Vec3,
    first: f32,
    camera_ray: Ray,
) -> Shaded {
    let mut ray = camera_ray;
    let mut tint = vec3(1.0, 1.0, 1.0);
    let mut color = vec3(0.0, 0.0, 0.0);
    let mut depth = f32::MAX;
    for i in 0..5u32 {
        let hit = columns.closest_hit(ray);
        let t = if hit.is_hit { hit.t } else { ray.t_max };
        let to_floor = -ray.origin.y / ray.direction.y;
        let is_floor = to_floor > ray.t_min && to_floor < t;
        let reach = if is_floor { to_floor } else { t };
        let seen = nearest::<S>(lenses, ray.with_range(ray.t_min, reach));
        if i == 0 {
            depth = seen.t;
        }
        if !seen.is_hit {
            let at = ray.at(reach);
            if is_floor || hit.is_hit {
                let own = if is_floor { floor(at, reach) } else { columns.primitive(hit).rgb() };
                let normal =
                    if is_floor { Vec3::Y } else { columns.primitive(hit).normal(ray, hit) };
                let facing = normal.dot(sun);
                let mut light = 0.5 + 0.1 * normal.y;
                if facing > 0.0 {
                    let shadow = Ray::new(at + normal * 0.002, sun);
                    // What a lens focuses is left out, and so it has a shadow.
                    let is_lit = !columns.any_hit(shadow) && !nearest::<S>(lenses, shadow).is_hit;
                    light += if is_lit { 0.62 * facing } else { 0.0 };
                }
                let air = clamp((reach - 20.0) / 90.0, 0.0, 1.0);
                color = (own * light).lerp(vec3(0.86, 0.88, 0.90), air);
            } else {
                color = sky(ray.direction, sun);
            }
            break;
        }
        let lens: Lens<S> = lenses[seen.index as usize];
        let passage = behind::<S>(lens, ray.at(seen.t), ray.direction, first);
        if !passage.is_out {
            // Given up: a colour that nothing else has.
            color = vec3(1.0, 0.0, 1.0);
            break;
        }
        tint *= vec3(0.95, 0.965, 0.97);
        let direction = normalize(passage.end.momentum);
        ray = Ray::new(passage.end.at, direction).with_range(0.001, camera_ray.t_max);
    }
    Shaded { color: color * tint, depth, id: 0 }
}
