//! Host data in WGSL: a storage buffer and its accessor functions.

use super::Recorder;
use crate::machine::{Data, Schema, Type};

impl Recorder {
    /// Returns the function `fn points_at(i: u32) -> ColorSphere`; the accessor itself is printed
    /// with the buffer.
    pub(crate) fn fetch_function<D: Data>(&self, data: &D) -> usize {
        self.at_function(&self.buffer_of(data), D::Element::SCHEMA)
    }

    pub(crate) fn at_function(&self, buffer: &str, schema: &'static Schema) -> usize {
        self.text_function(format!("{buffer}_at"), vec![schema], &|_| String::new())
    }

    /// Returns the function `fn points_len() -> u32`.
    pub(crate) fn len_function<D: Data>(&self, data: &D) -> usize {
        self.len_of_buffer(&self.buffer_of(data))
    }

    pub(crate) fn len_of_buffer(&self, buffer: &str) -> usize {
        self.text_function(format!("{buffer}_len"), vec![], &|name| {
            format!("fn {name}() -> u32 {{\n    return params.len_of_{buffer};\n}}\n")
        })
    }

    /// Returns the function `fn points_element(i: u32) -> ColorSphere`, for any `i`; it too is
    /// printed with the buffer.
    pub(crate) fn element_function<D: Data>(&self, data: &D) -> usize {
        let name = format!("{}_element", self.buffer_of(data));
        self.text_function(name, vec![D::Element::SCHEMA], &|_| String::new())
    }

    /// Returns the name of the buffer of elements.
    pub(crate) fn buffer_of<D: Data>(&self, data: &D) -> String {
        self.buffer(data.key(), &data.name(), D::Element::SCHEMA, data.count() as u64)
    }
}
