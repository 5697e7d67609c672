//! Finished pictures.

use std::fmt::Display;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

use raydsl::integrators::heat_color;
use raydsl::prelude::*;
use raydsl::render::Display as Shown;
use rayon::prelude::*;

/// How two variants differ.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Difference {
    /// The greatest difference of a channel of a pixel.
    pub most: f32,
    /// The number of pixels that differ.
    pub pixels: usize,
}

/// A picture with what is known of how it was made.
#[derive(Clone, Debug)]
pub struct Frame {
    /// The number of the change that it shows; see [`Session::number`](crate::Session::number).
    pub number: u64,
    /// Columns and rows of `rgba`.
    pub size: (u32, u32),
    /// Whether it has fewer pixels than are wanted, because the camera moves.
    pub is_coarse: bool,
    /// Samples of each pixel.
    pub samples: u32,
    /// Red, green, blue and alpha of each pixel in sRGB, from the top.
    pub rgba: Vec<u8>,
    /// The picture on the window's device, in place of `rgba`, which is empty then.
    pub texture: Option<wgpu::Texture>,
    /// Milliseconds of the last pass, all pixels once.
    pub ms: f64,
    /// Milliseconds since the change that it shows was seen by the renderer.
    pub age_ms: f64,
    /// The root mean square of the standard errors of all pixels; nothing of one sample.
    pub error: Option<f32>,
    /// How two variants differ, if that is shown.
    pub difference: Option<Difference>,
}

/// Writes pixels of four bytes, from the top, as PNG.
pub(crate) fn write_png(path: &Path, rgba: &[u8], size: (u32, u32)) -> Result<(), String> {
    let color = image::ExtendedColorType::Rgba8;
    let format = image::ImageFormat::Png;
    save(path, |part| image::save_buffer_with_format(part, rgba, size.0, size.1, color, format))
}

/// Writes a file under another name first, so that it is whole or not there, and makes its folder.
pub(crate) fn save<E: Display>(
    path: &Path,
    write: impl FnOnce(&Path) -> Result<(), E>,
) -> Result<(), String> {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let fail = |e: String| format!("cannot write {}: {e}; choose another place", path.display());
    let folder = path.parent().unwrap_or(Path::new(""));
    std::fs::create_dir_all(folder).map_err(|e| fail(e.to_string()))?;
    let count = COUNT.fetch_add(1, Ordering::Relaxed);
    let part = folder.join(format!(".{}-{count}.part", std::process::id()));
    let end = write(&part).map_err(|e| e.to_string());
    let end = end.and_then(|()| std::fs::rename(&part, path).map_err(|e| e.to_string()));
    if end.is_err() {
        // It may not be there at all.
        let _ = std::fs::remove_file(&part);
    }
    end.map_err(fail)
}

/// Returns the bytes of a picture, from the top.
pub(crate) fn shown(light: &Image<Vec4>, exposure: f32) -> Vec<u8> {
    let display = Shown::new().exposure(exposure);
    bytes(light, |pixel| display.color(*pixel))
}

/// Puts a picture of linear colours times their alpha over the bytes of another one of that size, which
/// begin at the top.
pub(crate) fn over(front: &Image<Vec4>, rgba: &mut [u8]) {
    let pixels = front.rows().rev().flatten().zip(rgba.chunks_exact_mut(4));
    for (front, bytes) in pixels.filter(|(front, _)| front.w > 0.0) {
        let alpha = front.w.min(1.0);
        for (channel, byte) in bytes[..3].iter_mut().enumerate() {
            let shown = linear_to_srgb((front[channel] / front.w).clamp(0.0, 1.0)) * 255.0;
            *byte = (shown * alpha + f32::from(*byte) * (1.0 - alpha) + 0.5) as u8;
        }
    }
}

fn bytes<P: raydsl::Type + Sync>(image: &Image<P>, color: impl Fn(&P) -> Vec4 + Sync) -> Vec<u8> {
    let (width, height) = (image.width() as usize, image.height() as usize);
    let mut rgba = vec![0; 4 * width * height];
    let rows = rgba.par_chunks_mut((4 * width).max(1)).zip(image.pixels().par_chunks(width).rev());
    rows.for_each(|(bytes, pixels)| {
        for (bytes, pixel) in bytes.chunks_exact_mut(4).zip(pixels) {
            let color = color(pixel).clamp(Vec4::ZERO, Vec4::ONE) * 255.0 + 0.5;
            bytes.copy_from_slice(&color.to_array().map(|c| c as u8));
        }
    });
    rgba
}

/// Returns a heat map of where two pictures differ: black where they do not, dark blue at a
/// millionth and red at a whole.
pub(crate) fn difference(a: &Image<Vec4>, b: &Image<Vec4>) -> (Vec<u8>, Difference) {
    let apart: Vec<f32> = a.pixels().iter().zip(b.pixels()).map(|(a, b)| apart(*a, *b)).collect();
    let (width, height) = (a.width(), a.height());
    let index = |x: u32, y: u32| y as usize * width as usize + x as usize;
    let image = Image::from_fn(width, height, |x, y| apart[index(x, y)]);
    let rgba = bytes(&image, |d| {
        if *d == 0.0 {
            return Vec4::W;
        }
        let heat = heat_color((d.log10() / 6.0 + 1.0).clamp(0.05, 1.0));
        Vec3::from_array(heat.to_array().map(linear_to_srgb)).extend(1.0)
    });
    let most = apart.iter().copied().fold(0.0, f32::max);
    (rgba, Difference { most, pixels: apart.iter().filter(|d| **d > 0.0).count() })
}

/// The greatest difference of a channel; two NaN are equal, and one is infinitely far from a
/// number.
fn apart(a: Vec4, b: Vec4) -> f32 {
    let channel = |a: f32, b: f32| {
        if a == b || (a.is_nan() && b.is_nan()) {
            return 0.0;
        }
        let d = (a - b).abs();
        if d.is_nan() { f32::INFINITY } else { d }
    };
    (0..4).map(|i| channel(a[i], b[i])).fold(0.0, f32::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_begin_at_the_top() {
        let light = Image::from_fn(2, 2, |x, y| vec4(x as f32, y as f32, 0.0, 1.0));
        let rgba = shown(&light, 0.0);
        assert_eq!(rgba[..8], [0, 255, 0, 255, 255, 255, 0, 255]);
        assert_eq!(rgba[8..], [0, 0, 0, 255, 255, 0, 0, 255]);
    }

    #[test]
    fn differences_are_found() {
        let a = Image::filled(3, 1, Vec4::ONE);
        let mut b = a.clone();
        assert_eq!(difference(&a, &b).1, Difference::default());
        b.pixels_mut()[1].y = 1.5;
        let (rgba, found) = difference(&a, &b);
        assert_eq!(found, Difference { most: 0.5, pixels: 1 });
        assert_eq!(rgba[..4], [0, 0, 0, 255]);
        assert!(rgba[4] > 100);
        b.pixels_mut()[1].y = f32::NAN;
        assert_eq!(difference(&a, &b).1.most, f32::INFINITY);
    }
}
