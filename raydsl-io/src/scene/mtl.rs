//! Wavefront MTL.

use std::collections::{HashMap, HashSet};
use std::mem;
use std::path::{Component, Path, PathBuf};

use glam::{Affine2, Vec2, Vec3};

use super::picture::Room;
use super::{AlphaMode, Filter, Image, Material, Texture, Wrap, name};
use crate::error::word_text;
use crate::obj::vector;
use crate::source::Source;
use crate::{LoadError, Place};

const REMEDY: &str = "correct the line, or write the file again, for example with Blender";

/// The materials that an OBJ can name, and their pictures.
pub(super) struct Library {
    folder: PathBuf,
    materials: Vec<Material>,
    known: HashMap<String, usize>,
    images: Vec<Image>,
    /// The pictures that are read, by their names.
    pictures: HashMap<PathBuf, usize>,
    /// The files that are read.
    files: HashSet<PathBuf>,
    room: Room,
}

/// A material as it is in the file.
#[derive(Default)]
struct Stored {
    name: String,
    diffuse: Option<Vec3>,
    specular: Option<Vec3>,
    emissive: Option<Vec3>,
    filter: Option<Vec3>,
    exponent: Option<f32>,
    ior: Option<f32>,
    opacity: Option<f32>,
    metallic: Option<f32>,
    roughness: Option<f32>,
    model: Option<f32>,
    base_color_texture: Option<Texture>,
    emissive_texture: Option<Texture>,
    normal_texture: Option<Texture>,
}

/// What a mesh without a material has: matt white.
pub(super) fn blank() -> Material {
    Stored::default().material()
}

/// What follows the first word of a line, without white space around it.
pub(super) fn rest(line: &[u8]) -> String {
    let line = line.trim_ascii();
    let end = line.iter().position(u8::is_ascii_whitespace).unwrap_or(line.len());
    String::from_utf8_lossy(line[end..].trim_ascii()).into_owned()
}

/// Returns a line without its comment, which begins with a word: names may have a `#` within.
pub(super) fn without_comment(line: &[u8]) -> &[u8] {
    let begins = |i: usize| line[i] == b'#' && (i == 0 || line[i - 1].is_ascii_whitespace());
    let end = (0..line.len()).find(|i| begins(*i)).unwrap_or(line.len());
    &line[..end]
}

impl Library {
    pub(super) fn new(obj: &Source) -> Self {
        let folder = obj.path.parent().unwrap_or(Path::new("")).into();
        Self {
            folder,
            materials: Vec::new(),
            known: HashMap::new(),
            images: Vec::new(),
            pictures: HashMap::new(),
            files: HashSet::new(),
            room: Room::new(obj.len),
        }
    }

    pub(super) fn find(&self, name: &str) -> Option<usize> {
        self.known.get(name).copied()
    }

    /// Gives all materials and pictures.
    pub(super) fn take(&mut self) -> (Vec<Material>, Vec<Image>) {
        (mem::take(&mut self.materials), mem::take(&mut self.images))
    }

    /// Reads the files that a line `mtllib` names: one, whose name may have spaces, or several.
    pub(super) fn load(&mut self, obj: &Source, names: &str) -> Result<(), LoadError> {
        let whole = self.beside(obj, names)?;
        if whole.is_file() {
            return self.read(&whole);
        }
        for name in names.split_whitespace() {
            let path = self.beside(obj, name)?;
            self.read(&path)?;
        }
        Ok(())
    }

    /// The path of a file in the folder of the OBJ or below.
    fn beside(&self, source: &Source, name: &str) -> Result<PathBuf, LoadError> {
        let name = name.replace('\\', "/");
        let named = Path::new(&name);
        let is_below =
            named.components().all(|c| matches!(c, Component::Normal(_) | Component::CurDir));
        if name.is_empty() || !is_below {
            let what =
                format!("'{}' is no file in its folder or below", word_text(name.as_bytes()));
            let remedy = "move that file beside it, and write its name alone";
            return Err(source.bad_line(what, remedy));
        }
        Ok(self.folder.join(named))
    }

    fn read(&mut self, path: &Path) -> Result<(), LoadError> {
        if !self.files.insert(path.into()) {
            return Ok(());
        }
        let mut source = Source::open(path, "MTL")?;
        let (mut stored, mut line) = (None, Vec::new());
        while source.next_line(&mut line)? {
            let line = without_comment(&line);
            if line.trim_ascii().split(u8::is_ascii_whitespace).next() == Some(b"newmtl") {
                let name = rest(line);
                let next = Stored { name, ..Stored::default() };
                self.add(stored.replace(next));
            } else if let Some(stored) = &mut stored {
                self.statement(&source, line, stored)?;
            }
        }
        self.add(stored);
        Ok(())
    }

    /// Adds a material. The first of a name counts.
    fn add(&mut self, stored: Option<Stored>) {
        let Some(stored) = stored else { return };
        if !self.known.contains_key(&stored.name) {
            self.known.insert(stored.name.clone(), self.materials.len());
            self.materials.push(stored.material());
        }
    }

    fn statement(
        &mut self,
        source: &Source,
        line: &[u8],
        stored: &mut Stored,
    ) -> Result<(), LoadError> {
        let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        let Some(word) = words.next() else { return Ok(()) };
        let number = |words| number(words).map_err(|what| source.bad_line(what, REMEDY)).map(Some);
        let colour = |words| colour(words).map_err(|what| source.bad_line(what, REMEDY)).map(Some);
        match word {
            b"Kd" => stored.diffuse = colour(words)?,
            b"Ks" => stored.specular = colour(words)?,
            b"Ke" => stored.emissive = colour(words)?,
            b"Tf" => stored.filter = colour(words)?,
            b"Ns" => stored.exponent = number(words)?,
            b"Ni" => stored.ior = number(words)?,
            b"d" => stored.opacity = number(words)?,
            b"Tr" => stored.opacity = number(words)?.map(|transparency| 1.0 - transparency),
            b"Pm" => stored.metallic = number(words)?,
            b"Pr" => stored.roughness = number(words)?,
            b"illum" => stored.model = number(words)?,
            b"map_Kd" => stored.base_color_texture = Some(self.texture(source, line)?),
            b"map_Ke" => stored.emissive_texture = Some(self.texture(source, line)?),
            b"norm" | b"map_Kn" => stored.normal_texture = Some(self.texture(source, line)?),
            _ => {}
        }
        Ok(())
    }

    fn texture(&mut self, source: &Source, line: &[u8]) -> Result<Texture, LoadError> {
        let rest = rest(line);
        let options = Options::read(&rest);
        let options = options.map_err(|what| source.bad_line(what, REMEDY))?;
        let path = self.beside(source, options.name)?;
        let image = self.image(path)?;
        // Their v grows upwards.
        let Options { offset, scale, is_clamped, .. } = options;
        let offset = Vec2::new(offset.x, 1.0 - scale.y - offset.y);
        let transform = Affine2::from_scale_angle_translation(scale, 0.0, offset);
        if !transform.is_finite() {
            return Err(source.bad_line("its options are not finite".into(), REMEDY));
        }
        let wrap = [if is_clamped { Wrap::Clamp } else { Wrap::Repeat }; 2];
        Ok(Texture { image, set: 0, transform, wrap, filter: Filter::Linear })
    }

    fn image(&mut self, path: PathBuf) -> Result<usize, LoadError> {
        if let Some(image) = self.pictures.get(&path) {
            return Ok(*image);
        }
        let mut source = Source::open(&path, "picture")?;
        let bytes = source.rest()?;
        self.room.add(bytes.len() as u64);
        let title = path.file_name().unwrap_or_default().to_string_lossy();
        let image = self.room.decode(&bytes, name(Some(&title)));
        let image =
            image.map_err(|(what, remedy)| source.corrupt(Place::Somewhere, what, remedy))?;
        self.images.push(image);
        self.pictures.insert(path, self.images.len() - 1);
        Ok(self.images.len() - 1)
    }
}

impl Stored {
    fn material(self) -> Material {
        let is_glass = self.model.is_some_and(|model| [4.0, 6.0, 7.0, 9.0].contains(&model));
        let has_highlight = self.model.is_none_or(|model| model >= 2.0);
        let opacity = self.opacity.unwrap_or(if is_glass { 0.0 } else { 1.0 }).clamp(0.0, 1.0);
        let color = self.diffuse.unwrap_or(Vec3::ONE);
        let color = if is_glass { self.filter.unwrap_or(color) } else { color };
        let alpha = if is_glass { 1.0 } else { opacity };
        let rough = |exponent: f32| (2.0 / (exponent.max(0.0) + 2.0)).powf(0.25);
        let glow = if self.emissive_texture.is_some() { Vec3::ONE } else { Vec3::ZERO };
        Material {
            name: name(Some(&self.name)),
            base_color: color.min(Vec3::ONE).extend(alpha),
            base_color_texture: self.base_color_texture,
            metallic: self.metallic.unwrap_or(0.0).clamp(0.0, 1.0),
            roughness: self.roughness.or(self.exponent.map(rough)).unwrap_or(1.0).clamp(0.0, 1.0),
            normal_texture: self.normal_texture,
            emissive: self.emissive.unwrap_or(glow),
            emissive_texture: self.emissive_texture,
            alpha_mode: if alpha < 1.0 { AlphaMode::Blend } else { AlphaMode::Opaque },
            ior: self.ior.filter(|ior| *ior >= 1.0).unwrap_or(1.5),
            transmission: if is_glass { 1.0 - opacity } else { 0.0 },
            specular: if has_highlight && self.specular.is_some() { 1.0 } else { 0.0 },
            specular_color: self.specular.unwrap_or(Vec3::ONE),
            double_sided: true,
            ..Material::default()
        }
    }
}

/// What stands before the name of a picture.
struct Options<'a> {
    name: &'a str,
    offset: Vec2,
    scale: Vec2,
    is_clamped: bool,
}

impl<'a> Options<'a> {
    fn read(text: &'a str) -> Result<Self, String> {
        let mut options =
            Self { name: text, offset: Vec2::ZERO, scale: Vec2::ONE, is_clamped: false };
        while options.name.starts_with('-') {
            let option = options.word();
            match option {
                "-o" => options.offset = options.up_to_three(0.0),
                "-s" => options.scale = options.up_to_three(1.0),
                "-t" => drop(options.up_to_three(0.0)),
                "-clamp" => options.is_clamped = options.word() == "on",
                "-mm" => drop((options.word(), options.word())),
                "-blendu" | "-blendv" | "-bm" | "-boost" | "-cc" | "-imfchan" | "-texres"
                | "-type" => drop(options.word()),
                _ => {
                    let option = word_text(option.as_bytes());
                    return Err(format!("'{option}' is no option of a texture"));
                }
            }
        }
        Ok(options)
    }

    /// Takes the next word.
    fn word(&mut self) -> &'a str {
        let end = self.name.find(char::is_whitespace).unwrap_or(self.name.len());
        let (word, rest) = self.name.split_at(end);
        self.name = rest.trim_start();
        word
    }

    /// Takes one to three numbers, of which the third is of no use to pictures.
    fn up_to_three(&mut self, default: f32) -> Vec2 {
        let mut numbers = [default; 3];
        for number in &mut numbers {
            let word = self.name.split_whitespace().next().unwrap_or_default();
            let Ok(found) = word.parse() else { break };
            *number = found;
            self.word();
        }
        Vec2::new(numbers[0], numbers[1])
    }
}

fn number<'a>(words: impl Iterator<Item = &'a [u8]>) -> Result<f32, String> {
    // The fog of `d -halo` is passed over.
    let mut words = words.filter(|word| *word != b"-halo");
    let word = words.next().ok_or("it has no number")?;
    let value = str::from_utf8(word).ok().and_then(|word| word.parse().ok());
    let value = value.filter(|value: &f32| value.is_finite());
    value.ok_or_else(|| format!("'{}' is no finite number", word_text(word)))
}

/// One number stands for three.
fn colour<'a>(words: impl Iterator<Item = &'a [u8]> + Clone) -> Result<Vec3, String> {
    let color = match words.clone().count() {
        1 => Vec3::splat(number(words)?),
        _ => vector(words)?,
    };
    if color.is_finite() && color.min_element() >= 0.0 {
        return Ok(color);
    }
    Err("it is no colour: a number is negative or not finite".into())
}
