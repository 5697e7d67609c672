//! A path tracer of a box with two blocks and a lamp: what a user of raydsl might write. Six
//! kernels over one tree: `respond`, `scatter`, `lamp_light` and `radiance` are functions, `film`
//! and `preview` closures.
//!
//! `path_tracer SAMPLES WIDTH` writes `path_tracer.ppm` and `path_tracer_preview.ppm`.

use std::error::Error;
use std::time::Instant;
use std::{env, fs, io};

use raydsl::kernel;
use raydsl::shading::facing;
use raydsl::prelude::*;
use raydsl::render::{Display, ToneMap};

/// Paths end here at the latest.
const MOST_BOUNCES: u32 = 12;

/// From this bounce on a path may end at random.
const SURE_BOUNCES: u32 = 3;

/// A side of the room, of a block, or of the lamp.
#[primitive(rectangle(corner, u_edge, v_edge))]
struct Wall {
    corner: Vec3,
    u_edge: Vec3,
    v_edge: Vec3,
    /// Its number in the list of materials.
    material: u32,
}

/// What light does at a surface: a share `gloss` of it goes near the direction of a mirror, the
/// rest in all directions.
#[derive(Clone, Copy, Debug, Type)]
#[repr(C)]
struct Material {
    /// How much comes back.
    color: Vec3,
    /// The share that is not matt.
    gloss: f32,
    /// What the front sends out by itself.
    emission: Vec3,
    /// How narrow the gloss is: the exponent of a power of a cosine.
    exponent: f32,
}

/// A direction that light comes from, and how much of it is sent on.
#[derive(Clone, Copy, Type)]
#[repr(C)]
struct Scattered {
    direction: Vec3,
    /// The density of this direction, per solid angle.
    density: f32,
    /// The share of the light that is sent on, with the cosine, over the density.
    weight: Vec3,
}

/// What a surface makes of light from one direction.
#[derive(Clone, Copy, Type)]
#[repr(C)]
struct Response {
    /// The share of the light that is sent on, with the cosine.
    value: Vec3,
    /// How dense `scatter` is there.
    density: f32,
}

/// What a surface that is seen along `seen` sends on of light that comes from `direction`.
#[kernel]
fn respond(material: Material, normal: Vec3, seen: Vec3, direction: Vec3) -> Response {
    let cosine = normal.dot(direction);
    if cosine <= 0.0 {
        return Response { value: vec3(0.0, 0.0, 0.0), density: 0.0 };
    }
    let matt = (1.0 - material.gloss) * cosine_hemisphere_pdf(cosine);
    let mut density = matt;
    if material.gloss > 0.0 {
        let mirrored = seen.reflect(normal);
        let along = clamp(mirrored.dot(direction), 0.0, 1.0);
        density += material.gloss * power_cosine_pdf(along, material.exponent);
    }
    Response { value: material.color * density, density }
}

/// Chooses where light comes from that a surface sends along `seen`, about as often as it matters.
#[kernel]
fn scatter(material: Material, normal: Vec3, seen: Vec3, choice: f32, u: Vec2) -> Scattered {
    let direction = if choice < material.gloss {
        let lobe = sample_power_cosine(u, material.exponent);
        Frame::around(seen.reflect(normal)).to_world(lobe)
    } else {
        Frame::around(normal).to_world(sample_cosine_hemisphere(u))
    };
    let response = respond(material, normal, seen, direction);
    let weight =
        if response.density > 0.0 { response.value / response.density } else { Vec3::ZERO };
    Scattered { direction, density: response.density, weight }
}

/// The light that a point sends along `seen` and that came from the lamp at once, by one point of
/// the lamp. It is weighed against paths that meet the lamp by chance.
#[kernel]
fn lamp_light(
    scene: &Bvh<'_, Wall>,
    lamp: Wall,
    emission: Vec3,
    material: Material,
    point: SurfacePoint,
    seen: Vec3,
    u: Vec2,
) -> Vec3 {
    let on_lamp = lamp.sample(u);
    let way = on_lamp.position - point.position;
    let direction = way.normalize();
    let response = respond(material, point.normal, seen, direction);
    let is_in_front = on_lamp.normal.dot(direction) < 0.0;
    let mut light = vec3(0.0, 0.0, 0.0);
    if is_in_front && response.density > 0.0 && !scene.any_hit(point.ray_between(on_lamp)) {
        let density = solid_angle_pdf(1.0 / lamp.area(), way, on_lamp.normal);
        let share = power_heuristic(1.0, density, 1.0, response.density);
        light = response.value * emission * (share / density);
    }
    light
}

/// The light that comes along a ray, by one path.
#[kernel]
fn radiance(
    scene: &Bvh<'_, Wall>,
    materials: &[Material],
    lamp: Wall,
    first: Ray,
    mut sampler: Sampler,
) -> Vec3 {
    let mut ray = first;
    let mut light = vec3(0.0, 0.0, 0.0);
    let mut throughput = vec3(1.0, 1.0, 1.0);
    // How dense the direction of the ray was; of the first one nobody else can have made it.
    let mut density = 0.0;
    for bounce in 0..MOST_BOUNCES {
        let hit = scene.closest_hit(ray);
        if !hit.is_hit {
            break;
        }
        let wall = scene.primitive(hit);
        let material = materials[wall.material as usize];
        let seen = ray.direction.normalize();
        let surface = wall.surface_point(ray, hit);
        if material.emission.max_element() > 0.0 && surface.normal.dot(seen) < 0.0 {
            let mut share = 1.0;
            if bounce > 0 {
                let way = surface.position - ray.origin;
                let of_lamp = solid_angle_pdf(1.0 / lamp.area(), way, surface.normal);
                share = power_heuristic(1.0, density, 1.0, of_lamp);
            }
            light += throughput * material.emission * share;
        }
        let point = facing(surface, seen);
        let emission = materials[lamp.material as usize].emission;
        let u = sampler.next_2d();
        let direct = lamp_light(scene, lamp, emission, material, point, seen, u);
        light += throughput * direct;
        let choice = sampler.next_1d();
        let scattered = scatter(material, point.normal, seen, choice, sampler.next_2d());
        throughput *= scattered.weight;
        density = scattered.density;
        let mut lives = throughput.max_element() > 0.0;
        if bounce >= SURE_BOUNCES {
            let chance = min(throughput.max_element(), 0.95);
            lives = lives && sampler.next_1d() < chance;
            throughput /= chance;
        }
        if !lives {
            break;
        }
        ray = point.ray(scattered.direction);
    }
    light
}

/// The materials that walls name by number.
const WHITE: u32 = 0;
const RED: u32 = 1;
const GREEN: u32 = 2;
const METAL: u32 = 3;
const LAMP: u32 = 4;

fn materials() -> Vec<Material> {
    let matt = |r: f32, g: f32, b: f32| Material {
        color: vec3(r, g, b),
        gloss: 0.0,
        emission: Vec3::ZERO,
        exponent: 1.0,
    };
    vec![
        matt(0.73, 0.73, 0.71),
        matt(0.65, 0.06, 0.05),
        matt(0.12, 0.45, 0.10),
        Material { gloss: 0.6, exponent: 60.0, ..matt(0.86, 0.80, 0.68) },
        Material { emission: vec3(17.0, 12.0, 6.0), ..matt(0.4, 0.4, 0.4) },
    ]
}

/// The five walls of the room: it is open to the camera.
fn room() -> Vec<Wall> {
    let (x, y, z) = (Vec3::X * 2.0, Vec3::Y * 2.0, Vec3::Z * 2.0);
    let wall = |corner: Vec3, u_edge: Vec3, v_edge: Vec3, material: u32| Wall {
        corner,
        u_edge,
        v_edge,
        material,
    };
    vec![
        wall(vec3(-1.0, 0.0, -1.0), z, x, WHITE), // floor
        wall(vec3(-1.0, 2.0, -1.0), x, z, WHITE), // ceiling
        wall(vec3(-1.0, 0.0, -1.0), x, y, WHITE), // back
        wall(vec3(-1.0, 0.0, -1.0), y, z, RED),   // left
        wall(vec3(1.0, 0.0, -1.0), z, y, GREEN),  // right
    ]
}

/// The six sides of a block that stands on the floor and is turned about the vertical.
fn block(center: Vec2, size: Vec3, turn: f32, material: u32) -> [Wall; 6] {
    let (sin, cos) = turn.sin_cos();
    let x = vec3(cos, 0.0, -sin) * size.x;
    let (y, z) = (Vec3::Y * size.y, vec3(sin, 0.0, cos) * size.z);
    // A little above the floor: two surfaces at one place are none.
    let low = vec3(center.x, 0.002, center.y) - 0.5 * (x + z);
    let side = |corner: Vec3, u_edge: Vec3, v_edge: Vec3| Wall { corner, u_edge, v_edge, material };
    [
        side(low, x, z),
        side(low + y, z, x),
        side(low, y, x),
        side(low + z, x, y),
        side(low, z, y),
        side(low + x, y, z),
    ]
}

/// The lamp under the ceiling, which shines downwards.
fn lamp() -> Wall {
    Wall {
        corner: vec3(-0.28, 1.995, -0.22),
        u_edge: Vec3::X * 0.56,
        v_edge: Vec3::Z * 0.44,
        material: LAMP,
    }
}

/// All eighteen rectangles.
fn walls() -> Vec<Wall> {
    let mut walls = room();
    walls.extend(block(vec2(0.36, 0.32), vec3(0.58, 0.58, 0.58), -0.29, WHITE));
    walls.extend(block(vec2(-0.34, -0.28), vec3(0.58, 1.22, 0.58), 0.32, METAL));
    walls.push(lamp());
    walls
}

/// What the command line says: how many samples a pixel has, and how wide the picture is.
struct Args {
    samples: u32,
    width: u32,
}

impl Args {
    fn parse() -> Result<Self, Box<dyn Error>> {
        let mut words = env::args().skip(1);
        let mut number = |otherwise: u32| words.next().map_or(Ok(otherwise), |word| word.parse());
        let args = Self { samples: number(64)?, width: number(400)? };
        if args.samples == 0 || !(16..=8192).contains(&args.width) {
            return Err("at least one sample, and a width from 16 to 8192".into());
        }
        Ok(args)
    }
}

/// Writes a picture of 8 bits; files begin with the top row.
fn write_ppm(path: &str, image: &Image<[Unorm8; 4]>) -> io::Result<()> {
    let mut bytes = format!("P6 {} {} 255\n", image.width(), image.height()).into_bytes();
    for row in image.rows().rev() {
        for pixel in row {
            bytes.extend(pixel[..3].iter().map(|channel| channel.to_bits()));
        }
    }
    fs::write(path, bytes)
}

fn main() -> Result<(), Box<dyn Error>> {
    let args = Args::parse()?;
    let (walls, materials, lamp) = (walls(), materials(), lamp());
    let scene = Bvh::build(&walls)?;
    let materials = &materials[..];
    let camera = Pinhole::new(vec3(0.0, 1.0, 4.1), vec3(0.0, 1.0, 0.0), Vec3::Y, 0.62);
    let scheduler = TiledScheduler::new();

    // What is seen first: its colour, darker where it is seen at a slant.
    let preview = kernel!(|ray: Ray| {
        let hit = scene.closest_hit(ray);
        let mut color = vec3(0.02, 0.02, 0.03);
        if hit.is_hit {
            let wall = scene.primitive(hit);
            let point = facing(wall.surface_point(ray, hit), ray.direction);
            let slant = -point.normal.dot(ray.direction.normalize());
            color = materials[wall.material as usize].color * (0.2 + 0.8 * slant);
        }
        color.extend(1.0)
    });
    let mut first = Image::filled(args.width, args.width, Vec4::ZERO);
    scheduler.frame(&camera, &preview, &mut first);
    write_ppm("path_tracer_preview.ppm", &Display::new().show(&first))?;

    // The mean of many paths. One that is far brighter than the lamp would be seen as a speck.
    let brightest = 10.0;
    let film = kernel!(|ray: Ray, sampler: Sampler| {
        let light = radiance(&scene, materials, lamp, ray, sampler);
        light.min(Vec3::splat(brightest))
    });
    let (start, mut picture) = (Instant::now(), Film::new(args.width, args.width));
    let sampling = Sampling::new(args.samples);
    scheduler.accumulate(&camera, &film, &sampling, &mut picture, args.samples);
    let seconds = start.elapsed().as_secs_f64();
    let paths = f64::from(args.width).powi(2) * f64::from(args.samples);
    println!("{:.2} million paths a second", paths / seconds * 1e-6);
    if picture.nan_pixels() > 0 {
        return Err("some light is no number".into());
    }
    let display = Display::new().tone_map(ToneMap::Reinhard { white: 4.0 }).exposure(1.2);
    write_ppm("path_tracer.ppm", &display.show(&picture.image()))?;
    Ok(())
}
