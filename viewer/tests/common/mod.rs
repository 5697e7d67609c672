//! Shared code of the viewer's tests.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use raydsl_viewer::{Action, Config, Device, Player, Session};

/// A folder for the files of a test, removed at its end.
pub(crate) struct Folder(PathBuf);

impl Folder {
    /// Makes an empty folder.
    pub(crate) fn new(name: &str) -> Self {
        let name = format!("raydsl-viewer-{name}-{}", std::process::id());
        let path = std::env::temp_dir().join(name);
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).expect("a temporary folder");
        Self(path)
    }

    /// Returns the path of a file in it.
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        if std::env::var_os("RAYDSL_KEEP").is_none() {
            let _ = std::fs::remove_dir_all(&self.0);
        }
    }
}

/// Plays a script without a window.
pub(crate) fn play(text: &str, folder: &Folder) -> Session {
    let mut player = Player::read(text).expect("a script");
    let mut session = Session::new(Config::scripted(folder.path("")), Device::default(), || {});
    player.play(&mut session);
    session
}

/// Waits until the picture of the last change has as many samples.
pub(crate) fn wait(session: &mut Session, samples: u32) {
    session.apply(&Action::Wait(samples)).expect("nothing is refused");
    until(session, |session| session.has(samples));
}

/// Waits for something, a minute at most.
pub(crate) fn until(session: &mut Session, is_there: impl Fn(&Session) -> bool) {
    let start = Instant::now();
    while !is_there(session) {
        assert!(start.elapsed() < Duration::from_secs(60), "waited too long: {:#?}", session.log());
        session.poll();
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// Reads a picture: its size, and four bytes of each pixel from the top.
pub(crate) fn picture_of(path: &Path) -> ((u32, u32), Vec<u8>) {
    let image = image::open(path).unwrap_or_else(|e| panic!("{}: {e}", path.display())).to_rgba8();
    (image.dimensions(), image.into_raw())
}

/// The folder of real files, if there is one.
pub(crate) fn data() -> Option<String> {
    std::env::var("RAYDSL_DATA").ok()
}
