//! Points of surfaces, as a scanner finds them.

use raydsl::prelude::*;

use super::xorshift;

/// A small ball: 16 bytes.
#[primitive(sphere(center, radius))]
pub struct Point {
    /// Where it is.
    pub center: Vec3,
    /// Large enough that those of a surface nearly close it.
    pub radius: f32,
}

/// Balls all over some triangles, about `count`: each triangle has as many as its area is worth.
/// In random order, so that neighbours do not stand together.
pub fn points(triangles: &[Triangle], count: usize) -> Vec<Point> {
    let area = |t: &Triangle| f64::from(0.5 * (t.v1 - t.v0).cross(t.v2 - t.v0).length());
    let whole: f64 = triangles.iter().map(area).sum();
    let radius = (0.7 * (whole / count as f64).sqrt()) as f32;
    let mut unit = xorshift();
    let mut all = Vec::with_capacity(count);
    let mut due = 0.0;
    for t in triangles {
        due += area(t) / whole * count as f64;
        while (all.len() as f64) < due.round() {
            let at = sample_triangle(vec2(unit(), unit()));
            let center = t.v0 + (t.v1 - t.v0) * at.x + (t.v2 - t.v0) * at.y;
            all.push(Point { center, radius });
        }
    }
    shuffle(&mut all, unit);
    all
}

/// (Durstenfeld, "Algorithm 235: Random permutation", 1964.)
fn shuffle<T>(all: &mut [T], mut unit: impl FnMut() -> f32) {
    for last in (1..all.len()).rev() {
        // 24 bits are too few to reach every place of a long list; two draws are enough.
        let u = (f64::from(unit()) + f64::from(unit()) / 16_777_216.0) * (last + 1) as f64;
        all.swap(last, (u as usize).min(last));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_lie_on_triangles_by_their_area() {
        let corner = |x, y| vec3(x, y, 2.0);
        let triangle = |size: f32, at: f32| Triangle {
            v0: corner(at, 0.0),
            v1: corner(at + size, 0.0),
            v2: corner(at, size),
        };
        let all = points(&[triangle(1.0, 0.0), triangle(3.0, 10.0)], 5000);
        assert_eq!(all.len(), 5000);
        assert_eq!(all.iter().filter(|p| p.center.x < 5.0).count(), 500);
        assert!(all.iter().all(|p| p.center.z == 2.0 && p.center.y >= 0.0));
        assert!((all[0].radius - 0.7 * 0.001_f32.sqrt()).abs() < 1e-6);
        assert_eq!(size_of::<Point>(), 16);
    }
}
