//! Nodes: what is placed in the world.

use std::ops::Range;

use glam::{Affine3A, Mat4, Quat, Vec2, Vec3};
use gltf_json::camera::Type;
use gltf_json::scene::Node;
use gltf_json::validation::Checked;
use gltf_json::{Index, Mesh};
use serde::Deserialize;

use super::buffer::Buffers;
use super::primitive::{self, Room};
use super::{File, REMEDY};
use crate::LoadError;
use crate::scene::{Camera, Instance, LightKind, Material, Projection, PunctualLight, Scene, name};

/// Instances that any file may have, however small it is.
const FREE: u64 = 1 << 16;

/// Reads the nodes of the scene and all that they place.
pub(super) fn read(file: &File, buffers: &Buffers, scene: &mut Scene) -> Result<(), LoadError> {
    let lights = file.root.extensions.as_ref().map(|e| &e.others);
    let lights: Lights =
        file.extension(lights, "KHR_lights_punctual", "extensions")?.unwrap_or_default();
    let mut reader = Reader {
        file,
        buffers,
        scene,
        lights: lights.lights,
        meshes: vec![None; file.root.meshes.len()],
        room: Room::new(buffers),
        default_material: None,
    };
    let mut is_placed = vec![false; file.root.nodes.len()];
    let mut left: Vec<(usize, Affine3A)> =
        roots(file)?.into_iter().rev().map(|i| (i, Affine3A::IDENTITY)).collect();
    while let Some((index, parent)) = left.pop() {
        let node = file.at(&file.root.nodes, index, "nodes")?;
        // Otherwise nodes could be in a circle, or more than can be counted.
        if std::mem::replace(&mut is_placed[index], true) {
            return Err(file.wrong(format!("nodes[{index}] is in the scene twice")));
        }
        let transform = parent * local(file, node, index)?;
        if !transform.is_finite() {
            return Err(file.wrong(format!("nodes[{index}]: its transform is not finite")));
        }
        reader.place(node, index, transform)?;
        let children = node.children.iter().flatten().rev();
        left.extend(children.map(|child| (child.value(), transform)));
    }
    Ok(())
}

/// The nodes at the top of the default scene, or of the first, or without a scene of all.
fn roots(file: &File) -> Result<Vec<usize>, LoadError> {
    let root = &file.root;
    if let Some(index) = root.scene {
        let scene = file.get(&root.scenes, index, "scenes")?;
        return Ok(scene.nodes.iter().map(Index::value).collect());
    }
    if let Some(scene) = root.scenes.first() {
        return Ok(scene.nodes.iter().map(Index::value).collect());
    }
    let mut is_child = vec![false; root.nodes.len()];
    for child in root.nodes.iter().flat_map(|node| node.children.iter().flatten()) {
        if let Some(is_child) = is_child.get_mut(child.value()) {
            *is_child = true;
        }
    }
    Ok((0..root.nodes.len()).filter(|i| !is_child[*i]).collect())
}

fn local(file: &File, node: &Node, index: usize) -> Result<Affine3A, LoadError> {
    let wrong = |what: &str| file.wrong(format!("nodes[{index}]: {what}"));
    if let Some(matrix) = node.matrix {
        let matrix = Mat4::from_cols_array(&matrix);
        if !matrix.row(3).abs_diff_eq(glam::Vec4::W, 1e-5) {
            return Err(wrong("the last row of its matrix is not 0, 0, 0, 1"));
        }
        return Ok(Affine3A::from_mat4(matrix));
    }
    let scale = Vec3::from(node.scale.unwrap_or([1.0; 3]));
    let rotation = Quat::from_array(node.rotation.unwrap_or_default().0);
    let translation = Vec3::from(node.translation.unwrap_or_default());
    let length = rotation.length();
    if !length.is_finite() || length < 1e-3 {
        return Err(wrong("its rotation is no unit quaternion"));
    }
    Ok(Affine3A::from_scale_rotation_translation(scale, rotation / length, translation))
}

#[derive(Default, Deserialize)]
struct Lights {
    lights: Vec<Light>,
}

#[derive(Deserialize)]
struct Light {
    name: Option<String>,
    #[serde(rename = "type")]
    kind: Kind,
    color: Option<[f32; 3]>,
    intensity: Option<f32>,
    range: Option<f32>,
    spot: Option<Spot>,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Kind {
    Point,
    Spot,
    Directional,
}

#[derive(Clone, Copy, Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
struct Spot {
    inner_cone_angle: f32,
    outer_cone_angle: Option<f32>,
}

/// An index of a light, in the extension of a node.
#[derive(Deserialize)]
struct LightOf {
    light: usize,
}

struct Reader<'a> {
    file: &'a File,
    buffers: &'a Buffers,
    scene: &'a mut Scene,
    lights: Vec<Light>,
    /// The meshes of the scene, by the indices of the file.
    meshes: Vec<Option<Range<usize>>>,
    room: Room,
    default_material: Option<usize>,
}

impl Reader<'_> {
    fn place(&mut self, node: &Node, index: usize, transform: Affine3A) -> Result<(), LoadError> {
        let what = format!("nodes[{index}]");
        if let Some(mesh) = node.mesh {
            self.place_mesh(mesh, node, transform)?;
        }
        if let Some(camera) = node.camera {
            let camera = self.camera(camera, node, transform, &what)?;
            self.scene.cameras.push(camera);
        }
        let others = node.extensions.as_ref().map(|e| &e.others);
        let found = self.file.extension(others, "KHR_lights_punctual", &what)?;
        if let Some(LightOf { light }) = found {
            let light = self.light(light, node, transform, &what)?;
            self.scene.lights.push(light);
        }
        Ok(())
    }

    fn place_mesh(
        &mut self,
        index: Index<Mesh>,
        node: &Node,
        transform: Affine3A,
    ) -> Result<(), LoadError> {
        let meshes = self.mesh(index)?;
        let limit = FREE + self.file.source.len;
        let count = (self.scene.instances.len() + meshes.len()) as u64;
        if count > limit {
            let path = self.file.source.path.clone();
            return Err(LoadError::TooMany {
                path,
                what: "instance",
                count,
                limit,
                remedy: REMEDY,
            });
        }
        for mesh in meshes {
            let own = node.name.as_deref().map(|text| name(Some(text)));
            let name = own.unwrap_or_else(|| self.scene.meshes[mesh].name.clone());
            self.scene.instances.push(Instance { name, mesh, transform });
        }
        Ok(())
    }

    /// The meshes of the scene that are a mesh of the file; they are read when they are placed
    /// first.
    fn mesh(&mut self, index: Index<Mesh>) -> Result<Range<usize>, LoadError> {
        let file = self.file;
        let json = file.get(&file.root.meshes, index, "meshes")?;
        if let Some(range) = &self.meshes[index.value()] {
            return Ok(range.clone());
        }
        let begin = self.scene.meshes.len();
        for primitive in &json.primitives {
            let found = primitive::read(file, self.buffers, primitive, &mut self.room)?;
            let Some(mut mesh) = found else { continue };
            mesh.name = name(json.name.as_deref());
            mesh.material = match primitive.material {
                Some(material) => {
                    file.get(&file.root.materials, material, "materials")?;
                    material.value()
                }
                None => self.default_material(),
            };
            self.scene.meshes.push(mesh);
        }
        let range = begin..self.scene.meshes.len();
        self.meshes[index.value()] = Some(range.clone());
        Ok(range)
    }

    fn default_material(&mut self) -> usize {
        let materials = &mut self.scene.materials;
        *self.default_material.get_or_insert_with(|| {
            materials.push(Material::default());
            materials.len() - 1
        })
    }

    fn light(
        &self,
        index: usize,
        node: &Node,
        transform: Affine3A,
        what: &str,
    ) -> Result<PunctualLight, LoadError> {
        let wrong = |why: &str| self.file.wrong(format!("{what}: {why}"));
        let light = self.file.at(&self.lights, index, "lights")?;
        let color = Vec3::from(light.color.unwrap_or([1.0; 3]));
        let intensity = color * light.intensity.unwrap_or(1.0);
        if !intensity.is_finite() || intensity.min_element() < 0.0 {
            return Err(wrong("the intensity of its light is out of range"));
        }
        if light.range.is_some_and(|range| !(range > 0.0 && range.is_finite())) {
            return Err(wrong("the range of its light is out of range"));
        }
        let direction = unit(transform, Vec3::NEG_Z);
        let kind = match light.kind {
            Kind::Point => LightKind::Point,
            Kind::Directional => LightKind::Directional,
            Kind::Spot => {
                let spot = light.spot.unwrap_or_default();
                let quarter = std::f32::consts::FRAC_PI_4;
                let (inner, outer) = (spot.inner_cone_angle, spot.outer_cone_angle);
                let outer = outer.unwrap_or(quarter).min(2.0 * quarter);
                if !(inner >= 0.0 && inner < outer) {
                    return Err(wrong("the angles of its light are out of range"));
                }
                LightKind::Spot { inner, outer }
            }
        };
        if direction.is_none() && kind != LightKind::Point {
            return Err(wrong("its light has no direction"));
        }
        Ok(PunctualLight {
            name: name(node.name.as_deref().or(light.name.as_deref())),
            position: transform.translation.into(),
            direction: direction.unwrap_or(Vec3::NEG_Z),
            intensity,
            range: light.range,
            kind,
        })
    }

    fn camera(
        &self,
        index: Index<gltf_json::Camera>,
        node: &Node,
        transform: Affine3A,
        what: &str,
    ) -> Result<Camera, LoadError> {
        let wrong = |why: &str| self.file.wrong(format!("{what}: {why}"));
        let json = self.file.get(&self.file.root.cameras, index, "cameras")?;
        let projection = projection(json).ok_or_else(|| {
            self.file.wrong(format!("cameras[{}]: it has numbers out of range", index.value()))
        })?;
        let forward = unit(transform, Vec3::NEG_Z);
        let up = forward.zip(unit(transform, Vec3::Y));
        let up = up.and_then(|(forward, up)| up.reject_from_normalized(forward).try_normalize());
        let (Some(forward), Some(up)) = (forward, up) else {
            return Err(wrong("its camera has no direction"));
        };
        Ok(Camera {
            name: name(node.name.as_deref().or(json.name.as_deref())),
            position: transform.translation.into(),
            forward,
            up,
            projection,
        })
    }
}

/// A direction of a node's space, in the world.
fn unit(transform: Affine3A, direction: Vec3) -> Option<Vec3> {
    transform.transform_vector3(direction).try_normalize()
}

/// None if a number is missing or out of range.
fn projection(json: &gltf_json::Camera) -> Option<Projection> {
    let is_above = |x: f32, least: f32| x > least && x.is_finite();
    match json.type_ {
        Checked::Valid(Type::Perspective) => {
            let p = json.perspective.as_ref()?;
            let is_right = is_above(p.yfov, 0.0)
                && p.yfov < std::f32::consts::PI
                && p.aspect_ratio.is_none_or(|aspect| is_above(aspect, 0.0))
                && is_above(p.znear, 0.0)
                && p.zfar.is_none_or(|far| is_above(far, p.znear));
            let (vertical, aspect, near, far) = (p.yfov, p.aspect_ratio, p.znear, p.zfar);
            is_right.then_some(Projection::Perspective { vertical, aspect, near, far })
        }
        Checked::Valid(Type::Orthographic) => {
            let o = json.orthographic.as_ref()?;
            let half_size = Vec2::new(o.xmag, o.ymag);
            let is_right = half_size.is_finite()
                && half_size.cmpne(Vec2::ZERO).all()
                && o.znear >= 0.0
                && is_above(o.zfar, o.znear);
            let (near, far) = (o.znear, o.zfar);
            is_right.then_some(Projection::Orthographic { half_size, near, far })
        }
        Checked::Invalid => None,
    }
}
