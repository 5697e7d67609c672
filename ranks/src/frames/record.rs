//! The record of a folder's frames: a file that says what they are, so that a run goes on from its
//! own frames only.
//!
//! Finished frames are removed by a run that begins anew, and by nothing else.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::args::Args;
use crate::disk::{self, WriteError};

/// The file with the description of a folder's frames.
const FILE: &str = "frames.txt";

/// Why a run cannot go on from the frames of a folder, which stay as they are.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RecordError {
    /// The record cannot be read.
    #[error(
        "{}: {source}; it says what the frames beside it are: make it readable, choose another \
         --out, or begin anew without --resume",
        path.display()
    )]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// There are frames, and nothing says what they are.
    #[error(
        "{} is missing, and there are frames beside it: choose another --out, or begin anew without \
         --resume",
        .0.display()
    )]
    Missing(PathBuf),
    /// The frames are those of another run.
    #[error(
        "{}: it has frames of another run, \"{found}\" and not \"{wanted}\": choose another \
         --out, or begin anew without --resume",
        path.display()
    )]
    Other {
        /// The file.
        path: PathBuf,
        /// What made its frames.
        found: String,
        /// What would make these.
        wanted: String,
    },
    /// The record cannot be written, or frames of before cannot be removed.
    #[error(transparent)]
    Write(#[from] WriteError),
}

/// Returns the file whose presence says that a frame is finished.
pub(super) fn light_file(folder: &Path, frame: u32) -> PathBuf {
    folder.join(format!("frame_{frame:04}.pfm"))
}

/// Returns the number of frames that are there, if this run goes on from them; notes what they are.
pub(super) fn frames_so_far(args: &Args, description: &str) -> Result<u32, RecordError> {
    let path = args.out.join(FILE);
    let files = || (0..args.frames).map(|frame| light_file(&args.out, frame));
    if args.resume {
        match fs::read_to_string(&path) {
            Ok(found) if found == description => {
                return Ok(files().take_while(|file| file.exists()).count() as u32);
            }
            Ok(found) => {
                return Err(RecordError::Other { path, found, wanted: description.to_owned() });
            }
            Err(source) if source.kind() != io::ErrorKind::NotFound => {
                return Err(RecordError::Read { path, source });
            }
            Err(_) if files().any(|file| file.exists()) => return Err(RecordError::Missing(path)),
            Err(_) => {}
        }
    }
    // Frames are removed only where there can be a record. It is that of no run until they are gone:
    // nobody takes frames of before for those of this run, should it be cut short here.
    disk::replace(&path, b"")?;
    files().try_for_each(|file| disk::remove(&file))?;
    disk::replace(&path, description.as_bytes())?;
    Ok(0)
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;
    use crate::tests::Folder;

    /// Returns the error of a run in a folder with two frames and a record, which `change` spoils.
    /// Its frames must be there afterwards.
    fn refused(name: &str, resume: bool, change: impl FnOnce(&Path)) -> RecordError {
        let folder = Folder::new(name);
        let args = args(&folder, resume);
        fs::write(folder.0.join(FILE), "points").expect("a folder that can be written");
        let frames = [0, 1].map(|frame| light_file(&folder.0, frame));
        frames.iter().for_each(|file| fs::write(file, "light").expect("as above"));
        change(&folder.0.join(FILE));
        let error = frames_so_far(&args, "points").expect_err("it is spoilt");
        assert!(frames.iter().all(|file| file.exists()), "{error}");
        let text = error.to_string();
        assert!(text.contains(FILE) && text.contains("choose another --out"), "{text}");
        error
    }

    fn args(folder: &Folder, resume: bool) -> Args {
        let mut args = Args::parse_from(["raydsl-ranks", "--frames", "3"]);
        (args.out, args.resume) = (folder.0.clone(), resume);
        args
    }

    /// Puts a folder in a file's place: it can be neither read nor replaced, by nobody.
    fn block(path: &Path) {
        fs::remove_file(path).expect("it is there");
        fs::create_dir(path).expect("a folder that can be written");
    }

    #[test]
    fn frames_stay_where_their_record_cannot_be_used() {
        let read = refused("record-read", true, block);
        assert!(matches!(read, RecordError::Read { .. }), "{read}");
        let text = refused("record-text", true, |path| fs::write(path, [0xff]).expect("a file"));
        assert!(matches!(text, RecordError::Read { .. }), "{text}");
        let gone = refused("record-gone", true, |path| fs::remove_file(path).expect("a file"));
        assert!(matches!(gone, RecordError::Missing(_)), "{gone}");
        let other =
            refused("record-other", true, |path| fs::write(path, "volume").expect("a file"));
        assert!(matches!(other, RecordError::Other { .. }), "{other}");
        let write = refused("record-write", false, block);
        assert!(matches!(write, RecordError::Write(_)), "{write}");
        // Nothing can be written beside it.
        let full = refused("record-full", false, |path| {
            fs::create_dir(path.with_file_name("unfinished-frames.txt")).expect("a folder");
        });
        assert!(matches!(full, RecordError::Write(_)), "{full}");
    }

    #[test]
    fn runs_go_on_or_begin_anew() {
        let folder = Folder::new("record");
        assert_eq!(frames_so_far(&args(&folder, true), "points").expect("nothing is there"), 0);
        for frame in [0, 1] {
            fs::write(light_file(&folder.0, frame), "light").expect("a folder");
        }
        assert_eq!(frames_so_far(&args(&folder, true), "points").expect("its own"), 2);
        assert_eq!(frames_so_far(&args(&folder, false), "volume").expect("anew"), 0);
        assert!(!light_file(&folder.0, 0).exists() && !light_file(&folder.0, 1).exists());
        assert_eq!(fs::read(folder.0.join(FILE)).expect("a record"), b"volume");
    }
}
