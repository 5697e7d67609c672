//! Fits the polynomials of `raydsl::bsdf`'s albedos, prints them as Rust, and measures errors.
//!
//! `cargo run --release -p raydsl-tests --bin albedo --no-default-features`
//!
//! Integrals are over the visible half vectors. A fit is the one within the narrowest tube above
//! the integral, on a grid: least squares with weights that grow where the fit is worst (Lawson,
//! 1961). The kernels' errors are measured on a second grid, between the points of the first.

use std::f64::consts::{PI, TAU};

use raydsl::bsdf;

/// Points of the quadrature in an interval, and azimuths.
const POINTS: (usize, usize) = (64, 240);
/// How far below the integral the bottom of a tube is.
const SLACK: f64 = 2e-5;
/// The smoothest lobes that are fitted, and the roughest.
const ALPHAS: (f64, f64) = (1e-4, 1.0);
/// The same for the sheen, and its least cosine.
const SHEEN_ALPHAS: (f64, f64) = (0.07, 1.0);
const SHEEN_COS: f64 = 1e-3;

fn main() {
    let quadrature = Quadrature::new(POINTS);
    let lobe = fit_lobe(&quadrature);
    let mean = fit_mean(&quadrature, &lobe);
    let sheen = fit_sheen(&quadrature);
    for (name, fit) in [("deficit", &lobe), ("mean cosine", &mean), ("sheen", &sheen)] {
        println!("// {name}: {} terms, tube of {:.2e}", fit.terms.len(), fit.width);
        println!("{}", fit.source());
    }
    report(&quadrature);
}

/// Nodes and weights of an integral from 0 to 1 (Gauss and Legendre).
fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    let node = |i: usize| {
        let mut x = (PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
        loop {
            let (mut p, mut before) = (1.0, 0.0);
            for k in 0..n {
                let k = k as f64;
                (p, before) = (((2.0 * k + 1.0) * x * p - k * before) / (k + 1.0), p);
            }
            let slope = n as f64 * (x * p - before) / (x * x - 1.0);
            x -= p / slope;
            if (p / slope).abs() < 1e-15 {
                return (0.5 * (1.0 - x), 1.0 / ((1.0 - x * x) * slope * slope));
            }
        }
    };
    (0..n).map(node).collect()
}

struct Quadrature {
    nodes: Vec<(f64, f64)>,
    azimuths: usize,
}

impl Quadrature {
    fn new((points, azimuths): (usize, usize)) -> Self {
        Self { nodes: gauss_legendre(points), azimuths }
    }

    /// Calls `add(cosine between the direction and the half vector, weight)`: the weights are those
    /// of visible half vectors times the shadowing of the reflected direction.
    ///
    /// Half vectors are on the spherical cap of Dupuy and Benyoub, "Sampling visible GGX normals
    /// with spherical caps" (2023). Each azimuth is cut where reflected directions cross the
    /// horizon: between, everything is smooth.
    fn visible(&self, cos: f64, alpha: f64, mut add: impl FnMut(f64, f64)) {
        const STEPS: usize = 24;
        let sin = (1.0 - cos * cos).sqrt();
        let t = (alpha * alpha * sin * sin + cos * cos).sqrt();
        let (x, z) = (alpha * sin / t, cos / t);
        for k in 0..self.azimuths {
            let (around_sin, around_cos) = (PI * (k as f64 + 0.5) / self.azimuths as f64).sin_cos();
            // The cosines of the half vector and of the reflected direction. The square of u
            // stretches the rim of the cap, where half vectors turn fast.
            let at = |u: f64| {
                let height = (1.0 + z) * u * u - z;
                let r = (1.0 - height * height).max(0.0).sqrt();
                let (hx, hy, hz) =
                    (alpha * (r * around_cos + x), alpha * r * around_sin, height + z);
                let norm = (hx * hx + hy * hy + hz * hz).sqrt();
                let c = (sin * hx + cos * hz) / norm;
                (c, 2.0 * c * hz / norm - cos)
            };
            let is_up = |u: f64| at(u).1 > 0.0;
            let mut cuts = vec![0.0];
            for step in 1..=STEPS {
                let (mut low, mut high) = ((step - 1) as f64, step as f64);
                low = (low / STEPS as f64).max(1e-12);
                high /= STEPS as f64;
                let before = is_up(low);
                if is_up(high) != before {
                    for _ in 0..50 {
                        let middle = 0.5 * (low + high);
                        *(if is_up(middle) == before { &mut low } else { &mut high }) = middle;
                    }
                    cuts.push(0.5 * (low + high));
                }
            }
            cuts.push(1.0);
            for cut in cuts.windows(2) {
                let length = cut[1] - cut[0];
                for &(v, weight) in &self.nodes {
                    let u = cut[0] + length * v * v * (3.0 - 2.0 * v);
                    let (c, cos_i) = at(u);
                    if cos_i > 0.0 {
                        let t_i = (alpha * alpha * (1.0 - cos_i * cos_i) + cos_i * cos_i).sqrt();
                        let shadow = cos_i * (cos + t) / (cos_i * t + cos * t_i);
                        let measure = length * 6.0 * v * (1.0 - v) * 2.0 * u;
                        add(c, weight * measure * shadow / self.azimuths as f64);
                    }
                }
            }
        }
    }

    /// The albedo of the lobe, and those with the Fresnel reflectances of `iors`.
    fn lobe(&self, cos: f64, alpha: f64, iors: &[f64]) -> (f64, Vec<f64>) {
        let (mut all, mut reflected) = (0.0, vec![0.0; iors.len()]);
        self.visible(cos, alpha, |c, weight| {
            all += weight;
            for (sum, &ior) in reflected.iter_mut().zip(iors) {
                *sum += weight * fresnel(c, ior);
            }
        });
        (all, reflected)
    }

    fn sheen(&self, cos: f64, alpha: f64) -> f64 {
        let share = (1.0 - alpha) * (1.0 - alpha);
        let mix = |smooth: f64, rough: f64| share * smooth + (1.0 - share) * rough;
        let (a, b, c) = (mix(25.3245, 21.5473), mix(3.32435, 3.82987), mix(0.16801, 0.19823));
        let (d, e) = (mix(-1.27393, -1.97760), mix(-4.85967, -4.32054));
        let l = |x: f64| a / (1.0 + b * x.powf(c)) + d * x + e;
        let lambda = |x: f64| if x < 0.5 { l(x).exp() } else { (2.0 * l(0.5) - l(1.0 - x)).exp() };
        let (sin, lambda_o) = ((1.0 - cos * cos).sqrt(), lambda(cos));
        let azimuths = 2 * self.azimuths;
        let mut sum = 0.0;
        for &(v, weight) in &self.nodes {
            // The two halves of the shadowing: the lower one is steep at 0.
            let (low, high) = (0.5 * v * v * v * v, 1.0 - 0.5 * v * v);
            for (cos_i, measure) in [(low, 2.0 * v * v * v), (high, v)] {
                let sin_i = (1.0 - cos_i * cos_i).sqrt();
                let shadow = 1.0 / (1.0 + lambda(cos_i) + lambda_o);
                for k in 0..azimuths {
                    let across = (PI * (k as f64 + 0.5) / azimuths as f64).cos();
                    // The sine of the half vector.
                    let side = sin * sin + sin_i * sin_i + 2.0 * sin * sin_i * across;
                    let up = (cos + cos_i) * (cos + cos_i);
                    let d = (2.0 + 1.0 / alpha) / TAU * (side / (side + up)).powf(0.5 / alpha);
                    sum += weight * measure * d * shadow / (4.0 * cos);
                }
            }
        }
        sum * TAU / azimuths as f64
    }
}

fn fresnel(cos: f64, ior: f64) -> f64 {
    let g = (ior * ior - 1.0 + cos * cos).sqrt();
    let s = (cos - g) / (cos + g);
    let p = (ior * ior * cos - g) / (ior * ior * cos + g);
    0.5 * (s * s + p * p)
}

/// The cosine whose reflectance is `reflectance`, by bisection.
fn inverse_fresnel(reflectance: f64, ior: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        *(if fresnel(middle, ior) > reflectance { &mut low } else { &mut high }) = middle;
    }
    0.5 * (low + high)
}

/// What a polynomial of `at`, multiplied by `factor`, may be.
struct Row {
    at: [f64; 3],
    factor: f64,
    low: f64,
    high: f64,
}

struct Fit {
    /// Exponents of the three variables, in order.
    terms: Vec<[i32; 3]>,
    coefficients: Vec<f64>,
    width: f64,
}

impl Fit {
    /// Finds the narrowest tube of `tube(width)` that the polynomial stays in, by bisection.
    fn new(terms: Vec<[i32; 3]>, tube: impl Fn(f64) -> Vec<Row>) -> Self {
        let mut best = Self { terms, coefficients: Vec::new(), width: 0.016 };
        let mut too_narrow = 0.001;
        while best.width > 1.02 * too_narrow {
            let width = (best.width * too_narrow).sqrt();
            let (coefficients, worst) = lawson(&best.terms, &tube(width));
            if worst < 1.002 {
                (best.coefficients, best.width) = (coefficients, width);
            } else {
                too_narrow = width;
            }
        }
        assert!(!best.coefficients.is_empty(), "no tube is wide enough");
        best
    }

    fn at(&self, at: [f64; 3]) -> f64 {
        let term = |(term, c): (&[i32; 3], &f64)| f64::from(*c as f32) * monomial(at, *term);
        self.terms.iter().zip(&self.coefficients).map(term).sum()
    }

    /// Nested as Horner's rule does: x outermost, then y, z.
    fn source(&self) -> String {
        let has_z = self.terms.iter().any(|t| t[2] > 0);
        let mut source = String::new();
        let names = |letter: &str, n: usize| (0..n).map(|i| format!("{letter}{i}")).collect();
        let of = |i: i32, j: Option<i32>| {
            let terms = self.terms.iter().zip(&self.coefficients);
            let these = terms.filter(move |(t, _)| t[0] == i && j.is_none_or(|j| t[1] == j));
            these.map(|(_, c)| format!("{:?}", *c as f32)).collect::<Vec<_>>()
        };
        let rows = (0..).take_while(|&i| !of(i, None).is_empty());
        let rows: Vec<i32> = rows.collect();
        for &i in &rows {
            let inner = if has_z {
                let columns: Vec<i32> = (0..).take_while(|&j| !of(i, Some(j)).is_empty()).collect();
                for &j in &columns {
                    source += &format!("    let q{j} = {};\n", horner("z", &of(i, Some(j))));
                }
                names("q", columns.len())
            } else {
                of(i, None)
            };
            source += &format!("    let p{i} = {};\n", horner("y", &inner));
        }
        let outer: Vec<String> = names("p", rows.len());
        source + &format!("    {}", horner("x", &outer))
    }
}

fn horner(variable: &str, coefficients: &[String]) -> String {
    match coefficients {
        [last] => last.clone(),
        [first, last] => format!("{first} + {variable} * {last}"),
        [first, rest @ ..] => format!("{first} + {variable} * ({})", horner(variable, rest)),
        [] => unreachable!(),
    }
}

fn monomial(at: [f64; 3], term: [i32; 3]) -> f64 {
    at[0].powi(term[0]) * at[1].powi(term[1]) * at[2].powi(term[2])
}

/// Returns coefficients and the largest deviation from the rows' middles, in halves of their
/// widths.
fn lawson(terms: &[[i32; 3]], rows: &[Row]) -> (Vec<f64>, f64) {
    let n = terms.len();
    let scale = |row: &Row| 2.0 / (row.high - row.low);
    let matrix: Vec<Vec<f64>> = rows
        .iter()
        .map(|row| {
            let term = |t: &[i32; 3]| monomial(row.at, *t) * row.factor * scale(row);
            let middle = 0.5 * (row.low + row.high) * scale(row);
            terms.iter().map(term).chain([middle]).collect()
        })
        .collect();
    let mut weights = vec![1.0; rows.len()];
    let mut best = (Vec::new(), f64::INFINITY);
    for _ in 0..240 {
        // The normal equations, with the right side as the last column.
        let mut normal = vec![vec![0.0; n + 1]; n];
        for (row, &weight) in matrix.iter().zip(&weights) {
            for i in 0..n {
                let v = row[i] * weight;
                for (sum, x) in normal[i][i..].iter_mut().zip(&row[i..]) {
                    *sum += v * x;
                }
            }
        }
        let x = solve(normal);
        let off =
            |row: &Vec<f64>| (row.iter().zip(&x).map(|(a, x)| a * x).sum::<f64>() - row[n]).abs();
        let off: Vec<f64> = matrix.iter().map(off).collect();
        let worst = off.iter().fold(0.0, |a: f64, &b| a.max(b));
        if worst < best.1 {
            best = (x, worst);
        }
        for (weight, off) in weights.iter_mut().zip(off) {
            *weight *= (off / worst).sqrt() + 0.05;
        }
        let mean = weights.iter().sum::<f64>() / weights.len() as f64;
        weights.iter_mut().for_each(|weight| *weight /= mean);
    }
    best
}

/// Solves symmetric equations, of which the upper half is given (Cholesky), scaled to a diagonal
/// of ones and a little more, for what is nearly dependent.
fn solve(mut a: Vec<Vec<f64>>) -> Vec<f64> {
    let n = a.len();
    let scale: Vec<f64> = (0..n).map(|i| 1.0 / a[i][i].sqrt()).collect();
    for i in 0..n {
        for j in i..n {
            a[i][j] *= scale[i] * scale[j];
        }
        a[i][i] += 1e-13;
        a[i][n] *= scale[i];
    }
    for i in 0..n {
        let root = a[i][i].sqrt();
        a[i][i..].iter_mut().for_each(|x| *x /= root);
        let (top, below) = a.split_at_mut(i + 1);
        let top = &top[i];
        for (k, row) in below.iter_mut().enumerate() {
            let k = i + 1 + k;
            for j in k..=n {
                row[j] -= top[k] * top[j];
            }
        }
    }
    let mut x = vec![0.0; n];
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|j| a[i][j] * x[j]).sum();
        x[i] = (a[i][n] - known) / a[i][i];
    }
    x.iter().zip(scale).map(|(x, s)| x * s).collect()
}

/// `n + 1` numbers from `low` to `high`, dense at `low`.
fn spread(n: usize, power: i32, (low, high): (f64, f64)) -> Vec<f64> {
    (0..=n).map(|i| low + (high - low) * (i as f64 / n as f64).powi(power)).collect()
}

/// Cosines from 0 to 1, dense where the lobe changes: at those of the size of `alpha`.
fn cosines(n: usize, alpha: f64, offset: f64) -> Vec<f64> {
    let most = 1.0 / (1.0 + 2.0 * alpha).sqrt();
    let cosine = |i: usize| {
        let x = ((i as f64 + offset) / n as f64).min(1.0) * most;
        (2.0 * alpha * x * x / (1.0 - x * x)).min(1.0)
    };
    (0..=n).map(cosine).collect()
}

fn terms(of: impl Fn(i32, i32, i32) -> bool) -> Vec<[i32; 3]> {
    let all = (0..512).map(|n| [n / 64, n / 8 % 8, n % 8]);
    all.filter(|&[i, j, k]| of(i, j, k)).collect()
}

/// The share of the cosine in itself and a multiple of the roughness.
fn share(cos: f64, alpha: f64) -> f64 {
    cos / (cos + 2.5 * alpha)
}

fn deficit_at(cos: f64, alpha: f64) -> ([f64; 3], f64) {
    let x = share(cos, alpha);
    ([x.sqrt(), alpha, 0.0], x * (1.0 - x) * (1.0 - x))
}

/// What the lobe lacks to 1.
fn fit_lobe(quadrature: &Quadrature) -> Fit {
    let mut points = Vec::new();
    for alpha in spread(24, 2, ALPHAS) {
        for cos in cosines(48, alpha, 0.0).into_iter().skip(1) {
            points.push((cos, alpha, quadrature.lobe(cos, alpha, &[]).0));
        }
    }
    const DEGREES: [i32; 6] = [2, 3, 4, 4, 3, 2];
    let terms = terms(|i, j, k| DEGREES.get(i as usize).is_some_and(|&d| j <= d) && k == 0);
    Fit::new(terms, |width| {
        let row = |&(cos, alpha, e): &(f64, f64, f64)| {
            let (at, factor) = deficit_at(cos, alpha);
            let high = 1.0 - e * (1.0 - SLACK);
            Row { at, factor, low: high - width * e, high }
        };
        points.iter().map(row).collect()
    })
}

fn mean_at(cos: f64, alpha: f64, ior: f64) -> ([f64; 3], f64) {
    let root = alpha.sqrt();
    let g = (ior * ior - 1.0).sqrt().sqrt();
    ([share(cos, alpha).sqrt(), root.sqrt(), g / (1.0 + g)], root)
}

/// The cosine whose Fresnel reflectance is the lobe's mean one, less that of the direction.
fn fit_mean(quadrature: &Quadrature, lobe: &Fit) -> Fit {
    // From next to 1 to 3, where the spread is of g² / (1 + g²).
    let iors = spread(20, 2, (0.012, 8f64.sqrt() / (1.0 + 8f64.sqrt())));
    let ior = |y: f64| (1.0 + (y / (1.0 - y)) * (y / (1.0 - y))).sqrt();
    let iors: Vec<f64> = iors.into_iter().map(ior).collect();
    let mut points = Vec::new();
    for alpha in spread(22, 4, ALPHAS) {
        for cos in cosines(30, alpha, 0.0) {
            let (at, factor) = deficit_at(cos, alpha);
            let all = (1.0 - factor * lobe.at(at)).min(1.0);
            let (_, reflected) = quadrature.lobe(cos, alpha, &iors);
            points.extend(iors.iter().zip(reflected).map(|(&ior, e)| (cos, alpha, ior, all, e)));
        }
    }
    let terms = terms(|i, j, k| i + j + k <= 6 && i < 6 && j < 5 && k < 5);
    Fit::new(terms, |width| {
        let row = |&(cos, alpha, ior, all, e): &(f64, f64, f64, f64, f64)| {
            let (at, factor) = mean_at(cos, alpha, ior);
            let (least, most) = ((e - SLACK) / all, (e - SLACK + width) / all);
            // Where the limit of all reflectances is within the tube, so is what is beyond.
            let high = if least > fresnel(1.0, ior) { inverse_fresnel(least, ior) } else { 1.5 };
            let low = if most < 1.0 { inverse_fresnel(most, ior) } else { high - 0.01 };
            Row { at, factor, low: low - cos, high: high - cos }
        };
        points.iter().map(row).collect()
    })
}

fn sheen_at(cos: f64, alpha: f64) -> ([f64; 3], f64) {
    ([cos.sqrt().sqrt(), alpha.sqrt(), 0.0], 1.0)
}

/// The fourth root of the sheen's albedo.
fn fit_sheen(quadrature: &Quadrature) -> Fit {
    let mut points = Vec::new();
    for alpha in spread(20, 2, SHEEN_ALPHAS) {
        for cos in spread(40, 3, (SHEEN_COS, 1.0)) {
            points.push((cos, alpha, quadrature.sheen(cos, alpha)));
        }
    }
    Fit::new(terms(|i, j, k| i < 6 && i + j <= 6 && k == 0), |width| {
        let row = |&(cos, alpha, e): &(f64, f64, f64)| {
            let (at, factor) = sheen_at(cos, alpha);
            let (low, high) = ((e - SLACK).max(0.0).powf(0.25), (e - SLACK + width).powf(0.25));
            Row { at, factor, low, high }
        };
        points.iter().map(row).collect()
    })
}

/// Errors of a kernel: the least, the largest, and the sum of those found.
struct Errors {
    name: &'static str,
    least: f64,
    most: f64,
    sum: f64,
    count: usize,
}

impl Errors {
    fn new(name: &'static str) -> Self {
        Self { name, least: f64::INFINITY, most: f64::NEG_INFINITY, sum: 0.0, count: 0 }
    }

    fn add(&mut self, error: f64) {
        self.least = self.least.min(error);
        self.most = self.most.max(error);
        self.sum += error;
        self.count += 1;
    }
}

/// Compares the compiled kernels with the integrals.
fn report(quadrature: &Quadrature) {
    let mut lobe = Errors::new("ggx_albedo, relative");
    let mut dielectric = Errors::new("dielectric_albedo");
    let mut sheen = Errors::new("sheen_albedo");
    let mut finer = Errors::new("this quadrature");
    let fine = Quadrature::new((128, 960));
    let iors: Vec<f64> =
        spread(36, 3, (1.0001, 3.0)).iter().map(|&n| f64::from(n as f32)).collect();
    let alphas = |n, range| spread(n, 2, range).into_iter().map(|a| f64::from(a as f32));
    for (i, alpha) in alphas(23, (ALPHAS.0 * 1.7, ALPHAS.1)).enumerate() {
        for (j, cos) in cosines(39, alpha, 0.37).into_iter().enumerate() {
            let cos = f64::from(cos as f32);
            let (all, reflected) = quadrature.lobe(cos, alpha, &iors);
            let found = f64::from(bsdf::ggx_albedo(cos as f32, alpha as f32));
            lobe.add(found / all - 1.0);
            for (&ior, e) in iors.iter().zip(reflected) {
                let found = bsdf::dielectric_albedo(cos as f32, alpha as f32, ior as f32);
                dielectric.add(f64::from(found) - e);
            }
            if i % 5 == 2 && j % 8 == 3 {
                finer.add(all - fine.lobe(cos, alpha, &[]).0);
            }
        }
    }
    for alpha in alphas(17, SHEEN_ALPHAS) {
        for cos in spread(47, 3, (SHEEN_COS, 1.0)) {
            let cos = f64::from(cos as f32);
            let found = bsdf::sheen_albedo(cos as f32, alpha as f32);
            sheen.add(f64::from(found) - quadrature.sheen(cos, alpha));
        }
    }
    println!(
        "\n| {:26} | {:>6} | {:>9} | {:>9} | {:>9} |",
        "error", "points", "least", "mean", "most"
    );
    println!("|{}|", [28, 8, 11, 11, 11].map(|n| "-".repeat(n)).join("|"));
    for Errors { name, least, most, sum, count } in [lobe, dielectric, sheen, finer] {
        let mean = sum / count as f64;
        println!("| {name:26} | {count:6} | {least:9.1e} | {mean:9.1e} | {most:9.1e} |");
    }
}
