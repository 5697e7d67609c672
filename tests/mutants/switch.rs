//! Which mutant of this copy is active: `RAYDSL_MUTANT` is its number, or `seen:FILE` to write down
//! the numbers of those that are reached, one a line, while none is active.

use core::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::fs::File;
use std::io::Write;
use std::sync::{LazyLock, Mutex};

/// Larger than the number of any mutant: none is active.
const NONE: u32 = u32::MAX - 2;
/// None is active, and those reached are written down.
const SEEN: u32 = u32::MAX - 1;
/// The environment has not been read.
const UNREAD: u32 = u32::MAX;

const MOST: usize = 4096;

static ACTIVE: AtomicU32 = AtomicU32::new(UNREAD);
static REACHED: [AtomicBool; MOST] = [const { AtomicBool::new(false) }; MOST];
static FILE: LazyLock<Mutex<Option<File>>> = LazyLock::new(|| {
    let name = std::env::var("RAYDSL_MUTANT").unwrap_or_default();
    let open = |name: &str| {
        File::options().append(true).create(true).open(name).expect("a file to write to")
    };
    Mutex::new(name.strip_prefix("seen:").map(open))
});

/// Returns whether the mutant is active. It stays so, or does not, as long as the process runs.
#[inline(always)]
pub fn is_on(mutant: u32) -> bool {
    let active = ACTIVE.load(Ordering::Relaxed);
    active == mutant || active > NONE && slowly(mutant)
}

#[cold]
#[inline(never)]
fn slowly(mutant: u32) -> bool {
    if ACTIVE.load(Ordering::Relaxed) == UNREAD {
        let active = match std::env::var("RAYDSL_MUTANT") {
            Err(_) => NONE,
            Ok(name) if name.starts_with("seen:") => SEEN,
            Ok(number) => number.parse().expect("RAYDSL_MUTANT is a number, or `seen:FILE`"),
        };
        ACTIVE.store(active, Ordering::Relaxed);
    }
    let active = ACTIVE.load(Ordering::Relaxed);
    if active == SEEN && !REACHED[mutant as usize].swap(true, Ordering::Relaxed) {
        let mut file = FILE.lock().expect("no thread panics while it writes");
        if let Some(file) = file.as_mut() {
            writeln!(file, "{mutant}").expect("a file to write to");
        }
    }
    active == mutant
}
