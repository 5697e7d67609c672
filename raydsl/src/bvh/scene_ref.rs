//! A scene of any type, as kernels of generic host functions capture it.

use super::{RayQueryOn, RecordQuery};
use crate::machine::{Capture, Machine, Resource};

/// A scene whose type is a parameter of the function around a kernel. `kernel!` captures this, where
/// it cannot capture an `S` of which it only knows that it is a scene.
///
/// ```
/// use raydsl::bvh::SceneRef;
/// use raydsl::prelude::*;
///
/// /// Finds how much of the sky is open above some points, in any scene.
/// fn open<S: RayQuery + ?Sized>(scene: &S, points: &[Vec3]) -> Vec<bool> {
///     let scene = SceneRef::new(scene);
///     let kernel = kernel!(|p: Vec3| !scene.any_hit(Ray::new(p, Vec3::Z)));
///     let mut open = vec![false; points.len()];
///     let inputs: Vec<(Vec3,)> = points.iter().map(|p| (*p,)).collect();
///     kernel.run(Variant::widest(), &inputs, &mut open);
///     open
/// }
///
/// let (v1, v2) = (vec3(4.0, 0.0, 1.0), vec3(0.0, 4.0, 1.0));
/// let triangles = [Triangle { v0: Vec3::Z, v1, v2 }];
/// let points = [vec3(1.0, 1.0, 0.0), vec3(3.0, 3.0, 0.0)];
/// assert_eq!(open(&triangles[..], &points), [false, true]);
/// assert_eq!(open(&Bvh::build(&triangles)?, &points), [false, true]);
/// # Ok::<(), raydsl::bvh::BuildError>(())
/// ```
#[derive(Debug)]
pub struct SceneRef<'a, S: ?Sized> {
    scene: &'a S,
}

impl<S: ?Sized> Clone for SceneRef<'_, S> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S: ?Sized> Copy for SceneRef<'_, S> {}

impl<'a, S: RecordQuery + ?Sized> SceneRef<'a, S> {
    /// Refers to a scene.
    pub fn new(scene: &'a S) -> Self {
        Self { scene }
    }

    /// Returns the scene.
    pub fn scene(self) -> &'a S {
        self.scene
    }
}

impl<S: RecordQuery + ?Sized> RecordQuery for SceneRef<'_, S> {
    type Hit = S::Hit;
    type View<'v>
        = S::View<'v>
    where
        Self: 'v;

    #[inline(always)]
    fn view(&self) -> S::View<'_> {
        self.scene.view()
    }
}

#[diagnostic::do_not_recommend]
impl<M: Machine, S: RecordQuery + ?Sized> Capture<M> for SceneRef<'_, S> {
    type On<'c>
        = &'c S
    where
        Self: 'c;

    #[inline(always)]
    fn capture<'c>(&'c self, _: &M, _: &'static str) -> &'c S {
        self.scene
    }

    #[inline(always)]
    fn constant<'c>(&'c self, _: &M) -> &'c S {
        self.scene
    }

    fn resources(&self, _: &'static str, visit: &mut dyn FnMut(&dyn Resource)) {
        self.view().resources(visit);
    }
}
