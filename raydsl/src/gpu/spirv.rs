//! SPIR-V of a kernel's text, whose operations a driver may not fuse or move.
//!
//! WGSL lets a driver fuse `a * b + c` and evaluate sums in any order, and has no word against it.
//! SPIR-V has the decoration `NoContraction`.

use naga::back::spv;
use naga::proc::{BoundsCheckPolicies, BoundsCheckPolicy};
use naga::valid::{Capabilities, ValidationFlags, Validator};

use super::error::{GpuError, one_line};
use super::interface::{self, Sizes};
use super::pipeline::{Bindings, Checks};

/// Words of a module before its instructions.
const HEADER: usize = 5;
const OP_DECORATE: u32 = 71;
const NO_CONTRACTION: u32 = 42;

/// The operations on floats that may be contracted: negation, sum, difference, product, quotient,
/// remainders, products with vectors and matrices, dot product.
const ARITHMETIC: [u32; 13] = [127, 129, 131, 133, 136, 140, 141, 142, 143, 144, 145, 146, 148];

/// The opcodes of types. Decorations stand before the first type.
const TYPES: std::ops::RangeInclusive<u32> = 19..=39;

/// A kernel's SPIR-V.
pub(super) struct Exact {
    pub(super) words: Vec<u32>,
    /// The least bytes that its buffers must have.
    pub(super) sizes: Sizes,
}

/// Returns the SPIR-V of a kernel's text, validated, for a layout with these bindings.
///
/// # Errors
///
/// [`GpuError::ShaderInvalid`] if naga refuses the text, [`GpuError::PipelineFailed`] if its bindings
/// or its entry point are others.
pub(super) fn exact(
    source: &str,
    checks: Checks,
    bindings: &Bindings,
    limits: &wgpu::Limits,
) -> Result<Exact, GpuError> {
    let parsed = naga::front::wgsl::parse_str(source);
    let module = parsed.map_err(|e| invalid(source, e.location(source), e.message()))?;
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty()).validate(&module);
    let info = info.map_err(|e| invalid(source, e.location(source), &with_causes(e.as_inner())))?;
    let sizes = interface::check(&module, bindings, limits)?;
    let policy = match checks {
        Checks::Full => BoundsCheckPolicy::Restrict,
        Checks::Trusted => BoundsCheckPolicy::Unchecked,
    };
    let options = spv::Options {
        flags: spv::WriterFlags::empty(),
        fake_missing_bindings: false,
        binding_map: binding_map(bindings),
        bounds_check_policies: BoundsCheckPolicies {
            index: policy,
            buffer: policy,
            image_load: policy,
            binding_array: policy,
        },
        ..Default::default()
    };
    let entry = spv::PipelineOptions {
        shader_stage: naga::ShaderStage::Compute,
        entry_point: "main".to_owned(),
    };
    let words = spv::write_vec(&module, &info, &options, Some(&entry));
    let words = words.map_err(|error| invalid(source, None, &error.to_string()))?;
    Ok(Exact { words: without_contraction(&words), sizes })
}

/// Returns where each binding is in Vulkan's layout: wgpu numbers them by their order.
fn binding_map(bindings: &Bindings) -> spv::BindingMap {
    let place = |(i, binding): (usize, u32)| {
        let info =
            spv::BindingInfo { descriptor_set: 0, binding: i as u32, binding_array_size: None };
        (naga::ResourceBinding { group: 0, binding }, info)
    };
    bindings.numbers().into_iter().enumerate().map(place).collect()
}

/// Returns the words with a decoration of each operation's result.
fn without_contraction(words: &[u32]) -> Vec<u32> {
    let mut results = Vec::new();
    let mut first_type = words.len();
    let mut at = HEADER;
    while at < words.len() {
        let (length, opcode) = ((words[at] >> 16) as usize, words[at] & 0xffff);
        if TYPES.contains(&opcode) {
            first_type = first_type.min(at);
        }
        if ARITHMETIC.contains(&opcode) {
            results.push(words[at + 2]);
        }
        at += length.max(1);
    }
    let decorations = results.iter().flat_map(|id| [3 << 16 | OP_DECORATE, *id, NO_CONTRACTION]);
    let (head, rest) = words.split_at(first_type);
    head.iter().copied().chain(decorations).chain(rest.iter().copied()).collect()
}

/// Returns an error's text with those of its causes.
fn with_causes(error: &dyn std::error::Error) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        text += &format!(": {error}");
        cause = error.source();
    }
    text
}

fn invalid(source: &str, location: Option<naga::SourceLocation>, message: &str) -> GpuError {
    let line = location.map_or(0, |location| location.line_number);
    let text = source.lines().nth((line as usize).wrapping_sub(1)).unwrap_or_default();
    GpuError::ShaderInvalid { message: one_line(message), line, text: text.trim().to_owned() }
}
