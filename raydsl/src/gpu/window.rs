//! Windows: slices and primitives stored in the application's own buffers.

use std::fmt;
use std::marker::PhantomData;
use std::panic::{AssertUnwindSafe, catch_unwind};

use super::device::{Gpu, lock};
use super::error::GpuError;
use super::{Context, GpuScheduler};
use crate::bvh::{Bvh, BvhList, Instances, View};
use crate::geometry::{Primitive, Shared};
use crate::machine::wgsl::BufferKey;
use crate::machine::{Data, Slice, Type, borrowed_key, stride};

/// A part of a buffer of the application: `size` bytes from `offset`.
#[derive(Clone, Debug)]
pub struct GpuWindow {
    /// A buffer of the context's device, created with `BufferUsages::STORAGE`.
    pub buffer: wgpu::Buffer,
    /// The offset of the first element: a multiple of `min_storage_buffer_offset_alignment`.
    pub offset: u64,
    /// The bytes of all elements, one after another in the slice's memory layout.
    pub size: u64,
}

/// Host data that a [`GpuWindow`] may replace: a slice, the primitives of a tree, or of the trees
/// of a list or a scene of instances (those of the first tree first), or data that primitives
/// share, as in `bvh.view().shared()`.
pub trait OnHost {
    /// The element type.
    type Element: Type;

    #[doc(hidden)]
    fn buffer(&self) -> (BufferKey, usize);
}

impl<D: OnHost + ?Sized> OnHost for &D {
    type Element = D::Element;

    fn buffer(&self) -> (BufferKey, usize) {
        D::buffer(self)
    }
}

// Only references: the address identifies the elements while they are borrowed.
impl<T: Type> OnHost for &[T] {
    type Element = T;

    fn buffer(&self) -> (BufferKey, usize) {
        (borrowed_key(self), self.len())
    }
}

impl<T: Type> OnHost for &Vec<T> {
    type Element = T;

    fn buffer(&self) -> (BufferKey, usize) {
        self.as_slice().buffer()
    }
}

impl<T: Type, const N: usize> OnHost for &[T; N] {
    type Element = T;

    fn buffer(&self) -> (BufferKey, usize) {
        self.as_slice().buffer()
    }
}

impl<T: Type, S: Shared> OnHost for View<'_, T, S> {
    type Element = T;

    fn buffer(&self) -> (BufferKey, usize) {
        (self.key(), self.len())
    }
}

impl<T: Type> OnHost for Slice<'_, T> {
    type Element = T;

    fn buffer(&self) -> (BufferKey, usize) {
        (self.key(), self.len())
    }
}

impl<P: Primitive> OnHost for Bvh<'_, P> {
    type Element = P;

    fn buffer(&self) -> (BufferKey, usize) {
        self.view().buffer()
    }
}

impl<P: Primitive> OnHost for BvhList<'_, P> {
    type Element = P;

    fn buffer(&self) -> (BufferKey, usize) {
        self.view().buffer()
    }
}

impl<P: Primitive> OnHost for Instances<'_, P> {
    type Element = P;

    fn buffer(&self) -> (BufferKey, usize) {
        self.view().buffer()
    }
}

/// The reason why a window cannot replace a slice.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum WindowError {
    /// The buffer cannot be read by kernels.
    #[error("the buffer has no BufferUsages::STORAGE: create it with that")]
    NotStorage,
    /// The buffer cannot be written to.
    #[error("the buffer has no BufferUsages::COPY_DST: create it with that, and with STORAGE")]
    NotCopyDst,
    /// The window's offset is not aligned for a binding.
    #[error(
        "its offset {offset} is no multiple of {limit}, the device's \
         min_storage_buffer_offset_alignment: put the first element at a multiple of that"
    )]
    Unaligned {
        /// The window's offset.
        offset: u64,
        /// The required alignment.
        limit: u64,
    },
    /// The window extends past its buffer.
    #[error("{size} bytes from {offset} on run past the buffer's end at {limit}: make it larger")]
    PastEnd {
        /// The window's offset.
        offset: u64,
        /// The window's size.
        size: u64,
        /// The buffer's size.
        limit: u64,
    },
    /// The window does not have the size of the slice.
    #[error(
        "it has {size} bytes, but the data is {len} elements of {stride} bytes, together {needed}: \
         give a window of that size, with the elements as they lie in memory"
    )]
    WrongSize {
        /// The window's size.
        size: u64,
        /// The number of elements of the slice.
        len: u64,
        /// Bytes from one element to the next.
        stride: u64,
        /// The bytes of all elements.
        needed: u64,
    },
    /// The slice is empty: it needs no buffer, and has no address of its own.
    #[error("the data is empty: kernels read nothing of it, leave the window out")]
    Empty,
    /// The slice already has a window.
    #[error("the data has a window already: drop that one first")]
    Taken,
    /// The device refuses the buffer.
    #[error(
        "the device does not take the buffer ({message}): create it with Context::device(), and do \
         not destroy it"
    )]
    Foreign {
        /// wgpu's message.
        message: String,
    },
}

/// A guard while which kernels read the slice from the application's buffer; see
/// [`GpuScheduler::with_gpu`].
#[must_use = "the window is in use while this lives"]
pub struct OnGpu<'a> {
    context: &'a Context,
    key: BufferKey,
    data: PhantomData<&'a ()>,
}

impl Drop for OnGpu<'_> {
    fn drop(&mut self) {
        lock(&self.context.uploads).leave_window(self.key);
    }
}

impl fmt::Debug for OnGpu<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("OnGpu").field("key", &self.key).finish_non_exhaustive()
    }
}

impl GpuScheduler {
    /// Makes kernels that read `data` read `window` instead, as long as the result lives. Nothing
    /// of the data is uploaded, except a tree's nodes and indices. Of a [wide
    /// tree](crate::bvh::Bvh::build_wide) its leaves are uploaded too, which are copies of the
    /// primitives: over data that is on the device build a binary tree.
    ///
    /// The window must hold the same data, in the same memory layout; this is not checked. The CPU
    /// variants still read the host's data. Another slice of the same elements, such as a part, is
    /// not replaced and is uploaded as usual, and so is a slice under a tree if a kernel captures
    /// the slice itself.
    ///
    /// Create the buffer with [`Context::device`]. A buffer of another device of the same
    /// `wgpu::Instance` is always refused. Instances number their buffers independently, so a
    /// buffer of another instance is refused only if its number is not in use.
    ///
    /// # Errors
    ///
    /// [`GpuError::Window`] if the window cannot be bound, has another size, or the buffer belongs
    /// to another device.
    pub fn with_gpu<'a, D: OnHost + 'a>(
        &'a self,
        data: D,
        window: GpuWindow,
    ) -> Result<OnGpu<'a>, GpuError> {
        let context = self.context();
        let (key, len) = data.buffer();
        check(&context.gpu, len as u64, stride(D::Element::SCHEMA) as u64, &window)
            .and_then(|()| lock(&context.uploads).enter_window(key, window))
            .map_err(|problem| GpuError::Window {
                element: core::any::type_name::<D::Element>(),
                problem,
            })?;
        Ok(OnGpu { context, key, data: PhantomData })
    }
}

/// Checks that `len` elements of `T` can be written to the window.
pub(super) fn check_target<T: Type>(
    gpu: &Gpu,
    len: u64,
    window: &GpuWindow,
) -> Result<(), GpuError> {
    let is_writable = window.buffer.usage().contains(wgpu::BufferUsages::COPY_DST);
    let can_hold = is_writable.then_some(()).ok_or(WindowError::NotCopyDst);
    can_hold
        .and_then(|()| check(gpu, len, stride(T::SCHEMA) as u64, window))
        .map_err(|problem| GpuError::Window { element: core::any::type_name::<T>(), problem })
}

/// Checks that the window can replace `len` elements of `stride` bytes.
fn check(gpu: &Gpu, len: u64, stride: u64, window: &GpuWindow) -> Result<(), WindowError> {
    let GpuWindow { buffer, offset, size } = window;
    let (offset, size, limit) = (*offset, *size, gpu.caps.alignment);
    let needed = len.saturating_mul(stride);
    if len == 0 {
        return Err(WindowError::Empty);
    }
    if !buffer.usage().contains(wgpu::BufferUsages::STORAGE) {
        return Err(WindowError::NotStorage);
    }
    if !offset.is_multiple_of(limit) {
        return Err(WindowError::Unaligned { offset, limit });
    }
    if size != needed {
        return Err(WindowError::WrongSize { size, len, stride, needed });
    }
    if offset.checked_add(size).is_none_or(|end| end > buffer.size()) {
        return Err(WindowError::PastEnd { offset, size, limit: buffer.size() });
    }
    try_binding(gpu, buffer, offset, size.min(gpu.caps.max_binding & !3))
}

/// Binds the window once: only wgpu knows which device the buffer belongs to, and whether it still
/// exists.
fn try_binding(
    gpu: &Gpu,
    buffer: &wgpu::Buffer,
    offset: u64,
    size: u64,
) -> Result<(), WindowError> {
    let bound = gpu.guarded("a window", || {
        let layout = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("a window"),
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::COMPUTE,
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Storage { read_only: true },
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                count: None,
            }],
        });
        let resource = wgpu::BindingResource::Buffer(wgpu::BufferBinding {
            buffer,
            offset,
            size: wgpu::BufferSize::new(size),
        });
        // wgpu panics for a number unknown to the device's instance.
        catch_unwind(AssertUnwindSafe(|| {
            gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("a window"),
                layout: &layout,
                entries: &[wgpu::BindGroupEntry { binding: 0, resource }],
            })
        }))
    });
    let foreign = "it belongs to another instance of wgpu";
    match bound {
        Ok(Ok(_)) => Ok(()),
        Ok(Err(_)) => Err(WindowError::Foreign { message: foreign.to_owned() }),
        Err(GpuError::Rejected { message, .. }) => Err(WindowError::Foreign { message }),
        Err(error) => Err(WindowError::Foreign { message: error.to_string() }),
    }
}
