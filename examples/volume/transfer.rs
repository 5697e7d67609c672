//! Transfer functions by name: presets of this program, colour maps, and files of ParaView.

use std::path::{Path, PathBuf};

use colorous::Gradient;
use raydsl::prelude::*;
use raydsl::volume::TransferFunction;

use super::Failure;

/// Colours and opacities by value.
type Knots = (Vec<(f32, Vec3)>, Vec<(f32, f32)>);

/// Colours of what scans of bodies show, over the range of their values.
const TISSUE: [(f32, Vec3); 5] = [
    (0.22, SKIN),
    (0.36, SKIN),
    (0.46, vec3(0.8, 0.66, 0.6)),
    (0.66, vec3(0.93, 0.9, 0.84)),
    (0.85, vec3(1.0, 0.98, 0.9)),
];
const SKIN: Vec3 = vec3(0.86, 0.6, 0.48);

/// The colours of tissue with opacities over the range of a scan's values.
#[derive(Debug)]
pub(crate) struct Preset {
    name: &'static str,
    about: &'static str,
    opacities: &'static [(f32, f32)],
}

const PRESETS: [Preset; 4] = [
    Preset {
        name: "tissue",
        about: "skin, brain and bone, opaque",
        opacities: &[(0.16, 0.0), (0.24, 0.55), (0.35, 0.6), (0.45, 0.9), (1.0, 0.97)],
    },
    Preset {
        name: "glass",
        about: "thin skin over what is dense",
        opacities: &[(0.2, 0.0), (0.26, 0.03), (0.34, 0.02), (0.55, 0.04), (0.62, 0.7), (1.0, 0.9)],
    },
    Preset { name: "bone", about: "what is dense alone", opacities: &[(0.72, 0.0), (0.8, 0.9)] },
    Preset {
        name: "xray",
        about: "the sum of all, as a radiograph",
        opacities: &[(0.15, 0.0), (1.0, 0.02)],
    },
];

const MAPS: [(&str, Gradient); 15] = [
    ("viridis", colorous::VIRIDIS),
    ("magma", colorous::MAGMA),
    ("inferno", colorous::INFERNO),
    ("plasma", colorous::PLASMA),
    ("cividis", colorous::CIVIDIS),
    ("turbo", colorous::TURBO),
    ("warm", colorous::WARM),
    ("cool", colorous::COOL),
    ("cubehelix", colorous::CUBEHELIX),
    ("rainbow", colorous::RAINBOW),
    ("spectral", colorous::SPECTRAL),
    ("red-blue", colorous::RED_BLUE),
    ("blues", colorous::BLUES),
    ("greens", colorous::GREENS),
    ("greys", colorous::GREYS),
];

/// Linear pieces of a colour map: few, since rays stop at each, and within four levels of a byte.
const PIECES: u16 = 32;

/// Opacities of what has none of its own, over the range of a scan's values.
const RAMP: [(f32, f32); 2] = [(0.1, 0.0), (1.0, 0.9)];

/// Which transfer function is asked for.
#[derive(Clone, Debug)]
pub(crate) enum Choice {
    Preset(&'static Preset),
    Map(Gradient),
    /// Every whole number is an organ with a colour of its own.
    Labels,
    File(PathBuf),
}

impl Choice {
    /// Reads a name of the command line.
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        if let Some(preset) = PRESETS.iter().find(|p| p.name == text) {
            return Ok(Self::Preset(preset));
        }
        if let Some((_, map)) = MAPS.iter().find(|m| m.0 == text) {
            return Ok(Self::Map(*map));
        }
        if text == "labels" {
            return Ok(Self::Labels);
        }
        let path = Path::new(text);
        if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("json")) {
            return Ok(Self::File(path.into()));
        }
        Err(format!("choose from {}", Self::known()))
    }

    /// What there is to choose from.
    pub(crate) fn known() -> String {
        let (presets, maps) = (PRESETS.map(|p| p.name), MAPS.map(|m| m.0));
        format!("{}, labels; {}; or a .json file of ParaView", presets.join(", "), maps.join(", "))
    }

    /// What is chosen by that.
    pub(crate) fn help() -> String {
        let presets = PRESETS.map(|p| format!("  {:8} {}\n", p.name, p.about)).concat();
        format!(
            "Transfer functions:\n{presets}  labels   whole numbers from 1 on, as of organs, a colour \
             each\n  Opacities of a colour map rise from the tenth of the \
             values' range on. Of a file of\n  ParaView the first preset is taken; if its colours are \
             of values from 0 to 1, that is the\n  range."
        )
    }

    /// The function for values of a range; opacities are of layers as thick as `unit`.
    pub(crate) fn function(&self, range: Vec2, unit: f32) -> Result<TransferFunction, Failure> {
        match self {
            Self::Preset(preset) => {
                of_shares((TISSUE.into(), preset.opacities.into()), range, unit)
            }
            Self::Map(map) => of_shares((sampled(map), RAMP.into()), range, unit),
            Self::Labels => Ok(TransferFunction::labels(&labels(range.y)?, unit)?),
            Self::File(path) => {
                let found = raydsl_io::paraview::load(path)?.swap_remove(0);
                let (colors, mut opacities) = (found.colors, found.opacities);
                let ends = (colors[0].0, colors[colors.len() - 1].0);
                if opacities.is_empty() {
                    opacities =
                        RAMP.map(|(at, opacity)| (ends.0 + (ends.1 - ends.0) * at, opacity)).into();
                }
                // Other values are those of the data that the file was made for.
                if ends == (0.0, 1.0) {
                    of_shares((colors, opacities), range, unit)
                } else {
                    Ok(TransferFunction::new(&colors, &opacities, unit)?)
                }
            }
        }
    }
}

/// The function whose knots are at shares of a range.
fn of_shares(
    (mut colors, mut opacities): Knots,
    range: Vec2,
    unit: f32,
) -> Result<TransferFunction, Failure> {
    let over_range = |share: f32| range.x + (range.y - range.x) * share;
    colors.iter_mut().for_each(|(value, _)| *value = over_range(*value));
    opacities.iter_mut().for_each(|(value, _)| *value = over_range(*value));
    Ok(TransferFunction::new(&colors, &opacities, unit)?)
}

/// Labels that a scan may have, and more than are told apart.
const MOST_LABELS: f32 = 4096.0;

/// Labels up to the greatest value, with hues as far apart as those before leave room for.
fn labels(most: f32) -> Result<Vec<(u32, Vec3, f32)>, Failure> {
    // The range of values is widened by rounding.
    let most = most.round();
    if !(1.0..=MOST_LABELS).contains(&most) {
        let message = format!("--tf labels is for whole numbers from 1 to 4096, not up to {most}");
        return Err(Failure::Usage(message));
    }
    let color = |label: u32| {
        let hue = (label as f32 * 0.618_034).fract() * 6.0;
        let channel = |shift: f32| {
            let around = (hue + shift) % 6.0;
            0.92 - 0.62 * around.min(4.0 - around).clamp(0.0, 1.0)
        };
        vec3(channel(5.0), channel(3.0), channel(1.0))
    };
    Ok((1..=most as u32).map(|label| (label, color(label), 0.9)).collect())
}

fn sampled(map: &Gradient) -> Vec<(f32, Vec3)> {
    let color = |share: f32| {
        let c = map.eval_continuous(share.into());
        Vec3::from([c.r, c.g, c.b].map(|byte| f32::from(byte) / 255.0))
    };
    let shares = (0..=PIECES).map(|i| f32::from(i) / f32::from(PIECES));
    shares.map(|share| (share, color(share))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_known() {
        for name in PRESETS.iter().map(|p| p.name).chain(MAPS.map(|m| m.0)) {
            let choice = Choice::parse(name).expect(name);
            let function = choice.function(vec2(-100.0, 900.0), 2.0).expect(name);
            let knots = function.knots();
            assert!(knots.iter().all(|k| (-100.0..=900.0).contains(&k.value)), "{name}");
            assert_eq!(function.at(-100.0).extinction, 0.0, "{name}");
            assert!(function.at(900.0).extinction > 0.0, "{name}");
            assert!(Choice::known().contains(name));
        }
        let organs = Choice::Labels.function(vec2(0.0, 15.0), 1.0).expect("labels");
        assert!(organs.at(0.0).extinction == 0.0 && organs.at(15.0).extinction > 0.0);
        assert!(organs.at(4.0).color != organs.at(5.0).color);
        assert!(Choice::Labels.function(vec2(-1.0, 0.4), 1.0).is_err());
        let message = Choice::parse("jet").expect_err("no map of that name");
        assert!(message.contains("tissue") && message.contains("turbo"), "{message}");
        assert!(matches!(Choice::parse("a/b.JSON"), Ok(Choice::File(_))));
    }

    #[test]
    fn ramps_begin_at_a_tenth() {
        let function = Choice::parse("viridis").expect("a map").function(vec2(0.0, 10.0), 1.0);
        let function = function.expect("a function");
        assert_eq!(function.at(1.0).extinction, 0.0);
        assert!(function.at(1.1).extinction > 0.0);
        assert!((function.at(10.0).extinction - 10f32.ln()).abs() < 1e-5);
        let end = function.at(10.0).color - vec3(253.0, 231.0, 37.0) / 255.0;
        assert!(end.abs().max_element() < 0.01, "{end}");
    }

    /// Between knots a map is within four levels of a byte of its own colours.
    #[test]
    fn pieces_are_enough() {
        for (name, map) in MAPS {
            let knots = sampled(&map);
            for i in 0..10 * PIECES {
                let place = f32::from(i) / 10.0;
                let (from, to) = (knots[usize::from(i) / 10].1, knots[usize::from(i) / 10 + 1].1);
                let color = map.eval_continuous(f64::from(place) / f64::from(PIECES));
                let exact = Vec3::from([color.r, color.g, color.b].map(f32::from));
                let error = (from.lerp(to, place.fract()) * 255.0 - exact).abs().max_element();
                assert!(error < 4.0, "{name} at {place}: {error}");
            }
        }
    }

    #[test]
    fn files_of_shares_are_spread() {
        let path = std::env::temp_dir().join(format!("volume-{}.json", std::process::id()));
        let file = |first: i32, last: i32| {
            let preset = format!(
                r#"[{{"Name":"a","RGBPoints":[{first},1,0,0,{last},0,0,1],
                "Points":[{first},0,0.5,0,{last},0.5,0.5,0]}}]"#
            );
            std::fs::write(&path, preset).expect("a temporary file");
            Choice::File(path.clone()).function(vec2(100.0, 300.0), 1.0).expect("a function")
        };
        let spread = file(0, 1);
        let own = file(0, 2);
        std::fs::remove_file(&path).expect("it is there");
        let ends = |function: &TransferFunction| {
            let knots = function.knots();
            (knots[0].value, knots[knots.len() - 1].value)
        };
        assert_eq!((ends(&spread), ends(&own)), ((100.0, 300.0), (0.0, 2.0)));
        assert_eq!(spread.at(300.0).extinction, 2f32.ln());
        assert_eq!(own.at(2.0).extinction, 2f32.ln());
    }
}
