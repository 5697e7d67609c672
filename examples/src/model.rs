//! Scenes of files as data that kernels read: triangles, materials, pictures and lights.

use glam::Mat3A;
use raydsl::bsdf::{Bsdf, BsdfSample, Material, MetallicRoughness, NO_LIGHT};
use raydsl::kernel;
use raydsl::light::{AnyLight, AreaLight, DirectionalLight, PointLight, SpotLight};
use raydsl::prelude::*;
use raydsl_io::scene::{self, AlphaMode, Filter, Image as Texels, LightKind, Scene as File, Wrap};

/// Where a material finds a picture among the texels of all, and how it is looked up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct Picture {
    /// The first texel.
    pub first: u32,
    /// Texels per row, and rows; 0 where there is no picture.
    pub size: UVec2,
    /// What happens beyond the sides: 0 repeats, 1 mirrors, 2 clamps.
    pub wrap: UVec2,
    /// Whether the nearest texel is taken.
    pub is_nearest: u32,
    /// First row of the map of texture coordinates.
    pub to_u: Vec3,
    /// The second row.
    pub to_v: Vec3,
}

/// The material of a mesh, with its pictures.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
#[repr(C)]
pub struct Look {
    /// The factors.
    pub base: MetallicRoughness,
    /// Opacity, by which that of the picture is multiplied.
    pub opacity: f32,
    /// Opacity from which on a mask is there; below 0 for one that is half transparent.
    pub cutoff: f32,
    /// Factor of the mapped normal's first two components.
    pub normal_scale: f32,
    /// Base colour and opacity.
    pub color: Picture,
    /// Roughness in green, metal in blue.
    pub roughness: Picture,
    /// Normal.
    pub normal: Picture,
    /// Transmission in red.
    pub transmission: Picture,
    /// Whether one of the following is there.
    pub has_layers: u32,
    /// Colour of the reflection of what is no metal.
    pub specular_color: Picture,
    /// Strength of that reflection in alpha.
    pub specular: Picture,
    /// Coat in red.
    pub clearcoat: Picture,
    /// Roughness of the coat in green.
    pub clearcoat_roughness: Picture,
    /// Colour of the sheen.
    pub sheen_color: Picture,
    /// Roughness of the sheen in alpha.
    pub sheen_roughness: Picture,
}

/// A surface as a ray meets it.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub struct Met {
    /// How it scatters light.
    pub bsdf: MetallicRoughness,
    /// The number of its light.
    pub light: u32,
    /// Its opacity.
    pub opacity: f32,
    /// Its mapped normal.
    pub normal: Vec3,
}

#[kernel]
impl Bsdf for Met {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Vec3 {
        let bsdf: MetallicRoughness = self.bsdf;
        MetallicRoughness::eval(&bsdf, wo, wi)
    }

    fn sample(&self, wo: Vec3, u: Vec3) -> BsdfSample {
        let bsdf: MetallicRoughness = self.bsdf;
        MetallicRoughness::sample(&bsdf, wo, u)
    }

    fn pdf(&self, wo: Vec3, wi: Vec3) -> f32 {
        let bsdf: MetallicRoughness = self.bsdf;
        MetallicRoughness::pdf(&bsdf, wo, wi)
    }

    fn albedo(&self, wo: Vec3) -> Vec3 {
        let bsdf: MetallicRoughness = self.bsdf;
        MetallicRoughness::albedo(&bsdf, wo)
    }
}

#[kernel]
impl Material for Met {
    fn light(&self) -> u32 {
        self.light
    }

    fn opacity(&self) -> f32 {
        self.opacity
    }

    fn normal(&self) -> Vec3 {
        self.normal
    }
}

// ANCHOR: look
/// Returns a coordinate's texel, of `size` along its axis.
#[kernel]
fn wrapped(i: i32, size: u32, wrap: u32) -> u32 {
    let n = size as i32;
    let period = i.rem_euclid(2 * n);
    let mirrored = if period < n { period } else { 2 * n - 1 - period };
    let inside = match wrap {
        0 => i.rem_euclid(n),
        1 => mirrored,
        _ => clamp(i, 0, n - 1),
    };
    inside as u32
}

/// Returns a texel, of four numbers with 16 bits each.
#[kernel]
fn texel(texels: &[UVec2], picture: Picture, x: i32, y: i32) -> Vec4 {
    let column = wrapped(x, picture.size.x, picture.wrap.x);
    let row = wrapped(y, picture.size.y, picture.wrap.y);
    let words = texels[(picture.first + row * picture.size.x + column) as usize];
    let part = |word: u32| word as f32 * (1.0 / 65535.0);
    let (low, high) = (words.x, words.y);
    vec4(part(low & 0xffff), part(low >> 16), part(high & 0xffff), part(high >> 16))
}

/// Returns what a picture has at texture coordinates; white where there is none.
#[kernel]
pub fn look_up(texels: &[UVec2], picture: Picture, uv: Vec2) -> Vec4 {
    if picture.size.x == 0 {
        return Vec4::ONE;
    }
    let place = vec3(uv.x, uv.y, 1.0);
    let x = picture.to_u.dot(place) * picture.size.x as f32;
    let y = picture.to_v.dot(place) * picture.size.y as f32;
    if picture.is_nearest == 1 {
        return texel(texels, picture, x.floor() as i32, y.floor() as i32);
    }
    let (left, top) = ((x - 0.5).floor(), (y - 0.5).floor());
    let (fx, fy) = (x - 0.5 - left, y - 0.5 - top);
    let (i, j) = (left as i32, top as i32);
    let above = texel(texels, picture, i, j) * (1.0 - fx) + texel(texels, picture, i + 1, j) * fx;
    let below =
        texel(texels, picture, i, j + 1) * (1.0 - fx) + texel(texels, picture, i + 1, j + 1) * fx;
    above * (1.0 - fy) + below * fy
}

/// Returns a material's factors with the pictures of its coat, its sheen and what it reflects.
#[kernel]
fn layered(texels: &[UVec2], look: Look, uv: Vec2) -> MetallicRoughness {
    let base: MetallicRoughness = look.base;
    let tint = look_up(texels, look.specular_color, uv).truncate();
    let sheen = look_up(texels, look.sheen_color, uv).truncate();
    MetallicRoughness {
        specular: base.specular * tint * look_up(texels, look.specular, uv).w,
        clearcoat: base.clearcoat * look_up(texels, look.clearcoat, uv).x,
        clearcoat_roughness: base.clearcoat_roughness
            * look_up(texels, look.clearcoat_roughness, uv).y,
        sheen_color: base.sheen_color * sheen,
        sheen_roughness: base.sheen_roughness * look_up(texels, look.sheen_roughness, uv).w,
        ..base
    }
}

/// Returns the surface at texture coordinates.
#[kernel]
pub fn met(texels: &[UVec2], look: Look, point: ShadingPoint, light: u32) -> Met {
    let color = look_up(texels, look.color, point.uv);
    let rough = look_up(texels, look.roughness, point.uv);
    let glass = look_up(texels, look.transmission, point.uv);
    let mut normal = vec3(0.0, 0.0, 1.0);
    if look.normal.size.x > 0 {
        let n = look_up(texels, look.normal, point.uv);
        let (x, y) = (2.0 * n.x - 1.0, 2.0 * n.y - 1.0);
        normal = vec3(x * look.normal_scale, y * look.normal_scale, 2.0 * n.z - 1.0);
    }
    let opacity = look.opacity * color.w;
    let masked = if opacity >= look.cutoff { 1.0 } else { 0.0 };
    let mut base: MetallicRoughness = look.base;
    if look.has_layers == 1 {
        base = layered(texels, look, point.uv);
    }
    let bsdf = MetallicRoughness {
        base_color: base.base_color * color.truncate() * point.albedo,
        metallic: base.metallic * rough.z,
        roughness: base.roughness * rough.y,
        transmission: base.transmission * glass.x,
        ..base
    };
    Met { bsdf, light, opacity: if look.cutoff < 0.0 { opacity } else { masked }, normal }
}
// ANCHOR_END: look

/// A scene as kernels read it: all meshes in the space of the world.
#[derive(Clone, Debug, Default)]
pub struct Model {
    /// Vertices.
    pub positions: Vec<Vec3>,
    /// Their normals.
    pub normals: Vec<Vec3>,
    /// Their texture coordinates.
    pub uvs: Vec<Vec2>,
    /// Their colours.
    pub colors: Vec<Vec3>,
    /// Triangles.
    pub triangles: Vec<IndexedTriangle>,
    /// The material of each triangle.
    pub materials: Vec<u32>,
    /// The light that each triangle is, or [`NO_LIGHT`].
    pub light_of: Vec<u32>,
    /// The materials.
    pub looks: Vec<Look>,
    /// The texels of all pictures.
    pub texels: Vec<UVec2>,
    /// The lights.
    pub lights: Vec<AnyLight>,
    /// Whether some material has an opacity below 1.
    pub has_masks: bool,
}

impl Model {
    /// Makes a model of a file's scene. Light is emitted evenly over each triangle: a picture of what
    /// is emitted counts by its mean.
    pub fn new(file: &File) -> Self {
        let mut model = Self::default();
        // What no picture is.
        model.texels.push(UVec2::MAX);
        for material in &file.materials {
            let look = model.look(material, &file.images);
            model.looks.push(look);
            model.has_masks |= material.alpha_mode != AlphaMode::Opaque;
        }
        file.lights.iter().for_each(|l| model.lights.push(light(l)));
        file.instances.iter().for_each(|i| model.place(file, i));
        model
    }

    /// Returns the box around all vertices.
    pub fn bounds(&self) -> Aabb {
        Aabb::from_points(self.positions.iter().copied())
    }

    fn look(&mut self, m: &scene::Material, images: &[Texels]) -> Look {
        let mut picture = |texture: Option<scene::Texture>, is_color: bool| {
            texture.map_or_else(Picture::default, |t| self.picture(&t, &images[t.image], is_color))
        };
        let base = MetallicRoughness {
            base_color: m.base_color.truncate(),
            metallic: m.metallic,
            roughness: m.roughness,
            ior: if m.ior > 0.0 { m.ior.clamp(1.0, 3.0) } else { 1.5 },
            specular: (m.specular_color * m.specular).clamp(Vec3::ZERO, Vec3::ONE),
            transmission: m.transmission,
            is_solid: m.thickness > 0.0,
            clearcoat: m.clearcoat,
            clearcoat_roughness: m.clearcoat_roughness,
            sheen_color: m.sheen_color,
            sheen_roughness: m.sheen_roughness,
        };
        let cutoff = match m.alpha_mode {
            AlphaMode::Opaque => 0.0,
            AlphaMode::Mask(cutoff) => cutoff,
            AlphaMode::Blend => -1.0,
        };
        let layers = [
            m.specular_color_texture,
            m.specular_texture,
            m.clearcoat_texture,
            m.clearcoat_roughness_texture,
            m.sheen_color_texture,
            m.sheen_roughness_texture,
        ];
        let has_layers = layers.iter().any(Option::is_some);
        Look {
            base,
            opacity: if m.alpha_mode == AlphaMode::Opaque { 1.0 } else { m.base_color.w },
            cutoff,
            normal_scale: m.normal_scale,
            color: picture(m.base_color_texture, true),
            roughness: picture(m.metallic_roughness_texture, false),
            normal: picture(m.normal_texture, false),
            transmission: picture(m.transmission_texture, false),
            has_layers: u32::from(has_layers),
            specular_color: picture(m.specular_color_texture, true),
            specular: picture(m.specular_texture, false),
            clearcoat: picture(m.clearcoat_texture, false),
            clearcoat_roughness: picture(m.clearcoat_roughness_texture, false),
            sheen_color: picture(m.sheen_color_texture, true),
            sheen_roughness: picture(m.sheen_roughness_texture, false),
        }
    }

    /// Adds a picture's texels, linear, and says where they are.
    fn picture(&mut self, texture: &scene::Texture, image: &Texels, is_color: bool) -> Picture {
        let first = self.texels.len() as u32;
        let linear = |v: u8, is_color: bool| {
            let v = f32::from(v) / 255.0;
            let v = if is_color { srgb_to_linear(v) } else { v };
            (v * 65535.0).round() as u32
        };
        self.texels.extend(image.texels.iter().map(|t| {
            let [r, g, b] = [t[0], t[1], t[2]].map(|v| linear(v, is_color));
            uvec2(r | g << 16, b | linear(t[3], false) << 16)
        }));
        let wrap = texture.wrap.map(|w| match w {
            Wrap::Repeat => 0,
            Wrap::Mirror => 1,
            Wrap::Clamp => 2,
        });
        let map = texture.transform;
        Picture {
            first,
            size: uvec2(image.width, image.height),
            wrap: UVec2::from_array(wrap),
            is_nearest: u32::from(texture.filter == Filter::Nearest),
            to_u: vec3(map.matrix2.x_axis.x, map.matrix2.y_axis.x, map.translation.x),
            to_v: vec3(map.matrix2.x_axis.y, map.matrix2.y_axis.y, map.translation.y),
        }
    }

    /// Adds the triangles of an instance.
    fn place(&mut self, file: &File, instance: &scene::Instance) {
        let mesh = &file.meshes[instance.mesh];
        let material = &file.materials[mesh.material];
        let to_world = instance.transform;
        let first = self.positions.len() as u32;
        let start = self.positions.len();
        self.positions.extend(mesh.positions.iter().map(|p| to_world.transform_point3(*p)));
        // A mirrored mesh turns its triangles around, and so its front.
        let is_mirrored = to_world.matrix3.determinant() < 0.0;
        let turned = to_world.matrix3.inverse().transpose();
        let flat = if mesh.normals.is_empty() {
            normals_of(&mesh.positions, &mesh.triangles)
        } else {
            mesh.normals.clone()
        };
        self.normals.extend(flat.iter().map(|n| normal_of(turned, *n)));
        let count = mesh.positions.len();
        let or = |v: &[Vec2]| if v.is_empty() { vec![Vec2::ZERO; count] } else { v.to_vec() };
        self.uvs.extend(or(&mesh.uvs));
        if mesh.colors.is_empty() {
            self.colors.resize(start + count, Vec3::ONE);
        } else {
            self.colors.extend(mesh.colors.iter().map(|c| c.truncate()));
        }
        let emitted = material.emissive * mean_of(material.emissive_texture, &file.images);
        for t in &mesh.triangles {
            let [a, b, c] = t.map(|i| first + i);
            let vertices = if is_mirrored { [a, c, b] } else { [a, b, c] };
            self.triangles.push(IndexedTriangle { vertices });
            self.materials.push(mesh.material as u32);
            let shines = emitted.max_element() > 0.0;
            self.light_of.push(if shines { self.lights.len() as u32 } else { NO_LIGHT });
            if shines {
                let [v0, v1, v2] = vertices.map(|i| self.positions[i as usize]);
                let shape = Triangle { v0, v1, v2 };
                let is_two_sided = material.double_sided;
                let light = AreaLight::<Triangle> { shape, radiance: emitted, is_two_sided };
                self.lights.push(AnyLight::Triangle(light));
            }
        }
    }
}

/// A normal of a mesh in the world; a zero one stays so.
fn normal_of(turned: Mat3A, n: Vec3) -> Vec3 {
    let n = turned * n;
    if n.is_finite() { n } else { Vec3::ZERO }
}

/// Normals of vertices: the sum of those of their triangles, by area.
fn normals_of(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let mut normals = vec![Vec3::ZERO; positions.len()];
    for t in triangles {
        let [a, b, c] = t.map(|i| positions[i as usize]);
        let normal = (b - a).cross(c - a);
        t.iter().for_each(|i| normals[*i as usize] += normal);
    }
    normals
}

/// The mean of a picture in linear colours; white where there is none.
fn mean_of(texture: Option<scene::Texture>, images: &[Texels]) -> Vec3 {
    let Some(texture) = texture else { return Vec3::ONE };
    let texels = &images[texture.image].texels;
    let sum: glam::DVec3 = texels
        .iter()
        .map(|t| {
            let [r, g, b] = [t[0], t[1], t[2]].map(|v| srgb_to_linear(f32::from(v) / 255.0));
            vec3(r, g, b).as_dvec3()
        })
        .sum();
    (sum / texels.len().max(1) as f64).as_vec3()
}

/// A light of a file. Candela and lux are taken as W/sr and W/m²: only their ratios matter.
fn light(l: &scene::PunctualLight) -> AnyLight {
    let (position, intensity) = (l.position, l.intensity);
    match l.kind {
        LightKind::Point => AnyLight::Point(PointLight { position, intensity }),
        LightKind::Spot { inner, outer } => AnyLight::Spot(SpotLight {
            position,
            intensity,
            direction: l.direction,
            cos_inner: inner.cos(),
            cos_outer: outer.cos(),
        }),
        LightKind::Directional => AnyLight::Directional(DirectionalLight {
            direction: -l.direction,
            irradiance: intensity,
            sine: 0.0,
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every picture of a material multiplies its own factor, in its own channel.
    #[test]
    fn pictures_multiply_their_factors() {
        let image = |texel: [u8; 4]| Texels {
            width: 1,
            height: 1,
            texels: vec![texel],
            ..Texels::default()
        };
        // Of each channel another part, and of sRGB one whose linear number is known.
        let images = [image([51, 102, 153, 204]), image([188, 255, 0, 255])];
        let at = |image| {
            let (set, transform) = (0, glam::Affine2::IDENTITY);
            let (wrap, filter) = ([Wrap::Repeat; 2], Filter::Linear);
            Some(scene::Texture { image, set, transform, wrap, filter })
        };
        let material = scene::Material {
            specular_texture: at(0),
            specular_color_texture: at(1),
            clearcoat: 1.0,
            clearcoat_texture: at(0),
            clearcoat_roughness: 0.5,
            clearcoat_roughness_texture: at(0),
            sheen_color: vec3(1.0, 0.5, 1.0),
            sheen_color_texture: at(1),
            sheen_roughness: 0.5,
            sheen_roughness_texture: at(0),
            transmission: 0.5,
            transmission_texture: at(0),
            ..scene::Material::default()
        };
        let mut model = Model::default();
        let look = model.look(&material, &images);
        let texels = &model.texels[..];
        let point = ShadingPoint { albedo: Vec3::ONE, ..ShadingPoint::default() };
        let seen = met(texels, look, point, NO_LIGHT).bsdf;
        let half = srgb_to_linear(188.0 / 255.0);
        let near = |a: Vec3, b: Vec3| assert!(a.abs_diff_eq(b, 1e-4), "{a} for {b}");
        near(seen.specular, vec3(half, 1.0, 0.0) * 0.8);
        near(seen.sheen_color, vec3(half, 0.5, 0.0));
        near(vec3(seen.clearcoat, seen.clearcoat_roughness, 0.0), vec3(0.2, 0.2, 0.0));
        near(vec3(seen.sheen_roughness, seen.transmission, 0.0), vec3(0.4, 0.1, 0.0));
        let plain = model.look(&scene::Material { clearcoat: 1.0, ..Default::default() }, &images);
        assert_eq!(met(&model.texels, plain, point, NO_LIGHT).bsdf, plain.base);
    }
}
