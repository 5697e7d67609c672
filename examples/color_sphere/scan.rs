//! From a cloud of points to spheres and a camera.

use std::path::Path;

use raydsl::math::Unorm8;
use raydsl::prelude::{Pinhole, Vec3, vec3};
use raydsl_examples::cloud::{self, Scaled, View};
use raydsl_io::cloud::{PointCloud, load};

use crate::args::Args;
use crate::{ColorSphere, Failure, bar};

/// A scan, ready to be rendered.
pub(crate) struct Scan {
    pub(crate) name: String,
    pub(crate) spheres: Vec<ColorSphere>,
    pub(crate) camera: Pinhole,
    pub(crate) up: Vec3,
    scaled: Summary,
}

/// How the file's units became those of the scene.
struct Summary {
    scale: f64,
    offset: [f64; 3],
    spacing: f64,
    radius_code: u8,
}

impl Scan {
    /// Reads or makes the points, scales them, and looks at them.
    pub(crate) fn load(args: &Args) -> Result<Self, Failure> {
        let (name, points) = match &args.file {
            Some(path) => (file_name(path), read(path)?),
            None => ("landscape".to_owned(), make(args)?),
        };
        let scaled = cloud::scale(&points, args.radius)?;
        let view = view(args, &points)?;
        let place = |p: [f64; 3]| {
            let axis = |i: usize| ((p[i] - scaled.offset[i]) * scaled.scale) as f32;
            vec3(axis(0), axis(1), axis(2))
        };
        let up = vec3(view.up[0] as f32, view.up[1] as f32, view.up[2] as f32).normalize();
        let fov = view.fov_y_degrees.to_radians() as f32;
        let camera = Pinhole::new(place(view.eye), place(view.target), up, fov);
        Ok(Self {
            name,
            spheres: spheres(&points, &scaled),
            camera,
            up,
            scaled: Summary::of(&scaled),
        })
    }

    /// One or two lines on the scene.
    pub(crate) fn description(&self) -> String {
        let Summary { scale, offset, spacing, radius_code } = &self.scaled;
        format!(
            "{}: {} points, spacing {spacing:.4}\n\
             radius code {radius_code} of 255; scaled by {scale:.6} about ({:.3}, {:.3}, {:.3})",
            self.name,
            self.spheres.len(),
            offset[0],
            offset[1],
            offset[2],
        )
    }
}

impl Summary {
    fn of(s: &Scaled) -> Self {
        let Scaled { scale, offset, spacing, radius_code, .. } = s;
        Self { scale: *scale, offset: *offset, spacing: *spacing, radius_code: *radius_code }
    }
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

fn read(path: &Path) -> Result<PointCloud, Failure> {
    let bar = bar(0, "reading");
    let points = load(path, &mut |done, total| {
        bar.set_length(total);
        bar.set_position(done);
    });
    bar.finish_and_clear();
    Ok(points?)
}

fn make(args: &Args) -> Result<PointCloud, Failure> {
    if args.points == 0 {
        return Err(Failure::Usage("--points is 0; ask for at least 1 point".to_owned()));
    }
    let bar = bar(args.points as u64, "making a landscape");
    let points = cloud::procedural(args.points, args.seed, &mut |done| bar.set_position(done));
    bar.finish_and_clear();
    Ok(points)
}

/// The camera that was asked for; what was not comes from a view of everything.
fn view(args: &Args, points: &PointCloud) -> Result<View, Failure> {
    let mut view = cloud::suggested_view(points);
    view.eye = args.eye.unwrap_or(view.eye);
    view.target = args.target.unwrap_or(view.target);
    view.up = args.up.unwrap_or(view.up);
    view.fov_y_degrees = args.fov.unwrap_or(view.fov_y_degrees);
    if !(view.fov_y_degrees > 0.0 && view.fov_y_degrees < 180.0) {
        let message = format!("--fov {} is not between 0 and 180 degrees", view.fov_y_degrees);
        return Err(Failure::Usage(message));
    }
    let way: [f64; 3] = std::array::from_fn(|i| view.target[i] - view.eye[i]);
    let across = [
        way[1] * view.up[2] - way[2] * view.up[1],
        way[2] * view.up[0] - way[0] * view.up[2],
        way[0] * view.up[1] - way[1] * view.up[0],
    ];
    if across.iter().all(|c| c.abs() < 1e-12) {
        let message = "the camera looks along --up, or --eye is --target; move one of them";
        return Err(Failure::Usage(message.to_owned()));
    }
    Ok(view)
}

fn spheres(points: &PointCloud, scaled: &Scaled) -> Vec<ColorSphere> {
    scaled
        .centers
        .iter()
        .zip(&points.colors)
        .map(|(c, color)| ColorSphere {
            center: Vec3::from_array(*c),
            radius: Unorm8::from_bits(scaled.radius_code),
            color: color.map(Unorm8::from_bits),
        })
        .collect()
}
