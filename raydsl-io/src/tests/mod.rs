//! Tests of all loaders, with files that they write.

mod environments;
mod files;
mod grids;
mod hostile;
mod memory;
mod meshes;
mod mutations;
mod presets;
mod scene_files;
mod scenes;
mod tracts;
mod volumes;
mod volumes_hostile;

use std::path::PathBuf;
use std::sync::atomic::{AtomicU32, Ordering};

use memory::assert_modest;

use crate::cloud::{self, PointCloud};
use crate::mesh::{self, Mesh};
use crate::volume::{self, VolumeFile};
use crate::{LoadError, Place};

/// A file in the system's folder for temporary files, removed at the end.
struct Temp(PathBuf);

impl Temp {
    fn new(extension: &str, bytes: &[u8]) -> Self {
        static NEXT: AtomicU32 = AtomicU32::new(0);
        let n = NEXT.fetch_add(1, Ordering::Relaxed);
        let name = format!("raydsl-io-{}-{n}.{extension}", std::process::id());
        let path = std::env::temp_dir().join(name);
        std::fs::write(&path, bytes).expect("a temporary file");
        Self(path)
    }

    fn cloud(&self) -> Result<PointCloud, LoadError> {
        cloud::load(&self.0, &mut |_, _| {})
    }

    fn mesh(&self) -> Result<Mesh, LoadError> {
        mesh::load(&self.0)
    }

    fn volume(&self) -> Result<VolumeFile, LoadError> {
        volume::load(&self.0)
    }
}

impl Drop for Temp {
    fn drop(&mut self) {
        // Left behind at worst.
        let _ = std::fs::remove_file(&self.0);
    }
}

fn load_bytes(extension: &str, bytes: &[u8]) -> Result<PointCloud, LoadError> {
    Temp::new(extension, bytes).cloud()
}

/// The error's message, which has to be one line.
fn message(extension: &str, bytes: &[u8]) -> String {
    let text = load_bytes(extension, bytes).expect_err("an error").to_string();
    assert!(!text.contains('\n'), "more than one line: {text}");
    text
}

/// A small cloud whose coordinates are exact in all formats.
fn small(points: usize) -> PointCloud {
    let position = |i: usize| [i as f64 * 0.5, (i * i % 17) as f64 * 0.25, (i % 5) as f64 - 2.0];
    let color = |i: usize| [i as u8, 255 - i as u8, (i * 7) as u8];
    PointCloud {
        positions: (0..points).map(position).collect(),
        colors: (0..points).map(color).collect(),
    }
}

/// LAS 1.4 bytes; colours are multiplied by `depth`.
fn las_bytes(cloud: &PointCloud, format: u8, compressed: bool, depth: u16) -> Vec<u8> {
    let mut builder = ::las::Builder::from((1, 4));
    builder.point_format = ::las::point::Format::new(format).expect("a format");
    builder.point_format.is_compressed = compressed;
    let t = ::las::Transform { scale: 0.001, offset: 10.0 };
    builder.transforms = ::las::Vector { x: t, y: t, z: t };
    let header = builder.into_header().expect("a header");
    let mut writer =
        ::las::Writer::new(std::io::Cursor::new(Vec::new()), header).expect("a writer");
    for (p, c) in cloud.positions.iter().zip(&cloud.colors) {
        let [red, green, blue] = c.map(|c| u16::from(c) * depth);
        let has_color = writer.header().point_format().has_color;
        let point = ::las::Point {
            x: p[0],
            y: p[1],
            z: p[2],
            intensity: u16::from(c[0]) * 16,
            color: has_color.then_some(::las::Color { red, green, blue }),
            nir: writer.header().point_format().has_nir.then_some(1),
            gps_time: writer.header().point_format().has_gps_time.then_some(1.0),
            ..Default::default()
        };
        writer.write_point(point).expect("a point");
    }
    writer.into_inner().expect("the bytes").into_inner()
}

/// PLY bytes with doubles and byte colours.
fn ply_bytes(cloud: &PointCloud, encoding: &str) -> Vec<u8> {
    let mut out = format!(
        "ply\nformat {encoding} 1.0\ncomment a test\nelement camera 1\nproperty float f\n\
         property list uchar int marks\nelement vertex {}\nproperty double x\n\
         property double y\nproperty double z\nproperty uchar red\nproperty uchar green\n\
         property uchar blue\nend_header\n",
        cloud.positions.len()
    )
    .into_bytes();
    let big = encoding == "binary_big_endian";
    match encoding {
        "ascii" => out.extend(b"1.5 2 7 8\n"),
        _ if big => out.extend([0x3f, 0xc0, 0, 0, 1, 0, 0, 0, 7]),
        _ => out.extend([0, 0, 0xc0, 0x3f, 1, 7, 0, 0, 0]),
    }
    for ([x, y, z], [r, g, b]) in cloud.positions.iter().zip(&cloud.colors) {
        if encoding == "ascii" {
            out.extend(format!("{x} {y} {z} {r} {g} {b}\n").bytes());
            continue;
        }
        for c in [x, y, z] {
            out.extend(if big { c.to_be_bytes() } else { c.to_le_bytes() });
        }
        out.extend([r, g, b]);
    }
    out
}
