//! Why a cloud cannot be made spheres, in one line each.

/// Tells why no spheres can be made of a cloud. The message says what is wrong and what to do.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ScaleError {
    /// A cloud without points was to be rendered.
    #[error("the cloud holds no point; load or make at least one")]
    Empty,
    /// A cloud whose vectors differ in length.
    #[error(
        "the cloud holds {positions} positions but {colors} colours; give every point one colour"
    )]
    LengthMismatch {
        /// Number of positions.
        positions: usize,
        /// Number of colours.
        colors: usize,
    },
    /// A radius that no sphere can have.
    #[error(
        "radius {radius}: is not a positive finite number; give one, or none to have it chosen"
    )]
    BadRadius {
        /// The radius asked for.
        radius: f64,
    },
    /// Centres in f32 would be off by a visible part of the radius.
    #[error(
        "radius {radius}: is too small for a cloud that spans {extent}, 32-bit coordinates cannot \
         resolve it; use at least {minimum}, or remove stray points far from the rest"
    )]
    RadiusTooSmall {
        /// The radius asked for, or chosen.
        radius: f64,
        /// Longest side of the cloud's box.
        extent: f64,
        /// Smallest radius that works.
        minimum: f64,
    },
    /// All points would vanish in a single sphere.
    #[error(
        "radius {radius}: is too large for a cloud that spans {extent}, all points would merge; \
         use at most {maximum}, in the units of the file"
    )]
    RadiusTooLarge {
        /// The radius asked for.
        radius: f64,
        /// Longest side of the cloud's box.
        extent: f64,
        /// Largest radius that works.
        maximum: f64,
    },
    /// The box's sides overflow, or vanish, in 64-bit arithmetic.
    #[error(
        "the cloud spans {extent}, beyond what can be scaled; remove stray points or change its unit"
    )]
    BadExtent {
        /// Longest side of the cloud's box.
        extent: f64,
    },
    /// Coordinates are NaN or infinite.
    #[error(
        "{count} of {total} points have a coordinate that is not a finite number (the first is \
         point {first}, counted from 0); remove these points"
    )]
    NotFinite {
        /// Points that are not finite.
        count: usize,
        /// All points.
        total: usize,
        /// Index of the first that is not.
        first: usize,
    },
}
