//! Several pictures on one sheet.

use std::path::Path;

use image::{ImageResult, Rgb, RgbImage};
use raydsl::prelude::*;

use crate::heat_map::write;

/// Height of the strip with a name.
const STRIP: u32 = 16;

/// Pictures of one size side by side, row by row, each with its name.
#[derive(Clone, Debug)]
pub struct Sheet {
    image: RgbImage,
    size: (u32, u32),
    columns: u32,
}

impl Sheet {
    /// An empty sheet for so many pictures of `size`, `columns` in a row.
    pub fn new(size: (u32, u32), columns: u32, count: u32) -> Self {
        let rows = count.div_ceil(columns.max(1));
        Self { image: RgbImage::new(size.0 * columns, size.1 * rows), size, columns }
    }

    /// Puts the picture number `i`, from 0 on, on the sheet.
    pub fn put(&mut self, i: u32, name: &str, picture: &Image<[Unorm8; 4]>) {
        let (x0, y0) = (i % self.columns * self.size.0, i / self.columns * self.size.1);
        for (k, pixel) in picture.pixels().iter().enumerate() {
            // Pictures begin at the bottom.
            let (x, y) =
                (k as u32 % picture.width(), picture.height() - 1 - k as u32 / picture.width());
            if x < self.size.0 && y < self.size.1 {
                let [r, g, b, _] = pixel.map(Unorm8::to_bits);
                // The name stands on a darker strip.
                let is_strip = !name.is_empty() && y + STRIP >= self.size.1;
                let color = [r, g, b].map(|c| if is_strip { c / 3 } else { c });
                self.image.put_pixel(x0 + x, y0 + y, Rgb(color));
            }
        }
        write(&mut self.image, x0 + 8, y0 + self.size.1.saturating_sub(STRIP - 4), name);
    }

    /// Writes it as a file, whose extension says the format.
    ///
    /// # Errors
    ///
    /// If the file cannot be written.
    pub fn save(&self, path: impl AsRef<Path>) -> ImageResult<()> {
        self.image.save(path)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_stand_side_by_side() {
        let mut sheet = Sheet::new((20, 40), 2, 3);
        let white = [Unorm8::new(1.0); 4];
        sheet.put(2, "", &Image::filled(20, 40, white));
        assert_eq!(sheet.image.dimensions(), (40, 80));
        assert_eq!(sheet.image.get_pixel(0, 40).0, [255; 3]);
        assert_eq!(sheet.image.get_pixel(20, 40).0, [0; 3]);
    }
}
