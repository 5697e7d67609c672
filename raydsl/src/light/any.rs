//! A light of any kind of the library.

use glam::{Vec2, Vec3};

use super::{
    AreaLight, DirectionalLight, DiskShape, DistantLight, Light, LightExtent, LightSample,
    PointLight, RectangleShape, SphereShape, SpotLight,
};
use crate::geometry::{SurfacePoint, Triangle};
use crate::{Type, kernel};

/// A light of any kind of the library, for lists of several. WGSL and machine code have the kinds
/// that a captured list holds.
///
/// A list with kinds of your own is an enum of yours, with one `match` for each method of [`Light`].
#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub enum AnyLight {
    /// An isotropic point.
    Point(PointLight),
    /// A point that shines into a cone.
    Spot(SpotLight),
    /// A direction, or a disk in the sky.
    Directional(DirectionalLight),
    /// A sphere.
    Sphere(AreaLight<SphereShape>),
    /// A rectangle or other parallelogram.
    Rectangle(AreaLight<RectangleShape>),
    /// A triangle.
    Triangle(AreaLight<Triangle>),
    /// A disk.
    Disk(AreaLight<DiskShape>),
}

/// Implements a method by that of each kind.
macro_rules! forward {
    ($(fn $method:ident($($arg:ident: $t:ty),*) -> $out:ty;)+) => {
        #[kernel]
        impl Light for AnyLight {
            $(
                fn $method(&self $(, $arg: $t)*) -> $out {
                    match *self {
                        AnyLight::Point(l) => PointLight::$method(&l $(, $arg)*),
                        AnyLight::Spot(l) => SpotLight::$method(&l $(, $arg)*),
                        AnyLight::Directional(l) => DirectionalLight::$method(&l $(, $arg)*),
                        AnyLight::Sphere(l) => AreaLight::<SphereShape>::$method(&l $(, $arg)*),
                        AnyLight::Rectangle(l) => {
                            AreaLight::<RectangleShape>::$method(&l $(, $arg)*)
                        }
                        AnyLight::Triangle(l) => AreaLight::<Triangle>::$method(&l $(, $arg)*),
                        AnyLight::Disk(l) => AreaLight::<DiskShape>::$method(&l $(, $arg)*),
                    }
                }
            )+
        }
    };
}

forward! {
    fn sample(from: Vec3, u: Vec2) -> LightSample;
    fn pdf(from: Vec3, at: SurfacePoint) -> f32;
    fn emitted(at: SurfacePoint, to_viewer: Vec3) -> Vec3;
    fn distant(direction: Vec3) -> DistantLight;
    fn is_distant() -> bool;
    fn power(radius: f32) -> f32;
    fn extent() -> LightExtent;
}
