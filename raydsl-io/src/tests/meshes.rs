use glam::{Vec3, vec3};

use super::*;

pub(super) fn load_mesh(extension: &str, bytes: &[u8]) -> Result<Mesh, LoadError> {
    Temp::new(extension, bytes).mesh()
}

/// The error's message, which has to be one line.
fn refusal(extension: &str, bytes: &[u8]) -> String {
    let text = load_mesh(extension, bytes).expect_err("an error").to_string();
    assert!(!text.contains('\n') && text.contains(';'), "{text}");
    text
}

const SQUARE: [Vec3; 4] = [Vec3::ZERO, Vec3::X, vec3(1.0, 1.0, 0.0), Vec3::Y];

const HEADER: &str = "element vertex 4\nproperty float x\nproperty float y\nproperty double z\n\
    element face 1\nproperty uchar kind\nproperty list uchar int vertex_indices\nend_header\n";

/// A square as a PLY, with a list of corners.
pub(super) fn ply_square(encoding: &str, corners: &[i32]) -> Vec<u8> {
    let mut out = format!("ply\nformat {encoding} 1.0\n{HEADER}").into_bytes();
    if encoding == "ascii" {
        let rows = SQUARE.map(|v| format!("{} {} {}\n", v.x, v.y, v.z)).concat();
        let corners: String = corners.iter().map(|i| format!(" {i}")).collect();
        let count = corners.split_whitespace().count();
        out.extend(format!("{rows}7 {count}{corners}\n").bytes());
        return out;
    }
    let big = encoding == "binary_big_endian";
    for v in SQUARE {
        for c in [v.x, v.y] {
            out.extend(if big { c.to_be_bytes() } else { c.to_le_bytes() });
        }
        let z = f64::from(v.z);
        out.extend(if big { z.to_be_bytes() } else { z.to_le_bytes() });
    }
    out.extend([7, corners.len() as u8]);
    for i in corners {
        out.extend(if big { i.to_be_bytes() } else { i.to_le_bytes() });
    }
    out
}

pub(super) fn tri_square() -> Vec<u8> {
    let mut tri = 2u32.to_le_bytes().to_vec();
    for i in [0, 1, 2, 0, 2, 3] {
        tri.extend(SQUARE[i].to_array().iter().flat_map(|x| x.to_le_bytes()));
    }
    tri
}

pub(super) const OBJ_SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";

#[test]
fn a_square_in_every_format() {
    let square =
        Mesh { vertices: SQUARE.into(), normals: vec![], triangles: vec![[0, 1, 2], [0, 2, 3]] };
    assert_eq!(load_mesh("OBJ", OBJ_SQUARE.as_bytes()).expect("a square"), square);
    for encoding in ["ascii", "binary_little_endian", "binary_big_endian"] {
        let ply = load_mesh("ply", &ply_square(encoding, &[0, 1, 2, 3]));
        assert_eq!(ply.expect("a square"), square, "{encoding}");
    }
    let tri = load_mesh("tri", &tri_square()).expect("a square");
    assert!(tri.corners().eq(square.corners()));
    assert_eq!(tri.triangles, [[0, 1, 2], [3, 4, 5]]);
}

#[test]
fn obj_indices_count_from_either_end() {
    let text = b"# made by hand\nmtllib none.mtl\no square\n\
                f 1 2 3 # the vertices follow\nv 0 0 0 1\nv 1 0 0 0.5 0.5 0.5\r\n\tv 1 1 0\n\
                vt 0 0\nv 0 1 0\nf -4/1 -2/1 -1/1\nl 1 2\np 1\ng \xff\nf 1 2\n";
    let mesh = load_mesh("obj", text).expect("a square");
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(mesh.vertices, SQUARE);
}

#[test]
fn normals_are_those_of_corners() {
    let text = OBJ_SQUARE.replace("f 1 2 3 4", "vn 0 0 1\nvn 0 0 2\nf 1//1 2//1 3/9/1 4//-2");
    let mesh = load_mesh("obj", text.as_bytes()).expect("a square");
    assert_eq!((mesh.vertices, mesh.normals), (SQUARE.into(), vec![Vec3::Z; 4]));
    // A vertex with two normals is two; a corner without one leaves all out.
    let two = format!("{text}f 1//2 2//1 3//1\n");
    let mesh = load_mesh("obj", two.as_bytes()).expect("three triangles");
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [4, 1, 2]]);
    assert_eq!((mesh.vertices[4], mesh.normals[4]), (Vec3::ZERO, 2.0 * Vec3::Z));
    let none = format!("{text}f 1 2//1 3//1\n");
    let mesh = load_mesh("obj", none.as_bytes()).expect("three triangles");
    assert!(mesh.normals.is_empty() && mesh.vertices.len() == 4);
    let ply = "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar uint vertex_index\n\
               element vertex 3\nproperty float nx\nproperty float ny\nproperty float nz\n\
               property int x\nproperty int y\nproperty int z\nend_header\n\
               3 0 1 2\n0 0 1 0 0 0\n0 1 0 1 0 0\n1 0 0 0 1 0\n";
    let mesh = load_mesh("ply", ply.as_bytes()).expect("a triangle");
    assert_eq!(mesh.normals, [Vec3::Z, Vec3::Y, Vec3::X]);
    assert_eq!(mesh.vertices, [Vec3::ZERO, Vec3::X, Vec3::Y]);
}

/// A vertex that nothing uses may be anything.
#[test]
fn only_triangles_are_held_to_finite_numbers() {
    let text = format!("{OBJ_SQUARE}v nan inf 0\n");
    assert_eq!(load_mesh("obj", text.as_bytes()).expect("a square").vertices.len(), 5);
    let message = refusal("obj", format!("{text}f 1 2 3\nf 1 2 5\n").as_bytes());
    assert!(message.contains("1 of 4 triangles") && message.contains("triangle 3"), "{message}");
}

#[test]
fn broken_meshes_are_named() {
    let missing = mesh::load("no/such.obj").expect_err("it is not there").to_string();
    assert!(missing.starts_with("no/such.obj: no such file"), "{missing}");
    let folder = std::env::temp_dir().join(format!("raydsl-io-{}.obj", std::process::id()));
    std::fs::create_dir(&folder).expect("a folder");
    let message = mesh::load(&folder).expect_err("a folder").to_string();
    std::fs::remove_dir(&folder).expect("it is there");
    assert!(message.contains("cannot be read"), "{message}");
    assert!(refusal("stl", b"").contains("one of .obj, .ply, .tri"));
    let ascii = |corners: &[i32]| String::from_utf8(ply_square("ascii", corners)).expect("text");
    let square = ascii(&[0, 1, 2, 3]);
    for (extension, text, what) in [
        ("obj", "v 0 0 0\nf 1 2 3\n".into(), ":2: is no valid OBJ: 3 is none of the 1 vertices"),
        ("obj", "v 0 0 x\n".into(), ":1: is no valid OBJ: 'x' is no number"),
        ("obj", "\nv 0 0\n".into(), ":2: is no valid OBJ: it has fewer"),
        (
            "obj",
            "v 0 0 0\nf 1//1 1//1 1//1\n".into(),
            ":2: is no valid OBJ: 1 is none of the 0 normals",
        ),
        ("obj", "v 0 0 0\nf 0 1 1\n".into(), "0 is no vertex: 1 come before"),
        ("obj", "v 0 0 0\nf 1/1/-1 1 1\n".into(), "-1 is no normal: 0 come before"),
        ("obj", "v 0 0 0\nf -9223372036854775808 1 1\n".into(), "is no vertex"),
        ("obj", "v 0 0 0\nf 4294967296 1 1\n".into(), "4294967296 is no vertex"),
        ("obj", "v 0 0 0\nf 1 1 1 \\\n1\n".into(), "'\\' is no index of a vertex"),
        ("obj", "v 0 0 0\n".into(), "no triangle"),
        ("obj", "v 1e99 0 0\nf 1 1 1\n".into(), "finite"),
        ("ply", "".into(), "cut off at byte 0"),
        ("ply", "ply\nformat ascii 1.0\n".into(), "cut off at byte 21: it ends within its header"),
        ("ply", "plyx\n".into(), ":1: is no valid PLY: it begins with 'plyx'"),
        ("ply", ascii(&[0, 1, 9]), ":15: is no valid PLY: the corner 9 is none of the 4 vertices"),
        ("ply", ascii(&[0, 1, -1]), "the corner -1 is none of the 4 vertices"),
        ("ply", ascii(&[0, 1]), "no triangle"),
        ("ply", square.replace("7 4 0", "7 4.5 0"), "the list 'vertex_indices' has 4.5 items"),
        ("ply", square.replace("7 4 0", "7 9 0"), ":15: is no valid PLY: no value for"),
        ("ply", square.replace("7 4 0 1 2 3\n", ""), "0 of 1 elements 'face'"),
        ("ply", square.replace("vertex 4", "vertex 99999999999999"), "at most 4294967295"),
        ("ply", square.replace("vertex 4", "vertex -4"), "element 'vertex' has no count"),
        ("ply", square.replace("face 1", "vertex 1"), "two elements 'vertex'"),
        ("ply", square.replace("face", "fact"), "no element 'face'"),
        ("ply", square.replace("float x", "float w"), "no number 'x'"),
        ("ply", square.replace("float x", "half x"), "'half' is no type"),
        ("ply", square.replace("list uchar", "list float"), "is no integer"),
        ("ply", square.replace("uchar int v", "uchar float v"), "no list of integers"),
        ("ply", square.replace("ascii 1.0", "ascii 2.0"), "not of version 1.0"),
        ("ply", square.replace("format ascii 1.0\n", ""), "no line 'format'"),
        ("ply", format!("ply\n{}", "comment\n".repeat(200_000)), "header is longer than"),
        ("tri", "ab".into(), "cut off at byte 2: it is shorter than 4"),
        ("tri", "\u{7f}\u{7f}\u{7f}\u{7f}".into(), "0 follow"),
        ("tri", "\0\0\0\0ab".into(), ", byte 4: is no valid TRI"),
        ("tri", "\0\0\0\0".into(), "no triangle"),
    ] {
        let message = refusal(extension, text.as_bytes());
        assert!(message.contains(what), "{message}\n{what}");
    }
    let binary = refusal("ply", &ply_square("binary_little_endian", &[0, 1, 4]));
    assert!(binary.contains(", byte ") && binary.contains("the corner 4"), "{binary}");
}

/// Typed errors name the line, the byte or the limit.
#[test]
fn errors_have_their_place() {
    let line = load_mesh("obj", b"v 0 0 0\nf 1 1 x\n");
    assert!(matches!(line, Err(LoadError::Corrupt { place: Place::Line(2), format: "OBJ", .. })));
    let byte = load_mesh("tri", &[tri_square(), vec![0]].concat());
    assert!(matches!(byte, Err(LoadError::Corrupt { place: Place::Byte(76), .. })), "{byte:?}");
    let cut = load_mesh("tri", &tri_square()[..70]);
    assert!(matches!(cut, Err(LoadError::Truncated { len: 70, .. })), "{cut:?}");
}

/// Counts that no file of this length can hold: neither memory nor time is spent on them.
#[test]
fn claims_of_meshes_are_not_trusted() {
    let head = |extra: &str, faces: &str| {
        format!(
            "ply\nformat binary_little_endian 1.0\nelement empty 1152921504606846976\n{extra}\
             element vertex 3\nproperty uchar x\nproperty uchar y\nproperty uchar z\n\
             element face {faces}\nproperty list uint int vertex_indices\nend_header\n"
        )
    };
    let body = [0, 0, 0, 1, 0, 0, 0, 1, 0];
    let face = |count: u32| [&body[..], &count.to_le_bytes()].concat();
    let file = |head: String, body: &[u8]| [head.as_bytes(), body].concat();
    let many = file(head("", "4294967295"), &face(u32::MAX));
    assert!(refusal("ply", &many).contains("0 of 4294967295 elements 'face'"));
    let rows = "element row 1152921504606846976\nproperty double a\n";
    assert!(refusal("ply", &file(head(rows, "1"), &body)).contains("elements 'row'"));
    let lists = "element row 1152921504606846976\nproperty list uint double a\n";
    assert!(refusal("ply", &file(head(lists, "1"), &face(7))).contains("elements 'row'"));
    let triangle = [&face(3)[..], &[0; 4], &[1, 0, 0, 0, 2, 0, 0, 0]].concat();
    let mesh = load_mesh("ply", &file(head("", "1"), &triangle)).expect("a triangle");
    assert_eq!(mesh.triangles, [[0, 1, 2]]);
    assert_modest();
}

/// Every file cut anywhere, and with any byte changed: a mesh, or an error of one line.
#[test]
fn damaged_meshes_never_panic() {
    let corners = [0, 1, 2, 3];
    let normals = OBJ_SQUARE.replace("f 1 2 3 4", "vn 0 0 1\nf 1//1 2//1 3/9/1 4//-1");
    let files = [
        ("obj", normals.into_bytes()),
        ("ply", ply_square("ascii", &corners)),
        ("ply", ply_square("binary_little_endian", &corners)),
        ("ply", ply_square("binary_big_endian", &corners)),
        ("tri", tri_square()),
    ];
    let check = |extension: &str, bytes: &[u8]| match load_mesh(extension, bytes) {
        Ok(mesh) => {
            assert!(mesh.normals.is_empty() || mesh.normals.len() == mesh.vertices.len());
            assert!(mesh.corners().len() > 0 && mesh.corners().flatten().all(|v| v.is_finite()));
        }
        Err(e) => assert!(!e.to_string().contains('\n'), "{extension}: {e}"),
    };
    for (extension, bytes) in files {
        for at in 0..bytes.len() {
            check(extension, &bytes[..at]);
            for flip in [0x01, 0x02, 0x80, 0xff] {
                let mut damaged = bytes.clone();
                damaged[at] ^= flip;
                check(extension, &damaged);
            }
        }
    }
    assert_modest();
}
