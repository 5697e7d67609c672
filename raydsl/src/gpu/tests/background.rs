//! Tests of compilation on threads of their own.

use std::sync::Arc;
use std::time::{Duration, Instant};

use super::kernels::grind;
use crate::gpu::background::Background;
use crate::gpu::{Context, GpuError};
use crate::machine::wgsl::Module;

/// Asks until nothing is pending.
fn end(background: &Background, context: &Arc<Context>, module: &Module) -> Result<(), GpuError> {
    let start = Instant::now();
    while background.pending(context, &|| module.clone())?.is_some() {
        assert!(start.elapsed() < Duration::from_secs(300), "it ends");
        std::thread::sleep(Duration::from_millis(1));
    }
    Ok(())
}

fn broken(context: &str) -> Module {
    let mut module = grind(1);
    module.source = module.source.replace("hash(value)", "hsah(value)") + context;
    module
}

#[test]
fn a_pipeline_is_compiled_once() {
    let Some(context) = super::context().map(Arc::new) else { return };
    let background = Background::default();
    assert!(matches!(background.pending(&context, &|| grind(1)), Ok(Some(_))));
    assert_eq!(end(&background, &context, &grind(1)), Ok(()));
    assert_eq!(context.compiled(), 1);
    assert_eq!(end(&background, &context, &grind(1)), Ok(()));
    assert_eq!(context.compiled(), 1);
    // After all pipelines are gone it begins anew.
    context.pipelines.clear();
    assert_eq!(end(&background, &context, &grind(1)), Ok(()));
    assert_eq!(context.compiled(), 2);
}

/// A text that is refused stays refused, also where kernels take turns, and does not compile for ever.
#[test]
fn refusals_are_told_each_time() {
    let Some(context) = super::context().map(Arc::new) else { return };
    let background = Background::default();
    for round in 0..4 {
        for module in [broken(""), broken("\n"), grind(1)] {
            let is_broken = module.source.contains("hsah");
            match end(&background, &context, &module) {
                Err(GpuError::ShaderInvalid { .. }) => assert!(is_broken, "round {round}"),
                other => assert!(!is_broken && other.is_ok(), "round {round}: {other:?}"),
            }
        }
    }
    for i in 0..40 {
        let refused = end(&background, &context, &broken(&"\n".repeat(i)));
        assert!(matches!(refused, Err(GpuError::ShaderInvalid { .. })), "{i}: {refused:?}");
    }
    assert_eq!(context.compiled(), 1);
}

#[test]
fn a_lost_device_is_told() {
    let Some(context) = super::context().map(Arc::new) else { return };
    context.device().destroy();
    let lost = end(&Background::default(), &context, &grind(1));
    assert!(matches!(lost, Err(GpuError::DeviceLost { .. })), "{lost:?}");
}

#[test]
fn dropping_waits_for_threads() {
    let Some(context) = super::context().map(Arc::new) else { return };
    let background = Background::default();
    assert!(matches!(background.pending(&context, &|| grind(1)), Ok(Some(_))));
    drop(background);
    assert_eq!(Arc::strong_count(&context), 1, "no thread has it");
}
