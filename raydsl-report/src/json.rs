//! JSON of a comparison.

use serde_json::{Value, json as value};

use super::{Comparison, Missing, Row, Verdict};
use raydsl::machine::Type;
use raydsl::testing::{MeansAgreement, MeansVerdict, Scale};

/// Figures of the scene, unknown to a comparison.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneInfo {
    /// The scene's name.
    pub scene: String,
    /// The number of primitives.
    pub primitives: u64,
    /// The build time of the tree, in milliseconds.
    pub build_ms: f64,
    /// The tree's size in bytes.
    pub bvh_bytes: u64,
}

pub(super) fn json<R: Type>(c: &Comparison<R>, scene: &SceneInfo) -> Value {
    let image = &c.scalar().image;
    let (width, height) = (image.width(), image.height());
    let variants: Vec<Value> = c.rows.iter().map(|r| row(r, c.scalar())).collect();
    value!({
        "scene": scene.scene,
        "primitives": scene.primitives,
        "width": width,
        "height": height,
        "rays": u64::from(width) * u64::from(height),
        "adapter": c.adapter,
        "build_ms": scene.build_ms,
        "bvh_bytes": scene.bvh_bytes,
        "verdict": match c.verdict() {
            Verdict::Agree => "agree",
            Verdict::MeansAgree => "means agree",
            Verdict::Differ => "differ",
            Verdict::Refused => "refused",
            Verdict::NotMeaningful => "not meaningful",
            Verdict::NothingCompared => "nothing compared",
        },
        "tolerance_ulp": c.tolerance,
        "rounding": {
            "sum_ulp": c.rounding.sum / f64::from(f32::EPSILON),
            "quotient_ulp": c.rounding.quotient / f64::from(f32::EPSILON),
            "root_ulp": c.rounding.root / f64::from(f32::EPSILON),
            "elementary_ulp": c.rounding.elementary / f64::from(f32::EPSILON),
        },
        "sampled": c.sample.inputs,
        "uncertain_share": c.sample.share(),
        "median_width_ulp": number(c.sample.median_width_ulp),
        "means": c.means.as_ref().map(means),
        "variants": variants,
    })
}

fn means(m: &MeansAgreement) -> Value {
    let scale = |s: &Scale| {
        value!({
            "sums": s.tests,
            "z": number(s.z),
            "limit": s.limit,
            "pixel": [s.pixel.x, s.pixel.y],
            "channel": s.channel,
            "finds_bias_in_half": number(s.median),
            "finds_bias_in_all": number(s.worst),
        })
    };
    let scales = |[picture, blocks, pixels]: &[Scale; 3]| value!({ "picture": scale(picture), "blocks": scale(blocks), "pixels": scale(pixels) });
    value!({
        "verdict": match m.verdict() {
            MeansVerdict::Agree => "agree",
            MeansVerdict::Differ => "differ",
            MeansVerdict::TooFewSamples => "too few samples",
        },
        "replications": m.replications,
        "samples": m.test.samples,
        "bias": m.test.bias,
        "false_alarm": m.test.false_alarm,
        "nonfinite": m.nonfinite,
        "light": scales(&m.light),
        "ratio": scales(&m.ratio),
    })
}

/// Returns a number; JSON has no infinity, so that becomes a string.
fn number(v: f64) -> Value {
    if v.is_finite() { v.into() } else { v.to_string().into() }
}

fn row<R: Type>(row: &Row<R>, scalar: &Row<R>) -> Value {
    if let Some(reason) = &row.unavailable {
        let refused = matches!(reason, Missing::Refused(_));
        let name = row.variant.name();
        return value!({ "name": name, "not_run": reason.to_string(), "refused": refused });
    }
    value!({
        "name": row.variant.name(),
        "isa": row.isa,
        "lanes": row.lanes,
        "ms": row.times.median(),
        "mrays_per_s": row.mrays_per_s(),
        "speedup": row.times.speedup_over(&scalar.times),
        "spread": row.times.spread(),
        "bit_identical": row.agreement.is_bit_identical(),
        "max_ulp": row.agreement.max_ulp,
        "hit_mismatches": row.agreement.hit_mismatches,
        "explained": row.agreement.explained,
        "undecided": row.agreement.undecided,
        "unexplained": row.agreement.unexplained,
        "differing_means": row.differing_means,
        "max_error_ulp": number(row.accuracy.max_ulp),
        "mean_error_ulp": number(row.accuracy.mean_ulp),
        "median_error_ulp": number(row.accuracy.median_ulp),
        "other_paths": row.accuracy.other_paths,
    })
}
