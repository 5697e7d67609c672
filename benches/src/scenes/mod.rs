//! Scenes with a camera each.

mod grove;
mod points;

use std::path::Path;
use std::{fs, io};

use raydsl::prelude::*;
use raydsl_examples::cloud;
use raydsl_examples::mesh;
use raydsl_io::LoadError;

pub use grove::grove;
pub use points::{Point, points};

/// A point of a scan: 16 bytes.
#[primitive]
pub struct ColorSphere {
    /// Where the point is.
    pub center: Vec3,
    /// How large it is drawn.
    pub radius: Unorm8,
    /// Its colour.
    pub color: [Unorm8; 3],
}

#[primitive]
impl ColorSphere {
    const SLACK: f32 = sphere::SLACK;
    const IS_SHORT: bool = true;

    /// Where a ray meets the sphere.
    #[inline]
    pub fn intersect(&self, ray: Ray) -> Hit {
        sphere::intersect(ray, self.center, self.radius.to_f32())
    }

    /// The box of the sphere.
    pub fn get_bounds(&self) -> Aabb {
        Aabb::from_sphere(self.center, self.radius.to_f32())
    }
}

/// Primitives and where to look at them from.
pub struct Scene<P> {
    /// The primitives.
    pub prims: Vec<P>,
    /// The camera.
    pub camera: Pinhole,
}

/// The procedural cloud with `points` points.
///
/// # Panics
///
/// If there are too few points to make a scale of.
pub fn scan(points: usize) -> Scene<ColorSphere> {
    let cloud = cloud::procedural(points, 7, &mut |_| {});
    let view = cloud::suggested_view(&cloud);
    let scaled = cloud::scale(&cloud, None).expect("the procedural cloud can be scaled");
    let radius = Unorm8::from_bits(scaled.radius_code);
    let sphere = |(&c, &rgb): (&[f32; 3], &[u8; 3])| ColorSphere {
        center: Vec3::from_array(c),
        radius,
        color: rgb.map(Unorm8::from_bits),
    };
    let prims = scaled.centers.iter().zip(&cloud.colors).map(sphere).collect();
    let place = |p: [f64; 3]| {
        Vec3::from_array(std::array::from_fn(|i| ((p[i] - scaled.offset[i]) * scaled.scale) as f32))
    };
    let up = Vec3::from_array(view.up.map(|c| c as f32));
    let fov = view.fov_y_degrees.to_radians() as f32;
    Scene { prims, camera: Pinhole::new(place(view.eye), place(view.target), up, fov) }
}

/// Scenes of triangles in the folder of test data.
pub const FILES: [&str; 3] = ["sibenik", "sponza", "conference"];

/// Sibenik cathedral from the folder of test data.
///
/// # Errors
///
/// As [`file()`].
pub fn sibenik(data: &Path) -> io::Result<Scene<Triangle>> {
    file(data, "sibenik")
}

/// One of [`FILES`] from the folder of test data.
///
/// # Errors
///
/// If the files cannot be read or are not what they should be.
pub fn file(data: &Path, name: &str) -> io::Result<Scene<Triangle>> {
    let prims = mesh::load(&data.join(format!("{name}.tri"))).map_err(io::Error::other)?;
    let cameras: serde_json::Value = serde_json::from_slice(&fs::read(data.join("cameras.json"))?)?;
    let camera = &cameras[name];
    let vector = |part: &str| {
        let number = |i: usize| camera[part][i].as_f64().unwrap_or_default() as f32;
        vec3(number(0), number(1), number(2))
    };
    let fov = camera["vfov_deg"].as_f64().unwrap_or(60.0).to_radians() as f32;
    let camera = Pinhole::new(vector("eye"), vector("center"), vector("up"), fov);
    Ok(Scene { prims, camera })
}

/// The triangles of an `.obj`, a `.ply` or a `.tri`, seen whole from above one corner.
///
/// # Errors
///
/// As [`mesh::load`].
pub fn mesh(path: &Path) -> Result<Scene<Triangle>, LoadError> {
    let prims = mesh::load(path)?;
    let bounds = bounds(&prims);
    let (center, half) = (0.5 * (bounds.min + bounds.max), 0.5 * (bounds.max - bounds.min));
    let eye = center + vec3(0.45, 0.35, 0.82) * (1.6 * half.length());
    Ok(Scene { prims, camera: Pinhole::new(eye, center, Vec3::Y, 1.05) })
}

/// The box of some triangles.
pub fn bounds(triangles: &[Triangle]) -> Aabb {
    Aabb::from_points(triangles.iter().flat_map(|t| [t.v0, t.v1, t.v2]))
}

/// Two rows of fluted columns under a vault, about 80,000 triangles: a hall that needs no file.
pub fn colonnade() -> Scene<Triangle> {
    let (prims, camera) = raydsl_tests::scenes::colonnade();
    Scene { prims, camera }
}

/// Numbers from 0 to below 1, always the same ones.
///
/// (Marsaglia, "Xorshift RNGs", 2003.)
fn xorshift() -> impl FnMut() -> f32 {
    let mut state = 1u32;
    move || {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        (state >> 8) as f32 / 16_777_216.0
    }
}

/// Small triangles in clusters of every density, a few large ones among them: nothing is a surface.
pub fn scatter(count: usize) -> Vec<Triangle> {
    let mut unit = xorshift();
    let mut prims = Vec::with_capacity(count);
    let mut middle = Vec3::ZERO;
    for i in 0..count {
        let mut point = |size: f32| (vec3(unit(), unit(), unit()) - 0.5) * size;
        if i % 1000 == 0 {
            middle = point(100.0);
        }
        let size = if i % 997 == 0 { 10.0 } else { 0.2 };
        let v0 = middle + point(1.0 + (i / 1000 % 20) as f32);
        prims.push(Triangle { v0, v1: v0 + point(size), v2: v0 + point(size) });
    }
    prims
}
