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
    /// How many points are where another one is.
    left_out: usize,
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
            None => ("landscape".to_owned(), make(args)),
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
        let spheres = spheres(&points, &scaled);
        Ok(Self {
            name,
            left_out: points.positions.len() - spheres.len(),
            spheres,
            camera,
            up,
            scaled: Summary::of(&scaled),
        })
    }

    /// One or two lines on the scene.
    pub(crate) fn description(&self) -> String {
        let Summary { scale, offset, spacing, radius_code } = &self.scaled;
        let left_out = match self.left_out {
            0 => String::new(),
            n => format!(", {n} others are at the centres of these and left out"),
        };
        format!(
            "{}: {} points, spacing {}{left_out}\n\
             radius code {radius_code} of 255; scaled by {} about ({:.3}, {:.3}, {:.3})",
            self.name,
            self.spheres.len(),
            short(*spacing),
            short(*scale),
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

fn make(args: &Args) -> PointCloud {
    let bar = bar(args.points.into(), "making a landscape");
    let count = args.points as usize;
    let points = cloud::procedural(count, args.seed, &mut |done| bar.set_position(done));
    bar.finish_and_clear();
    points
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
    if !view.is_upright() {
        let message = "the camera looks along --up, or --eye is --target; move one of them";
        return Err(Failure::Usage(message.to_owned()));
    }
    Ok(view)
}

fn spheres(points: &PointCloud, scaled: &Scaled) -> Vec<ColorSphere> {
    let sphere = |i: usize| ColorSphere {
        center: Vec3::from_array(scaled.centers[i]),
        radius: Unorm8::from_bits(scaled.radius_code),
        color: points.colors[i].map(Unorm8::from_bits),
    };
    scaled.distinct().into_iter().map(sphere).collect()
}

/// A length: with an exponent where four digits behind the point say nothing.
fn short(x: f64) -> String {
    if (1e-3..1e7).contains(&x) { format!("{x:.4}") } else { format!("{x:.3e}") }
}
