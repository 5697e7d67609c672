//! Small scenes that tests write.

use std::io::Cursor;

use super::*;
use crate::scene::{self, Scene};

/// Writes the buffer of a glTF file, its views and accessors.
#[derive(Default)]
pub(super) struct Builder {
    pub(super) bin: Vec<u8>,
    pub(super) views: Vec<String>,
    pub(super) accessors: Vec<String>,
}

impl Builder {
    /// Adds a view; gives its index.
    pub(super) fn view(&mut self, bytes: &[u8], more: &str) -> usize {
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        let (at, len) = (self.bin.len(), bytes.len());
        self.bin.extend(bytes);
        self.views.push(format!(r#"{{"buffer":0,"byteOffset":{at},"byteLength":{len}{more}}}"#));
        self.views.len() - 1
    }

    /// Adds an accessor with a view of its own; gives its index.
    pub(super) fn accessor(&mut self, bytes: &[u8], kind: u32, shape: &str, count: usize) -> usize {
        let view = self.view(bytes, "");
        self.accessor_of(&format!(r#""bufferView":{view}"#), kind, shape, count)
    }

    pub(super) fn accessor_of(
        &mut self,
        more: &str,
        kind: u32,
        shape: &str,
        count: usize,
    ) -> usize {
        self.accessors
            .push(format!(r#"{{{more},"componentType":{kind},"count":{count},"type":"{shape}"}}"#));
        self.accessors.len() - 1
    }

    pub(super) fn floats(&mut self, numbers: &[f32], shape: &str) -> usize {
        let width = match shape {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            _ => 4,
        };
        self.accessor(&bytes_of(numbers), 5126, shape, numbers.len() / width)
    }

    /// The JSON, with a URI of the buffer unless that is empty.
    pub(super) fn json(&self, uri: &str, more: &str) -> String {
        let uri = if uri.is_empty() { String::new() } else { format!(r#","uri":"{uri}""#) };
        format!(
            r#"{{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":{}{uri}}}],
            "bufferViews":[{}],"accessors":[{}],{more}}}"#,
            self.bin.len(),
            self.views.join(","),
            self.accessors.join(",")
        )
    }

    pub(super) fn glb(&self, more: &str) -> Vec<u8> {
        glb(&self.json("", more), &self.bin)
    }
}

pub(super) fn bytes_of(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|x| x.to_le_bytes()).collect()
}

pub(super) fn glb(json: &str, bin: &[u8]) -> Vec<u8> {
    let padded = |bytes: &[u8], with: u8| {
        let mut bytes = bytes.to_vec();
        bytes.resize(bytes.len().next_multiple_of(4), with);
        bytes
    };
    let (json, bin) = (padded(json.as_bytes(), b' '), padded(bin, 0));
    let mut out = b"glTF".to_vec();
    out.extend(2u32.to_le_bytes());
    out.extend((12 + 8 + json.len() as u32 + 8 + bin.len() as u32).to_le_bytes());
    out.extend((json.len() as u32).to_le_bytes());
    out.extend(b"JSON");
    out.extend(json);
    out.extend((bin.len() as u32).to_le_bytes());
    out.extend(b"BIN\0");
    out.extend(bin);
    out
}

pub(super) fn base64(bytes: &[u8]) -> String {
    let letters = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for group in bytes.chunks(3) {
        let mut bits = [0; 4];
        bits[1..=group.len()].copy_from_slice(group);
        let bits = u32::from_be_bytes(bits);
        for i in 0..4 {
            let letter = letters[(bits >> (18 - 6 * i)) as usize & 63];
            text.push(if i <= group.len() { char::from(letter) } else { '=' });
        }
    }
    text
}

/// A picture of 2 x 2 texels.
pub(super) fn picture(format: image::ImageFormat) -> Vec<u8> {
    let mut picture = image::RgbImage::new(2, 2);
    picture.put_pixel(0, 0, image::Rgb([255, 0, 0]));
    picture.put_pixel(1, 0, image::Rgb([0, 255, 0]));
    let mut out = Cursor::new(Vec::new());
    picture.write_to(&mut out, format).expect("a picture");
    out.into_inner()
}

pub(super) const SQUARE: [f32; 12] = [0., 0., 0., 1., 0., 0., 1., 1., 0., 0., 1., 0.];

/// All that is read of a glTF file, in one.
pub(super) fn everything() -> Builder {
    let mut b = Builder::default();
    b.floats(&SQUARE, "VEC3");
    b.floats(&[0., 0., 1.].repeat(4), "VEC3");
    b.floats(&[0., 0., 1., 0., 1., 1., 0., 1.], "VEC2");
    b.floats(&[1., 0., 0., -1.].repeat(4), "VEC4");
    let colors = b.view(&[255, 0, 51, 255].repeat(4), "");
    let colors = format!(r#""bufferView":{colors},"normalized":true"#);
    b.accessor_of(&colors, 5121, "VEC4", 4);
    b.accessor(&[0u16, 1, 2, 0, 2, 3].map(u16::to_le_bytes).concat(), 5123, "SCALAR", 6);
    // Sparse, of nothing else: the third vertex is elsewhere.
    let (indices, values) = (b.view(&[2], ""), b.view(&bytes_of(&[5., 6., 7.]), ""));
    let sparse = format!(
        r#""sparse":{{"count":1,"indices":{{"bufferView":{indices},"componentType":5121}},
        "values":{{"bufferView":{values}}}}}"#
    );
    b.accessor_of(&sparse, 5126, "VEC3", 3);
    b.view(&picture(image::ImageFormat::Png), "");
    b.view(&picture(image::ImageFormat::Jpeg), "");
    b
}

/// The rest of the JSON that belongs to `everything`.
pub(super) const REST: &str = r#"
"extensionsUsed":["KHR_materials_clearcoat"],"extensionsRequired":["KHR_texture_transform"],
"scene":0,"scenes":[{"nodes":[0,3]}],
"nodes":[
 {"name":"top","translation":[1,2,3],"rotation":[0,0.70710678,0,0.70710678],"scale":[2,2,2],"mesh":0,"children":[1,2]},
 {"name":"sun","extensions":{"KHR_lights_punctual":{"light":0}}},
 {"camera":0,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,1,0,0,1]},
 {"mesh":1,"camera":1,"extensions":{"KHR_lights_punctual":{"light":1}},"children":[4]},
 {"extensions":{"KHR_lights_punctual":{"light":2}}}],
"meshes":[
 {"name":"square","primitives":[
  {"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2,"TEXCOORD_1":2,"TANGENT":3,"COLOR_0":4,"_EXTRA":4},"indices":5,"material":0},
  {"attributes":{"POSITION":0},"mode":5},
  {"attributes":{"POSITION":0},"mode":6,"material":1},
  {"attributes":{"POSITION":0},"mode":1}]},
 {"primitives":[{"attributes":{"POSITION":6}}]}],
"materials":[
 {"name":"all","pbrMetallicRoughness":{"baseColorFactor":[0.1,0.2,0.3,0.4],"metallicFactor":0.5,"roughnessFactor":0.25,
  "baseColorTexture":{"index":0,"texCoord":1,"extensions":{"KHR_texture_transform":{"offset":[0.5,0.25],"rotation":1.57079633,"scale":[2,3]}}},
  "metallicRoughnessTexture":{"index":1}},
  "normalTexture":{"index":0,"scale":0.5},"emissiveFactor":[1,0.5,0],"emissiveTexture":{"index":1},
  "occlusionTexture":{"index":0},"alphaMode":"MASK","alphaCutoff":0.75,"doubleSided":true,
  "extensions":{"KHR_materials_ior":{"ior":1.33},"KHR_materials_emissive_strength":{"emissiveStrength":4},
  "KHR_materials_transmission":{"transmissionFactor":0.9,"transmissionTexture":{"index":1}},
  "KHR_materials_volume":{"thicknessFactor":0.1,"attenuationDistance":2,"attenuationColor":[0.5,0.6,0.7]},
  "KHR_materials_specular":{"specularFactor":0.8,"specularTexture":{"index":0},
   "specularColorFactor":[1,0.9,2],"specularColorTexture":{"index":1}},
  "KHR_materials_clearcoat":{"clearcoatFactor":1,"clearcoatTexture":{"index":1},
   "clearcoatRoughnessFactor":0.1,"clearcoatRoughnessTexture":{"index":0}},
  "KHR_materials_sheen":{"sheenColorFactor":[0.3,0.2,0.1],"sheenColorTexture":{"index":0},
   "sheenRoughnessFactor":0.6,"sheenRoughnessTexture":{"index":1}},
  "KHR_materials_unlit":{}}},
 {"alphaMode":"BLEND"}],
"textures":[{"source":0,"sampler":0},{"source":1}],
"samplers":[{"wrapS":33071,"wrapT":33648,"magFilter":9728}],
"images":[{"name":"dots","bufferView":8,"mimeType":"image/png"},{"bufferView":9,"mimeType":"image/jpeg"}],
"cameras":[{"type":"perspective","perspective":{"yfov":0.8,"aspectRatio":1.5,"znear":0.01}},
 {"type":"orthographic","orthographic":{"xmag":2,"ymag":1,"znear":0,"zfar":10}}],
"extensions":{"KHR_lights_punctual":{"lights":[
 {"type":"directional","intensity":3,"color":[1,0.5,0.25]},
 {"type":"spot","intensity":10,"range":20,"spot":{"innerConeAngle":0.1,"outerConeAngle":0.5},"name":"lamp"},
 {"type":"point"}]}}"#;

/// All that is read of OBJ and MTL.
pub(super) const OBJ: &str = "\
# made by hand
mtllib scene.mtl
v 0 0 0
v 1 0 0 1 0.5 0
v 1 1 0
v 0 1 0
vt 0 0
vt 1 0
vt 1 1
vt 0.25 0.75
vn 0 0 1
f 1 2 3
o square
usemtl wood
f 1/1/1 2/2/1 3/3/1 4/4/1
g more
usemtl glass
f -4//-1 -3//-1 -2//-1
";

pub(super) const MTL: &str = "\
# made by hand
newmtl wood
Kd 0.5 0.25 0.125
Ks 0.2 0.2 0.2
Ns 30
illum 2
map_Kd -s 2 2 1 -o 0.5 0 -clamp on dots.png
newmtl glass
Kd 0 0 0
Tf 1 0.9 0.8
Ni 1.33
illum 7
newmtl lamp
Ke 5 4 3
d 0.5
";

/// A folder with files, removed at the end.
pub(super) struct Folder(pub(super) PathBuf);

impl Folder {
    pub(super) fn new(files: &[(&str, &[u8])]) -> Self {
        static NEXT: AtomicU32 = AtomicU32::new(0);
        let n = NEXT.fetch_add(1, Ordering::Relaxed);
        let name = format!("raydsl-io-scene-{}-{n}", std::process::id());
        let folder = Self(std::env::temp_dir().join(name));
        std::fs::create_dir_all(&folder.0).expect("a folder");
        for (name, bytes) in files {
            folder.write(name, bytes);
        }
        folder
    }

    /// A folder with an OBJ, its MTL and picture.
    pub(super) fn obj() -> Self {
        let png = picture(image::ImageFormat::Png);
        Self::new(&[
            ("scene.obj", OBJ.as_bytes()),
            ("scene.mtl", MTL.as_bytes()),
            ("dots.png", &png),
        ])
    }

    pub(super) fn write(&self, name: &str, bytes: &[u8]) {
        let path = self.0.join(name);
        // Some file systems wait for the disc where a file is overwritten.
        let _ = std::fs::remove_file(&path);
        std::fs::write(path, bytes).expect("a file");
    }

    pub(super) fn load(&self, name: &str) -> Result<Scene, LoadError> {
        scene::load(self.0.join(name))
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // Left behind at worst.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// Checks what the documentation promises, of a scene or of an error.
pub(super) fn check_scene(found: &Result<Scene, LoadError>, what: &str) {
    let scene = match found {
        Ok(scene) => scene,
        Err(e) => {
            let text = e.to_string();
            assert!(!text.contains('\n') && text.contains(';'), "{what}: {text}");
            return;
        }
    };
    assert!(!scene.instances.is_empty(), "{what}");
    for instance in &scene.instances {
        assert!(instance.mesh < scene.meshes.len() && instance.transform.is_finite(), "{what}");
    }
    for mesh in &scene.meshes {
        let count = mesh.positions.len();
        assert!(mesh.material < scene.materials.len() && !mesh.triangles.is_empty(), "{what}");
        assert!(mesh.triangles.as_flattened().iter().all(|i| (*i as usize) < count), "{what}");
        let lens = [mesh.normals.len(), mesh.uvs.len(), mesh.uvs1.len(), mesh.tangents.len()];
        assert!(lens.iter().chain([&mesh.colors.len()]).all(|n| [0, count].contains(n)), "{what}");
        assert!(mesh.positions.iter().chain(&mesh.normals).all(|v| v.is_finite()), "{what}");
        assert!(mesh.uvs.iter().chain(&mesh.uvs1).all(|v| v.is_finite()), "{what}");
        assert!(mesh.tangents.iter().chain(&mesh.colors).all(|v| v.is_finite()), "{what}");
    }
    for image in &scene.images {
        assert_eq!(image.texels.len() as u32, image.width * image.height, "{what}");
    }
    scene.materials.iter().for_each(|material| check_material(scene, material, what));
    for light in &scene.lights {
        assert!(light.intensity.is_finite() && light.intensity.min_element() >= 0.0, "{what}");
        assert!(light.position.is_finite() && light.direction.is_normalized(), "{what}");
    }
    for camera in &scene.cameras {
        assert!(camera.forward.is_normalized() && camera.up.is_normalized(), "{what}");
        assert!(camera.position.is_finite(), "{what}");
        assert!(camera.forward.dot(camera.up).abs() < 1e-4, "{what}");
    }
}

fn check_material(scene: &Scene, m: &scene::Material, what: &str) {
    let shares = [m.metallic, m.roughness, m.transmission, m.specular, m.clearcoat];
    let more = [m.clearcoat_roughness, m.sheen_roughness];
    let colors = [m.base_color.truncate(), m.attenuation_color, m.sheen_color];
    let colors = colors.map(|c| c.to_array()).concat();
    let is_share = |x: &f32| (0.0..=1.0).contains(x);
    assert!(shares.iter().chain(&more).chain(&colors).all(is_share), "{what}: {m:?}");
    assert!(is_share(&m.base_color.w), "{what}");
    for light in [m.emissive, m.specular_color] {
        assert!(light.is_finite() && light.min_element() >= 0.0, "{what}: {m:?}");
    }
    assert!((m.ior == 0.0 || m.ior >= 1.0) && m.ior.is_finite(), "{what}: {}", m.ior);
    assert!(m.normal_scale.is_finite() && m.thickness >= 0.0 && m.thickness.is_finite(), "{what}");
    assert!(m.attenuation_distance > 0.0, "{what}");
    let textures = [
        m.base_color_texture,
        m.metallic_roughness_texture,
        m.normal_texture,
        m.emissive_texture,
        m.transmission_texture,
    ];
    for texture in textures.iter().flatten() {
        assert!(texture.image < scene.images.len() && texture.set < 2, "{what}");
        assert!(texture.transform.is_finite(), "{what}");
    }
}
