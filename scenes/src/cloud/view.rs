//! Where to look at a cloud from.

use raydsl_io::cloud::PointCloud;

/// A pinhole camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Place of the camera, in units of the file.
    pub eye: [f64; 3],
    /// The place in the middle of the picture.
    pub target: [f64; 3],
    /// Upward in the picture.
    pub up: [f64; 3],
    /// Vertical field of view.
    pub fov_y_degrees: f64,
}

impl View {
    /// Returns whether the view has an upright: the eye is not at the target, and `up` is not along
    /// the line between them. It does not depend on the size of the scene or the length of `up`.
    pub fn is_upright(&self) -> bool {
        let way = std::array::from_fn(|i| self.target[i] - self.eye[i]);
        let (Some(a), Some(b)) = (scaled_down(way), scaled_down(self.up)) else { return false };
        let across =
            [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
        across.iter().any(|c| c.abs() > 1e-9)
    }
}

/// A vector over its largest component, so that its products neither vanish nor overflow; `None`
/// without a direction.
fn scaled_down(v: [f64; 3]) -> Option<[f64; 3]> {
    let largest = v.iter().fold(0.0f64, |m, c| m.max(c.abs()));
    let is_direction = largest > 0.0 && v.iter().all(|c| c.is_finite());
    is_direction.then(|| v.map(|c| c / largest))
}

/// Points that are looked at to choose a view.
const SAMPLE: usize = 20_000;
/// Share of the points on either side that may be stray.
const STRAY: f64 = 0.003;
/// Share of the points that must be in the picture; stray ones may be lost.
const SEEN: f64 = 0.9995;
/// Leaves some air around the cloud.
const MARGIN: f64 = 1.04;
const FOV_Y_DEGREES: f64 = 40.0;
/// Width over height for which the view fits; wider pictures show more at the sides.
const ASPECT: f64 = 1.6;

/// A three-quarter view from the left front that fits the cloud into a picture of 8:5 or
/// wider: 35 degrees above a flat landscape, down to 12 degrees for a tall object.
///
/// Box and distance are percentiles of a sample, so that stray points do not matter. The
/// view of a single place is one unit away. Points that are not finite are passed over.
pub fn suggested_view(cloud: &PointCloud) -> View {
    let points = sample(cloud);
    let sides: [[f64; 2]; 3] = std::array::from_fn(|axis| {
        let c = points.iter().map(|p| p[axis]).collect();
        let c = sorted(c);
        [percentile(&c, STRAY), percentile(&c, 1.0 - STRAY)]
    });
    let mut target = sides.map(|[low, high]| 0.5 * (low + high));
    let [width, depth, height] = sides.map(|[low, high]| high - low);
    let tall = height / width.hypot(depth).max(height).max(f64::MIN_POSITIVE);
    let elevation = (35.0 - 40.0 * tall).max(12.0).to_radians();
    // A little off the diagonal, lest the corner of a square point at the camera.
    let axes = Axes::new(229f64.to_radians(), elevation);
    // Nearer parts look larger, so the box's middle is not the picture's.
    let mut distance = axes.fit(&points, target);
    for _ in 0..3 {
        let [aside, aloft] = axes.middle(&points, target, distance);
        for (i, c) in target.iter_mut().enumerate() {
            *c += axes.right[i] * aside + axes.up[i] * aloft;
        }
        distance = axes.fit(&points, target);
    }
    let distance = MARGIN * distance;
    let eye = std::array::from_fn(|i| target[i] + axes.back[i] * distance);
    View { eye, target, up: [0.0, 0.0, 1.0], fov_y_degrees: FOV_Y_DEGREES }
}

fn sample(cloud: &PointCloud) -> Vec<[f64; 3]> {
    let step = cloud.positions.len().div_ceil(SAMPLE).max(1);
    let all = cloud.positions.iter().step_by(step).copied();
    all.filter(|p| p.iter().all(|c| c.is_finite())).collect()
}

/// The camera's directions in the world.
struct Axes {
    right: [f64; 3],
    up: [f64; 3],
    back: [f64; 3],
}

impl Axes {
    fn new(azimuth: f64, elevation: f64) -> Self {
        let (sin, cos) = azimuth.sin_cos();
        let (rise, run) = elevation.sin_cos();
        Self {
            right: [-sin, cos, 0.0],
            up: [-rise * cos, -rise * sin, run],
            back: [run * cos, run * sin, rise],
        }
    }

    /// A place relative to the target: right, up and towards the camera.
    fn local(&self, p: &[f64; 3], target: [f64; 3]) -> [f64; 3] {
        let d: [f64; 3] = std::array::from_fn(|i| p[i] - target[i]);
        [self.right, self.up, self.back].map(|a| a[0] * d[0] + a[1] * d[1] + a[2] * d[2])
    }

    /// The distance from which the points lie within the field of view.
    fn fit(&self, points: &[[f64; 3]], target: [f64; 3]) -> f64 {
        let tangent = (0.5 * FOV_Y_DEGREES).to_radians().tan();
        let needed = |p: &[f64; 3]| {
            let [x, y, z] = self.local(p, target);
            z + (x.abs() / ASPECT).max(y.abs()) / tangent
        };
        let needed = sorted(points.iter().map(needed).collect());
        let distance = percentile(&needed, SEEN);
        if distance.is_normal() && distance > 0.0 { distance } else { 1.0 }
    }

    /// How far the middle of what the camera sees lies off the target.
    fn middle(&self, points: &[[f64; 3]], target: [f64; 3], distance: f64) -> [f64; 2] {
        let seen = |axis: usize| {
            let project = |p: &[f64; 3]| {
                let local = self.local(p, target);
                local[axis] / (1.0 - local[2] / distance).max(0.05)
            };
            let c = sorted(points.iter().map(project).collect());
            0.5 * (percentile(&c, STRAY) + percentile(&c, 1.0 - STRAY))
        };
        [seen(0), seen(1)]
    }
}

fn sorted(mut values: Vec<f64>) -> Vec<f64> {
    values.sort_unstable_by(f64::total_cmp);
    values
}

/// 0 for no values.
fn percentile(sorted: &[f64], share: f64) -> f64 {
    let last = sorted.len().saturating_sub(1) as f64;
    sorted.get((share * last).round() as usize).copied().unwrap_or(0.0)
}
