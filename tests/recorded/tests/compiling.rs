//! Pipelines: compiled on a thread while the host renders, and kept in a file.
//!
//! `cargo test --test compiling -- --nocapture` prints how long a first picture takes.

use std::fs;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use raydsl::gpu::{Context, GpuError, GpuScheduler};
use raydsl::integrators::ambient_occlusion;
use raydsl::prelude::*;
use raydsl_tests::gpu::gpu;
use raydsl_tests::scenes::{random_rays, triangles};
use raydsl_tests::values::compare;

type Error = Box<dyn std::error::Error>;

/// A context of its own, which has no pipelines yet.
fn own() -> Result<Option<Context>, Error> {
    Ok(if gpu().is_some() { Some(Context::new()?) } else { None })
}

fn camera() -> Pinhole {
    Pinhole::new(vec3(0.0, 0.0, 3.0), Vec3::ZERO, Vec3::Y, 1.0)
}

/// Asks until a frame is compiled.
fn wait(
    gpu: &GpuScheduler,
    kernel: &raydsl::kernel::Kernel<'_, (Ray, Sampler), Vec4>,
) -> Result<(), Error> {
    let start = Instant::now();
    while !gpu.prepare_frame(&camera(), kernel)? {
        assert!(start.elapsed() < Duration::from_secs(300), "it is compiled at last");
        std::thread::sleep(Duration::from_millis(5));
    }
    Ok(())
}

/// Ambient occlusion in a tree: enough text to compile for a while.
macro_rules! occlusion {
    ($bvh:ident) => {
        kernel!(|ray: Ray, sampler: Sampler| ambient_occlusion::<_, 4>(&$bvh, 0.5, ray, sampler))
    };
}

#[test]
fn the_host_renders_while_the_device_compiles() -> Result<(), Error> {
    let Some(context) = own()? else { return Ok(()) };
    let gpu = GpuScheduler::with_context(context).while_compiling(TiledScheduler::new());
    let triangles = triangles(2000);
    let bvh = Bvh::build(&triangles)?;
    let kernel = occlusion!(bvh);
    let host = TiledScheduler::new();

    let mut expected = Image::filled(40, 30, Vec4::ZERO);
    host.frame(&camera(), &kernel, &mut expected);
    let mut found = Image::filled(40, 30, Vec4::ZERO);
    let first = gpu.frame(&camera(), &kernel, &mut found)?;
    assert_eq!(found, expected);

    wait(&gpu, &kernel)?;
    let mut found = Image::filled(40, 30, Vec4::ZERO);
    let second = gpu.frame(&camera(), &kernel, &mut found)?;
    assert_eq!(found, expected);
    assert!(second.dispatches > 0);
    assert_eq!(gpu.context().compiled(), 1, "a thread compiled it, and nobody else");
    println!("first picture {:.1} ms, then {:.1} ms", first.wall_ms, second.wall_ms);
    Ok(())
}

#[test]
fn passes_of_both_make_one_film() -> Result<(), Error> {
    let Some(context) = own()? else { return Ok(()) };
    let gpu = GpuScheduler::with_context(context).while_compiling(TiledScheduler::new());
    let triangles = triangles(2000);
    let bvh = Bvh::build(&triangles)?;
    let kernel = occlusion!(bvh);
    let sampling = Sampling::new(7);
    let (mut expected, mut found) = (Film::new(24, 16), Film::new(24, 16));
    let mut runs = [0, 0];
    let start = Instant::now();
    while runs[1] < 2 {
        assert!(start.elapsed() < Duration::from_secs(300), "the device takes over");
        TiledScheduler::new().accumulate(&camera(), &kernel, &sampling, &mut expected, 2);
        let timing = gpu.accumulate(&camera(), &kernel, &sampling, &mut found, 2)?;
        runs[usize::from(timing.dispatches > 0)] += 1;
    }
    println!("{} passes of the host, then {} of the device", runs[0], runs[1]);
    assert_eq!(found.image(), expected.image());
    Ok(())
}

#[test]
fn batches_are_done_by_both() -> Result<(), Error> {
    let Some(context) = own()? else { return Ok(()) };
    let gpu = GpuScheduler::with_context(context).while_compiling(TiledScheduler::new());
    let triangles = triangles(2000);
    let bvh = Bvh::build(&triangles)?;
    let kernel = kernel!(|ray: Ray| bvh.closest_hit(ray));
    let rays: Vec<(Ray,)> = random_rays(3, 300_000).into_iter().map(|ray| (ray,)).collect();
    let (mut expected, mut found) = (vec![Hit::miss(); rays.len()], vec![Hit::miss(); rays.len()]);
    TiledScheduler::new().batch(&kernel, &rays, &mut expected);
    let start = Instant::now();
    while gpu.batch(&kernel, &rays, &mut found)?.dispatches == 0 {
        assert!(start.elapsed() < Duration::from_secs(300), "the device takes over");
        compare("a batch of the host", &expected, &found).assert_same(|i| i.to_string());
        found.fill(Hit::miss());
    }
    compare("a batch of both", &expected, &found).assert_same(|i| i.to_string());
    // What is wrong is the device's error still.
    let refused = gpu.batch(&kernel, &rays, &mut found[1..]);
    assert!(matches!(refused, Err(GpuError::WrongLength { .. })), "{refused:?}");
    Ok(())
}

/// The loss of the device comes with a call, and a scheduler may go while a thread compiles.
#[test]
fn a_lost_device_is_an_error_while_the_host_renders() -> Result<(), Error> {
    let Some(context) = own()? else { return Ok(()) };
    let gpu = GpuScheduler::with_context(context).while_compiling(TiledScheduler::new());
    let triangles = triangles(200);
    let bvh = Bvh::build(&triangles)?;
    let kernel = occlusion!(bvh);
    assert!(!gpu.prepare_frame(&camera(), &kernel)?);
    drop(gpu);

    let Some(context) = own()? else { return Ok(()) };
    let gpu = GpuScheduler::with_context(context).while_compiling(TiledScheduler::new());
    gpu.context().device().destroy();
    let error = gpu.frame(&camera(), &kernel, &mut Image::filled(8, 8, Vec4::ZERO)).err();
    assert!(matches!(error, Some(GpuError::DeviceLost { .. })), "{error:?}");
    Ok(())
}

/// A folder that is removed at the end.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let name = format!("raydsl-{name}-{}", std::process::id());
        let folder = std::env::temp_dir().join(name);
        // One of a run that was killed.
        let _ = fs::remove_dir_all(&folder);
        Self(folder)
    }

    fn files(&self) -> Result<Vec<PathBuf>, Error> {
        fs::read_dir(&self.0)?.map(|entry| Ok(entry?.path())).collect()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

#[test]
fn pipelines_are_kept_in_a_file() -> Result<(), Error> {
    let Some(context) = own()? else { return Ok(()) };
    if !context.device().features().contains(wgpu::Features::PIPELINE_CACHE) {
        // SAFETY: there is no file.
        let context = unsafe { context.with_pipeline_cache("no folder") }?;
        assert_eq!(context.save_pipelines()?, 0);
        eprintln!("SKIPPED: the device keeps no pipelines");
        return Ok(());
    }
    let folder = Folder::new("pipelines");
    let triangles = triangles(200);
    let bvh = Bvh::build(&triangles)?;
    let kernel = occlusion!(bvh);
    let mut expected = Image::filled(16, 16, Vec4::ZERO);
    TiledScheduler::new().frame(&camera(), &kernel, &mut expected);
    let render = |context: Context| -> Result<f64, Error> {
        let gpu = GpuScheduler::with_context(context);
        let mut found = Image::filled(16, 16, Vec4::ZERO);
        gpu.frame(&camera(), &kernel, &mut found)?;
        assert_eq!(found, expected);
        Ok(gpu.context().compile_time().as_secs_f64() * 1e3)
    };
    // SAFETY: only this test knows the folder.
    let first = render(unsafe { context.with_pipeline_cache(&folder.0) }?)?;
    let files = folder.files()?;
    let [file] = &files[..] else { panic!("one file: {files:?}") };
    let written = fs::read(file)?;
    assert!(written.starts_with(b"raydsl 1"), "{} bytes", written.len());

    // SAFETY: as before.
    let again = unsafe { Context::new()?.with_pipeline_cache(&folder.0) }?;
    let bytes = again.save_pipelines()?;
    assert_eq!(fs::read(file)?.len() as u64, 16 + bytes);
    println!("compiled in {first:.1} ms, from the file in {:.1} ms", render(again)?);

    // One that is cut short is as good as none.
    for length in [0, 7, 15, 16, written.len() / 2, written.len() - 1] {
        fs::write(file, &written[..length])?;
        // SAFETY: what was cut off is found.
        render(unsafe { Context::new()?.with_pipeline_cache(&folder.0) }?)?;
        assert!(fs::read(file)?.len() >= written.len(), "it is written anew");
        assert_eq!(folder.files()?.len(), 1, "and nothing else is left");
    }

    // A file that is a folder cannot be read.
    fs::remove_file(file)?;
    fs::create_dir(file)?;
    // SAFETY: there is no file.
    let refused = unsafe { Context::new()?.with_pipeline_cache(&folder.0) };
    assert!(matches!(refused, Err(GpuError::PipelineFile { .. })), "{refused:?}");
    Ok(())
}
