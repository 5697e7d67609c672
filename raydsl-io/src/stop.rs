//! Loading that another thread may end.

use std::cell::RefCell;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// The most bytes that are read at once.
pub(crate) const MOST: usize = 1 << 18;

thread_local! {
    static STOP: RefCell<Option<Arc<AtomicBool>>> = const { RefCell::new(None) };
}

/// Calls `load`, whose reading of files ends with [`LoadError::Stopped`](crate::LoadError::Stopped) soon
/// after another thread sets `stop`: with the next part of at most 256 KiB that is read. What is done
/// with bytes that are read already, as decompressing them, goes on to its end.
///
/// It holds for files that `load` opens on this thread. An outer call is out of force meanwhile.
///
/// ```
/// use std::sync::Arc;
/// use std::sync::atomic::AtomicBool;
///
/// use raydsl_io::{LoadError, mesh, stoppable};
///
/// let stop = Arc::new(AtomicBool::new(true)); // another thread has given up already
/// # let path = std::env::temp_dir().join(format!("stoppable-{}.obj", std::process::id()));
/// # std::fs::write(&path, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")?;
/// let found = stoppable(&stop, || mesh::load(&path));
/// assert!(matches!(found, Err(LoadError::Stopped { .. })));
/// # std::fs::remove_file(path)?;
/// # Ok::<(), std::io::Error>(())
/// ```
pub fn stoppable<T>(stop: &Arc<AtomicBool>, load: impl FnOnce() -> T) -> T {
    /// Sets what was in force before, also after a panic.
    struct Restore(Option<Arc<AtomicBool>>);

    impl Drop for Restore {
        fn drop(&mut self) {
            STOP.set(self.0.take());
        }
    }

    let _restore = Restore(STOP.replace(Some(stop.clone())));
    load()
}

/// A file that cannot be read any more once reading is stopped.
pub(crate) struct Stoppable {
    file: File,
    stop: Option<Arc<AtomicBool>>,
}

/// Returns whether loading on this thread was stopped. Decoders may hand on a reader's error as one of
/// their own, so this is asked where errors are made.
pub(crate) fn is_stopped() -> bool {
    STOP.with_borrow(|stop| stop.as_ref().is_some_and(is_set))
}

fn is_set(stop: &Arc<AtomicBool>) -> bool {
    stop.load(Ordering::Relaxed)
}

impl Stoppable {
    pub(crate) fn new(file: File) -> Self {
        Self { file, stop: STOP.with_borrow(Clone::clone) }
    }
}

impl Read for Stoppable {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.stop.as_ref().is_some_and(is_set) {
            return Err(io::Error::other("loading was stopped"));
        }
        // A reader of large parts passes its own room on, not that of a buffer.
        let most = buffer.len().min(MOST);
        self.file.read(&mut buffer[..most])
    }
}

impl Seek for Stoppable {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}

#[cfg(test)]
mod tests {
    use std::io::BufReader;

    use super::*;

    #[test]
    fn parts_are_small() -> io::Result<()> {
        let path = std::env::temp_dir().join(format!("parts-{}", std::process::id()));
        std::fs::write(&path, vec![7; 1 << 20])?;
        let file = File::open(&path)?;
        std::fs::remove_file(path)?;
        // It has less room than is asked for, so it is passed by.
        let mut reader = BufReader::with_capacity(MOST, Stoppable::new(file));
        let mut room = vec![0; 1 << 20];
        let first = reader.read(&mut room)?;
        assert!((1..=MOST).contains(&first), "{first}");
        reader.read_exact(&mut room[first..])?;
        assert!(room.iter().all(|byte| *byte == 7));
        assert_eq!(reader.read(&mut [0])?, 0);
        Ok(())
    }
}
