//! Volumes that are cut off, damaged, or claim what they do not have.

use glam::uvec3;

use super::volumes::{
    PLAIN, Vti, Way, bytes_of, gzip, load_volume, meta_header, nifti, nrrd_header, numbers,
    png_bytes, refused, zlib,
};
use super::*;
use crate::volume::{ByteOrder, VoxelType, Voxels, load_raw, load_stack};

const LITTLE: ByteOrder = ByteOrder::Little;

/// A small file of each kind, and whether its end can be seen.
pub(super) fn files() -> Vec<(&'static str, Vec<u8>, bool)> {
    let kind = VoxelType::I16;
    let data = bytes_of(kind, LITTLE, &numbers(kind));
    let words: Vec<_> = numbers(kind).iter().map(|n| format!("{n}")).collect();
    let words = words.join(" ").into_bytes();
    let meta = |more: &str, data: &[u8]| {
        [format!("{}LOCAL\n", meta_header(kind, LITTLE, more)).as_bytes(), data].concat()
    };
    let nrrd = |encoding: &str, data: &[u8]| {
        let more = "space directions: (1,0,0) (0,2,0) (0,0,3)\nspace origin: (1,2,3)\n\n";
        [nrrd_header(kind, LITTLE, encoding, more).as_bytes(), data].concat()
    };
    let vti = |way, block, is_wide| Vti { way, kind, block, is_wide, ..PLAIN }.simple();
    vec![
        ("nii", nifti(kind, LITTLE), true),
        ("nii", nifti(kind, ByteOrder::Big), true),
        ("nii.gz", gzip(&nifti(kind, LITTLE)), true),
        ("vti", vti(Way::Text, None, false), true),
        ("vti", vti(Way::Inline, None, false), true),
        ("vti", vti(Way::Inline, Some(17), true), true),
        ("vti", vti(Way::Raw, None, true), true),
        ("vti", vti(Way::Raw, Some(20), false), true),
        ("vti", vti(Way::Base64, Some(1000), false), true),
        ("mha", meta("TransformMatrix = 1 0 0 0 1 0 0 0 1\n", &data), true),
        ("mha", meta("CompressedData = True\n", &zlib(&data)), true),
        ("mha", meta("BinaryData = False\n", &words), false),
        ("nrrd", nrrd("raw", &data), true),
        ("nrrd", nrrd("gzip", &gzip(&data)), true),
        ("nrrd", nrrd("ascii", &words), false),
    ]
}

/// A volume as it has to be, or an error of one line.
#[track_caller]
pub(super) fn check(extension: &str, bytes: &[u8], case: &str) {
    match load_volume(extension, bytes) {
        Ok(volume) => {
            assert_eq!(volume.voxels.len() as u32, volume.size.element_product());
            let to_voxels = volume.to_world.as_daffine3().inverse().as_affine3();
            assert!(volume.to_world.is_finite() && to_voxels.is_finite());
            assert!(volume.scale.is_finite() && volume.offset.is_finite());
        }
        Err(e) => {
            let text = e.to_string();
            assert!(!text.contains('\n') && text.contains(';'), "{extension}, {case}: {text}");
        }
    }
}

/// Every file cut at every byte: an error, or the whole volume where only the end of a tag or of
/// the white space is missing.
#[test]
fn cut_volumes_are_errors() {
    for (extension, bytes, has_end) in files() {
        let whole = load_volume(extension, &bytes).expect("a volume");
        for end in 0..bytes.len() {
            let case = format!("cut at {end}");
            check(extension, &bytes[..end], &case);
            match load_volume(extension, &bytes[..end]) {
                Ok(part) if has_end => assert_eq!(part, whole, "{extension}, {case}"),
                // The last number of a text may be cut.
                Ok(part) => assert_eq!(part.size, whole.size, "{extension}, {case}"),
                Err(LoadError::Truncated { len, .. }) => assert_eq!(len, end as u64),
                // A line or a magic of a header may lack its last letters.
                Err(e) => assert!(end < 700, "{extension}, {case}: {e}"),
            }
        }
    }
    assert_modest();
}

/// Every byte changed, and several at once.
#[test]
fn damaged_volumes_never_panic() {
    let mut state = 1u64;
    let mut random = move |below: usize| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    for (extension, bytes, _) in files() {
        for at in 0..bytes.len() {
            for flip in [0x01, 0x02, 0x10, 0x80, 0xff] {
                let mut damaged = bytes.clone();
                damaged[at] ^= flip;
                check(extension, &damaged, &format!("byte {at} by {flip}"));
            }
        }
        for round in 0..500 {
            let mut damaged = bytes.clone();
            for _ in 0..=random(8) {
                let at = random(bytes.len());
                damaged[at] = [0, 1, 0x7f, 0xff, b'9', b' ', b'\n', b'<', b'='][random(9)];
            }
            check(extension, &damaged, &format!("round {round}"));
        }
    }
    // Damage within a compressed header, behind sums that are right.
    let plain = nifti(VoxelType::I16, LITTLE);
    for round in 0..1000 {
        let mut damaged = plain.clone();
        for _ in 0..=random(4) {
            damaged[random(352)] = [0, 1, 2, 0x40, 0x7f, 0xff][random(6)];
        }
        check("nii.gz", &gzip(&damaged), &format!("compressed round {round}"));
    }
    assert_modest();
}

fn edited(at: usize, bytes: &[u8]) -> Vec<u8> {
    let mut file = nifti(VoxelType::U8, LITTLE);
    file[at..][..bytes.len()].copy_from_slice(bytes);
    file
}

#[test]
fn broken_nifti_is_named() {
    let sizes = |n: [i16; 8]| n.map(i16::to_le_bytes).concat();
    let float = |x: f32| x.to_le_bytes();
    for (file, what) in [
        (vec![], "cut off at byte 0: it ends within its header"),
        (vec![0; 400], ", byte 0: is no valid NIfTI: its first number is not 348 or 540"),
        (nifti(VoxelType::U8, LITTLE)[..300].to_vec(), "300 of 348 bytes of its header"),
        (edited(344, b"ni1\0"), ".img"),
        (edited(344, b"abcd"), "byte 344: is no valid NIfTI: it has no mark"),
        (edited(70, &[128, 0]), "byte 70: is no valid NIfTI: the type 128"),
        (edited(40, &sizes([9, 4, 3, 2, 1, 1, 1, 1])), "it has 9 axes"),
        (edited(40, &sizes([3, 4, -3, 2, 1, 1, 1, 1])), "its size along axis 1 is -3"),
        (edited(40, &sizes([3, 4, 0, 2, 1, 1, 1, 1])), "holds no voxel"),
        (edited(40, &sizes([4, 4, 3, 2, 5, 1, 1, 1])), "it has 5 volumes"),
        (edited(40, &sizes([3, 4, 3, 3, 1, 1, 1, 1])), "take 36 bytes, 24 are there"),
        (edited(40, &sizes([3, 32767, 32767, 32767, 1, 1, 1, 1])), "at most 2147483648"),
        (edited(80, &float(f32::NAN)), "byte 76: is no valid NIfTI: the spacing NaN"),
        (edited(84, &float(0.0)), "the spacing 0"),
        (edited(84, &float(-1.0)), "the spacing -1"),
        (edited(84, &float(1e-40)), "byte 76: is no valid NIfTI: its spacing has no inverse"),
        (edited(254, &[1, 0]), "byte 280: is no valid NIfTI: its matrix"),
        (edited(108, &float(1e30)), "its voxels begin at byte 1"),
        (edited(108, &float(f32::NAN)), "its voxels begin at byte NaN"),
        (edited(108, &float(352.5)), "its voxels begin at byte 352.5"),
        (edited(108, &float(1e6)), "the voxels begin at byte 1000000 of 392"),
    ] {
        let message = refused("nii", &file);
        assert!(message.contains(what), "{message}\n{what}");
        if file.len() > 348 && !what.contains("392") && !what.contains("24 are") {
            let packed = refused("nii.gz", &gzip(&file));
            assert!(packed.contains(what), "{packed}\n{what}");
        }
    }
    let mut rotated = edited(252, &[1, 0]);
    rotated[268..272].copy_from_slice(&float(f32::INFINITY));
    assert!(refused("nii", &rotated).contains("byte 256: is no valid NIfTI: its rotation"));
    // A sum that is wrong.
    let mut packed = gzip(&nifti(VoxelType::U8, LITTLE));
    let end = packed.len();
    packed[end - 8] ^= 1;
    assert!(refused("nii.gz", &packed).contains("is no valid NIfTI"));
}

/// Sizes that no file of this length can hold: neither memory nor time is spent on them.
#[test]
fn claims_of_volumes_are_not_trusted() {
    // 2^31 voxels in 400 bytes, and compressed.
    let sizes = [3i16, 2048, 1024, 1024, 1, 1, 1, 1].map(i16::to_le_bytes).concat();
    let file = edited(40, &sizes);
    assert!(refused("nii", &file).contains("take 2147483648 bytes, 24 are there"));
    assert!(refused("nii.gz", &gzip(&file)).contains("take 2147483648 bytes"));
    // Much more than the header promises is not inflated: 24 voxels, and zeros without end.
    let bomb = gzip(&[nifti(VoxelType::U8, LITTLE), vec![0; 32 << 20]].concat());
    assert_eq!(load_volume("nii.gz", &bomb).expect("a volume").voxels.len(), 24);
    // Nor is what lies before the voxels, beyond a limit.
    let far = gzip(&edited(108, &1e9f32.to_le_bytes()));
    assert!(refused("nii.gz", &far).contains("at most 67108864"));
    let near = gzip(&edited(108, &1e6f32.to_le_bytes()));
    assert!(refused("nii.gz", &near).contains("bytes before the voxels are there"));
    let size = uvec3(u32::MAX, u32::MAX, u32::MAX);
    let raw = Temp::new("raw", &[0; 24]);
    let message = load_raw(&raw.0, size, VoxelType::F64, LITTLE).expect_err("too many").to_string();
    assert!(message.contains("has 18446744073709551615 voxels"), "{message}");
    let size = uvec3(2048, 1024, 1024);
    let message = load_raw(&raw.0, size, VoxelType::F64, LITTLE).expect_err("too many").to_string();
    assert!(message.contains("take 17179869184 bytes, 24 are there"), "{message}");
    let message = load_raw(&raw.0, uvec3(5, 1, 1), VoxelType::U8, LITTLE).expect_err("too few");
    let message = message.to_string();
    assert!(message.contains("byte 5") && message.contains("5 x 1 x 1 voxels of u8"), "{message}");
    assert!(message.ends_with("check the size and the type"), "{message}");
    for (way, block) in [
        (Way::Text, None),
        (Way::Inline, None),
        (Way::Raw, None),
        (Way::Raw, Some(24)),
        (Way::Base64, Some(24)),
    ] {
        let file = Vti { way, block, ..PLAIN }.simple();
        for (sizes, what) in [
            ("0 2047 0 1023 0 1023", "2147483648 bytes"),
            ("0 2047 0 1023 0 1024", "at most 2147483648"),
            ("-2147483648 2147483647 0 0 0 0", "at most 2147483648"),
            ("0 -1 0 2 0 1", "holds no voxel"),
            ("-9223372036854775808 9223372036854775807 0 0 0 0", "WholeExtent"),
        ] {
            let find = b"0 3 0 2 0 1";
            let at = file.windows(find.len()).position(|w| w == find).expect("sizes");
            let file = [&file[..at], sizes.as_bytes(), &file[at + find.len()..]].concat();
            let message = refused("vti", &file);
            let text = way == Way::Text && what == "2147483648 bytes";
            let what = if text { "4294967295 bytes of text" } else { what };
            assert!(message.contains(what), "{message}\n{what}");
        }
    }
    let meta = meta_header(VoxelType::U8, LITTLE, "").replace("4 3 2", "1024 1024 2048");
    let message = refused("mha", format!("{meta}LOCAL\nabc").as_bytes());
    assert!(message.contains("take 2147483648 bytes, 3 are there"), "{message}");
    let nrrd = nrrd_header(VoxelType::U8, LITTLE, "ascii", "\n").replace("4 3 2", "1024 1024 2048");
    assert!(refused("nrrd", nrrd.as_bytes()).contains("bytes of text, 0 are there"));
    assert_modest();
}

#[test]
fn broken_vti_is_named() {
    let text = |vti: Vti| String::from_utf8(vti.simple()).expect("text");
    let plain = text(PLAIN);
    let inline = text(Vti { way: Way::Inline, ..PLAIN });
    let packed = text(Vti { way: Way::Inline, block: Some(24), ..PLAIN });
    let appended = text(Vti { way: Way::Base64, ..PLAIN });
    for (file, what) in [
        (String::new(), "cut off at byte 0"),
        ("no XML".into(), "no element 'ImageData'"),
        (plain.replace("ImageData", "PolyData"), "it holds 'PolyData' instead of 'ImageData'"),
        (plain.replace("</Piece>", "</Peace>"), "is no valid VTI"),
        (plain.replace("</VTKFile>", ""), "it ends within an element"),
        (plain.replace("WholeExtent", "Extent"), "has no 'WholeExtent'"),
        (plain.replace("0 3 0 2 0 1", "0 3 0 2 0"), "instead of 6 numbers"),
        (plain.replace("'1 2 3'", "'1 nan 3'"), "its spacing, origin or direction"),
        (plain.replace("'1 2 3'", "'1 0 3'"), "its spacing, origin or direction"),
        (plain.replace("'10 20 30'", "'10 inf 30'"), "its spacing, origin or direction"),
        (plain.replace("LittleEndian", "Middle"), "'Middle' is no byte order"),
        (plain.replace("UInt32", "UInt16"), "'UInt16' is no type of lengths"),
        (plain.replace("header_type", "compressor='vtkLZ4DataCompressor' x"), "vtkLZ4"),
        (plain.replace("UInt8", "Bit"), "'Bit' is no type of numbers"),
        (plain.replace("format=\"ascii\"", "format=\"hex\""), "'hex' is no format"),
        (plain.replace("Components=\"1\"", "Components=\"x\""), "'NumberOfComponents'"),
        (plain.replace("Components=\"1\"", "Components=\"3\""), "has 3 components"),
        (plain.replace("0 \n11 \n", "0 \n"), "23 of 24 voxels are there"),
        (plain.replace("0 \n11 \n", "0 \n300 \n"), "voxel 1, '300', is no u8"),
        (plain.replace("0 \n11 \n", "0 \n1.5 \n"), "voxel 1, '1.5', is no u8"),
        (plain.replace("0 \n11 \n", &"1".repeat(100)), "longer than 64 letters"),
        (inline.replace("GAAAA", "GQAAA"), "take 24 bytes, its array has"),
        (inline.replace("GAAAA", "GA*AA"), "a letter that is none"),
        (inline.replace("\nGAAAA", "\nGA=AA"), "goes on behind the `=`"),
        (inline.replace("\nGAAAA", "\nG=AAA"), "a letter that is none"),
        (packed.replace("\nAQAAA", "\nAgAAA"), "its array has 2 blocks of 24, the last of 24"),
        (packed.replace("\nAQAAA", "\n////f"), "blocks"),
        (appended.replace("offset=\"0\"", "offset=\"99999\""), "begin behind byte"),
        (appended.replace("offset=\"0\"", "offset=\"18446744073709551615\""), "begin behind byte"),
        (appended.replace("offset=\"0\"", "offset=\"-1\""), "'offset'"),
        (appended.replace(" _", " "), "begin without `_`"),
        (appended.replace("AppendedData", "Appended"), "there are none"),
        (appended.replace("encoding=\"base64\"", "encoding=\"hex\""), "'hex' is no encoding"),
    ] {
        let message = refused("vti", file.as_bytes());
        assert!(message.contains(what), "{message}\n{what}");
    }
    let file = Vti { way: Way::Raw, block: Some(24), ..PLAIN }.simple();
    let find = |mark: &[u8]| file.windows(mark.len()).position(|w| w == mark).expect("a mark");
    // The sum of the block, its length, and a length that goes on behind it.
    let start = find(b" _") + 2;
    let end = find(b"\n</Appended") - 1;
    let mut damaged = file.clone();
    damaged[end] ^= 1;
    assert!(refused("vti", &damaged).contains("is no valid VTI"));
    for change in [1, 255] {
        let mut damaged = file.clone();
        damaged[start + 12] = damaged[start + 12].wrapping_add(change);
        assert!(refused("vti", &damaged).contains("compressed block"));
    }
}

#[test]
fn broken_text_headers_are_named() {
    let meta = format!("{}LOCAL\n{}", meta_header(VoxelType::U8, LITTLE, ""), "x".repeat(24));
    let zero = "ElementSpacing = 1 0 3";
    for (file, what) in [
        (String::new(), "it ends within its header"),
        (meta.replace("NDims = 3", "NDims = 4"), ":2: is no valid MetaImage: '4' is none"),
        (meta.replace("NDims = 3\n", ""), "its header has no line 'NDims'"),
        (meta.replace("NDims = 3", "NDims"), ":2: is no valid MetaImage: 'NDims' is no line"),
        (meta.replace("4 3 2", "4 3"), "'4 3' is no list of 3 numbers"),
        (meta.replace("4 3 2", "4 -3 2"), "'4 -3 2' is no list of 3 numbers"),
        (meta.replace("4 3 2", "4 0 2"), "holds no voxel"),
        (meta.replace("4 3 2", "4 3 3"), "take 36 bytes, 24 are there"),
        (meta.replace("MET_UCHAR", "MET_BIT"), "'MET_BIT' is none"),
        (meta.replace("NDims = 3", "NDims = 3\nElementNumberOfChannels = 3"), "it has 3 numbers"),
        (meta.replace("ElementSpacing = 1 2 3", zero), ":5: is no valid MetaImage: its spacing"),
        (meta.replace("= 1 2 3", "= 1 nan 3"), ":5: is no valid MetaImage: its spacing"),
        (meta.replace("LOCAL", "LIST"), "list of files"),
        (meta.replace("LOCAL", "../x.raw"), "its voxels are in '../x.raw'"),
        (meta.replace("LOCAL", "/etc/passwd"), "its voxels are in '/etc/passwd'"),
        (meta.replace("LOCAL", ""), "its voxels are in ''"),
        (meta.replace("LOCAL", "no-such-file.raw"), "no such file"),
        (meta.replace("MSB = False", "MSB = Maybe"), "'Maybe' is none"),
        (meta.replace("NDims = 3", "NDims = 3\nCompressedData = True"), "is no valid MetaImage"),
        (meta.replace("NDims = 3", "NDims = 3\nBinaryData = False"), "bytes of text, 24 are"),
        ("a = b\n".repeat(200_000), "header is longer than"),
    ] {
        let message = refused("mha", file.as_bytes());
        assert!(message.contains(what), "{message}\n{what}");
    }
    let head = nrrd_header(VoxelType::U16, LITTLE, "raw", "spacings: 1 2 3\n");
    let nrrd = format!("{head}\n{}", "x".repeat(48));
    let long = format!("NRRD0004\n{}", "# more\n".repeat(200_000));
    for (file, what) in [
        (String::new(), "it ends within its header"),
        ("NARD0004\n".into(), ":1: is no valid NRRD: it begins with 'NARD0004'"),
        (head, "it ends within its header"),
        (nrrd.replace("dimension: 3", "dimension: 4"), ":4: is no valid NRRD: it has 4 axes"),
        (nrrd.replace("sizes: 4 3 2", "sizes: 4 3"), "'4 3' is no list of 3 numbers"),
        (nrrd.replace("sizes: 4 3 2", "sizes: 4 3 3"), "take 72 bytes, 48 are there"),
        (nrrd.replace("sizes: 4 3 2", "sizes: 0 3 3"), "holds no voxel"),
        (nrrd.replace("sizes:", "size"), "'size 4 3 2' is no line"),
        (nrrd.replace("unsigned short", "block"), "'block' is none"),
        (nrrd.replace("endian: little\n", ""), "no line 'endian'"),
        (nrrd.replace("little", "middle"), "'middle' is none"),
        (nrrd.replace("encoding: raw", "encoding: bzip2"), "'bzip2' is none"),
        (nrrd.replace("encoding: raw", "encoding: gzip"), "is no valid NRRD"),
        (nrrd.replace("spacings: 1 2 3", "spacings: 1 nan 3"), ":9: is no valid NRRD: its spac"),
        (nrrd.replace("spacings: 1 2 3", "spacings: 1 0 3"), ":9: is no valid NRRD: its spacings"),
        (nrrd.replace("spacings: 1 2 3", "space directions: none (1,0,0)"), "is none of its"),
        (nrrd.replace("spacings: 1 2 3", "space directions: (1,0,0) (1,0,0)"), "2 directions"),
        (nrrd.replace("spacings: 1 2 3", "space origin: (1,0)"), "is none of its"),
        (nrrd.replace("spacings: 1 2 3", "byte skip: -2"), "-2 bytes behind"),
        (nrrd.replace("spacings: 1 2 3", "byte skip: 99"), "99 bytes come before"),
        (nrrd.replace("spacings: 1 2 3", "line skip: 99"), "of 99 lines"),
        (nrrd.replace("spacings: 1 2 3", "data file: LIST"), "list of files"),
        (nrrd.replace("spacings: 1 2 3", "data file: a/../../b"), "its voxels are in 'a/../../b'"),
        (long, "header is longer than"),
    ] {
        let message = refused("nrrd", file.as_bytes());
        assert!(message.contains(what), "{message}\n{what}");
    }
}

#[test]
fn broken_stacks_are_named() {
    let grey = png_bytes(png::ColorType::Grayscale, png::BitDepth::Eight, &[7; 12]);
    let deep = png_bytes(png::ColorType::Grayscale, png::BitDepth::Sixteen, &[7; 24]);
    let color = png_bytes(png::ColorType::Rgb, png::BitDepth::Eight, &[7; 36]);
    let stack = |layers: &[&[u8]]| {
        let layers: Vec<_> = layers.iter().map(|bytes| Temp::new("png", bytes)).collect();
        load_stack(&layers.iter().map(|file| &file.0).collect::<Vec<_>>())
    };
    let message = |layers: &[&[u8]]| {
        let text = stack(layers).expect_err("an error").to_string();
        assert!(!text.contains('\n') && text.contains(';'), "{text}");
        text
    };
    assert!(message(&[]).contains("holds no picture"));
    assert!(message(&[&grey, &deep]).contains("it is 4 x 3 of u16, the first is 4 x 3 of u8"));
    assert!(message(&[&color]).contains("its pixels are Rgb of 8 bits"));
    assert!(message(&[&grey, b""]).contains("cut off at byte 0"));
    assert!(message(&[b"not a picture"]).contains("is no valid PNG"));
    // A size that no file of this length can hold, behind a sum that is right.
    let mut large = grey.clone();
    large[16..24].copy_from_slice(&[0, 0, 0x7f, 0xff, 0, 0, 0x7f, 0xff]);
    let sum = {
        let mut sum = flate2::Crc::new();
        sum.update(&large[12..29]);
        sum.sum()
    };
    large[29..33].copy_from_slice(&sum.to_be_bytes());
    assert!(message(&[&large]).contains("take 1073676289 bytes"));
    assert!(message(&[&large, &large, &large]).contains("at most 2147483648"));
    let whole = stack(&[&deep, &deep]).expect("a volume");
    for end in 0..deep.len() {
        match stack(&[&deep, &deep[..end]]) {
            Ok(part) => assert_eq!(part, whole, "cut at {end}"),
            Err(e) => assert!(!e.to_string().contains('\n'), "cut at {end}: {e}"),
        }
        for flip in [0x01, 0x02, 0x80, 0xff] {
            let mut damaged = deep.clone();
            damaged[end] ^= flip;
            if let Err(e) = stack(&[&damaged]) {
                assert!(!e.to_string().contains('\n'), "byte {end} by {flip}: {e}");
            }
        }
    }
    assert_modest();
}

/// Names tell formats, and errors know them.
#[test]
fn names_of_volumes() {
    let known = ".mha, .mhd, .nhdr, .nii, .nii.gz, .nrrd, .vti";
    assert!(refused("gz", b"").contains(known));
    assert!(refused("vtk", b"").contains("'vtk'"));
    assert!(matches!(volume::load("no-such.nii.gz"), Err(LoadError::Missing { .. })));
    // Floats may be anything.
    let bytes = bytes_of(VoxelType::F32, LITTLE, &[f64::NAN, f64::INFINITY]);
    let raw = Temp::new("raw", &bytes);
    let volume = load_raw(&raw.0, uvec3(2, 1, 1), VoxelType::F32, LITTLE).expect("a volume");
    assert!(matches!(&volume.voxels, Voxels::F32(v) if v[0].is_nan() && v[1] == f32::INFINITY));
}
