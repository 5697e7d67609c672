//! A vector field by streamlines and arrows, and fibre tracts, by every variant of one kernel.
//!
//! Without an argument it makes a flow of vortices in code; with a `.vtu` it shows that, and with
//! `--tracts` and a `.trk` the tracts of that. It writes a picture for each variant, their
//! differences, a table that says whether they agree, and `flow.png` with a legend.

mod args;
mod file;
mod lines;
mod made;
mod measure;

use std::process::ExitCode;

use args::Args;
use clap::Parser;
use lines::Shown;
use raydsl::prelude::*;
use raydsl::volume::TransferFunction;
use raydsl_examples::comparison::Frames;
use raydsl_examples::picture::smooth_frame;
use raydsl_report::Legend;

/// What ends the program: one line, and exit code 2.
#[derive(Debug, thiserror::Error)]
enum Failure {
    #[error(transparent)]
    Load(#[from] raydsl_io::LoadError),
    #[error(transparent)]
    Cells(#[from] raydsl::volume::cells::CellError),
    #[error(transparent)]
    Flow(#[from] raydsl::flow::FlowError),
    #[error(transparent)]
    Transfer(#[from] raydsl::volume::TransferError),
    #[error(transparent)]
    Build(#[from] raydsl::bvh::BuildError),
    #[error(transparent)]
    Write(#[from] raydsl_report::WriteError),
    #[error("flow.png cannot be written: {0}")]
    Picture(#[from] image::ImageError),
    #[error(transparent)]
    Device(#[from] raydsl::gpu::GpuError),
    #[error("{0}")]
    Usage(String),
}

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(e) => {
            eprintln!("flow: {e}");
            ExitCode::from(2)
        }
    }
}

fn run(args: &Args) -> Result<(), Failure> {
    if args.measure {
        return Ok(measure::run(args)?);
    }
    let shown = match &args.file {
        Some(path) if args.tracts => file::tracts(args, path)?,
        Some(path) => file::cells(args, path)?,
        None => made::shown(args)?,
    };
    show(args, &shown)
}

/// Field of view, in radians.
const ANGLE: f32 = 0.5;

/// A camera that sees all of a box, and where light comes from.
fn view(args: &Args, bounds: Aabb) -> (Pinhole, Vec3) {
    let from = args.from.map_or(vec3(0.9, -1.6, 0.8), |v| Vec3::from(v.map(|x| x as f32)));
    let from = from.normalize_or(Vec3::Y);
    let up = if from.z.abs() > 0.99 { Vec3::Y } else { Vec3::Z };
    let right = from.cross(up).normalize();
    let above = right.cross(from);
    let aspect = args.size.0 as f32 / args.size.1 as f32;
    let half = (ANGLE * 0.5).tan();
    // As near as all corners of the box are seen, with room for the legend.
    let corner = |i: u32| (uvec3(i & 1, i >> 1 & 1, i >> 2).as_vec3() - 0.5) * bounds.size();
    let distance = |c: Vec3| {
        let aside = (c.dot(right).abs() / aspect).max(c.dot(above).abs());
        1.1 * aside / half + c.dot(from)
    };
    let far = (0..8).map(|i| distance(corner(i))).fold(0.0, f32::max);
    let middle = bounds.center();
    let to_light = (from - right * 0.5 + above * 0.9).normalize();
    (Pinhole::new(middle + from * far, middle, up, ANGLE), to_light)
}

/// The colours of a map over values.
fn colors(args: &Args, (low, high): (f32, f32)) -> Vec<(f32, Vec3)> {
    const KNOTS: u32 = 32;
    let knot = |i: u32| {
        let share = f64::from(i) / f64::from(KNOTS);
        let c = args.map.gradient().eval_continuous(share);
        let color = vec3(c.r.into(), c.g.into(), c.b.into()) / 255.0;
        (low + (high - low) * share as f32, color)
    };
    (0..=KNOTS).map(knot).collect()
}

fn show(args: &Args, shown: &Shown) -> Result<(), Failure> {
    let range = shown.range();
    let (camera, to_light) = view(args, shown.bounds);
    // ANCHOR: colors
    let map = TransferFunction::from_extinction(&colors(args, range), &[(0.0, 0.0)])?;
    // ANCHOR_END: colors
    let (tubes, arrows) = (Bvh::build(&shown.tubes)?, Bvh::build(&shown.arrows)?);
    let by_direction = args.tracts;
    let reach = shown.bounds.size().length();
    let tube_count = shown.tubes.len() as u32;
    // ANCHOR: picture
    let primary = kernel!(|ray: Ray| {
        let tube = tubes.closest_hit(ray);
        let arrow = arrows.closest_hit(ray);
        let is_arrow = arrow.is_hit && !(tube.is_hit && tube.t <= arrow.t);
        let mut color = vec3(0.12, 0.13, 0.15) + vec3(0.1, 0.1, 0.1) * ray.direction.z.abs();
        let mut depth = f32::MAX;
        let mut id = tube.prim_id;
        if tube.is_hit || is_arrow {
            let normal;
            let own;
            if is_arrow {
                let part = arrows.primitive(arrow);
                normal = part.normal(ray, arrow);
                own = map.at(part.value).color;
                depth = arrow.t;
                // Behind the numbers of tubes.
                id = tube_count + arrow.prim_id;
            } else {
                let part = tubes.primitive(tube);
                normal = part.normal(ray, tube);
                let axis = (part.p1 - part.p0).normalize_or_zero().abs();
                own = if by_direction { axis } else { map.at(part.value(tube)).color };
                depth = tube.t;
            }
            let at = ray.at(depth) + normal * (reach * 1e-4);
            let shadow = Ray::new(at, to_light).with_range(0.0, reach);
            let is_dark = tubes.any_hit(shadow) || arrows.any_hit(shadow);
            let direct = if is_dark { 0.0 } else { max(normal.dot(to_light), 0.0) };
            let facing = max(-normal.dot(ray.direction), 0.0);
            color = own * (0.4 + 0.25 * facing + 0.5 * direct);
        }
        Shaded { color, depth, id }
    });
    // ANCHOR_END: picture

    let frames =
        Frames { size: args.size, runs: args.runs, variants: &args.variants, out: &args.out };
    frames.report(&frames.compare(&primary, &camera))?;
    let mut picture = smooth_frame(Variant::widest(), &camera, &primary, args.size)?;
    // ANCHOR: legend
    if !by_direction {
        Legend::new(&shown.title[..], range.0, range.1)
            .draw(&mut picture, |value| map.at(value).color);
    }
    // ANCHOR_END: legend
    picture.write_png(args.out.join("flow.png"))?;
    Ok(())
}
