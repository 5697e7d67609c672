//! Type layouts: names, members and offsets.

/// The layout of a [`Type`](super::Type), for the recorder and the GPU.
///
/// It describes both the *value* in a kernel (an 8-bit unorm is a `u32` in WGSL) and its *storage*
/// in the host's memory (one byte).
#[derive(Debug, PartialEq)]
pub enum Schema {
    /// `f32`.
    F32,
    /// `i32`.
    I32,
    /// `u32`.
    U32,
    /// `bool`: a byte in memory.
    Bool,
    /// An unsigned number of 1 or 2 bytes in memory, `u32` in a kernel.
    Small {
        /// Bytes in memory: 1 or 2.
        bytes: usize,
    },
    /// The number of an enum's variant, a `u32`.
    Kind {
        /// The number of variants.
        count: u32,
    },
    /// A vector of glam: that many scalars (of the first part) without a gap.
    Vector(&'static Schema, usize),
    /// `[T; N]`.
    Array {
        /// The element's layout.
        element: &'static Schema,
        /// The number of elements.
        count: usize,
        /// Bytes from one to the next.
        stride: usize,
    },
    /// A struct or tuple.
    Struct {
        /// The struct's name.
        name: &'static str,
        /// Its members in order of declaration.
        fields: &'static [Field],
        /// Bytes from one to the next in an array.
        size: usize,
    },
    /// A value of the host that leaves no trace in generated code.
    Host,
}

/// A member of a struct.
#[derive(Debug, PartialEq)]
pub struct Field {
    /// The member's name.
    pub name: &'static str,
    /// Its distance in bytes from the start of the struct.
    pub offset: usize,
    /// Its layout.
    pub schema: &'static Schema,
}

impl Schema {
    /// Returns the number of scalars in a value.
    pub const fn leaves(&self) -> usize {
        match self {
            Self::F32
            | Self::I32
            | Self::U32
            | Self::Bool
            | Self::Small { .. }
            | Self::Kind { .. } => 1,
            Self::Vector(_, n) => *n,
            Self::Array { element, count, .. } => element.leaves() * *count,
            Self::Struct { fields, .. } => {
                let (mut sum, mut i) = (0, 0);
                while i < fields.len() {
                    sum += fields[i].schema.leaves();
                    i += 1;
                }
                sum
            }
            Self::Host => 0,
        }
    }

    /// Returns whether the number of an enum's variant is among the scalars.
    pub(crate) const fn has_kinds(&self) -> bool {
        match self {
            Self::Kind { .. } => true,
            Self::Array { element, .. } => element.has_kinds(),
            Self::Struct { fields, .. } => {
                let mut i = 0;
                while i < fields.len() {
                    if fields[i].schema.has_kinds() {
                        return true;
                    }
                    i += 1;
                }
                false
            }
            _ => false,
        }
    }

    /// Returns whether a value has leaves and each is an `f32`.
    pub(crate) const fn is_of_floats(&self) -> bool {
        match self {
            Self::F32 => true,
            Self::Vector(element, _) => element.is_of_floats(),
            Self::Struct { fields, .. } => {
                let mut i = 0;
                while i < fields.len() {
                    if !fields[i].schema.is_of_floats() {
                        return false;
                    }
                    i += 1;
                }
                i > 0
            }
            _ => false,
        }
    }

    /// Returns the bytes of one value in the host's memory, including padding at the end.
    pub const fn size(&self) -> usize {
        match self {
            Self::F32 | Self::I32 | Self::U32 | Self::Kind { .. } => 4,
            Self::Bool => 1,
            Self::Small { bytes } => *bytes,
            Self::Vector(element, n) => element.size() * *n,
            Self::Array { count, stride, .. } => *count * *stride,
            Self::Struct { size, .. } => *size,
            Self::Host => 0,
        }
    }
}

/// Where the members of a struct or a tuple lie in buffers.
#[derive(Clone, Copy, Debug)]
pub struct Places<const N: usize> {
    /// The offset of each member in bytes.
    pub offsets: [usize; N],
    /// Bytes from one value to the next.
    pub size: usize,
}

impl<const N: usize> Places<N> {
    /// Returns the host's places, `size` and `offsets`, unless the layout of a member is larger than
    /// its host's size, as that of an enum with fields may be. Then members follow each other in
    /// whole words.
    pub const fn new(
        size: usize,
        offsets: [usize; N],
        sizes: [usize; N],
        schemas: [&Schema; N],
    ) -> Self {
        let (mut all, mut end, mut fits, mut i) = ([0; N], 0, true, 0);
        while i < N {
            all[i] = end;
            end += schemas[i].size().next_multiple_of(4);
            fits &= schemas[i].size() <= sizes[i];
            i += 1;
        }
        if fits { Self { offsets, size } } else { Self { offsets: all, size: end } }
    }
}

/// Returns the bytes from one element of an array to the next.
pub(super) const fn stride_of<T: super::Type>() -> usize {
    let (host, own) = (size_of::<T>(), T::SCHEMA.size());
    if own > host { own.next_multiple_of(4) } else { host }
}
