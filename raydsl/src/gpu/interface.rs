//! The check of a shader against the layout of its pipeline.
//!
//! wgpu makes it for shaders that it translates; those that it passes on to the driver are checked
//! here, since a driver that is given another layout than a shader has may do anything.

use std::num::NonZeroU64;

use naga::{AddressSpace, ImageClass, ImageDimension, StorageAccess, TypeInner};

use super::error::GpuError;
use super::pipeline::{Bindings, Sampled, Sizes};

/// Checks that a module's entry point and bindings are those of a kernel with this layout.
///
/// # Errors
///
/// [`GpuError::PipelineFailed`] names the first that is not.
pub(super) fn check(
    module: &naga::Module,
    bindings: &Bindings,
    limits: &wgpu::Limits,
) -> Result<Sizes, GpuError> {
    check_entry_point(module, limits)?;
    check_workgroup_memory(module, limits)?;
    let mut sizes = Sizes::new();
    for (_, variable) in module.global_variables.iter() {
        let fail = |why: &str| {
            let name = variable.name.as_deref().unwrap_or("a binding");
            Err(failed(&format!("`{name}` {why}")))
        };
        let inner = &module.types[variable.ty].inner;
        let Some(binding) = &variable.binding else {
            match variable.space {
                AddressSpace::Private | AddressSpace::WorkGroup => continue,
                _ => return fail("has no binding"),
            }
        };
        if binding.group != 0 {
            return fail("is in another bind group than 0");
        }
        let number = binding.binding;
        if !fits(variable.space, inner, number, bindings) {
            return fail("is not what the layout has at its binding");
        }
        if variable.space != AddressSpace::Handle {
            let size = u64::from(inner.size(module.to_ctx()));
            sizes.extend(NonZeroU64::new(size).map(|size| (number, size)));
        }
    }
    Ok(sizes)
}

fn check_entry_point(module: &naga::Module, limits: &wgpu::Limits) -> Result<(), GpuError> {
    let is_main = |e: &&naga::EntryPoint| e.name == "main" && e.stage == naga::ShaderStage::Compute;
    let Some(main) = module.entry_points.iter().find(is_main) else {
        return Err(failed("the shader has no compute entry point `main`"));
    };
    let most = [
        limits.max_compute_workgroup_size_x,
        limits.max_compute_workgroup_size_y,
        limits.max_compute_workgroup_size_z,
    ];
    let size = main.workgroup_size;
    let invocations = size.iter().map(|n| u64::from(*n)).product::<u64>();
    let is_within = size.iter().zip(most).all(|(n, most)| (1..=most).contains(n));
    if is_within && invocations <= u64::from(limits.max_compute_invocations_per_workgroup) {
        return Ok(());
    }
    Err(failed(&format!(
        "a workgroup of {size:?} is too large: {most:?} and {} invocations are allowed",
        limits.max_compute_invocations_per_workgroup
    )))
}

fn check_workgroup_memory(module: &naga::Module, limits: &wgpu::Limits) -> Result<(), GpuError> {
    let shared = module.global_variables.iter().map(|(_, variable)| variable);
    let shared = shared.filter(|variable| variable.space == AddressSpace::WorkGroup);
    // Each is aligned to 16 bytes, as wgpu counts them.
    let of = |variable: &naga::GlobalVariable| {
        u64::from(module.types[variable.ty].inner.size(module.to_ctx())).next_multiple_of(16)
    };
    let (bytes, limit) = (shared.map(of).sum::<u64>(), limits.max_compute_workgroup_storage_size);
    if bytes <= u64::from(limit) {
        return Ok(());
    }
    Err(failed(&format!("a workgroup has {bytes} bytes, more than the {limit} that are allowed")))
}

/// Returns whether a variable is what the layout has at its binding.
fn fits(space: AddressSpace, inner: &TypeInner, number: u32, bindings: &Bindings) -> bool {
    let is_number = number == 0 || number == 1;
    let is_stored = number == 0 && bindings.has_stored_parameters;
    match space {
        AddressSpace::Uniform => is_number && !is_stored,
        AddressSpace::Storage { access } => {
            let is_read = !access.intersects(StorageAccess::STORE | StorageAccess::ATOMIC);
            let storage = bindings.storage.iter().find(|storage| storage.binding == number);
            storage.map_or(is_stored && is_read, |storage| is_read || !storage.read_only)
        }
        AddressSpace::Handle => {
            bindings.sampled.iter().any(|sampled| is_of(sampled, inner, number))
        }
        _ => false,
    }
}

/// Returns whether a variable is a texture, or its sampler.
fn is_of(sampled: &Sampled, inner: &TypeInner, number: u32) -> bool {
    match inner {
        TypeInner::Image {
            dim,
            arrayed: false,
            class: ImageClass::Sampled { kind: naga::ScalarKind::Float, multi: false },
        } => {
            let expected = if sampled.is_volume { ImageDimension::D3 } else { ImageDimension::D2 };
            number == sampled.binding && *dim == expected
        }
        TypeInner::Sampler { comparison: false } => number == sampled.binding + 1,
        _ => false,
    }
}

fn failed(message: &str) -> GpuError {
    GpuError::PipelineFailed { message: message.to_owned() }
}
