//! Headless Chromium, which opens the page and lets it report.

use std::fs::File;
use std::net::Ipv4Addr;
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};
use std::time::Duration;

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
    url: String,
    reports: Receiver<Report>,
    /// Chromium's profile and log.
    folder: PathBuf,
}

impl Browser {
    /// Returns the browser of this process, once no other test has it.
    pub(crate) fn shared() -> MutexGuard<'static, Self> {
        static BROWSER: OnceLock<Mutex<Browser>> = OnceLock::new();
        let browser = BROWSER.get_or_init(|| Mutex::new(Self::new()));
        browser.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn new() -> Self {
        let folder = bundle().expect("the page can be built");
        let address = (Ipv4Addr::LOCALHOST, 0).into();
        let server = PageServer::open(&folder, address).expect("a port is free");
        let url = server.url();
        let (sender, reports) = channel();
        std::thread::spawn(move || server.serve(Some(&sender)));
        let folder = std::env::temp_dir().join(format!("raydsl-chromium-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder can be made");
        Self { url, reports, folder }
    }

    /// Opens the page with a query and returns its report.
    pub(crate) fn open(&self, query: &str, webgpu: WebGpu) -> Report {
        let log = self.folder.join("log.txt");
        let _page = Page(self.start(query, webgpu, &log));
        match self.reports.recv_timeout(PATIENCE) {
            Ok(report) => report,
            Err(RecvTimeoutError::Timeout) => {
                let log = std::fs::read_to_string(&log).unwrap_or_default();
                panic!("{query}: no report in {} s; Chromium wrote\n{log}", PATIENCE.as_secs())
            }
            Err(RecvTimeoutError::Disconnected) => panic!("{query}: the server has ended"),
        }
    }

    fn start(&self, query: &str, webgpu: WebGpu, log: &PathBuf) -> Child {
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
            .arg(format!("{}?{query}&report", self.url))
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(file)
            .spawn()
            .unwrap_or_else(|e| {
                panic!("{}: {e}; install Chromium, or set RAYDSL_CHROMIUM", program.display())
            })
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
