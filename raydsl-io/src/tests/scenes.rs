use std::io::Write;
use std::time::Instant;

use glam::{Affine3A, Quat, Vec2, Vec3, Vec4, vec2, vec3};

use super::scene_files::*;
use super::*;
use crate::scene::{
    self, AlphaMode, Filter, LightKind, Material, Projection, Scene, Texture, Wrap,
};

fn load_glb(bytes: &[u8]) -> Result<Scene, LoadError> {
    scene::load(&Temp::new("glb", bytes).0)
}

/// The error's message.
fn error(bytes: &[u8]) -> String {
    let found = load_glb(bytes);
    check_scene(&found, "an error");
    found.expect_err("an error").to_string()
}

fn close(a: Vec3, b: Vec3) {
    assert!(a.abs_diff_eq(b, 1e-5), "{a} {b}");
}

/// One primitive, in one node.
fn primitive(b: &Builder, text: &str) -> Vec<u8> {
    b.glb(&format!(
        r#""scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{text}]}}]"#
    ))
}

#[test]
fn a_scene_is_whole() {
    let scene = load_glb(&everything().glb(REST)).expect("a scene");
    check_scene(&Ok(scene.clone()), "everything");
    let [square, strip, fan, sparse] = &scene.meshes[..] else { panic!("{}", scene.meshes.len()) };
    assert_eq!(square.name, "square");
    assert_eq!(square.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(square.positions[2], vec3(1.0, 1.0, 0.0));
    assert_eq!(square.normals, [Vec3::Z; 4]);
    assert_eq!(square.uvs[2], vec2(1.0, 1.0));
    assert_eq!(square.uvs1, square.uvs);
    assert_eq!(square.tangents, [Vec4::new(1.0, 0.0, 0.0, -1.0); 4]);
    assert_eq!(square.colors, [Vec4::new(1.0, 0.0, 0.2, 1.0); 4]);
    assert_eq!(strip.triangles, [[0, 1, 2], [2, 1, 3]]);
    assert_eq!(fan.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(sparse.positions, [Vec3::ZERO, Vec3::ZERO, vec3(5.0, 6.0, 7.0)]);
    // The default material is behind those of the file.
    assert_eq!([square, strip, fan, sparse].map(|m| m.material), [0, 2, 1, 2]);
    assert_eq!(scene.materials.len(), 3);
    assert_eq!(scene.materials[2], Material::default());
    assert_eq!(scene.materials[1].alpha_mode, AlphaMode::Blend);
    assert_eq!(scene.instances.len(), 4);
    assert_eq!(scene.instances[0].name, "top");
    let transform = Affine3A::from_scale_rotation_translation(
        Vec3::splat(2.0),
        Quat::from_rotation_y(std::f32::consts::FRAC_PI_2),
        vec3(1.0, 2.0, 3.0),
    );
    assert!(scene.instances[0].transform.abs_diff_eq(transform, 1e-5));
    assert_eq!(scene.instances[3].transform, Affine3A::IDENTITY);
}

#[test]
fn a_material_is_whole() {
    let scene = load_glb(&everything().glb(REST)).expect("a scene");
    let dots = Texture {
        image: 0,
        set: 0,
        transform: glam::Affine2::IDENTITY,
        wrap: [Wrap::Clamp, Wrap::Mirror],
        filter: Filter::Nearest,
    };
    let other = Texture { image: 1, wrap: [Wrap::Repeat; 2], filter: Filter::Linear, ..dots };
    let m = &scene.materials[0];
    let base = m.base_color_texture.expect("a texture");
    let expected = Material {
        name: "all".into(),
        base_color: Vec4::new(0.1, 0.2, 0.3, 0.4),
        base_color_texture: Some(base),
        metallic: 0.5,
        roughness: 0.25,
        metallic_roughness_texture: Some(other),
        normal_texture: Some(dots),
        normal_scale: 0.5,
        emissive: vec3(4.0, 2.0, 0.0),
        emissive_texture: Some(other),
        alpha_mode: AlphaMode::Mask(0.75),
        double_sided: true,
        ior: 1.33,
        transmission: 0.9,
        transmission_texture: Some(other),
        thickness: 0.1,
        attenuation_distance: 2.0,
        attenuation_color: vec3(0.5, 0.6, 0.7),
        specular: 0.8,
        specular_texture: Some(dots),
        specular_color: vec3(1.0, 0.9, 2.0),
        specular_color_texture: Some(other),
        clearcoat: 1.0,
        clearcoat_texture: Some(other),
        clearcoat_roughness: 0.1,
        clearcoat_roughness_texture: Some(dots),
        sheen_color: vec3(0.3, 0.2, 0.1),
        sheen_color_texture: Some(dots),
        sheen_roughness: 0.6,
        sheen_roughness_texture: Some(other),
        unlit: true,
    };
    assert_eq!(m, &expected);
    assert_eq!((base.image, base.set, base.filter), (0, 1, Filter::Nearest));
    // A quarter turn counter-clockwise, with v down: u to the right becomes up.
    let at = |u, v| base.transform.transform_point2(vec2(u, v));
    let near = |a: Vec2, b: Vec2| assert!(a.abs_diff_eq(b, 1e-5), "{a} {b}");
    near(at(0.0, 0.0), vec2(0.5, 0.25));
    near(at(1.0, 0.0), vec2(0.5, -1.75));
    near(at(0.0, 1.0), vec2(3.5, 0.25));
    let [dots, jpeg] = &scene.images[..] else { panic!("{}", scene.images.len()) };
    assert_eq!((dots.name.as_str(), dots.width, dots.height), ("dots", 2, 2));
    assert_eq!(dots.texels, [[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 0, 255], [0, 0, 0, 255]]);
    assert_eq!((jpeg.width, jpeg.height, jpeg.texels[3][3]), (2, 2, 255));
}

#[test]
fn lights_and_cameras_are_in_the_world() {
    let scene = load_glb(&everything().glb(REST)).expect("a scene");
    let [sun, lamp, point] = &scene.lights[..] else { panic!("{}", scene.lights.len()) };
    assert_eq!((sun.name.as_str(), sun.kind), ("sun", LightKind::Directional));
    assert_eq!(sun.intensity, vec3(3.0, 1.5, 0.75));
    // Turned by a quarter around y, -z is -x.
    close(sun.direction, Vec3::NEG_X);
    close(sun.position, vec3(1.0, 2.0, 3.0));
    assert_eq!(lamp.kind, LightKind::Spot { inner: 0.1, outer: 0.5 });
    assert_eq!((lamp.name.as_str(), lamp.range), ("lamp", Some(20.0)));
    assert_eq!((point.kind, point.intensity), (LightKind::Point, Vec3::ONE));
    let [first, second] = &scene.cameras[..] else { panic!("{}", scene.cameras.len()) };
    close(first.position, vec3(1.0, 2.0, 1.0));
    close(first.forward, Vec3::NEG_X);
    close(first.up, Vec3::Y);
    let projection =
        Projection::Perspective { vertical: 0.8, aspect: Some(1.5), near: 0.01, far: None };
    assert_eq!(first.projection, projection);
    let half_size = vec2(2.0, 1.0);
    assert_eq!(second.projection, Projection::Orthographic { half_size, near: 0.0, far: 10.0 });
}

#[test]
fn indices_are_of_all_types() {
    let list = [0u32, 1, 2, 2, 3, 0];
    let kinds = [
        (5121, list.map(|i| i as u8).to_vec()),
        (5123, list.map(|i| (i as u16).to_le_bytes()).concat()),
        (5125, list.map(u32::to_le_bytes).concat()),
    ];
    for (kind, bytes) in kinds {
        let mut b = Builder::default();
        b.floats(&SQUARE, "VEC3");
        b.accessor(&bytes, kind, "SCALAR", 6);
        let file = primitive(&b, r#"{"attributes":{"POSITION":0},"indices":1}"#);
        let scene = load_glb(&file).expect("a scene");
        assert_eq!(scene.meshes[0].triangles, [[0, 1, 2], [2, 3, 0]], "{kind}");
    }
}

#[test]
fn attributes_are_interleaved_and_normalised() {
    let mut b = Builder::default();
    let (position, normal) = ([[0i16, 0, 0], [32767, 0, 0], [0, -32768, 0]], [0i8, 0, 127]);
    let mut bytes = Vec::new();
    for position in position {
        bytes.extend(position.map(i16::to_le_bytes).concat());
        bytes.extend([0, 0]);
        bytes.extend(normal.map(|x| x as u8));
        bytes.push(0);
    }
    let view = b.view(&bytes, r#","byteStride":12"#);
    let at = |at| format!(r#""bufferView":{view},"normalized":true,"byteOffset":{at}"#);
    b.accessor_of(&at(0), 5122, "VEC3", 3);
    b.accessor_of(&at(8), 5120, "VEC3", 3);
    let file = primitive(&b, r#"{"attributes":{"POSITION":0,"NORMAL":1}}"#);
    let mesh = load_glb(&file).expect("a scene").meshes.remove(0);
    assert_eq!(mesh.positions, [Vec3::ZERO, Vec3::X, Vec3::NEG_Y]);
    assert_eq!(mesh.normals, [Vec3::Z; 3]);
}

/// Primitives that share the vertices of a mesh keep what they use.
#[test]
fn shared_vertices_are_shared_out() {
    let mut b = Builder::default();
    b.floats(&[SQUARE, SQUARE.map(|x| x + 7.0)].concat(), "VEC3");
    b.accessor(&[7, 5, 6], 5121, "SCALAR", 3);
    let file = primitive(&b, r#"{"attributes":{"POSITION":0},"indices":1}"#);
    let mesh = load_glb(&file).expect("a scene").meshes.remove(0);
    assert_eq!(mesh.triangles, [[2, 0, 1]]);
    assert_eq!(mesh.positions, [[8., 7., 7.], [8., 8., 7.], [7., 8., 7.]].map(Vec3::from));
}

#[test]
fn buffers_are_beside_or_within() {
    let (b, png) = (everything(), picture(image::ImageFormat::Png));
    let whole = load_glb(&b.glb(REST)).expect("a scene");
    let folder = Folder::new(&[("a b.bin", &b.bin), ("dots.png", &png)]);
    let uri = format!("data:application/octet-stream;base64,{}", base64(&b.bin));
    folder.write("within.gltf", b.json(&uri, REST).as_bytes());
    folder.write("beside.GLTF", b.json("./a%20b.bin", REST).as_bytes());
    let rest = REST.replace(r#""bufferView":8"#, r#""uri":"dots.png""#);
    folder.write("picture.gltf", b.json("a%20b.bin", &rest).as_bytes());
    for name in ["within.gltf", "beside.GLTF", "picture.gltf"] {
        assert_eq!(folder.load(name).expect("a scene"), whole, "{name}");
    }
    let refused = |uri: &str| {
        folder.write("bad.gltf", b.json(uri, REST).as_bytes());
        let found = folder.load("bad.gltf");
        check_scene(&found, uri);
        found.expect_err("an error").to_string()
    };
    for uri in
        ["../a.bin", "/etc/passwd", "http://a.b/c.bin", "file:a.bin", "a/../../b", "%2e%2e/a"]
    {
        assert!(refused(uri).contains("is no file in its folder or below"), "{uri}");
    }
    assert!(refused("none.bin").contains("none.bin: no such file"));
    assert!(refused("dots.png").contains("buffers[0] claims"));
    assert!(refused("data:;base64,!!!").contains("is no base64 data"));
    assert!(refused("%zz").contains("is not percent-encoded"));
}

#[test]
fn extensions_that_are_required_are_known() {
    for (name, remedy) in [
        ("KHR_draco_mesh_compression", "without compression"),
        ("EXT_meshopt_compression", "without compression"),
        ("KHR_texture_basisu", "PNG or JPEG"),
        ("EXT_texture_webp", "PNG or JPEG"),
        ("XYZ_none", "without this extension"),
    ] {
        let json = format!(r#"{{"asset":{{"version":"2.0"}},"extensionsRequired":["{name}"]}}"#);
        let found = load_glb(&glb(&json, &[]));
        let Err(e) = &found else { panic!("{name}") };
        assert!(matches!(e, LoadError::Extension { extension, .. } if extension == name), "{e}");
        assert!(e.to_string().contains(remedy), "{e}");
    }
    // One that is only used is not missed before its data are.
    let draco = r#""extensionsUsed":["KHR_draco_mesh_compression"]"#;
    let rest = REST.replace(r#""extensionsUsed":["KHR_materials_clearcoat"]"#, draco);
    let mut b = everything();
    load_glb(&b.glb(&rest)).expect("a scene");
    b.accessors[0] = r#"{"componentType":5126,"count":4,"type":"VEC3"}"#.into();
    assert!(error(&b.glb(&rest)).contains("needs the extension KHR_draco_mesh_compression"));
    // One that is only used is left out, unless a picture is in no other form.
    let rest =
        REST.replace(r#"{"source":1}"#, r#"{"extensions":{"KHR_texture_basisu":{"source":1}}}"#);
    assert!(error(&everything().glb(&rest)).contains("KHR_texture_basisu"));
}

/// What is replaced in a file, and what its error says.
const WRONG: [(&str, &str, &str); 29] = [
    (r#""version":"2.0""#, r#""version":"1.0""#, "it is of version '1.0'"),
    (r#""scene":0"#, r#""scene":3"#, "scenes[3]"),
    (r#""children":[4]"#, r#""children":[3]"#, "nodes[3] is in the scene twice"),
    (r#""children":[4]"#, r#""children":[1]"#, "nodes[1] is in the scene twice"),
    (r#""children":[4]"#, r#""children":[99]"#, "nodes[99]"),
    (r#""rotation":[0,0.70710678"#, r#""rotation":[0,1e38"#, "no unit quaternion"),
    (r#""scale":[2,2,2]"#, r#""scale":[2,2,0]"#, "has no direction"),
    (r#""scale":[2,2,2]"#, r#""scale":[3e38,3e39,2]"#, "not finite"),
    ("1,0,0,1]", "1,0,0,2]", "the last row of its matrix"),
    (r#""light":1"#, r#""light":7"#, "lights[7]"),
    (r#""intensity":3"#, r#""intensity":-3"#, "intensity of its light"),
    (r#""range":20"#, r#""range":0"#, "range of its light"),
    (r#""innerConeAngle":0.1"#, r#""innerConeAngle":0.6"#, "angles of its light"),
    (r#""type":"spot""#, r#""type":"tube""#, "KHR_lights_punctual"),
    (r#""yfov":0.8"#, r#""yfov":4"#, "cameras[0]"),
    (r#""zfar":10"#, r#""zfar":0"#, "cameras[1]"),
    (r#""mode":5"#, r#""mode":9"#, "mode of a primitive"),
    (r#""indices":5"#, r#""indices":0"#, "not of indices"),
    (r#""indices":5"#, r#""indices":55"#, "accessors[55]"),
    (r#""NORMAL":1"#, r#""NORMAL":6"#, "a primitive of 4 positions has 3 normals"),
    (r#""NORMAL":1"#, r#""NORMAL":2"#, "normals of 2 components"),
    (r#""material":1"#, r#""material":5"#, "materials[5]"),
    (r#""texCoord":1"#, r#""texCoord":2"#, "of set 2"),
    (r#""source":1"#, r#""source":8"#, "images[8]"),
    (r#""alphaMode":"MASK""#, r#""alphaMode":"GLOW""#, "alphaMode"),
    (r#""emissiveStrength":4"#, r#""emissiveStrength":-4"#, "emissive factor"),
    (r#""ior":1.33"#, r#""ior":"glass""#, "KHR_materials_ior"),
    (r#""attenuationDistance":2"#, r#""attenuationDistance":0"#, "attenuation distance"),
    (r#""bufferView":9"#, r#""bufferView":0"#, "images[1]: it is neither PNG nor JPEG"),
];

#[test]
fn errors_name_what_is_wrong() {
    let b = everything();
    for (from, to, what) in WRONG {
        let json = b.json("", REST);
        assert!(json.contains(from), "{from}");
        let text = error(&glb(&json.replacen(from, to, 1), &b.bin));
        assert!(text.contains(what), "{to}: {text}");
    }
}

#[test]
fn accessors_stay_within_their_views() {
    let at_square = r#""bufferView":0"#;
    for (more, count, what) in [
        (at_square, "5", "beyond their view of 48 bytes"),
        (at_square, "18446744073709551615", "its count is 18446744073709551615"),
        (at_square, "4294967294", "beyond their view"),
        (at_square, "0", "its count is 0"),
        (r#""bufferView":0,"byteOffset":4"#, "4", "from byte 4 end beyond"),
        (r#""bufferView":0,"byteOffset":18446744073709551615"#, "4", "beyond their view"),
        (r#""bufferView":1"#, "4", "bufferViews[1]"),
        (r#""bufferView":2"#, "4", "48 bytes from 4, beyond its buffer"),
        (r#""bufferView":3"#, "4", "elements of 12 bytes lie 4 apart"),
        (r#""normalized":false"#, "4", "it has no bufferView"),
        (
            r#""sparse":{"count":1,"indices":{"bufferView":0,"componentType":5121},"values":{"bufferView":0}}"#,
            "4000000000",
            "more than the file has bytes",
        ),
        (
            r#""sparse":{"count":9,"indices":{"bufferView":0,"componentType":5121},"values":{"bufferView":0}}"#,
            "4",
            "the count of its sparse part",
        ),
        (
            r#""sparse":{"count":2,"indices":{"bufferView":0,"componentType":5121},"values":{"bufferView":0}}"#,
            "4",
            "sparse indices do not rise",
        ),
    ] {
        let mut b = Builder::default();
        b.view(&bytes_of(&SQUARE), "");
        b.views.push(r#"{"buffer":9,"byteLength":4}"#.into());
        b.views.push(r#"{"buffer":0,"byteOffset":4,"byteLength":48}"#.into());
        b.views.push(r#"{"buffer":0,"byteLength":48,"byteStride":4}"#.into());
        b.accessors
            .push(format!(r#"{{{more},"componentType":5126,"count":{count},"type":"VEC3"}}"#));
        let text = error(&primitive(&b, r#"{"attributes":{"POSITION":0}}"#));
        // The first wrong thing of a file with several may be another.
        assert!(
            text.contains(what) || more.contains(":1") && text.contains("9]"),
            "{more}: {text}"
        );
    }
}

#[test]
fn numbers_are_finite_and_indices_are_vertices() {
    let mut b = Builder::default();
    let mut square = SQUARE;
    square[4] = f32::NAN;
    b.floats(&square, "VEC3");
    let text = error(&primitive(&b, r#"{"attributes":{"POSITION":0}}"#));
    assert!(text.contains("1 of 4 positions") && text.contains("position 1"), "{text}");
    let mut b = Builder::default();
    b.floats(&SQUARE, "VEC3");
    b.accessor(&[0, 1, 4], 5121, "SCALAR", 3);
    let text = error(&primitive(&b, r#"{"attributes":{"POSITION":0},"indices":1}"#));
    assert!(text.contains("accessors[1]: 4 is none of 4 vertices"), "{text}");
}

/// Small files that describe far more than they have.
#[test]
fn repetition_is_bounded() {
    let start = Instant::now();
    let mut b = Builder::default();
    b.floats(&SQUARE.repeat(1 << 12), "VEC3");
    let many = vec![r#"{"attributes":{"POSITION":0}}"#; 1 << 12].join(",");
    assert!(error(&primitive(&b, &many)).contains("share their accessors so often"));
    let mut b = Builder::default();
    b.floats(&SQUARE, "VEC3");
    let many = vec![r#"{"attributes":{"POSITION":0}}"#; 1000].join(",");
    let nodes = vec![r#"{"mesh":0}"#; 1000].join(",");
    let text = error(&b.glb(&format!(r#""nodes":[{nodes}],"meshes":[{{"primitives":[{many}]}}]"#)));
    assert!(text.contains("instances"), "{text}");
    let deep = "[".repeat(100_000);
    assert!(
        error(&glb(&format!(r#"{{"asset":{{"version":"2.0"}},"extras":{deep}"#), &[])).len() < 500
    );
    // A chain of nodes is followed without recursion.
    let chain: Vec<String> = (1..50_000).map(|i| format!(r#"{{"children":[{i}]}}"#)).collect();
    let nodes = format!(r#"{},{{"mesh":0}}"#, chain.join(","));
    let scene = load_glb(&b.glb(&format!(
        r#""nodes":[{nodes}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}]"#
    )));
    assert_eq!(scene.expect("a scene").instances.len(), 1);
    // A picture that claims more than its bytes can hold.
    let mut png = picture(image::ImageFormat::Png);
    png[16..24].copy_from_slice(&[0, 0, 0x40, 0, 0, 0, 0x40, 0]);
    let mut b = everything();
    let at = b.bin.windows(4).position(|w| w == b"\x89PNG").expect("a picture");
    b.bin[at..at + png.len()].copy_from_slice(&png);
    error(&b.glb(REST));
    assert!(start.elapsed().as_secs() < 20);
    assert_modest();
}

#[test]
fn glb_chunks_are_checked() {
    let whole = everything().glb(REST);
    assert!(error(b"glT").contains("cut off"));
    assert!(error(b"{}").contains("does not begin with 'glTF'"));
    let changed = |at: usize, byte: u8| {
        let mut bytes = whole.clone();
        bytes[at] = byte;
        error(&bytes)
    };
    assert!(changed(4, 1).contains("version 1"));
    assert!(changed(11, 9).contains("cut off"));
    assert!(changed(15, 9).contains("a chunk of"));
    assert!(changed(16, b'X').contains("not JSON"));
    assert!(error(&glb("{", &[])).contains("cut off"));
    assert!(error(&glb(r#"{"asset":{"version":"2.0"}}"#, &[])).contains("holds no triangle"));
    let error = scene::load("none.gltf").expect_err("an error");
    assert!(matches!(error, LoadError::Missing { .. }));
    assert!(matches!(scene::load("a.fbx"), Err(LoadError::UnknownExtension { .. })));
}

#[test]
fn obj_has_materials() {
    let scene = Folder::obj().load("scene.obj").expect("a scene");
    check_scene(&Ok(scene.clone()), "obj");
    let [plain, square, more] = &scene.meshes[..] else { panic!("{}", scene.meshes.len()) };
    assert_eq!([plain, square, more].map(|m| m.name.as_str()), ["", "square", "square"]);
    assert_eq!([plain, square, more].map(|m| m.material), [3, 0, 1]);
    assert_eq!(plain.colors[1], Vec4::new(1.0, 0.5, 0.0, 1.0));
    assert!(plain.normals.is_empty() && plain.uvs.is_empty());
    assert_eq!(square.triangles, [[0, 1, 2], [0, 2, 3]]);
    // Their v is turned upside down.
    assert_eq!(square.uvs[3], vec2(0.25, 0.25));
    assert_eq!(square.normals, [Vec3::Z; 4]);
    assert_eq!(more.normals, [Vec3::Z; 3]);
    let [wood, glass, lamp, blank] = &scene.materials[..] else { panic!() };
    assert_eq!(wood.base_color, Vec4::new(0.5, 0.25, 0.125, 1.0));
    assert_eq!((wood.specular, wood.specular_color), (1.0, Vec3::splat(0.2)));
    assert!((wood.roughness - 0.5).abs() < 1e-6);
    let texture = wood.base_color_texture.expect("a texture");
    assert_eq!(texture.wrap, [Wrap::Clamp; 2]);
    // Upwards (0, 0) is looked up at (0.5, 0), and (0, 1) at (0.5, 2).
    assert_eq!(texture.transform.transform_point2(vec2(0.0, 1.0)), vec2(0.5, 1.0));
    assert_eq!(texture.transform.transform_point2(vec2(0.0, 0.0)), vec2(0.5, -1.0));
    assert_eq!((glass.transmission, glass.ior, glass.specular), (1.0, 1.33, 0.0));
    assert_eq!(glass.base_color, Vec4::new(1.0, 0.9, 0.8, 1.0));
    assert_eq!((lamp.emissive, lamp.alpha_mode), (vec3(5.0, 4.0, 3.0), AlphaMode::Blend));
    assert_eq!((lamp.base_color.w, lamp.metallic), (0.5, 0.0));
    assert_eq!((blank.base_color, blank.metallic, blank.specular), (Vec4::ONE, 0.0, 0.0));
    assert_eq!((scene.images.len(), scene.images[0].name.as_str()), (1, "dots.png"));
}

/// A `#` within a word is part of a name.
#[test]
fn names_may_have_a_number_sign() {
    let folder = Folder::obj();
    let materials = "newmtl paint#1 # the first\nKd 1 0 0\nnewmtl paint#2\nKd 0 1 0\n";
    folder.write("scene.mtl", materials.as_bytes());
    let text = "mtllib scene.mtl\nv 0 0 0 # a corner\nv 1 0 0\nv 0 1 0\nusemtl paint#2\nf 1 2 3\n";
    folder.write("scene.obj", text.as_bytes());
    let scene = folder.load("scene.obj").expect("a scene");
    let names: Vec<&str> = scene.materials.iter().map(|m| m.name.as_str()).collect();
    assert_eq!(names, ["paint#1", "paint#2"]);
    let used: Vec<usize> = scene.meshes.iter().map(|mesh| mesh.material).collect();
    assert_eq!(used, [1]);
}

#[test]
fn errors_of_obj_and_mtl_name_their_lines() {
    let cases = [
        ("scene.obj", "mtllib scene.mtl", "mtllib none.mtl", "none.mtl: no such file"),
        ("scene.obj", "mtllib scene.mtl", "mtllib ../a.mtl", "scene.obj:2: "),
        ("scene.obj", "mtllib scene.mtl", "", "'wood' is no material"),
        ("scene.obj", "usemtl wood", "usemtl steel", "scene.obj:14: "),
        ("scene.obj", "f 1 2 3", "f 1 2 9", "scene.obj:12: "),
        ("scene.obj", "f 1 2 3", "f 1 2/9 3", "9 is no texture coordinate"),
        ("scene.obj", "f 1 2 3", "f 1 2 /3", "no index of a vertex"),
        ("scene.obj", "f 1 2 3", "f 0 1 2", "0 is no vertex"),
        ("scene.obj", "v 1 1 0", "v 1 nan 0", "a coordinate that is not a finite number"),
        ("scene.mtl", "Kd 0.5 0.25 0.125", "Kd 0.5 0.25", "scene.mtl:3: "),
        ("scene.mtl", "Kd 0.5 0.25 0.125", "Kd -1 0 0", "no colour"),
        ("scene.mtl", "Ns 30", "Ns", "scene.mtl:5: "),
        ("scene.mtl", "Ns 30", "Ns inf", "no finite number"),
        ("scene.mtl", "-clamp", "-warp", "'-warp' is no option"),
        ("scene.mtl", "dots.png", "/dots.png", "folder or below"),
        ("scene.mtl", "dots.png", "scene.mtl", "neither PNG nor JPEG"),
    ];
    for (name, from, to, what) in cases {
        let folder = Folder::obj();
        let text = if name == "scene.obj" { OBJ } else { MTL };
        assert!(text.contains(from), "{from}");
        folder.write(name, text.replacen(from, to, 1).as_bytes());
        let found = folder.load("scene.obj");
        check_scene(&found, to);
        let text = found.expect_err(to).to_string();
        assert!(text.contains(what), "{to}: {text}");
    }
}

#[test]
fn cut_and_damaged_scenes_are_errors() {
    let whole = everything().glb(REST);
    for end in 0..whole.len() {
        let found = load_glb(&whole[..end]);
        check_scene(&found, &format!("cut at {end}"));
        assert!(found.is_err(), "cut at {end}");
    }
    for at in 0..whole.len() {
        for flip in [0x01, 0x20, 0x80] {
            let mut bytes = whole.clone();
            bytes[at] ^= flip;
            check_scene(&load_glb(&bytes), &format!("{flip} at {at}"));
        }
    }
    let folder = Folder::obj();
    for (name, text) in [("scene.obj", OBJ), ("scene.mtl", MTL)] {
        for at in 0..text.len() {
            folder.write(name, &text.as_bytes()[..at]);
            check_scene(&folder.load("scene.obj"), &format!("{name} cut at {at}"));
            for flip in [0x01, 0x10, 0x80] {
                let mut bytes = text.as_bytes().to_vec();
                bytes[at] ^= flip;
                folder.write(name, &bytes);
                check_scene(&folder.load("scene.obj"), &format!("{name}: {flip} at {at}"));
            }
        }
        folder.write(name, text.as_bytes());
    }
    assert_modest();
}

/// The path of a real file, or word that a test is skipped.
pub(super) fn real(test: &str, name: &str) -> Option<PathBuf> {
    let path = std::env::var_os("RAYDSL_DATA").map(|folder| PathBuf::from(folder).join(name));
    let path = path.filter(|path| path.exists());
    if path.is_none() {
        // Written past the test harness, which would swallow what a passing test prints.
        let mut err = std::io::stderr();
        let _ = writeln!(err, "SKIPPED {test}: RAYDSL_DATA is not set or holds no {name}");
    }
    path
}

#[test]
fn a_real_scene_loads() {
    let Some(path) = real("a_real_scene_loads", "shader_ball.glb") else { return };
    let found = scene::load(&path);
    check_scene(&found, "shader_ball.glb");
    let scene = found.expect("a scene");
    let [ball] = &scene.meshes[..] else { panic!("{} meshes", scene.meshes.len()) };
    assert_eq!((ball.triangles.len(), ball.positions.len()), (46_704, 52_542));
    assert_eq!((ball.normals.len(), ball.uvs.len()), (52_542, 52_542));
    assert_eq!(scene.materials[ball.material].name, "initialShadingGroup");
    let whole = std::fs::read(&path).expect("a file");
    for i in 0..40 {
        let mut bytes = whole.clone();
        if i % 2 == 0 {
            bytes.truncate(whole.len() / 41 * i);
        } else {
            // Within its JSON, and behind it.
            for j in 0..20 {
                let at = if i % 4 == 1 { 20 + (i * 997 + j * 131) % 4000 } else { i * j * 1999 };
                bytes[at % whole.len()] ^= 1 << (j % 8);
            }
        }
        check_scene(&load_glb(&bytes), &format!("variant {i}"));
    }
}
