//! Bins of time, as ways of sound.

/// Bins of equal length from 0 on. Sound of a wave that has gone from `a` to `b` metres is in all
/// bins between.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bins {
    /// How many there are.
    pub(crate) count: usize,
    /// Metres that sound goes in one.
    pub(crate) length: f64,
}

impl Bins {
    /// Where the last one ends.
    pub(crate) fn reach(&self) -> f64 {
        self.count as f64 * self.length
    }

    /// The bins between two ways, with the part that lies in each.
    pub(crate) fn parts(self, from: f64, to: f64) -> impl Iterator<Item = (usize, f64, f64)> {
        // Rounding may name a bin too many at both ends.
        let first = (from / self.length) as usize;
        let end = ((to / self.length).ceil() as usize).min(self.count);
        let part = move |i| {
            let low = i as f64 * self.length;
            (i, from.max(low), to.min(low + self.length))
        };
        (first..end).map(part).filter(|(_, low, high)| low < high)
    }
}

/// The integral of `exp(-air r)` between two ways.
pub(crate) fn faded(air: f64, from: f64, to: f64) -> f64 {
    let length = to - from;
    if air * length < 1e-12 {
        return (-air * from).exp() * length;
    }
    (-air * from).exp() * -(-air * length).exp_m1() / air
}
