//! The Cornell box, from its measured data.
//!
//! Positions in millimetres and reflectances are those that the Program of Computer Graphics of
//! Cornell University measured (Goral, Torrance, Greenberg and Battaile, "Modeling the Interaction
//! of Light Between Diffuse Surfaces", SIGGRAPH 1984; "The Cornell Box", data of 1998). Its spectra
//! are given here as linear red, green and blue of sRGB's primaries.

use raydsl::bsdf::{Lambert, Luminous, NO_LIGHT};
use raydsl::kernel;
use raydsl::light::AreaLight;
use raydsl::prelude::*;
use raydsl::shading::Surface;

/// A triangle of one colour, which may be a light.
#[primitive(triangle(v0, v1, v2))]
pub struct Wall {
    /// A corner.
    pub v0: Vec3,
    /// The second corner.
    pub v1: Vec3,
    /// The third corner.
    pub v2: Vec3,
    /// Reflectance.
    pub color: Vec3,
    /// Number of the light that it is, or [`NO_LIGHT`].
    pub light: u32,
}

#[kernel]
impl Surface for Wall {
    fn surface(&self, ray: Ray, hit: Hit) -> SurfacePoint {
        self.surface_point(ray, hit)
    }

    fn albedo(&self, _ray: Ray, _hit: Hit) -> Vec3 {
        self.color
    }
}

#[kernel]
impl Wall {
    /// Its material.
    pub fn material(&self) -> Luminous<Lambert> {
        Luminous::<Lambert> { bsdf: Lambert { color: self.color }, light: self.light }
    }
}

const WHITE: Vec3 = Vec3::new(0.885_809, 0.698_859, 0.666_422);
const RED: Vec3 = Vec3::new(0.570_068, 0.043_013_5, 0.044_370_6);
const GREEN: Vec3 = Vec3::new(0.105_421, 0.377_98, 0.076_425);
/// Reflectance of the lamp.
const GREY: Vec3 = Vec3::splat(0.78);

/// Radiance of the lamp.
pub const LAMP: Vec3 = Vec3::new(18.387, 13.9873, 6.753_57);

/// Quadrilaterals: four corners, and the reflectance. The first one is the lamp, which hangs a
/// millimetre below the ceiling.
const QUADS: [([[f32; 3]; 4], Vec3); 16] = [
    (
        [
            [343.0, 547.8, 227.0],
            [343.0, 547.8, 332.0],
            [213.0, 547.8, 332.0],
            [213.0, 547.8, 227.0],
        ],
        GREY,
    ),
    ([[552.8, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 559.2], [549.6, 0.0, 559.2]], WHITE),
    ([[556.0, 548.8, 0.0], [556.0, 548.8, 559.2], [0.0, 548.8, 559.2], [0.0, 548.8, 0.0]], WHITE),
    ([[549.6, 0.0, 559.2], [0.0, 0.0, 559.2], [0.0, 548.8, 559.2], [556.0, 548.8, 559.2]], WHITE),
    ([[0.0, 0.0, 559.2], [0.0, 0.0, 0.0], [0.0, 548.8, 0.0], [0.0, 548.8, 559.2]], GREEN),
    ([[552.8, 0.0, 0.0], [549.6, 0.0, 559.2], [556.0, 548.8, 559.2], [556.0, 548.8, 0.0]], RED),
    (
        [[130.0, 165.0, 65.0], [82.0, 165.0, 225.0], [240.0, 165.0, 272.0], [290.0, 165.0, 114.0]],
        WHITE,
    ),
    (
        [[290.0, 0.0, 114.0], [290.0, 165.0, 114.0], [240.0, 165.0, 272.0], [240.0, 0.0, 272.0]],
        WHITE,
    ),
    ([[130.0, 0.0, 65.0], [130.0, 165.0, 65.0], [290.0, 165.0, 114.0], [290.0, 0.0, 114.0]], WHITE),
    ([[82.0, 0.0, 225.0], [82.0, 165.0, 225.0], [130.0, 165.0, 65.0], [130.0, 0.0, 65.0]], WHITE),
    ([[240.0, 0.0, 272.0], [240.0, 165.0, 272.0], [82.0, 165.0, 225.0], [82.0, 0.0, 225.0]], WHITE),
    (
        [
            [423.0, 330.0, 247.0],
            [265.0, 330.0, 296.0],
            [314.0, 330.0, 456.0],
            [472.0, 330.0, 406.0],
        ],
        WHITE,
    ),
    (
        [[423.0, 0.0, 247.0], [423.0, 330.0, 247.0], [472.0, 330.0, 406.0], [472.0, 0.0, 406.0]],
        WHITE,
    ),
    (
        [[472.0, 0.0, 406.0], [472.0, 330.0, 406.0], [314.0, 330.0, 456.0], [314.0, 0.0, 456.0]],
        WHITE,
    ),
    (
        [[314.0, 0.0, 456.0], [314.0, 330.0, 456.0], [265.0, 330.0, 296.0], [265.0, 0.0, 296.0]],
        WHITE,
    ),
    (
        [[265.0, 0.0, 296.0], [265.0, 330.0, 296.0], [423.0, 330.0, 247.0], [423.0, 0.0, 247.0]],
        WHITE,
    ),
];

/// The walls, blocks and the lamp: two triangles for each quadrilateral.
pub fn walls() -> Vec<Wall> {
    let mut walls = Vec::new();
    for (i, (corners, color)) in QUADS.iter().enumerate() {
        let [a, b, c, d] = corners.map(Vec3::from_array);
        for (k, [v1, v2]) in [[b, c], [c, d]].into_iter().enumerate() {
            let light = if i == 0 { k as u32 } else { NO_LIGHT };
            walls.push(Wall { v0: a, v1, v2, color: *color, light });
        }
    }
    walls
}

/// The lights among the walls, in the order of their numbers.
pub fn lamps(walls: &[Wall]) -> Vec<AreaLight<Triangle>> {
    let lamp = |wall: &Wall| AreaLight::<Triangle> {
        shape: Triangle { v0: wall.v0, v1: wall.v1, v2: wall.v2 },
        radiance: LAMP,
        is_two_sided: false,
    };
    walls.iter().filter(|wall| wall.light != NO_LIGHT).map(lamp).collect()
}

/// The camera in front of the open side: its film is 25 mm wide, 35 mm behind the lens.
pub fn camera() -> Pinhole {
    let eye = vec3(278.0, 273.0, -800.0);
    Pinhole::new(eye, eye + Vec3::Z, Vec3::Y, 2.0 * (12.5f32 / 35.0).atan())
}
