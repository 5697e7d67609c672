//! Four panes with a flower on each, on a tiled floor.

use raydsl::kernel;
use raydsl::prelude::*;

/// Red, green, blue and opacity.
pub(crate) type Rgba8 = [Unorm8; 4];

/// A pane with a picture on it.
#[primitive(rectangle(corner, right, up))]
pub(crate) struct Pane {
    corner: Vec3,
    right: Vec3,
    up: Vec3,
    /// Which filter reads its picture.
    filter: u32,
}

/// Four panes beside each other.
pub(crate) fn panes() -> Vec<Pane> {
    let pane = |filter: u32| {
        let corner = vec3(filter as f32 * 1.3 - 2.55, 0.0, 0.0);
        Pane { corner, right: vec3(1.2, 0.0, 0.0), up: vec3(0.0, 1.2, 0.0), filter }
    };
    (0..4).map(pane).collect()
}

/// A flower of 16 by 16 texels: five petals and a heart, nothing around them.
pub(crate) fn flower() -> Vec<Rgba8> {
    let texel = |i: u32| {
        let (x, y) = ((i % 16) as f32 - 7.5, (i / 16) as f32 - 7.5);
        let (radius, angle) = (x.hypot(y), x.atan2(-y));
        let petals = 5.2 + 2.0 * (5.0 * angle).cos();
        let color = match radius {
            r if r > petals => [214, 60, 110, 0],
            r if r < 2.0 => [250, 205, 60, 255],
            r if r > petals - 1.3 => [240, 130, 170, 255],
            _ => [200, 30, 80, 255],
        };
        color.map(Unorm8::from_bits)
    };
    (0..256).map(texel).collect()
}

/// A floor of two kinds of tiles.
pub(crate) fn tiles() -> Vec<Rgba8> {
    let texel = |i: u32| {
        let (x, y) = (i % 32, i / 32);
        let color = match (x / 16 + y / 16) % 2 {
            _ if x % 16 == 0 || y % 16 == 0 => [70, 68, 66, 255],
            0 => [205, 200, 190, 255],
            _ => [120, 135, 145, 255],
        };
        color.map(Unorm8::from_bits)
    };
    (0..1024).map(texel).collect()
}

// ANCHOR: painted
/// The colour and opacity of a pane where it was hit, read by its filter.
#[kernel]
fn painted(
    nearest: &TextureRef2<'_, Rgba8>,
    linear: &TextureRef2<'_, Rgba8>,
    spline: &TextureRef2<'_, Rgba8>,
    catmull_rom: &TextureRef2<'_, Rgba8>,
    pane: Pane,
    hit: Hit,
) -> Vec4 {
    // Row 0 of the picture is its top one.
    let uv = vec2(hit.u, 1.0 - hit.v);
    match pane.filter {
        0 => tex2(nearest, uv),
        1 => tex2(linear, uv),
        2 => tex2(spline, uv),
        _ => tex2(catmull_rom, uv),
    }
}
// ANCHOR_END: painted

// ANCHOR: floor
/// The floor, seen from a distance `t` along `ray`: of the level whose texels are as large as what
/// a pixel sees of them.
#[kernel]
fn floor_at(floor: &Texture2<'_, Rgba8>, ray: Ray, t: f32) -> Vec3 {
    let at = ray.at(t) * 0.5;
    // Half a milliradian a ray, and the floor is 16 texels to a unit of length.
    let width = 0.0005 * t / ray.direction.y.abs() * 16.0;
    tex2_level(floor, vec2(at.x, at.z), log2(width)).truncate()
}
// ANCHOR_END: floor

/// The light along `ray`.
#[kernel]
#[expect(clippy::too_many_arguments, reason = "a texture for each filter is the point")]
pub(crate) fn shade(
    panes: &Bvh<'_, Pane>,
    nearest: &TextureRef2<'_, Rgba8>,
    linear: &TextureRef2<'_, Rgba8>,
    spline: &TextureRef2<'_, Rgba8>,
    catmull_rom: &TextureRef2<'_, Rgba8>,
    floor: &Texture2<'_, Rgba8>,
    sun: Vec3,
    ray: Ray,
) -> Shaded {
    // ANCHOR: mask
    let hit = panes.closest_hit_where(ray, |hit: Hit| {
        painted(nearest, linear, spline, catmull_rom, panes.primitive(hit), hit).w > 0.5
    });
    // ANCHOR_END: mask
    let mut color = vec3(0.62, 0.74, 0.88);
    let mut t = hit.t;
    if hit.is_hit {
        let seen = painted(nearest, linear, spline, catmull_rom, panes.primitive(hit), hit);
        color = seen.truncate();
    } else if ray.direction.y < 0.0 {
        t = -ray.origin.y / ray.direction.y;
        let towards_sun = Ray::new(ray.at(t), sun).with_range(0.001, 100.0);
        let is_dark = panes.any_hit_where(towards_sun, |hit: Hit| {
            painted(nearest, linear, spline, catmull_rom, panes.primitive(hit), hit).w > 0.5
        });
        let light = if is_dark { 0.35 } else { 1.0 };
        color = floor_at(floor, ray, t) * light;
    }
    let shown = vec3(linear_to_srgb(color.x), linear_to_srgb(color.y), linear_to_srgb(color.z));
    Shaded { color: shown, depth: t, id: hit.prim_id }
}
