//! Colours for clouds that carry none.

/// Greys from 16-bit intensities. Scanners use any part of the range, so the 99th
/// percentile becomes white.
pub(crate) fn from_intensity(intensity: &[u16]) -> Vec<[u8; 3]> {
    let mut histogram = vec![0usize; 1 << 16];
    for &i in intensity {
        histogram[usize::from(i)] += 1;
    }
    let mut seen = 0;
    let bright = histogram.iter().position(|&n| {
        seen += n;
        seen * 100 >= intensity.len() * 99
    });
    let white = bright.unwrap_or(1).max(1) as f64;
    // The root lifts the dark half, where most returns lie.
    let grey = |&i: &u16| [((f64::from(i) / white).min(1.0).sqrt() * 255.0).round() as u8; 3];
    intensity.iter().map(grey).collect()
}

/// Colours from blue over green and sand to white, low to high.
pub(crate) fn from_height(positions: &[[f64; 3]]) -> Vec<[u8; 3]> {
    const RAMP: [[f64; 3]; 5] = [
        [58.0, 92.0, 140.0],
        [84.0, 146.0, 110.0],
        [176.0, 180.0, 96.0],
        [206.0, 152.0, 92.0],
        [244.0, 240.0, 232.0],
    ];
    let heights = || positions.iter().map(|p| p[2]).filter(|z| z.is_finite());
    let low = heights().fold(f64::INFINITY, f64::min);
    let high = heights().fold(f64::NEG_INFINITY, f64::max);
    let last = (RAMP.len() - 1) as f64;
    let tint = |p: &[f64; 3]| {
        let t = (p[2] - low) / (high - low);
        // A flat or non-finite cloud gets the middle of the ramp.
        let t = if t.is_finite() { t.clamp(0.0, 1.0) * last } else { 0.5 * last };
        let i = (t as usize).min(RAMP.len() - 2);
        std::array::from_fn(|c| {
            let (a, b) = (RAMP[i][c], RAMP[i + 1][c]);
            (a + (b - a) * (t - i as f64)).round() as u8
        })
    };
    positions.iter().map(tint).collect()
}

/// 16-bit colours to 8 bits. Some writers store 8-bit values unscaled; a file that never
/// exceeds 255 is taken for one of these.
pub(crate) fn from_rgb16(colors: &[[u16; 3]]) -> Vec<[u8; 3]> {
    let narrow = colors.iter().flatten().all(|&c| c <= 255);
    let convert = |c: u16| if narrow { c as u8 } else { (c >> 8) as u8 };
    colors.iter().map(|c| c.map(convert)).collect()
}

/// Colours from numbers that are 0 to 255, or 0 to 1 throughout the file.
///
/// Which of the two is known only at the first value above 1. Until then values are scaled
/// by 255; should they turn out to be bytes, each was 0 or 1 and can be told again.
pub(crate) struct Gathered {
    colors: Vec<[u8; 3]>,
    bytes: bool,
}

impl Gathered {
    /// Collects into `colors`; `bytes` says that the values are 0 to 255 for sure.
    pub(crate) fn new(colors: Vec<[u8; 3]>, bytes: bool) -> Self {
        Self { colors, bytes }
    }

    /// Adds a colour, or gives back the value that is no colour.
    pub(crate) fn push(&mut self, rgb: [f64; 3]) -> Result<(), f64> {
        if let Some(&bad) = rgb.iter().find(|c| !(0.0..=255.0).contains(*c)) {
            return Err(bad);
        }
        if !self.bytes && rgb.iter().any(|&c| c > 1.0) {
            self.bytes = true;
            for c in self.colors.iter_mut().flatten() {
                *c = u8::from(*c >= 128);
            }
        }
        let scale = if self.bytes { 1.0 } else { 255.0 };
        self.colors.push(rgb.map(|c| (c * scale).round() as u8));
        Ok(())
    }

    pub(crate) fn finish(self) -> Vec<[u8; 3]> {
        self.colors
    }
}
