//! From kernels to pictures.

use raydsl::gpu::GpuError;
use raydsl::prelude::*;

/// The picture at an `n`-th of its size: each pixel is the mean of `n` by `n`. What is brighter
/// than white counts as white, or a highlight's edge would have steps.
pub fn reduced(image: &Image, n: u32) -> Image {
    let mut small = Image::new(image.width() / n, image.height() / n);
    let (width, large) = (small.width() as usize, image.width() as usize);
    let n = n as usize;
    for (i, pixel) in small.pixels_mut().iter_mut().enumerate() {
        let first = n * (i / width) * large + n * (i % width);
        let block = (0..n * n).map(|k| image.pixels()[first + k / n * large + k % n]);
        let color: Vec3 = block.clone().map(|p| shown(p.color)).sum();
        *pixel = Shaded { color: color / (n * n) as f32, ..image.pixels()[first] };
    }
    small
}

/// A NaN is left as it is, so that it is not overlooked.
fn shown(color: Vec3) -> Vec3 {
    if color.is_nan() { color } else { color.min(Vec3::ONE) }
}

/// A frame of `width` by `height` pixels with two by two rays each, by one variant.
///
/// # Errors
///
/// WGSL without a device that runs it.
pub fn smooth_frame(
    variant: Variant,
    camera: &Pinhole,
    kernel: &Kernel<'_, (Ray,), Shaded>,
    (width, height): (u32, u32),
) -> Result<Image, GpuError> {
    let mut image = Image::new(2 * width, 2 * height);
    match variant {
        Variant::Wgsl => {
            GpuScheduler::new()?.frame(camera, kernel, &mut image)?;
        }
        cpu => TiledScheduler::new().variant(cpu).frame(camera, kernel, &mut image),
    }
    Ok(reduced(&image, 2))
}

/// Two pictures of the same height, one at the left and one at the right.
///
/// # Panics
///
/// If their heights differ.
pub fn beside(left: &Image, right: &Image) -> Image {
    assert_eq!(left.height(), right.height(), "pictures beside each other have one height");
    let mut both = Image::new(left.width() + right.width(), left.height());
    fn parts(image: &Image) -> impl Iterator<Item = &[Shaded]> {
        image.pixels().chunks(image.width() as usize)
    }
    let rows = both.pixels_mut().chunks_mut((left.width() + right.width()) as usize);
    for ((row, l), r) in rows.zip(parts(left)).zip(parts(right)) {
        row[..l.len()].copy_from_slice(l);
        row[l.len()..].copy_from_slice(r);
    }
    both
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_block_becomes_its_mean() {
        let mut image = Image::new(5, 4);
        for (i, pixel) in image.pixels_mut().iter_mut().enumerate() {
            pixel.color = vec3(i as f32 / 32.0, 4.0 * (i % 2) as f32, 0.0);
        }
        let small = reduced(&image, 2);
        assert_eq!((small.width(), small.height()), (2, 2));
        // Of the second row of blocks the second one: columns 2 and 3, rows 2 and 3.
        let color = small.pixels()[3].color;
        assert_eq!(color, vec3((12 + 13 + 17 + 18) as f32 / 4.0 / 32.0, 0.5, 0.0));
        image.pixels_mut()[0].color.x = f32::NAN;
        assert!(reduced(&image, 2).pixels()[0].color.is_nan());
    }
}
