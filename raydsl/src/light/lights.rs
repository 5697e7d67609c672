//! All lights of a scene as one value.

use glam::{Vec2, Vec3, vec2, vec3};

use super::environment::{EnvironmentView, sample_direction};
use super::{DistantLight, Environment, Light, LightSample};
use crate::geometry::{Aabb, SurfacePoint, SurfacePointOn};
use crate::machine::functions::{vec2, vec3};
use crate::machine::generic::min;
use crate::machine::wgsl::BufferKey;
use crate::machine::{
    Capture, F, Leaves, Machine, Method, On, Owner, Parameter, Resource, Schema, Slice, Table,
    TableView, Type as MachineType, U, Value, X2, X3, name, table_view,
};
use crate::sampling::{Distribution1d, power_heuristic, sample_table};
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
}

/// Greatest number of lights.
const MOST_LIGHTS: usize = 1 << 22;

/// The lights of a scene and its environment, as one value that kernels capture.
///
/// One light is sampled at a time, chosen with a probability in proportion to its power. Kernels call
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
        // Black lights are as good as each other.
        let table =
            Distribution1d::new(&powers).or_else(|_| Distribution1d::new(&vec![1.0; list.len()]));
        let cdf = table.map(|t| t.cdf().to_vec()).unwrap_or_default();
        let is_distant = |i: &u32| list[*i as usize].is_distant();
        let distant: Vec<u32> = (0..list.len() as u32).filter(is_distant).collect();
        let (count, far) = (list.len() as u32, distant.len() as u32);
        let layout = LightsLayout { environment_share: 0.0, radius, count, distant: far };
        Ok(Self { list, distant, cdf, environment: None, layout, owner: Owner::new() })
    }

    /// Adds an environment, which is chosen with a probability in proportion to its power, at least
    /// a tenth, and at most nine beside other lights.
    #[must_use]
    pub fn with_environment(self, environment: &'a Environment) -> Self {
        let radius = self.layout.radius;
        let listed: f64 = self.list.iter().map(|l| f64::from(l.power(radius))).sum();
        let area = core::f64::consts::PI * f64::from(radius).powi(2);
        let own = environment.mean_luminance() * 4.0 * core::f64::consts::PI * area;
        let share = if self.list.is_empty() { 1.0 } else { (own / (own + listed)).clamp(0.1, 0.9) };
        // A NaN, of an infinite radius, is none.
        let environment_share = if share > 0.0 { share as f32 } else { 0.5 };
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
    fn layout(&self) -> LightsLayout {
        self.layout
    }

    fn named_view(&self, name: &'static str) -> LightsView<'_, L> {
        let key = |part| Some(BufferKey { id: self.owner.id(), version: 0, part });
        LightsView {
            list: Slice::new(self.list, name),
            distant: Slice::owned(&self.distant, key(0), name).suffixed("distant"),
            cdf: Slice::owned(&self.cdf, key(1), name).suffixed("cdf"),
            environment: self.environment.map(|e| e.named_view(name)),
            layout: self.layout,
            name,
        }
    }
}

/// Returns the probability of choosing a light of the list.
#[kernel]
#[inline]
fn chance_of<L: Light + MachineType>(lights: &Lights<'_, L>, i: u32) -> f32 {
    let before = lights.cdf()[i as usize];
    let own = lights.cdf()[(i + 1) as usize] - before;
    if lights.has_environment() { own * (1.0 - lights.layout().environment_share) } else { own }
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
    let i = sample_table(u.z, lights.cdf()).cell;
    let light: L = lights.light(i);
    let sample = light.sample(from.position, vec2(u.x, u.y));
    LightSample { pdf: sample.pdf * chance_of(lights, i), ..sample }
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
fn emitted_by_listed<L: Light + MachineType>(
    lights: &Lights<'_, L>,
    i: u32,
    at: SurfacePoint,
    from: SurfacePoint,
    wi: Vec3,
    pdf: f32,
) -> Vec3 {
    if i >= lights.layout().count {
        return vec3(0.0, 0.0, 0.0);
    }
    let light: L = lights.light(i);
    let rival = light.pdf(from.position, at) * chance_of(lights, i);
    light.emitted(at, -wi) * power_heuristic(1.0, pdf, 1.0, rival)
}

#[kernel]
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
        radiance = emitted_by_listed(lights, i, at, from, wi, pdf);
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
            let rival = seen.pdf * chance_of(lights, i);
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
