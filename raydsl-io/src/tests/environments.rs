use std::io::Cursor;

use glam::Vec3;
use image::{ImageEncoder, Rgb, Rgb32FImage};

use super::scenes::real;
use super::*;
use crate::environment::{self, Environment};

pub(super) fn load_environment(extension: &str, bytes: &[u8]) -> Result<Environment, LoadError> {
    environment::load(&Temp::new(extension, bytes).0)
}

/// Checks what the documentation promises, of an environment or of an error.
pub(super) fn check_environment(found: &Result<Environment, LoadError>, what: &str) {
    match found {
        Ok(sky) => {
            assert_eq!(sky.texels.len() as u32, sky.width * sky.height, "{what}");
            let is_light = |c: &Vec3| c.is_finite() && c.min_element() >= 0.0;
            assert!(sky.texels.iter().all(is_light), "{what}");
        }
        Err(e) => {
            let text = e.to_string();
            assert!(!text.contains('\n') && text.contains(';'), "{what}: {text}");
        }
    }
}

/// A picture of 16 x 8 texels, with one of them changed.
fn sky(change: Option<f32>) -> Rgb32FImage {
    let mut sky = Rgb32FImage::from_fn(16, 8, |x, y| Rgb([x as f32, y as f32, 0.5]));
    if let Some(value) = change {
        sky.put_pixel(3, 2, Rgb([1.0, value, 1.0]));
    }
    sky
}

fn exr_of<T: exr::prelude::IntoSample>(
    encoding: exr::image::Encoding,
    channel: impl Fn(f32) -> T + Sync,
    sky: &Rgb32FImage,
) -> Vec<u8> {
    use exr::prelude::*;
    let pixels = |at: Vec2<usize>| {
        let [red, green, blue] = sky.get_pixel(at.0 as u32, at.1 as u32).0;
        (channel(red), channel(green), channel(blue))
    };
    let name = LayerAttributes::named("sky");
    let layer = Layer::new((16, 8), name, encoding, SpecificChannels::rgb(pixels));
    let mut out = Cursor::new(Vec::new());
    Image::from_layer(layer).write().non_parallel().to_buffered(&mut out).expect("a picture");
    out.into_inner()
}

pub(super) fn exr(change: Option<f32>) -> Vec<u8> {
    exr_of(exr::image::Encoding::UNCOMPRESSED, |x| x, &sky(change))
}

/// Compressed, in blocks of lines and in tiles, and in floats of 16 bits.
pub(super) fn exrs() -> Vec<Vec<u8>> {
    use exr::prelude::{Blocks, Compression, Encoding, LineOrder, f16};
    let (zip, piz) = (Compression::ZIP16, Compression::PIZ);
    let encodings = [
        Encoding { compression: Compression::RLE, ..Encoding::UNCOMPRESSED },
        Encoding { compression: zip, blocks: Blocks::ScanLines, line_order: LineOrder::Decreasing },
        Encoding { compression: piz, ..Encoding::SMALL_LOSSLESS },
        Encoding { compression: Compression::PXR24, ..Encoding::FAST_LOSSLESS },
    ];
    encodings.map(|encoding| exr_of(encoding, f16::from_f32, &sky(None))).to_vec()
}

pub(super) fn hdr() -> Vec<u8> {
    let (mut out, sky) = (Vec::new(), sky(None));
    let bytes: Vec<u8> = sky.as_raw().iter().flat_map(|x| x.to_ne_bytes()).collect();
    image::codecs::hdr::HdrEncoder::new(&mut out)
        .write_image(&bytes, 16, 8, image::ExtendedColorType::Rgb32F)
        .expect("a picture");
    out
}

#[test]
fn rows_begin_at_the_top() {
    let exrs = exrs().into_iter().map(|bytes| ("exr", bytes));
    for (extension, bytes) in exrs.chain([("hdr", hdr()), ("EXR", exr(None))]) {
        let sky = load_environment(extension, &bytes).expect("an environment");
        assert_eq!((sky.width, sky.height), (16, 8));
        for (i, texel) in sky.texels.iter().enumerate() {
            let expected = Vec3::new((i % 16) as f32, (i / 16) as f32, 0.5);
            assert!(texel.abs_diff_eq(expected, 0.1), "{extension}: {texel} {expected}");
        }
    }
}

#[test]
fn texels_are_light() {
    for (value, text) in [(f32::NAN, "NaN"), (f32::INFINITY, "inf"), (-1.0, "-1")] {
        let found = load_environment("exr", &exr(Some(value)));
        check_environment(&found, text);
        let error = found.expect_err("an error").to_string();
        assert!(error.contains("row 2 and column 3") && error.contains(text), "{error}");
    }
}

/// A layer that is not as large as the picture would be light from elsewhere.
#[test]
fn crops_are_refused() {
    use exr::prelude::*;
    let channels = SpecificChannels::rgb(|_: Vec2<usize>| (1.0f32, 1.0f32, 1.0f32));
    let layer = Layer::new((8, 8), LayerAttributes::default(), Encoding::UNCOMPRESSED, channels);
    let mut picture = Image::from_layer(layer);
    picture.attributes.display_window = IntegerBounds::from_dimensions((16, 8));
    let mut out = Cursor::new(Vec::new());
    picture.write().non_parallel().to_buffered(&mut out).expect("a picture");
    let found = load_environment("exr", &out.into_inner());
    check_environment(&found, "a crop");
    assert!(found.expect_err("an error").to_string().contains("its data window"));
}

#[test]
fn claims_of_environments_are_not_trusted() {
    let header = |size: &str| format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n{size}\n\0\0");
    for (size, what) in [
        ("-Y 32768 +X 32768", "texels"),
        ("-Y 40000 +X 2", "at most"),
        ("-Y 1000 +X 1000", "claim 1000 x 1000 texels"),
        ("-Y 8 +X 16", "cut off"),
        ("-Y 0 +X 16", "claim"),
        ("-Y 8", "is no valid HDR"),
    ] {
        let found = load_environment("hdr", header(size).as_bytes());
        check_environment(&found, size);
        let error = found.expect_err(size).to_string();
        assert!(error.contains(what), "{size}: {error}");
    }
    let encoding = exr::image::Encoding {
        compression: exr::compression::Compression::B44,
        ..exr::image::Encoding::FAST_LOSSLESS
    };
    let bytes = exr_of(encoding, exr::prelude::f16::from_f32, &sky(None));
    let error = load_environment("exr", &bytes).expect_err("an error").to_string();
    assert!(error.contains("compression") && error.contains("ZIP"), "{error}");
    assert!(matches!(environment::load("a.png"), Err(LoadError::UnknownExtension { .. })));
    assert_modest();
}

#[test]
fn cut_and_damaged_environments_are_errors() {
    let exrs = exrs().into_iter().map(|bytes| ("exr", bytes));
    for (extension, whole) in exrs.chain([("hdr", hdr()), ("exr", exr(None))]) {
        for at in 0..whole.len() {
            check_environment(&load_environment(extension, &whole[..at]), &format!("cut at {at}"));
            for flip in [0x01, 0x10, 0x80, 0xff] {
                let mut bytes = whole.clone();
                bytes[at] ^= flip;
                let what = format!("{extension}: {flip} at {at}");
                check_environment(&load_environment(extension, &bytes), &what);
            }
        }
    }
    assert_modest();
}

#[test]
fn a_real_environment_loads() {
    let Some(path) = real("a_real_environment_loads", "chinese_garden_1k.hdr") else { return };
    let found = environment::load(&path);
    check_environment(&found, "chinese_garden_1k.hdr");
    let sky = found.expect("an environment");
    assert_eq!((sky.width, sky.height), (1024, 512));
    let whole = std::fs::read(&path).expect("a file");
    for i in 1..20 {
        let cut = load_environment("hdr", &whole[..whole.len() / 20 * i]);
        assert!(matches!(cut, Err(LoadError::Truncated { .. })), "{cut:?}");
        let mut bytes = whole.clone();
        bytes[whole.len() / 20 * i] ^= 0x55;
        check_environment(&load_environment("hdr", &bytes), &format!("variant {i}"));
    }
    // The sky is brighter than the ground.
    let mean = |rows: &[Vec3]| rows.iter().map(|c| c.y).sum::<f32>() / rows.len() as f32;
    let (top, bottom) = sky.texels.split_at(sky.texels.len() / 2);
    assert!(mean(top) > mean(bottom), "{} {}", mean(top), mean(bottom));
}
