//! What `--explain` of an example prints: the size of its program, beside that of a program with all
//! features of its family.

use std::time::Instant;

use raydsl::machine::Recording;
use raydsl::machine::wgsl::Limits;
use raydsl::prelude::*;
use raydsl_report::{InvalidProgram, Program, ProgramSize};

/// A program, and what it has.
pub struct Explained<'a> {
    /// Its name.
    pub name: &'a str,
    /// The features that it uses.
    pub features: &'a str,
    /// What was recorded of it.
    pub recording: Recording,
}

/// Returns a table of the sizes of programs, and the ratios of each to the last one, which has all
/// features. Where there is a device it says how long that takes to make their pipelines.
///
/// # Errors
///
/// If a text is not valid.
pub fn explain(programs: &[Explained<'_>]) -> Result<String, InvalidProgram> {
    let gpu = GpuScheduler::new().ok();
    let mut rows = Vec::with_capacity(programs.len());
    for Explained { name, features, recording } in programs {
        let source = recording.module(&Limits::default()).source;
        let size = Program::read(&source)?.size;
        let pipeline = gpu.as_ref().and_then(|gpu| pipeline_ms(gpu, &source, &size));
        rows.push((name, features, size, pipeline));
    }
    let mut table = format!(
        "{:<16}{:>11}{:>10}{:>13}{:>10}{:>9}{:>9}{:>10}{:>12}\n",
        "program",
        "WGSL bytes",
        "functions",
        "instructions",
        "in loops",
        "bindings",
        "private",
        "workgroup",
        "pipeline"
    );
    for (name, _, size, pipeline) in &rows {
        let ms = pipeline.map_or("-".to_owned(), |ms| format!("{ms:.1} ms"));
        let ProgramSize { wgsl_bytes, functions, instructions, in_loops, bindings, .. } = size;
        table += &format!(
            "{name:<16}{wgsl_bytes:>11}{functions:>10}{instructions:>13}{in_loops:>10}{bindings:>9}{:>9}{:>10}{ms:>12}\n",
            size.private_bytes, size.workgroup_bytes
        );
    }
    if let Some(((_, _, all, all_pipeline), others)) = rows.split_last() {
        let share = |a: usize, b: usize| format!("{:.0} %", 100.0 * a as f64 / b.max(1) as f64);
        for (name, _, size, pipeline) in others {
            let ms = pipeline.zip(*all_pipeline);
            table += &format!(
                "{:<16}{:>11}{:>10}{:>13}{:>10}{:>9}{:>9}{:>10}{:>12}\n",
                format!("{name}, of all"),
                share(size.wgsl_bytes, all.wgsl_bytes),
                share(size.functions, all.functions),
                share(size.instructions, all.instructions),
                share(size.in_loops, all.in_loops),
                share(size.bindings, all.bindings),
                share(size.private_bytes as usize, all.private_bytes as usize),
                "",
                ms.map_or("-".to_owned(), |(a, b)| format!("{:.0} %", 100.0 * a / b)),
            );
        }
    }
    for (name, features, ..) in &rows {
        table += &format!("{name}: {features}\n");
    }
    if let Some(gpu) = &gpu {
        table += &format!("Pipelines of {}.\n", gpu.context().adapter_name());
    }
    Ok(table)
}

/// Returns how long a device takes to make a text's pipeline, in milliseconds; `None` if it has fewer
/// bindings than the text.
fn pipeline_ms(gpu: &GpuScheduler, source: &str, size: &ProgramSize) -> Option<f64> {
    let device = gpu.context().device();
    if size.bindings > device.limits().max_storage_buffers_per_shader_stage as usize {
        return None;
    }
    let start = Instant::now();
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("explained"),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    let _pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some("explained"),
        layout: None,
        module: &module,
        entry_point: Some("main"),
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    });
    Some(start.elapsed().as_secs_f64() * 1e3)
}

/// Records a `#[kernel] fn` alone, of which no packets are compiled: its captures, then its parameters.
#[macro_export]
macro_rules! recorded {
    ($kernel:ident($($capture:ident),*)($($arg:ident: $ty:ty),+) -> $out:ty) => {
        ::raydsl::machine::Recording::batch::<($($ty,)+), $out>(
            ::raydsl::machine::wgsl::Arithmetic::Strict,
            |m, ($($arg,)+)| {
                use ::raydsl::__private::{Capture, Recorder};
                // The function itself runs nowhere.
                let _ = $kernel;
                $(let $capture = Capture::<Recorder>::capture(&$capture, m, stringify!($capture));)*
                $kernel::on(m, $($capture,)* $($arg),+)
            },
        )
    };
}
