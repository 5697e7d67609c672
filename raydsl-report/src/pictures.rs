//! Picture files of a comparison.

use std::path::Path;

use super::Comparison;
use raydsl::render::{Image, Shaded};

/// The error of writing files.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// The folder cannot be created, or a file cannot be written.
    #[error("cannot write {path}: {source}; choose another folder")]
    File {
        /// The file.
        path: String,
        /// The cause.
        source: image::ImageError,
    },
}

impl Comparison<Shaded> {
    /// Writes into `folder`: a picture for each variant that ran, a difference picture for each but
    /// the scalar one, and `table.txt`.
    ///
    /// # Errors
    ///
    /// If a file cannot be written.
    pub fn write(&self, folder: impl AsRef<Path>) -> Result<(), WriteError> {
        let folder = folder.as_ref();
        let at = |name: &str| folder.join(name);
        let check = |path: &Path, result: Result<(), image::ImageError>| {
            result.map_err(|source| WriteError::File { path: path.display().to_string(), source })
        };
        check(folder, std::fs::create_dir_all(folder).map_err(Into::into))?;
        for row in self.rows.iter().filter(|r| r.unavailable.is_none()) {
            let name = row.variant.name();
            let path = at(&format!("{name}.png"));
            check(&path, row.image.write_png(&path))?;
            if name != self.scalar().variant.name() {
                let path = at(&format!("difference_{name}.png"));
                check(&path, difference(&self.scalar().image, &row.image).write_png(&path))?;
            }
        }
        let path = at("table.txt");
        check(&path, std::fs::write(&path, self.table()).map_err(Into::into))
    }
}

/// Returns the difference of two pictures: the scalar one dimmed, red where an id differs, yellow
/// where only numbers do.
fn difference(expected: &Image, found: &Image) -> Image {
    let mut shown = expected.clone();
    for (out, (a, b)) in
        shown.pixels_mut().iter_mut().zip(expected.pixels().iter().zip(found.pixels()))
    {
        let gray = 0.2 * (a.color.x + a.color.y + a.color.z) / 3.0;
        out.color = if a.id != b.id {
            glam::vec3(1.0, 0.0, 0.0)
        } else if a.color != b.color || a.depth != b.depth {
            glam::vec3(1.0, 0.9, 0.0)
        } else {
            glam::Vec3::splat(gray)
        };
    }
    shown
}
