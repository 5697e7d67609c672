//! Points in space, and their file.

use std::path::Path;

use glam::DVec3;
use las::point::{Classification, Format, ScanDirection};
use las::{Builder, GpsTimeType, Transform, Vector, Version, Writer};
use raydsl_examples::cloud::{Cover, Facets};

use super::echoes::Returns;
use super::scanner::Scanner;

/// Step of coordinates in the file, in metres.
const STEP: f64 = 0.001;

/// A return as a point in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Point {
    /// Where it is, in metres.
    pub(crate) position: DVec3,
    /// Intensity, 65535 at most.
    pub(crate) intensity: u16,
    /// Which of the pulse's returns it is, from 1.
    pub(crate) return_number: u8,
    /// How many returns the pulse has.
    pub(crate) returns: u8,
    /// Angle from the vertical in degrees, positive to the right of the flight.
    pub(crate) angle: f32,
    /// Whether the mirror swept to the right.
    pub(crate) sweeps_right: bool,
    /// When the pulse was emitted.
    pub(crate) gps_time: f64,
    /// Flight line, from 0.
    pub(crate) line: u16,
    /// What was hit.
    pub(crate) cover: Cover,
}

impl Point {
    /// The points of a pulse. They lie on the beam's axis, since a scanner does not know which part
    /// of its beam came back.
    pub(crate) fn of(
        scanner: &Scanner,
        land: &Facets,
        pulse: u32,
        returns: &Returns,
    ) -> impl Iterator<Item = Self> {
        let beam = scanner.beam(pulse);
        let (origin, axis) = (beam.origin.as_dvec3(), beam.axis.as_dvec3());
        let of_echo = move |(number, echo): (u8, &super::echoes::Echo)| Self {
            position: origin + axis * f64::from(echo.range),
            intensity: (65_535.0 * echo.intensity).round() as u16,
            return_number: number,
            returns: returns.count as u8,
            angle: 360.0 * beam.angle,
            sweeps_right: scanner.sweeps_right(pulse),
            gps_time: scanner.gps_time(pulse),
            line: scanner.line(pulse) as u16,
            cover: land.cover(echo.prim_id as usize),
        };
        (1u8..).zip(returns.iter()).map(of_echo)
    }

    fn las(&self) -> las::Point {
        las::Point {
            x: self.position.x,
            y: self.position.y,
            z: self.position.z,
            intensity: self.intensity,
            return_number: self.return_number,
            number_of_returns: self.returns,
            scan_direction: match self.sweeps_right {
                true => ScanDirection::LeftToRight,
                false => ScanDirection::RightToLeft,
            },
            classification: match self.cover {
                Cover::Ground => Classification::Ground,
                Cover::Built => Classification::Building,
                Cover::Wood | Cover::Leaves => Classification::HighVegetation,
            },
            scan_angle: self.angle,
            point_source_id: self.line + 1,
            gps_time: Some(self.gps_time),
            ..las::Point::default()
        }
    }
}

/// Writes LAS 1.4 with points of format 6: coordinates in millimetres, GPS time, scan angle.
///
/// # Errors
///
/// If the file cannot be written.
pub(crate) fn write_las(points: &[Point], path: &Path) -> las::Result<()> {
    let transform = Transform { scale: STEP, offset: 0.0 };
    let mut header = Builder::default();
    header.version = Version::new(1, 4);
    header.point_format = Format::new(6)?;
    header.gps_time_type = GpsTimeType::Standard;
    header.has_wkt_crs = true;
    "simulated".clone_into(&mut header.system_identifier);
    "raydsl lidar".clone_into(&mut header.generating_software);
    header.transforms = Vector { x: transform, y: transform, z: transform };
    let mut writer = Writer::from_path(path, header.into_header()?)?;
    points.iter().try_for_each(|point| writer.write_point(point.las()))?;
    writer.close()
}

/// Reads a file and compares it with the points that were written.
///
/// # Errors
///
/// What differs.
pub(crate) fn check_las(points: &[Point], path: &Path) -> Result<(), String> {
    let cloud = raydsl_io::cloud::load(path, &mut |_, _| {}).map_err(|e| e.to_string())?;
    if cloud.positions.len() != points.len() {
        return Err(format!("{} points of {}", cloud.positions.len(), points.len()));
    }
    let far = |(read, point): &(&[f64; 3], &Point)| {
        !(DVec3::from(**read) - point.position).abs().cmple(DVec3::splat(0.501 * STEP)).all()
    };
    match cloud.positions.iter().zip(points).position(|pair| far(&pair)) {
        Some(i) => Err(format!("point {i} is at {:?}", cloud.positions[i])),
        None => Ok(()),
    }
}
