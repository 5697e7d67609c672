//! JSON of a comparison.

use serde_json::{Value, json as value};

use super::{Comparison, Missing, Row, Verdict};
use raydsl::machine::Type;

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
        "variants": variants,
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
        "unexplained": row.agreement.unexplained,
        "max_error_ulp": number(row.accuracy.max_ulp),
        "mean_error_ulp": number(row.accuracy.mean_ulp),
        "median_error_ulp": number(row.accuracy.median_ulp),
        "other_paths": row.accuracy.other_paths,
    })
}
