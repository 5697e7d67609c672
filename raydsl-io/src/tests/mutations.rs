//! Files that are changed at random: a loader gives a volume that is whole, or an error of one
//! line.
//!
//! Truncation and damage of single bytes are tested beside each format; here files change their
//! length, borrow from each other, and claim sizes at the limits of integers. `RAYDSL_FUZZ_FILES`
//! is the number of variants of each file, `RAYDSL_FUZZ_SEED` says which ones:
//!
//! ```text
//! RAYDSL_FUZZ_FILES=100000 RAYDSL_FUZZ_SEED=7 cargo test -p raydsl-io mutations -- --nocapture
//! ```

use std::time::{Duration, Instant};

use glam::{UVec3, Vec3};

use super::environments::{check_environment, exr, exrs, hdr, load_environment};
use super::memory::assert_modest;
use super::meshes::{OBJ_SQUARE, load_mesh, ply_square, tri_square};
use super::presets::{EXPORTED, load_presets};
use super::scene_files::*;
use super::volumes::{beside, bytes_of, gzip, meta_header, nifti, nrrd_header, numbers, png_bytes};
use super::volumes_hostile::{check, files};
use super::*;
use crate::guard::guarded;
use crate::volume::{ByteOrder, VoxelType, load_raw, load_stack};

/// More than any of these small files takes, whatever else the machine does.
const LONGEST: Duration = Duration::from_secs(20);

/// Numbers that sizes, places and counts should not be.
const NUMBERS: [&str; 18] = [
    "0",
    "-1",
    "2",
    "3",
    "255",
    "65536",
    "2147483647",
    "2147483648",
    "4294967295",
    "4294967297",
    "9223372036854775807",
    "18446744073709551615",
    "18446744073709551616",
    "1e308",
    "1e-320",
    "-1e999",
    "nan",
    "inf",
];

fn number(name: &str, default: u64) -> u64 {
    match std::env::var(name) {
        Ok(text) => text.parse().unwrap_or_else(|e| panic!("{name}={text}: {e}")),
        Err(_) => default,
    }
}

/// Random numbers, and what is changed by them.
struct Mutation {
    state: u64,
}

impl Mutation {
    fn new(seed: u64) -> Self {
        Self { state: seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) }
    }

    /// SplitMix64.
    fn next(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.state ^ (self.state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() % count.max(1) as u64) as usize
    }

    /// A part of at most so many bytes.
    fn part(&mut self, bytes: &[u8], most: usize) -> std::ops::Range<usize> {
        let begin = self.below(bytes.len());
        begin..(begin + self.below(most + 1)).min(bytes.len())
    }

    /// Bytes of a number at a limit, of any size and order.
    fn limit(&mut self) -> Vec<u8> {
        let number = match self.below(8) {
            0 => 0,
            1 => 1,
            2 => u64::MAX,
            3 => i64::MAX as u64,
            4 => 1 << 31,
            5 => u64::from(f32::NAN.to_bits()) * 0x1_0000_0001,
            6 => u64::from(f32::MAX.to_bits()) * 0x1_0000_0001,
            _ => self.next(),
        };
        let mut bytes = number.to_le_bytes()[..1 << self.below(4)].to_vec();
        if self.below(2) == 0 {
            bytes.reverse();
        }
        bytes
    }

    /// Changes a file; parts may come from another.
    fn apply(&mut self, bytes: &mut Vec<u8>, other: &[u8]) {
        for _ in 0..=self.below(4) {
            let at = self.below(bytes.len());
            match self.below(9) {
                0 => bytes.truncate(at),
                1 => drop(bytes.drain(self.part(bytes, 40))),
                2 => {
                    let copy = bytes[self.part(bytes, 200)].to_vec();
                    bytes.splice(at..at, copy);
                }
                3 => {
                    let copy = other[self.part(other, 60)].to_vec();
                    let part = self.part(bytes, 60);
                    bytes.splice(part, copy);
                }
                4 => {
                    let count = self.below(20);
                    let random: Vec<u8> = (0..count).map(|_| self.next() as u8).collect();
                    bytes.splice(at..at, random);
                }
                5 | 6 => {
                    let limit = self.limit();
                    let end = (at + limit.len()).min(bytes.len());
                    bytes.splice(at..end, limit);
                }
                // A number of a text.
                _ => {
                    let is_digit = |b: &u8| b.is_ascii_digit() || b".-".contains(b);
                    let Some(begin) = bytes[at.min(bytes.len())..].iter().position(is_digit) else {
                        continue;
                    };
                    let begin = at + begin;
                    let length = bytes[begin..].iter().take_while(|b| is_digit(b)).count();
                    let number = NUMBERS[self.below(NUMBERS.len())];
                    bytes.splice(begin..begin + length, number.bytes());
                }
            }
        }
    }
}

/// Checks random variants of each file, which `load` fails on by a panic.
fn each_variant(files: &[Vec<u8>], load: impl Fn(usize, &[u8])) {
    let count = number("RAYDSL_FUZZ_FILES", 2000);
    let seed = number("RAYDSL_FUZZ_SEED", 1);
    let begun = Instant::now();
    for (index, file) in files.iter().enumerate() {
        for round in 0..count {
            let mut mutation = Mutation::new((seed << 40) + ((index as u64) << 32) + round);
            let other = &files[mutation.below(files.len())];
            let mut bytes = file.clone();
            mutation.apply(&mut bytes, other);
            let start = Instant::now();
            let case = format!("seed {seed}, file {index}, round {round}");
            if let Err(panic) = guarded(|| load(index, &bytes)) {
                panic!("{case}: {panic}\n{}", bytes.escape_ascii());
            }
            assert!(start.elapsed() < LONGEST, "{case}: it took {:?}", start.elapsed());
        }
    }
    assert_modest();
    let (all, seconds) = (count * files.len() as u64, begun.elapsed().as_secs_f64());
    println!("{all} files, {:.1} microseconds each", 1e6 * seconds / all as f64);
}

/// Every format, in one file; compressed headers are changed before they are compressed.
#[test]
fn volumes() {
    let plain = files();
    let headers = [VoxelType::U8, VoxelType::F64].map(|kind| nifti(kind, ByteOrder::Little));
    let all: Vec<Vec<u8>> = plain.iter().map(|f| f.1.clone()).chain(headers).collect();
    each_variant(&all, |index, bytes| match plain.get(index) {
        Some((extension, ..)) => check(extension, bytes, "a variant"),
        None => check("nii.gz", &gzip(bytes), "a compressed variant"),
    });
}

/// Unstructured grids in every encoding.
#[test]
fn grids() {
    each_variant(&super::grids::files(), |_, bytes| {
        let _ = super::grids::check_cells(bytes, "a variant");
    });
}

/// Tracts in both byte orders, with a count and without.
#[test]
fn tracts() {
    each_variant(&super::tracts::files(), |_, bytes| {
        let _ = super::tracts::check_tracts(bytes, "a variant");
    });
}

/// Clouds in every format and encoding.
#[test]
fn clouds() {
    let cloud = small(9);
    let las = |format, compressed| las_bytes(&cloud, format, compressed, 257);
    let encodings = ["ascii", "binary_little_endian", "binary_big_endian"];
    let xyz = "# x y z r g b\n0.5 1 -2 7 8 9\n\n1e3,2.5,0,255,0,1\n";
    let mut all = vec![("las", las(2, false)), ("las", las(7, false)), ("laz", las(3, true))];
    all.extend(encodings.map(|encoding| ("ply", ply_bytes(&cloud, encoding))));
    all.push(("xyz", xyz.as_bytes().to_vec()));
    let files: Vec<Vec<u8>> = all.iter().map(|file| file.1.clone()).collect();
    each_variant(&files, |index, bytes| match load_bytes(all[index].0, bytes) {
        Ok(cloud) => {
            let is_finite = |p: &[f64; 3]| p.iter().all(|c| c.is_finite());
            assert!(!cloud.positions.is_empty() && cloud.positions.iter().all(is_finite));
            assert!(cloud.colors.is_empty() || cloud.colors.len() == cloud.positions.len());
        }
        Err(e) => assert!(!e.to_string().contains('\n'), "{e}"),
    });
}

/// Meshes in every format and encoding.
#[test]
fn meshes() {
    let encodings = ["ascii", "binary_little_endian", "binary_big_endian"];
    let mut all = vec![("obj", OBJ_SQUARE.as_bytes().to_vec()), ("tri", tri_square())];
    all.extend(encodings.map(|encoding| ("ply", ply_square(encoding, &[0, 1, 2, 3]))));
    let files: Vec<Vec<u8>> = all.iter().map(|file| file.1.clone()).collect();
    each_variant(&files, |index, bytes| match load_mesh(all[index].0, bytes) {
        Ok(mesh) => {
            let count = mesh.vertices.len() as u32;
            assert!(mesh.triangles.iter().flatten().all(|&corner| corner < count));
            assert!(mesh.normals.is_empty() || mesh.normals.len() == mesh.vertices.len());
            let is_finite = |&corner: &u32| mesh.vertices[corner as usize].is_finite();
            assert!(mesh.triangles.iter().flatten().all(is_finite));
        }
        Err(e) => assert!(!e.to_string().contains('\n'), "{e}"),
    });
}

/// Headers whose voxels are in a file beside them.
#[test]
fn volumes_beside_their_headers() {
    let (kind, order) = (VoxelType::U16, ByteOrder::Little);
    let (_file, name) = beside(&bytes_of(kind, order, &numbers(kind)));
    let meta = format!("{}{name}\n", meta_header(kind, order, ""));
    let nrrd = nrrd_header(kind, order, "raw", &format!("data file: {name}\nbyte skip: -1\n"));
    for (extension, header) in [("mhd", &meta), ("nhdr", &nrrd)] {
        assert!(volume::load(&Temp::new(extension, header.as_bytes()).0).is_ok());
    }
    each_variant(&[meta.into_bytes(), nrrd.into_bytes()], |index, bytes| {
        check(["mhd", "nhdr"][index], bytes, "a variant");
    });
}

#[test]
fn stacks_and_raw_files() {
    let grey = png_bytes(png::ColorType::Grayscale, png::BitDepth::Eight, &[7; 12]);
    let deep = png_bytes(png::ColorType::Grayscale, png::BitDepth::Sixteen, &[7; 24]);
    let files = [grey, deep, vec![7; 24]];
    let layers = [0, 1].map(|i| Temp::new("png", &files[i]));
    each_variant(&files, |index, bytes| {
        let file = Temp::new("png", bytes);
        let found = match index {
            2 => load_raw(&file.0, UVec3::new(3, 2, 2), VoxelType::U16, ByteOrder::Big),
            _ => load_stack(&[&layers[index].0, &file.0]),
        };
        match found {
            Ok(volume) => {
                assert_eq!(volume.voxels.len() as u32, volume.size.element_product());
                assert!(index < 2 || bytes.len() == 24);
            }
            Err(e) => assert!(!e.to_string().contains('\n'), "{e}"),
        }
    });
}

/// Presets are as transfer functions want them.
#[test]
fn presets() {
    let spaces = ["HSV", "Lab", "Step"].map(|space| EXPORTED.replace("Diverging", space));
    let mut all = vec![EXPORTED.as_bytes().to_vec()];
    all.extend(spaces.map(String::into_bytes));
    each_variant(&all, |_, bytes| match load_presets(bytes) {
        Ok(presets) => {
            assert!(!presets.is_empty());
            for preset in presets {
                let is_share = |x: f32| (0.0..=1.0).contains(&x);
                let is_color = |c: Vec3| c.to_array().into_iter().all(is_share);
                assert!(!preset.colors.is_empty() && preset.colors.is_sorted_by(|a, b| a.0 <= b.0));
                assert!(preset.colors.iter().all(|(v, c)| v.is_finite() && is_color(*c)));
                assert!(preset.opacities.is_sorted_by(|a, b| a.0 <= b.0));
                assert!(preset.opacities.iter().all(|(v, a)| v.is_finite() && is_share(*a)));
            }
        }
        Err(e) => {
            let text = e.to_string();
            assert!(!text.contains('\n') && text.contains(';'), "{text}");
        }
    });
}

/// glTF in both forms. The pieces of each are also changed alone, as most changes of a whole file
/// only break its JSON.
#[test]
fn scenes() {
    let b = everything();
    let (json, bin) = (b.json("", REST), b.bin.clone());
    let uri = format!("data:;base64,{}", base64(&bin));
    let files = [b.glb(REST), json.clone().into_bytes(), bin.clone(), b.json(&uri, REST).into()];
    each_variant(&files, |index, bytes| {
        let found = match index {
            0 => crate::scene::load(&Temp::new("glb", bytes).0),
            1 => match str::from_utf8(bytes) {
                Ok(json) => crate::scene::load(&Temp::new("glb", &glb(json, &bin)).0),
                Err(_) => return,
            },
            2 => crate::scene::load(&Temp::new("glb", &glb(&json, bytes)).0),
            _ => crate::scene::load(&Temp::new("gltf", bytes).0),
        };
        check_scene(&found, "a variant");
    });
}

/// An OBJ, its MTL and its picture.
#[test]
fn scenes_of_obj() {
    let folder = Folder::obj();
    let png = picture(image::ImageFormat::Png);
    let (names, files) = (
        ["scene.obj", "scene.mtl", "dots.png"],
        [OBJ.as_bytes().to_vec(), MTL.as_bytes().to_vec(), png],
    );
    each_variant(&files, |index, bytes| {
        folder.write(names[index], bytes);
        check_scene(&folder.load("scene.obj"), "a variant");
        folder.write(names[index], &files[index]);
    });
}

#[test]
fn environments() {
    let files: Vec<Vec<u8>> = [hdr(), exr(None)].into_iter().chain(exrs()).collect();
    each_variant(&files, |index, bytes| {
        let extension = if index == 0 { "hdr" } else { "exr" };
        check_environment(&load_environment(extension, bytes), "a variant");
    });
}
