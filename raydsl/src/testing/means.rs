//! Agreement of pictures in their means, where single samples cannot agree.

use core::fmt;

use glam::{DVec4, UVec2, UVec4, uvec2};

use crate::render::{Film, Sampling};
use crate::sampling::pcg4d;

/// The edge of a block in pixels.
const BLOCK: u32 = 16;

/// The probability with which a bias that is said to be found is missed.
const MISS: f64 = 1e-3;

/// The part of [`MeansTest::bias`] that is allowed: rounding itself is a bias.
const ALLOWED: f64 = 0.1;

/// A mean that is darker than this share of the picture's is allowed as much as one of this size.
const DARK: f64 = 0.01;

/// The limit on ratios, in units of [`MeansTest::bias`].
const LIMIT: f64 = 10.0;

/// The sizes of sums, each of them of light and of ratios.
const SCALES: [&str; 3] = ["picture", "blocks of 16 x 16", "pixels"];
const KINDS: [&str; 2] = ["light", "ratio"];

const CHANNELS: [&str; 4] = ["red", "green", "blue", "alpha"];

/// A test whether two variants of a kernel give the same picture, up to a small bias: a comparison
/// of single samples says little where rounding decides which path a sample takes.
///
/// Both variants take the same samples, in independent *replications* of the picture. The
/// differences of their means are added up over the picture, over blocks of 16 by 16 pixels and
/// over each pixel, as they are (*light*), and relative to the means and limited (*ratio*): a few
/// bright paths hide what is wrong in all others from the first, and are hidden from the second. A
/// sum `S` of differences `d` fails the test if
///
/// > `|S| - a > z sqrt(sum of d^2)`, with `z = sqrt(2 ln(2 n / p))`.
///
/// `a` is an allowance of a tenth of [`Self::bias`], as rounding itself is a bias, and `p / n` is
/// the probability of a false alarm for one of `n` sums (Bonferroni): sums of each size and kind
/// have a sixth of [`Self::false_alarm`]. The bound holds for any distribution of differences that is
/// symmetric beyond the allowance, however rare and large they are (Hoeffding, "Probability
/// Inequalities for Sums of Bounded Random Variables", 1963, applied to the signs; Efron,
/// "Student's t-Test Under Symmetry Conditions", 1969). A normal distribution is not assumed: the
/// differences of paths are 0 but for the few that rounding sends another way.
///
/// Common samples make the variance of a difference far smaller than that of two pictures (Law,
/// "Simulation Modeling and Analysis", 5th edition, 2015, section 11.2), so that the test is
/// sharper than the pictures' own noise. [`MeansAgreement`] states which bias it finds.
///
/// ```
/// use raydsl::prelude::*;
/// use raydsl::testing::{MeansTest, MeansVerdict, PairedMeans};
///
/// let camera = Pinhole::new(vec3(0.0, 0.0, 5.0), Vec3::ZERO, Vec3::Y, 1.0);
/// let sky = |gain: f32| {
///     let kernel = kernel!(|ray: Ray, sampler: Sampler| {
///         let mut sampler = sampler;
///         gain * (1.0 + ray.direction.x + sampler.next_1d())
///     });
///     let test = MeansTest::new();
///     let films = test.replications().map(|sampling| {
///         let mut film = Film::new(32, 32);
///         TiledScheduler::new().accumulate(&camera, &kernel, &sampling, &mut film, test.samples);
///         film
///     });
///     films.collect::<Vec<Film>>()
/// };
/// let verdict_on = |gain: f32| {
///     let mut means = PairedMeans::new(&MeansTest::new(), 32, 32);
///     sky(1.0).iter().zip(&sky(gain)).for_each(|(a, b)| means.add(a, b));
///     means.agreement().verdict()
/// };
/// assert_eq!(verdict_on(1.0 + 1e-6), MeansVerdict::Agree);
/// assert_eq!(verdict_on(1.01), MeansVerdict::Differ);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeansTest {
    /// The samples: their method and positions in pixels. Each replication has another seed.
    pub sampling: Sampling,
    /// The number of replications: 64 unless set, and at least 2.
    pub replications: u32,
    /// The number of samples of each pixel in a replication: 4 unless set.
    pub samples: u32,
    /// The relative bias that the test should find: 0.01 unless set.
    pub bias: f64,
    /// The probability that variants fail whose differences have no bias: 1e-6 unless set.
    pub false_alarm: f64,
}

impl Default for MeansTest {
    fn default() -> Self {
        Self::new()
    }
}

impl MeansTest {
    /// Creates a test of 64 replications of 4 jittered Sobol samples per pixel.
    pub const fn new() -> Self {
        let sampling = Sampling::new(4);
        Self { sampling, replications: 64, samples: 4, bias: 0.01, false_alarm: 1e-6 }
    }

    /// Sets the sampling method, the positions in pixels and the seed.
    #[must_use]
    pub const fn sampling(self, sampling: Sampling) -> Self {
        Self { sampling, ..self }
    }

    /// Sets the number of replications, and of samples per pixel in each.
    #[must_use]
    pub const fn samples(self, replications: u32, samples: u32) -> Self {
        Self { replications, samples, ..self }
    }

    /// Sets the relative bias that the test should find.
    #[must_use]
    pub const fn bias(self, bias: f64) -> Self {
        Self { bias, ..self }
    }

    /// Sets the probability of a false alarm.
    #[must_use]
    pub const fn false_alarm(self, probability: f64) -> Self {
        Self { false_alarm: probability, ..self }
    }

    /// Returns the sampling of each replication.
    pub fn replications(&self) -> impl Iterator<Item = Sampling> + use<> {
        let (sampling, planned) = (self.sampling, self.samples.max(1));
        (0..self.replications.max(2)).map(move |i| {
            let key = UVec4::new(sampling.seed, i, 0x6d65_616e, 0x7061_6972);
            Sampling { seed: pcg4d(key).x, planned, ..sampling }
        })
    }
}

/// What one sum of differences needs.
#[derive(Clone, Copy, Default)]
struct Sum {
    /// The sum of the differences.
    difference: DVec4,
    /// The sum of their squares.
    squares: DVec4,
    /// The sum of the sizes of the expected means.
    size: DVec4,
    /// The sum of the squares of the expected means.
    size_squares: DVec4,
}

impl Sum {
    /// Returns a difference, where `size` is expected.
    fn of(difference: DVec4, size: DVec4) -> Self {
        let (squares, size_squares) = (difference * difference, size * size);
        Self { difference, squares, size, size_squares }
    }

    fn add(&mut self, other: &Self) {
        self.difference += other.difference;
        self.squares += other.squares;
        self.size += other.size;
        self.size_squares += other.size_squares;
    }

    /// Returns the distance of the sum from the allowed ones in a channel, in roots of the sum of
    /// squares.
    fn z(&self, channel: usize, allowed: f64) -> f64 {
        let beyond = (self.difference[channel].abs() - allowed).max(0.0);
        if beyond == 0.0 { 0.0 } else { beyond / self.squares[channel].sqrt() }
    }

    /// Returns the relative bias in a channel that is found but for a probability of [`MISS`], if
    /// `z` is the limit: infinity if there are too few differences, 0 if nothing is seen there.
    fn finds(&self, channel: usize, allowed: f64, z: f64) -> f64 {
        let (size, noise) = (self.size[channel], self.squares[channel]);
        if size == 0.0 {
            return 0.0;
        }
        // A bias `b` adds `b^2` times the squares of the means to those of the differences:
        // (b - allowed)^2 size^2 = k^2 (noise + b^2 squares).
        let k = z + (-2.0 * MISS.ln()).sqrt();
        let (a, share) = (allowed / size, k * k * self.size_squares[channel] / (size * size));
        let (rest, constant) = (1.0 - share, a * a - k * k * noise / (size * size));
        if rest <= 0.0 { f64::INFINITY } else { (a + (a * a - rest * constant).sqrt()) / rest }
    }
}

/// The differences of two variants' pictures, replication by replication.
#[derive(Clone)]
pub struct PairedMeans {
    test: MeansTest,
    width: u32,
    /// Sums of light and of ratios.
    pixels: [Vec<Sum>; 2],
    replications: u32,
    /// Means that are finite in one variant only, and the first such pixel.
    nonfinite: u64,
    first_nonfinite: Option<UVec2>,
}

impl fmt::Debug for PairedMeans {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PairedMeans").field("replications", &self.replications).finish()
    }
}

impl PairedMeans {
    /// Creates a comparison of films of `width` by `height` pixels without replications.
    pub fn new(test: &MeansTest, width: u32, height: u32) -> Self {
        let pixels = [(); 2].map(|()| vec![Sum::default(); width as usize * height as usize]);
        let (replications, nonfinite, first_nonfinite) = (0, 0, None);
        Self { test: *test, width, pixels, replications, nonfinite, first_nonfinite }
    }

    /// Adds a replication: the films of both variants, of the same samples. Differences must be
    /// independent: a kernel whose result does not depend on its sample, neither by its position in
    /// the pixel nor by its `Sampler`, differs in all replications alike.
    ///
    /// # Panics
    ///
    /// If a film has another size.
    pub fn add(&mut self, expected: &Film, found: &Film) {
        let same = |film: &Film| film.means().count() == self.pixels[0].len();
        assert!(same(expected) && same(found), "both films have the size of the comparison");
        let dark = 0.5 * DARK * (mean_size(expected) + mean_size(found));
        let limit = DVec4::splat(LIMIT * self.test.bias);
        for (i, (a, b)) in expected.means().zip(found.means()).enumerate() {
            match (a.is_finite(), b.is_finite()) {
                (true, true) => {
                    let size = (0.5 * (a.abs() + b.abs())).max(dark);
                    // Where nothing is expected at all, nothing is found.
                    let is_seen = size.cmpgt(DVec4::ZERO);
                    let ratio = DVec4::select(is_seen, (b - a) / size, DVec4::ZERO);
                    let one = DVec4::select(is_seen, DVec4::ONE, DVec4::ZERO);
                    self.pixels[0][i].add(&Sum::of(b - a, a.abs()));
                    self.pixels[1][i].add(&Sum::of(ratio.clamp(-limit, limit), one));
                }
                // Both left the numbers: that is no difference of variants.
                (false, false) => {}
                _ => {
                    self.nonfinite += 1;
                    self.first_nonfinite.get_or_insert(self.place(i));
                }
            }
        }
        self.replications += 1;
    }

    fn place(&self, pixel: usize) -> UVec2 {
        let width = self.width.max(1) as usize;
        uvec2((pixel % width) as u32, (pixel / width) as u32)
    }

    /// Returns the sums over blocks of 16 by 16 pixels, row by row.
    fn blocks(&self, pixels: &[Sum]) -> Vec<Sum> {
        let columns = self.width.div_ceil(BLOCK) as usize;
        let rows = pixels.len().div_ceil(self.width.max(1) as usize).div_ceil(BLOCK as usize);
        let mut blocks = vec![Sum::default(); columns * rows];
        for (i, sum) in pixels.iter().enumerate() {
            let at = self.place(i) / BLOCK;
            blocks[at.y as usize * columns + at.x as usize].add(sum);
        }
        blocks
    }

    /// Returns what all replications say.
    pub fn agreement(&self) -> MeansAgreement {
        let columns = self.width.div_ceil(BLOCK).max(1) as usize;
        let block = |i: usize| uvec2((i % columns) as u32, (i / columns) as u32) * BLOCK;
        let [light, ratio] = [&self.pixels[0], &self.pixels[1]].map(|pixels| {
            let mut picture = Sum::default();
            pixels.iter().for_each(|sum| picture.add(sum));
            let dark = picture.size * (DARK / pixels.len().max(1) as f64);
            let blocks = self.blocks(pixels);
            let scale = |sums: &[Sum], place: &dyn Fn(usize) -> UVec2| {
                let pixels_of_each = pixels.len() as f64 / sums.len().max(1) as f64;
                self.scale(sums, dark * pixels_of_each, place)
            };
            [
                scale(&[picture], &|_| UVec2::ZERO),
                scale(&blocks, &block),
                scale(pixels, &|i| self.place(i)),
            ]
        });
        MeansAgreement {
            test: self.test,
            replications: self.replications,
            light,
            ratio,
            nonfinite: self.nonfinite,
            first_nonfinite: self.first_nonfinite,
        }
    }

    fn scale(&self, sums: &[Sum], dark: DVec4, place: &dyn Fn(usize) -> UVec2) -> Scale {
        let tests = sums.len() * CHANNELS.len();
        let families = (SCALES.len() * KINDS.len()) as f64;
        let limit = (2.0 * (2.0 * families * tests as f64 / self.test.false_alarm).ln()).sqrt();
        let (mut z, mut at, mut finds) = (0.0, (UVec2::ZERO, CHANNELS[0]), Vec::new());
        for (i, sum) in sums.iter().enumerate() {
            for (channel, name) in CHANNELS.into_iter().enumerate() {
                let size = sum.size[channel].max(dark[channel]);
                let allowed = ALLOWED * self.test.bias * size;
                let found = sum.z(channel, allowed);
                if found > z {
                    (z, at) = (found, (place(i), name));
                }
                finds.push(sum.finds(channel, allowed, limit));
            }
        }
        finds.sort_by(f64::total_cmp);
        let median = finds.get(finds.len() / 2).copied().unwrap_or(f64::INFINITY);
        let worst = finds.last().copied().unwrap_or(f64::INFINITY);
        Scale { tests: tests as u64, z, limit, pixel: at.0, channel: at.1, median, worst }
    }
}

/// Returns the mean size of a film's finite means.
fn mean_size(film: &Film) -> DVec4 {
    let (mut sum, mut count) = (DVec4::ZERO, 0u64);
    for mean in film.means().filter(|m| m.is_finite()) {
        sum += mean.abs();
        count += 1;
    }
    sum / count.max(1) as f64
}

/// The sums of differences of one kind over parts of one size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// The number of sums.
    pub tests: u64,
    /// The largest `(|S| - a) / sqrt(sum of d^2)`; see [`MeansTest`].
    pub z: f64,
    /// The limit on it.
    pub limit: f64,
    /// The first pixel of the part with the largest.
    pub pixel: UVec2,
    /// Its channel.
    pub channel: &'static str,
    /// The relative bias of a part that is found in half of the parts and channels, but for one time
    /// in a thousand. For ratios it is a bias of all samples alike.
    pub median: f64,
    /// The relative bias that is found in every part.
    pub worst: f64,
}

impl Scale {
    /// Returns whether all sums are within the limit.
    pub fn agrees(&self) -> bool {
        self.z <= self.limit
    }
}

/// The result of a [`MeansTest`]. Printed, it is a table.
#[must_use = "an agreement that nobody reads finds nothing"]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeansAgreement {
    /// The test.
    pub test: MeansTest,
    /// The number of replications.
    pub replications: u32,
    /// Differences as they are: the sums over the picture, over blocks of 16 by 16 pixels, and over
    /// each pixel.
    pub light: [Scale; 3],
    /// Differences relative to the means, the same sums.
    pub ratio: [Scale; 3],
    /// Means of pixels in replications that are finite in one variant only.
    pub nonfinite: u64,
    /// The first such pixel.
    pub first_nonfinite: Option<UVec2>,
}

/// The verdict of a [`MeansTest`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MeansVerdict {
    /// No sum of differences is beyond its limit, and a bias of [`MeansTest::bias`] of the picture
    /// would be.
    Agree,
    /// A sum of differences is beyond its limit, or a mean is finite in one variant only.
    Differ,
    /// No sum is beyond its limit, but a bias of [`MeansTest::bias`] might not be either: more
    /// samples are needed.
    TooFewSamples,
}

impl MeansAgreement {
    /// Returns the verdict.
    pub fn verdict(&self) -> MeansVerdict {
        if self.nonfinite > 0 || !self.light.iter().chain(&self.ratio).all(Scale::agrees) {
            MeansVerdict::Differ
        } else if self.light[0].worst <= self.test.bias {
            MeansVerdict::Agree
        } else {
            MeansVerdict::TooFewSamples
        }
    }
}

/// Prints a share in per cent.
struct Percent(f64);

impl fmt::Display for Percent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let text = match 100.0 * self.0 {
            v if v > 100.0 => "none".to_owned(),
            v => format!("{v:.2} %"),
        };
        f.pad(&text)
    }
}

impl fmt::Display for MeansAgreement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let head = format!("{} x {} samples", self.replications, self.test.samples);
        writeln!(
            f,
            "{head:<24}    sums  largest z   limit  finds a bias of  where the largest is"
        )?;
        for (part, name) in SCALES.into_iter().enumerate() {
            for (kind, s) in KINDS.into_iter().zip([self.light[part], self.ratio[part]]) {
                let place = match s.z > 0.0 {
                    false => "nowhere".to_owned(),
                    true if part == 0 => s.channel.to_owned(),
                    true => format!("{} at ({}, {})", s.channel, s.pixel.x, s.pixel.y),
                };
                let finds = Percent(if part == 0 { s.worst } else { s.median });
                let (name, tests) = (format!("{name}, {kind}"), s.tests);
                write!(f, "{name:<24} {tests:>7} {:>10.2} {:>7.2} {finds:>16}", s.z, s.limit)?;
                writeln!(f, "  {place}")?;
            }
        }
        if let Some(at) = self.first_nonfinite {
            let (n, x, y) = (self.nonfinite, at.x, at.y);
            writeln!(f, "{n} means are finite in one variant only, the first at ({x}, {y})")?;
        }
        let (bias, worst) = (Percent(self.test.bias), Percent(self.light[0].worst));
        match self.verdict() {
            MeansVerdict::Agree => write!(f, "the means agree: a bias of {bias} would be found"),
            MeansVerdict::Differ => write!(f, "the means differ"),
            MeansVerdict::TooFewSamples => {
                write!(f, "too few samples: the smallest bias found is {worst}, not {bias}")
            }
        }?;
        writeln!(f, " (false alarms: {:e}, misses: {MISS:e})", self.test.false_alarm)
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec4;

    use super::*;
    use crate::render::{Image, Moments};

    const SIZE: u32 = 24;

    /// Returns numbers from 0 to 1.
    fn random(seed: u32, pixel: u32, replication: u32) -> [f64; 4] {
        let words = pcg4d(UVec4::new(seed, pixel, replication, 0x7465_7374));
        words.to_array().map(|w| f64::from(w) / 4_294_967_296.0)
    }

    fn film(value: impl Fn(u32) -> f64) -> Film {
        let mut film = Film::new(SIZE, SIZE);
        let image = Image::from_fn(SIZE, SIZE, |x, y| {
            let mean = Vec4::splat(value(y * SIZE + x) as f32);
            Moments { count: 4, mean, m2: Vec4::ZERO }
        });
        film.join(&image, 4);
        film
    }

    /// Returns the agreement of noisy pictures, where the found one is `gain` times as bright, and
    /// every hundredth path goes another way: most to a place of about the same light, few to a
    /// lamp.
    fn agreement(seed: u32, test: &MeansTest, gain: impl Fn(u32) -> f64) -> MeansAgreement {
        let mut means = PairedMeans::new(test, SIZE, SIZE);
        for r in 0..test.replications {
            let light = |u: f64| if u < 0.002 { 100.0 } else { 0.5 + u };
            let expected = |p: u32| light(random(seed, p, r)[0]);
            let found = |p: u32| {
                let [u, flips, other, _] = random(seed, p, r);
                gain(p) * light(if flips < 0.01 { other } else { u }) * (1.0 + 1e-6)
            };
            means.add(&film(expected), &film(found));
        }
        means.agreement()
    }

    /// Tests the stated probability of a false alarm where it can be counted.
    #[test]
    fn right_variants_rarely_fail() {
        let test = MeansTest::new().samples(24, 4).bias(0.1).false_alarm(0.05);
        let failed = |seed: &u32| {
            let found = agreement(*seed, &test, |_| 1.0);
            found.verdict() == MeansVerdict::Differ
        };
        let alarms = (0..400).filter(failed).count();
        // Twenty are allowed: more than 35 of a binomial distribution are one in a thousand. The
        // bound is far from sharp, so there are fewer.
        assert!(alarms <= 20, "{alarms}");
        let test = MeansTest::new().false_alarm(1e-6);
        assert!(
            (0..20).all(|seed| agreement(seed, &test, |_| 1.0).verdict() != MeansVerdict::Differ)
        );
    }

    #[test]
    fn biased_variants_fail() {
        let test = MeansTest::new();
        for seed in 0..20 {
            let of = |gain: &dyn Fn(u32) -> f64| agreement(seed, &test, gain);
            let right = of(&|_| 1.0);
            let finds = right.light[0].worst;
            // What is said to be found is.
            let found = of(&|_| 1.0 + finds);
            assert_eq!(found.verdict(), MeansVerdict::Differ, "{seed}: {finds}\n{found}");
            // One per cent, of which rare bright paths hide most in the light.
            assert_eq!(of(&|_| 1.01).verdict(), MeansVerdict::Differ, "{seed}");
            // The bias of a block, where those of others make up for it.
            let blocks = |p: u32| if p % SIZE < 16 { 1.1 } else { 0.8 };
            let found = of(&blocks);
            assert!(!found.ratio[1].agrees(), "{seed}\n{found}");
            // One pixel that is wrong.
            let found = of(&|p| if p == 77 { 3.0 } else { 1.0 });
            assert!(
                !found.ratio[2].agrees() && found.ratio[2].pixel == uvec2(5, 3),
                "{seed}\n{found}"
            );
        }
    }

    /// Tests that few samples are no agreement, and what a missing number is.
    #[test]
    fn no_agreement_without_evidence() {
        let few = MeansTest::new().samples(2, 1);
        let found = agreement(1, &few, |_| 1.0);
        assert_eq!(found.verdict(), MeansVerdict::TooFewSamples, "{found}");
        assert!(found.light[0].worst > few.bias);
        let mut means = PairedMeans::new(&few, SIZE, SIZE);
        means.add(&film(|_| 1.0), &film(|p| if p == 30 { f64::NAN } else { 1.0 }));
        let found = means.agreement();
        assert_eq!((found.verdict(), found.nonfinite), (MeansVerdict::Differ, 1));
        assert_eq!(found.first_nonfinite, Some(uvec2(6, 1)));
        let mut means = PairedMeans::new(&few, SIZE, SIZE);
        means.add(&film(|_| f64::NAN), &film(|_| f64::NAN));
        assert_eq!(means.agreement().nonfinite, 0);
    }

    #[test]
    fn tables_are_narrow() {
        let found =
            agreement(3, &MeansTest::new().samples(8, 2), |p| if p == 9 { 50.0 } else { 1.0 });
        let table = found.to_string();
        assert!(table.lines().all(|l| l.chars().count() <= 100), "{table}");
        assert!(table.lines().count() == 8, "{table}");
    }
}
