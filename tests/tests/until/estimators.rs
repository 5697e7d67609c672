//! Coverage of plain estimators.

use std::f64::consts::PI;

use raydsl::kernel;
use raydsl::prelude::*;
use raydsl::render::Metric;
use raydsl::texture::Filter;

use crate::camera;
use crate::coverage::{CLAIMED, Known, Runs, Table};

/// Whether a ray from the origin meets a sphere.
#[kernel]
fn meets(d: Vec3, center: Vec3, radius: f32) -> bool {
    let along = d.dot(center);
    let aside = center - d * along;
    along > 0.0 && aside.dot(aside) <= radius * radius
}

/// The number of the case of a square light.
pub(crate) const SQUARE: u32 = 6;

/// One sample of a case: what a point at the origin, with its normal along z, is to estimate.
#[kernel]
pub(crate) fn sample_of(case: u32, emission: &Texture2<'_, f32>, u: Vec2) -> f32 {
    let d = sample_cosine_hemisphere(u);
    let on_light = vec3(2.0 * u.x - 1.0, 2.0 * u.y - 1.0, 1.0);
    let square = on_light.dot(on_light);
    // Both cosines, over the squared distance, times the area.
    let from_light = 4.0 / (square * square);
    match case {
        0 => {
            let p = d * (2.0 / d.z);
            if p.x * p.x + p.y * p.y <= 1.0 { 0.0 } else { 1.0 }
        }
        1 => {
            let p = d / d.z - vec3(1.5, 0.0, 0.0);
            if p.x * p.x + p.y * p.y <= 1.0 { 0.0 } else { 1.0 }
        }
        2 => {
            if meets(d, vec3(1.0, 0.0, 2.0), 1.0) {
                0.0
            } else {
                1.0
            }
        }
        3 => {
            if meets(d, vec3(3.0, 0.0, 0.0), 1.0) {
                0.0
            } else {
                1.0
            }
        }
        4 => {
            let p = d * (1.25 / d.z);
            let is_in = p.x >= 0.5 && p.x <= 2.0 && p.y >= -1.0 && p.y <= 1.5;
            if is_in { 0.0 } else { 1.0 }
        }
        5 => {
            if meets(d, vec3(1.0, 0.0, 2.0), 0.5) {
                31.415_926
            } else {
                0.0
            }
        }
        6 => from_light,
        7 => {
            let p = vec3(on_light.x, on_light.y, 1.5);
            let distance = p.length();
            1.5 / (distance * distance * distance)
        }
        8 => tex2(emission, u),
        9 => from_light * tex2(emission, u),
        _ => {
            if u.x < 0.01 {
                100.0
            } else {
                0.0
            }
        }
    }
}

/// Texels of a dark surface with some bright places.
const TEXELS: [f32; 20] = [
    0.1, 0.2, 0.1, 4.0, 0.3, 0.1, 0.9, 0.5, 0.2, 0.1, 0.1, 2.5, 0.3, 0.1, 0.6, 0.2, 0.1, 0.1, 0.7,
    8.0,
];
const SIZE: [u32; 2] = [5, 4];

/// What a square light of these texels gives, by the midpoint rule in each texel.
fn textured_light() -> f64 {
    const N: usize = 400;
    let [columns, rows] = SIZE.map(|n| n as usize);
    let place = |i: usize, size: usize| 2.0 * (i as f64 + 0.5) / (size * N) as f64 - 1.0;
    let mut sum = 0.0;
    for j in 0..rows * N {
        for i in 0..columns * N {
            let (x, y) = (place(i, columns), place(j, rows));
            let square = x * x + y * y + 1.0;
            sum += 4.0 / (square * square) * f64::from(TEXELS[j / N * columns + i / N]);
        }
    }
    sum / (columns * rows * N * N) as f64
}

struct Case {
    name: &'static str,
    number: u32,
    truth: f64,
    metric: Metric,
    /// Columns and rows.
    film: (u32, u32),
}

/// The values are those of the closed forms beside them, with more digits than are needed.
fn cases() -> Vec<Case> {
    let mean = TEXELS.iter().map(|&t| f64::from(t)).sum::<f64>() / TEXELS.len() as f64;
    let (rmse, one, few) = (Metric::Rmse, (1, 1), (4, 4));
    let ao2 = {
        let (h, r) = (1.0f64 / 1.5, 1.0f64 / 1.5);
        let z = 1.0 + h * h + r * r;
        1.0 - 0.5 * (1.0 - (1.0 + h * h - r * r) / (z * z - 4.0 * r * r).sqrt())
    };
    let all = [
        ("occlusion by a disk above", 1.0 - 1.0 / 5.0, rmse, one),
        ("by a disk aside", ao2, rmse, few),
        ("by a sphere", 1.0 - 2.0 / 5.0f64.powf(1.5), Metric::Mean, few),
        ("by a dome on the plane", 0.991_861_698_270_285_7, rmse, one),
        ("by a rectangle", 0.830_989_940_095_277_9, rmse, few),
        ("light of a sphere", PI * 10.0 * 0.25 * 2.0 / 5.0f64.powf(1.5), rmse, few),
        ("of a square", 1.740_839_502_734_206_4, Metric::RelMse, few),
        ("of a point on a patch", 0.312_766_721_941_545, rmse, few),
        ("a texture", mean, rmse, few),
        ("a square light with a texture", textured_light(), rmse, one),
        ("100 with a probability of 0.01", 1.0, Metric::RelMse, one),
    ];
    let case = |((name, truth, metric, film), number)| Case { name, number, truth, metric, film };
    all.into_iter().zip(0..).map(case).collect()
}

impl Case {
    fn known(&self) -> Known<Pinhole> {
        let Self { truth, metric, film, .. } = *self;
        let truth = vec![truth; (film.0 * film.1) as usize];
        Known { camera: camera(), pixels: PixelSampler::Center, film, metric, truth }
    }
}

pub(crate) fn texture() -> Texture2<'static, f32> {
    let nearest = TextureConfig::new().filter(Filter::Nearest);
    Texture2::new(&TEXELS, SIZE, nearest).expect("twenty texels")
}

/// The claimed 95 % are between 93 and 99 % of the seeds; and 90 % where a pixel is rarely bright.
#[test]
fn the_confidence_is_as_claimed() {
    let texture = texture();
    let mut table = Table::new();
    for case in cases() {
        let number = case.number;
        let kernel = kernel!(|_ray: Ray, sampler: Sampler| {
            let mut sampler = sampler;
            sample_of(number, &texture, sampler.next_2d())
        });
        let range = if number == 10 { (0.90, 1.0) } else { CLAIMED };
        // A sphere of light is met by one direction in 22.
        let (random, sobol) = match number {
            5 => (0.06, 0.02),
            10 => (0.1, 0.02),
            _ => (0.03, 0.006),
        };
        let runs = Runs { random, sobol, pilot: 1024, samples: 6000 };
        table.row(case.name, range, runs, &case.known(), &kernel);
    }
    table.finish();
}
