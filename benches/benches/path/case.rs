//! The scenes, as any renderer may have them.

use std::path::Path;

use raydsl::prelude::*;
use raydsl_examples::cornell::{LAMP, Wall};
use serde::Serialize;

use crate::Error;

/// A triangle with what shades it.
pub(crate) struct Facet {
    pub(crate) corners: [Vec3; 3],
    /// Reflectance, the same on both sides.
    pub(crate) color: Vec3,
    /// Radiance on the side of the normal.
    pub(crate) radiance: Vec3,
}

/// A scene, its light and its camera.
pub(crate) struct Case {
    pub(crate) name: &'static str,
    pub(crate) facets: Vec<Facet>,
    /// Radiance of all directions.
    pub(crate) sky: Vec3,
    pub(crate) camera: Pinhole,
}

/// Returns the Cornell box.
pub(crate) fn of_walls(walls: &[Wall], camera: Pinhole) -> Case {
    let facet = |wall: &Wall| Facet {
        corners: [wall.v0, wall.v1, wall.v2],
        color: wall.color,
        radiance: if wall.light == raydsl::bsdf::NO_LIGHT { Vec3::ZERO } else { LAMP },
    };
    Case { name: "cornell", facets: walls.iter().map(facet).collect(), sky: Vec3::ZERO, camera }
}

/// Returns grey triangles under a white sky.
pub(crate) fn of_triangles(name: &'static str, triangles: &[Triangle], camera: Pinhole) -> Case {
    let facet = |t: &Triangle| Facet {
        corners: [t.v0, t.v1, t.v2],
        color: Vec3::splat(0.8),
        radiance: Vec3::ZERO,
    };
    Case { name, facets: triangles.iter().map(facet).collect(), sky: Vec3::ONE, camera }
}

/// What other renderers need to make the same picture.
#[derive(Serialize)]
struct Written {
    name: &'static str,
    /// File of the triangles, 15 `f32` each: corners, reflectance, radiance.
    facets: String,
    sky: [f32; 3],
    eye: [f32; 3],
    center: [f32; 3],
    up: [f32; 3],
    /// Vertical field of view in radians.
    fov_y: f32,
    /// Width and height of the picture.
    size: u32,
    /// How often light is scattered at most.
    bounces: u32,
    /// File of the reference: three `f32` a pixel, the lowest row first.
    reference: String,
}

/// Returns the file of a scene's reference.
pub(crate) fn reference_file(name: &str) -> String {
    format!("{name}.reference.f32")
}

impl Case {
    /// Writes the scene and its reference.
    pub(crate) fn write(
        &self,
        folder: &Path,
        (size, bounces): (u32, u32),
        reference: &[[f32; 3]],
    ) -> Result<(), Error> {
        let facet = |f: &Facet| {
            let [v0, v1, v2] = f.corners;
            [v0, v1, v2, f.color, f.radiance].map(|v| v.to_array())
        };
        let facets: Vec<[f32; 3]> = self.facets.iter().flat_map(facet).collect();
        let Pinhole { eye, center, up, fov_y } = self.camera;
        let written = Written {
            name: self.name,
            facets: format!("{}.facets.f32", self.name),
            sky: self.sky.to_array(),
            eye: eye.to_array(),
            center: center.to_array(),
            up: up.to_array(),
            fov_y,
            size,
            bounces,
            reference: reference_file(self.name),
        };
        std::fs::create_dir_all(folder)?;
        std::fs::write(folder.join(&written.facets), bytes_of(&facets))?;
        std::fs::write(folder.join(&written.reference), bytes_of(reference))?;
        let text = serde_json::to_vec_pretty(&written)?;
        std::fs::write(folder.join(format!("{}.json", self.name)), text)?;
        Ok(())
    }
}

fn bytes_of(values: &[[f32; 3]]) -> Vec<u8> {
    values.iter().flatten().flat_map(|x| x.to_le_bytes()).collect()
}

/// Reads a picture of `size` by `size` pixels.
pub(crate) fn read_picture(path: &Path, size: u32) -> Result<Vec<[f32; 3]>, Error> {
    let bytes = std::fs::read(path)?;
    if bytes.len() as u64 != u64::from(size) * u64::from(size) * 12 {
        return Err(format!("{}: no picture of {size} x {size} pixels", path.display()).into());
    }
    let (values, _) = bytes.as_chunks::<4>();
    let values: Vec<f32> = values.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect();
    Ok(values.as_chunks::<3>().0.to_vec())
}
