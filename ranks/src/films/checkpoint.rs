//! The films so far, on disk.
//!
//! A file begins with its format's name and the description of the job, then has each part behind its
//! length, and ends with a checksum of everything before. Numbers are little-endian.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use raydsl::render::{FilmPart, PartError};

use super::Job;
use super::assembly::{AddError, Assembly};
use crate::disk::{self, WriteError};

/// The file's name in the folder of the pictures.
pub const FILE: &str = "film.parts";

const MAGIC: &[u8] = b"raydsl film parts 1\n";

/// Why a run cannot go on from the films so far.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CheckpointError {
    /// The file cannot be read.
    #[error("{}: {source}; make it readable, or choose another --out", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The file is something else, or parts of it are lost.
    #[error("{}: {what}; remove it to begin anew", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        what: String,
    },
    /// The films so far are those of another job.
    #[error(
        "{}: it has films of \"{found}\", not of \"{wanted}\": give the same arguments, or remove it",
        path.display()
    )]
    OtherJob {
        /// The file.
        path: PathBuf,
        /// The description of its job.
        found: String,
        /// That of the job that would go on.
        wanted: String,
    },
    /// There are films so far, and the run would not go on from them.
    #[error(
        "{} has the films of a run that was cut short: go on from them with --resume, or remove it",
        .0.display()
    )]
    Unfinished(PathBuf),
}

/// Writes the parts of a film.
pub(super) fn write(folder: &Path, job: &Job, assembly: &Assembly) -> Result<(), WriteError> {
    let mut bytes = MAGIC.to_vec();
    append(&mut bytes, job.description.as_bytes());
    for part in assembly.parts() {
        append(&mut bytes, &part.to_bytes());
    }
    bytes.extend(checksum(&bytes).to_le_bytes());
    disk::replace(&folder.join(FILE), &bytes)
}

/// Reads the parts of a film into an assembly; there are none if there is no file.
pub(super) fn read(
    folder: &Path,
    job: &Job,
    assembly: &mut Assembly,
) -> Result<(), CheckpointError> {
    let path = folder.join(FILE);
    let bytes = match fs::read(&path) {
        Ok(bytes) => bytes,
        Err(e) if e.kind() == io::ErrorKind::NotFound => return Ok(()),
        Err(source) => return Err(CheckpointError::Read { path, source }),
    };
    let (found, parts) = match content(&bytes) {
        Ok(content) => content,
        Err(what) => return Err(CheckpointError::Damaged { path, what }),
    };
    if found != job.description {
        let wanted = job.description.clone();
        return Err(CheckpointError::OtherJob { path, found, wanted });
    }
    for part in parts {
        let added = part.map_err(AddError::Part).and_then(|part| assembly.add(part));
        if let Err(e) = added {
            return Err(CheckpointError::Damaged { path, what: e.to_string() });
        }
    }
    Ok(())
}

/// Returns an error if there are films so far, which a run would write over.
pub(super) fn refuse(folder: &Path) -> Result<(), CheckpointError> {
    let path = folder.join(FILE);
    match path.try_exists() {
        Ok(false) => Ok(()),
        Ok(true) => Err(CheckpointError::Unfinished(path)),
        Err(source) => Err(CheckpointError::Read { path, source }),
    }
}

/// Removes the films so far: the film is whole.
pub(super) fn remove(folder: &Path) -> Result<(), WriteError> {
    disk::remove(&folder.join(FILE))
}

/// Appends bytes behind their number.
fn append(bytes: &mut Vec<u8>, more: &[u8]) {
    bytes.extend((more.len() as u64).to_le_bytes());
    bytes.extend(more);
}

type Parts<'a> = Vec<Result<FilmPart, PartError>>;

/// Returns the description of the job, and the parts.
fn content(bytes: &[u8]) -> Result<(String, Parts<'_>), String> {
    let Some(rest) = bytes.strip_prefix(MAGIC) else {
        return Err("this is no file with parts of films".to_owned());
    };
    let Some((_, sum)) = bytes.split_last_chunk::<8>().filter(|_| rest.len() >= 8) else {
        return Err("it ends early".to_owned());
    };
    if checksum(&bytes[..bytes.len() - 8]) != u64::from_le_bytes(*sum) {
        return Err("it ends early, or bytes of it have changed".to_owned());
    }
    let mut rest = &rest[..rest.len() - 8];
    let mut pieces = Vec::new();
    while !rest.is_empty() {
        let piece = rest.split_first_chunk::<8>().and_then(|(length, rest)| {
            rest.split_at_checked(usize::try_from(u64::from_le_bytes(*length)).ok()?)
        });
        let Some((piece, others)) = piece else {
            return Err("a part is longer than the file".to_owned());
        };
        pieces.push(piece);
        rest = others;
    }
    let (first, parts) = pieces.split_first().ok_or("it has no description")?;
    let parts = parts.iter().map(|bytes| FilmPart::from_bytes(bytes)).collect();
    Ok((String::from_utf8_lossy(first).into_owned(), parts))
}

/// Returns the hash of bytes. (Fowler, Noll and Vo, FNV-1a of 64 bits.)
fn checksum(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

#[cfg(test)]
mod tests {
    use std::ops::Range;

    use glam::uvec2;
    use raydsl::prelude::*;
    use raydsl::render::FilmExtent;

    use super::*;
    use crate::tests::Folder;

    fn job() -> Job {
        let description = "noise 20x5, 100 samples".to_owned();
        Job { film: uvec2(20, 5), samples: 100, tile: 16, blocks: 1, description }
    }

    fn part(job: &Job, x: u32, width: u32, samples: Range<u32>) -> FilmPart {
        let camera = Pinhole::new(vec3(0.0, 0.0, 5.0), Vec3::ZERO, Vec3::Y, 1.0);
        let slope = kernel!(|ray: Ray| ray.direction.y);
        let extent = FilmExtent::new(job.film, uvec2(x, 0), uvec2(width, 5), samples);
        let (scheduler, sampling) = (TiledScheduler::new(), Sampling::new(job.samples));
        scheduler.render_part(&camera, &slope, &sampling, &extent.expect("of the job"))
    }

    fn half_done(job: &Job) -> Assembly {
        let mut assembly = Assembly::new(job);
        assembly.add(part(job, 0, 16, 0..64)).expect("missing");
        assembly.add(part(job, 16, 4, 64..100)).expect("missing");
        assembly
    }

    #[test]
    fn what_is_written_is_read() {
        let (folder, job) = (Folder::new("read"), job());
        let mut nothing = Assembly::new(&job);
        read(&folder.0, &job, &mut nothing).expect("no file is no part");
        assert_eq!(nothing.share(), 0.0);

        let assembly = half_done(&job);
        write(&folder.0, &job, &assembly).expect("a folder that can be written");
        let mut found = Assembly::new(&job);
        read(&folder.0, &job, &mut found).expect("what was written");
        assert!(found.parts().eq(assembly.parts()));
        assert_eq!(found.share(), assembly.share());
        assert!(found.share() > 0.5 && found.share() < 0.9);
        let left: Vec<_> = fs::read_dir(&folder.0).expect("it is there").collect();
        assert_eq!(left.len(), 1, "nothing unfinished is left: {left:?}");
        assert!(matches!(refuse(&folder.0), Err(CheckpointError::Unfinished(_))));
        remove(&folder.0).expect("it is there");
        refuse(&folder.0).expect("there is none any more");
    }

    #[test]
    fn damage_is_noticed() {
        let (folder, job) = (Folder::new("damage"), job());
        write(&folder.0, &job, &half_done(&job)).expect("a folder that can be written");
        let path = folder.0.join(FILE);
        let whole = fs::read(&path).expect("what was written");
        let refused = |bytes: &[u8]| {
            fs::write(&path, bytes).expect("a folder that can be written");
            let mut assembly = Assembly::new(&job);
            let error = read(&folder.0, &job, &mut assembly).expect_err("damaged");
            assert!(matches!(error, CheckpointError::Damaged { .. }), "{error}");
            assert!(error.to_string().contains("remove it"), "{error}");
        };
        for length in (0..whole.len()).step_by(53).chain([whole.len() - 1]) {
            refused(&whole[..length]);
        }
        for at in (0..whole.len()).step_by(61) {
            let mut bytes = whole.clone();
            bytes[at] ^= 0x10;
            refused(&bytes);
        }
        // With a checksum that is right: lengths and parts are looked at too.
        let body = &whole[..whole.len() - 8];
        let mut lengths = body.to_vec();
        lengths[MAGIC.len()..MAGIC.len() + 8].fill(0xff);
        let twice = [body, &body[MAGIC.len() + 8 + job.description.len()..]].concat();
        // A part that ends within a block, so that none can follow.
        let mut ends = MAGIC.to_vec();
        append(&mut ends, job.description.as_bytes());
        append(&mut ends, &part(&job, 0, 16, 0..50).to_bytes());
        for body in [lengths, twice, ends, MAGIC.to_vec()] {
            let sum = checksum(&body).to_le_bytes();
            refused(&[&body[..], &sum].concat());
        }
    }

    #[test]
    fn films_of_other_jobs_are_refused() {
        let (folder, job) = (Folder::new("other"), job());
        write(&folder.0, &job, &half_done(&job)).expect("a folder that can be written");
        let other = Job { description: "noise 20x5, 200 samples".to_owned(), ..job };
        let error = read(&folder.0, &other, &mut Assembly::new(&other)).expect_err("another");
        assert!(matches!(error, CheckpointError::OtherJob { .. }), "{error}");
        assert!(error.to_string().contains("100 samples"), "{error}");
    }
}
