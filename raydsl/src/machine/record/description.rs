//! Descriptions of what a kernel captures, as far as a recording depends on it.

use super::{Builder, Recorder, storage};
use crate::machine::{Data, KernelInfo, Resource, Schema, Type as _, wgsl::BufferKey};

/// What a kernel captures: numbers and buffers under their names, and the facts that decide what is
/// recorded.
///
/// Kernels of one closure with the same facts have the same recording but for numbers and buffers,
/// which are found by their names. A resource that does not describe itself leaves a description
/// open: such a kernel is recorded for itself.
pub struct Description {
    /// What it captures is in its uniforms and buffers.
    pub(super) m: Recorder,
    pub(super) facts: Vec<u64>,
    pub(super) is_open: bool,
}

impl Default for Description {
    fn default() -> Self {
        static INFO: KernelInfo =
            KernelInfo { name: "captures", file: file!(), line: line!(), params: &[], known: None };
        let m = Recorder::default();
        m.state.borrow_mut().open.push(Builder::new(&INFO));
        Self { m, facts: Vec::new(), is_open: false }
    }
}

impl Description {
    /// Says that there is more than can be described.
    pub fn leave_open(&mut self) {
        self.is_open = true;
    }

    /// Adds what a branch of the host decides by while a kernel is recorded.
    pub fn fact(&mut self, fact: u64) {
        self.facts.push(fact);
    }

    /// Adds a value, given in its memory layout.
    pub(crate) fn value(&mut self, name: &str, schema: &'static Schema, bytes: &[u8]) {
        storage::uniforms(&self.m, name, schema, bytes, &mut Vec::new());
        self.variants(schema, bytes);
    }

    /// Adds the numbers of an enum's variants, which are known while a kernel is recorded.
    fn variants(&mut self, schema: &'static Schema, bytes: &[u8]) {
        match schema {
            Schema::Kind { .. } => {
                let number = bytes.first_chunk().map_or(0, |word| u32::from_le_bytes(*word));
                self.fact(number.into());
            }
            Schema::Array { element, count, stride } => {
                (0..*count).for_each(|i| self.variants(element, &bytes[i * stride..]));
            }
            Schema::Struct { fields, .. } => {
                fields.iter().for_each(|f| self.variants(f.schema, &bytes[f.offset..]));
            }
            _ => {}
        }
    }

    /// Adds a buffer. Two that are one now may be two in another kernel, so that is a fact too.
    pub(crate) fn buffer(&mut self, key: BufferKey, name: &str, schema: &'static Schema, len: u64) {
        let name = self.m.buffer(key, name, schema, len);
        let at = self.m.state.borrow().buffers.iter().position(|b| b.name == name);
        self.fact(at.map_or(u64::MAX, |at| at as u64 * 2 + u64::from(len == 0)));
    }

    /// Adds the elements of a slice, or of a scene, with the kinds of enums among them, of which the
    /// text has the arms.
    pub(crate) fn data<D: Data>(&mut self, data: &D) {
        self.buffer(data.key(), &data.name(), D::Element::SCHEMA, data.count() as u64);
        for kinds in self.m.kinds_of_data(data) {
            self.fact(kinds.bits());
        }
    }

    /// Adds a constant: all that it describes are facts.
    pub(crate) fn constant(&mut self, resource: &dyn Resource) {
        let mut own = Self::default();
        resource.describe(&mut own);
        let state = own.m.state.into_inner();
        let words = state.uniforms.iter().flat_map(|u| &u.words).map(|w| u64::from(*w));
        self.facts.extend(words);
        self.facts.extend(state.buffers.iter().flat_map(|b| {
            let (version, part) = (u64::from(b.key.version), u64::from(b.key.part));
            [b.key.id, version << 32 | part, b.len]
        }));
        self.facts.append(&mut own.facts);
        self.is_open |= own.is_open;
    }

    /// Returns the facts, unless the description is open.
    #[cfg(feature = "gpu")]
    pub(super) fn closed_facts(&self) -> Option<&[u64]> {
        let is_closed = !self.is_open && !self.m.state.borrow().is_renamed;
        is_closed.then_some(&self.facts[..])
    }
}
