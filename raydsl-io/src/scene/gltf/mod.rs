//! glTF 2.0.
//!
//! JSON is read by the crate `gltf-json`. Its checks of indices panic on some files, so they are not
//! called: each index is looked up where it is used.

mod accessor;
mod buffer;
mod container;
mod material;
mod nodes;
mod primitive;

use gltf_json::{Index, Root, Value};
use serde::Deserialize;
use serde::de::DeserializeOwned;

use super::Scene;
use super::picture::Room;
use crate::error::{one_line, word_text};
use crate::source::Source;
use crate::{LoadError, Place};
use buffer::Buffers;

const REMEDY: &str = "export it again, for example with Blender, and check it with glTF-Validator";

/// The extensions of which this crate reads what a file may require.
const KNOWN: [&str; 11] = [
    "KHR_lights_punctual",
    "KHR_materials_clearcoat",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

pub(super) fn read(mut source: Source) -> Result<Scene, LoadError> {
    let bytes = source.rest()?;
    let (json, blob) = container::split(&source, bytes)?;
    check_head(&source, &json)?;
    let root: Root = parse(&source, &json)?;
    let len = source.len;
    let file = File { source, root };
    let buffers = Buffers::load(&file, blob)?;
    let mut room = Room::new(len);
    room.add(buffers.total());
    let mut scene = Scene::default();
    material::read(&file, &buffers, &mut room, &mut scene)?;
    nodes::read(&file, &buffers, &mut scene)?;
    Ok(scene)
}

/// What tells whether the rest can be read.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Head {
    asset: Asset,
    #[serde(default)]
    extensions_required: Vec<String>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Asset {
    version: String,
    min_version: Option<String>,
}

fn check_head(source: &Source, json: &[u8]) -> Result<(), LoadError> {
    let head: Head = parse(source, json)?;
    let needed = head.asset.min_version.as_ref().unwrap_or(&head.asset.version);
    if needed != "2.0" && !(head.asset.min_version.is_none() && needed.starts_with("2.")) {
        let what = format!("it is of version '{}'", word_text(needed.as_bytes()));
        return Err(source.corrupt(Place::Somewhere, what, "convert it to glTF 2.0"));
    }
    match head.extensions_required.iter().find(|name| !KNOWN.contains(&name.as_str())) {
        Some(name) => Err(unsupported(source, name)),
        None => Ok(()),
    }
}

/// The extensions by which the data of meshes are compressed.
const COMPRESSIONS: [&str; 3] =
    ["EXT_meshopt_compression", "KHR_draco_mesh_compression", "KHR_meshopt_compression"];

fn unsupported(source: &Source, name: &str) -> LoadError {
    let remedy = match name {
        name if COMPRESSIONS.contains(&name) => {
            "write it without compression of meshes, for example with Blender or \
             `gltf-transform copy`"
        }
        "KHR_texture_basisu" | "EXT_texture_webp" | "EXT_texture_avif" | "MSFT_texture_dds" => {
            "write it with pictures as PNG or JPEG, for example with `gltf-transform png`"
        }
        "EXT_mesh_gpu_instancing" => "write a node for each instance",
        _ => "export it without this extension",
    };
    let extension = one_line(name);
    LoadError::Extension { path: source.path.clone(), extension, remedy }
}

fn parse<T: DeserializeOwned>(source: &Source, json: &[u8]) -> Result<T, LoadError> {
    serde_json::from_slice(json).map_err(|e| {
        if e.is_eof() {
            return source.truncated("it ends within its JSON".into());
        }
        source.corrupt(Place::Somewhere, format!("its JSON: {}", one_line(e)), REMEDY)
    })
}

/// The file, and what its JSON says.
pub(super) struct File {
    source: Source,
    root: Root,
}

impl File {
    fn wrong(&self, what: impl Into<String>) -> LoadError {
        self.source.corrupt(Place::Somewhere, what.into(), REMEDY)
    }

    /// Data are missing: maybe they are there only in compressed form.
    fn missing(&self, what: impl Into<String>) -> LoadError {
        let mut used = self.root.extensions_used.iter();
        match used.find(|name| COMPRESSIONS.contains(&name.as_str())) {
            Some(name) => unsupported(&self.source, name),
            None => self.wrong(what),
        }
    }

    /// What an index of the JSON stands for.
    fn get<'a, T>(&self, list: &'a [T], index: Index<T>, name: &str) -> Result<&'a T, LoadError> {
        self.at(list, index.value(), name)
    }

    fn at<'a, T>(&self, list: &'a [T], index: usize, name: &str) -> Result<&'a T, LoadError> {
        list.get(index).ok_or_else(|| {
            self.wrong(format!("it names {name}[{index}], but has {} of them", list.len()))
        })
    }

    /// An extension of an object.
    fn extension<T: DeserializeOwned>(
        &self,
        others: Option<&serde_json::Map<String, Value>>,
        name: &str,
        what: &str,
    ) -> Result<Option<T>, LoadError> {
        let Some(value) = others.and_then(|others| others.get(name)) else { return Ok(None) };
        let read = T::deserialize(value);
        read.map(Some).map_err(|e| self.wrong(format!("{what}: {name}: {}", one_line(e))))
    }
}
