//! What a field is cut by.

use raydsl::kernel;
use raydsl::prelude::*;
use raydsl::shading::Surface;

use crate::look::CutObject;

/// A ball that cuts.
#[primitive(sphere(center, radius))]
pub(in crate::data) struct Ball {
    center: Vec3,
    radius: f32,
}

/// Half of space: all that is behind a plane.
#[primitive(plane(normal, offset))]
pub(in crate::data) struct Half {
    normal: Vec3,
    offset: f32,
}

macro_rules! surface {
    ($($tool:ident)+) => {
        $(
            #[kernel]
            impl Surface for $tool {
                fn surface(&self, ray: Ray, hit: Hit) -> SurfacePoint {
                    self.surface_point(ray, hit)
                }

                fn albedo(&self, _ray: Ray, _hit: Hit) -> Vec3 {
                    Vec3::ONE
                }
            }
        )+
    };
}

surface!(Ball Half);

/// Everything that cuts, as one scene.
#[derive(Scene)]
pub(in crate::data) struct Tools<'a> {
    balls: &'a [Ball],
    halves: &'a [Half],
}

/// Cut objects in the world.
pub(in crate::data) struct Cuts {
    balls: Vec<Ball>,
    halves: Vec<Half>,
}

impl Cuts {
    /// Places cut objects in a volume's box.
    pub(in crate::data) fn new(cuts: &[CutObject], bounds: Aabb) -> Self {
        let (min, size) = (bounds.min, bounds.size());
        let (mut balls, mut halves) = (Vec::new(), Vec::new());
        for cut in cuts {
            match *cut {
                CutObject::Ball { center, radius } => balls.push(Ball {
                    center: min + center * size,
                    radius: radius * size.max_element(),
                }),
                // What is behind the plane is cut away, so that its normal points to what is kept.
                CutObject::Half { through, normal } => {
                    halves.push(Half { normal, offset: normal.dot(min + through * size) });
                }
            }
        }
        Cuts { balls, halves }
    }

    /// Returns them as a scene.
    pub(in crate::data) fn scene(&self) -> Tools<'_> {
        Tools { balls: &self.balls, halves: &self.halves }
    }

    /// Returns whether a point is cut away.
    pub(in crate::data) fn has(&self, p: Vec3) -> bool {
        self.balls.iter().any(|b| p.distance(b.center) < b.radius)
            || self.halves.iter().any(|h| h.normal.dot(p) < h.offset)
    }
}
