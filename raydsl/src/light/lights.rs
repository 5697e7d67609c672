//! All lights of a scene as one value.

use glam::{Vec2, Vec3, vec2, vec3};

use super::environment::{EnvironmentView, sample_direction};
use super::tree::{LEAF, LightNode, LightTree, Lit, NOT_IN_TREE, share_of_first};
use super::{DistantLight, Environment, Light, LightChoice, LightSample};
use crate::geometry::{Aabb, SurfacePoint, SurfacePointOn};
use crate::machine::functions::{vec2, vec3};
use crate::machine::generic::{max, min};
use crate::machine::wgsl::BufferKey;
use crate::machine::{
    Capture, F, Leaves, Machine, Method, On, Owner, Parameter, Resource, Schema, Slice, Table,
    TableView, Type as MachineType, U, Value, X2, X3, name, table_view,
};
use crate::sampling::{Distribution1d, ONE_MINUS_EPSILON, power_heuristic, sample_table};
use crate::{Type, kernel};

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
        let powers: Vec<f32> = list.iter().map(|l| l.power(radius)).collect();
        if let Some(i) = powers.iter().position(|p| !(p.is_finite() && *p >= 0.0)) {
            return Err(LightsError::NotPower(i));
        }
        let cdf = table(&powers);
        let is_distant = |i: &u32| list[*i as usize].is_distant();
        let distant: Vec<u32> = (0..list.len() as u32).filter(is_distant).collect();
        let (count, far) = (list.len() as u32, distant.len() as u32);
        let layout = LightsLayout { environment_share: 0.0, radius, count, distant: far };
        Ok(Self {
            list,
            distant,
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
    /// (`tests/tests/light_tree.rs`). A choice is a way down the tree, some ten times the work of one by
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
        let mut weights: Vec<f32> = self.powers().collect();
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
    /// a tenth, and at most nine beside other lights.
    #[must_use]
    pub fn with_environment(self, environment: &'a Environment) -> Self {
        let radius = self.layout.radius;
        let listed: f64 = self.powers().map(f64::from).sum();
        let area = core::f64::consts::PI * f64::from(radius).powi(2);
        let own = environment.mean_luminance() * 4.0 * core::f64::consts::PI * area;
        let share = if self.list.is_empty() { 1.0 } else { (own / (own + listed)).clamp(0.1, 0.9) };
        // A NaN, of an infinite radius, is none.
        let environment_share = if share > 0.0 { share as f32 } else { 0.5 };
        let layout = LightsLayout { environment_share, ..self.layout };
        Self { environment: Some(environment), layout, owner: Owner::new(), ..self }
    }

    fn powers(&self) -> impl Iterator<Item = f32> {
        self.list.iter().map(|l| l.power(self.layout.radius))
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

    fn named_view(&self, name: &'static str) -> LightsView<'_, L> {
        let key = |part| Some(BufferKey { id: self.owner.id(), version: 0, part });
        LightsView {
            list: Slice::new(self.list, name),
            distant: Slice::owned(&self.distant, key(0), name).suffixed("distant"),
            cdf: Slice::owned(&self.cdf, key(1), name).suffixed("cdf"),
            nodes: Slice::owned(&self.tree.nodes, key(2), name).suffixed("tree"),
            trails: Slice::owned(&self.tree.trails, key(3), name).suffixed("trails"),
            table_share: self.table_share,
            environment: self.environment.map(|e| e.named_view(name)),
            layout: self.layout,
            name,
        }
    }
}

/// Returns the table of weights.
fn table(weights: &[f32]) -> Vec<f32> {
    // Black lights are as good as each other.
    let table =
        Distribution1d::new(weights).or_else(|_| Distribution1d::new(&vec![1.0; weights.len()]));
    table.map(|t| t.cdf().to_vec()).unwrap_or_default()
}

/// Returns the probability of a light by the table alone.
#[kernel]
#[inline]
fn chance_by_table<L: Light + MachineType>(lights: &Lights<'_, L>, i: u32) -> f32 {
    let before = lights.cdf()[i as usize];
    lights.cdf()[(i + 1) as usize] - before
}

/// Goes down the tree, by a number or by the trail of a light.
#[kernel]
fn descend<L: Light + MachineType>(
    lights: &Lights<'_, L>,
    from: SurfacePoint,
    is_known: bool,
    trail: u32,
    u: f32,
) -> LightChoice {
    let top: u32 = 0;
    let root: LightNode = lights.tree_node(top);
    let mut child = root.child;
    let (mut rest, mut turns, mut chance) = (u, trail, 1.0);
    while child < LEAF {
        let first: LightNode = lights.tree_node(child);
        let second: LightNode = lights.tree_node(child + 1);
        let share = share_of_first(first, second, from);
        let is_second = if is_known { (turns & 1) == 1 } else { rest >= share };
        let before = if is_second { share } else { 0.0 };
        let own = if is_second { 1.0 - share } else { share };
        // What chose the child is used again below it.
        rest = min((rest - before) / max(own, f32::MIN_POSITIVE), ONE_MINUS_EPSILON);
        turns >>= 1;
        chance *= own;
        child = if is_second { second.child } else { first.child };
    }
    LightChoice { light: child & (LEAF - 1), chance }
}

/// Returns the probability of a light by the table or the tree.
#[kernel]
#[inline]
fn by_either(by_table: f32, by_tree: f32, table_share: f32) -> f32 {
    by_table * table_share + by_tree * (1.0 - table_share)
}

/// Returns the probability of choosing a light among the list.
#[kernel]
fn chance_of<L: Light + MachineType>(lights: &Lights<'_, L>, i: u32, from: SurfacePoint) -> f32 {
    let by_table = chance_by_table(lights, i);
    if lights.has_tree() {
        let trail = lights.trail(i);
        let mut by_tree = 0.0;
        if trail < NOT_IN_TREE {
            let found: LightChoice = descend(lights, from, true, trail, 0.0);
            by_tree = found.chance;
        }
        return by_either(by_table, by_tree, lights.table_share());
    }
    by_table
}

/// Returns the probability of choosing a light that is infinitely far away.
#[kernel]
#[inline]
fn chance_of_distant<L: Light + MachineType>(lights: &Lights<'_, L>, i: u32) -> f32 {
    let by_table = chance_by_table(lights, i);
    if lights.has_tree() { by_either(by_table, 0.0, lights.table_share()) } else { by_table }
}

/// Returns the probability of choosing a light of the list and not the environment, given that among
/// the list.
#[kernel]
#[inline]
fn of_all<L: Light + MachineType>(lights: &Lights<'_, L>, chance: f32) -> f32 {
    if lights.has_environment() {
        chance * (1.0 - lights.layout().environment_share)
    } else {
        chance
    }
}

/// Chooses a light of the list.
#[kernel]
fn choose_listed<L: Light + MachineType>(
    lights: &Lights<'_, L>,
    from: SurfacePoint,
    u: f32,
) -> LightChoice {
    if lights.has_tree() {
        let table_share = lights.table_share();
        let is_by_table = u < table_share;
        let mut light: u32 = 0;
        let mut trail: u32 = 0;
        if is_by_table {
            light = sample_table(min(u / table_share, ONE_MINUS_EPSILON), lights.cdf()).cell;
            trail = lights.trail(light);
        }
        let mut by_tree = 0.0;
        if trail < NOT_IN_TREE {
            let others = max(1.0 - table_share, f32::MIN_POSITIVE);
            let rest = min((u - table_share) / others, ONE_MINUS_EPSILON);
            let found: LightChoice = descend(lights, from, is_by_table, trail, rest);
            light = found.light;
            by_tree = found.chance;
        }
        let chance = by_either(chance_by_table(lights, light), by_tree, table_share);
        return LightChoice { light, chance };
    }
    let light = sample_table(u, lights.cdf()).cell;
    LightChoice { light, chance: chance_by_table(lights, light) }
}

#[kernel]
fn choose_one<L: Light + MachineType>(
    lights: &Lights<'_, L>,
    from: SurfacePoint,
    u: f32,
) -> LightChoice {
    if lights.is_listed() {
        choose_listed(lights, from, u)
    } else {
        LightChoice { light: 0, chance: 0.0 }
    }
}

/// Samples the light `i`.
#[kernel]
#[inline]
fn sample_number<L: Light + MachineType>(
    lights: &Lights<'_, L>,
    i: u32,
    from: SurfacePoint,
    u: Vec2,
) -> LightSample {
    let light: L = lights.light(i);
    light.sample(from.position, u)
}

/// Samples a light of the list.
#[kernel]
fn sample_listed<L: Light + MachineType>(
    lights: &Lights<'_, L>,
    from: SurfacePoint,
    u: Vec3,
) -> LightSample {
    let chosen: LightChoice = choose_listed(lights, from, u.z);
    let light: L = lights.light(chosen.light);
    let sample = light.sample(from.position, vec2(u.x, u.y));
    LightSample { pdf: sample.pdf * of_all(lights, chosen.chance), ..sample }
}

#[kernel]
fn sample_one<L: Light + MachineType>(
    lights: &Lights<'_, L>,
    from: SurfacePoint,
    u: Vec3,
) -> LightSample {
    if lights.has_environment() {
        let share = lights.layout().environment_share;
        let mut sample = LightSample::dark();
        if u.z < share || !lights.is_listed() {
            sample = lights.environment().sample(vec2(u.x, u.y));
            sample.pdf *= share;
        } else if lights.is_listed() {
            let z = min((u.z - share) / (1.0 - share), 0.999_999_94);
            sample = sample_listed(lights, from, vec3(u.x, u.y, z));
        }
        return sample;
    }
    if lights.is_listed() { sample_listed(lights, from, u) } else { LightSample::dark() }
}

#[kernel]
#[expect(clippy::collapsible_if, reason = "the outer one is decided before the kernel runs")]
fn emitted_by<L: Light + MachineType>(
    lights: &Lights<'_, L>,
    i: u32,
    at: SurfacePoint,
    from: SurfacePoint,
    wi: Vec3,
    pdf: f32,
) -> Vec3 {
    let mut radiance = vec3(0.0, 0.0, 0.0);
    if lights.is_listed() {
        if i < lights.layout().count {
            let light: L = lights.light(i);
            let rival = light.pdf(from.position, at) * of_all(lights, chance_of(lights, i, from));
            radiance = light.emitted(at, -wi) * power_heuristic(1.0, pdf, 1.0, rival);
        }
    }
    radiance
}

#[kernel]
fn radiance_of_miss<L: Light + MachineType>(lights: &Lights<'_, L>, wi: Vec3, pdf: f32) -> Vec3 {
    let mut radiance = vec3(0.0, 0.0, 0.0);
    if lights.has_environment() {
        let rival = lights.environment().pdf(wi) * lights.layout().environment_share;
        radiance = lights.environment().radiance(wi) * power_heuristic(1.0, pdf, 1.0, rival);
    }
    if lights.has_distant() {
        for k in 0..lights.layout().distant {
            let i = lights.distant_light(k);
            let light: L = lights.light(i);
            let seen: DistantLight = light.distant(wi);
            let rival = seen.pdf * of_all(lights, chance_of_distant(lights, i));
            radiance += seen.radiance * power_heuristic(1.0, pdf, 1.0, rival);
        }
    }
    radiance
}

/// View of [`Lights`] in kernels: a host value on every machine.
#[derive(Debug)]
pub struct LightsView<'a, L: Light + MachineType> {
    list: Slice<'a, L>,
    distant: Slice<'a, u32>,
    cdf: Slice<'a, f32>,
    nodes: Slice<'a, LightNode>,
    trails: Slice<'a, u32>,
    table_share: f32,
    environment: Option<EnvironmentView<'a>>,
    layout: LightsLayout,
    name: &'static str,
}

impl<L: Light + MachineType> Clone for LightsView<'_, L> {
    #[inline(always)]
    fn clone(&self) -> Self {
        *self
    }
}

impl<L: Light + MachineType> Copy for LightsView<'_, L> {}

/// A light that kernels have.
pub trait KernelLight: Light + MachineType {}

impl<L: Light + MachineType> KernelLight for L {}

table_view!([L: KernelLight] Lights<'_, L>, LightsView, "lights", "lights");

impl<L: Light + MachineType> TableView for LightsView<'_, L> {
    fn resources(&self, visit: &mut dyn FnMut(&dyn Resource)) {
        visit(&self.list);
        visit(&self.distant);
        visit(&self.cdf);
        visit(&self.nodes);
        visit(&self.trails);
        if let Some(environment) = &self.environment {
            environment.resources(visit);
        }
    }

    fn is_same(&self, other: &Self) -> bool {
        self.list.is_same(&other.list)
            && core::ptr::eq(self.cdf.elements(), other.cdf.elements())
            && match (&self.environment, &other.environment) {
                (None, None) => true,
                (Some(a), Some(b)) => a.is_same(b),
                _ => false,
            }
    }
}

/// Layout in the uniform block: `lamps_lights`.
#[derive(Clone, Copy, Type)]
struct InUniforms {
    lights: LightsLayout,
}

/// What kernels know of the tree in the uniform block, if there is one: `lamps_table_share`.
#[derive(Clone, Copy, Type)]
struct OfTree {
    table_share: f32,
}

/// Implements a method of the view in kernels.
macro_rules! methods {
    ($($name:literal ($($arg:ident: $t:ty),*) -> $out:ty, |$this:ident, $m:ident| $body:expr;)+) => {
        $(
            #[diagnostic::do_not_recommend]
            impl<'a, M: Machine, L: Light + MachineType> Method<{ name($name) }, M, ($($t,)*)>
                for LightsView<'a, L>
            {
                type Output = $out;

                #[inline(always)]
                fn call(self, $m: &M, ($($arg,)*): ($($t,)*)) -> $out {
                    let $this = self;
                    $body
                }
            }
        )+
    };
}

methods! {
    "layout" () -> On<LightsLayout, M>, |this, m| {
        m.capture(this.name, InUniforms { lights: this.layout }).lights
    };
    "light" (i: U<M>) -> On<L, M>, |this, m| m.element(&this.list, i);
    "is_listed" () -> bool, |this, _m| !this.list.elements().is_empty();
    "has_environment" () -> bool, |this, _m| this.environment.is_some();
    "environment" () -> EnvironmentView<'a>, |this, _m| {
        this.environment.expect("kernels ask only where there is one")
    };
    "count" () -> U<M>, |this, m| {
        m.capture(this.name, InUniforms { lights: this.layout }).lights.count
    };
    "sample_light" (i: U<M>, from: SurfacePointOn<M>, u: X2<F<M>>) -> On<LightSample, M>, |this, m| {
        sample_number::on(m, this, i, from, u)
    };
    "sample_environment" (u: X2<F<M>>) -> On<LightSample, M>, |this, m| match this.environment {
        Some(e) => sample_direction::on(m, e, u),
        None => LightSample::splat(m, LightSample::dark()),
    };
    "has_distant" () -> bool, |this, _m| !this.distant.elements().is_empty();
    "distant_light" (k: U<M>) -> U<M>, |this, m| m.element(&this.distant, k);
    "cdf" () -> Slice<'a, f32>, |this, _m| this.cdf;
    "has_tree" () -> bool, |this, _m| !this.nodes.elements().is_empty();
    "tree_node" (k: U<M>) -> On<LightNode, M>, |this, m| m.element(&this.nodes, k);
    "trail" (i: U<M>) -> U<M>, |this, m| m.element(&this.trails, i);
    "table_share" () -> F<M>, |this, m| {
        m.capture(this.name, OfTree { table_share: this.table_share }).table_share
    };
    "choose" (from: SurfacePointOn<M>, u: F<M>) -> On<LightChoice, M>, |this, m| {
        choose_one::on(m, this, from, u)
    };
    "chance" (i: U<M>, from: SurfacePointOn<M>) -> F<M>, |this, m| {
        chance_of::on(m, this, i, from)
    };
    "sample" (from: SurfacePointOn<M>, u: X3<F<M>>) -> On<LightSample, M>, |this, m| {
        sample_one::on(m, this, from, u)
    };
    "emitted" (
        i: U<M>, at: SurfacePointOn<M>, from: SurfacePointOn<M>, wi: X3<F<M>>, pdf: F<M>
    ) -> X3<F<M>>, |this, m| emitted_by::on(m, this, i, at, from, wi, pdf);
    "missed" (wi: X3<F<M>>, pdf: F<M>) -> X3<F<M>>, |this, m| {
        radiance_of_miss::on(m, this, wi, pdf)
    };
}
