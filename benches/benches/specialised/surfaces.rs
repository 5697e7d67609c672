//! Scenes of surfaces, and the generic kernel that has every feature of theirs.

use raydsl::bsdf::{Coated, Eon, Lambert, Luminous, NO_LIGHT};
use raydsl::integrators::{PathLimits, ambient_occlusion, path};
use raydsl::kernel;
use raydsl::light::{
    AnyLight, AreaLight, DirectionalLight, DiskShape, Environment, Lights, PointLight,
    RectangleShape, SphereShape, SpotLight,
};
use raydsl::prelude::*;
use raydsl::shading::Surface;
use raydsl::texture::AsTextureRef;
use raydsl_examples::shown::{self, Shown};
use raydsl_examples::{blocks, cornell};
use raydsl_tests::scenes::{ColorSphere, spheres};

use super::{Bench, Error, Row};

/// Declares coloured primitives, and the enum of all of them.
macro_rules! shapes {
    ($($name:ident($make:ident($($member:ident: $t:ty),+));)+) => {
        $(
            #[primitive($make($($member),+))]
            pub(super) struct $name {
                $(pub(super) $member: $t,)+
                pub(super) color: Vec3,
            }

            #[kernel]
            impl Surface for $name {
                fn surface(&self, ray: Ray, hit: Hit) -> SurfacePoint {
                    self.surface_point(ray, hit)
                }

                fn albedo(&self, _ray: Ray, _hit: Hit) -> Vec3 {
                    self.color
                }
            }
        )+

        /// Any of them.
        #[primitive(Surface)]
        pub(super) enum Shape {
            $($name($name),)+
        }
    };
}

shapes! {
    Ball(sphere(center: Vec3, radius: f32));
    Plate(disk(center: Vec3, normal: Vec3, radius: f32));
    Panel(rectangle(corner: Vec3, u_edge: Vec3, v_edge: Vec3));
    Can(cylinder(p0: Vec3, p1: Vec3, radius: f32));
    Block(cuboid(min: Vec3, max: Vec3));
    Face(triangle(v0: Vec3, v1: Vec3, v2: Vec3));
}

/// One of each, tiny, where no ray comes.
fn hidden(at: Vec3) -> [Shape; 6] {
    let (size, color) = (1e-3, Vec3::ONE);
    let [x, y, z] = [Vec3::X, Vec3::Y, Vec3::Z].map(|v| v * size);
    [
        Shape::Ball(Ball { center: at, radius: size, color }),
        Shape::Plate(Plate { center: at, normal: Vec3::Y, radius: size, color }),
        Shape::Panel(Panel { corner: at, u_edge: x, v_edge: z, color }),
        Shape::Can(Can { p0: at, p1: at + y, radius: size, color }),
        Shape::Block(Block { min: at - x - y - z, max: at, color }),
        Shape::Face(Face { v0: at, v1: at + x, v2: at + y, color }),
    ]
}

fn faces(triangles: &[Triangle]) -> Vec<Shape> {
    let face = |t: &Triangle| Face { v0: t.v0, v1: t.v1, v2: t.v2, color: Vec3::ONE };
    triangles.iter().map(|t| Shape::Face(face(t))).collect()
}

/// One of each kind, which shine not at all.
fn dark() -> [AnyLight; 7] {
    let (a, b, c, none) = (Vec3::X, Vec3::Y, Vec3::Z, Vec3::ZERO);
    let shape = SphereShape { center: a, radius: 1.0 };
    let rectangle = RectangleShape { corner: a, u_edge: b, v_edge: c };
    let triangle = Triangle { v0: a, v1: b, v2: c };
    let disk = DiskShape { center: a, normal: b, radius: 1.0 };
    let (position, direction, intensity, radiance) = (a, c, none, none);
    let (cos_inner, cos_outer, is_two_sided) = (0.9, 0.8, true);
    [
        AnyLight::Point(PointLight { position, intensity }),
        AnyLight::Spot(SpotLight { position, intensity, direction, cos_inner, cos_outer }),
        AnyLight::Directional(DirectionalLight { direction, irradiance: none, sine: 0.1 }),
        AnyLight::Sphere(AreaLight { shape, radiance, is_two_sided }),
        AnyLight::Rectangle(AreaLight { shape: rectangle, radiance, is_two_sided }),
        AnyLight::Triangle(AreaLight { shape: triangle, radiance, is_two_sided }),
        AnyLight::Disk(AreaLight { shape: disk, radiance, is_two_sided }),
    ]
}

/// What a primitive is made of: numbers of a material and of a light.
#[derive(Clone, Copy, Debug, Type)]
struct Part {
    material: u32,
    light: u32,
}

const COLORS: u32 = 0;
const OCCLUSION: u32 = 1;
const PATHS: u32 = 2;

#[kernel]
#[expect(clippy::too_many_arguments, reason = "a renderer of everything captures everything")]
fn everything(
    scene: &Bvh<'_, Shape>,
    parts: &[Part],
    materials: &[Shown],
    paint: &TextureRef2<'_, f32>,
    lights: &Lights<'_, AnyLight>,
    task: u32,
    radius: f32,
    limits: PathLimits,
    ray: Ray,
    sampler: Sampler,
) -> Vec4 {
    if task == COLORS {
        let hit = scene.closest_hit(ray);
        let color = scene.shading_point(ray, hit).albedo;
        return if hit.is_hit {
            vec4(color.x, color.y, color.z, 1.0)
        } else {
            vec4(0.0, 0.0, 0.0, 0.0)
        };
    }
    if task == OCCLUSION {
        return ambient_occlusion::<_, 4>(scene, radius, ray, sampler);
    }
    let surface = |hit: Hit, point: ShadingPoint| {
        let part = parts[hit.prim_id as usize % parts.len()];
        let painted = tex2(paint, point.uv) as u32;
        let bsdf = materials[(part.material + painted) as usize % materials.len()];
        Luminous::<Shown> { bsdf, light: part.light }
    };
    path::<_, _, Luminous<Shown>>(scene, surface, lights, limits, ray, sampler).color
}

/// What the generic kernel of surfaces is given, beside one of every kind.
struct Surfaces {
    shapes: Vec<Shape>,
    hidden: Vec3,
    parts: Vec<Part>,
    materials: Vec<Shown>,
    lights: Vec<AnyLight>,
    sky: Vec3,
    /// Two rows of two texels: what is added to numbers of materials.
    paint: [f32; 4],
    task: u32,
    radius: f32,
    limits: PathLimits,
}

impl Surfaces {
    /// Measures a specialised kernel beside the generic one.
    fn beside(
        self,
        bench: &Bench<'_>,
        shot: (Pinhole, u32),
        specialised: &Kernel<'_, (Ray, Sampler), Vec4>,
    ) -> Result<Vec<Row>, Error> {
        let Surfaces { task, radius, limits, .. } = self;
        let shapes = [self.shapes, hidden(self.hidden).to_vec()].concat();
        let parts = &self.parts[..];
        let shown = shown::all().into_iter().map(|(_, shown)| shown);
        let materials: Vec<Shown> = self.materials.into_iter().chain(shown).collect();
        let materials = &materials[..];
        let scene = Bvh::build(&shapes)?;
        let (sky, list) =
            (Environment::constant(self.sky)?, [self.lights, dark().to_vec()].concat());
        let lights = Lights::new(&list, scene.bounds())?.with_environment(&sky);
        let texture = Texture2::new(&self.paint, [2, 2], TextureConfig::new())?;
        let paint = texture.as_texture_ref();
        let generic = kernel!(|ray: Ray, sampler: Sampler| everything(
            &scene, parts, materials, &paint, &lights, task, radius, limits, ray, sampler
        ));
        bench.measure(shot, specialised, &generic)
    }
}

pub(super) fn points(bench: &Bench<'_>) -> Result<Vec<Row>, Error> {
    let small =
        |s: ColorSphere| ColorSphere { radius: Unorm8::from_bits(s.radius.to_bits() / 4), ..s };
    let spheres: Vec<ColorSphere> = spheres(20_000).into_iter().map(small).collect();
    let bvh = Bvh::build(&spheres)?;
    let kernel = kernel!(|ray: Ray, _sampler: Sampler| {
        let hit = bvh.closest_hit(ray);
        let color = bvh.primitive(hit).rgb();
        if hit.is_hit { vec4(color.x, color.y, color.z, 1.0) } else { vec4(0.0, 0.0, 0.0, 0.0) }
    });
    let ball =
        |s: &ColorSphere| Ball { center: s.center, radius: s.radius.to_f32(), color: s.rgb() };
    let largest = spheres.iter().max_by_key(|s| s.radius.to_bits()).ok_or("there are spheres")?;
    let shapes = spheres.iter().map(|s| Shape::Ball(ball(s))).collect();
    let all = Surfaces { shapes, ..surfaces(COLORS, largest.center) };
    let camera = Pinhole::new(vec3(0.0, 0.0, 13.0), Vec3::ZERO, Vec3::Y, 0.8);
    all.beside(bench, (camera, 1), &kernel)
}

/// A scene of nothing yet.
fn surfaces(task: u32, hidden: Vec3) -> Surfaces {
    Surfaces {
        shapes: Vec::new(),
        hidden,
        parts: vec![Part { material: 0, light: NO_LIGHT }],
        materials: Vec::new(),
        lights: Vec::new(),
        sky: Vec3::ZERO,
        paint: [0.0; 4],
        task,
        radius: 1.0,
        limits: PathLimits::new(6),
    }
}

pub(super) fn occlusion(bench: &Bench<'_>) -> Result<Vec<Row>, Error> {
    let triangles = blocks::pile(400);
    let scene = Bvh::build(&triangles)?;
    let radius = 0.5;
    let kernel = kernel!(|ray: Ray, sampler: Sampler| {
        ambient_occlusion::<_, 4>(&scene, radius, ray, sampler)
    });
    let shapes = faces(&triangles);
    let all = Surfaces { shapes, radius, ..surfaces(OCCLUSION, IN_FLOOR) };
    all.beside(bench, (above(), 4), &kernel)
}

/// A point in the floor that blocks stand on, and a view of them.
const IN_FLOOR: Vec3 = Vec3::new(0.0, -0.1, 0.0);

fn above() -> Pinhole {
    Pinhole::new(vec3(5.0, 5.0, 9.0), vec3(0.0, 0.5, 0.0), Vec3::Y, 0.8)
}

pub(super) fn diffuse_paths(bench: &Bench<'_>) -> Result<Vec<Row>, Error> {
    let walls = cornell::walls();
    let lamps = cornell::lamps(&walls);
    let scene = Bvh::build(&walls)?;
    let lights = Lights::new(&lamps, scene.bounds())?;
    let limits = PathLimits::new(6);
    let kernel = kernel!(|ray: Ray, sampler: Sampler| {
        let surface = |hit: Hit, _point: ShadingPoint| scene.primitive(hit).material();
        path::<_, _, Luminous<Lambert>>(&scene, surface, &lights, limits, ray, sampler).color
    });
    let triangle = |w: &cornell::Wall| Triangle { v0: w.v0, v1: w.v1, v2: w.v2 };
    let part = |(i, w): (usize, &cornell::Wall)| Part { material: i as u32, light: w.light };
    let all = Surfaces {
        shapes: faces(&walls.iter().map(triangle).collect::<Vec<_>>()),
        parts: walls.iter().enumerate().map(part).collect(),
        materials: walls.iter().map(|w| Shown::Lambert(Lambert { color: w.color })).collect(),
        lights: lamps.iter().copied().map(AnyLight::Triangle).collect(),
        limits,
        // Under the floor: rays leave the box by its open side alone.
        ..surfaces(PATHS, vec3(278.0, -50.0, 300.0))
    };
    all.beside(bench, (cornell::camera(), 4), &kernel)
}

/// Blocks of one of two plastics, by a texture, under a lamp and a sky.
pub(super) fn coated_paths(bench: &Bench<'_>) -> Result<Vec<Row>, Error> {
    let coated = |color| Coated::<Eon> {
        base: Eon { color, roughness: 0.5 },
        ior: 1.5,
        alpha: 0.2,
        strength: Vec3::ONE,
    };
    let plastics = [coated(vec3(0.7, 0.2, 0.1)), coated(vec3(0.1, 0.3, 0.7))];
    let materials = &plastics[..];
    let texels = [0.0, 1.0, 1.0, 0.0];
    let squares = Texture2::new(&texels, [2, 2], TextureConfig::new())?;
    let paint = squares.as_texture_ref();
    let triangles = blocks::pile(100);
    let scene = Bvh::build(&triangles)?;
    let lamp = PointLight { position: vec3(3.0, 6.0, 4.0), intensity: Vec3::splat(60.0) };
    let (lamps, blue) = ([lamp], vec3(0.3, 0.4, 0.6));
    let sky = Environment::constant(blue)?;
    let lights = Lights::new(&lamps, scene.bounds())?.with_environment(&sky);
    let limits = PathLimits::new(6);
    let kernel = kernel!(|ray: Ray, sampler: Sampler| {
        let surface = |_hit: Hit, point: ShadingPoint| {
            materials[tex2(&paint, point.uv) as u32 as usize % materials.len()]
        };
        path::<_, _, Coated<Eon>>(&scene, surface, &lights, limits, ray, sampler).color
    });
    let all = Surfaces {
        shapes: faces(&triangles),
        materials: materials.iter().map(|m| Shown::Plastic(*m)).collect(),
        lights: vec![AnyLight::Point(lamp)],
        sky: blue,
        paint: texels,
        limits,
        ..surfaces(PATHS, IN_FLOOR)
    };
    all.beside(bench, (above(), 4), &kernel)
}
