//! Which loader reads a file.

use std::path::Path;

use crate::LoadError;

/// A format of files.
pub(crate) struct Format<R> {
    /// What the names of its files end in.
    pub(crate) extension: &'static str,
    /// What errors call it.
    pub(crate) name: &'static str,
    /// The feature of this crate that it needs.
    pub(crate) feature: &'static str,
    /// Its loader, unless the feature is off.
    pub(crate) read: Option<R>,
}

/// A loader, if its feature is on.
macro_rules! loader {
    ($feature:tt, $read:path) => {{
        #[cfg(feature = $feature)]
        {
            Some($read)
        }
        #[cfg(not(feature = $feature))]
        {
            None
        }
    }};
}
pub(crate) use loader;

/// The format of a file, and its loader.
pub(crate) fn of<'a, R: Copy>(
    path: &Path,
    formats: &'a [Format<R>],
) -> Result<(&'a Format<R>, R), LoadError> {
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    // An extension of two words, as in `.nii.gz`.
    let ends = |f: &Format<R>| f.extension.contains('.') && name.ends_with(f.extension);
    let Some(format) = formats.iter().find(|f| f.extension == extension || ends(f)) else {
        let known: Vec<String> = formats.iter().map(|f| format!(".{}", f.extension)).collect();
        let known = known.join(", ");
        return Err(LoadError::UnknownExtension { path: path.into(), extension, known });
    };
    match format.read {
        Some(read) => Ok((format, read)),
        None => Err(LoadError::FeatureOff { path: path.into(), feature: format.feature }),
    }
}
