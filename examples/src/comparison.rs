//! How programs compare the variants of a kernel: with a bar, a table and pictures.

use std::path::Path;

use indicatif::{ProgressBar, ProgressStyle};
use raydsl::camera::Camera;
use raydsl::kernel::{Kernel, Variant, Variants};
use raydsl::prelude::*;
use raydsl_report::{Compare, Comparison, WriteError};

/// What command lines say about a comparison.
#[derive(Clone, Copy, Debug)]
pub struct Frames<'a> {
    /// Width and height of the pictures.
    pub size: (u32, u32),
    /// Timed rounds.
    pub runs: u16,
    /// Which variants run, beside the scalar one.
    pub variants: &'a [Variant],
    /// Folder of the pictures.
    pub out: &'a Path,
}

impl Frames<'_> {
    /// Runs every variant, with a bar.
    pub fn compare(
        &self,
        kernel: &Kernel<'_, (Ray,), Shaded>,
        camera: &impl Camera,
    ) -> Comparison<Shaded> {
        let variants = Variants::of(self.variants);
        let steps = variants.iter().count() * (usize::from(self.runs) + 1);
        let bar = bar(steps as u64, "rendering");
        let (width, height) = self.size;
        let found = Compare::new()
            .size(width, height)
            .runs(self.runs.into())
            .variants(&variants)
            .progress(|name| {
                bar.set_message(format!("rendering {name}"));
                bar.inc(1);
            })
            .run(kernel, camera);
        bar.finish_and_clear();
        found
    }

    /// Prints the table of a comparison and writes its pictures.
    ///
    /// # Errors
    ///
    /// If a file cannot be written.
    pub fn report(&self, found: &Comparison<Shaded>) -> Result<(), WriteError> {
        let (width, height) = self.size;
        println!("\n{}", found.table());
        if let Some(adapter) = &found.adapter {
            println!("WGSL ran on {adapter}.");
        }
        println!(
            "Medians of {} interleaved runs of {width}x{height} rays on {} threads; the pictures are in {}.",
            self.runs,
            rayon::current_num_threads(),
            self.out.display()
        );
        found.write(self.out)
    }
}

/// A progress bar that is silent where nobody watches.
pub fn bar(length: u64, message: &'static str) -> ProgressBar {
    let style = ProgressStyle::with_template("{msg:28} {wide_bar} {percent:>3} %")
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(length).with_style(style).with_message(message)
}
