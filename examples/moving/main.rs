//! Smoke that changes in time, beads that circle in it, and a hollow that follows one of them.
//! Learn here what is done anew for each frame of data that moves, and what is not: steps in time
//! are blended by `Grid::between`, one tree is refitted, and surfaces end the rays through smoke.
//!
//! `cargo run --release --example moving -- --frames 48 --out DIR` writes a picture for each frame,
//! `moving.gif`, and three frames beside each other in `moving.png` to DIR (`out` if none is given),
//! and says what each frame took.

mod scene;
mod smoke;

use std::error::Error;
use std::fs::{self, File};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

use clap::Parser;
use image::codecs::gif::{GifEncoder, Repeat};
use image::{Delay, DynamicImage, RgbImage};
use raydsl::gpu::Context;
use raydsl::kernel;
use raydsl::kernel::Kernel;
use raydsl::prelude::*;
use raydsl::volume::{Grid, ShadedCell, Volume};
use raydsl_examples::args::{size, variant};
use raydsl_examples::picture::{beside, reduced};
use scene::{SUN, beads, hollow, seen};
use smoke::STEPS;

/// Smoke, beads and a hollow that move, in one picture.
#[derive(Debug, Parser)]
struct Args {
    /// Frames of the loop.
    #[arg(long, value_name = "N", default_value_t = 48)]
    #[arg(value_parser = clap::value_parser!(u16).range(1..))]
    frames: u16,
    /// Picture size; each pixel has four rays.
    #[arg(long, value_name = "WxH", default_value = "400x300", value_parser = size)]
    size: (u32, u32),
    /// Which variants render; the pictures are of the first.
    #[arg(
        long,
        value_name = "LIST",
        value_delimiter = ',',
        default_values_t = [Variant::widest().name().to_owned(), "wgsl".to_owned()]
    )]
    variants: Vec<String>,
    /// Folder of the pictures.
    #[arg(long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
}

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(e) => {
            eprintln!("moving: {e}");
            ExitCode::from(2)
        }
    }
}

/// The variants that render, and the device of one of them.
struct Renderers {
    variants: Vec<Variant>,
    device: Option<GpuScheduler>,
}

impl Renderers {
    fn new(names: &[String]) -> Result<Self, Box<dyn Error>> {
        let mut variants = names.iter().map(|n| variant(n)).collect::<Result<Vec<_>, _>>()?;
        let mut device = None;
        if variants.contains(&Variant::Wgsl) {
            match GpuScheduler::new() {
                Ok(gpu) => device = Some(gpu),
                Err(e) if variants.len() == 1 => return Err(e.into()),
                Err(e) => eprintln!("without wgsl: {e}"),
            }
        }
        if device.is_none() {
            variants.retain(|v| *v != Variant::Wgsl);
        }
        Ok(Self { variants, device })
    }

    fn context(&self) -> Option<&Context> {
        self.device.as_ref().map(GpuScheduler::context)
    }

    /// Renders a frame by every variant: the picture of the first, and milliseconds of each.
    fn render(
        &self,
        kernel: &Kernel<'_, (Ray,), Shaded>,
        (width, height): (u32, u32),
    ) -> Result<(Image, Vec<f64>), Box<dyn Error>> {
        let camera = Pinhole::new(vec3(0.4, 1.0, 4.3), vec3(0.0, 0.3, 0.0), Vec3::Y, 0.62);
        let mut picture = None;
        let mut times = Vec::new();
        for variant in &self.variants {
            let mut image = Image::new(2 * width, 2 * height);
            let start = Instant::now();
            match (variant, &self.device) {
                (Variant::Wgsl, Some(gpu)) => {
                    gpu.frame(&camera, kernel, &mut image)?;
                }
                (cpu, _) => TiledScheduler::new().variant(*cpu).frame(&camera, kernel, &mut image),
            }
            times.push(milliseconds(start));
            picture.get_or_insert(image);
        }
        let picture = picture.ok_or("--variants names none that runs here")?;
        Ok((reduced(&picture, 2), times))
    }

    fn print_header(&self) {
        let names: Vec<_> = self.variants.iter().map(|v| format!("{:>10}", v.name())).collect();
        print!("frame  step  share   data {}", names.concat());
        println!("{}", if self.device.is_some() { COUNTERS } else { "" });
    }

    /// A row: what a frame took in milliseconds, and what the device has done so far.
    fn print(&self, (frame, step, share): (u16, usize, f32), data: f64, times: &[f64]) {
        let times: Vec<_> = times.iter().map(|ms| format!("{ms:10.1}")).collect();
        print!("{frame:5}  {step:4}  {share:5.2}  {data:5.2} {}", times.concat());
        if let Some(context) = self.context() {
            print!("{:10}{:9}", context.recorded(), context.printed());
            print!("{:10}{:11}", context.compiled(), context.uploaded_bytes());
        }
        println!();
    }
}

const COUNTERS: &str = "  recorded  printed  compiled   uploaded";

fn milliseconds(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1e3
}

fn animated(image: &Image) -> Option<image::Frame> {
    let picture = RgbImage::from_raw(image.width(), image.height(), image.to_rgb8())?;
    let picture = DynamicImage::ImageRgb8(picture).into_rgba8();
    Some(image::Frame::from_parts(picture, 0, 0, Delay::from_numer_denom_ms(50, 1)))
}

fn run(args: &Args) -> Result<(), Box<dyn Error>> {
    let renderers = Renderers::new(&args.variants)?;
    fs::create_dir_all(&args.out)?;
    let mut film = GifEncoder::new_with_speed(File::create(args.out.join("moving.gif"))?, 4);
    film.set_repeat(Repeat::Infinite)?;
    let mut strip: Option<Image> = None;
    renderers.print_header();

    // ANCHOR: frames
    let voxels = smoke::steps();
    let steps = voxels.iter().map(|v| smoke::grid(v)).collect::<Result<Vec<_>, _>>()?;
    let function = smoke::function()?;
    let method = ShadedCell::new(SUN, 3.0);
    let mut swarm = beads(0.0);
    let mut bvh = Bvh::build(&swarm)?;
    for frame in 0..args.frames {
        let phase = f32::from(frame) / f32::from(args.frames);
        let start = Instant::now();
        let tree = bvh.detach();
        swarm = beads(phase);
        bvh = tree.refit(&swarm)?;
        let hollow = hollow(&swarm);

        let time = phase * STEPS as f32;
        let (step, share) = (time as usize, time.fract());
        let now = Grid::between(&steps[step], &steps[(step + 1) % STEPS], share)?;
        let volume = Volume::new(&now, function.clone());
        let data = milliseconds(start);

        let primary = kernel!(|ray: Ray| seen(&bvh, &volume, &hollow, method, ray));
        let (image, times) = renderers.render(&primary, args.size)?;
        renderers.print((frame, step, share), data, &times);
        // ANCHOR_END: frames
        image.write_png(args.out.join(format!("moving_{frame:03}.png")))?;
        film.encode_frame(animated(&image).ok_or("a picture has three bytes for each pixel")?)?;
        if frame % args.frames.div_ceil(3) == 0 {
            strip = Some(strip.map_or(image.clone(), |strip| beside(&strip, &image)));
        }
    }
    if let Some(strip) = strip {
        strip.write_png(args.out.join("moving.png"))?;
    }
    Ok(())
}
