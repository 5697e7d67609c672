//! What a Vulkan device can be asked to do with denormals, infinity and NaN.

/// The modes of 32-bit floats that a device offers (`VK_KHR_shader_float_controls`).
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(super) struct FloatControls {
    /// Denormals are kept.
    pub(super) denormals: bool,
    /// Signed zeros, infinities and NaNs are kept, and no operation assumes that there are none.
    pub(super) specials: bool,
}

impl FloatControls {
    /// Returns what a device offers; nothing if it is not one of Vulkan 1.2.
    #[cfg(any(target_os = "linux", target_os = "windows", target_os = "android"))]
    pub(super) fn of(device: &wgpu::Device) -> Self {
        use ash::vk;

        // SAFETY: the device is only asked for its properties; it is neither kept nor destroyed.
        let Some(device) = (unsafe { device.as_hal::<wgpu::hal::api::Vulkan>() }) else {
            return Self::default();
        };
        let mut offered = vk::PhysicalDeviceFloatControlsProperties::default();
        let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut offered);
        // SAFETY: instance and physical device belong together and live as long as the device. The
        // function is one of Vulkan 1.1, which wgpu asks for where a driver has it; the structure of
        // version 1.2 is left alone by older drivers, and then offers nothing.
        unsafe {
            device
                .shared_instance()
                .raw_instance()
                .get_physical_device_properties2(device.raw_physical_device(), &mut properties);
        }
        if properties.properties.api_version < vk::API_VERSION_1_2 {
            return Self::default();
        }
        Self {
            denormals: offered.shader_denorm_preserve_float32 == vk::TRUE,
            specials: offered.shader_signed_zero_inf_nan_preserve_float32 == vk::TRUE,
        }
    }

    /// Returns nothing: there is no Vulkan.
    #[cfg(not(any(target_os = "linux", target_os = "windows", target_os = "android")))]
    pub(super) fn of(_: &wgpu::Device) -> Self {
        Self::default()
    }
}
