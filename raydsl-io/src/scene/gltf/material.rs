//! Materials, their textures and pictures.

use std::collections::HashMap;
use std::rc::Rc;

use glam::{Affine2, Vec2, Vec3, Vec4};
use gltf_json::material::AlphaMode as Alpha;
use gltf_json::texture::{self, Info, MagFilter, WrappingMode};
use gltf_json::validation::Checked;
use gltf_json::{Index, Value};
use serde::Deserialize;
use serde_json::Map;

use super::buffer::{Buffers, fetch};
use super::{File, unsupported};
use crate::LoadError;
use crate::scene::picture::Room;
use crate::scene::{AlphaMode, Filter, Material, Scene, Texture, Wrap, name};

/// Reads all materials, and the pictures that they use.
pub(super) fn read(
    file: &File,
    buffers: &Buffers,
    room: &mut Room,
    scene: &mut Scene,
) -> Result<(), LoadError> {
    let images = vec![None; file.root.images.len()];
    let mut reader = Reader { file, buffers, room, scene, images, beside: HashMap::new() };
    for (i, json) in file.root.materials.iter().enumerate() {
        let material = reader.material(json, &format!("materials[{i}]"))?;
        reader.scene.materials.push(material);
    }
    Ok(())
}

#[derive(Deserialize)]
#[serde(default, rename_all = "camelCase")]
struct Strength {
    emissive_strength: f32,
}

impl Default for Strength {
    fn default() -> Self {
        Self { emissive_strength: 1.0 }
    }
}

#[derive(Deserialize)]
#[serde(default)]
struct Ior {
    ior: f32,
}

impl Default for Ior {
    fn default() -> Self {
        Self { ior: 1.5 }
    }
}

#[derive(Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
struct Transmission {
    transmission_factor: f32,
    transmission_texture: Option<Info>,
}

#[derive(Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
struct Volume {
    thickness_factor: f32,
    attenuation_distance: Option<f32>,
    attenuation_color: Option<[f32; 3]>,
}

#[derive(Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
struct Specular {
    specular_factor: Option<f32>,
    specular_texture: Option<Info>,
    specular_color_factor: Option<[f32; 3]>,
    specular_color_texture: Option<Info>,
}

#[derive(Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
struct Clearcoat {
    clearcoat_factor: f32,
    clearcoat_texture: Option<Info>,
    clearcoat_roughness_factor: f32,
    clearcoat_roughness_texture: Option<Info>,
}

#[derive(Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
struct Sheen {
    sheen_color_factor: [f32; 3],
    sheen_color_texture: Option<Info>,
    sheen_roughness_factor: f32,
    sheen_roughness_texture: Option<Info>,
}

#[derive(Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
struct Transform {
    offset: [f32; 2],
    rotation: f32,
    scale: Option<[f32; 2]>,
    tex_coord: Option<u32>,
}

type Others<'a> = Option<&'a Map<String, Value>>;

struct Reader<'a> {
    file: &'a File,
    buffers: &'a Buffers,
    room: &'a mut Room,
    scene: &'a mut Scene,
    /// The pictures of the scene, by the indices of the file.
    images: Vec<Option<usize>>,
    /// The files that are read.
    beside: HashMap<String, Rc<Vec<u8>>>,
}

impl Reader<'_> {
    fn material(&mut self, json: &gltf_json::Material, what: &str) -> Result<Material, LoadError> {
        let pbr = &json.pbr_metallic_roughness;
        let normal = json.normal_texture.as_ref();
        let mut material = Material {
            name: name(json.name.as_deref()),
            base_color: Vec4::from(pbr.base_color_factor.0).clamp(Vec4::ZERO, Vec4::ONE),
            base_color_texture: self.texture(pbr.base_color_texture.as_ref(), what)?,
            metallic: share(pbr.metallic_factor.0),
            roughness: share(pbr.roughness_factor.0),
            metallic_roughness_texture: self
                .texture(pbr.metallic_roughness_texture.as_ref(), what)?,
            normal_scale: normal.map_or(1.0, |normal| normal.scale),
            emissive: Vec3::from(json.emissive_factor.0),
            emissive_texture: self.texture(json.emissive_texture.as_ref(), what)?,
            alpha_mode: match json.alpha_mode {
                Checked::Valid(Alpha::Opaque) => AlphaMode::Opaque,
                Checked::Valid(Alpha::Mask) => {
                    AlphaMode::Mask(json.alpha_cutoff.unwrap_or_default().0.max(0.0))
                }
                Checked::Valid(Alpha::Blend) => AlphaMode::Blend,
                Checked::Invalid => {
                    return Err(self.file.wrong(format!("{what}: its alphaMode is unknown")));
                }
            },
            double_sided: json.double_sided,
            ..Material::default()
        };
        if let Some(normal) = normal {
            let others = normal.extensions.as_ref().map(|e| &e.others);
            let (index, set) = (normal.index, normal.tex_coord);
            material.normal_texture = Some(self.texture_of(index, set, others, what)?);
        }
        let others = json.extensions.as_ref().map(|e| &e.others);
        self.read_glass(&mut material, others, what)?;
        self.read_layers(&mut material, others, what)?;
        self.check(&material, what)?;
        Ok(material)
    }

    /// Extensions of what lies within the surface.
    fn read_glass(
        &mut self,
        m: &mut Material,
        others: Others,
        what: &str,
    ) -> Result<(), LoadError> {
        let file = self.file;
        if let Some(Ior { ior }) = file.extension(others, "KHR_materials_ior", what)? {
            m.ior = if ior == 0.0 { 0.0 } else { ior.max(1.0) };
        }
        let found: Option<Transmission> =
            file.extension(others, "KHR_materials_transmission", what)?;
        if let Some(found) = found {
            m.transmission = share(found.transmission_factor);
            m.transmission_texture = self.texture(found.transmission_texture.as_ref(), what)?;
        }
        let found: Option<Volume> = file.extension(others, "KHR_materials_volume", what)?;
        if let Some(found) = found {
            m.thickness = found.thickness_factor.max(0.0);
            m.attenuation_distance = found.attenuation_distance.unwrap_or(f32::INFINITY);
            m.attenuation_color = colour(found.attenuation_color.unwrap_or([1.0; 3]));
        }
        Ok(())
    }

    /// Extensions of what lies on the surface.
    fn read_layers(
        &mut self,
        m: &mut Material,
        others: Others,
        what: &str,
    ) -> Result<(), LoadError> {
        let file = self.file;
        let strength = file.extension(others, "KHR_materials_emissive_strength", what)?;
        if let Some(Strength { emissive_strength }) = strength {
            m.emissive *= emissive_strength;
        }
        let found: Option<Specular> = file.extension(others, "KHR_materials_specular", what)?;
        if let Some(found) = found {
            m.specular = share(found.specular_factor.unwrap_or(1.0));
            m.specular_color = Vec3::from(found.specular_color_factor.unwrap_or([1.0; 3]));
            m.specular_texture = self.texture(found.specular_texture.as_ref(), what)?;
            m.specular_color_texture = self.texture(found.specular_color_texture.as_ref(), what)?;
        }
        let found: Option<Clearcoat> = file.extension(others, "KHR_materials_clearcoat", what)?;
        if let Some(found) = found {
            m.clearcoat = share(found.clearcoat_factor);
            m.clearcoat_roughness = share(found.clearcoat_roughness_factor);
            m.clearcoat_texture = self.texture(found.clearcoat_texture.as_ref(), what)?;
            m.clearcoat_roughness_texture =
                self.texture(found.clearcoat_roughness_texture.as_ref(), what)?;
        }
        let found: Option<Sheen> = file.extension(others, "KHR_materials_sheen", what)?;
        if let Some(found) = found {
            m.sheen_color = colour(found.sheen_color_factor);
            m.sheen_roughness = share(found.sheen_roughness_factor);
            m.sheen_color_texture = self.texture(found.sheen_color_texture.as_ref(), what)?;
            m.sheen_roughness_texture =
                self.texture(found.sheen_roughness_texture.as_ref(), what)?;
        }
        m.unlit = others.is_some_and(|others| others.contains_key("KHR_materials_unlit"));
        Ok(())
    }

    /// Numbers without an upper limit.
    fn check(&self, m: &Material, what: &str) -> Result<(), LoadError> {
        let is_light = |v: Vec3| v.is_finite() && v.min_element() >= 0.0;
        let cutoff = if let AlphaMode::Mask(cutoff) = m.alpha_mode { cutoff } else { 0.0 };
        let checks = [
            (is_light(m.emissive), "emissive factor"),
            (is_light(m.specular_color), "specular colour"),
            (m.normal_scale.is_finite(), "scale of normals"),
            (m.ior.is_finite(), "index of refraction"),
            (m.thickness.is_finite(), "thickness"),
            (m.attenuation_distance > 0.0, "attenuation distance"),
            (cutoff.is_finite(), "alpha cutoff"),
        ];
        match checks.iter().find(|(is_right, _)| !is_right) {
            Some((_, number)) => {
                Err(self.file.wrong(format!("{what}: its {number} is out of range")))
            }
            None => Ok(()),
        }
    }

    fn texture(&mut self, info: Option<&Info>, what: &str) -> Result<Option<Texture>, LoadError> {
        let Some(info) = info else { return Ok(None) };
        let others = info.extensions.as_ref().map(|e| &e.others);
        self.texture_of(info.index, info.tex_coord, others, what).map(Some)
    }

    fn texture_of(
        &mut self,
        index: Index<texture::Texture>,
        set: u32,
        others: Others,
        what: &str,
    ) -> Result<Texture, LoadError> {
        let file = self.file;
        let transform: Option<Transform> = file.extension(others, "KHR_texture_transform", what)?;
        let transform = transform.unwrap_or_default();
        let set = transform.tex_coord.unwrap_or(set);
        if set > 1 {
            let what = format!("{what}: it uses texture coordinates of set {set}, beyond 0 and 1");
            return Err(file.wrong(what));
        }
        let scale = Vec2::from(transform.scale.unwrap_or([1.0; 2]));
        let offset = Vec2::from(transform.offset);
        // The extension turns by an angle that is counter-clockwise where v grows downwards.
        let transform = Affine2::from_scale_angle_translation(scale, -transform.rotation, offset);
        if !transform.is_finite() {
            return Err(file.wrong(format!("{what}: its KHR_texture_transform is not finite")));
        }
        let json = file.get(&file.root.textures, index, "textures")?;
        if json.source.value() == u32::MAX as usize {
            let others = json.extensions.as_ref().map(|e| &e.others);
            let name = others.and_then(|others| others.keys().next());
            let none = || file.wrong(format!("textures[{}] has no picture", index.value()));
            return Err(name.map_or_else(none, |name| unsupported(&file.source, name)));
        }
        let image = self.image(json.source)?;
        let sampler = json.sampler.map(|i| file.get(&file.root.samplers, i, "samplers"));
        let sampler = sampler.transpose()?.cloned().unwrap_or_default();
        let wrap = [self.wrap(sampler.wrap_s)?, self.wrap(sampler.wrap_t)?];
        let filter = match sampler.mag_filter {
            Some(Checked::Valid(MagFilter::Nearest)) => Filter::Nearest,
            Some(Checked::Invalid) => return Err(file.wrong("the filter of a sampler is unknown")),
            _ => Filter::Linear,
        };
        Ok(Texture { image, set, transform, wrap, filter })
    }

    fn wrap(&self, mode: Checked<WrappingMode>) -> Result<Wrap, LoadError> {
        match mode {
            Checked::Valid(WrappingMode::Repeat) => Ok(Wrap::Repeat),
            Checked::Valid(WrappingMode::MirroredRepeat) => Ok(Wrap::Mirror),
            Checked::Valid(WrappingMode::ClampToEdge) => Ok(Wrap::Clamp),
            Checked::Invalid => Err(self.file.wrong("the wrapping mode of a sampler is unknown")),
        }
    }

    /// A picture of the scene; it is read when it is used first.
    fn image(&mut self, index: Index<gltf_json::Image>) -> Result<usize, LoadError> {
        let (file, i) = (self.file, index.value());
        let json = file.get(&file.root.images, index, "images")?;
        if let Some(image) = self.images[i] {
            return Ok(image);
        }
        let fetched;
        let bytes = match (json.buffer_view, &json.uri) {
            (Some(view), _) => self.buffers.view(file, view)?.bytes,
            (None, Some(uri)) => {
                let known = self.beside.len();
                fetched = fetch(&file.source, uri, &mut self.beside)?;
                if self.beside.len() > known {
                    self.room.add(fetched.len() as u64);
                }
                &fetched
            }
            (None, None) => return Err(file.wrong(format!("images[{i}] has no data"))),
        };
        let found = self.room.decode(bytes, name(json.name.as_deref()));
        let image = found.map_err(|(what, remedy)| {
            let what = format!("images[{i}]: {what}");
            file.source.corrupt(crate::Place::Somewhere, what, remedy)
        })?;
        self.scene.images.push(image);
        self.images[i] = Some(self.scene.images.len() - 1);
        Ok(self.scene.images.len() - 1)
    }
}

fn share(number: f32) -> f32 {
    number.clamp(0.0, 1.0)
}

fn colour(channels: [f32; 3]) -> Vec3 {
    Vec3::from(channels).clamp(Vec3::ZERO, Vec3::ONE)
}
