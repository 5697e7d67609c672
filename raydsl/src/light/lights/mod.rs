//! All lights of a scene as one value.

mod choice;
mod view;

pub use view::{KernelLight, LightsView};

use glam::{Vec2, Vec3};

use self::choice::{
    chance_of, choose_one, emitted_by, radiance_of_miss, sample_number, sample_one,
};
use super::tree::{LightNode, LightTree, Lit};
use super::{Environment, Light, LightChoice, LightSample};
use crate::Type;
use crate::geometry::{Aabb, SurfacePoint};
use crate::machine::{Owner, Type as MachineType};
use crate::sampling::Distribution1d;

/// Error of joining lights.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum LightsError {
    /// The power of a light is negative, infinite or NaN.
    #[error(
        "light number {0}, from 0 on, has a power that is negative or not finite: look at its members"
    )]
    NotPower(usize),
    /// There are more lights than a table can hold.
    #[error("{count} lights are too many: at most {limit}")]
    TooMany {
        /// Number of lights.
        count: usize,
        /// Greatest number.
        limit: usize,
    },
    /// The extent of a light is infinite or NaN, which a tree of lights cannot hold.
    #[error("light number {0}, from 0 on, has an extent that is not finite: look at its members")]
    NotFinite(usize),
}

/// Steps of a random number.
const STEPS: f32 = 16_777_216.0;

/// Least share of a light that is not black: 128 steps of a random number.
const LEAST_SHARE: f64 = 1.0 / 131_072.0;

/// Greatest ratio of the power of distant lights to that of the others.
const FAR_TO_NEAR: f64 = 9.0;

/// Greatest number of lights.
const MOST_LIGHTS: usize = 1 << 22;

/// How often a light is chosen by its power where there is a tree, whatever the point: so no light is
/// missed, and no estimate is worse than by 16 times as few samples by power.
const BY_POWER: f32 = 1.0 / 16.0;

/// The lights of a scene and its environment, as one value that kernels capture.
///
/// One light is sampled at a time, chosen with a probability in proportion to its power, or, of many,
/// by a tree ([`with_tree`](Self::with_tree)). Kernels call
/// [`sample`](Self::sample) for a direction to one of the lights; where a ray hits a light,
/// [`emitted`](Self::emitted), and where it hits nothing, [`missed`](Self::missed): these weight what
/// they return against the samples, so that no light counts twice.
///
/// ```
/// use raydsl::light::{AnyLight, AreaLight, Environment, Lights, PointLight, SphereShape};
/// use raydsl::prelude::*;
///
/// let lamp = PointLight { position: vec3(0.0, 2.0, 0.0), intensity: Vec3::ONE };
/// let ball = AreaLight::<SphereShape> {
///     shape: SphereShape { center: vec3(3.0, 1.0, 0.0), radius: 0.5 },
///     radiance: Vec3::splat(4.0),
///     is_two_sided: false,
/// };
/// let list = [AnyLight::Point(lamp), AnyLight::Sphere(ball)];
/// let sky = Environment::constant(Vec3::splat(0.1))?;
/// let bounds = Aabb { min: Vec3::splat(-4.0), max: Vec3::splat(4.0) };
/// let lights = Lights::new(&list, bounds)?.with_environment(&sky);
///
/// let floor = SurfacePoint { position: Vec3::ZERO, normal: Vec3::Y, error: 1e-6 };
/// let kernel = kernel!(|u: Vec3| lights.sample(floor, u).light.x);
/// assert!(kernel.call((vec3(0.3, 0.5, 0.5),)) > 0.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Lights<'a, L: Light + MachineType> {
    list: &'a [L],
    /// Numbers of those that are infinitely far away.
    distant: Vec<u32>,
    /// How often each is chosen by power, relative to the others.
    weights: Vec<f32>,
    cdf: Vec<f32>,
    tree: LightTree,
    /// Probability of choosing by the table, where there is a tree.
    table_share: f32,
    environment: Option<&'a Environment>,
    layout: LightsLayout,
    owner: Owner,
}

/// What kernels know of lights besides.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
pub struct LightsLayout {
    /// Probability of sampling the environment.
    environment_share: f32,
    /// Radius of the scene.
    radius: f32,
    /// Number of lights.
    count: u32,
    /// Number of those that are infinitely far away.
    distant: u32,
}

/// Density of a direction that no light sample rivals: that of a camera ray, or of a delta lobe.
pub const NO_RIVAL: f32 = f32::MAX;

impl<'a, L: Light + MachineType> Lights<'a, L> {
    /// Joins lights that shine into a scene with these bounds, which say how much of a distant light
    /// falls into it.
    ///
    /// # Errors
    ///
    /// If there are too many, or the power of one is negative or not finite.
    pub fn new(list: &'a [L], bounds: Aabb) -> Result<Self, LightsError> {
        if list.len() > MOST_LIGHTS {
            return Err(LightsError::TooMany { count: list.len(), limit: MOST_LIGHTS });
        }
        let radius = 0.5 * (bounds.max - bounds.min).length();
        let radius = if radius.is_finite() && radius > 0.0 { radius } else { 1.0 };
        let weights = weights(list, radius)?;
        let cdf = table(&weights);
        let is_distant = |i: &u32| list[*i as usize].is_distant();
        let distant: Vec<u32> = (0..list.len() as u32).filter(is_distant).collect();
        let (count, far) = (list.len() as u32, distant.len() as u32);
        let layout = LightsLayout { environment_share: 0.0, radius, count, distant: far };
        Ok(Self {
            list,
            distant,
            weights,
            cdf,
            tree: LightTree::default(),
            table_share: 0.0,
            environment: None,
            layout,
            owner: Owner::new(),
        })
    }

    /// Builds a tree by which kernels choose lights that send much light to the point in question: those
    /// that are close, and that shine towards it. In a hall with 10,000 small triangles the variance of
    /// a sample is 7 to 96 times lower than by power, where each shines unhindered
    /// (`tests/tests/light/light_tree.rs`). A choice is a way down the tree, some ten times the work of one by
    /// power: a handful of lights is better off without.
    ///
    /// The cosine at the point counts on both sides of the surface, which may let light through.
    ///
    /// Lights that are infinitely far away and the environment are outside of the tree. They are chosen
    /// as often as without one; of the other samples one in 16 is by power as before, so that every
    /// light has its chance everywhere. Black lights have none.
    ///
    /// ```
    /// use raydsl::light::{Lights, PointLight};
    /// use raydsl::prelude::*;
    ///
    /// let lamp = |i: u32| PointLight { position: vec3(i as f32, 2.0, 0.0), intensity: Vec3::ONE };
    /// let lamps: Vec<PointLight> = (0..1000).map(lamp).collect();
    /// let bounds = Aabb { min: Vec3::ZERO, max: vec3(1000.0, 2.0, 0.0) };
    /// let lights = Lights::new(&lamps, bounds)?.with_tree()?;
    ///
    /// let floor = SurfacePoint { position: Vec3::X * 500.0, normal: Vec3::Y, error: 1e-6 };
    /// let kernel = kernel!(|i: u32| lights.chance(i, floor));
    /// assert!(kernel.call((500,)) > 100.0 * kernel.call((0,)));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// If the extent of a light is not finite.
    pub fn with_tree(self) -> Result<Self, LightsError> {
        let mut weights = self.weights.clone();
        let all: f64 = weights.iter().copied().map(f64::from).sum();
        let mut near = Vec::new();
        for (i, light) in self.list.iter().enumerate().filter(|(_, l)| !l.is_distant()) {
            let lit = Lit::new(i as u32, light.extent(), weights[i]);
            let lit = lit.ok_or(LightsError::NotFinite(i))?;
            if weights[i] > 0.0 {
                near.push(lit);
                weights[i] *= BY_POWER;
            }
        }
        if near.is_empty() {
            return Ok(self);
        }
        let by_table: f64 = weights.iter().copied().map(f64::from).sum();
        let tree = LightTree::new(near, self.list.len());
        let (cdf, table_share) = (table(&weights), (by_table / all) as f32);
        Ok(Self { cdf, tree, table_share, owner: Owner::new(), ..self })
    }

    /// Adds an environment, which is chosen with a probability in proportion to its power, at least
    /// a tenth and at most nine tenths beside other lights; a black one never.
    #[must_use]
    pub fn with_environment(self, environment: &'a Environment) -> Self {
        let radius = self.layout.radius;
        let listed: f64 = self.list.iter().map(|l| f64::from(l.power(radius))).sum();
        let area = core::f64::consts::PI * f64::from(radius).powi(2);
        let own = environment.mean_luminance() * 4.0 * core::f64::consts::PI * area;
        let beside = if own > 0.0 { (own / (own + listed)).clamp(0.1, 0.9) } else { 0.0 };
        let share = if self.list.is_empty() { 1.0 } else { beside };
        // A NaN, of an infinite radius, is none.
        let environment_share = if share.is_nan() { 0.5 } else { share as f32 };
        let layout = LightsLayout { environment_share, ..self.layout };
        Self { environment: Some(environment), layout, owner: Owner::new(), ..self }
    }

    /// Returns the lights.
    pub fn list(&self) -> &'a [L] {
        self.list
    }

    /// Samples the direction to one of the lights from a point of a surface, by a point of the unit
    /// cube. The density, or the probability of a delta light, includes that of the choice.
    #[inline]
    pub fn sample(&self, from: SurfacePoint, u: Vec3) -> LightSample {
        sample_one(self, from, u)
    }

    /// Returns the radiance from the point `at` of the light `i` towards `from`, from where a ray was
    /// sampled with the density `pdf` (`NO_RIVAL` where no light sample could have done so),
    /// weighted by the power heuristic against light samples. `wi` is the direction of the ray.
    ///
    /// A number that is none of a light, such as [`NO_LIGHT`](crate::bsdf::NO_LIGHT), is black.
    #[inline]
    pub fn emitted(
        &self,
        i: u32,
        at: SurfacePoint,
        from: SurfacePoint,
        wi: Vec3,
        pdf: f32,
    ) -> Vec3 {
        emitted_by(self, i, at, from, wi, pdf)
    }

    /// Returns the radiance of the environment and of distant lights along a ray that hits nothing,
    /// weighted against light samples as [`emitted`](Self::emitted) is.
    #[inline]
    pub fn missed(&self, wi: Vec3, pdf: f32) -> Vec3 {
        radiance_of_miss(self, wi, pdf)
    }

    /// Chooses a light of the list for a point of a surface, by a number from 0 to below 1. The
    /// environment is none of them. With a tree the point's normal may be on either side.
    ///
    /// There is a light in the list, or the choice has the probability 0.
    #[inline]
    pub fn choose(&self, from: SurfacePoint, u: f32) -> LightChoice {
        choose_one(self, from, u)
    }

    /// Returns the probability with which [`choose`](Self::choose) chooses the light `i`, less than
    /// [`count`](Self::count), for a point: the same number.
    #[inline]
    pub fn chance(&self, i: u32, from: SurfacePoint) -> f32 {
        chance_of(self, i, from)
    }

    /// Samples the direction to the light `i` from a point of a surface, by a point of the unit
    /// square.
    #[inline]
    pub fn sample_light(&self, i: u32, from: SurfacePoint, u: Vec2) -> LightSample {
        sample_number(self, i, from, u)
    }

    /// Samples a direction to the environment, by a point of the unit square: a dark one without.
    #[inline]
    pub fn sample_environment(&self, u: Vec2) -> LightSample {
        self.environment.map_or_else(LightSample::dark, |e| e.sample(u))
    }

    /// Returns the number of lights, the environment not counted.
    #[inline]
    pub fn count(&self) -> u32 {
        self.layout.count
    }

    /// Returns whether there is an environment.
    #[inline]
    pub fn has_environment(&self) -> bool {
        self.environment.is_some()
    }

    #[inline(always)]
    fn is_listed(&self) -> bool {
        !self.list.is_empty()
    }

    #[inline(always)]
    fn environment(&self) -> &'a Environment {
        self.environment.expect("kernels ask only where there is one")
    }

    #[inline(always)]
    fn light(&self, i: u32) -> L {
        self.list[i as usize]
    }

    #[inline(always)]
    fn distant_light(&self, k: u32) -> u32 {
        self.distant[k as usize]
    }

    #[inline(always)]
    fn has_distant(&self) -> bool {
        !self.distant.is_empty()
    }

    #[inline(always)]
    fn cdf(&self) -> &[f32] {
        &self.cdf
    }

    #[inline(always)]
    fn has_tree(&self) -> bool {
        !self.tree.nodes.is_empty()
    }

    #[inline(always)]
    fn tree_node(&self, k: u32) -> LightNode {
        self.tree.nodes[k as usize]
    }

    #[inline(always)]
    fn trail(&self, i: u32) -> u32 {
        self.tree.trails[i as usize]
    }

    #[inline(always)]
    fn table_share(&self) -> f32 {
        self.table_share
    }

    #[inline(always)]
    fn layout(&self) -> LightsLayout {
        self.layout
    }
}

/// Returns how often each light is chosen, relative to the others.
fn weights<L: Light>(list: &[L], radius: f32) -> Result<Vec<f32>, LightsError> {
    let mut powers: Vec<f64> = list.iter().map(|l| f64::from(l.power(radius))).collect();
    if let Some(i) = powers.iter().position(|p| !(p.is_finite() && *p >= 0.0)) {
        return Err(LightsError::NotPower(i));
    }
    let is_distant: Vec<bool> = list.iter().map(Light::is_distant).collect();
    let sum_of = |powers: &[f64], distant: bool| -> f64 {
        powers.iter().zip(&is_distant).filter(|(_, d)| **d == distant).map(|(p, _)| p).sum()
    };
    let (far, near) = (sum_of(&powers, true), sum_of(&powers, false));
    if near > 0.0 && far > FAR_TO_NEAR * near {
        let factor = FAR_TO_NEAR * near / far;
        powers.iter_mut().zip(&is_distant).filter(|(_, d)| **d).for_each(|(p, _)| *p *= factor);
    }
    let sum: f64 = powers.iter().sum();
    let least = sum * LEAST_SHARE.min(0.5 / list.len() as f64);
    let weight = |p: f64| if p > 0.0 { p.max(least) / sum } else { 0.0 };
    Ok(powers.into_iter().map(|p| weight(p) as f32).collect())
}

/// Returns the table of weights, in steps of random numbers, so that the difference of two entries is
/// the probability of what is between them, exactly.
fn table(weights: &[f32]) -> Vec<f32> {
    // Black lights are as good as each other.
    let table =
        Distribution1d::new(weights).or_else(|_| Distribution1d::new(&vec![1.0; weights.len()]));
    let cdf = table.map(|t| t.cdf().to_vec()).unwrap_or_default();
    cdf.into_iter().map(|share| (share * STEPS).round() / STEPS).collect()
}
