//! Textures beside the definition of their filters.

use raydsl::prelude::*;
use raydsl::texture::{Address, Filter, TextureError};
use raydsl_tests::filters::taps;
use raydsl_tests::rng::Rng;
use raydsl_tests::scaled;

use super::{ADDRESSES, FILTERS};

/// The linear filter at `x` of `n` texels, or the border, that have these values.
pub(super) fn linear(n: u32, address: Address, x: f64, value: impl Fn(Option<i64>) -> f64) -> f64 {
    taps(Filter::Linear, n, address, x).into_iter().map(|(i, w)| w * value(i)).sum()
}

struct Case {
    size: [u32; 3],
    texels: Vec<f32>,
    config: TextureConfig,
}

impl Case {
    fn new(rng: &mut Rng, filter: Filter, dimensions: usize) -> Self {
        let size = [0, 1, 2].map(|i| if i < dimensions { 1 + rng.below(9) as u32 } else { 1 });
        let texels = (0..size.iter().product()).map(|_| rng.range(-1.0, 1.0)).collect();
        let address = [rng.pick(&ADDRESSES), rng.pick(&ADDRESSES), rng.pick(&ADDRESSES)];
        let border = vec4(rng.unit(), 0.0, 0.0, 0.0);
        let config = TextureConfig { filter, address, border, ..TextureConfig::default() };
        Self { size, texels, config }
    }

    fn exact(&self, at: &[f64]) -> f64 {
        let along = |axis: usize| match at.get(axis) {
            Some(&x) => taps(self.config.filter, self.size[axis], self.config.address[axis], x),
            None => vec![(Some(0), 1.0)],
        };
        let [w, h, _] = self.size.map(i64::from);
        let border = f64::from(self.config.border.x);
        let mut sum = 0.0;
        for (z, wz) in along(2) {
            for (y, wy) in along(1) {
                for (x, wx) in along(0) {
                    let i = (|| Some((z? * h + y?) * w + x?))();
                    let v = i.map_or(border, |i| f64::from(self.texels[i as usize]));
                    sum += wx * wy * wz * v;
                }
            }
        }
        sum
    }

    /// Whether a nearest texel may be another one by rounding.
    fn is_open(&self, at: &[f32]) -> bool {
        let place = |(x, n): (&f32, &u32)| f64::from(*x) * f64::from(*n);
        let is_close = |p: f64| (p - p.round()).abs() < 1e-5;
        self.config.filter == Filter::Nearest && at.iter().zip(&self.size).map(place).any(is_close)
    }

    fn check(&self, at: &[f32], found: f32) {
        let wide: Vec<f64> = at.iter().map(|x| f64::from(*x)).collect();
        let exact = self.exact(&wide);
        let off = (f64::from(found) - exact).abs();
        assert!(off <= 3e-5 || self.is_open(at), "{:?} {at:?}: {found} {exact}", self.config);
    }
}

#[test]
fn filters_are_their_definition() -> Result<(), TextureError> {
    let mut rng = Rng::new(10);
    for filter in FILTERS {
        for _ in 0..scaled(1000) {
            let point = |rng: &mut Rng| rng.point(2.5);
            let case = Case::new(&mut rng, filter, 1);
            let texture = Texture1::new(&case.texels, [case.size[0]], case.config)?;
            for _ in 0..10 {
                let u = point(&mut rng).x;
                case.check(&[u], tex1(&texture, u));
            }
            let case = Case::new(&mut rng, filter, 2);
            let texture = Texture2::new(&case.texels, [case.size[0], case.size[1]], case.config)?;
            for _ in 0..10 {
                let p = point(&mut rng);
                case.check(&[p.x, p.y], tex2(&texture, vec2(p.x, p.y)));
            }
            let case = Case::new(&mut rng, filter, 3);
            let texture = Texture3::new(&case.texels, case.size, case.config)?;
            for _ in 0..10 {
                let p = point(&mut rng);
                case.check(&[p.x, p.y, p.z], tex3(&texture, p));
            }
        }
    }
    Ok(())
}

/// The spline of the coefficients goes through the texels, in every mode and for every small size.
#[test]
fn an_interpolating_spline_goes_through_the_texels() -> Result<(), TextureError> {
    let mut rng = Rng::new(11);
    for _ in 0..scaled(2000) {
        let case = Case::new(&mut rng, Filter::Nearest, 3);
        let texture = Texture3::new(&case.texels, case.size, case.config)?;
        let spline = texture.interpolating()?;
        assert_eq!(spline.config().filter, Filter::BSpline);
        let [w, h, d] = case.size;
        let [x, y, z] = case.size.map(|n| rng.below(n as usize) as u32);
        let centre = |i: u32, n: u32| (i as f32 + 0.5) / n as f32;
        let at = vec3(centre(x, w), centre(y, h), centre(z, d));
        let (found, texel) = (tex3(&spline, at), case.texels[((z * h + y) * w + x) as usize]);
        assert!((found - texel).abs() <= 2e-5, "{:?} {at}: {found} {texel}", case.config);
    }
    Ok(())
}
