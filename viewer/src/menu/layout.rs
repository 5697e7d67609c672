//! Where buttons are: on a plane before the camera, which follows the head.

use raydsl::prelude::*;
use raydsl_scenes::Pose;

use crate::wand::Wand;

/// A button: its corners, anticlockwise from the lower left.
#[primitive(quad(v0, v1, v2, v3))]
#[derive(Debug, PartialEq)]
pub struct Button {
    /// The lower left corner.
    pub v0: Vec3,
    /// The lower right corner.
    pub v1: Vec3,
    /// The upper right corner.
    pub v2: Vec3,
    /// The upper left corner.
    pub v3: Vec3,
}

/// How far the menu is, as a share of the distance of what is looked at.
const REACH: f32 = 0.5;
/// Columns and rows.
const CELLS: (f32, f32) = (3.0, 5.0);
/// Size of a column and a row, as shares of the height that is seen.
const CELL: Vec2 = vec2(0.46, 0.155);
/// Size of a button in its cell.
const BUTTON: Vec2 = vec2(0.92, 0.8);
/// Where the hand is that holds a mouse's wand: to the right, up and back, by the height that is seen.
const HAND: Vec3 = vec3(0.3, -0.62, 0.25);

/// The plane of the menu.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Frame {
    /// From the plane's coordinates to the world: right, up and to the camera. The unit is the height
    /// that is seen there, or less where a picture is narrow.
    to_world: Mat4,
}

impl Frame {
    pub(super) fn new(pose: &Pose, (width, height): (u32, u32)) -> Self {
        let reach = REACH * pose.distance();
        let tall = 2.0 * (0.5 * pose.fov_y).tan() * reach;
        let aspect = width as f32 / height as f32;
        // All columns are seen.
        let unit = tall * (aspect / (CELLS.0 * CELL.x + 0.04)).min(1.0);
        let away = Mat4::from_translation(vec3(0.0, 0.0, -reach));
        Self { to_world: pose.head() * away * Mat4::from_scale(Vec3::splat(unit)) }
    }

    /// Returns a length of the plane in the world.
    pub(super) fn length(&self, length: f32) -> f32 {
        self.to_world.x_axis.truncate().length() * length
    }

    pub(super) fn button(&self, column: u32, row: u32) -> Button {
        let middle =
            vec2(column as f32 - 0.5 * (CELLS.0 - 1.0), 0.5 * (CELLS.1 - 1.0) - row as f32);
        let corner = |x: f32, y: f32| {
            let at = (middle + 0.5 * BUTTON * vec2(x, y)) * CELL;
            self.to_world.transform_point3(at.extend(0.0))
        };
        let [v0, v1, v2, v3] =
            [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
        Button { v0, v1, v2, v3 }
    }

    /// Returns the ray of a wand in the world.
    pub(super) fn ray(&self, wand: Wand, pose: &Pose, size: (u32, u32)) -> Ray {
        match wand {
            Wand::Tracked(pose) => {
                let axis = pose.z_axis.truncate();
                Ray::new(pose.w_axis.truncate(), -axis.normalize_or(Vec3::Z))
            }
            Wand::Pixel(at) => {
                let hand = self.to_world.transform_point3(HAND);
                let middle = self.to_world.w_axis.truncate();
                // A pixel sees the plane somewhere: it is across the line of sight.
                let there = pose.beside(size, at, middle).unwrap_or(middle);
                Ray::new(hand, (there - hand).normalize_or(Vec3::Z))
            }
        }
    }
}
