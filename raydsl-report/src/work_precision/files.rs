//! Report files.

use std::path::{Path, PathBuf};

use super::{Report, WorkPrecisionError};

/// Pixels for a unit of a plot, which is 1000 units wide.
#[cfg(feature = "png")]
const PNG_SCALE: f32 = 1.6;

impl Report {
    /// Writes into `folder`: `points.csv`, `report.json`, `table.txt`, `errors.txt`,
    /// `omissions.md`, `choice_NAME.txt` for each [family](Self::families), and a plot for each case,
    /// `work_precision.svg` if there is one case and `work_precision_NAME.svg` otherwise; with the
    /// feature `png` a `.png` besides each. Returns the paths of the plots without their extension,
    /// in the order of the cases.
    ///
    /// # Errors
    ///
    /// If a file cannot be written.
    pub fn write(&self, folder: impl AsRef<Path>) -> Result<Vec<PathBuf>, WorkPrecisionError> {
        let folder = folder.as_ref();
        let error = |path: &Path| {
            let path = path.to_owned();
            |source| WorkPrecisionError::File { path, source }
        };
        std::fs::create_dir_all(folder).map_err(error(folder))?;
        let write = |path: PathBuf, text: String| {
            std::fs::write(&path, text).map_err(error(&path)).map(|()| path)
        };
        write(folder.join("points.csv"), self.csv())?;
        write(folder.join("report.json"), format!("{:#}\n", self.json()))?;
        write(folder.join("table.txt"), self.table())?;
        write(folder.join("errors.txt"), self.errors())?;
        write(folder.join("omissions.md"), self.omissions())?;
        for family in self.families() {
            let path = folder.join(format!("choice_{}.txt", file_name(family)));
            write(path, self.choice(family))?;
        }
        let mut plots = Vec::new();
        for case in &self.cases {
            let stem = match self.cases.len() {
                1 => "work_precision".to_owned(),
                _ => format!("work_precision_{}", file_name(&case.name)),
            };
            let plot = case.plot();
            write(folder.join(format!("{stem}.svg")), plot.svg())?;
            #[cfg(feature = "png")]
            {
                let path = folder.join(format!("{stem}.png"));
                let file = plot.png(PNG_SCALE)?;
                std::fs::write(&path, file).map_err(error(&path))?;
            }
            plots.push(folder.join(stem));
        }
        Ok(plots)
    }
}

/// Returns a name of letters, digits, `-` and `_`.
fn file_name(name: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() || c == '-' { c } else { '_' };
    name.chars().map(plain).collect()
}
