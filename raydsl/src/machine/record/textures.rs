//! Textures sampled by the device.

use core::fmt::Write;

use super::Recorder;
use super::ir::{Expr, Id, Scalar, Type};
use super::names::{safe_name, unique};
use crate::machine::Machine;
use crate::machine::wgsl::{BufferKey, Texture, TextureLayout};

/// Sampled textures and samplers per shader stage that WebGPU guarantees.
const MOST: usize = 16;

impl Recorder {
    /// Returns the leaves of `tiles_sample(at, level)`, the device's sampler; at level 0 if no
    /// other is given. Returns `None` if there are too many textures.
    ///
    /// Axes missing in `at` are sampled in the middle.
    pub(crate) fn sample(
        &self,
        key: BufferKey,
        name: &str,
        layout: &TextureLayout,
        at: &[Id],
        level: Option<Id>,
    ) -> Option<[Id; 4]> {
        let level = level.unwrap_or_else(|| self.f32(0.0));
        let middle = self.f32(0.5);
        let place = [*at.first()?, at.get(1).copied().unwrap_or(middle), *at.last()?];
        let at = &place[..if layout.is_volume { 3 } else { 2 }];
        let name = self.texture(key, name, layout)?;
        let n = at.len();
        let function = self.text_function(format!("{name}_sample"), vec![], &|function| {
            format!(
                "fn {function}(at: vec{n}<f32>, level: f32) -> vec4<f32> {{\n    \
                 return textureSampleLevel({name}_texture, {name}_sampler, at, level);\n}}\n"
            )
        });
        let at = self.vector(at);
        let call = self.add(Expr::Call(function, vec![at, level]), Type::Vector(Scalar::F32, 4));
        Some(["x", "y", "z", "w"].map(|c| self.add(Expr::Member(call, c), Type::F32)))
    }

    /// Returns the name of a texture; the same texels sampled in the same way are the same texture.
    fn texture(&self, key: BufferKey, name: &str, layout: &TextureLayout) -> Option<String> {
        let mut state = self.state.borrow_mut();
        if let Some(t) = state.textures.iter().find(|t| t.key == key && t.layout == *layout) {
            return Some(t.name.clone());
        }
        if state.textures.len() == MOST {
            return None;
        }
        let name = unique(&safe_name(name), |n| state.is_taken_for_buffer(n));
        let texture = Texture { key, name: name.clone(), binding: 0, layout: *layout };
        state.textures.push(texture);
        Some(name)
    }
}

/// Prints the two bindings of a texture.
pub(super) fn bindings(texture: &Texture) -> String {
    let Texture { name, binding, layout, .. } = texture;
    let kind = if layout.is_volume { "3d" } else { "2d" };
    let mut text = String::new();
    let _ = writeln!(
        text,
        "@group(0) @binding({binding}) var {name}_texture: texture_{kind}<f32>;\n\
         @group(0) @binding({}) var {name}_sampler: sampler;",
        binding + 1
    );
    text
}
