//! ParaView's presets: colours and opacities of values, from the JSON files that its colour map
//! editor exports.
//!
//! Colours are handed on as they are in the file, for display in sRGB: a picture that is written
//! without another curve has the colours of ParaView. Between two points ParaView mixes colours in
//! the preset's colour space, by the rule of VTK's `vtkColorTransferFunction`. Knots here are for
//! linear RGB mixing, so there are as many as it takes to follow that rule within half a level of a
//! byte, 1/510, in each channel; `RGB` and `Step` are exact. Opacities follow the midpoints and the
//! sharpness of `vtkPiecewiseFunction` within the same bound, and exactly where it is linear or a
//! step.
//!
//! An opacity is that of a layer as thick as a distance that is not in the file: ParaView's
//! `ScalarOpacityUnitDistance`, which whoever renders has to give. The colour of NaN is passed
//! over.

mod curve;
mod spaces;

use std::io::Read;
use std::path::Path;

use glam::Vec3;
use serde::Deserialize;

use crate::error::{one_line, word_text};
use crate::source::Source;
use crate::{LoadError, Place};
use curve::{follow, opacity};
use spaces::Space;

/// Bytes of a file at most; ParaView's own presets are 0.3 MB together.
const LONGEST: u64 = 4 << 20;
/// Knots of a file at most.
const MOST: usize = 1 << 18;
/// The greatest value, in size. Transfer functions need room beyond their last knot.
const FAR: f64 = f32::MAX as f64 / 16.0;

const REMEDY: &str = "mend it in ParaView's colour map editor, and export it again";

/// Holds the colours and opacities of values: a preset of ParaView.
#[derive(Clone, Debug, PartialEq)]
pub struct Preset {
    /// What ParaView calls it; may be empty.
    pub name: String,
    /// Values and colours, sorted by value, at least one; colour is linear between two of them, and
    /// two of one value are a step. Values are of any unit, often from 0 to 1 for the whole range
    /// of a data set; channels are from 0 to 1, as the file has them.
    ///
    /// The colours of categories are steps in the middle between two categories' values: those of
    /// the annotations if all of them are numbers, or else 0, 1, 2 and so on.
    pub colors: Vec<(f32, Vec3)>,
    /// Values and opacities from 0 to 1, in the same way; empty if the preset has none.
    pub opacities: Vec<(f32, f32)>,
}

/// Loads the presets of a file, in its order. There is at least one.
///
/// The file is a list, as ParaView exports it. Comments and a comma behind the last element, which
/// ParaView's import passes over, are errors here.
///
/// Colour spaces are `RGB`, `HSV`, `Lab` (or `CIELAB`), `Diverging` and `Step`; a preset that tells
/// none is `RGB`.
///
/// # Errors
///
/// When the file is missing, unreadable, cut off, longer than 4 MiB or no list of presets, when a
/// preset has no colours, an incomplete point, another colour space, a value beyond 2.1e37, or a
/// colour, opacity, midpoint or sharpness below 0 or above 1, and when there are more than 2^18
/// knots.
///
/// # Examples
///
/// ```no_run
/// let presets = raydsl_io::paraview::load("bone.json")?;
/// println!("{}: {} knots", presets[0].name, presets[0].colors.len());
/// # Ok::<(), raydsl_io::LoadError>(())
/// ```
pub fn load(path: impl AsRef<Path>) -> Result<Vec<Preset>, LoadError> {
    let mut source = Source::open(path.as_ref(), "ParaView preset")?;
    let stored = stored(&mut source)?;
    if stored.is_empty() {
        return Err(LoadError::Empty { path: source.path, what: "preset" });
    }
    let mut room = MOST;
    let mut presets = Vec::new();
    for preset in &stored {
        presets.push(preset.read(&source, &mut room)?);
    }
    Ok(presets)
}

/// A preset as it is in the file; other fields are passed over.
#[derive(Deserialize)]
#[serde(rename_all = "PascalCase")]
struct Stored {
    name: String,
    color_space: Option<String>,
    #[serde(rename = "HSVWrap")]
    hsv_wrap: Option<Flag>,
    /// A value and three channels each.
    #[serde(rename = "RGBPoints")]
    rgb_points: Option<Vec<f64>>,
    /// A value, opacity, midpoint and sharpness each.
    points: Option<Vec<f64>>,
    /// Three channels each.
    indexed_colors: Option<Vec<f64>>,
    /// A category's value and its label each.
    annotations: Option<Vec<String>>,
}

/// ParaView's properties of two values are numbers.
#[derive(Deserialize)]
#[serde(untagged)]
enum Flag {
    Bool(bool),
    Number(f64),
}

fn stored(source: &mut Source) -> Result<Vec<Stored>, LoadError> {
    let mut text = Vec::new();
    // It may be longer than its length was when it was opened.
    let read = source.take(LONGEST + 1).read_to_end(&mut text);
    read.map_err(|e| source.fault(e.into(), REMEDY))?;
    if text.len() as u64 > LONGEST {
        let what = format!("it is longer than {LONGEST} bytes");
        return Err(source.corrupt(Place::Somewhere, what, "export fewer presets at once"));
    }
    serde_json::from_slice(&text).map_err(|e| {
        if e.is_eof() {
            return source.truncated("it ends within a preset".into());
        }
        let place = format!(" at line {} column {}", e.line(), e.column());
        let what = one_line(e.to_string().trim_end_matches(&place));
        source.corrupt(Place::Line(e.line() as u64), what, REMEDY)
    })
}

impl Stored {
    /// Takes the room of its knots from what is left for a file.
    fn read(&self, source: &Source, room: &mut usize) -> Result<Preset, LoadError> {
        let wrong = |what: String| {
            let name = word_text(self.name.as_bytes());
            source.corrupt(Place::Somewhere, format!("preset '{name}': {what}"), REMEDY)
        };
        let colors = match (&self.rgb_points, &self.indexed_colors) {
            (Some(points), _) if !points.is_empty() => {
                let space = self.space().map_err(wrong)?;
                let points = sorted(points, "RGBPoints").map_err(wrong)?;
                follow(&points, |from, to| space.between(from, to), room)
            }
            (_, Some(colors)) if !colors.is_empty() => {
                let points = self.categories(colors).map_err(wrong)?;
                follow(&points, |from, to| Space::Step.between(from, to), room)
            }
            _ => return Err(wrong("it has neither RGBPoints nor IndexedColors".into())),
        };
        let opacities = match &self.points {
            Some(points) if points.is_empty() => return Err(wrong("Points are empty".into())),
            Some(points) => {
                let points = sorted(points, "Points").map_err(wrong)?;
                follow(&points, opacity, room)
            }
            None => Some(Vec::new()),
        };
        let (Some(colors), Some(opacities)) = (colors, opacities) else {
            return Err(LoadError::TooMany {
                path: source.path.clone(),
                what: "knot",
                count: MOST as u64 + 1,
                limit: MOST as u64,
                remedy: "export fewer presets at once",
            });
        };
        Ok(Preset {
            name: self.name.clone(),
            colors: colors.into_iter().map(|(v, c)| (v, Vec3::from(c))).collect(),
            opacities: opacities.into_iter().map(|(v, [a])| (v, a)).collect(),
        })
    }

    fn space(&self) -> Result<Space, String> {
        // ParaView takes hues for wrapped only where the preset says so.
        let wraps = match self.hsv_wrap {
            Some(Flag::Bool(wraps)) => wraps,
            Some(Flag::Number(n)) => n != 0.0,
            None => false,
        };
        Ok(match self.color_space.as_deref().unwrap_or("RGB") {
            "RGB" => Space::Rgb,
            "HSV" => Space::Hsv { wraps },
            "Lab" | "CIELAB" => Space::Lab,
            "Diverging" => Space::Diverging,
            "Step" => Space::Step,
            other => {
                let other = word_text(other.as_bytes());
                return Err(format!(
                    "the colour space '{other}' is none of RGB, HSV, Lab, Diverging, Step"
                ));
            }
        })
    }

    /// Points of steps in the middle between the values of categories.
    fn categories(&self, colors: &[f64]) -> Result<Vec<[f64; 4]>, String> {
        let (colors, rest) = colors.as_chunks::<3>();
        if !rest.is_empty() {
            return Err(format!("IndexedColors end within colour {}", colors.len()));
        }
        let pairs = self.annotations.as_deref().unwrap_or_default().as_chunks::<2>().0;
        let values: Option<Vec<f64>> = pairs.iter().map(|[v, _]| v.trim().parse().ok()).collect();
        let values = match values {
            Some(values) if !values.is_empty() => values,
            _ => (0..colors.len()).map(|i| i as f64).collect(),
        };
        // More annotations than colours begin with the first colour again.
        let colors = colors.iter().cycle();
        let points: Vec<f64> =
            values.iter().zip(colors).flat_map(|(v, [r, g, b])| [*v, *r, *g, *b]).collect();
        let mut points = sorted(&points, "IndexedColors")?;
        // A step has the colour of its end: that is where the next category begins.
        for i in 0..points.len().saturating_sub(1) {
            points[i][0] = (points[i][0] + points[i + 1][0]) * 0.5;
        }
        Ok(points)
    }
}

/// Points of a list, sorted by value; all their other numbers are from 0 to 1.
fn sorted(numbers: &[f64], list: &str) -> Result<Vec<[f64; 4]>, String> {
    let (points, rest) = numbers.as_chunks::<4>();
    if !rest.is_empty() {
        return Err(format!("{list} end within point {}", points.len()));
    }
    for (i, point) in points.iter().enumerate() {
        let [value, shares @ ..] = point;
        if value.is_nan() || value.abs() > FAR {
            return Err(format!("{list} have the value {value:e} at point {i}, beyond {FAR:.1e}"));
        }
        if let Some(share) = shares.iter().find(|share| !(0.0..=1.0).contains(*share)) {
            return Err(format!("{list} have {share} at point {i}, which is not from 0 to 1"));
        }
    }
    let mut points = points.to_vec();
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    Ok(points)
}
