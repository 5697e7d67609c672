//! The environment of a measurement.

use super::case::Backend;
#[cfg(feature = "gpu")]
use raydsl::kernel::Variant;

/// The machine and the build.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Environment {
    /// The processor's name, or its architecture if the system does not report the name.
    pub cpu: String,
    /// The operating system.
    pub os: &'static str,
    /// The device of the WGSL variant.
    pub gpu: Option<String>,
    /// The interface, and the driver's name and version if known.
    pub driver: Option<String>,
    /// Each backend, the instruction set that runs it, and its lanes.
    pub backends: Vec<(&'static str, &'static str, usize)>,
    /// The number of threads of runs on the CPU.
    pub threads: u32,
    /// Whether debug assertions are enabled: then times mean little.
    pub has_debug_assertions: bool,
    /// The version of raydsl.
    pub version: &'static str,
    /// The features that raydsl was built with, in alphabetical order.
    pub features: Vec<&'static str>,
    /// The commit of the source, or `unknown`: see
    /// [`WorkPrecision::commit`](super::WorkPrecision::commit).
    pub commit: String,
}

impl Environment {
    pub(super) fn of(
        backends: &[Backend],
        commit: Option<String>,
        #[cfg(feature = "gpu")] gpu: Option<&raydsl::gpu::GpuScheduler>,
    ) -> Self {
        let described = |backend: &Backend| match backend {
            Backend::Variant(variant) => (backend.name(), variant.isa().0, variant.isa().1),
            Backend::F64 => (backend.name(), "scalar", 1),
        };
        #[cfg(feature = "gpu")]
        let (gpu, driver) = gpu
            .filter(|_| backends.contains(&Backend::Variant(Variant::Wgsl)))
            .map(|g| device(g.context().adapter_info()))
            .unzip();
        #[cfg(not(feature = "gpu"))]
        let (gpu, driver) = (None, None);
        Self {
            cpu: cpu().unwrap_or_else(|| std::env::consts::ARCH.to_owned()),
            os: std::env::consts::OS,
            gpu,
            driver,
            backends: backends.iter().map(described).collect(),
            threads: 1,
            has_debug_assertions: cfg!(debug_assertions),
            version: env!("CARGO_PKG_VERSION"),
            features: features(),
            commit: commit.unwrap_or_else(|| "unknown".to_owned()),
        }
    }
}

/// Returns a device's name, and its interface and driver.
#[cfg(feature = "gpu")]
fn device(info: &wgpu::AdapterInfo) -> (String, String) {
    let interface = format!("{:?}", info.backend);
    let driver = [interface.as_str(), &info.driver, &info.driver_info];
    let known: Vec<&str> = driver.into_iter().filter(|word| !word.is_empty()).collect();
    (info.name.clone(), known.join(", "))
}

fn features() -> Vec<&'static str> {
    let all = [
        ("cpu_time", cfg!(feature = "cpu_time")),
        ("flip", cfg!(feature = "flip")),
        ("gpu", cfg!(feature = "gpu")),
        ("image", cfg!(feature = "image")),
        ("parallel", cfg!(feature = "parallel")),
    ];
    all.into_iter().filter(|f| f.1).map(|f| f.0).collect()
}

/// Returns the processor's name, if Linux reports it.
fn cpu() -> Option<String> {
    let text = std::fs::read_to_string("/proc/cpuinfo").ok()?;
    let line = text.lines().find(|l| l.starts_with("model name"))?;
    line.split_once(':').map(|(_, name)| name.trim().to_owned())
}
