//! The channels of a film: means of every number of a kernel's results.

use super::moments::{Moments, MomentsOn, Sums};
use super::store::Store;
use super::{Image, Radiance};
use crate::machine::{Floats, Machine, Scalar, Schema, Type, Value, Var, op};

/// What a [`Film`](super::Film) keeps of the results `R` of a kernel: their colours, for a `Film`,
/// or all their numbers, for a `Film<R>`.
pub trait Kept<R: Radiance>: 'static {
    /// The moments of a pixel in a pass.
    #[doc(hidden)]
    type Moments: Type;

    /// Returns the moments of no samples.
    #[doc(hidden)]
    fn none() -> Self::Moments;

    /// Adds a sample.
    #[doc(hidden)]
    fn add(moments: &mut Self::Moments, result: R);

    /// Adds a sample in the running lanes.
    #[doc(hidden)]
    fn add_on<M: Machine>(m: &M, moments: &Var<<Self::Moments as Type>::On<M>>, result: R::On<M>);

    /// Adds a pass of `samples` samples per pixel to a film.
    #[doc(hidden)]
    fn join(pass: &Image<Self::Moments>, samples: u32, film: &mut Store);
}

impl<R: Radiance> Kept<R> for () {
    type Moments = Moments;

    fn none() -> Moments {
        Moments::none()
    }

    fn add(moments: &mut Moments, result: R) {
        moments.add(result.rgba());
    }

    #[inline(always)]
    fn add_on<M: Machine>(m: &M, moments: &Var<MomentsOn<M>>, result: R::On<M>) {
        Moments::add_on(m, moments, R::rgba_on(m, result));
    }

    fn join(pass: &Image<Moments>, samples: u32, film: &mut Store) {
        film.join(pass, samples);
    }
}

/// The moments of the colour, then the means and the sums of squared deviations of all numbers.
impl<R: Radiance> Kept<R> for R {
    type Moments = (Moments, R, R);

    fn none() -> (Moments, R, R) {
        let zero = R::read(&vec![0; R::SCHEMA.size()]);
        (Moments::none(), zero, zero)
    }

    fn add((color, mean, m2): &mut (Moments, R, R), result: R) {
        color.add(result.rgba());
        // The operations of the lifted code, so that packets have the same bits.
        let m = Scalar::default();
        let [value, old, apart] = [result, *mean, *m2].map(|v| R::splat(&m, v));
        let (new, apart) = with_sample::<_, R::On<Scalar>>(&m, color.count, value, old, apart);
        (*mean, *m2) = (R::lane::<Scalar>(&new, 0), R::lane::<Scalar>(&apart, 0));
    }

    #[inline(always)]
    fn add_on<M: Machine>(
        m: &M,
        moments: &Var<(MomentsOn<M>, R::On<M>, R::On<M>)>,
        result: R::On<M>,
    ) {
        let (color, mean, m2) = moments.get(m);
        let var = Var::new(m, "color", color);
        Moments::add_on(m, &var, R::rgba_on(m, result));
        let color = var.get(m);
        let (mean, m2) = with_sample(m, color.count.0, result, mean, m2);
        moments.set(m, (color, mean, m2));
    }

    fn join(pass: &Image<(Moments, R, R)>, samples: u32, film: &mut Store) {
        let mut bytes = [vec![0; R::SCHEMA.size()], vec![0; R::SCHEMA.size()]];
        if let Store { channels: Some(channels), pixels, .. } = film {
            for (i, ((color, mean, m2), before)) in pass.pixels().iter().zip(pixels).enumerate() {
                mean.write(&mut bytes[0]);
                m2.write(&mut bytes[1]);
                channels.join(i, before.count, color.count, &bytes);
            }
        }
        film.join(&pass.map(|(color, ..)| *color), samples);
    }
}

/// Returns the mean and the sum of squared deviations with one more sample, the `count`-th, in every
/// float; other leaves of the mean are those of the sample. (Welford, "Note on a Method for
/// Calculating Corrected Sums of Squares and Products", Technometrics 1962.)
#[inline(always)]
fn with_sample<M: Machine, V: Value<M>>(m: &M, count: M::U32, value: V, mean: V, m2: V) -> (V, V) {
    let count = m.u32_to_f32(count);
    let minus =
        |a: V, b: V| V::zip(m, a, b, &mut Floats(|m: &M, a, b| m.f32_binary(op::Sub, a, b)));
    let from_mean = minus(value, mean);
    let step = |m: &M, from, mean| m.f32_binary(op::Add, mean, m.f32_binary(op::Div, from, count));
    let mean = V::zip(m, from_mean, mean, &mut Floats(step));
    let times = |m: &M, a, b| m.f32_binary(op::Mul, a, b);
    let square = V::zip(m, from_mean, minus(value, mean), &mut Floats(times));
    let plus = |m: &M, a, b| m.f32_binary(op::Add, a, b);
    (mean, V::zip(m, m2, square, &mut Floats(plus)))
}

/// The mean and the sum of squared deviations of a number.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Number {
    mean: f64,
    m2: f64,
}

impl Number {
    /// Merges the `k` samples of another with these `n`, as [`Sums::merge`] does.
    fn merge(&mut self, n: u64, other: Self, k: u64) {
        let (n, k) = (n as f64, k as f64);
        let apart = other.mean - self.mean;
        self.mean += apart * (k / (n + k));
        self.m2 += other.m2 + apart * apart * (n * k / (n + k));
    }
}

/// The channels of all pixels of a film, over all passes.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ChannelSums {
    /// The size of a result in bytes, and the offsets of its floats.
    size: usize,
    offsets: Vec<usize>,
    /// The floats of each pixel.
    numbers: Vec<Number>,
    /// The bytes of each pixel's last sample; its floats do not count.
    last: Vec<u8>,
}

impl ChannelSums {
    /// Creates the sums of results of this layout without samples.
    pub(super) fn new(schema: &Schema, pixels: usize) -> Self {
        let mut offsets = Vec::new();
        floats(schema, 0, &mut offsets);
        let numbers = vec![Number::default(); pixels * offsets.len()];
        Self { size: schema.size(), last: vec![0; pixels * schema.size()], offsets, numbers }
    }

    pub(super) fn clear(&mut self) {
        self.numbers.fill(Number::default());
        self.last.fill(0);
    }

    /// Merges a pass of `count` samples of a pixel that has `before`: the bytes of the means and of
    /// the sums of squared deviations.
    fn join(&mut self, pixel: usize, before: u64, count: u32, [mean, m2]: &[Vec<u8>; 2]) {
        if count == 0 {
            return;
        }
        let float = |bytes: &[u8], at: usize| f64::from(f32::read(&bytes[at..]));
        let Self { offsets, numbers, .. } = self;
        for (number, at) in numbers[pixel * offsets.len()..].iter_mut().zip(&*offsets) {
            let pass = Number { mean: float(mean, *at), m2: float(m2, *at) };
            number.merge(before, pass, u64::from(count));
        }
        self.last[pixel * self.size..][..self.size].copy_from_slice(mean);
    }

    /// Merges the channels of another film; `pixels` and `others` have the counts.
    pub(super) fn merge(&mut self, pixels: &[Sums], other: &Self, others: &[Sums]) {
        for (i, (before, more)) in pixels.iter().zip(others).enumerate() {
            if more.count == 0 {
                continue;
            }
            let n = self.offsets.len();
            let numbers = i * n..(i + 1) * n;
            let added = &other.numbers[numbers.clone()];
            for (number, added) in self.numbers[numbers].iter_mut().zip(added) {
                number.merge(before.count, *added, more.count);
            }
            let bytes = i * self.size..(i + 1) * self.size;
            self.last[bytes.clone()].copy_from_slice(&other.last[bytes]);
        }
    }

    /// Writes `f` of each number of a pixel, and the integers of its last sample or zeros.
    pub(super) fn write(
        &self,
        pixel: usize,
        with_integers: bool,
        out: &mut [u8],
        f: impl Fn(f64, f64) -> f64,
    ) {
        out.fill(0);
        if with_integers {
            out.copy_from_slice(&self.last[pixel * self.size..][..self.size]);
        }
        let numbers = &self.numbers[pixel * self.offsets.len()..];
        for (number, at) in numbers.iter().zip(&self.offsets) {
            (f(number.mean, number.m2) as f32).write(&mut out[*at..]);
        }
    }
}

/// Collects the offsets of all floats.
fn floats(schema: &Schema, at: usize, offsets: &mut Vec<usize>) {
    match schema {
        Schema::F32 => offsets.push(at),
        Schema::Vector(element, n) => {
            (0..*n).for_each(|i| floats(element, at + i * element.size(), offsets));
        }
        Schema::Array { element, count, stride } => {
            (0..*count).for_each(|i| floats(element, at + i * stride, offsets));
        }
        Schema::Struct { fields, .. } => {
            fields.iter().for_each(|f| floats(f.schema, at + f.offset, offsets));
        }
        Schema::I32
        | Schema::U32
        | Schema::Bool
        | Schema::Small { .. }
        | Schema::Kind { .. }
        | Schema::Host => {}
    }
}
