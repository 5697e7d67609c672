//! Unstructured grids, from files that these tests write.

use glam::{Vec3, vec3};

use super::volumes::{ALL_WAYS, Array, KINDS, ORDERS, PLAIN, Vti, Way, real};
use super::*;
use crate::cells::{CellArray, CellFile, CellKind, load};
use crate::volume::VoxelType;

/// Positions of the points: a unit cube, and one above.
const POINTS: [[f64; 3]; 9] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 1.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 0.0, 1.0],
    [1.0, 1.0, 1.0],
    [0.0, 1.0, 1.0],
    [0.0, 0.0, 2.0],
];

/// Cells of all kinds, a triangle and a line, each with its type.
const CELLS: [(f64, &[f64]); 7] = [
    (10.0, &[0.0, 1.0, 3.0, 4.0]),
    (5.0, &[0.0, 1.0, 2.0]),
    (11.0, &[0.0, 1.0, 3.0, 2.0, 4.0, 5.0, 7.0, 6.0]),
    (12.0, &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]),
    (13.0, &[0.0, 1.0, 2.0, 4.0, 5.0, 6.0]),
    (3.0, &[0.0, 8.0]),
    (14.0, &[4.0, 5.0, 6.0, 7.0, 8.0]),
];

/// A file whose arrays have numbers of the type of `way`, and those of cells of another.
pub(super) fn vtu(way: Vti, index: VoxelType) -> Vec<u8> {
    let indices = Vti { kind: index, ..way };
    let mut appended = Vec::new();
    let mut list = |of: Vti, arrays: &[Array<'_>]| -> String {
        arrays.iter().map(|array| of.array(&mut appended, array)).collect()
    };
    let numbers = |count: usize, factor: f64| (0..count).map(|i| i as f64 * factor).collect();
    let points = [("t", 1, numbers(9, 3.0)), ("v", 3, numbers(27, 2.0))];
    let points = list(way, &points);
    let cells = list(way, &[("of cells", 1, numbers(7, 1.0))]);
    let positions = list(way, &[("", 3, POINTS.concat())]);
    let vertices: Vec<f64> = CELLS.iter().flat_map(|c| c.1).copied().collect();
    let mut end = 0.0;
    let ends = CELLS.map(|(_, own)| {
        end += own.len() as f64;
        end
    });
    let shape = [
        ("connectivity", 1, vertices),
        ("offsets", 1, ends.to_vec()),
        ("types", 1, CELLS.map(|c| c.0).to_vec()),
    ];
    let shape = list(indices, &shape);
    let attributes = way.attributes();
    let mut file = format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" {attributes}>\n\
         <UnstructuredGrid><Piece NumberOfPoints='9' NumberOfCells='7'>\n<PointData Scalars='t'>\n\
         {points}<DataArray type='String' Name='note' format='ascii'>1 2</DataArray>\n\
         <DataArray type='Bit' Name='flag' format='ascii'>1</DataArray></PointData>\n\
         <CellData>{cells}</CellData>\n<Points>{positions}</Points>\n<Cells>{shape}</Cells>\n\
         </Piece></UnstructuredGrid>\n"
    )
    .into_bytes();
    file.extend(way.appended(&appended));
    file.extend(b"</VTKFile>\n");
    file
}

pub(super) fn load_cells(bytes: &[u8]) -> Result<CellFile, LoadError> {
    load(&Temp::new("vtu", bytes).0)
}

/// What the file has to be.
fn assert_cells(file: &CellFile) {
    use CellKind::{Hexahedron, Pyramid, Tetrahedron, Wedge};
    assert_eq!(file.points, POINTS.map(|p| vec3(p[0] as f32, p[1] as f32, p[2] as f32)));
    assert_eq!(file.kinds, [Tetrahedron, Hexahedron, Hexahedron, Wedge, Pyramid]);
    assert_eq!(file.skipped, 2);
    let expected = [
        &[0, 1, 3, 4][..],
        &[0, 1, 2, 3, 4, 5, 6, 7],
        &[0, 1, 2, 3, 4, 5, 6, 7],
        &[0, 1, 2, 4, 5, 6],
        &[4, 5, 6, 7, 8],
    ];
    assert_eq!(file.vertices, expected.concat());
    let numbers = |count: usize, factor: f32| (0..count).map(|i| i as f32 * factor).collect();
    let array =
        |name: &str, components, values| CellArray { name: name.into(), components, values };
    assert_eq!(
        file.point_arrays,
        [array("t", 1, numbers(9, 3.0)), array("v", 3, numbers(27, 2.0))]
    );
    assert_eq!(file.cell_arrays, [array("of cells", 1, vec![0.0, 2.0, 3.0, 4.0, 6.0])]);
    assert_eq!(file.scalars().map(|s| (&s.0.name[..], s.1)), Some(("t", false)));
    assert_eq!(file.array("of cells").map(|s| s.1), Some(true));
    assert!(file.array("note").is_none());
}

#[test]
fn vtu_of_every_type() {
    for way in ALL_WAYS {
        for kind in KINDS {
            for order in ORDERS {
                for (is_wide, block) in
                    [(false, None), (true, Some(24)), (true, None), (false, Some(17))]
                {
                    let vti = Vti { way, kind, order, is_wide, block };
                    for index in [VoxelType::U8, VoxelType::I32, VoxelType::I64] {
                        let file = load_cells(&vtu(vti, index));
                        assert_cells(&file.unwrap_or_else(|e| panic!("{vti:?}: {e}")));
                    }
                }
            }
        }
    }
}

/// Small files of each encoding.
pub(super) fn files() -> Vec<Vec<u8>> {
    let float = Vti { kind: VoxelType::F32, ..PLAIN };
    [
        float,
        Vti { way: Way::Inline, ..float },
        Vti { way: Way::Inline, block: Some(20), is_wide: true, ..float },
        Vti { way: Way::Raw, ..float },
        Vti { way: Way::Raw, block: Some(64), ..float },
        Vti { way: Way::Base64, block: Some(1000), ..float },
    ]
    .map(|way| vtu(way, VoxelType::I32))
    .to_vec()
}

/// Cells as they have to be, or an error of one line.
#[track_caller]
pub(super) fn check_cells(bytes: &[u8], case: &str) -> Option<CellFile> {
    match load_cells(bytes) {
        Ok(file) => {
            let count: usize = file.kinds.iter().map(|k| k.vertices()).sum();
            assert!(!file.kinds.is_empty() && count == file.vertices.len(), "{case}");
            assert!(file.vertices.iter().all(|v| (*v as usize) < file.points.len()), "{case}");
            assert!(file.points.iter().all(|p| p.is_finite()), "{case}");
            for (arrays, count) in
                [(&file.point_arrays, file.points.len()), (&file.cell_arrays, file.kinds.len())]
            {
                assert!(arrays.iter().all(|a| a.values.len() == count * a.components), "{case}");
            }
            Some(file)
        }
        Err(e) => {
            let text = e.to_string();
            assert!(!text.contains('\n') && text.contains(';'), "{case}: {text}");
            None
        }
    }
}

#[test]
fn cut_grids_are_errors() {
    for bytes in files() {
        let whole = load_cells(&bytes).expect("cells");
        for end in 0..bytes.len() {
            if let Some(part) = check_cells(&bytes[..end], &format!("cut at {end}")) {
                assert_eq!(part, whole, "cut at {end}");
            }
        }
    }
    assert_modest();
}

#[test]
fn damaged_grids_never_panic() {
    for bytes in files() {
        for at in 0..bytes.len() {
            for flip in [0x01, 0x02, 0x10, 0x80, 0xff] {
                let mut damaged = bytes.clone();
                damaged[at] ^= flip;
                check_cells(&damaged, &format!("byte {at} by {flip}"));
            }
        }
    }
    assert_modest();
}

#[test]
fn broken_vtu_is_named() {
    let text = String::from_utf8(vtu(Vti { kind: VoxelType::F32, ..PLAIN }, VoxelType::I32));
    let plain = text.expect("text");
    let one = "<Cells>".to_owned() + plain.split("<Cells>").nth(1).expect("cells");
    let cells = |from: &str, to: &str| plain.replace(&one, &one.replacen(from, to, 1));
    let claim = |count: &str| plain.replace("NumberOfPoints='9'", count);
    let many = "<DataArray type='Float32' Name='x' NumberOfComponents='999' format='ascii'/>";
    for (file, what) in [
        (String::new(), "cut off at byte 0"),
        (plain.replace("UnstructuredGrid", "PolyData"), "instead of 'UnstructuredGrid'"),
        (plain.replace("<Points>", "<Dots>").replace("</Points>", "</Dots>"), "no array of points"),
        (plain.replace("offsets", "ends"), "no array 'offsets'"),
        (plain.replace("connectivity", "links"), "no array 'connectivity'"),
        (plain.replace("types", "kinds"), "no array 'types'"),
        (claim("NumberOfPoints='8'"), "has point 8, and there are 8"),
        (claim("NumberOfPoints='4294967296'"), "has 4294967296 points, but at most"),
        (claim("NumberOfPoints='4294967295'"), "than a file of"),
        (claim("NumberOfPoints='200'"), "bytes of text"),
        (claim("NumberOfPoints='x'"), "'NumberOfPoints' has 'x'"),
        (cells("\n4 \n7 ", "\n4 \n3 "), "the offset of cell 1, 3, is no whole number from"),
        (cells("\n4 \n7 ", "\n5 \n7 "), "of type 10 has 5 vertices, not 4"),
        (cells("\n36\n", "\n9999999999\n"), "is no i32"),
        (cells("\n0 \n1 \n3 ", "\n0 \n-1 \n3 "), "cell 0 has point -1"),
        (
            plain.replacen("\n0 \n0 \n0 \n1", "\n0 \nnan \n0 \n1", 1),
            "1 of 9 points have a coordinate",
        ),
        (cells("\n10 \n5 \n11 \n12 \n13 \n3 \n14", "\n1 \n1 \n1 \n1 \n1 \n1 \n1"), "with a volume"),
        (plain.replace("</PointData>", &format!("{many}</PointData>")), "'x'"),
        (plain.replace("Components=\"3\"", "Components=\"0\""), "have 0 coordinates instead of 3"),
    ] {
        let message = load_cells(file.as_bytes()).expect_err(what).to_string();
        assert!(!message.contains('\n') && message.contains(';'), "{message}");
        assert!(message.contains(what), "{message}\n{what}");
    }
    // Arrays that claim the same bytes again and again.
    let way = Vti { way: Way::Raw, kind: VoxelType::F32, block: Some(4096), ..PLAIN };
    let file = vtu(way, VoxelType::I32);
    let first = "<DataArray type=\"Float32\" Name=\"t\"";
    let mark = file.windows(first.len()).position(|w| w == first.as_bytes()).expect("a mark");
    let again = first.to_owned() + " format='appended' offset='0'/>";
    let copies: Vec<u8> = again.bytes().cycle().take(again.len() * 4000).collect();
    let bomb = [&file[..mark], &copies, &file[mark..]].concat();
    check_cells(&bomb, "arrays that share their bytes");
    assert_modest();
}

/// A burning pool. The numbers are those of Python's zlib and base64.
#[test]
fn a_real_vtu_loads() {
    let Some(path) = real("a_real_vtu_loads", "fire_ug.vtu") else { return };
    let file = load(&path).expect("cells");
    assert_eq!((file.points.len(), file.kinds.len(), file.skipped), (12_323, 10_462, 0));
    assert!(file.kinds.iter().all(|k| *k == CellKind::Hexahedron));
    let sum = file.vertices.iter().map(|v| u64::from(*v)).sum::<u64>();
    assert_eq!((file.vertices.len(), sum), (83_696, 515_872_416));
    let names: Vec<_> = file.point_arrays.iter().map(|a| (&a.name[..], a.components)).collect();
    assert_eq!(names, [("t", 1), ("uvw", 3), ("u", 1), ("v", 1), ("w", 1), ("mfrac", 1)]);
    assert!(file.cell_arrays.is_empty());
    let (t, is_cells) = file.scalars().expect("temperatures");
    let sum = t.values.iter().map(|v| f64::from(*v)).sum::<f64>();
    assert!((sum - 4_450_727.305_480_957).abs() < 1e-6, "{sum}");
    assert_eq!((&t.name[..], is_cells, t.values[100]), ("t", false, 299.954_68));
    assert_eq!(
        file.point_arrays[1].values[300..303],
        [0.048_586_61, -0.061_744_437, 0.062_724_516]
    );
    let most = file.points.iter().copied().fold(Vec3::ZERO, Vec3::max);
    assert_eq!(most, vec3(6.0, 2.5, 2.399_999_9));
}
