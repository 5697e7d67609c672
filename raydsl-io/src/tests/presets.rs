//! Presets of ParaView.

use glam::{Vec3, vec3};

use super::*;
use crate::paraview::{self, Preset};

pub(super) fn load_presets(text: impl AsRef<[u8]>) -> Result<Vec<Preset>, LoadError> {
    paraview::load(&Temp::new("json", text.as_ref()).0)
}

/// The error's message, which has to be one line with a remedy.
fn refused(text: &str) -> String {
    let message = load_presets(text).expect_err("an error").to_string();
    assert!(!message.contains('\n') && message.contains(';'), "{message}");
    message
}

fn one(text: &str) -> Preset {
    let mut presets = load_presets(text).expect("presets");
    assert_eq!(presets.len(), 1);
    presets.remove(0)
}

/// As ParaView writes it, with fields that are passed over.
pub(super) const EXPORTED: &str = r#"[
   {
      "ColorSpace" : "Diverging",
      "Creator" : "Kenneth Moreland",
      "Name" : "Cool to Warm",
      "NanColor" : [ 1, 1, 0 ],
      "Points" : [ -10.5, 0, 0.5, 0, 2, 0.25, 0.3, 0.5, 20, 1, 0.5, 0 ],
      "RGBPoints" : [ -10.5, 0.23137254902, 0.298039215686, 0.752941176471,
                      20, 0.705882352941, 0.0156862745098, 0.149019607843 ]
   },
   {
      "Annotations" : [ "7", "bone", "2", "skin", "3", "fat" ],
      "IndexedColors" : [ 1, 1, 1, 0.5, 0, 0, 0, 0.5, 0 ],
      "Name" : "Tissues"
   }
]"#;

#[test]
fn exported_presets_are_read() {
    let presets = load_presets(EXPORTED).expect("presets");
    let [warm, tissues] = &presets[..] else { panic!("{presets:?}") };
    assert_eq!((&*warm.name, &*tissues.name), ("Cool to Warm", "Tissues"));
    let ends = [&warm.colors[0], &warm.colors[warm.colors.len() - 1]];
    assert_eq!(ends[0], &(-10.5, vec3(0.231_372_55, 0.298_039_22, 0.752_941_2)));
    assert_eq!(ends[1], &(20.0, vec3(0.705_882_4, 0.015_686_275, 0.149_019_61)));
    assert!(warm.colors.is_sorted_by(|a, b| a.0 <= b.0));
    let grey = warm.colors.iter().find(|c| c.0 == 4.75).expect("a knot in the middle").1;
    assert!((grey - 0.865).abs().max_element() < 2e-3, "{grey}");
    assert_eq!(warm.opacities[..2], [(-10.5, 0.0), (2.0, 0.25)]);
    assert_eq!(warm.opacities[warm.opacities.len() - 1], (20.0, 1.0));
    // The midpoint is where opacity is in the middle.
    let middle = warm.opacities.iter().find(|o| (o.0 - 7.4).abs() < 1e-6).expect("a knot");
    assert!((middle.1 - 0.625).abs() < 1e-6, "{middle:?}");

    let (skin, fat, bone) = (vec3(0.5, 0.0, 0.0), vec3(0.0, 0.5, 0.0), Vec3::ONE);
    let steps = [(2.5, skin), (2.5, fat), (5.0, fat), (5.0, bone), (7.0, bone)];
    assert_eq!(tissues.colors, steps);
    assert!(tissues.opacities.is_empty());
}

#[test]
fn linear_presets_are_exact() {
    let preset = one(r#"[{"Name":"","RGBPoints":[5,0,0,1, -1,1,0,0, 2,0,1,0, 2,1,1,1],
        "Points":[5,1,0.5,0, -1,0,0.25,0, 1,0.5,0.5,1, 3,0,1,0.5, 4,0,0,0],"HSVWrap":1}]"#);
    let [red, green, blue] = [Vec3::X, Vec3::Y, Vec3::Z];
    assert_eq!(preset.colors, [(-1.0, red), (2.0, green), (2.0, Vec3::ONE), (5.0, blue)]);
    // A midpoint, a step, nothing between equal opacities, and a midpoint at the begin.
    let expected =
        [(-1.0, 0.0), (-0.5, 0.25), (1.0, 0.5), (2.0, 0.5), (2.0, 0.0), (3.0, 0.0), (4.0, 0.0)];
    assert_eq!(preset.opacities[..7], expected);
    assert_eq!(preset.opacities[7..], [(4.00001, 0.5), (5.0, 1.0)]);
}

#[test]
fn spaces_are_told_apart() {
    let points = r#""RGBPoints":[0,1,0,0,1,0,0,1]"#;
    let middle = |more: &str| {
        let preset = one(&format!("[{{\"Name\":\"a\",{more}{points}}}]"));
        preset.colors.iter().find(|c| c.0 == 0.5).map(|c| c.1)
    };
    assert_eq!(middle(""), None);
    assert_eq!(middle(r#""ColorSpace":"RGB","#), None);
    let purple = vec3(1.0, 0.0, 1.0);
    for (wraps, expected) in [
        ("", Vec3::Y),
        (r#""HSVWrap":0,"#, Vec3::Y),
        (r#""HSVWrap":false,"#, Vec3::Y),
        (r#""HSVWrap":1,"#, purple),
        (r#""HSVWrap":true,"#, purple),
    ] {
        let found = middle(&format!(r#""ColorSpace":"HSV",{wraps}"#)).expect("a knot");
        assert!((found - expected).abs().max_element() < 1e-6, "{wraps}: {found}");
    }
    let lab = middle(r#""ColorSpace":"Lab","#).expect("a knot");
    assert_eq!(middle(r#""ColorSpace":"CIELAB","#), Some(lab));
    assert!(lab.x > 0.7 && lab.y < 0.1 && lab.z > 0.5, "{lab}");
    let white = middle(r#""ColorSpace":"Diverging","#).expect("a knot");
    assert!(white.min_element() > 0.9, "{white}");
    let step = one(&format!(r#"[{{"Name":"a","ColorSpace":"Step",{points}}}]"#));
    assert_eq!(step.colors, [(0.0, Vec3::X), (0.0, Vec3::Z), (1.0, Vec3::Z)]);
}

/// More annotations than colours, and annotations that are words.
#[test]
fn categories_have_values() {
    let colors = r#""IndexedColors":[0,0,0,1,1,1],"RGBPoints":[]"#;
    let preset = |annotations: &str| {
        one(&format!(r#"[{{"Name":"a",{colors},"Annotations":[{annotations}]}}]"#)).colors
    };
    let (black, white) = (Vec3::ZERO, Vec3::ONE);
    let counted = [(0.5, black), (0.5, white), (1.0, white)];
    assert_eq!(preset(""), counted);
    assert_eq!(preset(r#""skin","Skin","bone","Bone""#), counted);
    let three = [(1.5, black), (1.5, white), (2.5, white), (2.5, black), (3.0, black)];
    assert_eq!(preset(r#""1","a","2","b","3","c""#), three);
}

#[test]
fn broken_presets_are_named() {
    let with = |more: &str| format!("[{{\"Name\":\"abc\",{more}}}]");
    let points = |numbers: &str| with(&format!(r#""RGBPoints":[{numbers}]"#));
    for (text, what) in [
        (String::new(), "is cut off at byte 0"),
        ("[]".into(), "holds no preset"),
        ("{}".into(), ":1: is no valid ParaView preset: invalid type: map"),
        ("[\n{}]".into(), ":2: is no valid ParaView preset: missing field `Name`"),
        (
            points("0,1,1,1").replace("}]", "},\n]"),
            ":2: is no valid ParaView preset: trailing comma",
        ),
        ("\u{feff}[]".into(), "expected value"),
        (with("\"a\":1"), "preset 'abc': it has neither RGBPoints nor IndexedColors"),
        (points(""), "it has neither RGBPoints nor IndexedColors"),
        (points("0,1,1"), "RGBPoints end within point 0"),
        (points("0,1,1,1,2,0"), "RGBPoints end within point 1"),
        (points("0,1,1,1,2,0,0,255"), "RGBPoints have 255 at point 1, which is not from 0 to 1"),
        (points("0,1,-0.1,1"), "RGBPoints have -0.1 at point 0"),
        (points("1e38,1,1,1"), "RGBPoints have the value 1e38 at point 0, beyond 2.1e37"),
        (points("1e999,1,1,1"), ":1: is no valid ParaView preset: number out of range"),
        (points("NaN,1,1,1"), "expected value"),
        (points("\"1\",1,1,1"), "expected f64"),
        (with(r#""RGBPoints":[0,0,0,0],"ColorSpace":"Lab/CIEDE2000""#), "'Lab/CIEDE2000' is none"),
        (with(r#""RGBPoints":[0,0,0,0],"Points":[0,1,0.5]"#), "Points end within point 0"),
        (with(r#""RGBPoints":[0,0,0,0],"Points":[]"#), "Points are empty"),
        (with(r#""RGBPoints":[0,0,0,0],"Points":[0,1,2,0]"#), "Points have 2 at point 0"),
        (with(r#""IndexedColors":[0,0,0,0]"#), "IndexedColors end within colour 1"),
        (with(r#""IndexedColors":[0,0,3]"#), "IndexedColors have 3 at point 0"),
        (with(r#""IndexedColors":[0,0,0],"Annotations":["inf","a"]"#), "have the value inf"),
        (with(r#""IndexedColors":[0,0,0],"Annotations":["nan","a"]"#), "have the value NaN"),
        ("[".repeat(100_000), "invalid type: sequence"),
        (with(&format!("\"a\":{}", "[".repeat(1000))), "expected value"),
        (" ".repeat((4 << 20) + 1), "it is longer than 4194304 bytes"),
    ] {
        let message = refused(&text);
        assert!(message.contains(what), "{message}\n{what}");
    }
    assert!(matches!(paraview::load("no-such.json"), Err(LoadError::Missing { .. })));
    assert!(matches!(paraview::load(std::env::temp_dir()), Err(LoadError::Unreadable { .. })));
}

#[test]
fn cut_presets_are_errors() {
    for end in 0..EXPORTED.len() {
        match load_presets(&EXPORTED[..end]) {
            Err(LoadError::Truncated { len, .. }) => assert_eq!(len, end as u64),
            other => panic!("cut at {end}: {other:?}"),
        }
    }
}

/// Small files can ask for many knots.
#[test]
fn knots_are_counted() {
    // Hues that turn many times on each way from black to white.
    let points: Vec<String> =
        (0..2000).map(|i| format!("{i},{}", ["0,0,0.01", "1,1,0.9"][i % 2])).collect();
    let points = points.join(",");
    let text = format!(r#"[{{"Name":"a","ColorSpace":"Diverging","RGBPoints":[{points}]}}]"#);
    let message = refused(&text);
    assert!(message.contains("262145 knots, but at most 262144 are supported"), "{message}");
    assert_modest();
}
