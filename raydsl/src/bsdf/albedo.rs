//! Directional albedos of microfacet lobes: what they reflect of light from one direction.
//!
//! They are fits, since kernels have no tables. `tests/src/bin/albedo.rs` integrates the lobes,
//! makes the fits, prints the coefficients below and measures the errors of the kernels:
//!
//! ```text
//! cargo run --release -p raydsl-tests --bin albedo --no-default-features
//! ```

use crate::kernel;
use crate::machine::generic::{max, min};

/// The least roughness; smoother lobes are as this one.
const LEAST_ALPHA: f32 = 1e-4;

/// Raises the albedo of dielectrics by what the fit is low between the points it was made of.
const RAISED: f32 = 1.00005;

/// Returns the albedo of the GGX lobe of a surface that reflects everything: what single scattering
/// leaves of 1 is lost between microfacets.
///
/// `cos` is the cosine of the direction from 0 to 1, `alpha` the square of the roughness from 1e-4
/// to 1; others count as the nearest, NaN as 0. Masking and shadowing are Smith's, correlated by
/// height. The result is at most 1, and above the integral by up to 0.2 % of it; it may be below by
/// 5e-5. So what is divided by it, or is given the rest up to 1, reflects no more than it receives.
///
/// (For compensation as in Kulla and Conty, "Revisiting physically based shading at Imageworks",
/// 2017, and Turquin, "Practical multiple scattering compensation for microfacet models", 2019.)
///
/// The rest up to 1 is `s (1 - s)²` times a polynomial of `sqrt(s)` and `alpha`, for
/// `s = cos / (cos + 2.5 alpha)`: 27 multiplications, a division, a root.
#[kernel]
#[inline]
pub fn ggx_albedo(cos: f32, alpha: f32) -> f32 {
    let a = within(alpha, LEAST_ALPHA);
    lobe_albedo(rough_share(within(cos, 0.0), a), a)
}

/// Returns the albedo of the GGX lobe that a dielectric reflects, seen from outside: the lobe of
/// [`ggx_albedo()`] with the exact Fresnel reflectance of unpolarized light. What is refracted is
/// the rest.
///
/// `cos` and `alpha` are those of [`ggx_albedo()`], `ior` the index of refraction inside, relative
/// to that outside, from 1 to 3; others count as the nearest. The result is above the integral by
/// up to 0.0027, and may be below by 1e-4: a diffuse surface below the lobe that is scaled by
/// `1 - dielectric_albedo(..)` adds no more than that. It is 0 at an `ior` of 1.
///
/// The reflectance is that at a mean cosine: `cos` plus `sqrt(alpha)` times a polynomial of
/// `sqrt(s)`, `alpha^(1/4)` and `g / (1 + g)`, for the `s` of [`ggx_albedo()`] and
/// `g = (ior² - 1)^(1/4)`. 109 multiplications, 4 divisions, 6 roots.
#[kernel]
#[inline]
pub fn dielectric_albedo(cos: f32, alpha: f32, ior: f32) -> f32 {
    let mu = within(cos, 0.0);
    let a = within(alpha, LEAST_ALPHA);
    let n = min(max(1.0, ior), 3.0);
    // Exact next to 1, where the square would be rounded.
    let above_one = (n - 1.0) * (n + 1.0);
    let g = above_one.sqrt().sqrt();
    let s = rough_share(mu, a);
    let root = a.sqrt();
    let mean = mu + root * mean_shift(s.sqrt(), root.sqrt(), g / (1.0 + g));
    min(lobe_albedo(s, a) * reflectance(within(mean, 1e-6), above_one) * RAISED, 1.0)
}

/// Returns the albedo of Charlie, the sheen of Estevez and Kulla, "Production friendly microfacet
/// sheen BRDF" (2017), of a white fabric, with their fit of the shadowing and without the softened
/// terminator.
///
/// `cos` is from 1e-3 to 1 and `alpha`, the roughness of their formulas, from 0.07 to 1; others
/// count as the nearest, NaN as the least. The result is at most 1, and above the integral by up to
/// 0.005; it may be below by 5e-5. Below a cosine of 1e-6 their shadowing lets the integral itself
/// exceed 1.
///
/// The fourth power of a polynomial of `cos^(1/4)` and `sqrt(alpha)`: 28 multiplications, 3 roots.
#[kernel]
#[inline]
pub fn sheen_albedo(cos: f32, alpha: f32) -> f32 {
    let x = within(cos, 1e-3).sqrt().sqrt();
    let y = within(alpha, 0.07).sqrt();
    let root = sheen_root(x, y);
    let square = root * root;
    min(square * square, 1.0)
}

/// Clamps `x` to `least` and 1; NaN gives `least`.
#[kernel]
#[inline]
fn within(x: f32, least: f32) -> f32 {
    min(max(least, x), 1.0)
}

/// Returns the share of the cosine in itself and a multiple of `alpha`.
#[kernel]
#[inline]
fn rough_share(cos: f32, alpha: f32) -> f32 {
    cos / (cos + 2.5 * alpha)
}

/// Returns the albedo of the lobe from the [`rough_share`].
#[kernel]
#[inline]
fn lobe_albedo(s: f32, alpha: f32) -> f32 {
    let rest = 1.0 - s;
    min(1.0 - s * rest * rest * deficit(s.sqrt(), alpha), 1.0)
}

/// Returns the Fresnel reflectance for an `ior` whose square is `above_one` more than 1.
#[kernel]
#[inline]
fn reflectance(cos: f32, above_one: f32) -> f32 {
    let g = (above_one + cos * cos).sqrt();
    let inside = cos + above_one * cos;
    let s = (cos - g) / (cos + g);
    let p = (inside - g) / (inside + g);
    0.5 * (s * s + p * p)
}

/// Returns what the lobe lacks to 1, as a share of `x² (1 - x²)²`.
#[kernel]
#[inline]
fn deficit(x: f32, y: f32) -> f32 {
    let p0 = 0.2544001 + y * (-0.19270757 + y * 15.735804);
    let p1 = 3.4643836 + y * (11.1595335 + y * (-79.91941 + y * -24.57295));
    let p2 = -16.76296 + y * (-99.95214 + y * (401.37408 + y * (21.117699 + y * 24.170582)));
    let p3 = 46.88367 + y * (310.34244 + y * (-1039.6538 + y * (53.05435 + y * -54.734524)));
    let p4 = -59.792213 + y * (-400.7437 + y * (1229.4469 + y * -18.17349));
    let p5 = 26.038792 + y * (185.71646 + y * -534.6135);
    p0 + x * (p1 + x * (p2 + x * (p3 + x * (p4 + x * p5))))
}

/// Returns how far the mean cosine is above that of the direction, as a share of `y²`.
#[kernel]
#[inline]
fn mean_shift(x: f32, y: f32, z: f32) -> f32 {
    let q0 = 0.005352897 + z * (-0.36862433 + z * (1.1293713 + z * (-2.7308147 + z * 2.735159)));
    let q1 = 0.22886793 + z * (7.3911886 + z * (-22.799664 + z * (39.0873 + z * -29.40584)));
    let q2 = -1.6993899 + z * (-7.083459 + z * (47.30513 + z * (-57.17502 + z * 13.096293)));
    let q3 = 3.4117014 + z * (-7.833313 + z * (-22.94674 + z * 37.711258));
    let q4 = -2.1529443 + z * (10.922106 + z * -11.053302);
    let p0 = q0 + y * (q1 + y * (q2 + y * (q3 + y * q4)));
    let q0 = 0.020843478 + z * (0.108262606 + z * (0.52514714 + z * (2.4682572 + z * -4.836262)));
    let q1 = -0.546816 + z * (-3.9963987 + z * (6.0309086 + z * (-12.579496 + z * 19.07246)));
    let q2 = 4.624975 + z * (6.159172 + z * (-9.761978 + z * -13.121178));
    let q3 = -10.767134 + z * (3.6788797 + z * 18.619402);
    let q4 = 7.75026 + z * -11.707077;
    let p1 = q0 + y * (q1 + y * (q2 + y * (q3 + y * q4)));
    let q0 = 0.017046615 + z * (0.7451365 + z * (-5.5064197 + z * (0.9313273 + z * 3.6918237)));
    let q1 = 0.72824204 + z * (4.6186614 + z * (-2.4720519 + z * 11.908147));
    let q2 = -9.858721 + z * (-4.8436713 + z * -7.427326);
    let q3 = 14.810425 + z * 5.09585;
    let q4 = -7.9277754;
    let p2 = q0 + y * (q1 + y * (q2 + y * (q3 + y * q4)));
    let q0 = -0.33333287 + z * (-2.4358823 + z * (9.544817 + z * -5.815925));
    let q1 = 0.4900873 + z * (-12.839759 + z * -5.1124477);
    let q2 = 12.270237 + z * 8.835021;
    let q3 = -9.896654;
    let p3 = q0 + y * (q1 + y * (q2 + y * q3));
    let q0 = 0.6243893 + z * (2.8365154 + z * -2.2842138);
    let q1 = -3.1064773 + z * 8.455299;
    let q2 = -6.1491227;
    let p4 = q0 + y * (q1 + y * q2);
    let q0 = -0.30908936 + z * -1.5576978;
    let q1 = 2.2178783;
    let p5 = q0 + y * q1;
    p0 + x * (p1 + x * (p2 + x * (p3 + x * (p4 + x * p5))))
}

/// Returns the fourth root of the sheen's albedo.
#[kernel]
#[inline]
fn sheen_root(x: f32, y: f32) -> f32 {
    let p0 = 1.3277326
        + y * (-3.1539903
            + y * (8.41786 + y * (-12.438445 + y * (10.361585 + y * (-4.3529134 + y * 0.660936)))));
    let p1 = 0.5681117
        + y * (0.47932616 + y * (-3.0763512 + y * (11.776746 + y * (-11.8685055 + y * 3.4460645))));
    let p2 = -0.18747683 + y * (3.876224 + y * (-18.264122 + y * (12.1920395 + y * -1.1391542)));
    let p3 = -7.7802253 + y * (11.995615 + y * (3.3199825 + y * -4.020672));
    let p4 = 9.642164 + y * (-13.023767 + y * 1.740123);
    let p5 = -4.1876764 + y * 4.32673;
    p0 + x * (p1 + x * (p2 + x * (p3 + x * (p4 + x * p5))))
}

#[cfg(test)]
mod tests {
    use core::f64::consts::{PI, TAU};

    use super::{dielectric_albedo, ggx_albedo, sheen_albedo};

    fn fresnel(cos: f64, ior: f64) -> f64 {
        let g = (ior * ior - 1.0 + cos * cos).sqrt();
        let s = (cos - g) / (cos + g);
        let p = (ior * ior * cos - g) / (ior * ior * cos + g);
        0.5 * (s * s + p * p)
    }

    /// Integrates over all half vectors, by their distribution; the fits were made of visible ones.
    fn integral(cos: f64, alpha: f64, ior: Option<f64>) -> f64 {
        const N: usize = 300;
        let sin = (1.0 - cos * cos).sqrt();
        let t = |c: f64| (alpha * alpha * (1.0 - c * c) + c * c).sqrt();
        let mut sum = 0.0;
        for i in 0..N {
            // Dense at steep half vectors, on which slanting light depends.
            let rest = (i as f64 + 0.5) / N as f64;
            let measure = 4.0 * rest * rest * rest;
            let tan2 = alpha * alpha * (1.0 / rest.powi(4) - 1.0);
            let hz = 1.0 / (1.0 + tan2).sqrt();
            let hr = tan2.sqrt() * hz;
            for j in 0..N {
                let across = (PI * (j as f64 + 0.5) / N as f64).cos();
                let c = sin * hr * across + cos * hz;
                let cos_i = 2.0 * c * hz - cos;
                if c > 0.0 && cos_i > 0.0 {
                    let shadow = 2.0 * cos * cos_i / (cos_i * t(cos) + cos * t(cos_i));
                    let reflected = ior.map_or(1.0, |n| fresnel(c, n));
                    sum += shadow * c / (cos * hz) * reflected * measure;
                }
            }
        }
        sum / (N * N) as f64
    }

    /// The sheen, by directions in steps of cosine and azimuth.
    fn sheen_integral(cos: f64, alpha: f64) -> f64 {
        const N: usize = 500;
        let k = (1.0 - alpha) * (1.0 - alpha);
        let mix = |smooth: f64, rough: f64| rough + (smooth - rough) * k;
        let l = |x: f64| {
            mix(25.3245, 21.5473) / (1.0 + mix(3.32435, 3.82987) * x.powf(mix(0.16801, 0.19823)))
                + mix(-1.27393, -1.97760) * x
                + mix(-4.85967, -4.32054)
        };
        let lambda = |c: f64| if c < 0.5 { l(c).exp() } else { (2.0 * l(0.5) - l(1.0 - c)).exp() };
        let sin = (1.0 - cos * cos).sqrt();
        let mut sum = 0.0;
        for i in 0..N {
            let cos_i = (i as f64 + 0.5) / N as f64;
            let sin_i = (1.0 - cos_i * cos_i).sqrt();
            let shadow = 1.0 / (1.0 + lambda(cos) + lambda(cos_i));
            for j in 0..N {
                let across = (PI * (j as f64 + 0.5) / N as f64).cos();
                let (x, y, z) =
                    (sin + sin_i * across, sin_i * (1.0 - across * across).sqrt(), cos + cos_i);
                let sine = ((x * x + y * y) / (x * x + y * y + z * z)).sqrt();
                let d = (2.0 + 1.0 / alpha) * sine.powf(1.0 / alpha) / TAU;
                sum += d * shadow / (4.0 * cos);
            }
        }
        sum * TAU / (N * N) as f64
    }

    #[test]
    fn known_values() {
        // The lobe of alpha 0.1 along the normal, and of alpha 1: 1 - ln 2.
        for (alpha, albedo) in [(0.1, 0.988_304_056_520_612), (1.0, 1.0 - 2f64.ln())] {
            let found = f64::from(ggx_albedo(1.0, alpha));
            assert!((-5e-5..2e-3).contains(&(found / albedo - 1.0)), "{alpha}: {found}");
        }
        // What a smooth surface reflects of light from everywhere.
        let n = 2000;
        let cosine = |i: i32| (f64::from(i) + 0.5) / f64::from(n);
        let flux = |i| 2.0 * cosine(i) * f64::from(dielectric_albedo(cosine(i) as f32, 0.0, 1.5));
        let found = (0..n).map(flux).sum::<f64>() / f64::from(n);
        assert!((-1e-4..3e-3).contains(&(found - 0.091_777_959_342_351_2)), "{found}");
    }

    #[test]
    fn above_the_integral() {
        // The coarse quadrature has an error too.
        let off = 2e-4;
        for alpha in [0.2f32, 0.45, 0.8, 1.0] {
            for cos in [0.1f32, 0.2, 0.3, 0.55, 0.8, 1.0] {
                let (c, a) = (f64::from(cos), f64::from(alpha));
                let e = integral(c, a, None);
                let excess = f64::from(ggx_albedo(cos, alpha)) / e - 1.0;
                assert!((-off..2e-3 + off).contains(&excess), "{cos} {alpha}: {excess}");
                for ior in [1.1f32, 1.5, 2.4] {
                    let e = integral(c, a, Some(f64::from(ior)));
                    let excess = f64::from(dielectric_albedo(cos, alpha, ior)) - e;
                    assert!(
                        (-off..2.7e-3 + off).contains(&excess),
                        "{cos} {alpha} {ior}: {excess}"
                    );
                }
                let excess = f64::from(sheen_albedo(cos, alpha)) - sheen_integral(c, a);
                assert!((-off..5e-3 + off).contains(&excess), "sheen {cos} {alpha}: {excess}");
            }
        }
    }

    #[test]
    fn limits() {
        assert_eq!(ggx_albedo(0.0, 0.0), 1.0);
        assert_eq!(ggx_albedo(0.0, 1.0), 1.0);
        assert!(ggx_albedo(1.0, 0.0) > 0.9999);
        for i in 0..=100 {
            let cos = i as f32 / 100.0;
            assert_eq!(dielectric_albedo(cos, 0.3, 1.0), 0.0);
            // Smooth: the reflectance itself.
            let off = f64::from(dielectric_albedo(cos, 0.0, 1.5)) - fresnel(f64::from(cos), 1.5);
            assert!(off.abs() < if cos == 0.0 { 0.02 } else { 3e-3 }, "{cos}: {off}");
        }
        let any = [f32::NAN, f32::NEG_INFINITY, -1.0, 0.0, 1e-30, 0.5, 1.0, 7.0, f32::INFINITY];
        for x in any {
            for y in any {
                for e in any.map(|z| dielectric_albedo(x, y, z)) {
                    assert!((0.0..=1.0).contains(&e), "{x} {y}: {e}");
                }
                assert!((0.0..=1.0).contains(&ggx_albedo(x, y)), "{x} {y}");
                assert!((0.0..=1.0).contains(&sheen_albedo(x, y)), "{x} {y}");
            }
        }
        assert_eq!(ggx_albedo(f32::NAN, 0.5), ggx_albedo(0.0, 0.5));
        assert_eq!(ggx_albedo(0.5, f32::NAN), ggx_albedo(0.5, 0.0));
    }

    #[test]
    fn variants_agree() {
        let values = [0.0, 1e-4, 3e-3, 0.04, 0.2, 0.5, 0.77, 1.0, 1.3];
        let pairs: Vec<(f32, f32)> = values.iter().flat_map(|&x| values.map(|y| (x, y))).collect();
        crate::assert_variants_agree!(ggx_albedo, &pairs);
        crate::assert_variants_agree!(sheen_albedo, &pairs);
        let triples: Vec<(f32, f32, f32)> =
            pairs.iter().flat_map(|&(x, y)| [1.0, 1.02, 1.5, 3.0].map(|n| (x, y, n))).collect();
        crate::assert_variants_agree!(dielectric_albedo, &triples);
    }
}
