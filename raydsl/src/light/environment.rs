//! The light of an environment: a picture of all directions.

use core::f32::consts::{PI, TAU};

use glam::{Mat3, UVec2, Vec2, Vec3, Vec4, uvec2, vec2, vec3, vec4};

use super::{LightSample, luminance};
use crate::Type;
use crate::kernel;
use crate::machine::functions::{uvec2, vec2, vec3, vec4};
use crate::machine::generic::{clamp, max, min};
use crate::machine::wgsl::BufferKey;
use crate::machine::{
    Capture, DescribedSlice, F, Leaves, Machine, Method, Owner, Parameter, Resource, Schema, Slice,
    Table, TableView, Type as MachineType, U, Value, X2, X3, name, table_view, visit_value,
};
use crate::math::elementary::{atan2, sincos_2pi};
use crate::sampling::{
    Distribution2d, ONE_MINUS_EPSILON, UNIFORM_SPHERE_PDF, bilinear_pdf, sample_bilinear,
    sample_table_2d, sample_uniform_sphere, table_2d_pdf,
};

/// Error of creating an environment.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EnvironmentError {
    /// The number of texels is not that of the size.
    #[error("{found} texels for {} by {}", size.x, size.y)]
    Size {
        /// Texels per row, and rows.
        size: UVec2,
        /// Number of texels.
        found: usize,
    },
    /// There are too many texels, or none.
    #[error("{} by {} texels: an environment has from 1 to {limit} along each side", size.x, size.y)]
    Extent {
        /// Texels per row, and rows.
        size: UVec2,
        /// Greatest number along a side.
        limit: u32,
    },
    /// A texel is negative, infinite or NaN.
    #[error("texel ({}, {}) is {value}: radiance is finite and not negative", at.x, at.y)]
    NotRadiance {
        /// Column and row of the texel.
        at: UVec2,
        /// Its value.
        value: Vec3,
    },
}

/// Greatest number of texels along a side.
const MOST_TEXELS: u32 = 16384;

/// What kernels know of an environment besides its texels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
pub struct EnvironmentLayout {
    /// Rows of the rotation from the scene to the picture.
    x: Vec3,
    y: Vec3,
    z: Vec3,
    /// Texels per row, and rows.
    size: UVec2,
}

/// Light from infinitely far away, in every direction: one radiance, or a picture with latitudes
/// and longitudes.
///
/// The first row of the picture is above, at `+y`; its middle column is in the direction `-z`, and
/// `+x` is to the right of that. [`rotated`](Self::rotated) turns it. Between texels radiance is
/// bilinear, and directions are sampled with a density in proportion to its luminance, the sine of the
/// angle to `y` included, so that a single bright texel is found.
///
/// ```
/// use raydsl::light::Environment;
/// use raydsl::prelude::*;
///
/// let texels = [vec3(0.2, 0.4, 1.0), vec3(0.3, 0.2, 0.1)];
/// let sky = Environment::new(&texels, uvec2(1, 2))?;
/// let kernel = kernel!(|direction: Vec3| sky.radiance(direction));
/// assert!((kernel.call((Vec3::Y,)) - texels[0]).length() < 1e-6);
/// assert_eq!(Environment::constant(Vec3::ONE)?.mean_luminance(), 1.0);
/// # Ok::<(), raydsl::light::EnvironmentError>(())
/// ```
#[derive(Debug)]
pub struct Environment {
    texels: Vec<Vec3>,
    /// Of cells between texels, two rows for each row of texels; nothing for one radiance.
    cdf: Vec<f32>,
    mean: f64,
    layout: EnvironmentLayout,
    owner: Owner,
}

impl Environment {
    /// Creates an environment of one radiance.
    ///
    /// # Errors
    ///
    /// If it is negative or not finite.
    pub fn constant(radiance: Vec3) -> Result<Self, EnvironmentError> {
        Self::new(&[radiance], uvec2(1, 1))
    }

    /// Creates an environment from `size.y` rows of `size.x` texels.
    ///
    /// # Errors
    ///
    /// If the number of texels is another one, too large or 0, or a texel is negative or not finite.
    pub fn new(texels: &[Vec3], size: UVec2) -> Result<Self, EnvironmentError> {
        if size.min_element() == 0 || size.max_element() > MOST_TEXELS {
            return Err(EnvironmentError::Extent { size, limit: MOST_TEXELS });
        }
        if texels.len() as u64 != u64::from(size.x) * u64::from(size.y) {
            return Err(EnvironmentError::Size { size, found: texels.len() });
        }
        let is_bad = |t: &Vec3| !(t.is_finite() && t.min_element() >= 0.0);
        if let Some(i) = texels.iter().position(is_bad) {
            let at = uvec2(i as u32 % size.x, i as u32 / size.x);
            return Err(EnvironmentError::NotRadiance { at, value: texels[i] });
        }
        let (cdf, mean) = distribution(texels, size);
        let layout = EnvironmentLayout { x: Vec3::X, y: Vec3::Y, z: Vec3::Z, size };
        Ok(Self { texels: texels.to_vec(), cdf, mean, layout, owner: Owner::new() })
    }

    /// Turns the environment: `to_scene` rotates its axes to those of the scene. With `z` up that is
    /// `Mat3::from_rotation_x(PI / 2.0)`.
    #[must_use]
    pub fn rotated(self, to_scene: Mat3) -> Self {
        let EnvironmentLayout { size, .. } = self.layout;
        let layout =
            EnvironmentLayout { x: to_scene.x_axis, y: to_scene.y_axis, z: to_scene.z_axis, size };
        Self { layout, owner: Owner::new(), ..self }
    }

    /// Returns the texels.
    pub fn texels(&self) -> &[Vec3] {
        &self.texels
    }

    /// Returns the number of texels per row, and of rows.
    pub fn size(&self) -> UVec2 {
        self.layout.size
    }

    /// Returns the mean luminance of all directions.
    pub fn mean_luminance(&self) -> f64 {
        self.mean
    }

    /// Returns the radiance from a direction of unit length.
    #[inline]
    pub fn radiance(&self, direction: Vec3) -> Vec3 {
        radiance_from(self, direction)
    }

    /// Returns the density with which [`sample`](Self::sample) chooses a direction.
    #[inline]
    pub fn pdf(&self, direction: Vec3) -> f32 {
        direction_pdf(self, direction)
    }

    /// Samples a direction by a point of the unit square.
    #[inline]
    pub fn sample(&self, u: Vec2) -> LightSample {
        sample_direction(self, u)
    }

    #[inline(always)]
    fn layout(&self) -> EnvironmentLayout {
        self.layout
    }

    #[inline(always)]
    fn texel(&self, i: u32) -> Vec3 {
        self.texels[i as usize]
    }

    #[inline(always)]
    fn is_constant(&self) -> bool {
        self.cdf.is_empty()
    }

    #[inline(always)]
    fn cdf(&self) -> &[f32] {
        &self.cdf
    }

    pub(super) fn named_view(&self, name: &'static str) -> EnvironmentView<'_> {
        let key = |part| Some(BufferKey { id: self.owner.id(), version: 0, part });
        EnvironmentView {
            texels: Slice::owned(&self.texels, key(0), name).suffixed("texels"),
            cdf: Slice::owned(&self.cdf, key(1), name).suffixed("cdf"),
            layout: self.layout,
            name,
        }
    }
}

/// Returns the distribution of cells and the mean luminance.
fn distribution(texels: &[Vec3], size: UVec2) -> (Vec<f32>, f64) {
    let rows = 2 * size.y;
    let of = |i: u32, row: u32| f64::from(luminance(texels[(row * size.x + i % size.x) as usize]));
    let edge = |i: u32, k: u32| {
        let rows = edge_rows(k, size.y);
        0.5 * (of(i, rows.x) + of(i, rows.y))
    };
    let height = |k: u32| {
        let angle = |k: u32| (core::f64::consts::PI * f64::from(k) / f64::from(rows)).cos();
        angle(k) - angle(k + 1)
    };
    let weight = |k: u32, i: u32| {
        0.25 * (edge(i, k) + edge(i + 1, k) + edge(i, k + 1) + edge(i + 1, k + 1)) * height(k)
    };
    let all = || (0..rows).flat_map(|k| (0..size.x).map(move |i| (k, i)));
    let sum: f64 = all().map(|(k, i)| weight(k, i)).sum();
    let mean = sum / (2.0 * f64::from(size.x));
    if size == UVec2::ONE {
        return (Vec::new(), mean);
    }
    // Weights relative to the greatest, which an `f32` holds.
    let most = all().map(|(k, i)| weight(k, i)).fold(0.0, f64::max);
    let weights: Vec<f32> = all().map(|(k, i)| (weight(k, i) / most) as f32).collect();
    match Distribution2d::new(&weights, uvec2(size.x, rows)) {
        Ok(table) => (table.cdf().to_vec(), mean),
        // All is black: any direction will do.
        Err(_) => {
            let table = Distribution2d::new(&vec![1.0; weights.len()], uvec2(size.x, rows));
            (table.map(|t| t.cdf().to_vec()).unwrap_or_default(), mean)
        }
    }
}

/// Returns the rows of texels whose mean is the radiance at the edge `k` of half a row.
#[kernel]
#[inline]
fn edge_rows(k: u32, rows: u32) -> UVec2 {
    let upper = (max(k, 1) - 1) / 2;
    uvec2(upper, min(k / 2, rows - 1))
}

/// Returns the luminance at the corners of a cell.
#[kernel]
#[inline]
fn corners(environment: &Environment, size: UVec2, cell: UVec2) -> Vec4 {
    let left = cell.x;
    let right = if cell.x + 1 == size.x { 0 } else { cell.x + 1 };
    let (above, below) = (edge_rows(cell.y, size.y), edge_rows(cell.y + 1, size.y));
    vec4(
        between_rows(environment, size, left, above),
        between_rows(environment, size, right, above),
        between_rows(environment, size, left, below),
        between_rows(environment, size, right, below),
    )
}

#[kernel]
#[inline]
fn between_rows(environment: &Environment, size: UVec2, column: u32, rows: UVec2) -> f32 {
    let upper = luminance(environment.texel(rows.x * size.x + column));
    let lower = luminance(environment.texel(rows.y * size.x + column));
    0.5 * (upper + lower)
}

/// Returns where a direction is in the picture, in units of its sides: beginning at the middle of
/// the first column, from 0 to below 1, and at the top; and the sine of the angle to `y`.
#[kernel]
#[inline]
fn place(layout: EnvironmentLayout, direction: Vec3) -> Vec3 {
    let (x, y, z) = (layout.x.dot(direction), layout.y.dot(direction), layout.z.dot(direction));
    let sine = (x * x + z * z).sqrt();
    let turn = 0.5 + atan2(x, -z) / TAU - 0.5 / layout.size.x as f32;
    let turn = turn - turn.floor();
    vec3(min(turn, ONE_MINUS_EPSILON), min(atan2(sine, y) / PI, ONE_MINUS_EPSILON), sine)
}

/// Returns the texel of an environment of one radiance.
#[kernel]
#[inline]
fn only_texel(environment: &Environment) -> Vec3 {
    let first: u32 = 0;
    environment.texel(first)
}

#[kernel]
fn radiance_from(environment: &Environment, direction: Vec3) -> Vec3 {
    if environment.is_constant() {
        return only_texel(environment);
    }
    let layout = environment.layout();
    let size = layout.size;
    let p = place(layout, direction);
    let x = p.x * size.x as f32;
    let y = clamp(p.y * size.y as f32 - 0.5, 0.0, (size.y - 1) as f32);
    let left = min(x as u32, size.x - 1);
    let right = if left + 1 == size.x { 0 } else { left + 1 };
    let upper = min(y as u32, size.y - 1);
    let lower = min(upper + 1, size.y - 1);
    let (fx, fy) = (x - left as f32, y - upper as f32);
    let above = environment.texel(upper * size.x + left) * (1.0 - fx)
        + environment.texel(upper * size.x + right) * fx;
    let below = environment.texel(lower * size.x + left) * (1.0 - fx)
        + environment.texel(lower * size.x + right) * fx;
    above * (1.0 - fy) + below * fy
}

/// Least sine with a density: closer to the poles the picture has no area.
const MIN_SINE: f32 = 1e-6;

/// Returns the density per solid angle of a point of the picture, given that per area.
#[kernel]
#[inline]
fn per_solid_angle(per_area: f32, sine: f32) -> f32 {
    per_area / (2.0 * PI * PI * max(sine, MIN_SINE))
}

/// Returns the place in a cell of the table.
#[kernel]
#[inline]
fn in_cell(p: Vec2, cell: UVec2, cells: UVec2) -> Vec2 {
    vec2(
        clamp(p.x * cells.x as f32 - cell.x as f32, 0.0, ONE_MINUS_EPSILON),
        clamp(p.y * cells.y as f32 - cell.y as f32, 0.0, ONE_MINUS_EPSILON),
    )
}

#[kernel]
fn direction_pdf(environment: &Environment, direction: Vec3) -> f32 {
    if environment.is_constant() {
        return UNIFORM_SPHERE_PDF;
    }
    let layout = environment.layout();
    let size = layout.size;
    let cells = uvec2(size.x, 2 * size.y);
    let p = place(layout, direction);
    let point = vec2(p.x, p.y);
    let cell = uvec2(
        min((p.x * cells.x as f32) as u32, cells.x - 1),
        min((p.y * cells.y as f32) as u32, cells.y - 1),
    );
    let of_cell = table_2d_pdf(point, environment.cdf(), cells);
    let within = bilinear_pdf(in_cell(point, cell, cells), corners(environment, size, cell));
    per_solid_angle(of_cell * within, p.z)
}

#[kernel]
pub(super) fn sample_direction(environment: &Environment, u: Vec2) -> LightSample {
    if environment.is_constant() {
        let wi = sample_uniform_sphere(u);
        return LightSample::distant(wi, only_texel(environment), UNIFORM_SPHERE_PDF, false);
    }
    let layout = environment.layout();
    let size = layout.size;
    let cells = uvec2(size.x, 2 * size.y);
    let chosen = sample_table_2d(u, environment.cdf(), cells);
    let weights = corners(environment, size, chosen.cell);
    // What chose the cell is used again within it.
    let p = sample_bilinear(in_cell(chosen.point, chosen.cell, cells), weights);
    let x = (chosen.cell.x as f32 + p.x) / cells.x as f32 + 0.5 / size.x as f32;
    let y = (chosen.cell.y as f32 + p.y) / cells.y as f32;
    let (around, down) = (sincos_2pi(x), sincos_2pi(0.5 * y));
    // The middle of the picture is at -z.
    let local = vec3(-around.sin * down.sin, down.cos, around.cos * down.sin);
    let wi = vec3(
        layout.x.x * local.x + layout.y.x * local.y + layout.z.x * local.z,
        layout.x.y * local.x + layout.y.y * local.y + layout.z.y * local.z,
        layout.x.z * local.x + layout.y.z * local.y + layout.z.z * local.z,
    );
    let pdf = per_solid_angle(chosen.pdf * bilinear_pdf(p, weights), down.sin);
    LightSample::distant(wi, environment.radiance(wi), pdf, false)
}

/// View of an [`Environment`] in kernels: a host value on every machine.
#[derive(Clone, Copy, Debug)]
pub struct EnvironmentView<'a> {
    texels: Slice<'a, Vec3>,
    cdf: Slice<'a, f32>,
    layout: EnvironmentLayout,
    name: &'static str,
}

table_view!([] Environment, EnvironmentView, "environment", "environments");

impl TableView for EnvironmentView<'_> {
    fn resources(&self, visit: &mut dyn FnMut(&dyn Resource)) {
        visit(&DescribedSlice(self.texels));
        visit(&DescribedSlice(self.cdf));
        visit_value(InUniforms { environment: self.layout }, self.name, visit);
    }

    fn is_same(&self, other: &Self) -> bool {
        core::ptr::eq(self.texels.elements(), other.texels.elements())
    }
}

/// Layout in the uniform block: `sky_environment`.
#[derive(Clone, Copy, Type)]
struct InUniforms {
    environment: EnvironmentLayout,
}

/// Implements a method of the view in kernels.
macro_rules! methods {
    ($($name:literal ($($arg:ident: $t:ty),*) -> $out:ty, |$this:ident, $m:ident| $body:expr;)+) => {
        $(
            #[diagnostic::do_not_recommend]
            impl<'a, M: Machine> Method<{ name($name) }, M, ($($t,)*)> for EnvironmentView<'a> {
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
    "layout" () -> <EnvironmentLayout as MachineType>::On<M>, |this, m| {
        m.capture(this.name, InUniforms { environment: this.layout }).environment
    };
    "texel" (i: U<M>) -> X3<F<M>>, |this, m| m.element(&this.texels, i);
    "is_constant" () -> bool, |this, _m| this.cdf.is_empty();
    "cdf" () -> Slice<'a, f32>, |this, _m| this.cdf;
    "radiance" (direction: X3<F<M>>) -> X3<F<M>>, |this, m| radiance_from::on(m, this, direction);
    "pdf" (direction: X3<F<M>>) -> F<M>, |this, m| direction_pdf::on(m, this, direction);
    "sample" (u: X2<F<M>>) -> <LightSample as MachineType>::On<M>, |this, m| {
        sample_direction::on(m, this, u)
    };
}
