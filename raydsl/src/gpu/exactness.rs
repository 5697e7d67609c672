//! How a device rounds quotients and square roots, found by running some.

use std::collections::HashSet;

use super::{Context, GpuError};
use crate::machine::wgsl::{Arithmetic, Module, Quotients};

/// What a device's strict kernels are to the other variants.
#[derive(Clone, Copy, Debug)]
pub(super) struct Exactness {
    pub(super) quotients: Quotients,
    pub(super) is_exact: bool,
}

/// Numbers of the kernel below: pairs of them.
const COUNT: u32 = 1 << 16;

impl Exactness {
    /// Runs quotients and roots of a context's device and compares them with the host's.
    pub(super) fn of(context: &Context) -> Self {
        let native = |is_exact| Self { quotients: Quotients::Native, is_exact };
        if context.spirv.is_none() {
            return native(false);
        }
        // A device that is a CPU has its instructions, which are those of the host, and no `fma`
        // that could be relied on.
        if context.adapter_info().device_type == wgpu::DeviceType::Cpu {
            return native(true);
        }
        let found = differences(context);
        context.forget_pipelines();
        // A kernel that fails will fail again, and then the error is returned.
        let Ok(found) = found else {
            return native(false);
        };
        match (found.contains(&Way::Native), found.contains(&Way::Corrected)) {
            (false, _) => native(true),
            (true, false) => Self { quotients: Quotients::Corrected, is_exact: true },
            (true, true) => native(false),
        }
    }
}

#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Way {
    Native,
    Corrected,
}

/// Returns the ways in which some result differs from the host's; nothing if the kernel fails.
fn differences(context: &Context) -> Result<HashSet<Way>, GpuError> {
    let pairs: Vec<[f32; 2]> = (0..COUNT).map(pair).collect();
    let inputs: Vec<u8> = pairs.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    let mut outputs = vec![0; 16 * COUNT as usize];
    context.run(&module(), &|_| None, &inputs, [COUNT, 1], &mut outputs)?;
    let mut found = HashSet::new();
    for ([a, b], of_pair) in pairs.into_iter().zip(outputs.chunks_exact(16)) {
        let expected = [a / b, a.sqrt()].map(f32::to_le_bytes);
        for (way, results) in [Way::Native, Way::Corrected].into_iter().zip(of_pair.chunks_exact(8))
        {
            if results != expected.as_flattened() {
                found.insert(way);
            }
        }
    }
    Ok(found)
}

/// Returns two positive numbers; their quotient is normal.
fn pair(i: u32) -> [f32; 2] {
    // Steele and Vigna's mixer of 32 bits (after Pelle Evensen).
    let mix = |mut x: u32| {
        x = (x ^ x >> 16).wrapping_mul(0x21f0_aaad);
        x = (x ^ x >> 15).wrapping_mul(0x735a_2d97);
        x ^ x >> 15
    };
    [2 * i, 2 * i + 1].map(|n| {
        let bits = mix(n);
        // Exponents from -60 to 60.
        let exponent = 67 + (bits >> 23) % 121;
        f32::from_bits(exponent << 23 | bits & 0x7f_ffff)
    })
}

/// Returns the kernel: native quotient and root, then both corrected.
fn module() -> Module {
    let quotient = include_str!("../machine/record/exact_quotient.wgsl");
    let root = include_str!("../machine/record/exact_root.wgsl");
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
@group(0) @binding(3) var<storage, read_write> outputs: array<vec4<f32>>;

{quotient}
{root}
@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {{
    if (any(id.xy >= job.count)) {{ return; }}
    let at = job.first + id.xy;
    let index = at.y * job.size.x + at.x - job.base;
    let a = inputs[index].x;
    let b = inputs[index].y;
    outputs[index] = vec4<f32>(a / b, sqrt(a), exact_quotient(a, b), exact_root(a));
}}
"
    );
    Module {
        source,
        arithmetic: Arithmetic::Strict,
        workgroup: [64, 1],
        uniforms: vec![0; 16],
        input_stride: 8,
        output_stride: 16,
        buffers: Vec::new(),
        textures: Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::{Way, differences, pair};

    #[test]
    fn the_kernel_runs() {
        let Some(context) = crate::gpu::tests::context() else {
            return;
        };
        let found = differences(&context).expect("the kernel compiles and runs");
        // A device that is a CPU may have no `fma` to correct with, but rounds to nearest itself.
        assert!(
            !context.is_exact()
                || !found.contains(&Way::Native)
                || !found.contains(&Way::Corrected)
        );
    }

    /// The text's algorithm, from an approximation that is `ulps` off.
    fn quotient(a: f32, b: f32, ulps: i32) -> f32 {
        let mantissa = |x: f32| f32::from_bits(x.to_bits() & 0x7f_ffff | 0x3f80_0000);
        let (m, n) = (mantissa(a), mantissa(b));
        let off = |x: f32| f32::from_bits(x.to_bits().wrapping_add_signed(ulps));
        let near = off(m / n);
        let q = near + off((-near).mul_add(n, m) / n);
        let left = (-q).mul_add(n, m);
        let [below, above] = [-1, 1].map(|by| f32::from_bits(q.to_bits().wrapping_add_signed(by)));
        if left + left > (above - q) * n {
            above
        } else if left + left < (below - q) * n {
            below
        } else {
            q
        }
    }

    /// The same of a root of a number in [1, 4).
    fn root(m: f32, ulps: i32) -> f32 {
        let off = |x: f32| f32::from_bits(x.to_bits().wrapping_add_signed(ulps));
        let near = off(m.sqrt());
        let s = near + off((-near).mul_add(near, m) / (near + near));
        let left = (-s).mul_add(s, m);
        let [below, above] = [-1, 1].map(|by| f32::from_bits(s.to_bits().wrapping_add_signed(by)));
        if left > (above - s) * s {
            above
        } else if left <= (below - s) * s {
            below
        } else {
            s
        }
    }

    #[test]
    fn quotients_are_rounded_to_nearest() {
        let cases = (0..200_000).map(pair);
        let edges = [1.0, 1.0f32.next_up(), 2.0f32.next_down(), 1.5, 1.0f32.next_up().next_up()];
        let of_edges = edges.iter().flat_map(|a| edges.iter().map(|b| [*a, *b]));
        for [a, b] in cases.chain(of_edges) {
            let one = |x: f32| f32::from_bits(x.to_bits() & 0x7f_ffff | 0x3f80_0000);
            for ulps in -4..=4 {
                assert_eq!(quotient(a, b, ulps), one(a) / one(b), "{a} / {b}, {ulps} ulp off");
            }
        }
    }

    #[test]
    fn roots_are_rounded_to_nearest() {
        for bits in 0x3f80_0000..0x4080_0000u32 {
            let m = f32::from_bits(bits);
            let ulps = (bits % 11) as i32 - 5;
            assert_eq!(root(m, ulps), m.sqrt(), "root of {m}, {ulps} ulp off");
        }
    }
}
