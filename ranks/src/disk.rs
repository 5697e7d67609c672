//! Files that are there as a whole or not at all.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Why a file cannot be written.
#[derive(Debug, thiserror::Error)]
#[error("{}: {source}; choose another --out, or make room", path.display())]
pub struct WriteError {
    path: PathBuf,
    source: io::Error,
}

/// Writes a file under another name, then gives it its own: whoever dies in between leaves the file
/// of before.
pub(crate) fn replace(path: &Path, bytes: &[u8]) -> Result<(), WriteError> {
    replace_by(path, |unfinished| {
        let mut file = File::create(unfinished)?;
        file.write_all(bytes)?;
        // On the disk before the name is: else a crash of the machine might leave an empty file.
        file.sync_all()
    })
}

/// Like [`replace`], with the file that `write` writes.
pub(crate) fn replace_by(
    path: &Path,
    write: impl FnOnce(&Path) -> io::Result<()>,
) -> Result<(), WriteError> {
    let mut unfinished = path.as_os_str().to_owned();
    unfinished.push(".unfinished");
    let unfinished = PathBuf::from(unfinished);
    let written = write(&unfinished).and_then(|()| fs::rename(&unfinished, path));
    written.map_err(|source| WriteError { path: path.to_owned(), source })
}

/// Creates the folder of the pictures.
pub(crate) fn create_folder(path: &Path) -> Result<(), WriteError> {
    fs::create_dir_all(path).map_err(|source| WriteError { path: path.to_owned(), source })
}
