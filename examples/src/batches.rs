//! Batches by every variant: compared and timed.

use std::time::Instant;

use raydsl::gpu::GpuError;
use raydsl::kernel::Kernel;
use raydsl::prelude::*;
use raydsl::testing::Agreement;

/// What ends a comparison.
#[derive(Debug, thiserror::Error)]
pub enum CompareError {
    /// The device refuses the kernel.
    #[error(transparent)]
    Device(#[from] GpuError),
    /// A variant of the CPU has results with other bits.
    #[error("{variant} has other bits than the scalar variant in {count} results: report it")]
    Disagrees {
        /// The variant's name.
        variant: &'static str,
        /// How many results differ.
        count: u64,
    },
}

/// Runs batches: on all threads, or on the device if there is one.
pub struct Batches {
    gpu: Option<GpuScheduler>,
}

impl Batches {
    /// Creates a runner for some of these variants. If WGSL is one of them and there is no device, a
    /// message says so, and comparisons leave it out.
    pub fn of(variants: &[Variant]) -> Self {
        let gpu = variants.contains(&Variant::Wgsl).then(GpuScheduler::new).transpose();
        let gpu = gpu.unwrap_or_else(|e| {
            eprintln!("without wgsl: {e}");
            None
        });
        Self { gpu }
    }

    /// Runs a kernel by the scalar variant and by `variants`, prints a table with the speed of each
    /// and how its results differ, and returns the scalar results. `unit` names an input, in plural.
    ///
    /// # Errors
    ///
    /// If the device refuses the kernel, or a variant of the CPU does not have the scalar bits.
    pub fn compare<A: Type, R: Type + Default>(
        &self,
        variants: &[Variant],
        kernel: &Kernel<'_, A, R>,
        inputs: &[A],
        unit: &str,
    ) -> Result<Vec<R>, CompareError> {
        let title = format!("million {unit}/s");
        println!("variant   {title:>17}  differing  max ulp  other decisions");
        let line = |variant: Variant, seconds: f64, same: &Agreement| {
            let rate = inputs.len() as f64 / seconds / 1e6;
            let (differing, decisions) = (same.differing, same.hit_mismatches);
            let name = variant.name();
            println!("{name:9} {rate:17.3} {differing:10} {:8} {decisions:16}", same.max_ulp);
        };
        let mut expected = vec![R::default(); inputs.len()];
        let seconds = self.run(Variant::Scalar, kernel, inputs, &mut expected)?;
        line(Variant::Scalar, seconds, &Agreement::of(&expected, &expected));
        for &variant in variants.iter().filter(|v| **v != Variant::Scalar && self.has(**v)) {
            let mut found = vec![R::default(); inputs.len()];
            let seconds = self.run(variant, kernel, inputs, &mut found)?;
            let same = Agreement::of(&expected, &found);
            line(variant, seconds, &same);
            if variant != Variant::Wgsl && !same.is_bit_identical() {
                let (variant, count) = (variant.name(), same.differing);
                return Err(CompareError::Disagrees { variant, count });
            }
        }
        Ok(expected)
    }

    fn has(&self, variant: Variant) -> bool {
        variant != Variant::Wgsl || self.gpu.is_some()
    }

    /// Runs a batch and returns the seconds that it took.
    fn run<A: Type, R: Type>(
        &self,
        variant: Variant,
        kernel: &Kernel<'_, A, R>,
        inputs: &[A],
        results: &mut [R],
    ) -> Result<f64, GpuError> {
        if let (Variant::Wgsl, Some(gpu)) = (variant, &self.gpu) {
            // The first run also compiles the kernel, and uploads the scene.
            gpu.batch(kernel, &inputs[..inputs.len().min(1)], &mut results[..inputs.len().min(1)])?;
        }
        let start = Instant::now();
        match (variant, &self.gpu) {
            (Variant::Wgsl, Some(gpu)) => {
                gpu.batch(kernel, inputs, results)?;
            }
            (cpu, _) => TiledScheduler::new().variant(cpu).batch(kernel, inputs, results),
        }
        Ok(start.elapsed().as_secs_f64())
    }
}
