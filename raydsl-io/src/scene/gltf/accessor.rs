//! Accessors: arrays of numbers within buffers.

use gltf_json::Accessor;
use gltf_json::accessor::{ComponentType, Type, sparse};
use gltf_json::validation::{Checked, USize64};
use gltf_json::{Index, buffer::View};

use super::File;
use super::buffer::Buffers;
use crate::LoadError;

/// Elements in a buffer.
struct Slots<'a> {
    bytes: &'a [u8],
    stride: usize,
}

/// The elements of an accessor; all of their bytes are there.
pub(super) struct Elements<'a> {
    count: usize,
    /// Without a buffer all are 0.
    slots: Option<Slots<'a>>,
    /// Indices, in rising order, of those that are elsewhere.
    moved: Vec<u32>,
    moved_to: Option<Slots<'a>>,
    components: usize,
    kind: ComponentType,
    normalized: bool,
}

impl<'a> Elements<'a> {
    pub(super) fn open(
        file: &File,
        buffers: &'a Buffers,
        index: Index<Accessor>,
    ) -> Result<Self, LoadError> {
        let accessor = file.get(&file.root.accessors, index, "accessors")?;
        let wrong = |what: &str| file.wrong(format!("accessors[{}]: {what}", index.value()));
        let Checked::Valid(kind) = accessor.component_type else {
            return Err(wrong("its componentType is unknown"));
        };
        let components = match accessor.type_ {
            Checked::Valid(Type::Scalar) => 1,
            Checked::Valid(Type::Vec2) => 2,
            Checked::Valid(Type::Vec3) => 3,
            Checked::Valid(Type::Vec4) => 4,
            _ => return Err(wrong("its type is no vector")),
        };
        let count = usize::try_from(accessor.count.0).unwrap_or(usize::MAX);
        if count == 0 || count >= u32::MAX as usize {
            return Err(wrong(&format!("its count is {count}")));
        }
        let size = kind.0.size() * components;
        let slots = match accessor.buffer_view {
            Some(view) => {
                let at = accessor.byte_offset.unwrap_or_default();
                Some(slots(file, buffers, view, at, size, count).map_err(|e| e.error(&wrong))?)
            }
            None if accessor.sparse.is_none() => {
                let what = format!("accessors[{}]: it has no bufferView", index.value());
                return Err(file.missing(what));
            }
            None if count as u64 > buffers.total() => {
                return Err(wrong(&format!("its count is {count}, more than the file has bytes")));
            }
            None => None,
        };
        let normalized = accessor.normalized;
        let (moved, moved_to) = (Vec::new(), None);
        let mut elements =
            Self { count, slots, moved, moved_to, components, kind: kind.0, normalized };
        if let Some(sparse) = &accessor.sparse {
            elements.read_sparse(file, buffers, sparse).map_err(|e| e.error(&wrong))?;
        }
        Ok(elements)
    }

    fn read_sparse(
        &mut self,
        file: &File,
        buffers: &'a Buffers,
        sparse: &sparse::Sparse,
    ) -> Result<(), Wrong> {
        let count = usize::try_from(sparse.count.0).ok().filter(|n| (1..=self.count).contains(n));
        let count = count.ok_or_else(|| Wrong::new("the count of its sparse part is wrong"))?;
        let (indices, values) = (&sparse.indices, &sparse.values);
        let Checked::Valid(kind) = indices.component_type else {
            return Err(Wrong::new("the componentType of its sparse indices is unknown"));
        };
        let (view, at, size) = (indices.buffer_view, indices.byte_offset, kind.0.size());
        let places = slots(file, buffers, view, at, size, count)?;
        self.moved = (0..count).map(|i| whole(places.at(i), kind.0)).collect();
        let in_order = self.moved.is_sorted_by(|a, b| a < b);
        if !in_order || self.moved.last().is_some_and(|last| *last as usize >= self.count) {
            return Err(Wrong::new("its sparse indices do not rise, or go beyond its count"));
        }
        let size = self.kind.size() * self.components;
        let to = slots(file, buffers, values.buffer_view, values.byte_offset, size, count)?;
        self.moved_to = Some(to);
        Ok(())
    }

    pub(super) fn count(&self) -> usize {
        self.count
    }

    pub(super) fn components(&self) -> usize {
        self.components
    }

    /// Whether they can be indices.
    pub(super) fn are_indices(&self) -> bool {
        let whole = [ComponentType::U8, ComponentType::U16, ComponentType::U32];
        self.components == 1 && whole.contains(&self.kind)
    }

    /// The bytes of an element below `count`; none where all are 0.
    fn bytes(&self, i: usize) -> Option<&'a [u8]> {
        if let (Some(to), false) = (&self.moved_to, self.moved.is_empty())
            && let Ok(at) = self.moved.binary_search(&(i as u32))
        {
            return Some(to.at(at));
        }
        self.slots.as_ref().map(|slots| slots.at(i))
    }

    /// An element below `count`, of which each is an index.
    pub(super) fn index(&self, i: usize) -> u32 {
        self.bytes(i).map_or(0, |bytes| whole(bytes, self.kind))
    }

    /// An element below `count`; 0 for components that it does not have.
    pub(super) fn vector<const N: usize>(&self, i: usize) -> [f32; N] {
        let mut vector = [0.0; N];
        let Some(bytes) = self.bytes(i) else { return vector };
        let parts = bytes.chunks(self.kind.size()).take(self.components);
        for (x, bytes) in vector.iter_mut().zip(parts) {
            *x = number(bytes, self.kind, self.normalized);
        }
        vector
    }
}

impl<'a> Slots<'a> {
    /// The bytes of an element; there are at least as many as its size.
    fn at(&self, i: usize) -> &'a [u8] {
        &self.bytes[i * self.stride..]
    }
}

/// What is wrong with an accessor, or with what it uses.
enum Wrong {
    Here(String),
    There(LoadError),
}

impl Wrong {
    fn new(what: impl Into<String>) -> Self {
        Self::Here(what.into())
    }

    fn error(self, wrong: &impl Fn(&str) -> LoadError) -> LoadError {
        match self {
            Self::Here(what) => wrong(&what),
            Self::There(error) => error,
        }
    }
}

/// Elements of a view, all within it.
fn slots<'a>(
    file: &File,
    buffers: &'a Buffers,
    view: Index<View>,
    at: USize64,
    size: usize,
    count: usize,
) -> Result<Slots<'a>, Wrong> {
    let view = buffers.view(file, view).map_err(Wrong::There)?;
    let stride = view.stride.unwrap_or(size);
    if stride < size {
        return Err(Wrong::new(format!("elements of {size} bytes lie {stride} apart")));
    }
    let begin = usize::try_from(at.0).ok();
    let len = (count - 1).checked_mul(stride).and_then(|n| n.checked_add(size));
    let bytes =
        begin.zip(len).and_then(|(begin, len)| view.bytes.get(begin..begin.checked_add(len)?));
    match bytes {
        Some(bytes) => Ok(Slots { bytes, stride }),
        None => Err(Wrong::new(format!(
            "{count} elements of {size} bytes, {stride} apart, from byte {} end beyond their view \
             of {} bytes",
            at.0,
            view.bytes.len()
        ))),
    }
}

/// The first bytes of a list.
fn first<const N: usize>(bytes: &[u8]) -> [u8; N] {
    bytes.first_chunk().copied().unwrap_or([0; N])
}

fn whole(bytes: &[u8], kind: ComponentType) -> u32 {
    match kind {
        ComponentType::U8 => first::<1>(bytes)[0].into(),
        ComponentType::U16 => u16::from_le_bytes(first(bytes)).into(),
        _ => u32::from_le_bytes(first(bytes)),
    }
}

fn number(bytes: &[u8], kind: ComponentType, normalized: bool) -> f32 {
    let (value, most) = match kind {
        ComponentType::F32 => return f32::from_le_bytes(first(bytes)),
        ComponentType::I8 => (f32::from(i8::from_le_bytes(first(bytes))), f32::from(i8::MAX)),
        ComponentType::U8 => (f32::from(first::<1>(bytes)[0]), f32::from(u8::MAX)),
        ComponentType::I16 => (f32::from(i16::from_le_bytes(first(bytes))), f32::from(i16::MAX)),
        ComponentType::U16 => (f32::from(u16::from_le_bytes(first(bytes))), f32::from(u16::MAX)),
        ComponentType::U32 => (u32::from_le_bytes(first(bytes)) as f32, u32::MAX as f32),
    };
    // -128 / 127 is -1, as is -127 / 127.
    if normalized { (value / most).max(-1.0) } else { value }
}
