//! Indexed meshes with what their vertices and triangles carry beside positions.

use core::fmt;

use glam::{Affine3, Vec2, Vec3, Vec4, vec3, vec4};

use super::attributes::{
    color_between, direction_or, smooth_normal, tangent_between, tangent_of_uvs, uv_between,
};
use super::scene::{Asked, in_scene};
use super::{Scene, ShadingPointOn};
use crate::bvh::carrier::carrier;
use crate::bvh::{PrimitiveScene, RayQueryOn, RecordQuery, SceneView};
use crate::geometry::{Hit, HitOn, IndexedTriangle, RayOn, SurfacePointOn, transform_normal_back};
use crate::machine::functions::{vec3, vec4};
use crate::machine::generic::{inverse, max};
use crate::machine::{
    Capture, Data, Leaves, Machine, On, Parameter, Resource, Schema, Slice, U, Value, X2,
};
use crate::sampling::Frame;
use crate::{Type, kernel};

/// What the vertices and triangles of a mesh carry beside positions. Each slice is the
/// application's; an empty one is left out of kernels.
#[derive(Clone, Copy, Debug, Default)]
pub struct MeshAttributes<'a> {
    /// Normals of the vertices, of any length above 0.
    pub normals: &'a [Vec3],
    /// Surface coordinates of the vertices.
    pub uvs: &'a [Vec2],
    /// Tangents of the vertices, in the direction in which the first surface coordinate grows; the
    /// last component is 1, or -1 where the bitangent is `-cross(normal, tangent)` (as in glTF).
    pub tangents: &'a [Vec4],
    /// Colours of the vertices: red, green and blue, each from 0 to 1.
    pub colors: &'a [Vec3],
    /// The material number of each triangle.
    pub materials: &'a [u32],
}

/// A scene of an indexed mesh, or of several that share their vertices, with [`MeshAttributes`]: a
/// tree, a list, instances or an accelerator of [`IndexedTriangle`]s. Integrators shade it.
///
/// ```
/// use raydsl::prelude::*;
/// use raydsl::shading::{Mesh, MeshAttributes};
///
/// let vertices = [vec3(0.0, 0.0, 2.0), vec3(2.0, 0.0, 2.0), vec3(0.0, 2.0, 2.0)];
/// let triangles = [IndexedTriangle { vertices: [0, 1, 2] }];
/// let bvh = Bvh::build_sharing(&triangles, &vertices, &BuildConfig::default())?;
/// let leaning = [vec3(-1.0, 0.0, 1.0), vec3(1.0, 0.0, 1.0), vec3(0.0, 1.0, 1.0)];
/// let mesh = Mesh::new(&bvh, MeshAttributes { normals: &leaning, ..Default::default() })?;
/// let ray = Ray::new(vec3(1.0, 0.0, 0.0), Vec3::Z);
/// let hit = mesh.closest_hit(ray);
/// let seen = mesh.shading_point(ray, hit);
/// assert_eq!(seen.shading_normal, vec3(0.0, 0.0, 1.0));
/// assert_eq!(seen.point.position, vec3(1.0, 0.0, 2.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Mesh<'a, S: ?Sized> {
    triangles: &'a S,
    attributes: MeshAttributes<'a>,
}

impl<S: ?Sized> fmt::Debug for Mesh<'_, S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Mesh").field("attributes", &self.attributes).finish_non_exhaustive()
    }
}

/// Why attributes do not fit a mesh.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct MeshError {
    /// The member of [`MeshAttributes`].
    pub attribute: &'static str,
    /// Its length.
    pub count: usize,
    /// The length that it should have: the number of vertices, or of triangles.
    pub expected: usize,
}

impl fmt::Display for MeshError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { attribute, count, expected } = self;
        let of = if *attribute == "materials" { "triangle" } else { "vertex" };
        write!(f, "a mesh has one element of `{attribute}` for each {of}: {expected}, not {count}")
    }
}

impl std::error::Error for MeshError {}

impl<'a, S: PrimitiveScene<Primitive = IndexedTriangle> + ?Sized> Mesh<'a, S> {
    /// Joins triangles and attributes, which must be empty or have an element for each vertex (or
    /// triangle).
    ///
    /// # Errors
    ///
    /// If the length of a slice is another one.
    pub fn new(triangles: &'a S, attributes: MeshAttributes<'a>) -> Result<Self, MeshError> {
        let view = triangles.primitives_view();
        let (vertices, count) = (view.shared().len(), Data::count(&view));
        let MeshAttributes { normals, uvs, tangents, colors, materials } = &attributes;
        for (attribute, count, expected) in [
            ("normals", normals.len(), vertices),
            ("uvs", uvs.len(), vertices),
            ("tangents", tangents.len(), vertices),
            ("colors", colors.len(), vertices),
            ("materials", materials.len(), count),
        ] {
            if count != 0 && count != expected {
                return Err(MeshError { attribute, count, expected });
            }
        }
        Ok(Self { triangles, attributes })
    }

    /// Returns the triangles.
    pub fn triangles(&self) -> &'a S {
        self.triangles
    }
}

/// View of a [`Mesh`] in kernels. A host value on every machine.
#[derive(Clone, Copy, Debug)]
pub struct MeshView<'a> {
    triangles: SceneView<'a, IndexedTriangle>,
    normals: Slice<'a, Vec3>,
    uvs: Slice<'a, Vec2>,
    tangents: Slice<'a, Vec4>,
    colors: Slice<'a, Vec3>,
    materials: Slice<'a, u32>,
}

/// Divides by the largest component.
#[kernel]
fn in_largest(v: Vec3) -> Vec3 {
    v / max(v.abs().max_element(), f32::MIN_POSITIVE)
}

/// Transforms a tangent of an instance to the space of the scene. In a mirrored instance the bitangent is
/// on the other side of normal and tangent.
#[kernel]
fn placed_tangent(to_object: Affine3, tangent: Vec4) -> Vec4 {
    let matrix = to_object.matrix3;
    let along = inverse(matrix) * vec3(tangent.x, tangent.y, tangent.z);
    // Scaled, so that the products neither over- nor underflow.
    let (x, y) = (in_largest(matrix.x_axis), in_largest(matrix.y_axis));
    let is_mirrored = in_largest(matrix.z_axis).dot(x.cross(y)) < 0.0;
    vec4(along.x, along.y, along.z, if is_mirrored { -tangent.w } else { tangent.w })
}

/// Returns a tangent perpendicular to the normal, of unit length.
#[kernel]
fn perpendicular(normal: Vec3, tangent: Vec4) -> Vec4 {
    let along = vec3(tangent.x, tangent.y, tangent.z);
    let unit = direction_or(along - normal * normal.dot(along), Frame::around(normal).x);
    vec4(unit.x, unit.y, unit.z, if tangent.w < 0.0 { -1.0 } else { 1.0 })
}

carrier!(['a] MeshView<'a>, SceneView<'a, IndexedTriangle>, triangles);

/// A host value on every machine.
impl<M: Machine> Value<M> for MeshView<'_> {
    const SCHEMA: &'static Schema = &Schema::Host;

    fn zero(m: &M) -> Self {
        Self {
            triangles: Value::<M>::zero(m),
            normals: Value::<M>::zero(m),
            uvs: Value::<M>::zero(m),
            tangents: Value::<M>::zero(m),
            colors: Value::<M>::zero(m),
            materials: Value::<M>::zero(m),
        }
    }

    #[inline(always)]
    fn zip(m: &M, a: Self, b: Self, f: &mut impl Leaves<M>) -> Self {
        Self {
            triangles: Value::<M>::zip(m, a.triangles, b.triangles, f),
            normals: Value::<M>::zip(m, a.normals, b.normals, f),
            uvs: Value::<M>::zip(m, a.uvs, b.uvs, f),
            tangents: Value::<M>::zip(m, a.tangents, b.tangents, f),
            colors: Value::<M>::zip(m, a.colors, b.colors, f),
            materials: Value::<M>::zip(m, a.materials, b.materials, f),
        }
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, S: PrimitiveScene<Primitive = IndexedTriangle> + ?Sized> Capture<M>
    for Mesh<'_, S>
{
    type On<'c>
        = MeshView<'c>
    where
        Self: 'c;

    #[inline(always)]
    fn capture<'c>(&'c self, _: &M, name: &'static str) -> MeshView<'c> {
        RayQueryOn::named(self.view(), name)
    }

    #[inline(always)]
    fn constant<'c>(&'c self, _: &M) -> MeshView<'c> {
        self.view()
    }

    fn resources(&self, name: &'static str, visit: &mut dyn FnMut(&dyn Resource)) {
        RayQueryOn::resources(&RayQueryOn::named(self.view(), name), visit);
    }
}

impl<S: PrimitiveScene<Primitive = IndexedTriangle> + ?Sized> Parameter for Mesh<'_, S> {
    type On<'v, M: Machine> = MeshView<'v>;
}

impl MeshView<'_> {
    /// Visits the attributes that are there.
    fn data(&self, visit: &mut dyn FnMut(&dyn Resource)) {
        let all: [&dyn Resource; 5] =
            [&self.normals, &self.uvs, &self.tangents, &self.colors, &self.materials];
        all.into_iter().for_each(visit);
    }

    /// Returns the tangent in the space of the mesh, where the attributes say one.
    #[inline(always)]
    fn tangent<M: Machine>(
        &self,
        m: &M,
        triangle: On<IndexedTriangle, M>,
        hit: HitOn<M>,
    ) -> Option<On<Vec4, M>> {
        if !self.tangents.is_empty() {
            return Some(tangent_between::on(m, triangle, self.tangents, hit));
        }
        let vertices = self.triangles.shared();
        (!self.uvs.is_empty()).then(|| tangent_of_uvs::on(m, triangle, vertices, self.uvs))
    }

    /// Returns what the attributes say of the point of a triangle that was hit; `own_normal` is the
    /// geometric normal in the space of the mesh.
    #[inline(always)]
    fn shaded<M: Machine>(
        &self,
        m: &M,
        triangle: On<IndexedTriangle, M>,
        own_normal: On<Vec3, M>,
        point: SurfacePointOn<M>,
        hit: HitOn<M>,
    ) -> ShadingPointOn<M> {
        let scene = self.triangles;
        let to_object = scene.has_instances().then(|| RayQueryOn::to_object(scene, m, hit.inst_id));
        let shading_normal = if self.normals.is_empty() {
            point.normal
        } else {
            let smooth = smooth_normal::on(m, triangle, self.normals, own_normal, hit);
            to_object.map_or(smooth, |to_object| transform_normal_back::on(m, smooth, to_object))
        };
        let tangent = match (self.tangent(m, triangle, hit), to_object) {
            (Some(along), Some(to_object)) => placed_tangent::on(m, to_object, along),
            (Some(along), None) => along,
            (None, _) => Type::splat(m, Vec4::ZERO),
        };
        let id = U(m.u32_select(hit.is_hit.0, hit.prim_id.0, m.u32(0)));
        ShadingPointOn {
            point,
            shading_normal,
            tangent: perpendicular::on(m, shading_normal, tangent),
            uv: match self.uvs.is_empty() {
                true => X2 { x: hit.u, y: hit.v },
                false => uv_between::on(m, triangle, self.uvs, hit),
            },
            material: match self.materials.is_empty() {
                true => U(m.u32(0)),
                false => m.element(&self.materials, id),
            },
            albedo: match self.colors.is_empty() {
                true => Type::splat(m, Vec3::splat(0.8)),
                false => color_between::on(m, triangle, self.colors, hit),
            },
        }
    }
}

impl Scene for MeshView<'_> {
    #[inline(always)]
    fn asked_on<M: Machine, A: Asked>(
        m: &M,
        view: &Self,
        ray: RayOn<M>,
        hit: HitOn<M>,
    ) -> A::On<M> {
        let scene = view.triangles;
        let triangle = SceneView::primitive_on(m, &scene, hit);
        let local = RayQueryOn::local_ray(scene, m, ray, hit.inst_id);
        let vertices = scene.shared();
        let own = || IndexedTriangle::surface_point_on(m, triangle, local, hit, vertices);
        let whole = || {
            let own = own();
            let point = in_scene(m, scene, ray, hit, own);
            view.shaded(m, triangle, own.normal, point, hit)
        };
        let crossing = || IndexedTriangle::crossing_on(m, triangle, local, hit, vertices);
        A::of(|| in_scene(m, scene, ray, hit, own()), whole, crossing)
    }
}

impl<S: PrimitiveScene<Primitive = IndexedTriangle> + ?Sized> RecordQuery for Mesh<'_, S> {
    type Hit = Hit;
    type View<'v>
        = MeshView<'v>
    where
        Self: 'v;

    #[inline(always)]
    fn view(&self) -> MeshView<'_> {
        let MeshAttributes { normals, uvs, tangents, colors, materials } = self.attributes;
        MeshView {
            triangles: self.triangles.primitives_view().named("mesh"),
            normals: Slice::new(normals, "normals"),
            uvs: Slice::new(uvs, "uvs"),
            tangents: Slice::new(tangents, "tangents"),
            colors: Slice::new(colors, "colors"),
            materials: Slice::new(materials, "materials"),
        }
    }
}

impl<S: PrimitiveScene<Primitive = IndexedTriangle> + ?Sized> Scene for Mesh<'_, S> {
    #[inline(always)]
    fn asked_on<M: Machine, A: Asked>(
        m: &M,
        scene: &Self,
        ray: RayOn<M>,
        hit: HitOn<M>,
    ) -> A::On<M> {
        MeshView::asked_on::<M, A>(m, &scene.view(), ray, hit)
    }
}
