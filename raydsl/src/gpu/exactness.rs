//! How a device rounds quotients and square roots, and whether it leaves sums as they are written, found
//! by running some.

use std::collections::HashSet;

use super::{Context, GpuError};
use crate::machine::wgsl::{Arithmetic, Module, Quotients};

/// What a device's strict kernels are to the other variants.
#[derive(Clone, Copy, Debug)]
pub(super) struct Exactness {
    pub(super) quotients: Quotients,
    /// What it is that has other bits; `None` on an exact device.
    pub(super) obstacle: Option<&'static str>,
}

/// Why a device without SPIR-V is not exact.
const NO_SPIRV: &str = "it takes no SPIR-V, so its driver may fuse and move operations";

/// The functions that correct a quotient and a root.
const QUOTIENT: &str = include_str!("../machine/record/exact_quotient.wgsl");
const ROOT: &str = include_str!("../machine/record/exact_root.wgsl");

/// Numbers of the kernel below: pairs of them.
const COUNT: u32 = 1 << 16;

impl Exactness {
    /// Returns whether a kernel has to run. A device that is a CPU has its instructions, which are
    /// those of the host, and no `fma` that could be relied on.
    pub(super) fn takes_a_kernel(context: &Context) -> bool {
        context.spirv.is_some() && context.adapter_info().device_type != wgpu::DeviceType::Cpu
    }

    /// Runs quotients and roots of a context's device and compares them with the host's.
    pub(super) fn of(context: &Context) -> Self {
        let native = |obstacle| Self { quotients: Quotients::Native, obstacle };
        if context.spirv.is_none() {
            return native(Some(NO_SPIRV));
        }
        if !Self::takes_a_kernel(context) {
            return native(None);
        }
        let found = differences(context, &module(QUOTIENT, ROOT));
        context.pipelines.reset();
        // A kernel that fails will fail again, and then the error is returned.
        let Ok(found) = found else {
            return native(Some("a kernel that tests its arithmetic failed"));
        };
        let has = |way| found.contains(&way);
        if has(Way::Sums) {
            return native(Some("it fuses or moves sums and products of SPIR-V, too"));
        }
        match (has(Way::Native), has(Way::Corrected)) {
            (false, _) => native(None),
            (true, false) => Self { quotients: Quotients::Corrected, obstacle: None },
            (true, true) => native(Some("its quotients or square roots cannot be corrected")),
        }
    }
}

#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Way {
    Native,
    Corrected,
    /// Sums of products, and differences of sums.
    Sums,
}

/// Returns the ways in which some result differs from the host's; nothing if the kernel fails.
fn differences(context: &Context, module: &Module) -> Result<HashSet<Way>, GpuError> {
    let pairs: Vec<[f32; 2]> = (0..COUNT).map(pair).collect();
    let inputs: Vec<u8> = pairs.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    let mut outputs = vec![0; 32 * COUNT as usize];
    context.run(module, &|_| None, &inputs, [COUNT, 1], &mut outputs)?;
    let mut found = HashSet::new();
    for ([a, b], of_pair) in pairs.into_iter().zip(outputs.chunks_exact(32)) {
        let (quotients, sums) = of_pair.split_at(16);
        let expected = [a / b, a.sqrt()].map(f32::to_le_bytes);
        for (way, results) in
            [Way::Native, Way::Corrected].into_iter().zip(quotients.chunks_exact(8))
        {
            if results != expected.as_flattened() {
                found.insert(way);
            }
        }
        let expected = [a * b + b, a * b - b * b, (a + b) - a, (a - b) * b].map(f32::to_le_bytes);
        if sums != expected.as_flattened() {
            found.insert(Way::Sums);
        }
    }
    Ok(found)
}

/// Mantissas next to powers of two and to halves between them.
const EDGES: [u32; 8] = [0, 1, 2, 0x3f_ffff, 0x40_0000, 0x40_0001, 0x7f_fffe, 0x7f_ffff];

/// Returns two positive numbers; their quotient is normal. The first pairs have all edges.
fn pair(i: u32) -> [f32; 2] {
    // Steele and Vigna's mixer of 32 bits (after Pelle Evensen).
    let mix = |mut x: u32| {
        x = (x ^ x >> 16).wrapping_mul(0x21f0_aaad);
        x = (x ^ x >> 15).wrapping_mul(0x735a_2d97);
        x ^ x >> 15
    };
    let edges = [EDGES[i as usize / 8 % 8], EDGES[i as usize % 8]];
    [0, 1].map(|n| {
        let bits = mix(2 * i + n);
        // Exponents from -60 to 60.
        let exponent = 67 + (bits >> 23) % 121;
        let mantissa = if i < 128 { edges[n as usize] } else { bits & 0x7f_ffff };
        f32::from_bits(exponent << 23 | mantissa)
    })
}

/// Returns the kernel: native quotient and root, both corrected by these functions, and sums.
fn module(quotient: &str, root: &str) -> Module {
    let source = format!(
        "struct Job {{
    size: vec2<u32>,
    first: vec2<u32>,
    count: vec2<u32>,
    base: u32,
    pad: u32,
}}
@group(0) @binding(0) var<uniform> params: vec4<u32>;
@group(0) @binding(1) var<uniform> job: Job;
@group(0) @binding(2) var<storage, read> inputs: array<vec2<f32>>;
struct Results {{
    quotients: vec4<f32>,
    sums: vec4<f32>,
}}
@group(0) @binding(3) var<storage, read_write> outputs: array<Results>;

{quotient}
{root}
@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {{
    if (any(id.xy >= job.count)) {{ return; }}
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let a = inputs[index].x;
    let b = inputs[index].y;
    outputs[index].quotients = vec4<f32>(a / b, sqrt(a), exact_quotient(a, b), exact_root(a));
    outputs[index].sums = vec4<f32>(a * b + b, a * b - b * b, (a + b) - a, (a - b) * b);
}}
"
    );
    Module {
        source,
        arithmetic: Arithmetic::Strict,
        workgroup: [64, 1],
        uniforms: vec![0; 16],
        input_stride: 8,
        output_stride: 32,
        buffers: Vec::new(),
        textures: Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::{QUOTIENT, ROOT, Way, differences, module};

    /// `fma` of numbers whose product nearly cancels the third, as all in the texts are: the
    /// product's rounding error by Dekker (1971), and a difference that is exact (Sterbenz, 1974). A
    /// CPU's own `fma` may be two operations.
    const FUSED: &str = "
fn fused(a: f32, b: f32, c: f32) -> f32 {
    let p = a * b;
    let a_split = 4097.0 * a;
    let a_high = a_split - (a_split - a);
    let a_low = a - a_high;
    let b_split = 4097.0 * b;
    let b_high = b_split - (b_split - b);
    let b_low = b - b_high;
    let lost = ((a_high * b_high - p) + a_high * b_low + a_low * b_high) + a_low * b_low;
    return (p + c) + lost;
}
";

    /// Returns a text whose approximation is so many ulp further off, with the `fma` above.
    fn off(text: &str, approximation: &str, ulps: i32) -> String {
        let exact = format!("let near = {approximation};");
        assert!(text.contains(&exact) && text.contains("fma("), "{text}");
        let shifted = format!(
            "let near = bitcast<f32>(bitcast<u32>({approximation}) + {}u);",
            ulps.cast_unsigned()
        );
        text.replace(&exact, &shifted).replace("fma(", "fused(")
    }

    #[test]
    fn corrected_results_are_the_nearest() {
        let Some(context) = crate::gpu::tests::context() else {
            return;
        };
        if context.spirv.is_none() {
            // Sums may be regrouped, and with them `fused`.
            eprintln!("LEFT OUT: {} takes no SPIR-V", context.adapter_name());
            return;
        }
        for ulps in -3..=3 {
            let quotient = FUSED.to_owned() + &off(QUOTIENT, "m / n", ulps);
            let module = module(&quotient, &off(ROOT, "sqrt(m)", ulps));
            let found = differences(&context, &module).expect("the kernel runs");
            assert!(!found.contains(&Way::Corrected), "{ulps} ulp off");
        }
    }

    #[test]
    fn other_results_are_found() {
        let Some(context) = crate::gpu::tests::context() else {
            return;
        };
        // Neither is corrected by what it is called with.
        let quotient = "fn exact_quotient(a: f32, b: f32) -> f32 { return a * (1.0 / b); }\n";
        let root = "fn exact_root(a: f32) -> f32 { return a * inverseSqrt(a); }\n";
        let found = differences(&context, &module(quotient, root)).expect("the kernel runs");
        assert!(found.contains(&Way::Corrected));
    }

    /// A device that is a CPU is believed to round to nearest, and to leave sums as they are written.
    #[test]
    fn what_is_native_is_exact_on_a_cpu() {
        let Some(context) = crate::gpu::tests::context() else {
            return;
        };
        let is_cpu = context.adapter_info().device_type == wgpu::DeviceType::Cpu;
        if is_cpu && context.spirv.is_some() {
            let found = differences(&context, &module(QUOTIENT, ROOT)).expect("the kernel runs");
            assert!(!found.contains(&Way::Native) && !found.contains(&Way::Sums));
        }
    }

    /// By an error that says why, and what to ask for instead.
    #[test]
    fn a_device_without_spirv_is_refused() {
        let Some(context) = crate::gpu::tests::context() else {
            return;
        };
        // Also if it was not before.
        let _ = context.is_exact();
        let error = context.with_operations_fused().require_exact().expect_err("no SPIR-V");
        let text = error.to_string();
        assert!(text.contains("SPIR-V") && text.contains("Arithmetic::Fast"), "{text}");
    }
}
