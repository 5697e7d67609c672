//! SPIR-V of a kernel's text, whose operations a driver may not fuse or move.
//!
//! WGSL lets a driver fuse `a * b + c` and evaluate sums in any order, and has no word against it.
//! SPIR-V has the decoration `NoContraction`.

use naga::back::spv;
use naga::proc::{BoundsCheckPolicies, BoundsCheckPolicy};
use naga::valid::{Capabilities, ValidationFlags, Validator};

use super::error::{GpuError, one_line};
use super::float_controls::FloatControls;
use super::interface;
use super::pipeline::{Bindings, Checks, Sizes};

/// Words of a module before its instructions.
const HEADER: usize = 5;

const OP_EXTENSION: u32 = 10;
const OP_ENTRY_POINT: u32 = 15;
const OP_EXECUTION_MODE: u32 = 16;
const OP_CAPABILITY: u32 = 17;
const OP_DECORATE: u32 = 71;

const NO_CONTRACTION: u32 = 42;

/// A capability of `SPV_KHR_float_controls`, and its execution mode.
const DENORM_PRESERVE: (u32, u32) = (4464, 4459);
const SIGNED_ZERO_INF_NAN_PRESERVE: (u32, u32) = (4466, 4461);

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
    controls: FloatControls,
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
    Ok(Exact { words: edited(&words, controls), sizes })
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

/// Returns the words with a decoration of each operation's result, and with the modes of floats that
/// a device offers.
fn edited(words: &[u32], controls: FloatControls) -> Vec<u32> {
    let mut results = Vec::new();
    let (mut first_type, mut entry) = (words.len(), None);
    let mut at = HEADER;
    while at < words.len() {
        let (length, opcode) = ((words[at] >> 16) as usize, words[at] & 0xffff);
        if TYPES.contains(&opcode) {
            first_type = first_type.min(at);
        } else if ARITHMETIC.contains(&opcode) {
            results.push(words[at + 2]);
        } else if opcode == OP_ENTRY_POINT {
            entry = Some((words[at + 2], at + length));
        }
        at += length.max(1);
    }
    let offered =
        [(controls.denormals, DENORM_PRESERVE), (controls.specials, SIGNED_ZERO_INF_NAN_PRESERVE)];
    let modes: Vec<(u32, u32)> = offered.into_iter().filter(|m| m.0).map(|m| m.1).collect();
    let (main, entries_end) = entry.unwrap_or((0, first_type));
    let capabilities_end = capabilities_end(words);
    let mut all = words[..capabilities_end].to_vec();
    for (capability, _) in &modes {
        all.extend(instruction(OP_CAPABILITY, &[*capability]));
    }
    if !modes.is_empty() {
        all.extend(instruction(OP_EXTENSION, &text("SPV_KHR_float_controls")));
    }
    all.extend(&words[capabilities_end..entries_end]);
    for (_, mode) in &modes {
        all.extend(instruction(OP_EXECUTION_MODE, &[main, *mode, 32]));
    }
    all.extend(&words[entries_end..first_type]);
    for result in results {
        all.extend(instruction(OP_DECORATE, &[result, NO_CONTRACTION]));
    }
    all.extend(&words[first_type..]);
    all
}

/// Returns where the capabilities end, which stand first.
fn capabilities_end(words: &[u32]) -> usize {
    let mut at = HEADER;
    while at < words.len() && words[at] & 0xffff == OP_CAPABILITY {
        at += (words[at] >> 16).max(1) as usize;
    }
    at
}

fn instruction(opcode: u32, operands: &[u32]) -> Vec<u32> {
    let length = operands.len() as u32 + 1;
    [length << 16 | opcode].into_iter().chain(operands.iter().copied()).collect()
}

/// Returns a text as SPIR-V has it: bytes, and at least one zero behind them.
fn text(text: &str) -> Vec<u32> {
    let mut bytes = text.as_bytes().to_vec();
    bytes.resize((bytes.len() + 1).next_multiple_of(4), 0);
    bytes.chunks_exact(4).map(|c| u32::from_le_bytes([c[0], c[1], c[2], c[3]])).collect()
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
