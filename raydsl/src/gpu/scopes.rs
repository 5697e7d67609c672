//! Error scopes around calls of a device.

/// One open error scope of each kind.
pub(super) struct Scopes {
    validation: wgpu::ErrorScopeGuard,
    internal: wgpu::ErrorScopeGuard,
    memory: wgpu::ErrorScopeGuard,
}

impl Scopes {
    /// Opens the scopes on this thread.
    pub(super) fn open(device: &wgpu::Device) -> Self {
        let validation = device.push_error_scope(wgpu::ErrorFilter::Validation);
        let internal = device.push_error_scope(wgpu::ErrorFilter::Internal);
        let memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        Self { validation, internal, memory }
    }

    /// Closes the scopes, innermost first, and returns what they caught, in a browser later. Out of
    /// memory goes first: the other errors are then mostly its consequences.
    pub(super) fn close(
        self,
    ) -> impl Future<Output = Option<wgpu::Error>> + wgpu::WasmNotSend + 'static {
        let (memory, internal, validation) =
            (self.memory.pop(), self.internal.pop(), self.validation.pop());
        async {
            let caught = [memory.await, internal.await, validation.await];
            caught.into_iter().flatten().next()
        }
    }
}
