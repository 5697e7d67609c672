//! Parts that buildings are put together from.

use super::paint::Paint;
use super::shape::{Shape, V3, add, times};
use super::terrain::{Terrain, to_world};
use super::{Piece, Scene};

/// An upright frame: a place on the ground and two horizontal directions.
#[derive(Clone, Copy)]
pub(super) struct Frame {
    pub(super) origin: V3,
    pub(super) along: V3,
    pub(super) side: V3,
}

impl Frame {
    /// A frame whose `along` axis is turned by `angle` from the view's `s` axis.
    pub(super) fn new(terrain: &Terrain, (s, t): (f64, f64), angle: f64, reach: f64) -> Self {
        let (x, y) = to_world(s, t);
        let turn = angle - std::f64::consts::FRAC_PI_4;
        let (sin, cos) = turn.sin_cos();
        let (along, side) = ([cos, sin, 0.0], [-sin, cos, 0.0]);
        // The floor lies on the lowest ground around, so that no wall hangs in the air.
        let floor = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0), (0.0, 0.0)]
            .map(|(a, b)| {
                let corner = add(times(along, a * reach), times(side, b * reach));
                terrain.height(x + corner[0], y + corner[1])
            })
            .into_iter()
            .fold(f64::INFINITY, f64::min);
        Self { origin: [x, y, floor], along, side }
    }

    pub(super) fn at(&self, a: f64, b: f64, z: f64) -> V3 {
        let flat = add(times(self.along, a), times(self.side, b));
        add(self.origin, [flat[0], flat[1], z])
    }

    pub(super) fn vector(&self, a: f64, b: f64, z: f64) -> V3 {
        let flat = add(times(self.along, a), times(self.side, b));
        [flat[0], flat[1], z]
    }
}

/// Measures of a gabled building: half extents, eaves and ridge above the floor.
#[derive(Clone, Copy)]
pub(super) struct Gable {
    pub(super) half: (f64, f64),
    pub(super) eaves: f64,
    pub(super) ridge: f64,
    pub(super) wall: Paint,
    pub(super) roof: Paint,
}

/// The four walls of a box, outward.
pub(super) fn walls(scene: &mut Scene, f: &Frame, (a, b): (f64, f64), z: (f64, f64), paint: Paint) {
    let up = [0.0, 0.0, z.1 - z.0];
    let sides = [
        (f.at(-a, -b, z.0), f.vector(2.0 * a, 0.0, 0.0)),
        (f.at(a, b, z.0), f.vector(-2.0 * a, 0.0, 0.0)),
        (f.at(a, -b, z.0), f.vector(0.0, 2.0 * b, 0.0)),
        (f.at(-a, b, z.0), f.vector(0.0, -2.0 * b, 0.0)),
    ];
    for (origin, u) in sides {
        scene.push(Shape::Quad { origin, u, v: up }, paint);
    }
}

/// A box with a lid.
pub(super) fn block(scene: &mut Scene, f: &Frame, half: (f64, f64), z: (f64, f64), paint: Paint) {
    walls(scene, f, half, z, paint);
    let (u, v) = (f.vector(2.0 * half.0, 0.0, 0.0), f.vector(0.0, 2.0 * half.1, 0.0));
    scene.push(Shape::Quad { origin: f.at(-half.0, -half.1, z.1), u, v }, paint);
}

pub(super) fn gabled(scene: &mut Scene, f: &Frame, g: Gable) {
    let (a, b) = g.half;
    walls(scene, f, g.half, (0.0, g.eaves), g.wall);
    let rise = g.ridge - g.eaves;
    for sign in [1.0, -1.0] {
        // Gable: the triangle between the eaves and the ridge.
        scene.push(
            Shape::Triangle {
                origin: f.at(sign * a, -sign * b, g.eaves),
                u: f.vector(0.0, 2.0 * sign * b, 0.0),
                v: f.vector(0.0, sign * b, rise),
            },
            g.wall,
        );
        // Roof: overhangs its walls by half a metre, at the roof's own slope.
        let over = 0.5;
        let drop = over * rise / b;
        scene.push(
            Shape::Quad {
                origin: f.at(-sign * (a + over), -sign * (b + over), g.eaves - drop),
                u: f.vector(sign * 2.0 * (a + over), 0.0, 0.0),
                v: f.vector(0.0, sign * (b + over), rise + drop),
            },
            g.roof,
        );
    }
}

/// Four triangles from a square to a point above it.
pub(super) fn pyramid(scene: &mut Scene, f: &Frame, half: f64, z: (f64, f64), paint: Paint) {
    for (c, s) in [(0.0, -1.0), (1.0, 0.0), (0.0, 1.0), (-1.0, 0.0)] {
        // (c, s) points out of this side; (-s, c) runs along it.
        let (c, s): (f64, f64) = (c, s);
        scene.push(
            Shape::Triangle {
                origin: f.at(half * (c + s), half * (s - c), z.0),
                u: f.vector(-2.0 * half * s, 2.0 * half * c, 0.0),
                v: f.vector(-half * (c + s), half * (c - s), z.1 - z.0),
            },
            paint,
        );
    }
}

impl Scene {
    /// Adds a surface.
    pub(super) fn push(&mut self, shape: Shape, paint: Paint) {
        self.pieces.push(Piece { shape, paint, area: shape.area() });
    }

    /// Reserves a disc of ground.
    pub(super) fn keep_clear(&mut self, place: (f64, f64), radius: f64) {
        self.occupied.push((place, radius));
    }

    /// Whether a disc of ground is free of buildings.
    pub(super) fn is_clear(&self, (s, t): (f64, f64), radius: f64) -> bool {
        self.occupied.iter().all(|((a, b), r)| (s - a).hypot(t - b) > r + radius)
    }
}
