//! Headless Chromium, which opens the page and lets it report.

use std::fs::File;
use std::net::Ipv4Addr;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};
use std::time::{Duration, Instant};

use raydsl_web::bundle::bundle;
use raydsl_web::server::{PageServer, Report};

/// A page that has not reported by then never will.
const PATIENCE: Duration = Duration::from_secs(400);

/// Whether the browser has a device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum WebGpu {
    /// The one in software, which Chromium brings along.
    SwiftShader,
    /// None.
    None,
}

/// A server of the page, and the browser that opens it, one page after another.
pub(crate) struct Browser {
    pub(crate) url: String,
    reports: Receiver<Report>,
    /// Chromium's profile and log, and the page.
    folder: PathBuf,
    pages: AtomicU32,
}

impl Browser {
    /// Returns the browser of this process, once no other test has it.
    pub(crate) fn shared() -> MutexGuard<'static, Self> {
        static BROWSER: OnceLock<Mutex<Browser>> = OnceLock::new();
        let browser = BROWSER.get_or_init(|| Mutex::new(Self::new()));
        browser.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn new() -> Self {
        let built = bundle().expect("the page can be built");
        let folder = std::env::temp_dir().join(format!("raydsl-chromium-{}", std::process::id()));
        copy(&built, &folder.join("page"));
        let address = (Ipv4Addr::LOCALHOST, 0).into();
        let server = PageServer::open(&folder.join("page"), address).expect("a port is free");
        let url = server.url();
        let (sender, reports) = channel();
        std::thread::spawn(move || server.serve(Some(&sender)));
        Self { url, reports, folder, pages: AtomicU32::new(0) }
    }

    /// Serves the page once more, in a folder of its own and with another text of one of its files.
    pub(crate) fn alter(&self, folder: &str, file: &str, text: &str) {
        let page = self.folder.join("page");
        copy(&page, &page.join(folder));
        std::fs::write(page.join(folder).join(file), text).expect("a file can be written");
    }

    /// Opens a page, which has a query, and returns its report.
    pub(crate) fn open(&self, page: &str, webgpu: WebGpu) -> Vec<u8> {
        // Of this process alone: a browser that is left of another one may find the same port.
        let number = self.pages.fetch_add(1, Ordering::Relaxed);
        let id = format!("{}-{number}", std::process::id());
        let log = self.folder.join("log.txt");
        let _page = Page(self.start(&format!("{page}&report={id}"), webgpu, &log));
        let end = Instant::now() + PATIENCE;
        loop {
            match self.reports.recv_timeout(end.saturating_duration_since(Instant::now())) {
                Ok(report) if report.id == id => return report.body,
                // That of another page.
                Ok(_) => {}
                Err(RecvTimeoutError::Timeout) => {
                    let log = std::fs::read_to_string(&log).unwrap_or_default();
                    panic!("{page}: no report in {} s; Chromium wrote\n{log}", PATIENCE.as_secs())
                }
                Err(RecvTimeoutError::Disconnected) => panic!("{page}: the server has ended"),
            }
        }
    }

    fn start(&self, page: &str, webgpu: WebGpu, log: &Path) -> Child {
        let program = std::env::var_os("RAYDSL_CHROMIUM").unwrap_or_else(|| "chromium".into());
        let mut command = Command::new(&program);
        command
            // The sandbox does not run as root, and the page is the only one that is opened.
            .args(["--headless=new", "--no-sandbox", "--no-first-run", "--disable-dev-shm-usage"])
            .arg(format!("--user-data-dir={}", self.folder.join("profile").display()));
        match webgpu {
            WebGpu::SwiftShader => command.args([
                "--enable-unsafe-webgpu",
                "--enable-unsafe-swiftshader",
                "--use-webgpu-adapter=swiftshader",
                // The page is composed by Vulkan too: a canvas is presented to nothing else.
                "--enable-features=Vulkan",
                "--use-vulkan=swiftshader",
                "--use-angle=vulkan",
            ]),
            WebGpu::None => command.args(["--disable-gpu", "--disable-features=WebGPU,Vulkan"]),
        };
        let file = File::create(log).expect("a log can be written");
        command
            .arg(format!("{}{page}", self.url))
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(file)
            .spawn()
            .unwrap_or_else(|e| {
                panic!("{}: {e}; install Chromium, or set RAYDSL_CHROMIUM", program.display())
            })
    }
}

/// Copies the files of a folder.
fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).expect("a folder can be made");
    for entry in std::fs::read_dir(from).expect("the folder is there") {
        let path = entry.expect("the folder can be read").path();
        if path.is_file() {
            let name = path.file_name().expect("a file has a name");
            std::fs::copy(&path, to.join(name)).expect("a file can be copied");
        }
    }
}

/// A running browser, which ends with its page.
struct Page(Child);

impl Drop for Page {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}
