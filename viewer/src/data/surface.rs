//! Triangles with materials and lights.

mod balls;

use std::path::Path;

use glam::Affine3A;
use raydsl::integrators::{
    PathLimits, PathOptions, PathSample, ambient_occlusion, bvh_cost_color, path_with, whitted,
};
use raydsl::light::{AnyLight, DirectionalLight, Environment, Lights, LightsError};
use raydsl::prelude::*;
use raydsl::shading::{Mesh, MeshAttributes};
use raydsl_examples::model::{Met, Model, met};
use raydsl_io::scene::{self, Projection, Scene as File};
use raydsl_scenes::Pose;

use super::{Failure, Serve, Teller, file_name};
use crate::look::{Kind, Look, Mode, Show};
use crate::subject::{Info, Picked, Subject, SubjectKernel};

/// Loads a scene with materials and serves it.
pub(super) fn open_scene(
    path: &Path,
    teller: &Teller<'_>,
    serve: Serve<'_>,
) -> Result<(), Failure> {
    show(file_name(path), scene::load(path)?, None, teller, serve)
}

/// Loads an environment, and serves two balls in it: a mirror and a white one.
pub(super) fn open_environment(
    path: &Path,
    teller: &Teller<'_>,
    serve: Serve<'_>,
) -> Result<(), Failure> {
    let sky = load_environment(path)?;
    show(file_name(path), balls::balls(), Some(sky), teller, serve)
}

/// Loads the light of all directions.
pub(crate) fn load_environment(path: &Path) -> Result<Environment, Failure> {
    let file = raydsl_io::environment::load(path)?;
    Ok(Environment::new(&file.texels, uvec2(file.width, file.height))?)
}

/// Loads triangles, of one rough material, and serves them.
pub(super) fn open_mesh(path: &Path, teller: &Teller<'_>, serve: Serve<'_>) -> Result<(), Failure> {
    let mesh = raydsl_io::mesh::load(path)?;
    let color = Vec3::splat(0.7);
    let material = scene::Material {
        base_color: color.extend(1.0),
        metallic: 0.0,
        specular: 0.0,
        ..Default::default()
    };
    let file = File {
        meshes: vec![scene::SceneMesh {
            positions: mesh.vertices,
            normals: mesh.normals,
            triangles: mesh.triangles,
            ..Default::default()
        }],
        materials: vec![material],
        instances: vec![scene::Instance {
            name: String::new(),
            mesh: 0,
            transform: Affine3A::IDENTITY,
        }],
        ..Default::default()
    };
    show(file_name(path), file, None, teller, serve)
}

/// The file's first camera that has a perspective, or one that sees all. Orbits turn around the
/// world's up, not around that of a camera that looks down; that one is taken at the pole only.
fn home(file: &File, bounds: Aabb, up: Vec3) -> Pose {
    let all = Pose::of_box(bounds, up, vec3(0.45, 0.4, 0.8));
    for c in &file.cameras {
        if let Projection::Perspective { vertical, .. } = c.projection {
            let away = c.position.distance(bounds.center()).max(1e-3 * bounds.size().length());
            let target = c.position + c.forward * away;
            // An animation goes back to the camera of before, which has to be one that is not refused.
            let (least, most) = crate::edit::FIELDS_OF_VIEW;
            let fov_y = vertical.clamp(least, most);
            let pose = Pose { eye: c.position, target, up, fov_y };
            let tries = [pose, Pose { up: c.up, ..pose }, all];
            return tries.into_iter().find(Pose::is_valid).unwrap_or(all);
        }
    }
    all
}

/// Which way is up in files of surfaces.
const UP: Vec3 = Vec3::Y;

/// What has no lamps gets a sun beside the sky.
fn sun() -> AnyLight {
    let direction = (UP + vec3(0.5, 0.1, 0.4)).normalize_or(UP);
    let irradiance = vec3(1.6, 1.5, 1.3);
    AnyLight::Directional(DirectionalLight { direction, irradiance, sine: 0.02 })
}

fn show(
    name: String,
    file: File,
    sky: Option<Environment>,
    teller: &Teller<'_>,
    serve: Serve<'_>,
) -> Result<(), Failure> {
    let model = Model::new(&file);
    let bounds = model.bounds();
    let home = home(&file, bounds, UP);
    let names: Vec<String> = file.materials.iter().map(|m| m.name.clone()).collect();
    // The model has its own triangles and pictures.
    drop(file);
    let is_dark = model.lights.is_empty() && sky.is_none();
    let own = if is_dark { vec3(0.45, 0.52, 0.6) } else { Vec3::ZERO };
    let sky = sky.map_or_else(|| Environment::constant(own), Ok)?;
    let sun = [sun()];
    let lamps = if is_dark { &sun[..] } else { &model.lights[..] };
    let config = BuildConfig::default();
    let tree = Bvh::build_observed(&model.triangles, &model.positions, &config, |done| {
        teller.tell("building the tree", done)
    })?;
    let attributes = MeshAttributes {
        normals: &model.normals,
        uvs: &model.uvs,
        colors: &model.colors,
        materials: &model.materials,
        ..Default::default()
    };
    let mesh = Mesh::new(&tree, attributes)?;
    let size = format!(
        "{} triangles, {} materials, {} lights",
        model.triangles.len(),
        model.looks.len(),
        model.lights.len()
    );
    let info = Info::of_scene(Kind::Surface, name, size, home, bounds);
    let own = OwnLight { lamps, sky: &sky, bounds };
    // What is wrong with the file's own lights is said before anything is shown.
    lit(lamps, &sky, bounds)?;
    serve(info, &mut Surface { model: &model, mesh: &mesh, tree: &tree, own, names });
    Ok(())
}

/// The light that a file brings, or what it gets without any.
struct OwnLight<'a> {
    lamps: &'a [AnyLight],
    sky: &'a Environment,
    bounds: Aabb,
}

/// Joins lamps and a sky.
fn lit<'a>(
    lamps: &'a [AnyLight],
    sky: &'a Environment,
    bounds: Aabb,
) -> Result<Lights<'a, AnyLight>, LightsError> {
    Ok(Lights::new(lamps, bounds)?.with_tree()?.with_environment(sky))
}

struct Surface<'a> {
    model: &'a Model,
    mesh: &'a Mesh<'a, Bvh<'a, IndexedTriangle>>,
    tree: &'a Bvh<'a, IndexedTriangle>,
    own: OwnLight<'a>,
    names: Vec<String>,
}

/// How often light is scattered at most.
const BOUNCES: u32 = 6;
/// The number of tests that is the hot end of the heat map.
const MOST_TESTS: f32 = 150.0;

impl Subject for Surface<'_> {
    fn with_kernel(
        &mut self,
        look: &Look,
        run: &mut dyn FnMut(&SubjectKernel<'_>),
    ) -> Result<(), String> {
        let Self { model, mesh, tree, own, .. } = self;
        let (mesh, tree, most) = (*mesh, *tree, MOST_TESTS);
        let radius = 0.25 * own.bounds.size().length();
        let lights = match &look.sky {
            Some(sky) => lit(&model.lights, sky.light(), own.bounds),
            None => lit(own.lamps, own.sky, own.bounds),
        };
        let lights = &lights.map_err(|e| e.to_string())?;
        let (looks, texels, light_of) = (&model.looks[..], &model.texels[..], &model.light_of[..]);
        let options = PathOptions { masks: model.has_masks, ..PathOptions::new() };
        let limits = PathLimits::new(BOUNCES);
        // One kernel for all modes: only what a mode needs is in the WGSL.
        let is_cost = look.show == Show::Cost;
        let is_occlusion = look.mode == Mode::Occlusion;
        let is_path = look.mode == Mode::Path;
        let bounces = if look.mode == Mode::Whitted { BOUNCES } else { 0 };
        let shadows = true;
        let kernel = kernel!(counted |ray: Ray, sampler: Sampler| {
            let surface = |hit: Hit, point: ShadingPoint| {
                let look = looks[point.material as usize];
                met(texels, look, point, light_of[hit.prim_id as usize])
            };
            let color = if is_cost {
                let heat = bvh_cost_color(tree, most, ray);
                vec4(heat.x, heat.y, heat.z, 1.0)
            } else if is_occlusion {
                let light = ambient_occlusion::<_, 1>(mesh, radius, ray, sampler);
                light + vec4(1.0, 1.0, 1.0, 1.0) * (1.0 - light.w)
            } else if is_path {
                let sample: PathSample = path_with::<_, _, Met>(
                    mesh,
                    surface,
                    lights,
                    host(options),
                    limits,
                    ray,
                    sampler,
                );
                sample.color
            } else {
                whitted::<_, _, Met>(
                    mesh,
                    surface,
                    lights,
                    host(shadows),
                    host(bounces),
                    ray,
                    sampler,
                )
            };
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
        let material = self.model.materials.get(hit.prim_id as usize).copied().unwrap_or(0);
        let name = self.names.get(material as usize).map_or("", String::as_str);
        let value = format!("material {material} {name}").trim_end().to_owned();
        Some(Picked { id: u64::from(hit.prim_id), position: ray.at(hit.t), value })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The pose of a file with one camera, five units from the middle.
    fn pose_of(forward: Vec3, up: Vec3, vertical: f32) -> Pose {
        let projection = Projection::Perspective { vertical, aspect: None, near: 0.1, far: None };
        let (name, position) = (String::new(), -5.0 * forward);
        let camera = scene::Camera { name, position, forward, up, projection };
        let bounds = Aabb::from_points([Vec3::splat(-1.0), Vec3::ONE]);
        home(&File { cameras: vec![camera], ..Default::default() }, bounds, Vec3::Y)
    }

    #[test]
    fn a_camera_of_a_file_does_not_tilt_the_world() {
        let down = vec3(0.0, -0.6, -0.8);
        let pose = pose_of(down, vec3(0.0, 0.8, -0.6), 0.5);
        assert_eq!((pose.eye, pose.up, pose.fov_y), (-5.0 * down, Vec3::Y, 0.5));
        assert!(pose.target.length() < 1e-5, "{pose:?}");
        // From straight above there is no other direction that is up.
        assert_eq!(pose_of(-Vec3::Y, Vec3::X, 0.5).up, Vec3::X);
    }

    #[test]
    fn a_camera_of_a_file_is_one_that_can_be_asked_for() {
        for vertical in [1e-4, 0.5, 3.1] {
            let pose = pose_of(-Vec3::Z, Vec3::Y, vertical);
            assert_eq!(crate::edit::camera(pose), Ok(pose), "{vertical}");
        }
    }
}
