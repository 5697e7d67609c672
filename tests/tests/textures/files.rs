//! Textures from picture files, good ones and bad ones.

use std::io::Cursor;

use image::{DynamicImage, ImageFormat, Rgb32FImage, RgbImage, RgbaImage};
use raydsl::prelude::*;
use raydsl::texture::{ColorSpace, Filter, LoadError};
use raydsl_tests::rng::Rng;
use raydsl_tests::scaled;

fn written(picture: &DynamicImage, format: ImageFormat) -> Result<Vec<u8>, image::ImageError> {
    let mut bytes = Cursor::new(Vec::new());
    picture.write_to(&mut bytes, format)?;
    Ok(bytes.into_inner())
}

fn small() -> DynamicImage {
    RgbaImage::from_fn(3, 2, |x, y| image::Rgba([x as u8 * 100, y as u8 * 200, 7, 255])).into()
}

fn bright() -> DynamicImage {
    Rgb32FImage::from_fn(4, 3, |x, y| image::Rgb([x as f32, 0.25, y as f32 * 16.0])).into()
}

const NEAREST: fn() -> TextureConfig = || TextureConfig::new().filter(Filter::Nearest);

#[test]
fn png_is_srgb() -> Result<(), Box<dyn std::error::Error>> {
    let bytes = written(&small(), ImageFormat::Png)?;
    let texture = Texture2::<[Unorm8; 4]>::from_picture(&bytes, NEAREST())?;
    assert_eq!(texture.size(), [3, 2]);
    assert_eq!(texture.config().color_space, ColorSpace::Srgb);
    assert_eq!(texture.texels()[5].map(|c| c.to_bits()), [200, 200, 7, 255]);
    let decoded = srgb_to_linear(200.0 / 255.0);
    assert_eq!(tex2(&texture, vec2(0.9, 0.9)).x, decoded);
    let grey = Texture2::<Unorm16>::from_picture(&bytes, NEAREST())?;
    assert_eq!(grey.size(), [3, 2]);
    let wide = Texture2::<Vec3>::from_picture(&bytes, NEAREST())?;
    assert_eq!(wide.config().color_space, ColorSpace::Srgb);
    assert!((tex2(&wide, vec2(0.9, 0.9)).x - decoded).abs() < 1e-6);
    Ok(())
}

/// The numbers of a normal map are no colours, and those of a picture of floats may be.
#[test]
fn a_colour_space_that_is_said() -> Result<(), Box<dyn std::error::Error>> {
    let bytes = written(&small(), ImageFormat::Png)?;
    let plain = ColorSpace::Linear;
    let texture = Texture2::<[Unorm8; 4]>::from_picture_as(&bytes, plain, NEAREST())?;
    assert_eq!(tex2(&texture, vec2(0.9, 0.9)).x, 200.0 / 255.0);
    let bytes = written(&bright(), ImageFormat::OpenExr)?;
    let texture = Texture2::<Vec3>::from_picture_as(&bytes, ColorSpace::Srgb, NEAREST())?;
    assert_eq!(tex2(&texture, vec2(0.9, 0.9)).y, srgb_to_linear(0.25));
    let missing = Texture2::<Unorm8>::load_as("no/such/picture.png", plain, NEAREST());
    assert!(matches!(missing, Err(LoadError::Unreadable { .. })));
    Ok(())
}

/// Halves are the floats of the same picture, rounded.
#[test]
fn halves_of_every_format() -> Result<(), Box<dyn std::error::Error>> {
    let formats = [
        (small(), ImageFormat::Png),
        (bright(), ImageFormat::OpenExr),
        (bright(), ImageFormat::Hdr),
    ];
    for (picture, format) in formats {
        let bytes = written(&picture, format)?;
        macro_rules! same {
            ($half:ty, $float:ty) => {
                let half = Texture2::<$half>::from_picture(&bytes, NEAREST())?;
                let float = Texture2::<$float>::from_picture(&bytes, NEAREST())?;
                assert_eq!(half.config(), float.config());
                let floats = float.texels().iter().flat_map(|t| t.map(F16::new));
                let halves = half.texels().iter().flatten().copied();
                assert!(halves.eq(floats), "{format:?}");
            };
        }
        same!([F16; 1], [f32; 1]);
        same!([F16; 2], [f32; 2]);
        same!([F16; 3], [f32; 3]);
        same!([F16; 4], [f32; 4]);
        let grey = Texture2::<F16>::from_picture(&bytes, NEAREST())?;
        let greys = Texture2::<[F16; 1]>::from_picture(&bytes, NEAREST())?;
        assert_eq!(grey.texels(), greys.texels().as_flattened());
    }
    // Beyond what a half holds.
    let beyond = Rgb32FImage::from_pixel(1, 1, image::Rgb([1e6; 3]));
    let bytes = written(&beyond.into(), ImageFormat::OpenExr)?;
    let texture = Texture2::<[F16; 3]>::from_picture(&bytes, NEAREST())?;
    assert_eq!(texture.texels()[0][0].to_f32(), f32::INFINITY);
    Ok(())
}

/// Large pictures and long rows are converted in pieces, which no texel shows.
#[test]
fn pieces_of_large_pictures() -> Result<(), Box<dyn std::error::Error>> {
    for [width, height] in [[300, 301], [70_000, 2], [1, 70_000], [65_537, 1]] {
        let mut rng = Rng::new(31);
        let color = |_, _| image::Rgb([(); 3].map(|()| rng.bits() as u8));
        let picture = DynamicImage::from(RgbImage::from_fn(width, height, color));
        let bytes = written(&picture, ImageFormat::Png)?;
        let grey = Texture2::<Unorm16>::from_picture(&bytes, NEAREST())?;
        let expected = picture.to_luma16().into_raw();
        assert!(grey.texels().iter().map(|t| t.to_bits()).eq(expected), "{width} {height}");
        let wide = Texture2::<Vec4>::from_picture(&bytes, NEAREST())?;
        let expected = picture.to_rgba32f().into_raw();
        assert!(wide.texels().iter().flat_map(|t| t.to_array()).eq(expected), "{width} {height}");
    }
    Ok(())
}

/// A picture that can be decoded, but not held together with the texels it is converted to.
#[test]
fn a_picture_and_its_texels_have_one_limit() -> Result<(), Box<dyn std::error::Error>> {
    let side = 8000;
    let grey: DynamicImage = image::GrayImage::new(side, side).into();
    let bytes = written(&grey, ImageFormat::Png)?;
    let found = Texture2::<Vec4>::from_picture(&bytes, NEAREST());
    let taken = 17 * u64::from(side) * u64::from(side);
    assert!(matches!(found, Err(LoadError::TooLarge { bytes, .. }) if bytes == taken));
    Ok(())
}

#[test]
fn floats_stay_floats() -> Result<(), Box<dyn std::error::Error>> {
    for format in [ImageFormat::OpenExr, ImageFormat::Hdr] {
        let bytes = written(&bright(), format)?;
        let texture = Texture2::<Vec3>::from_picture(&bytes, NEAREST())?;
        assert_eq!(texture.config().color_space, ColorSpace::Linear);
        assert_eq!(tex2(&texture, vec2(0.9, 0.9)), vec3(3.0, 0.25, 32.0), "{format:?}");
        assert_eq!(Texture2::<Vec4>::from_picture(&bytes, NEAREST())?.texels()[0].w, 1.0);
        let small = Texture2::<[Unorm8; 3]>::from_picture(&bytes, NEAREST());
        assert!(matches!(small, Err(LoadError::Floats)), "{format:?}");
    }
    Ok(())
}

#[test]
fn jpeg() -> Result<(), Box<dyn std::error::Error>> {
    let grey: DynamicImage = RgbImage::from_pixel(16, 8, image::Rgb([128; 3])).into();
    let bytes = written(&grey, ImageFormat::Jpeg)?;
    let texture = Texture2::<[Unorm8; 3]>::from_picture(&bytes, NEAREST())?;
    assert_eq!(texture.size(), [16, 8]);
    assert!(texture.texels()[0].iter().all(|c| c.to_bits().abs_diff(128) <= 2));
    Ok(())
}

#[test]
fn a_path_that_is_not_there_is_named() {
    let found = Texture2::<Unorm8>::load("no/such/picture.png", NEAREST());
    assert!(matches!(&found, Err(LoadError::Unreadable { .. })));
    assert!(found.is_err_and(|e| e.to_string().contains("no/such/picture.png")));
}

/// Cut off anywhere, with bytes changed, or no picture at all: an error or a texture, no panic.
#[test]
fn broken_files() -> Result<(), Box<dyn std::error::Error>> {
    let read = |bytes: &[u8]| Texture2::<Vec3>::from_picture(bytes, NEAREST());
    let mut rng = Rng::new(30);
    let pictures = [
        (small(), ImageFormat::Png),
        (bright(), ImageFormat::Hdr),
        (bright(), ImageFormat::OpenExr),
        (RgbImage::new(9, 9).into(), ImageFormat::Jpeg),
    ];
    for (picture, format) in pictures {
        let whole = written(&picture, format)?;
        assert!(read(&whole).is_ok(), "{format:?}");
        for len in (0..whole.len()).step_by(whole.len() / 100 + 1) {
            let _ = read(&whole[..len]);
        }
        assert!(read(&whole[..whole.len() / 4]).is_err(), "{format:?}");
        for _ in 0..scaled(2000) {
            let mut bytes = whole.clone();
            for _ in 0..1 + rng.below(4) {
                let i = rng.below(bytes.len());
                bytes[i] = rng.bits() as u8;
            }
            let _ = read(&bytes);
        }
    }
    for garbage in [&b""[..], b"\x89PNG", b"hello", &[0xff; 100]] {
        assert!(matches!(read(garbage), Err(LoadError::Undecodable { .. })));
    }
    Ok(())
}

/// A header that promises terabytes is refused before they are asked for.
#[test]
fn a_header_cannot_ask_for_the_memory() {
    let mut png = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR".to_vec();
    png.extend(1_000_000_u32.to_be_bytes());
    png.extend(1_000_000_u32.to_be_bytes());
    png.extend([8, 6, 0, 0, 0]);
    png.extend(crc(&png[12..]).to_be_bytes());
    png.extend(*b"\0\0\0\0IEND\xaeB\x60\x82");
    let hdr = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1000000 +X 1000000\n".to_vec();
    for bytes in [png, hdr] {
        let found = Texture2::<Vec3>::from_picture(&bytes, NEAREST());
        assert!(matches!(found, Err(LoadError::Undecodable { .. })), "{found:?}");
    }
}

/// The checksum of a PNG's chunk.
fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |c, _| (c >> 1) ^ (0xedb8_8320 * (c & 1)))
    })
}
