//! A thousand changes of each kind on a device: no text is printed and nothing is compiled after
//! the first, memory does not grow, and exactly what has changed is uploaded.

use raydsl::gpu::GpuScheduler;
use raydsl::kernel::Kernel;
use raydsl::prelude::*;
use raydsl::render::Renderer;
use raydsl::volume::{
    ExactCell, Grid, GridConfig, TransferFunction, TransferKnot, Volume, VolumeLight,
};
use raydsl_tests::gpu::gpu;
use raydsl_tests::rng::Rng;

use super::Ball;

type Error = Box<dyn std::error::Error>;

const CHANGES: usize = 1000;

/// Pictures compared with the scalar variant's are so many changes apart.
const COMPARED: usize = 97;

/// A scheduler of its own, so that nobody else moves its counters.
fn own_scheduler() -> Result<Option<GpuScheduler>, Error> {
    if gpu().is_none() {
        return Ok(None);
    }
    Ok(Some(GpuScheduler::new()?))
}

/// Small films of changing data, and the counters of their device.
struct Films {
    gpu: GpuScheduler,
    /// Frames before the first that is counted.
    warm: usize,
    frames: usize,
    first: Option<Counts>,
    /// The greatest difference of a pixel that is taken for rounding.
    bound: f32,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Counts {
    recorded: u64,
    printed: u64,
    compiled: u64,
    kept: u64,
    uploaded: u64,
}

impl Films {
    fn new(gpu: GpuScheduler, warm: usize, bound: f32) -> Self {
        Self { gpu, warm, frames: 0, first: None, bound }
    }

    fn counts(&self) -> Counts {
        let context = self.gpu.context();
        Counts {
            recorded: context.recorded(),
            printed: context.printed(),
            compiled: context.compiled(),
            kept: context.scene_bytes(),
            uploaded: context.uploaded_bytes(),
        }
    }

    /// Renders a frame; `uploads` is what a frame that is no longer counted as warm uploads.
    fn show(&mut self, kernel: &Kernel<'_, (Ray,), Vec4>, uploads: u64) -> Result<(), Error> {
        let camera = Pinhole::new(vec3(14.0, 11.0, 17.0), Vec3::splat(4.0), Vec3::Y, 0.6);
        let mut image = Image::filled(16, 16, Vec4::ZERO);
        self.gpu.frame(&camera, kernel, &mut image)?;
        if self.frames.is_multiple_of(COMPARED) {
            let mut expected = image.clone();
            TiledScheduler::new().variant(Variant::Scalar).frame(&camera, kernel, &mut expected);
            self.compare(&image, &expected);
        }
        let counts = self.counts();
        if self.frames >= self.warm {
            let first = *self.first.get_or_insert(counts);
            let since = (self.frames - self.warm) as u64;
            let uploaded = first.uploaded + since * uploads;
            assert_eq!(counts, Counts { uploaded, ..first }, "frame {}", self.frames);
        }
        self.frames += 1;
        Ok(())
    }

    /// Rounding may take a ray past the rim of a ball, here and there.
    fn compare(&self, found: &Image<Vec4>, expected: &Image<Vec4>) {
        let pixels = found.pixels().iter().zip(expected.pixels());
        let is_off = |(a, b): &(&Vec4, &Vec4)| (**a - **b).abs().max_element() > self.bound;
        let off: Vec<_> = pixels.filter(is_off).collect();
        assert!(off.len() <= 2, "frame {}: {off:?}", self.frames);
        let is_seen = |v: &Vec4| v.w > 0.0;
        let seen = expected.pixels().iter().copied().filter(|v| is_seen(v)).count();
        assert!(seen > 20, "frame {}: {seen} pixels show anything", self.frames);
    }
}

fn balls(seed: u64) -> Vec<Ball> {
    let mut rng = Rng::new(seed);
    let ball = |_| Ball { center: rng.point(8.0) + 4.0, radius: rng.range(0.2, 0.8) };
    (0..100).map(ball).collect()
}

/// What a device gets of a tree's nodes and balls, without the list of indices.
fn bytes(tree: &Bvh<'_, Ball>) -> u64 {
    (size_of_val(tree.nodes()) + size_of_val(tree.primitives())) as u64
}

#[test]
fn trees_made_ahead_take_turns() -> Result<(), Error> {
    let Some(gpu) = own_scheduler()? else { return Ok(()) };
    let balls: [Vec<Ball>; 8] = std::array::from_fn(|i| balls(i as u64));
    let trees = balls.iter().map(|b| Bvh::build(b)).collect::<Result<Vec<_>, _>>()?;
    // Each of the eight is uploaded once.
    let mut films = Films::new(gpu, 7, 1e-3);
    for i in 0..CHANGES {
        let tree = &trees[i % 8];
        let kernel = kernel!(|ray: Ray| {
            let hit = tree.closest_hit(ray);
            if !hit.is_hit {
                return vec4(0.0, 0.0, 0.0, 0.0);
            }
            let ball = tree.primitive(hit);
            let normal = ball.normal(ray, hit);
            vec4(normal.x, normal.y, normal.z, hit.t)
        });
        films.show(&kernel, 0)?;
    }
    assert_eq!((films.first.expect("frames").printed, films.frames), (1, CHANGES));
    Ok(())
}

#[test]
fn a_tree_is_refitted() -> Result<(), Error> {
    let Some(gpu) = own_scheduler()? else { return Ok(()) };
    let mut balls = balls(9);
    let mut films = Films::new(gpu, 0, 1e-3);
    let mut bvh = Bvh::build(&balls)?;
    for i in 0..CHANGES {
        let tree = bvh.detach();
        for (k, ball) in balls.iter_mut().enumerate() {
            ball.center += vec3((k + i) as f32, k as f32, i as f32).map(|x| x.sin() * 0.02);
        }
        bvh = tree.refit(&balls)?;
        let kernel = kernel!(|ray: Ray| {
            let hit = bvh.closest_hit(ray);
            let p = ray.at(if hit.is_hit { hit.t } else { 0.0 });
            vec4(p.x, p.y, p.z, if hit.is_hit { 1.0 } else { 0.0 })
        });
        films.show(&kernel, bytes(&bvh))?;
    }
    Ok(())
}

const SIZE: UVec3 = uvec3(9, 9, 9);

fn puff(seed: u64) -> Vec<u8> {
    let mut rng = Rng::new(seed);
    let voxel = |i: u32| {
        let at = uvec3(i % 9, i / 9 % 9, i / 81).as_vec3();
        (255.0 - 60.0 * at.distance(Vec3::splat(4.0)) + 50.0 * rng.unit()).clamp(0.0, 255.0) as u8
    };
    (0..SIZE.element_product()).map(voxel).collect()
}

fn smoke(density: f32) -> TransferFunction {
    let knots = [(20.0, 0.0), (120.0, 0.1 * density), (250.0, density)];
    let colors = [(0.0, vec3(0.9, 0.4, 0.1)), (255.0, vec3(0.2, 0.3, 0.9))];
    TransferFunction::from_extinction(&colors, &knots).expect("a function")
}

#[test]
fn a_transfer_function_is_edited() -> Result<(), Error> {
    let Some(gpu) = own_scheduler()? else { return Ok(()) };
    let voxels = puff(1);
    let grid = Grid::new(&voxels[..], SIZE, GridConfig::new())?;
    let mut volume = Volume::new(&grid, smoke(1.0));
    let exact = ExactCell::new();
    let mut films = Films::new(gpu, 0, 1e-4);
    for i in 0..CHANGES {
        volume.set_transfer(smoke(0.2 + 0.001 * i as f32));
        let kernel = kernel!(|ray: Ray| volume.integrate(&exact, ray, VolumeLight::new()).rgba());
        // The knots, with two far away, the 1025 bins by which they are found, and a majorant of
        // each macro-cell.
        let knots = size_of::<TransferKnot>() * (volume.transfer().knots().len() + 2);
        let bytes = knots + 4 * (1025 + volume.majorants().len());
        films.show(&kernel, bytes as u64)?;
    }
    Ok(())
}

#[test]
fn time_goes_on_between_two_steps() -> Result<(), Error> {
    let Some(gpu) = own_scheduler()? else { return Ok(()) };
    let steps: [Vec<u8>; 4] = std::array::from_fn(|i| puff(i as u64));
    let grid = |v| Grid::new(v, SIZE, GridConfig::new());
    let steps = steps.iter().map(|v| grid(&v[..])).collect::<Result<Vec<_>, _>>()?;
    let function = smoke(1.0);
    let exact = ExactCell::new();
    // The first three frames have all four steps.
    let mut films = Films::new(gpu, 3, 1e-4);
    for i in 0..CHANGES {
        let (step, share) = if i < 3 { (i, 0.5) } else { (i / 400, (i % 400) as f32 / 400.0) };
        let now = Grid::between(&steps[step], &steps[step + 1], share)?;
        let volume = Volume::new(&now, function.clone());
        let kernel = kernel!(|ray: Ray| volume.integrate(&exact, ray, VolumeLight::new()).rgba());
        films.show(&kernel, 4 * volume.majorants().len() as u64)?;
    }
    Ok(())
}
