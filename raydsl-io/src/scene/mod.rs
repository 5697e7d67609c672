//! Whole scenes, from glTF and from OBJ with MTL: meshes, materials, textures, lights and cameras.
//!
//! Materials of both are those of glTF: a base colour, metallic and rough, with a coat, sheen and
//! transmission. Numbers of materials are linear; the colour space of a picture is told by what a
//! material uses it for.
//!
//! # glTF
//!
//! glTF 2.0, as `.gltf` or `.glb`, its default scene or else the first. Read are meshes of
//! triangles, strips and fans, also sparse and quantised ones; materials; PNG and JPEG pictures;
//! cameras; and the extensions `KHR_lights_punctual`, `KHR_materials_clearcoat`,
//! `KHR_materials_emissive_strength`, `KHR_materials_ior`, `KHR_materials_sheen`,
//! `KHR_materials_specular`, `KHR_materials_transmission`, `KHR_materials_unlit`,
//! `KHR_materials_volume`, `KHR_mesh_quantization` and `KHR_texture_transform`. A file that requires
//! another is refused; one that only uses another is read without it.
//!
//! Not read are points and lines, occlusion, a coat's own normals, pictures of thickness, animations,
//! skins and morphs: meshes are as their nodes place them, at rest. A transparent picture of a material that is `Opaque` stays so.
//!
//! Buffers and pictures are in the file itself, in a `data:` URI, or in a file in its own folder or
//! below. A URI that leads elsewhere, or to the net, is an error.
//!
//! # OBJ with MTL
//!
//! Statements `v`, with colours behind the coordinates, `vt`, `vn`, `f`, `o`, `g`, `usemtl` and
//! `mtllib`; the others are passed over. There is a mesh for each material of each object and each
//! group, in order of first use. Texture coordinates are turned upside down, so that (0, 0) is at
//! the top left of a picture, as in glTF.
//!
//! A material of MTL, which is of Phong's model, becomes one of glTF:
//!
//! | MTL | becomes |
//! |---|---|
//! | `Kd`, `map_Kd` | `base_color` and its texture; the colour is white where only the texture is given |
//! | `Ks` | `specular_color`, and `specular` 1; without it `specular` is 0 |
//! | `Ns` | `roughness`, the fourth root of 2 / (`Ns` + 2), as GGX's alpha is its square; without it 1 |
//! | `Pm`, `Pr` | `metallic`, `roughness`; `Pr` counts more than `Ns` |
//! | `Ke`, `map_Ke` | `emissive` and its texture; the colour is white where only the texture is given |
//! | `Ni` | `ior`; 1.5 where it is missing or below 1 |
//! | `d`, `Tr` | the opacity, 1 - `Tr`, as alpha of `base_color`, and [`AlphaMode::Blend`] below 1 |
//! | `illum` | 0 and 1: no highlight, `specular` 0; 4, 6, 7 and 9: glass, whose alpha is 1, `transmission` is 1 - `d`, or 1 without `d`, and base colour is `Tf`, or `Kd` without `Tf`; others: nothing |
//! | `norm`, `map_Kn` | `normal_texture` |
//! | `map_d`, `map_Bump`, `bump`, `disp` and others | nothing |
//!
//! Of the options of a texture `-o`, `-s` and `-clamp` are followed, and the others are passed over.
//! Libraries and pictures are in the file's folder or below; pictures are PNG or JPEG.

#[cfg(feature = "gltf")]
mod gltf;
#[cfg(feature = "mtl")]
mod mtl;
#[cfg(feature = "mtl")]
mod obj;
#[cfg(any(feature = "gltf", feature = "mtl"))]
mod picture;

use std::path::Path;

use glam::{Affine2, Affine3A, Vec2, Vec3, Vec4};

use crate::LoadError;
use crate::format::{self, Format, loader};
use crate::source::Source;

/// Holds what is in a scene. All indices are those of elements.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// The meshes, each of one material, in the space of their node.
    pub meshes: Vec<SceneMesh>,
    /// The materials: those of the file, and a default one at the end where a mesh has none.
    pub materials: Vec<Material>,
    /// The pictures that materials use.
    pub images: Vec<Image>,
    /// Where meshes are; there is at least one.
    pub instances: Vec<Instance>,
    /// The lights, placed in the world.
    pub lights: Vec<PunctualLight>,
    /// The cameras, placed in the world.
    pub cameras: Vec<Camera>,
}

/// Holds triangles of one material. Attributes are one for each position, or empty where the file
/// has none; all are finite.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneMesh {
    /// What the file calls it; may be empty.
    pub name: String,
    /// The positions, in metres in glTF, and in units of the file in OBJ.
    pub positions: Vec<Vec3>,
    /// The normals, as they are in the file: of any length.
    pub normals: Vec<Vec3>,
    /// The texture coordinates of set 0: (0, 0) is the top left of a picture, (1, 1) its bottom
    /// right.
    pub uvs: Vec<Vec2>,
    /// The texture coordinates of set 1.
    pub uvs1: Vec<Vec2>,
    /// The tangents along u in `x`, `y`, `z`, and in `w` the sign, 1 or -1, of the bitangent:
    /// `w` times the cross product of normal and tangent.
    pub tangents: Vec<Vec4>,
    /// Linear colours and opacities by which the base colour is multiplied.
    pub colors: Vec<Vec4>,
    /// The triangles, each three indices into `positions`; counter-clockwise seen from the front.
    pub triangles: Vec<[u32; 3]>,
    /// The index of its material.
    pub material: usize,
}

/// Places a mesh in the world.
#[derive(Clone, Debug, PartialEq)]
pub struct Instance {
    /// What the file calls it; may be empty.
    pub name: String,
    /// The index of the mesh.
    pub mesh: usize,
    /// The map from the mesh's space to the world's; finite, maybe of determinant 0.
    pub transform: Affine3A,
}

/// Tells how a surface reflects, transmits and emits light: the model of glTF. Factors are
/// multiplied by their textures. A factor of a file beyond its range from 0 to 1 is set to the end
/// of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// What the file calls it; may be empty.
    pub name: String,
    /// The linear base colour and the opacity, each from 0 to 1.
    pub base_color: Vec4,
    /// The base colour, in sRGB, and the opacity, which is linear.
    pub base_color_texture: Option<Texture>,
    /// The share of metal, from 0 to 1.
    pub metallic: f32,
    /// The roughness, from 0 to 1: the square root of GGX's alpha.
    pub roughness: f32,
    /// The share of metal in blue and the roughness in green, linear.
    pub metallic_roughness_texture: Option<Texture>,
    /// The normal in tangent space: from -1 to 1, linear, in red, green (up the picture) and blue.
    pub normal_texture: Option<Texture>,
    /// The factor of the normal's x and y.
    pub normal_scale: f32,
    /// The linear colour that is emitted, not negative, times its strength: in glTF it is the
    /// radiance in candela per square metre.
    pub emissive: Vec3,
    /// The colour that is emitted, in sRGB.
    pub emissive_texture: Option<Texture>,
    /// What the opacity does.
    pub alpha_mode: AlphaMode,
    /// Whether the back is seen too.
    pub double_sided: bool,
    /// The index of refraction, 1 or more; or 0, which is for a highlight without Fresnel.
    pub ior: f32,
    /// The share of light that goes through what is no metal, from 0 to 1.
    pub transmission: f32,
    /// The share that goes through, in red, linear.
    pub transmission_texture: Option<Texture>,
    /// The thickness behind the surface, in units of the mesh, not negative; 0 is for a thin wall,
    /// which does not refract.
    pub thickness: f32,
    /// The distance, above 0, in units of the world, after which white light has become
    /// `attenuation_color`; infinite where nothing is absorbed.
    pub attenuation_distance: f32,
    /// The colour of white light after `attenuation_distance`, each from 0 to 1.
    pub attenuation_color: Vec3,
    /// The factor of the reflection of what is no metal, from 0 to 1.
    pub specular: f32,
    /// The factor of that reflection, in alpha, linear.
    pub specular_texture: Option<Texture>,
    /// The linear colour of that reflection, not negative.
    pub specular_color: Vec3,
    /// The colour of that reflection, in sRGB.
    pub specular_color_texture: Option<Texture>,
    /// The coat, from 0 to 1.
    pub clearcoat: f32,
    /// The coat in red, linear.
    pub clearcoat_texture: Option<Texture>,
    /// The roughness of the coat, from 0 to 1.
    pub clearcoat_roughness: f32,
    /// The roughness of the coat in green, linear.
    pub clearcoat_roughness_texture: Option<Texture>,
    /// The linear colour of the sheen, each from 0 to 1; black where there is none.
    pub sheen_color: Vec3,
    /// The colour of the sheen, in sRGB.
    pub sheen_color_texture: Option<Texture>,
    /// The roughness of the sheen, from 0 to 1.
    pub sheen_roughness: f32,
    /// The roughness of the sheen, in alpha, linear.
    pub sheen_roughness_texture: Option<Texture>,
    /// Whether the base colour is shown as it is, without light.
    pub unlit: bool,
}

impl Default for Material {
    /// glTF's default: white, rough metal.
    fn default() -> Self {
        Self {
            name: String::new(),
            base_color: Vec4::ONE,
            base_color_texture: None,
            metallic: 1.0,
            roughness: 1.0,
            metallic_roughness_texture: None,
            normal_texture: None,
            normal_scale: 1.0,
            emissive: Vec3::ZERO,
            emissive_texture: None,
            alpha_mode: AlphaMode::Opaque,
            double_sided: false,
            ior: 1.5,
            transmission: 0.0,
            transmission_texture: None,
            thickness: 0.0,
            attenuation_distance: f32::INFINITY,
            attenuation_color: Vec3::ONE,
            specular: 1.0,
            specular_texture: None,
            specular_color: Vec3::ONE,
            specular_color_texture: None,
            clearcoat: 0.0,
            clearcoat_texture: None,
            clearcoat_roughness: 0.0,
            clearcoat_roughness_texture: None,
            sheen_color: Vec3::ZERO,
            sheen_color_texture: None,
            sheen_roughness: 0.0,
            sheen_roughness_texture: None,
            unlit: false,
        }
    }
}

/// Tells what a material's opacity does.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum AlphaMode {
    /// Nothing: all is opaque.
    #[default]
    Opaque,
    /// What is less than this opacity is not there, the rest is opaque.
    Mask(f32),
    /// It is mixed with what lies behind.
    Blend,
}

/// Tells where a material finds its picture, and how it is looked up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Texture {
    /// The index of the picture.
    pub image: usize,
    /// The set of texture coordinates, 0 or 1.
    pub set: u32,
    /// What texture coordinates are mapped by before the picture is looked up.
    pub transform: Affine2,
    /// What lies beyond the picture along u and v.
    pub wrap: [Wrap; 2],
    /// What lies between two texels.
    pub filter: Filter,
}

/// Tells what lies beyond a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wrap {
    /// The picture again.
    #[default]
    Repeat,
    /// The picture again, each second one mirrored.
    Mirror,
    /// Its edge.
    Clamp,
}

/// Tells what lies between two texels. Mip levels are the renderer's matter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Filter {
    /// The nearest of them.
    Nearest,
    /// A mix of them.
    #[default]
    Linear,
}

/// Holds a picture of 8 bits for each channel. The material that uses it tells its colour space.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Image {
    /// What the file calls it; may be empty.
    pub name: String,
    /// Texels in a row, from 1 to 16384.
    pub width: u32,
    /// Rows, from 1 to 16384.
    pub height: u32,
    /// Red, green, blue and alpha, row by row from the top. Grey is in all three colours, alpha 255
    /// where the file has none, and 16 bits are rounded to 8.
    pub texels: Vec<[u8; 4]>,
}

/// Holds a light without a size.
#[derive(Clone, Debug, PartialEq)]
pub struct PunctualLight {
    /// What the file calls it; may be empty.
    pub name: String,
    /// Its place in the world.
    pub position: Vec3,
    /// The unit vector along which it shines; of no meaning for a point.
    pub direction: Vec3,
    /// The linear colour times the intensity, not negative: in candela (lumen per steradian), or in
    /// lux (lumen per square metre) for a directional light.
    pub intensity: Vec3,
    /// The distance, above 0, in units of the world, beyond which it may be left out; `None` is
    /// infinite.
    pub range: Option<f32>,
    /// Its shape.
    pub kind: LightKind,
}

/// Tells the shape of a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// It shines from a point to all sides.
    Point,
    /// It shines from a point into a cone.
    Spot {
        /// The angle from the axis, in radians, up to which it is of full intensity; 0 or more.
        inner: f32,
        /// The angle from the axis, in radians, from which on it is dark; above `inner`, at most
        /// half of pi.
        outer: f32,
    },
    /// It shines from afar.
    Directional,
}

/// Holds a camera.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// What the file calls it; may be empty.
    pub name: String,
    /// Its place in the world.
    pub position: Vec3,
    /// The unit vector along which it looks.
    pub forward: Vec3,
    /// The unit vector that is up in its picture, at a right angle to `forward`.
    pub up: Vec3,
    /// How it makes its picture.
    pub projection: Projection,
}

/// Tells how a camera makes its picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Rays from a point.
    Perspective {
        /// The angle of view from bottom to top, in radians, above 0 and below pi.
        vertical: f32,
        /// Width over height, above 0; `None` leaves it to the picture.
        aspect: Option<f32>,
        /// The least distance of what is seen, above 0.
        near: f32,
        /// The greatest distance of what is seen, above `near`; `None` is infinite.
        far: Option<f32>,
    },
    /// Parallel rays.
    Orthographic {
        /// Half the width and half the height of what is seen, not 0.
        half_size: Vec2,
        /// The least distance of what is seen, 0 or more.
        near: f32,
        /// The greatest distance of what is seen, above `near`.
        far: f32,
    },
}

type Reading = fn(Source) -> Result<Scene, LoadError>;

const FORMATS: [Format<Reading>; 3] = [
    Format {
        extension: "gltf",
        name: "glTF",
        feature: "gltf",
        read: loader!("gltf", crate::scene::gltf::read),
    },
    Format {
        extension: "glb",
        name: "glTF",
        feature: "gltf",
        read: loader!("gltf", crate::scene::gltf::read),
    },
    Format {
        extension: "obj",
        name: "OBJ",
        feature: "mtl",
        read: loader!("mtl", crate::scene::obj::read),
    },
];

/// Loads a scene by its file's extension, in any case: `.gltf`, `.glb` or `.obj`.
///
/// There is at least one instance of a mesh, all indices are those of elements, and all numbers are
/// finite, but for an infinite [`Material::attenuation_distance`].
///
/// # Errors
///
/// When the file, or one that it names, is missing, unreadable, cut off, corrupt or outside its
/// folder; when the file is of unknown extension, requires an extension of glTF that is not
/// supported, holds no triangle, or a number that is not finite or out of its range; and when it
/// has pictures above 16384 texels a side or 2^28 in all, or would take far more memory than its
/// size explains.
///
/// # Examples
///
/// ```no_run
/// let scene = raydsl_io::scene::load("room.glb")?;
/// for instance in &scene.instances {
///     let mesh = &scene.meshes[instance.mesh];
///     let material = &scene.materials[mesh.material];
///     println!("{}: {} triangles of {}", instance.name, mesh.triangles.len(), material.name);
/// }
/// # Ok::<(), raydsl_io::LoadError>(())
/// ```
pub fn load(path: impl AsRef<Path>) -> Result<Scene, LoadError> {
    let path = path.as_ref();
    let (format, read) = format::of(path, &FORMATS)?;
    let scene = read(Source::open(path, format.name)?)?;
    if scene.instances.is_empty() {
        return Err(LoadError::Empty { path: path.into(), what: "triangle" });
    }
    Ok(scene)
}

/// An error if any of a list is not finite.
#[cfg(any(feature = "gltf", feature = "mtl"))]
fn check_finite<T>(
    path: &Path,
    what: &'static str,
    list: &[T],
    is_finite: impl Fn(&T) -> bool,
) -> Result<(), LoadError> {
    let Some(first) = list.iter().position(|v| !is_finite(v)) else { return Ok(()) };
    Err(LoadError::NotFinite {
        path: path.into(),
        what,
        count: list.iter().filter(|v| !is_finite(v)).count(),
        total: list.len(),
        first,
        remedy: "remove what has it, and write the file again",
    })
}

/// A name of the file, of bounded length.
#[cfg(any(feature = "gltf", feature = "mtl"))]
fn name(text: Option<&str>) -> String {
    text.unwrap_or_default().chars().take(256).collect()
}
