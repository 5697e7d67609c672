//! Report files.

use std::path::{Path, PathBuf};

use super::{Report, WorkPrecisionError};

impl Report {
    /// Writes into `folder`: `points.csv`, `report.json`, `table.txt`, `errors.txt`,
    /// `omissions.md`, and a plot for each case, `work_precision.svg` if there is one case and
    /// `work_precision_NAME.svg` otherwise. Returns the paths of the plots without their extension,
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
        let mut plots = Vec::new();
        for case in &self.cases {
            let stem = match self.cases.len() {
                1 => "work_precision".to_owned(),
                _ => format!("work_precision_{}", file_name(&case.name)),
            };
            write(folder.join(format!("{stem}.svg")), case.plot().svg())?;
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
