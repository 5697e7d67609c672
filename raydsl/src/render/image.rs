//! Render targets.

use glam::Vec3;

use crate::Type;
use crate::machine::Type as KernelType;

/// A shaded pixel: colour, depth and id.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct Shaded {
    /// Linear or display-referred colour, 0 to 1.
    pub color: Vec3,
    /// Distance along the ray.
    pub depth: f32,
    /// The id of the visible primitive, or any id of the kernel's choice.
    pub id: u32,
}

/// A grid of pixels; row 0 is the bottom one.
#[derive(Clone, Debug, PartialEq)]
pub struct Image<R = Shaded> {
    width: u32,
    height: u32,
    pixels: Vec<R>,
}

impl<R: KernelType> Image<R> {
    /// Creates an image of `width` by `height` pixels, all `value`.
    pub fn filled(width: u32, height: u32, value: R) -> Self {
        let area = (width as usize).checked_mul(height as usize);
        let area = area.expect("an image has no more pixels than the machine has addresses");
        Self { width, height, pixels: vec![value; area] }
    }

    /// Creates an image of `width` by `height` pixels from `pixel`, called with the column and the
    /// row.
    pub fn from_fn(width: u32, height: u32, mut pixel: impl FnMut(u32, u32) -> R) -> Self {
        let rows = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        Self { width, height, pixels: rows.map(|(x, y)| pixel(x, y)).collect() }
    }

    /// Returns an image of the same size with `pixel` applied to each pixel, for example one
    /// channel of a record.
    pub fn map<S: KernelType>(&self, pixel: impl FnMut(&R) -> S) -> Image<S> {
        let (width, height) = (self.width, self.height);
        Image { width, height, pixels: self.pixels.iter().map(pixel).collect() }
    }

    /// Returns the pixel in a column and a row, if it exists.
    pub fn get(&self, x: u32, y: u32) -> Option<&R> {
        let index = y as usize * self.width as usize + x as usize;
        (x < self.width).then(|| self.pixels.get(index)).flatten()
    }

    /// Returns the rows, from the bottom.
    pub fn rows(&self) -> impl DoubleEndedIterator<Item = &[R]> {
        self.pixels.chunks(self.width.max(1) as usize)
    }

    /// Returns the number of columns.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Returns the number of rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Returns the pixels, row by row from the bottom.
    pub fn pixels(&self) -> &[R] {
        &self.pixels
    }

    /// Returns the pixels, row by row from the bottom.
    pub fn pixels_mut(&mut self) -> &mut [R] {
        &mut self.pixels
    }
}

impl Image<Shaded> {
    /// Creates a black image.
    pub fn new(width: u32, height: u32) -> Self {
        Self::filled(width, height, Shaded::default())
    }

    /// Returns the colours as 8-bit RGB, row by row from the *top*, as in picture files. A NaN
    /// becomes magenta, to be noticed.
    pub fn to_rgb8(&self) -> Vec<u8> {
        let row = |y: u32| {
            let start = y as usize * self.width as usize;
            &self.pixels[start..start + self.width as usize]
        };
        let byte = |v: f32| (v.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
        (0..self.height)
            .rev()
            .flat_map(row)
            .flat_map(
                |p| {
                    if p.color.is_nan() { [255, 0, 255] } else { p.color.to_array().map(byte) }
                },
            )
            .collect()
    }

    /// Writes the colours as a PNG.
    ///
    /// # Errors
    ///
    /// If the file cannot be written.
    #[cfg(feature = "image")]
    pub fn write_png(&self, path: impl AsRef<std::path::Path>) -> Result<(), image::ImageError> {
        let format = image::ExtendedColorType::Rgb8;
        super::files::write_png(path.as_ref(), &self.to_rgb8(), (self.width, self.height), format)
    }
}
