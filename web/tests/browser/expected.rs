//! What a page shows, and what it should.

use raydsl::prelude::*;
use raydsl::render::Display;
use raydsl_web::{Request, SAMPLING, next_pass};

/// What a page reports.
pub(crate) struct Seen {
    /// The line below the picture.
    pub(crate) status: String,
    /// The error on the page, empty if none is visible.
    pub(crate) error: String,
    /// Light: four numbers a pixel, from the bottom.
    pub(crate) light: Vec<f32>,
    /// The bytes of the canvas, from the top.
    pub(crate) shown: Vec<u8>,
}

impl Seen {
    /// Reads a line of JSON, the light and the bytes of the canvas.
    pub(crate) fn of(report: &[u8]) -> Self {
        let end = report.iter().position(|b| *b == b'\n').expect("a report begins with a line");
        let head: serde_json::Value = serde_json::from_slice(&report[..end]).expect("it is JSON");
        let text = |name: &str| head[name].as_str().expect("a text").to_owned();
        let length = head["light"].as_u64().expect("a number of bytes") as usize;
        let (light, shown) = report[end + 1..].split_at(length);
        let number = |bytes: &[u8]| f32::from_le_bytes(bytes.try_into().expect("four bytes"));
        Self {
            status: text("status"),
            error: text("error"),
            light: light.chunks_exact(4).map(number).collect(),
            shown: shown.to_vec(),
        }
    }
}

/// The picture of the scalar variant on this machine, with the passes of the page or as one frame.
pub(crate) struct Expected {
    pub(crate) light: Vec<f32>,
    pub(crate) shown: Vec<u8>,
}

impl Expected {
    pub(crate) fn of(request: &Request) -> Self {
        let (width, height) = request.size;
        let made = request.subject.with_kernel(async |kernel, pose| {
            let scheduler = TiledScheduler::new().variant(Variant::Scalar);
            if request.is_submitted {
                let mut image = Image::filled(width, height, Vec4::ZERO);
                scheduler.frame(&pose.camera(), kernel, &mut image);
                return image;
            }
            let mut film = Film::new(width, height);
            while film.samples() < request.samples {
                let samples = next_pass(film.samples(), request.samples);
                scheduler.accumulate(&pose.camera(), kernel, &SAMPLING, &mut film, samples);
            }
            film.image()
        });
        let light = pollster::block_on(made).expect("the scene can be made");
        let rows = Display::new().show(&light);
        let rows = rows.pixels().chunks_exact(width as usize).rev();
        let opaque = |[r, g, b, _]: &[Unorm8; 4]| [r.to_bits(), g.to_bits(), b.to_bits(), 255];
        let shown = rows.flatten().flat_map(opaque).collect();
        Self { light: light.pixels().iter().flat_map(|p| p.to_array()).collect(), shown }
    }
}
