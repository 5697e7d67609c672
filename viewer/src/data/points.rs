//! Clouds of points, as spheres of 16 bytes.

use std::path::Path;

use raydsl::integrators::{ambient_occlusion, bvh_cost_color};
use raydsl::prelude::*;
use raydsl_io::cloud::PointCloud;
use raydsl_scenes::cloud;
use raydsl_scenes::points::{self, Point, daylight, sky, spheres};

use super::{Failure, Serve, Teller, file_name};
use crate::look::{Kind, Look, Mode, Show};
use crate::subject::{Info, Picked, Subject, SubjectKernel};

/// Loads a file and serves it.
pub(super) fn open(path: &Path, teller: &Teller<'_>, serve: Serve<'_>) -> Result<(), Failure> {
    let mut is_over = false;
    let points = raydsl_io::cloud::load(path, &mut |done, total| {
        let share = done as f64 / total.max(1) as f64;
        is_over |= teller.tell("reading points", share).is_break();
    })?;
    if is_over { Ok(()) } else { show(file_name(path), points, teller, serve) }
}

/// Makes a landscape and serves it.
pub(super) fn landscape(count: u32, teller: &Teller<'_>, serve: Serve<'_>) -> Result<(), Failure> {
    let points = cloud::procedural(count as usize, 7, &mut |done| {
        // The count goes on even if nobody waits: it takes a second.
        let _ = teller.tell("making a landscape", done as f64 / f64::from(count));
    });
    if teller.is_over() { Ok(()) } else { show("landscape".to_owned(), points, teller, serve) }
}

fn show(
    name: String,
    points: PointCloud,
    teller: &Teller<'_>,
    serve: Serve<'_>,
) -> Result<(), Failure> {
    let scaled = cloud::scale(&points, None)?;
    let spheres = spheres(&points, &scaled);
    let home = points::home(&points, &scaled);
    let (scale, offset) = (scaled.scale, scaled.offset);
    // Only the spheres are needed from here on: the file's numbers are twice as large.
    drop((points, scaled));
    let config = BuildConfig::default();
    let tree =
        Bvh::build_observed(&spheres, &[], &config, |done| teller.tell("building the tree", done))?;
    let size = format!("{} points, {} nodes", spheres.len(), tree.nodes().len());
    let info = Info::of_scene(Kind::Points, name, size, home, tree.bounds());
    // Light from as far away as a dozen neighbours is what makes a surface of spheres look round.
    let radius = spheres.first().map_or(1.0, |s| s.radius.to_f32()) * 24.0;
    serve(info, &mut Points { tree, radius, scale, offset });
    Ok(())
}

struct Points<'a> {
    tree: Bvh<'a, Point>,
    radius: f32,
    scale: f64,
    offset: [f64; 3],
}

/// The number of tests that is the hot end of the heat map.
const MOST_TESTS: f32 = 120.0;

impl Subject for Points<'_> {
    fn with_kernel(
        &mut self,
        look: &Look,
        run: &mut dyn FnMut(&SubjectKernel<'_>),
    ) -> Result<(), String> {
        let (tree, radius, most, up) = (&self.tree, self.radius, MOST_TESTS, look.pose.up);
        let sun = points::to_sun(up);
        let is_cost = look.show == Show::Cost;
        let is_occlusion = look.mode == Mode::Occlusion;
        let kernel = kernel!(counted |ray: Ray, sampler: Sampler| {
            let mut color = sky(up, ray.direction);
            if is_cost {
                color = bvh_cost_color(tree, most, ray);
            } else if is_occlusion {
                let light = ambient_occlusion::<_, 1>(tree, radius, ray, sampler);
                color = vec3(light.x, light.y, light.z) + color * (1.0 - light.w);
            } else {
                color = daylight(tree, up, sun, ray);
            }
            vec4(color.x, color.y, color.z, 1.0)
        });
        run(&kernel);
        Ok(())
    }

    fn pick(&mut self, _look: &Look, ray: Ray) -> Option<Picked> {
        let hit = self.tree.closest_hit(ray);
        if !hit.is_hit {
            return None;
        }
        let point = self.tree.primitives().get(hit.prim_id as usize)?;
        let axis = |i: usize| f64::from(point.center[i]) / self.scale + self.offset[i];
        let [r, g, b] = point.color.map(|c| c.to_bits());
        let value = format!(
            "({:.3}, {:.3}, {:.3}) in the file, colour {r} {g} {b}",
            axis(0),
            axis(1),
            axis(2)
        );
        Some(Picked { id: u64::from(hit.prim_id), position: ray.at(hit.t), value })
    }
}
