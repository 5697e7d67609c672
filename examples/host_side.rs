//! The program of the book's chapter "The host's side": a knot at dusk, lit by three lamps.
//!
//! `cargo run --release --example host_side -- FOLDER` writes `host_side.png` to FOLDER (`out` if
//! none is given), and what the variants give to `FOLDER/host_side`.

use std::error::Error;
use std::path::PathBuf;
use std::{env, fs};

// ANCHOR: imports
use raydsl::bvh::BuildConfig;
use raydsl::camera::Camera;
use raydsl::prelude::*;
use raydsl::{assert_variants_agree, kernel};
use raydsl_report::Compare;
// ANCHOR_END: imports
use raydsl_examples::picture::reduced;

const TAU: f32 = std::f32::consts::TAU;

/// A lamp is a ball that is seen, and shines.
#[primitive]
struct Lamp {
    center: Vec3,
    radius: f32,
    color: Vec3,
}

#[primitive]
impl Lamp {
    fn intersect(&self, ray: Ray) -> Hit {
        sphere::intersect(ray, self.center, self.radius)
    }

    fn get_bounds(&self) -> Aabb {
        Aabb::from_sphere(self.center, self.radius)
    }
}

/// A mesh as applications have it: vertices, and three of them for each face.
#[derive(Default)]
struct Mesh {
    places: Vec<Vec3>,
    normals: Vec<Vec3>,
    faces: Vec<[u32; 3]>,
}

impl Mesh {
    /// Adds a surface over (u, v) in [0, 1]², in `m` by `n` patches.
    fn add(&mut self, (m, n): (u32, u32), surface: impl Fn(f32, f32) -> (Vec3, Vec3)) {
        let first = self.places.len() as u32;
        for (i, j) in (0..=n).flat_map(|j| (0..=m).map(move |i| (i, j))) {
            let (place, normal) = surface(i as f32 / m as f32, j as f32 / n as f32);
            self.places.push(place);
            self.normals.push(normal);
        }
        for (i, j) in (0..n).flat_map(|j| (0..m).map(move |i| (i, j))) {
            let a = first + j * (m + 1) + i;
            self.faces.extend([[a, a + 1, a + m + 2], [a, a + m + 2, a + m + 1]]);
        }
    }

    fn triangles(&self) -> Vec<Triangle> {
        let corner = |i: u32| self.places[i as usize];
        let triangle =
            |&[a, b, c]: &[u32; 3]| Triangle { v0: corner(a), v1: corner(b), v2: corner(c) };
        self.faces.iter().map(triangle).collect()
    }
}

/// The trefoil knot as a tube.
fn knot(u: f32, v: f32) -> (Vec3, Vec3) {
    let center = |t: f32| {
        let (s, c) = (t * TAU).sin_cos();
        let (s2, c2) = (2.0 * t * TAU).sin_cos();
        vec3(s + 2.0 * s2, 1.75 - 0.9 * (3.0 * t * TAU).sin(), c - 2.0 * c2) * 0.62
    };
    let along = (center(u + 1e-3) - center(u - 1e-3)).normalize();
    let side = along.cross(Vec3::Y).normalize();
    let (s, c) = (v * TAU).sin_cos();
    let normal = side * c + along.cross(side) * s;
    (center(u) + normal * 0.29, normal)
}

const SKY: Vec3 = vec3(0.2, 0.24, 0.34);

// ANCHOR: direction
/// The `i`-th of `n` directions around `normal`, spread by the cosine.
#[kernel]
fn direction(normal: Vec3, i: u32, n: u32) -> Vec3 {
    let share = (i as f32 + 0.5) / n as f32;
    let SinCos { sin, cos } = sincos_2pi(i as f32 * 0.618034);
    let (x, y) = normal.any_orthonormal_pair();
    (x * cos + y * sin) * share.sqrt() + normal * (1.0 - share).sqrt()
}
// ANCHOR_END: direction

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(env::args().nth(1).unwrap_or_else(|| "out".to_owned()));
    fs::create_dir_all(&folder)?;

    let mut mesh = Mesh::default();
    mesh.add((480, 48), knot);
    let knot_faces = mesh.faces.len() as u32;
    mesh.add((150, 150), |u, v| (vec3(24.0 * u - 12.0, 0.0, 6.0 - 24.0 * v), Vec3::Y));
    let lamp = |x, y, z, color: Vec3| Lamp { center: vec3(x, y, z), radius: 0.16, color };
    let lamps = vec![
        lamp(-2.0, 2.3, -0.4, vec3(2.6, 1.7, 0.8)),
        lamp(-2.1, 0.16, 1.6, vec3(0.3, 0.6, 1.2)),
        lamp(2.2, 0.16, 1.2, vec3(1.2, 0.3, 0.35)),
    ];

    // ANCHOR: build
    let triangles = mesh.triangles();
    let config = BuildConfig { max_leaf_size: 8, ..BuildConfig::default() };
    let bvh = Bvh::build_with(&triangles, &config)?;
    println!("{} triangles, {} nodes", bvh.primitives().len(), bvh.nodes().len());
    // ANCHOR_END: build

    // ANCHOR: bake
    let daylight = kernel!(|at: Vec3, normal: Vec3| {
        let mut seen = 0.0;
        for part in 0..8u32 {
            let hidden = bvh.any_hit_each::<16>(|i: u32| {
                Ray::new(at, direction(normal, 16 * part + i, 128)).with_range(0.002, 8.0)
            });
            for is_hidden in hidden {
                seen += if is_hidden { 0.0 } else { 1.0 };
            }
        }
        seen / 128.0
    });
    // ANCHOR_END: bake

    // ANCHOR: batch
    let inputs: Vec<(Vec3, Vec3)> =
        mesh.places.iter().copied().zip(mesh.normals.iter().copied()).collect();
    let mut light = vec![0.0; inputs.len()];
    daylight.run(Variant::widest(), &inputs, &mut light);
    // ANCHOR_END: batch

    // The light of some vertices once more, on a device.
    // ANCHOR: gpu_batch
    match GpuScheduler::new() {
        Ok(gpu) => {
            let mut found = vec![0.0; 1000];
            let timing = gpu.batch(&daylight, &inputs[..1000], &mut found)?;
            let same = found.iter().zip(&light).filter(|(a, b)| a == b).count();
            println!(
                "{same} of 1000 vertices are the same on the device, {:.1} ms",
                timing.wall_ms
            );
        }
        Err(error) => println!("{error}"),
    }
    // ANCHOR_END: gpu_batch

    // ANCHOR: primary
    let (normals, faces) = (&mesh.normals, &mesh.faces);
    let primary = kernel!(|ray: Ray| {
        let hit = bvh.closest_hit(ray);
        let glow = lamps.closest_hit(ray);
        if glow.is_hit && !(hit.is_hit && hit.t < glow.t) {
            let color = lamps.primitive(glow).color * 0.25 + 0.7;
            return Shaded { color, depth: glow.t, id: 0xffff_0000u32 + glow.prim_id };
        }
        if !hit.is_hit {
            return Shaded { color: SKY, depth: f32::MAX, id: 0xffff_ffffu32 };
        }
        let corners = faces[hit.prim_id as usize];
        let (a, b, c) = (corners[0] as usize, corners[1] as usize, corners[2] as usize);
        let w = 1.0 - hit.u - hit.v;
        let normal = (normals[a] * w + normals[b] * hit.u + normals[c] * hit.v).normalize();
        let at = ray.at(hit.t) + normal * 0.002;
        let mut sum = SKY * (light[a] * w + light[b] * hit.u + light[c] * hit.v);
        for lamp in &lamps {
            let to = lamp.center - at;
            let cosine = normal.dot(to) / to.length();
            if cosine > 0.0 && !bvh.any_hit(Ray::new(at, to).with_range(0.0, 1.0)) {
                sum += lamp.color * (0.9 * cosine / (0.2 + to.dot(to)));
            }
        }
        if hit.prim_id < knot_faces {
            sum *= vec3(0.95, 0.7, 0.42);
        }
        let color = 1.0 - vec3(exp(-2.0 * sum.x), exp(-2.0 * sum.y), exp(-2.0 * sum.z));
        Shaded { color, depth: hit.t, id: hit.prim_id }
    });
    // ANCHOR_END: primary

    // ANCHOR: frame
    let camera = Pinhole::new(vec3(0.0, 5.2, 5.6), vec3(0.0, 0.9, 0.1), Vec3::Y, 0.6);
    let mut image = Image::new(1280, 800);
    TiledScheduler::new().frame(&camera, &primary, &mut image);
    reduced(&image, 2).write_png(folder.join("host_side.png"))?;
    // ANCHOR_END: frame

    // ANCHOR: other_result
    let mut depth = Image::filled(320, 200, 0.0);
    let distance = kernel!(|ray: Ray| bvh.closest_hit(ray).t);
    SimpleScheduler::new().variant(Variant::Packet8).frame(&camera, &distance, &mut depth);
    // ANCHOR_END: other_result

    // ANCHOR: ray
    let rays = camera.begin_frame(320, 200);
    let ray = rays.primary_ray(160.5, 100.5);
    let hit = bvh.closest_hit(ray);
    println!("pixel (160, 100): t = {} of face {}", hit.t, hit.prim_id);
    assert_eq!(hit.t, distance.call((ray,)));
    assert_eq!(hit.t, depth.pixels()[100 * 320 + 160]);
    println!("without rounding: t = {:?}", distance.reference((ray,)));
    // ANCHOR_END: ray

    // ANCHOR: pixels
    let jittered = kernel!(|x: u32, y: u32| {
        let mut rng = Rng::new(uvec2(x, y), 0, 1);
        let u = rng.next_2d();
        let hit = bvh.closest_hit(rays.primary_ray(x as f32 + u.x, y as f32 + u.y));
        hit.is_hit && hit.prim_id < knot_faces
    });
    let pixels: Vec<(u32, u32)> = (0..320 * 200).map(|i| (i % 320, i / 320)).collect();
    let mut seen = vec![false; pixels.len()];
    jittered.run(Variant::widest(), &pixels, &mut seen);
    // ANCHOR_END: pixels
    println!("{} of {} rays hit the knot", seen.iter().filter(|s| **s).count(), seen.len());

    // ANCHOR: compare
    let found = Compare::new().size(320, 200).runs(3).run(&primary, &camera);
    println!("{}", found.table());
    found.write(folder.join("host_side"))?;
    // ANCHOR_END: compare

    // ANCHOR: agree
    assert_variants_agree!(&daylight, &inputs[..500]);
    // ANCHOR_END: agree
    Ok(())
}
