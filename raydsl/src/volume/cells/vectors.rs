//! Vector fields on meshes of cells, found by a tree over the tetrahedra.

use glam::{Vec3, Vec4, vec3, vec4};

use super::error::CellError;
use super::mesh::{CellMesh, Tetrahedron};
use crate::bvh::{BuildConfig, Bvh, PrimitiveScene, RecordQuery, SceneView};
use crate::geometry::{Aabb, Ray};
use crate::machine::functions::{vec3, vec4};
use crate::machine::generic::{clamp, max, min};
use crate::machine::wgsl::BufferKey;
use crate::machine::{
    Capture, DescribedSlice, F, Leaves, Machine, Method, On, Owner, Parameter, Resource, Schema,
    Slice, Table, TableView, U, V3, Value, name, table_view, visit_value,
};
use crate::{Type, kernel};

/// Length of the rays that find a cell, as a share of the mesh.
const RAY: f32 = 1.0 / 1_048_576.0;

/// Sizes whose scale is a normal number.
const SMALLEST: f32 = 1e-37;
const LARGEST: f32 = 1e37;

/// Vector field on a mesh of cells: a vector for each point, linear within each tetrahedron, and a
/// tree over the tetrahedra, which finds where a point is.
///
/// A point between two tetrahedra by rounding belongs to the nearer one; so the field reaches at most
/// some 2^-12 of a tetrahedron's height beyond the outer faces. Where tetrahedra overlap, the first one
/// counts. Where one of the four vectors is NaN or infinite there is no value.
///
/// ```
/// use raydsl::prelude::*;
/// use raydsl::volume::cells::{CellKind, CellMesh, CellVectors};
///
/// let points = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
/// let mesh = CellMesh::new(&points, &[0, 1, 2, 3], &[CellKind::Tetrahedron])?;
/// let wind = CellVectors::new(&mesh, &[Vec3::X, Vec3::X, Vec3::Y, Vec3::X])?;
/// let kernel = kernel!(|p: Vec3| wind.value(p).unwrap_or(Vec3::ZERO));
/// assert_eq!(kernel.call((vec3(0.0, 0.5, 0.0),)), vec3(0.5, 0.5, 0.0));
/// assert_eq!(wind.value(Vec3::ONE), None);
/// # Ok::<(), raydsl::volume::cells::CellError>(())
/// ```
#[derive(Debug)]
pub struct CellVectors<'a> {
    mesh: &'a CellMesh<'a>,
    solids: Bvh<'a, Tetrahedron>,
    vectors: &'a [Vec3],
    /// Length of the rays that find a cell.
    ray_length: f32,
    owner: Owner,
}

impl<'a> CellVectors<'a> {
    /// Joins a mesh and a vector for each of its points. It sorts the tetrahedra into a tree.
    ///
    /// # Errors
    ///
    /// If the number of vectors is not that of the points, or the tree cannot be built.
    pub fn new(mesh: &'a CellMesh<'a>, vectors: &'a [Vec3]) -> Result<Self, CellError> {
        let (expected, found) = (mesh.points().len(), vectors.len());
        if found != expected {
            return Err(CellError::Values { of: "points", expected, found });
        }
        let solids = Bvh::build_sharing(mesh.tetrahedra(), mesh.points(), &BuildConfig::default())?;
        let extent = solids.bounds().size().max_element();
        let ray_length = if extent > 0.0 { extent * RAY } else { RAY };
        Ok(Self { mesh, solids, vectors, ray_length, owner: Owner::new() })
    }

    /// Returns the mesh.
    pub fn mesh(&self) -> &'a CellMesh<'a> {
        self.mesh
    }

    /// Returns the vectors.
    pub fn vectors(&self) -> &'a [Vec3] {
        self.vectors
    }

    /// Returns the box around the mesh.
    pub fn bounds(&self) -> Aabb {
        self.solids.bounds()
    }

    /// Returns the vector at a point of the world, or `None` where there is no cell, and in a
    /// tetrahedron with a vector that is not finite.
    #[inline]
    pub fn value(&self, p: Vec3) -> Option<Vec3> {
        value(self, p)
    }

    #[inline(always)]
    fn ray_length(&self) -> f32 {
        self.ray_length
    }

    #[inline(always)]
    fn solids(&self) -> &Bvh<'a, Tetrahedron> {
        &self.solids
    }

    #[inline(always)]
    fn point(&self, i: u32) -> Vec3 {
        self.mesh.points()[i as usize]
    }

    #[inline(always)]
    fn vector(&self, i: u32) -> Vec3 {
        self.vectors[i as usize]
    }

    fn named_view(&self, name: &'static str) -> CellVectorsView<'_> {
        let id = self.owner.id();
        let key = BufferKey { id, version: 0, part: 0 };
        let vectors = Slice::owned(self.vectors, Some(key), name).suffixed("vectors");
        CellVectorsView {
            solids: self.solids.view().named(name),
            vectors,
            ray_length: self.ray_length,
            owner: id,
            name,
        }
    }
}

/// View of [`CellVectors`] in kernels: a host value on every machine.
#[derive(Clone, Copy, Debug)]
pub struct CellVectorsView<'a> {
    solids: SceneView<'a, Tetrahedron>,
    vectors: Slice<'a, Vec3>,
    ray_length: f32,
    /// Id of the field: several may be on the same points, with the same vectors.
    owner: u64,
    name: &'static str,
}

table_view!([] CellVectors<'_>, CellVectorsView, "vectors", "fields on cells");

impl TableView for CellVectorsView<'_> {
    fn resources(&self, visit: &mut dyn FnMut(&dyn Resource)) {
        visit(&self.solids);
        visit(&DescribedSlice(self.vectors));
        visit_value(InUniforms { cells_ray: self.ray_length }, self.name, visit);
    }

    fn is_same(&self, other: &Self) -> bool {
        self.owner == other.owner
    }
}

/// What is in the uniform block: `wind_cells_ray`.
#[derive(Clone, Copy, Type)]
struct InUniforms {
    cells_ray: f32,
}

/// Implements a method of the view in kernels.
macro_rules! methods {
    ($($name:literal ($($arg:ident: $t:ty),*) -> $out:ty, |$this:ident, $m:ident| $body:expr;)+) => {
        $(
            #[diagnostic::do_not_recommend]
            impl<'a, M: Machine> Method<{ name($name) }, M, ($($t,)*)> for CellVectorsView<'a> {
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
    "ray_length"() -> F<M>, |this, m| {
        m.capture(this.name, InUniforms { cells_ray: this.ray_length }).cells_ray
    };
    "solids"() -> SceneView<'a, Tetrahedron>, |this, _m| this.solids;
    "point"(i: U<M>) -> V3<M>, |this, m| m.element(&this.solids.shared(), i);
    "vector"(i: U<M>) -> V3<M>, |this, m| m.element(&this.vectors, i);
    "value"(p: V3<M>) -> On<Option<Vec3>, M>, |this, m| value::on(m, this, p);
}

#[kernel]
#[inline(never)]
fn value(cells: &CellVectors<'_>, p: Vec3) -> Option<Vec3> {
    let ray = Ray::new(p, vec3(0.0, 0.0, cells.ray_length())).with_range(0.0, 1.0);
    let hit = cells.solids().closest_hit(ray);
    let mut vector = vec3(0.0, 0.0, 0.0);
    let mut is_found = false;
    if hit.is_hit {
        let solid: Tetrahedron = cells.solids().primitive(hit);
        let i = solid.vertices;
        let (a, b) = (cells.point(i.x), cells.point(i.y));
        let (c, d) = (cells.point(i.z), cells.point(i.w));
        let weights = max(weights_of(p, a, b, c, d), vec4(0.0, 0.0, 0.0, 0.0));
        let sum = weights.x + weights.y + weights.z + weights.w;
        // From left to right: devices regroup sums of sums.
        let (v, w) = (cells.vector(i.x) * weights.x, cells.vector(i.y) * weights.y);
        vector = v + w + cells.vector(i.z) * weights.z + cells.vector(i.w) * weights.w;
        vector /= sum;
        is_found = vector.is_finite();
    }
    if is_found { Some(vector) } else { None }
}

/// Returns the barycentric weights of a point in a tetrahedron, below 0 outside; not finite if it is
/// flat.
#[kernel]
#[inline]
pub(super) fn weights_of(p: Vec3, a: Vec3, b: Vec3, c: Vec3, d: Vec3) -> Vec4 {
    let (a, b, c, d) = (a - p, b - p, c - p, d - p);
    let most = a.abs().max(b.abs()).max(c.abs().max(d.abs()));
    let scale = scale_of(max(max(most.x, most.y), most.z));
    let (a, b, c, d) = (a * scale, b * scale, c * scale, d * scale);
    let (cd, ab) = (c.cross(d), a.cross(b));
    let volumes = vec4(b.dot(cd), -a.dot(cd), d.dot(ab), -c.dot(ab));
    volumes / (volumes.x + volumes.y + volumes.z + volumes.w)
}

/// Returns the power of two that brings a size to between 1 and 2: products with it are exact, so
/// that a device may group them as it likes.
#[kernel]
#[inline]
fn scale_of(size: f32) -> f32 {
    let exponent = clamp(size, SMALLEST, LARGEST).to_bits() & 0x7f80_0000;
    f32::from_bits(0x7f00_0000 - exponent)
}

/// Returns the least of four numbers.
#[kernel]
#[inline]
pub(super) fn least_of(v: Vec4) -> f32 {
    min(min(v.x, v.y), min(v.z, v.w))
}

#[cfg(test)]
mod tests {
    use super::super::CellKind;
    use super::*;

    #[test]
    fn fields_on_two_meshes_are_told_apart() -> Result<(), CellError> {
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
        let one = CellMesh::new(&corners, &[0, 1, 2, 3], &[CellKind::Tetrahedron])?;
        let none = CellMesh::new(&corners, &[], &[])?;
        let (a, b) = (CellVectors::new(&one, &corners)?, CellVectors::new(&none, &corners)?);
        let [a, b] = [&a, &b].map(|field| field.named_view("field"));
        assert!(a.is_same(&a) && !a.is_same(&b));
        Ok(())
    }
}
