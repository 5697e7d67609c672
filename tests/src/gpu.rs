//! The device of the tests.

#[cfg(feature = "gpu")]
pub use device::{gpu, keeps_denormals};
#[cfg(not(feature = "gpu"))]
pub use none::{gpu, keeps_denormals};

#[cfg(feature = "gpu")]
mod device {
    use std::sync::OnceLock;
    use std::time::Duration;

    use raydsl::gpu::{Context, GpuScheduler};

    /// A driver for CPUs compiles at the first dispatch, and beside other tests.
    const TIMEOUT: Duration = Duration::from_secs(300);

    /// The scheduler of this machine's adapter, or `None` after saying so loudly.
    ///
    /// # Panics
    ///
    /// If there is no adapter and `RAYDSL_REQUIRE_GPU` is `1`.
    #[must_use = "a test that needs a device must return without one"]
    pub fn gpu() -> Option<&'static GpuScheduler> {
        static GPU: OnceLock<Option<GpuScheduler>> = OnceLock::new();
        GPU.get_or_init(|| match Context::new() {
            Ok(context) => {
                eprintln!("GPU adapter: {}", context.adapter_name());
                Some(GpuScheduler::with_context(context.with_timeout(TIMEOUT)))
            }
            Err(error) => {
                let required = std::env::var("RAYDSL_REQUIRE_GPU").is_ok_and(|v| v == "1");
                assert!(!required, "RAYDSL_REQUIRE_GPU=1, but: {error}");
                eprintln!("SKIPPED: no GPU adapter ({error})");
                None
            }
        })
        .as_ref()
    }

    /// Whether a device keeps denormals: one that is a CPU does, and cards may take them for 0.
    pub fn keeps_denormals(gpu: &GpuScheduler) -> bool {
        gpu.context().adapter_info().device_type == wgpu::DeviceType::Cpu
    }
}

/// Tests of the CPU alone are built without wgpu.
#[cfg(not(feature = "gpu"))]
mod none {
    use raydsl::kernel::Kernel;
    use raydsl::machine::Type;

    /// There is none.
    #[derive(Debug)]
    pub enum Device {}

    impl Device {
        /// Never called.
        ///
        /// # Errors
        ///
        /// None.
        pub fn batch<A: Type, R: Type>(
            &self,
            _: &Kernel<'_, A, R>,
            _: &[A],
            _: &mut [R],
        ) -> Result<(), String> {
            match *self {}
        }
    }

    /// No device, said loudly once.
    #[must_use = "a test that needs a device must return without one"]
    pub fn gpu() -> Option<&'static Device> {
        static SAID: std::sync::Once = std::sync::Once::new();
        SAID.call_once(|| eprintln!("SKIPPED: these tests were built without the feature `gpu`"));
        None
    }

    /// Never called.
    pub fn keeps_denormals(device: &Device) -> bool {
        match *device {}
    }
}
