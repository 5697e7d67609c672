//! What the render thread knows of data: the kernel that makes a picture of them, and picking.

use std::fmt;

use raydsl::kernel::CountedKernel;
use raydsl::prelude::*;
use raydsl_scenes::Pose;

use crate::look::{Kind, Look};

/// A kernel of pictures: one type for all data, so that the code around it exists once.
pub(crate) type PictureKernel<'a> = Kernel<'a, (Ray, Sampler), Vec4>;

/// The same with a copy that counts the lanes that run.
pub(crate) type SubjectKernel<'a> = CountedKernel<'a, (Ray, Sampler), Vec4>;

/// Data that can be looked at.
pub(crate) trait Subject {
    /// Calls `run` with the kernel for a look.
    ///
    /// # Errors
    ///
    /// If the look cannot be had of these data: one line.
    fn with_kernel(
        &mut self,
        look: &Look,
        run: &mut dyn FnMut(&SubjectKernel<'_>),
    ) -> Result<(), String>;

    /// Returns what a ray meets first.
    fn pick(&mut self, look: &Look, ray: Ray) -> Option<Picked>;
}

/// What is seen in a pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Picked {
    /// The number of the point or triangle; of a volume, that of the nearest voxel.
    pub id: u64,
    /// Where it is, in units of the scene.
    pub position: Vec3,
    /// What is there: colour, material or value.
    pub value: String,
}

impl fmt::Display for Picked {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { id, position: Vec3 { x, y, z }, value } = self;
        write!(f, "{id} at ({x:.4}, {y:.4}, {z:.4}): {value}")
    }
}

/// What is known of data that are open.
#[derive(Clone, Debug, PartialEq)]
pub struct Info {
    /// Points, surface, volume or cells.
    pub kind: Kind,
    /// The file's name.
    pub name: String,
    /// How much it is, in a line.
    pub size: String,
    /// The view that sees all.
    pub home: Pose,
    /// The box around all of it.
    pub bounds: Aabb,
    /// The least and the greatest value of a field.
    pub range: Vec2,
    /// How many voxels or points have a value, in equal parts of the range; empty for other data.
    pub histogram: Vec<u32>,
}

impl Info {
    /// Returns what is known of data without values.
    pub(crate) fn of_scene(
        kind: Kind,
        name: String,
        size: String,
        home: Pose,
        bounds: Aabb,
    ) -> Self {
        Self { kind, name, size, home, bounds, range: Vec2::ZERO, histogram: Vec::new() }
    }
}
