//! The scenes of the page with their kernels, the same for every variant.

use glam::Quat;
use raydsl::bsdf::{Lambert, Luminous};
use raydsl::integrators::{PathLimits, path};
use raydsl::kernel;
use raydsl::light::Lights;
use raydsl::prelude::*;
use raydsl::shading::Surface;
use raydsl::volume::{
    Centering, Cut, Grid, GridConfig, Midpoint, TransferFunction, Volume, VolumeLight,
};
use raydsl_scenes::cornell::{lamps, walls};
use raydsl_scenes::head::head;
use raydsl_scenes::points::{daylight, home, spheres, to_sun};
use raydsl_scenes::{Pose, cloud};

/// A kernel of pictures: one type for all scenes, so that the code around it exists once.
pub type PictureKernel<'a> = Kernel<'a, (Ray, Sampler), Vec4>;

/// A scene of the page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// A landscape of so many points, under a sun.
    Landscape {
        /// The points, at least 1.
        points: u32,
    },
    /// A head as a volume of `side`³ voxels, cut open.
    Head {
        /// The voxels of a side, at least 8.
        side: u32,
    },
    /// The Cornell box, by path tracing.
    Cornell,
}

/// Why a scene cannot be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SubjectError {
    /// The points are no cloud.
    #[error(transparent)]
    Cloud(#[from] cloud::ScaleError),
    /// There is no tree of the scene.
    #[error(transparent)]
    Tree(#[from] raydsl::bvh::BuildError),
    /// The voxels are no grid.
    #[error(transparent)]
    Grid(#[from] raydsl::volume::GridError),
    /// The colours and opacities are no transfer function.
    #[error(transparent)]
    Transfer(#[from] raydsl::volume::TransferError),
    /// The lamps are no lights.
    #[error(transparent)]
    Lights(#[from] raydsl::light::LightsError),
}

/// The seed of the landscape.
const SEED: u64 = 7;
/// Surfaces that a path meets at most, and from which on it may end by chance.
const LIMITS: PathLimits = PathLimits { bounces: 6, roulette: 3 };
/// Colours of tissue by the share of the values' range.
const COLORS: [(f32, Vec3); 5] = [
    (0.22, vec3(0.71, 0.32, 0.2)),
    (0.36, vec3(0.71, 0.32, 0.2)),
    (0.46, vec3(0.6, 0.4, 0.32)),
    (0.66, vec3(0.85, 0.79, 0.7)),
    (0.85, vec3(0.95, 0.88, 0.75)),
];
/// Opacities of a two-hundredth of the volume, likewise.
const OPACITIES: [(f32, f32); 5] =
    [(0.16, 0.0), (0.24, 0.55), (0.35, 0.6), (0.45, 0.9), (1.0, 0.97)];

impl Subject {
    /// Makes the scene and calls `show` with its kernel and a camera that sees all of it.
    ///
    /// `show` may take as long as a page is open: the kernel borrows the scene.
    ///
    /// # Errors
    ///
    /// If the scene cannot be made.
    pub async fn with_kernel<T>(
        self,
        show: impl AsyncFnOnce(&PictureKernel<'_>, Pose) -> T,
    ) -> Result<T, SubjectError> {
        match self {
            Self::Landscape { points } => landscape(points, show).await,
            Self::Head { side } => volume(side, show).await,
            Self::Cornell => cornell(show).await,
        }
    }
}

async fn landscape<T>(
    points: u32,
    show: impl AsyncFnOnce(&PictureKernel<'_>, Pose) -> T,
) -> Result<T, SubjectError> {
    let cloud = cloud::procedural(points as usize, SEED, &mut |_| {});
    let scaled = cloud::scale(&cloud, None)?;
    let (spheres, pose) = (spheres(&cloud, &scaled), home(&cloud, &scaled));
    drop((cloud, scaled));
    let tree = Bvh::build(&spheres)?;
    let up = pose.up;
    let sun = to_sun(up);
    let kernel = kernel!(|ray: Ray, _sampler: Sampler| {
        let color = daylight(&tree, up, sun, ray);
        vec4(color.x, color.y, color.z, 1.0)
    });
    Ok(show(&kernel, pose).await)
}

/// A ball that is cut out of the head.
#[primitive(sphere(center, radius))]
struct Ball {
    center: Vec3,
    radius: f32,
}

#[kernel]
impl Surface for Ball {
    fn surface(&self, ray: Ray, hit: Hit) -> SurfacePoint {
        self.surface_point(ray, hit)
    }

    fn albedo(&self, _ray: Ray, _hit: Hit) -> Vec3 {
        Vec3::ONE
    }
}

async fn volume<T>(
    side: u32,
    show: impl AsyncFnOnce(&PictureKernel<'_>, Pose) -> T,
) -> Result<T, SubjectError> {
    // Voxels of the cube from -1 to 1.
    let voxel = 2.0 / side as f32;
    let to_world = Affine3::from_scale_rotation_translation(
        Vec3::splat(voxel),
        Quat::IDENTITY,
        Vec3::splat(0.5 * voxel - 1.0),
    );
    let config = GridConfig::new().to_world(to_world).centering(Centering::Cell);
    let voxels: Vec<f32> = head(side).into_iter().map(f32::from).collect();
    let grid = Grid::new(voxels, UVec3::splat(side), config)?;
    let range = grid.range();
    let value = |share: f32| range.x + (range.y - range.x) * share;
    let function = TransferFunction::new(
        &COLORS.map(|(share, color)| (value(share), color)),
        &OPACITIES.map(|(share, opacity)| (value(share), opacity)),
        2.0 / 200.0,
    )?;
    let volume = Volume::new(&grid, function);
    let balls = [Ball { center: vec3(0.35, 0.5, 0.6), radius: 0.62 }];
    let tools = Bvh::build(&balls)?;
    // A short kernel: browsers compile it on the machine that shows the page.
    let method = Midpoint::new(0.5 * voxel);
    let background = vec3(0.015, 0.018, 0.026);
    let kernel = kernel!(|ray: Ray, _sampler: Sampler| {
        let mut light = VolumeLight::new();
        let mut cut = Cut::new(&tools, ray);
        while let Some(part) = cut.next_outside(&tools) {
            light = volume.integrate(&method, part, light);
        }
        let color = light.over(background);
        vec4(color.x, color.y, color.z, 1.0)
    });
    let bounds = Aabb::new(Vec3::NEG_ONE, Vec3::ONE);
    Ok(show(&kernel, Pose::of_box(bounds, Vec3::Z, vec3(0.75, 1.15, 0.55))).await)
}

async fn cornell<T>(
    show: impl AsyncFnOnce(&PictureKernel<'_>, Pose) -> T,
) -> Result<T, SubjectError> {
    let walls = walls();
    let lamps = lamps(&walls);
    let scene = Bvh::build(&walls)?;
    let lights = Lights::new(&lamps, scene.bounds())?;
    let limits = LIMITS;
    let kernel = kernel!(|ray: Ray, sampler: Sampler| {
        let surface = |hit: Hit, _point: ShadingPoint| scene.primitive(hit).material();
        path::<_, _, Luminous<Lambert>>(&scene, surface, &lights, limits, ray, sampler).color
    });
    // That of the example, with what it turns around in the middle of the box.
    let camera = raydsl_scenes::cornell::camera();
    let target = vec3(camera.eye.x, camera.eye.y, scene.bounds().center().z);
    let pose = Pose { eye: camera.eye, target, up: camera.up, fov_y: camera.fov_y };
    Ok(show(&kernel, pose).await)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every scene has a picture that is neither empty nor even, the same by packets.
    #[test]
    fn scenes_have_pictures() {
        let subjects =
            [Subject::Landscape { points: 2000 }, Subject::Head { side: 16 }, Subject::Cornell];
        for subject in subjects {
            let made = subject.with_kernel(async |kernel, pose| {
                let mut films = [Variant::Scalar, Variant::Packet4].map(|variant| {
                    let mut film = Film::new(24, 16);
                    TiledScheduler::new().variant(variant).accumulate(
                        &pose.camera(),
                        kernel,
                        &Sampling::new(4),
                        &mut film,
                        4,
                    );
                    film.image()
                });
                assert!(films[0] == films[1], "{subject:?}");
                std::mem::replace(&mut films[0], Image::filled(0, 0, Vec4::ZERO))
            });
            let light = pollster::block_on(made).expect("the scene can be made");
            let lit = light.pixels().iter().filter(|p| p.max_element().is_finite() && p.x > 0.02);
            assert!(lit.count() > 100, "{subject:?}");
            assert!(light.pixels().iter().any(|p| *p != light.pixels()[0]), "{subject:?}");
        }
    }
}
