//! A kernel in an application that has its own wgpu device. Learn here how a frame stays on the
//! device, in a buffer of the application, whose own shader goes on with it.
//!
//! `cargo run --release --example own_device -- FOLDER` writes `own_device.png` to FOLDER (`out` if
//! none is given). The device must run compute shaders.

mod glow;

use std::error::Error;
use std::path::PathBuf;
use std::{env, fs};

use glow::Glow;
use raydsl::gpu::{Context, GpuWindow};
use raydsl::kernel;
use raydsl::prelude::*;

const SIZE: (u32, u32) = (960, 540);

#[primitive(sphere(center, radius))]
struct Lamp {
    center: Vec3,
    radius: f32,
    light: Vec3,
}

/// A spiral of lamps that floats over a floor.
fn spiral() -> Vec<Lamp> {
    let lamp = |i: u32| {
        let t = i as f32 / 119.0;
        let (angle, reach) = (26.0 * t, 0.6 + 4.2 * t);
        let center =
            vec3(reach * angle.cos(), 0.5 + 2.6 * (1.0 - t) * (1.0 - t), reach * angle.sin());
        let hue = vec3(6.3 * t, 6.3 * t + 2.1, 6.3 * t + 4.2);
        let color = 0.55 + 0.45 * vec3(hue.x.sin(), hue.y.sin(), hue.z.sin());
        let light = color * if i.is_multiple_of(4) { 5.0 } else { 0.5 };
        Lamp { center, radius: 0.07 + 0.1 * t, light }
    };
    (0..120).map(lamp).collect()
}

/// The light of a lamp, brighter where it is seen from the front, or of the sky.
#[kernel]
fn light(lamps: &Bvh<'_, Lamp>, ray: Ray) -> Vec3 {
    let hit = lamps.closest_hit(ray);
    if !hit.is_hit {
        return vec3(0.02, 0.03, 0.06) * (1.2 - max(ray.direction.y, 0.0));
    }
    let lamp = lamps.primitive(hit);
    lamp.light * (0.25 + 0.75 * lamp.normal(ray, hit).dot(ray.direction).abs())
}

/// The same, with a floor that mirrors, more so at flat angles, and has waves.
#[kernel]
fn seen(lamps: &Bvh<'_, Lamp>, ray: Ray) -> Vec4 {
    let down = -ray.origin.y / ray.direction.y;
    let mut color = light(lamps, ray);
    let hit = lamps.closest_hit(ray);
    if down > 0.0 && !(hit.is_hit && hit.t < down) {
        let at = ray.at(down);
        let wave = sin(9.0 * at.x + 2.0 * sin(3.0 * at.z)) * 0.012;
        let normal = vec3(wave, 1.0, 0.7 * wave).normalize();
        let away = 1.0 + normal.dot(ray.direction);
        let share = 0.15 + 0.85 * away * away * away;
        color = light(lamps, Ray::new(at, ray.direction.reflect(normal))) * share;
    }
    vec4(color.x, color.y, color.z, 1.0)
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(env::args().nth(1).unwrap_or_else(|| "out".to_owned()));
    fs::create_dir_all(&folder)?;
    let lamps = spiral();
    let bvh = Bvh::build(&lamps)?;
    let camera = Pinhole::new(vec3(0.0, 3.6, 8.6), vec3(0.0, 0.75, 0.0), Vec3::Y, 0.6);
    let kernel = kernel!(|ray: Ray| seen(&bvh, ray));

    // ANCHOR: device
    // What the application has: a device, a queue, a buffer, and a shader that reads the buffer.
    let instance =
        wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle().with_env());
    let adapter = pollster::block_on(instance.request_adapter(&Default::default()))?;
    let (device, queue) = pollster::block_on(adapter.request_device(&Default::default()))?;
    let size = u64::from(SIZE.0 * SIZE.1) * size_of::<Vec4>() as u64;
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("light"),
        size,
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let glow = Glow::new(&device, &buffer, SIZE);

    // Rays on that device; their light stays in that buffer.
    let gpu = GpuScheduler::with_context(Context::from_wgpu(None, device.clone(), queue.clone()));
    let window = GpuWindow { buffer, offset: 0, size };
    let timing = gpu.frame_into(&camera, &kernel, SIZE, &window)?;
    println!("{}: {:.1} ms", gpu.context().adapter_name(), timing.wall_ms);
    let picture = glow.run(&device, &queue)?;
    // ANCHOR_END: device
    image::save_buffer(
        folder.join("own_device.png"),
        &picture,
        SIZE.0,
        SIZE.1,
        image::ExtendedColorType::Rgba8,
    )?;
    Ok(())
}
