//! Volumes of every format, from files that these tests write.

use std::io::Write;

use flate2::Compression;
use flate2::write::{GzEncoder, ZlibEncoder};
use glam::{Affine3, UVec3, Vec3, uvec3, vec3};

use super::*;
use crate::volume::{ByteOrder, VoxelType, Voxels, load_raw, load_stack};

pub(super) const SIZE: UVec3 = uvec3(4, 3, 2);

pub(super) const KINDS: [VoxelType; 10] = [
    VoxelType::U8,
    VoxelType::I8,
    VoxelType::U16,
    VoxelType::I16,
    VoxelType::U32,
    VoxelType::I32,
    VoxelType::U64,
    VoxelType::I64,
    VoxelType::F32,
    VoxelType::F64,
];

pub(super) const ORDERS: [ByteOrder; 2] = [ByteOrder::Little, ByteOrder::Big];

/// Numbers for all voxels that the type has.
pub(super) fn numbers(kind: VoxelType) -> Vec<f64> {
    let number = |i: u32| match kind {
        VoxelType::U8 => i * 11 % 256,
        VoxelType::I8 => i * 5,
        _ => i * 1000,
    };
    (0..SIZE.element_product()).map(|i| f64::from(number(i))).collect()
}

fn number_bytes(kind: VoxelType, order: ByteOrder, n: f64) -> Vec<u8> {
    let mut bytes = match kind {
        VoxelType::U8 => (n as u8).to_le_bytes().to_vec(),
        VoxelType::I8 => (n as i8).to_le_bytes().to_vec(),
        VoxelType::U16 => (n as u16).to_le_bytes().to_vec(),
        VoxelType::I16 => (n as i16).to_le_bytes().to_vec(),
        VoxelType::U32 => (n as u32).to_le_bytes().to_vec(),
        VoxelType::I32 => (n as i32).to_le_bytes().to_vec(),
        VoxelType::U64 => (n as u64).to_le_bytes().to_vec(),
        VoxelType::I64 => (n as i64).to_le_bytes().to_vec(),
        VoxelType::F32 => (n as f32).to_le_bytes().to_vec(),
        VoxelType::F64 => n.to_le_bytes().to_vec(),
    };
    if order == ByteOrder::Big {
        bytes.reverse();
    }
    bytes
}

pub(super) fn bytes_of(kind: VoxelType, order: ByteOrder, numbers: &[f64]) -> Vec<u8> {
    numbers.iter().flat_map(|n| number_bytes(kind, order, *n)).collect()
}

pub(super) fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes).expect("memory");
    encoder.finish().expect("memory")
}

pub(super) fn zlib(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes).expect("memory");
    encoder.finish().expect("memory")
}

fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for group in bytes.chunks(3) {
        let byte = |i: usize| group.get(i).map_or(0, |b| u32::from(*b));
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for i in 0..4 {
            let letter = char::from(LETTERS[(bits >> (18 - 6 * i)) as usize & 63]);
            text.push(if i <= group.len() { letter } else { '=' });
        }
    }
    text
}

pub(super) fn load_volume(extension: &str, bytes: &[u8]) -> Result<VolumeFile, LoadError> {
    Temp::new(extension, bytes).volume()
}

/// The error's message, which has to be one line with a remedy.
pub(super) fn refused(extension: &str, bytes: &[u8]) -> String {
    let text = load_volume(extension, bytes).expect_err("an error").to_string();
    assert!(!text.contains('\n') && text.contains(';'), "{text}");
    text
}

/// What a volume has to be, as the type that is kept of the numbers of a type.
#[track_caller]
fn assert_volume(found: &VolumeFile, kind: VoxelType, to_world: Affine3) {
    let numbers = numbers(kind);
    let voxels = match kind {
        VoxelType::F32 => Voxels::F32(numbers.iter().map(|n| *n as f32).collect()),
        VoxelType::I16 => Voxels::I16(numbers.iter().map(|n| *n as i16).collect()),
        VoxelType::U8 | VoxelType::I8 => Voxels::U8(numbers.iter().map(|n| *n as u8).collect()),
        _ => Voxels::U16(numbers.iter().map(|n| *n as u16).collect()),
    };
    assert_eq!((found.size, &found.voxels), (SIZE, &voxels), "{kind:?}");
    assert_eq!(found.to_world, to_world);
    assert_eq!(found.value(uvec3(1, 2, 1)), Some(numbers[1 + 4 * (2 + 3)] as f32));
    assert_eq!((found.value(uvec3(4, 0, 0)), found.value(uvec3(0, 0, 2))), (None, None));
    assert_eq!((found.scale, found.offset, found.no_data), (1.0, 0.0, None));
}

#[test]
fn raw_files_of_every_type() {
    for kind in KINDS {
        for order in ORDERS {
            let file = Temp::new("raw", &bytes_of(kind, order, &numbers(kind)));
            let volume = load_raw(&file.0, SIZE, kind, order).expect("a volume");
            assert_volume(&volume, kind, Affine3::IDENTITY);
            assert!(volume.is_cell_centred);
        }
    }
}

/// The smallest type that has all numbers.
#[test]
fn other_types_become_the_smallest() {
    let load = |kind, numbers: &[f64]| {
        let file = Temp::new("raw", &bytes_of(kind, ByteOrder::Little, numbers));
        let size = uvec3(numbers.len() as u32, 1, 1);
        load_raw(&file.0, size, kind, ByteOrder::Little).expect("a volume").voxels
    };
    assert_eq!(load(VoxelType::I8, &[1.0, -1.0, 2.0]), Voxels::I16(vec![1, -1, 2]));
    assert_eq!(load(VoxelType::I32, &[0.0, 255.0]), Voxels::U8(vec![0, 255]));
    assert_eq!(load(VoxelType::I32, &[3.0, 256.0, 65535.0]), Voxels::U16(vec![3, 256, 65535]));
    assert_eq!(load(VoxelType::I64, &[256.0, -32768.0]), Voxels::I16(vec![256, -32768]));
    assert_eq!(load(VoxelType::I64, &[-1.0, 32768.0]), Voxels::F32(vec![-1.0, 32768.0]));
    assert_eq!(load(VoxelType::I64, &[32768.0, -1.0]), Voxels::F32(vec![32768.0, -1.0]));
    assert_eq!(load(VoxelType::U32, &[7.0, 65536.0]), Voxels::F32(vec![7.0, 65536.0]));
    assert_eq!(load(VoxelType::F64, &[7.0, 300.0, 0.5]), Voxels::F32(vec![7.0, 300.0, 0.5]));
    assert_eq!(load(VoxelType::F64, &[1e300, 1.0]), Voxels::F32(vec![f32::INFINITY, 1.0]));
    let Voxels::F32(nan) = load(VoxelType::F64, &[2.0, f64::NAN]) else { panic!("no floats") };
    assert!(nan[0] == 2.0 && nan[1].is_nan());
    // Types that are kept are kept.
    assert_eq!(load(VoxelType::F32, &[1.0, 2.0]), Voxels::F32(vec![1.0, 2.0]));
    assert_eq!(load(VoxelType::U16, &[1.0, 2.0]), Voxels::U16(vec![1, 2]));
}

fn put(bytes: &mut [u8], at: usize, order: ByteOrder, kind: VoxelType, numbers: &[f64]) {
    let numbers = bytes_of(kind, order, numbers);
    bytes[at..][..numbers.len()].copy_from_slice(&numbers);
}

const NIFTI_CODES: [f64; 10] = [2.0, 256.0, 512.0, 4.0, 768.0, 8.0, 1280.0, 1024.0, 16.0, 64.0];

/// Where numbers of a header are: of version 1 or 2.
struct Places {
    axes: usize,
    kind: usize,
    spacings: usize,
    start: usize,
    factors: usize,
    codes: usize,
    rotation: usize,
    matrix: usize,
}

const FIRST: Places = Places {
    axes: 40,
    kind: 70,
    spacings: 76,
    start: 108,
    factors: 112,
    codes: 252,
    rotation: 256,
    matrix: 280,
};
const SECOND: Places = Places {
    axes: 16,
    kind: 12,
    spacings: 104,
    start: 168,
    factors: 176,
    codes: 344,
    rotation: 352,
    matrix: 400,
};

/// A NIfTI file with spacings of 1, 2 and 3; `edit` sets numbers of its header as floats.
fn nifti_with(
    version: usize,
    kind: VoxelType,
    order: ByteOrder,
    edit: impl FnOnce(&mut dyn FnMut(usize, &[f64])),
) -> Vec<u8> {
    let (int, float) =
        [(VoxelType::I16, VoxelType::F32), (VoxelType::I64, VoxelType::F64)][version - 1];
    let (length, places) = if version == 1 { (348, FIRST) } else { (540, SECOND) };
    let mut bytes = vec![0; length + 20];
    put(&mut bytes, 0, order, VoxelType::I32, &[length as f64]);
    put(&mut bytes, places.axes, order, int, &[3.0, 4.0, 3.0, 2.0]);
    let code = NIFTI_CODES[KINDS.iter().position(|k| *k == kind).expect("a type")];
    put(&mut bytes, places.kind, order, VoxelType::I16, &[code]);
    put(&mut bytes, places.spacings, order, float, &[1.0, 1.0, 2.0, 3.0]);
    let start = if version == 1 { float } else { int };
    put(&mut bytes, places.start, order, start, &[(length + 20) as f64]);
    let magic = [(344, "n+1\0"), (4, "n+2\0\r\n\x1a\n")][version - 1];
    bytes[magic.0..][..magic.1.len()].copy_from_slice(magic.1.as_bytes());
    edit(&mut |at, numbers| put(&mut bytes, at, order, float, numbers));
    bytes.extend(bytes_of(kind, order, &numbers(kind)));
    bytes
}

pub(super) fn nifti(kind: VoxelType, order: ByteOrder) -> Vec<u8> {
    nifti_with(1, kind, order, |_| {})
}

fn scaled(x: f32, y: f32, z: f32) -> Affine3 {
    Affine3::from_scale(vec3(x, y, z))
}

#[test]
fn nifti_of_every_type() {
    for kind in KINDS {
        for order in ORDERS {
            for version in [1, 2] {
                let bytes = nifti_with(version, kind, order, |_| {});
                let whole = load_volume("nii", &bytes).expect("a volume");
                assert_volume(&whole, kind, scaled(1.0, 2.0, 3.0));
                assert!(whole.is_cell_centred);
                // Compressed, under either name.
                let packed = gzip(&bytes);
                assert_eq!(load_volume("nii.gz", &packed).expect("a volume"), whole);
                assert_eq!(load_volume("NII.GZ", &packed).expect("a volume"), whole);
                assert_eq!(load_volume("nii", &packed).expect("a volume"), whole);
                assert_eq!(load_volume("nii.gz", &bytes).expect("a volume"), whole);
                // In two members, as parallel compressors write.
                let (a, b) = bytes.split_at(bytes.len() / 2);
                let members = [gzip(a), gzip(b)].concat();
                assert_eq!(load_volume("nii.gz", &members).expect("a volume"), whole);
            }
        }
    }
}

#[test]
fn nifti_places() {
    for (version, places) in [(1, FIRST), (2, SECOND)] {
        let code = |bytes: &mut [u8], at: usize, kind: VoxelType| {
            put(bytes, at, ByteOrder::Little, kind, &[1.0]);
        };
        let (kind, width) = if version == 1 { (VoxelType::I16, 2) } else { (VoxelType::I32, 4) };
        let order = ByteOrder::Little;
        // A quarter of a turn around z, with the third axis turned about, and an origin.
        let half = 0.5f64.sqrt();
        let mut bytes = nifti_with(version, VoxelType::U8, order, |put| {
            put(places.spacings, &[-1.0]);
            put(places.rotation, &[0.0, 0.0, half, 10.0, 20.0, 30.0]);
            // The matrix is not asked for.
            put(places.matrix, &[f64::NAN; 12]);
        });
        code(&mut bytes, places.codes, kind);
        let map = load_volume("nii", &bytes).expect("a volume").to_world;
        for (voxel, world) in [
            (Vec3::ZERO, vec3(10.0, 20.0, 30.0)),
            (Vec3::X, vec3(10.0, 21.0, 30.0)),
            (Vec3::Y, vec3(8.0, 20.0, 30.0)),
            (Vec3::Z, vec3(10.0, 20.0, 27.0)),
        ] {
            assert!((map.transform_point3(voxel) - world).length() < 1e-5, "{map:?}");
        }
        // A matrix comes first.
        let mut bytes = nifti_with(version, VoxelType::U8, order, |put| {
            put(places.rotation, &[f64::NAN; 6]);
            put(places.matrix, &[0.0, 2.0, 0.0, 5.0, 3.0, 0.0, 0.0, 6.0, 0.0, 0.0, -4.0, 7.0]);
        });
        code(&mut bytes, places.codes, kind);
        code(&mut bytes, places.codes + width, kind);
        let map = load_volume("nii", &bytes).expect("a volume").to_world;
        assert_eq!(map.transform_point3(vec3(1.0, 10.0, 100.0)), vec3(25.0, 9.0, -393.0));
    }
}

#[test]
fn nifti_factors() {
    for (version, places) in [(1, FIRST), (2, SECOND)] {
        for (factors, found) in [
            ([0.5, -3.0], (0.5, -3.0)),
            ([0.0, 9.0], (1.0, 0.0)),
            ([f64::NAN, 1.0], (1.0, 0.0)),
            ([2.0, f64::INFINITY], (1.0, 0.0)),
        ] {
            let bytes = nifti_with(version, VoxelType::U8, ByteOrder::Big, |put| {
                put(places.factors, &factors);
            });
            let volume = load_volume("nii", &bytes).expect("a volume");
            assert_eq!((volume.scale, volume.offset), found);
            assert_eq!(volume.value(UVec3::X), Some(11.0 * found.0 + found.1));
        }
    }
}

/// How an array of a VTI is written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Way {
    Text,
    Inline,
    Raw,
    Base64,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Vti {
    pub(super) way: Way,
    pub(super) kind: VoxelType,
    pub(super) order: ByteOrder,
    pub(super) is_wide: bool,
    /// Bytes of a compressed block.
    pub(super) block: Option<usize>,
}

pub(super) const PLAIN: Vti = Vti {
    way: Way::Text,
    kind: VoxelType::U8,
    order: ByteOrder::Little,
    is_wide: false,
    block: None,
};

impl Vti {
    fn length(self, n: usize) -> Vec<u8> {
        let kind = if self.is_wide { VoxelType::U64 } else { VoxelType::U32 };
        number_bytes(kind, self.order, n as f64)
    }

    /// The lengths, and the numbers behind them.
    fn data(self, numbers: &[f64]) -> [Vec<u8>; 2] {
        let bytes = bytes_of(self.kind, self.order, numbers);
        let Some(block) = self.block else { return [self.length(bytes.len()), bytes] };
        let blocks: Vec<_> = bytes.chunks(block).map(zlib).collect();
        let lengths = [blocks.len(), block, bytes.len() % block];
        let lengths = lengths.into_iter().chain(blocks.iter().map(Vec::len));
        [lengths.flat_map(|n| self.length(n)).collect(), blocks.concat()]
    }

    /// The data as text: compressed ones follow their lengths as a text of their own.
    fn base64(self, numbers: &[f64]) -> String {
        let [lengths, data] = self.data(numbers);
        if self.block.is_some() {
            return base64(&lengths) + &base64(&data);
        }
        base64(&[lengths, data].concat())
    }

    /// An array's element; what is appended goes behind `appended`.
    pub(super) fn array(
        self,
        appended: &mut Vec<u8>,
        (name, components, numbers): &Array<'_>,
    ) -> String {
        let (format, text) = match self.way {
            Way::Text => {
                let words: Vec<_> = numbers.iter().map(|n| format!("{n}")).collect();
                ("ascii".into(), words.join(" \n"))
            }
            Way::Inline => ("binary".into(), self.base64(numbers)),
            way => {
                let offset = appended.len();
                match way {
                    Way::Raw => appended.extend(self.data(numbers).concat()),
                    _ => appended.extend(self.base64(numbers).into_bytes()),
                }
                (format!("appended\" offset=\"{offset}"), String::new())
            }
        };
        let kind = format!("{:?}", self.kind);
        let kind = kind.replace('U', "UInt").replace('I', "Int").replace('F', "Float");
        let kind = kind.replace("UIntnt", "UInt");
        format!(
            "<DataArray type=\"{kind}\" Name=\"{name}\" \
             NumberOfComponents=\"{components}\" format=\"{format}\">\n{text}\n\
             </DataArray>\n"
        )
    }

    /// The attributes of the file's element.
    pub(super) fn attributes(self) -> String {
        let order = if self.order == ByteOrder::Big { "BigEndian" } else { "LittleEndian" };
        let width = if self.is_wide { "UInt64" } else { "UInt32" };
        let compressor = match self.block {
            Some(_) => "compressor='vtkZLibDataCompressor'",
            None => "",
        };
        format!("version=\"1.0\" byte_order=\"{order}\" header_type=\"{width}\" {compressor}")
    }

    /// The element of appended data.
    pub(super) fn appended(self, appended: &[u8]) -> Vec<u8> {
        let encoding = if self.way == Way::Raw { "raw" } else { "base64" };
        let mut element = Vec::new();
        if matches!(self.way, Way::Raw | Way::Base64) {
            element.extend(format!("<AppendedData encoding=\"{encoding}\">\n _").bytes());
            element.extend(appended);
            element.extend(b"\n</AppendedData>\n");
        }
        element
    }

    /// A file with arrays: a name, the number of components, and numbers.
    fn file(self, image: &str, points: &[Array<'_>], cells: &[Array<'_>], active: &str) -> Vec<u8> {
        let mut appended = Vec::new();
        let mut list = |arrays: &[Array<'_>]| -> String {
            arrays.iter().map(|array| self.array(&mut appended, array)).collect()
        };
        let (points, cells) = (list(points), list(cells));
        let attributes = self.attributes();
        let mut file = format!(
            "<?xml version=\"1.0\"?>\n<!-- a test -->\n<VTKFile type=\"ImageData\" \
             {attributes}>\n<ImageData {image}>\n\
             <FieldData><DataArray type=\"String\" Name=\"note\" format=\"ascii\">1 2</DataArray>\
             </FieldData><Piece><PointData {active}>\n{points}</PointData>\n\
             <CellData>{cells}</CellData></Piece>\n</ImageData>\n"
        )
        .into_bytes();
        file.extend(self.appended(&appended));
        file.extend(b"</VTKFile>\n");
        file
    }

    /// A file with one array of points.
    pub(super) fn simple(self) -> Vec<u8> {
        let image = "WholeExtent='0 3 0 2 0 1' Origin='10 20 30' Spacing='1 2 3'";
        self.file(image, &[("a", 1, numbers(self.kind))], &[], "Scalars='a'")
    }
}

pub(super) type Array<'a> = (&'a str, usize, Vec<f64>);

pub(super) const ALL_WAYS: [Way; 4] = [Way::Text, Way::Inline, Way::Raw, Way::Base64];

#[test]
fn vti_of_every_type() {
    let place = Affine3::from_translation(vec3(10.0, 20.0, 30.0)) * scaled(1.0, 2.0, 3.0);
    for way in ALL_WAYS {
        for kind in KINDS {
            for order in ORDERS {
                for is_wide in [false, true] {
                    // Blocks that end with the numbers, before, and with only one.
                    for block in [None, Some(24), Some(17), Some(1000)] {
                        let vti = Vti { way, kind, order, is_wide, block };
                        let volume = load_volume("vti", &vti.simple());
                        let volume = volume.unwrap_or_else(|e| panic!("{vti:?}: {e}"));
                        // A text has the type that it names.
                        assert_volume(&volume, kind, place);
                        assert!(!volume.is_cell_centred);
                    }
                }
            }
        }
    }
}

#[test]
fn vti_chooses_arrays() {
    let image = "WholeExtent='1 4 0 2 5 6' Spacing='1 2 3' Direction='0 -1 0 1 0 0 0 0 1'";
    let points = |n: f64| vec![n; 24];
    let cells = |n: f64| vec![n; 6];
    let array = |file: &[u8], name: &str| volume::load_array(&Temp::new("vti", file).0, name);
    let first = |volume: Result<VolumeFile, LoadError>| volume.expect("a volume").voxels.get(0);
    for way in ALL_WAYS {
        let vti = Vti { way, ..PLAIN };
        let two = [("a", 1, points(1.0)), ("b &amp; c", 1, points(2.0))];
        let some = [("a", 1, cells(3.0)), ("d", 1, cells(4.0)), ("v", 3, vec![5.0; 18])];
        let file = vti.file(image, &two, &some, "Scalars='b &amp; c'");
        assert_eq!(first(load_volume("vti", &file)), Some(2.0));
        assert_eq!(first(array(&file, "a")), Some(1.0));
        assert_eq!(first(array(&file, "b & c")), Some(2.0));
        let d = array(&file, "d").expect("a volume");
        assert_eq!((d.size, d.is_cell_centred), (uvec3(3, 2, 1), true));
        assert_eq!(d.voxels, Voxels::U8(vec![4; 6]));
        // The first point is at index 1, 0, 5 of the grid, and a cell's middle is farther by half.
        let a = array(&file, "a").expect("a volume");
        assert_eq!(a.to_world.transform_point3(Vec3::ZERO), vec3(0.0, 1.0, 15.0));
        assert_eq!(a.to_world.transform_point3(Vec3::Y), vec3(-2.0, 1.0, 15.0));
        assert_eq!(d.to_world.transform_point3(Vec3::ZERO), vec3(-1.0, 1.5, 16.5));
        // The only scalars, and none that can be told apart.
        let file = vti.file(image, &[("v", 3, vec![1.0; 72])], &[("d", 1, cells(4.0))], "");
        assert_eq!(first(load_volume("vti", &file)), Some(4.0));
        let message = array(&file, "v").expect_err("three components").to_string();
        assert!(message.contains("has 3 components in the array 'v'"), "{message}");
        assert!(message.contains("'v' (3), 'd' (1)"), "{message}");
        let message = array(&file, "e").expect_err("no such array").to_string();
        assert!(message.contains("has no array 'e'; name one of"), "{message}");
        let file = vti.file(image, &two, &some, "");
        let missing = load_volume("vti", &file);
        assert!(matches!(missing, Err(LoadError::NoArray { .. })), "{missing:?}");
        assert!(refused("vti", &vti.file(image, &[], &[], "")).contains("no array of voxels"));
    }
    // Other formats have no names.
    let file = Temp::new("nii", &nifti(VoxelType::U8, ByteOrder::Little));
    let message = volume::load_array(&file.0, "a").expect_err("no names").to_string();
    assert!(message.contains("has no array 'a'"), "{message}");
}

/// A flat image has one layer of cells, and the extent of a piece counts.
#[test]
fn vti_extents() {
    let image = "WholeExtent='0 2 0 2 7 7'";
    let file = PLAIN.file(image, &[], &[("a", 1, vec![1.0; 4])], "");
    assert_eq!(load_volume("vti", &file).expect("a volume").size, uvec3(2, 2, 1));
    let text = String::from_utf8(PLAIN.simple()).expect("text");
    let text = text.replace("0 3 0 2 0 1'", "0 9 0 9 0 9'");
    let file = text.replace("<Piece>", "<Piece Extent=\"0 3 0 2 0 1\">");
    assert_eq!(load_volume("vti", file.as_bytes()).expect("a volume").size, SIZE);
    let pieces = file.replace("</VTKFile>", "<Piece/></VTKFile>");
    assert!(refused("vti", pieces.as_bytes()).contains("several pieces"));
}

const META_TYPES: [&str; 10] = [
    "UCHAR",
    "CHAR",
    "USHORT",
    "SHORT",
    "UINT",
    "INT",
    "ULONG_LONG",
    "LONG_LONG",
    "FLOAT",
    "DOUBLE",
];

/// A header of MetaImage, up to the name of the file with the voxels.
pub(super) fn meta_header(kind: VoxelType, order: ByteOrder, more: &str) -> String {
    let name = META_TYPES[KINDS.iter().position(|k| *k == kind).expect("a type")];
    let big = if order == ByteOrder::Big { "True" } else { "False" };
    format!(
        "ObjectType = Image\nNDims = 3\nBinaryDataByteOrderMSB = {big}\n{more}\
         DimSize = 4 3 2\r\nElementSpacing = 1 2 3\nElementType = MET_{name}\nElementDataFile = "
    )
}

#[test]
fn metaimage_of_every_type() {
    for kind in KINDS {
        for order in ORDERS {
            let data = bytes_of(kind, order, &numbers(kind));
            let file = |more: &str, data: &[u8]| {
                [format!("{}LOCAL\n", meta_header(kind, order, more)).as_bytes(), data].concat()
            };
            let check = |bytes: &[u8]| {
                let volume = load_volume("mha", bytes).unwrap_or_else(|e| panic!("{kind:?}: {e}"));
                assert_volume(&volume, kind, scaled(1.0, 2.0, 3.0));
            };
            check(&file("", &data));
            check(&file("CompressedData = True\nCompressedDataSize = 9\n", &zlib(&data)));
            check(&file("CompressedData = True\n", &gzip(&data)));
            let words: Vec<_> = numbers(kind).iter().map(|n| format!("{n}")).collect();
            check(&file("BinaryData = False\n", words.join("\n").as_bytes()));
        }
    }
}

/// Writes voxels to a file, and gives its name.
pub(super) fn beside(data: &[u8]) -> (Temp, String) {
    let file = Temp::new("raw", data);
    let name = file.0.file_name().expect("a name").to_string_lossy().into_owned();
    (file, name)
}

#[test]
fn metaimage_beside_its_voxels() {
    let (kind, order) = (VoxelType::I16, ByteOrder::Big);
    let data = bytes_of(kind, order, &numbers(kind));
    let (_file, name) = beside(&[b"header".as_slice(), &data].concat());
    for skipped in [6, -1] {
        let more = format!("HeaderSize = {skipped}\n");
        let text = format!("{}{name}\n", meta_header(kind, order, &more));
        let volume = load_volume("mhd", text.as_bytes()).expect("a volume");
        assert_volume(&volume, kind, scaled(1.0, 2.0, 3.0));
    }
    let place = "Offset = 5 6 7\nTransformMatrix = 0 1 0 -1 0 0 0 0 1\n\
                 ElementToIntensityFunctionSlope = 2\nElementToIntensityFunctionOffset = 3\n";
    let text = format!("{}{name}\n", meta_header(kind, order, place));
    let volume = load_volume("mhd", text.as_bytes()).expect("a volume");
    // The first axis goes along y.
    let world = volume.to_world.transform_point3(vec3(1.0, 1.0, 1.0));
    assert_eq!(world, vec3(5.0 - 2.0, 6.0 + 1.0, 7.0 + 3.0));
    assert_eq!((volume.scale, volume.offset), (2.0, 3.0));
    let flat = "NDims = 2\nDimSize = 4 3\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n\
                abcdefghijkl";
    let volume = load_volume("mha", flat.as_bytes()).expect("a volume");
    assert_eq!((volume.size, volume.to_world), (uvec3(4, 3, 1), Affine3::IDENTITY));
}

const NRRD_TYPES: [&str; 10] = [
    "uchar",
    "int8",
    "unsigned short",
    "short",
    "uint32_t",
    "signed int",
    "uint64",
    "long long int",
    "float",
    "double",
];

pub(super) fn nrrd_header(kind: VoxelType, order: ByteOrder, encoding: &str, more: &str) -> String {
    let name = NRRD_TYPES[KINDS.iter().position(|k| *k == kind).expect("a type")];
    let order = if order == ByteOrder::Big { "big" } else { "little" };
    format!(
        "NRRD0004\n# a test\ntype: {name}\ndimension: 3\nsizes: 4 3 2\nendian: {order}\n\
         encoding: {encoding}\nkey: with=:= a value\n{more}"
    )
}

#[test]
fn nrrd_of_every_type() {
    for kind in KINDS {
        for order in ORDERS {
            let data = bytes_of(kind, order, &numbers(kind));
            let check = |encoding: &str, more: &str, data: &[u8]| {
                let more = format!("spacings: 1 2 3\n{more}");
                let header = nrrd_header(kind, order, encoding, &more);
                let (_file, name) = beside(data);
                let together = [format!("{header}\n").as_bytes(), data].concat();
                let apart = format!("{header}data file: {name}\n");
                for (extension, bytes) in
                    [("nrrd", &together), ("nhdr", &apart.clone().into_bytes())]
                {
                    let volume = load_volume(extension, bytes);
                    let volume = volume.unwrap_or_else(|e| panic!("{kind:?} {more}: {e}"));
                    assert_volume(&volume, kind, scaled(1.0, 2.0, 3.0));
                }
            };
            check("raw", "", &data);
            let behind = |head: &[u8]| [head, &data].concat();
            check("raw", "line skip: 2\nbyte skip: 3\n", &behind(b"one\n\nabc"));
            check("raw", "byte skip: -1\n", &behind(b"abc"));
            check("gzip", "", &gzip(&data));
            check("gz", "byteskip: 3\n", &gzip(&behind(b"abc")));
            check("gz", "lineskip: 1\n", &[b"one\n", &*gzip(&data)].concat());
            let words: Vec<_> = numbers(kind).iter().map(|n| format!("{n}")).collect();
            check("ascii", "", words.join(" ").as_bytes());
        }
    }
}

#[test]
fn nrrd_places() {
    let file = |more: &str| {
        let header = nrrd_header(VoxelType::U8, ByteOrder::Little, "raw", more);
        [format!("{header}\n").as_bytes(), &bytes_of(VoxelType::U8, ByteOrder::Little, &[0.0; 24])]
            .concat()
    };
    let more = "space: left-posterior-superior\nspace directions: (0,2,0) (1, 0, 0)  (0,0,-3)\n\
                space origin: (5,6,7)\ncenterings: node node node\n";
    let volume = load_volume("nrrd", &file(more)).expect("a volume");
    assert!(!volume.is_cell_centred);
    assert_eq!(volume.to_world.transform_point3(vec3(1.0, 10.0, 100.0)), vec3(15.0, 8.0, -293.0));
    let volume = load_volume("nrrd", &file("centers: cell none ???\n")).expect("a volume");
    assert!(volume.is_cell_centred && volume.to_world == Affine3::IDENTITY);
}

/// A layer of a stack.
pub(super) fn png_bytes(color: png::ColorType, bits: png::BitDepth, data: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 4, 3);
    encoder.set_color(color);
    encoder.set_depth(bits);
    let mut writer = encoder.write_header().expect("memory");
    writer.write_image_data(data).expect("memory");
    drop(writer);
    bytes
}

#[test]
fn stacks_of_pictures() {
    for (kind, bits) in
        [(VoxelType::U8, png::BitDepth::Eight), (VoxelType::U16, png::BitDepth::Sixteen)]
    {
        let data = bytes_of(kind, ByteOrder::Big, &numbers(kind));
        let layers: Vec<_> = data
            .chunks(data.len() / 2)
            .map(|layer| Temp::new("png", &png_bytes(png::ColorType::Grayscale, bits, layer)))
            .collect();
        let paths: Vec<_> = layers.iter().map(|file| &file.0).collect();
        let volume = load_stack(&paths).expect("a volume");
        assert_volume(&volume, kind, Affine3::IDENTITY);
    }
}

/// Says so where a real file is not there.
pub(super) fn real(test: &str, name: &str) -> Option<PathBuf> {
    // Written past the test harness, which would swallow what a passing test prints.
    let skip = |why: &str| {
        let mut err = std::io::stderr();
        let _ = writeln!(err, "SKIPPED {test}: {why}; no real volume is read");
        None
    };
    let Some(folder) = std::env::var_os("RAYDSL_DATA") else {
        return skip("RAYDSL_DATA is not set");
    };
    let path = PathBuf::from(folder).join(name);
    if path.exists() { Some(path) } else { skip(&format!("RAYDSL_DATA holds no {name}")) }
}

/// A brain. The numbers are those of Python's gzip and struct.
#[test]
fn a_real_nifti_loads() {
    let Some(path) = real("a_real_nifti_loads", "mni152_t1_1mm.nii.gz") else { return };
    let volume = volume::load(path).expect("a volume");
    assert_eq!(volume.size, uvec3(197, 233, 189));
    assert_eq!(volume.to_world, Affine3::from_translation(vec3(-98.0, -134.0, -72.0)));
    assert_eq!((volume.scale, volume.offset, volume.is_cell_centred), (1.0, 0.0, true));
    let Voxels::U8(voxels) = &volume.voxels else { panic!("no bytes") };
    assert_eq!(voxels.iter().map(|v| u64::from(*v)).sum::<u64>(), 333_468_829);
    assert_eq!((voxels.iter().min(), voxels.iter().max()), (Some(&0), Some(&255)));
    for (voxel, value) in [
        (uvec3(0, 0, 0), 0.0),
        (uvec3(98, 134, 72), 71.0),
        (uvec3(60, 100, 90), 171.0),
        (uvec3(120, 150, 60), 218.0),
        (uvec3(31, 116, 80), 179.0),
        (uvec3(196, 232, 188), 0.0),
    ] {
        assert_eq!(volume.value(voxel), Some(value), "{voxel}");
    }
}

/// A frog's tissues. The numbers are those of Python's zlib and base64.
#[test]
fn a_real_vti_loads() {
    let Some(path) = real("a_real_vti_loads", "frog_tissues.vti") else { return };
    let volume = volume::load(&path).expect("a volume");
    assert_eq!(volume.size, uvec3(500, 470, 136));
    assert_eq!((volume.to_world, volume.is_cell_centred), (scaled(1.0, 1.0, 1.5), false));
    let Voxels::U8(voxels) = &volume.voxels else { panic!("no bytes") };
    assert_eq!(voxels.iter().map(|v| u64::from(*v)).sum::<u64>(), 12_244_762);
    let mut counts = [0; 256];
    voxels.iter().for_each(|v| counts[usize::from(*v)] += 1);
    assert_eq!(counts.iter().filter(|n| **n > 0).count(), 26);
    assert!(counts[29] > 0 && counts[30..].iter().all(|n| *n == 0));
    for (voxel, value) in [
        (uvec3(250, 235, 68), 6.0),
        (uvec3(304, 228, 18), 1.0),
        (uvec3(405, 254, 1), 5.0),
        (uvec3(195, 202, 55), 29.0),
        (uvec3(499, 469, 135), 0.0),
    ] {
        assert_eq!(volume.value(voxel), Some(value), "{voxel}");
    }
    let named = volume::load_array(&path, "MetaImage").expect("a volume");
    assert!(named == volume);
}
