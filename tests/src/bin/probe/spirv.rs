//! SPIR-V whose operations may not be contracted.

use naga::back::spv;

use crate::device::Error;

/// The first words of a module, before its instructions.
const HEADER: usize = 5;
const OP_DECORATE: u32 = 71;
const NO_CONTRACTION: u32 = 42;

/// Operations on floats that a driver may contract with others: negation, sums, differences,
/// products, quotients, a vector times a scalar, products of matrices, and dot products.
const ARITHMETIC: [u32; 11] = [127, 129, 131, 133, 136, 142, 143, 144, 145, 146, 148];

/// The opcodes of types; decorations stand before the first of them.
const TYPES: std::ops::RangeInclusive<u32> = 19..=39;

/// Returns naga's SPIR-V of a WGSL module, with `NoContraction` at each operation.
pub(crate) fn without_contraction(source: &str) -> Result<Vec<u32>, Error> {
    let module = naga::front::wgsl::parse_str(source)?;
    let all = naga::valid::Capabilities::all();
    let info = naga::valid::Validator::new(naga::valid::ValidationFlags::all(), all)
        .validate(&module)
        .map_err(|error| error.emit_to_string(source))?;
    let bound = |binding| {
        let place = naga::ResourceBinding { group: 0, binding };
        let info = spv::BindingInfo { descriptor_set: 0, binding, binding_array_size: None };
        (place, info)
    };
    let options = spv::Options {
        lang_version: (1, 3),
        flags: spv::WriterFlags::empty(),
        binding_map: [bound(0), bound(1)].into_iter().collect(),
        ..Default::default()
    };
    let entry = spv::PipelineOptions {
        shader_stage: naga::ShaderStage::Compute,
        entry_point: "main".to_owned(),
    };
    let words = spv::write_vec(&module, &info, &options, Some(&entry))?;
    Ok(decorated(&words))
}

/// Returns the words with a decoration for the result of each operation.
fn decorated(words: &[u32]) -> Vec<u32> {
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
