//! Files that are there as a whole or not at all.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use image::ImageError;
use raydsl::prelude::{Image, Vec4};
use raydsl::render::Display;

/// Why a file cannot be written.
#[derive(Debug, thiserror::Error)]
#[error("{}: {source}; choose another --out, or make room", path.display())]
pub struct WriteError {
    path: PathBuf,
    source: io::Error,
}

impl WriteError {
    fn of(path: &Path) -> impl FnOnce(io::Error) -> Self {
        |source| Self { path: path.to_owned(), source }
    }
}

/// Writes a file under another name, then gives it its own: whoever dies in between leaves the file
/// of before.
pub(crate) fn replace(path: &Path, bytes: &[u8]) -> Result<(), WriteError> {
    replace_by(path, |unfinished| File::create(unfinished)?.write_all(bytes))
}

/// Like [`replace`], with the file that `write` writes.
pub(crate) fn replace_by(
    path: &Path,
    write: impl FnOnce(&Path) -> io::Result<()>,
) -> Result<(), WriteError> {
    let unfinished = unfinished(path);
    let replaced = write(&unfinished)
        // On the disk before it has the name: else a crash of the machine might leave an empty file.
        .and_then(|()| File::options().write(true).open(&unfinished)?.sync_all())
        .and_then(|()| fs::rename(&unfinished, path));
    if replaced.is_err() {
        // It takes room and is of no use. Where there is none, nothing is lost.
        let _ = fs::remove_file(&unfinished);
    }
    replaced.and_then(|()| sync_folder_of(path)).map_err(WriteError::of(path))
}

/// Replaces a picture to look at by that of light.
pub(crate) fn replace_png(path: &Path, light: &Image<Vec4>) -> Result<(), WriteError> {
    let picture = Display::new().show(light);
    replace_by(path, |unfinished| {
        picture.write_png(unfinished).map_err(|e| match e {
            ImageError::IoError(e) => e,
            other => io::Error::other(other),
        })
    })
}

/// Returns the name that a file has before it is whole. It keeps its ending, by which formats of
/// pictures are chosen.
fn unfinished(path: &Path) -> PathBuf {
    let mut name = std::ffi::OsString::from("unfinished-");
    name.push(path.file_name().unwrap_or_default());
    path.with_file_name(name)
}

/// Has names in the folder of a file outlast a crash of the machine, as the files themselves do.
fn sync_folder_of(path: &Path) -> io::Result<()> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    // Other systems do not open folders.
    if cfg!(unix) { File::open(folder.unwrap_or(Path::new(".")))?.sync_all() } else { Ok(()) }
}

/// Removes a file, if there is one.
pub(crate) fn remove(path: &Path) -> Result<(), WriteError> {
    match fs::remove_file(path) {
        Err(e) if e.kind() != io::ErrorKind::NotFound => Err(WriteError::of(path)(e)),
        _ => Ok(()),
    }
}

/// Creates the folder of the pictures.
pub(crate) fn create_folder(path: &Path) -> Result<(), WriteError> {
    fs::create_dir_all(path).map_err(WriteError::of(path))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::Folder;

    #[test]
    fn a_file_that_cannot_be_finished_leaves_the_one_of_before() {
        let folder = Folder::new("replaced");
        let path = folder.0.join("film.parts");
        replace(&path, b"before").expect("a folder that can be written");
        let half = |unfinished: &Path| {
            fs::write(unfinished, b"half of")?;
            Err(io::Error::other("the disk is full"))
        };
        let error = replace_by(&path, half).expect_err("it is not whole");
        assert!(error.to_string().contains("film.parts: the disk is full"), "{error}");
        // It must be on the disk before it has its name: a file that is not there cannot be.
        let missing = replace_by(&path, |_| Ok(())).expect_err("nothing was written");
        assert!(missing.to_string().contains("film.parts"), "{missing}");
        assert_eq!(fs::read(&path).expect("it is there"), b"before");
        assert_eq!(
            fs::read_dir(&folder.0).expect("it is there").count(),
            1,
            "nothing is left over"
        );
        replace(&path, b"behind").expect("a folder that can be written");
        assert_eq!(fs::read(&path).expect("it is there"), b"behind");
    }

    #[test]
    fn names_are_on_the_disk_wherever_the_folder_is() {
        let folder = Folder::new("names");
        sync_folder_of(&folder.0.join("film.parts")).expect("a folder");
        sync_folder_of(Path::new("film.parts")).expect("the one of this process");
        sync_folder_of(&folder.0.join("nowhere/film.parts")).expect_err("no folder");
    }

    #[test]
    fn what_is_not_there_is_removed() {
        let folder = Folder::new("removed");
        remove(&folder.0.join("film.parts")).expect("no file is removed");
        let error = remove(&folder.0).expect_err("a folder is no file");
        assert!(error.to_string().contains("removed"), "{error}");
    }
}
