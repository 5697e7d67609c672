//! A histogram of directions, and what it says of a density.

use glam::{DVec4, Vec3};

use super::findings::Findings;
use super::sphere::SphereBins;
use super::statistics::pearson;

/// Counts of sampled directions in bins that follow a lobe.
pub(super) struct Histogram {
    bins: SphereBins,
    counts: Vec<u64>,
}

impl Histogram {
    /// Creates an empty one, with bins for pilot samples: directions and densities. Those without a
    /// density do not count.
    pub(super) fn new(pilot: impl Iterator<Item = (Vec3, f32)>) -> Self {
        let spread: Vec<(Vec3, f32)> =
            pilot.filter(|(wi, pdf)| *pdf > 0.0 && wi.is_finite()).collect();
        let peak = spread.iter().max_by(|a, b| a.1.total_cmp(&b.1)).map_or(Vec3::Z, |s| s.0);
        let bins = SphereBins::new(peak, &spread.iter().map(|s| s.0).collect::<Vec<_>>());
        let counts = vec![0; bins.count()];
        Self { bins, counts }
    }

    pub(super) fn add(&mut self, wi: Vec3) {
        self.counts[self.bins.of(wi)] += 1;
    }

    /// Compares the counts of `n` samples, some of which may be in no bin, with the density `of(w).w`,
    /// and returns the integral of `of`. Sums may be off by `limit` standard deviations, and the
    /// integral of the density above 1 by `slack`.
    pub(super) fn compare(
        &self,
        place: &str,
        (n, limit, slack): (f64, f64, f64),
        of: &dyn Fn(Vec3) -> DVec4,
        found: &mut Findings,
    ) -> DVec4 {
        let integrals = self.bins.integrals(n, of);
        let expected: Vec<f64> = integrals.iter().map(|i| i.w * n).collect();
        let test = pearson(&self.counts, &expected);
        if test.z > limit {
            let (z, bin) = (test.z, test.worst);
            let (wi, count, expected) = (self.bins.middle(bin), self.counts[bin], expected[bin]);
            found.add(
                "samples and pdf differ",
                format!(
                    "{place}: chi-square {z:.1} standard deviations off, {limit:.1} allowed; most around \
                     wi {wi}, {count} samples where {expected:.1} are expected"
                ),
            );
        }
        let total: DVec4 = integrals.iter().sum();
        if total.w > 1.0 + slack {
            found.add("pdf integrates to more than 1", format!("{place}: {:.5}", total.w));
        }
        total
    }
}
