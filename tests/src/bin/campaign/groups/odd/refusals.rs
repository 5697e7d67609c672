//! Constructors that refuse.

use raydsl::bvh::{BuildError, InstanceError};
use raydsl::camera::CameraError;
use raydsl::prelude::*;
use raydsl::texture::TextureError;
use raydsl::volume::{
    Grid, GridConfig, GridError, MeshError, TransferError, TransferFunction, check_closed,
};

use crate::outcome::{Found, Outcome};
use crate::row::{Bound, Row, Unit};

pub(super) fn row() -> Row {
    Row::new("refused by a typed error", 9, Unit::Faults, Bound::NONE, |run| {
        let mut all = Found::new("host");
        for (what, is_refused) in refusals()? {
            all.add(run.unit, f64::from(u8::from(!is_refused)), || what.to_owned());
        }
        Ok(Outcome::host(all))
    })
}

/// Bad input, and whether it gave its own error.
fn refusals() -> Result<Vec<(&'static str, bool)>, BuildError> {
    let mut all = textures();
    all.extend(volumes());
    all.extend(trees()?);
    let flat = Matrix::new(Mat4::ZERO, Mat4::IDENTITY, DepthRange::ZERO_TO_ONE);
    all.push((
        "a camera of a matrix without an inverse",
        matches!(flat, Err(CameraError::Singular)),
    ));
    Ok(all)
}

fn textures() -> Vec<(&'static str, bool)> {
    let config = TextureConfig::new();
    let none = Texture2::new(&[0.0f32; 0][..], [0, 4], config);
    let flat = Texture3::new(&[0.0f32; 0][..], [4, 4, 0], config);
    let few = Texture2::new(&[0.0f32; 3][..], [2, 2], config);
    let long = Texture1::new(&[0.0f32; 1][..], [u32::MAX], config);
    vec![
        ("a texture of 0x4", matches!(none, Err(TextureError::NoTexels { axis: 0 }))),
        ("a texture of 4x4x0", matches!(flat, Err(TextureError::NoTexels { axis: 2 }))),
        (
            "3 texels for 2x2",
            matches!(few, Err(TextureError::WrongLength { expected: 4, found: 3 })),
        ),
        ("a texture of 2^32 - 1", matches!(long, Err(TextureError::TooLong { axis: 0, .. }))),
    ]
}

fn volumes() -> Vec<(&'static str, bool)> {
    let none = Grid::new(&[0.0f32; 0][..], uvec3(2, 0, 2), GridConfig::new());
    let few = Grid::new(&[0.0f32; 1][..], uvec3(2, 1, 1), GridConfig::new());
    let config = GridConfig::new().spacing(vec3(1.0, 0.0, 1.0));
    let flat = Grid::new(&[0.0f32; 1][..], UVec3::ONE, config);
    let no_color = TransferFunction::new(&[], &[(0.0, 0.5)], 1.0);
    let no_opacity = TransferFunction::new(&[(0.0, Vec3::ONE)], &[], 1.0);
    let unsorted = TransferFunction::new(&[(1.0, Vec3::ONE), (0.0, Vec3::ONE)], &[(0.0, 0.5)], 1.0);
    let opaque = TransferFunction::new(&[(0.0, Vec3::ONE)], &[(0.0, 1.5)], 1.0);
    let open = check_closed([[Vec3::ZERO, Vec3::X, Vec3::Y]]);
    vec![
        ("a grid of 2x0x2", matches!(none, Err(GridError::NoVoxels { axis: 1 }))),
        ("1 voxel for 2x1x1", matches!(few, Err(GridError::WrongLength { expected: 2, found: 1 }))),
        ("a grid without height", matches!(flat, Err(GridError::Placement))),
        ("no knot of colour", matches!(no_color, Err(TransferError::NoKnots { .. }))),
        ("no knot of opacity", matches!(no_opacity, Err(TransferError::NoKnots { .. }))),
        ("knots that go back", matches!(unsorted, Err(TransferError::Unsorted { index: 1, .. }))),
        ("an opacity of 1.5", matches!(opaque, Err(TransferError::OutOfRange { index: 0, .. }))),
        ("a mesh with an edge", matches!(open, Err(MeshError::Open { edges: 3, .. }))),
    ]
}

fn trees() -> Result<Vec<(&'static str, bool)>, BuildError> {
    let whole = [Triangle { v0: Vec3::ZERO, v1: Vec3::X, v2: Vec3::Y }];
    let of = |v2: Vec3| Bvh::build(&[Triangle { v2, ..whole[0] }]).err();
    let trees = [Bvh::build(&whole)?];
    let place = |matrix3: Mat3, translation: Vec3| {
        let instance = Instance::new(0, Affine3 { matrix3, translation });
        Instances::build(&trees, &[instance]).err()
    };
    let leaf = BuildConfig { max_leaf_size: 0, ..BuildConfig::default() };
    let leaf = Bvh::build_with(&whole, &leaf).err();
    let stretch = Mat3::from_diagonal(vec3(1.0, 1e-9, 1.0));
    let flat = Mat3::from_diagonal(vec3(1.0, 0.0, 1.0));
    let far = Vec3::splat(f32::MAX);
    Ok(vec![
        ("a vertex that is NaN", matches!(of(Vec3::NAN), Some(BuildError::NanBounds { index: 0 }))),
        (
            "a vertex at infinity",
            matches!(of(Vec3::INFINITY), Some(BuildError::InfiniteBounds { index: 0 })),
        ),
        (
            "leaves of 0",
            matches!(leaf, Some(BuildError::InvalidConfig { field: "max_leaf_size", .. })),
        ),
        (
            "an instance without height",
            matches!(place(flat, Vec3::ZERO), Some(InstanceError::NoInverse { instance: 0 })),
        ),
        (
            "an instance of condition 1e9",
            matches!(place(stretch, Vec3::ZERO), Some(InstanceError::IllConditioned { .. })),
        ),
        (
            "an instance at a NaN",
            matches!(place(Mat3::IDENTITY, Vec3::NAN), Some(InstanceError::NoInverse { .. })),
        ),
        (
            "an instance too far away",
            matches!(place(Mat3::IDENTITY, far), Some(InstanceError::TooLarge { .. })),
        ),
    ])
}
