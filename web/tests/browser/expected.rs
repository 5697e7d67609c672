//! What a page shows, and what it should.

use raydsl::prelude::*;
use raydsl::render::Display;
use raydsl_web::server::Report;
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
    pub(crate) fn of(report: &Report) -> Self {
        let bytes = |part: &str| report.get(part).cloned().unwrap_or_default();
        let text = |part: &str| String::from_utf8_lossy(&bytes(part)).into_owned();
        let number = |bytes: &[u8]| f32::from_le_bytes(bytes.try_into().expect("four bytes"));
        Self {
            status: text("status"),
            error: text("error"),
            light: bytes("light").chunks_exact(4).map(number).collect(),
            shown: bytes("shown"),
        }
    }
}

/// The picture of the scalar variant on this machine, with the passes of the page.
pub(crate) struct Expected {
    pub(crate) light: Vec<f32>,
    pub(crate) shown: Vec<u8>,
}

impl Expected {
    pub(crate) fn of(request: &Request) -> Self {
        let (width, height) = request.size;
        let made = request.subject.with_kernel(async |kernel, pose| {
            let mut film = Film::new(width, height);
            let scheduler = TiledScheduler::new().variant(Variant::Scalar);
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
