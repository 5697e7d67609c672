//! What is looked at, and how: everything that the picture depends on.

use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::sync::Arc;

use raydsl::light::Environment;
use raydsl::prelude::*;
use raydsl_scenes::Pose;

/// What kind of data is open.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A cloud of points.
    Points,
    /// Triangles with materials.
    Surface,
    /// A grid of numbers.
    Volume,
    /// A field on an unstructured grid.
    Cells,
}

impl Kind {
    /// Returns the name of the transfer function that data have at first.
    pub const fn first_preset(self) -> &'static str {
        match self {
            Self::Cells => "heat",
            _ => "tissue",
        }
    }

    /// Returns whether the data are seen through a transfer function, and can be cut.
    pub const fn is_field(self) -> bool {
        matches!(self, Self::Volume | Self::Cells)
    }
}

/// How data are turned into light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Mode {
    /// Points as spheres under a sun.
    Spheres,
    /// The unoccluded share of the hemisphere.
    Occlusion,
    /// Light that comes from lamps and the sky at once.
    Direct,
    /// The same, seen by mirrors and glass.
    Whitted,
    /// Light that is scattered many times.
    Path,
    /// A volume by steps of half a voxel.
    Midpoint,
    /// A volume by steps between which the transfer function is integrated.
    PreIntegrated,
    /// A volume or cells by the exact integral in each cell.
    ExactCell,
    /// The same with shading by the gradient.
    ShadedCell,
}

impl Mode {
    /// Every mode.
    pub const ALL: [Self; 9] = [
        Self::Spheres,
        Self::Occlusion,
        Self::Direct,
        Self::Whitted,
        Self::Path,
        Self::Midpoint,
        Self::PreIntegrated,
        Self::ExactCell,
        Self::ShadedCell,
    ];

    /// Returns the name in scripts and in the window.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Spheres => "spheres",
            Self::Occlusion => "occlusion",
            Self::Direct => "direct",
            Self::Whitted => "whitted",
            Self::Path => "path",
            Self::Midpoint => "midpoint",
            Self::PreIntegrated => "pre-integrated",
            Self::ExactCell => "exact-cell",
            Self::ShadedCell => "shaded-cell",
        }
    }

    /// Returns the modes of a kind of data; the first one is chosen when a file is opened.
    pub const fn of(kind: Kind) -> &'static [Self] {
        match kind {
            Kind::Points => &[Self::Spheres, Self::Occlusion],
            Kind::Surface => &[Self::Direct, Self::Occlusion, Self::Whitted, Self::Path],
            Kind::Volume => {
                &[Self::ShadedCell, Self::ExactCell, Self::PreIntegrated, Self::Midpoint]
            }
            Kind::Cells => &[Self::ShadedCell, Self::ExactCell],
        }
    }
}

impl FromStr for Mode {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|mode| mode.name() == text);
        found.ok_or_else(|| format!("choose a mode from {}", Self::ALL.map(Self::name).join(", ")))
    }
}

/// What the picture shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Show {
    /// The light.
    Picture,
    /// How many nodes and primitives each ray tests, as a heat map.
    Cost,
    /// Where another variant has other numbers.
    Difference(Variant),
}

impl fmt::Display for Show {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Picture => f.write_str("picture"),
            Self::Cost => f.write_str("cost"),
            Self::Difference(variant) => write!(f, "difference {}", variant.name()),
        }
    }
}

/// The most knots of a transfer function.
pub(crate) const MOST_KNOTS: usize = 256;

/// A knot of a transfer function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Knot {
    /// Where it is in the range of the values, from 0 to 1: 0 is the least, 1 the greatest.
    pub at: f32,
    /// Opacity from 0 to 1 of a two-hundredth of the volume's longest side.
    pub opacity: f32,
    /// Linear red, green and blue.
    pub color: Vec3,
}

/// Something that is cut out of a volume, in shares of the volume's box: 0 to 1 along each axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CutObject {
    /// A ball.
    Ball {
        /// Its centre.
        center: Vec3,
        /// Its radius as a share of the longest side.
        radius: f32,
    },
    /// Everything on one side of a plane.
    Half {
        /// A point of the plane.
        through: Vec3,
        /// What points to the side that is kept.
        normal: Vec3,
    },
}

impl CutObject {
    /// Returns where its handle is: the middle of a ball, a point of a plane.
    pub fn place(self) -> Vec3 {
        match self {
            Self::Ball { center, .. } => center,
            Self::Half { through, .. } => through,
        }
    }

    /// Moves the object by shares of the box.
    #[must_use]
    pub fn moved(self, by: Vec3) -> Self {
        match self {
            Self::Ball { center, radius } => Self::Ball { center: center + by, radius },
            Self::Half { through, normal } => Self::Half { through: through + by, normal },
        }
    }
}

impl fmt::Display for CutObject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let three = |v: Vec3| format!("{} {} {}", v.x, v.y, v.z);
        match self {
            Self::Ball { center, radius } => write!(f, "ball {} {radius}", three(*center)),
            Self::Half { through, normal } => {
                write!(f, "half {} {}", three(*through), three(*normal))
            }
        }
    }
}

/// The light of all directions, from a file.
#[derive(Clone, Debug)]
pub struct Sky {
    path: PathBuf,
    light: Arc<Environment>,
}

impl Sky {
    pub(crate) fn new(path: PathBuf, light: Environment) -> Self {
        Self { path, light: Arc::new(light) }
    }

    /// Returns the file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    pub(crate) fn light(&self) -> &Environment {
        &self.light
    }
}

impl PartialEq for Sky {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.light, &other.light)
    }
}

/// Everything that a picture depends on, beside the data.
#[derive(Clone, Debug, PartialEq)]
pub struct Look {
    /// Columns and rows, each at least 1.
    pub size: (u32, u32),
    /// The camera.
    pub pose: Pose,
    /// How data become light.
    pub mode: Mode,
    /// What runs the kernel.
    pub variant: Variant,
    /// What is shown.
    pub show: Show,
    /// Exposure in stops.
    pub exposure: f32,
    /// The transfer function of a volume, sorted by place.
    pub knots: Vec<Knot>,
    /// What is cut out of a volume.
    pub cuts: Vec<CutObject>,
    /// What surfaces are lit by in place of the sky that they have else.
    pub sky: Option<Sky>,
}

impl Default for Look {
    fn default() -> Self {
        Self {
            size: (960, 540),
            pose: Pose::default(),
            mode: Mode::Spheres,
            variant: Variant::widest(),
            show: Show::Picture,
            exposure: 0.0,
            knots: preset("tissue").unwrap_or_default(),
            cuts: Vec::new(),
            sky: None,
        }
    }
}

/// The names of the ready-made transfer functions.
pub const PRESETS: [&str; 4] = ["tissue", "glass", "bone", "heat"];

/// Returns a ready-made transfer function.
pub fn preset(name: &str) -> Option<Vec<Knot>> {
    let skin = vec3(0.71, 0.32, 0.2);
    let bone = vec3(0.95, 0.88, 0.75);
    let pairs: &[(f32, f32, Vec3)] = match name {
        "tissue" => &[
            (0.16, 0.0, skin),
            (0.24, 0.55, skin),
            (0.35, 0.6, skin),
            (0.45, 0.9, vec3(0.6, 0.4, 0.32)),
            (1.0, 0.97, bone),
        ],
        "glass" => &[
            (0.2, 0.0, skin),
            (0.26, 0.03, skin),
            (0.34, 0.02, skin),
            (0.55, 0.04, vec3(0.6, 0.4, 0.32)),
            (0.62, 0.7, vec3(0.84, 0.79, 0.68)),
            (1.0, 0.9, bone),
        ],
        // Black, purple, orange and pale yellow: what is least is not seen.
        "heat" => &[
            (0.12, 0.0, vec3(0.02, 0.005, 0.08)),
            (0.3, 0.12, vec3(0.16, 0.015, 0.19)),
            (0.55, 0.3, vec3(0.55, 0.04, 0.07)),
            (0.8, 0.6, vec3(0.95, 0.28, 0.01)),
            (1.0, 0.9, vec3(0.98, 0.95, 0.4)),
        ],
        "bone" => &[(0.72, 0.0, bone), (0.8, 0.9, bone), (1.0, 0.9, Vec3::ONE)],
        _ => return None,
    };
    Some(pairs.iter().map(|&(at, opacity, color)| Knot { at, opacity, color }).collect())
}
