//! How accurate lines are, and where they end.

use crate::Type;

/// Maximum of [`FlowSettings::max_attempts`]: the points of a line of so many steps take 3 MB.
pub const MAX_ATTEMPTS: u32 = 65_000;

/// Least speed at which a line goes on, unless set: squares of lower ones underflow.
const STILL: f32 = 1e-18;

/// Why settings are refused.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FlowError {
    /// A number is not in its range.
    #[error("{name} of a streamline is {value}: set a finite number {range}")]
    OutOfRange {
        /// Name of the setting.
        name: &'static str,
        /// Its value.
        value: f32,
        /// Range of such values.
        range: &'static str,
    },
    /// More attempts than [`MAX_ATTEMPTS`].
    #[error("{found} attempts a line are too many: at most {limit}; follow longer lines in parts")]
    TooManyAttempts {
        /// Number that was set.
        found: u32,
        /// [`MAX_ATTEMPTS`].
        limit: u32,
    },
}

/// Tolerance of streamlines, and the limits at which they end.
///
/// The error of a step, estimated in each coordinate, is at most `absolute + relative * |p|`, where
/// `|p|` is the greatest coordinate of its ends. Errors of steps add up along a line, and a field
/// that diverges amplifies them.
#[derive(Clone, Copy, Debug, PartialEq, Type)]
pub struct FlowSettings {
    pub(super) absolute: f32,
    pub(super) relative: f32,
    pub(super) max_step: f32,
    pub(super) min_step: f32,
    pub(super) max_time: f32,
    pub(super) max_length: f32,
    pub(super) still: f32,
    pub(super) closing: f32,
    pub(super) max_attempts: u32,
}

impl FlowSettings {
    /// Creates settings of an absolute tolerance for each step, and of the greatest length of a
    /// step; both are lengths in the world. What is smaller than a step may be stepped over: for a
    /// grid, a few of its spacings are a good length.
    ///
    /// # Errors
    ///
    /// If one of them is not finite or not above 0.
    pub fn new(tolerance: f32, max_step: f32) -> Result<Self, FlowError> {
        let absolute = positive("the tolerance", tolerance)?;
        let max_step = positive("the greatest step", max_step)?;
        Ok(Self {
            absolute,
            relative: 0.0,
            max_step,
            min_step: (0.1 * absolute).min(max_step),
            max_time: f32::MAX,
            max_length: f32::MAX,
            still: STILL,
            closing: 0.0,
            max_attempts: 2000,
        })
    }

    /// Sets the relative tolerance, a share of the greatest coordinate: 0 unless set.
    ///
    /// # Errors
    ///
    /// If it is not from 0 to 1.
    pub fn relative(self, relative: f32) -> Result<Self, FlowError> {
        if !(0.0..=1.0).contains(&relative) {
            let (name, range) = ("the relative tolerance", "from 0 to 1");
            return Err(FlowError::OutOfRange { name, value: relative, range });
        }
        Ok(Self { relative, ..self })
    }

    /// Sets the length of a step that is not divided any further: a line ends where the field does
    /// to within this length. A tenth of the tolerance unless set, and at most the greatest step.
    ///
    /// # Errors
    ///
    /// If it is not finite or not above 0.
    pub fn min_step(self, min_step: f32) -> Result<Self, FlowError> {
        let min_step = positive("the least step", min_step)?.min(self.max_step);
        Ok(Self { min_step, ..self })
    }

    /// Sets the time from the seed, forwards or backwards, at which a line ends.
    ///
    /// # Errors
    ///
    /// If it is not finite or not above 0.
    pub fn max_time(self, max_time: f32) -> Result<Self, FlowError> {
        Ok(Self { max_time: positive("the greatest time", max_time)?, ..self })
    }

    /// Sets the length from the seed at which a line ends.
    ///
    /// # Errors
    ///
    /// If it is not finite or not above 0.
    pub fn max_length(self, max_length: f32) -> Result<Self, FlowError> {
        Ok(Self { max_length: positive("the greatest length", max_length)?, ..self })
    }

    /// Sets the speed at or below which a line ends. 1e-18 unless set: the squares of lower ones
    /// underflow.
    ///
    /// # Errors
    ///
    /// If it is not finite or not above 0.
    pub fn still(self, speed: f32) -> Result<Self, FlowError> {
        Ok(Self { still: positive("the least speed", speed)?.max(STILL), ..self })
    }

    /// Ends lines that come back to their seed, closer than this distance, in the seed's direction.
    /// No line is unless set.
    ///
    /// # Errors
    ///
    /// If it is not finite or not above 0.
    pub fn closing(self, distance: f32) -> Result<Self, FlowError> {
        Ok(Self { closing: positive("the distance of closed lines", distance)?, ..self })
    }

    /// Sets the maximum number of steps that are tried, taken or not: 2000 unless set.
    ///
    /// # Errors
    ///
    /// If it is above [`MAX_ATTEMPTS`].
    pub fn max_attempts(self, max_attempts: u32) -> Result<Self, FlowError> {
        let limit = MAX_ATTEMPTS;
        if max_attempts > limit {
            return Err(FlowError::TooManyAttempts { found: max_attempts, limit });
        }
        Ok(Self { max_attempts, ..self })
    }
}

fn positive(name: &'static str, value: f32) -> Result<f32, FlowError> {
    if value > 0.0 && value.is_finite() {
        return Ok(value);
    }
    Err(FlowError::OutOfRange { name, value, range: "above 0" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_are_checked() {
        for bad in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            assert!(FlowSettings::new(bad, 1.0).is_err(), "{bad}");
            assert!(FlowSettings::new(1.0, bad).is_err(), "{bad}");
            let good = FlowSettings::new(1e-3, 1.0).expect("settings");
            assert!(good.min_step(bad).is_err() && good.max_time(bad).is_err(), "{bad}");
            assert!(good.max_length(bad).is_err() && good.still(bad).is_err(), "{bad}");
            assert!(good.closing(bad).is_err(), "{bad}");
        }
        let good = FlowSettings::new(1e-3, 1.0).expect("settings");
        assert!(good.relative(-0.1).is_err() && good.relative(f32::NAN).is_err());
        assert!(good.relative(0.0).is_ok());
        let found = MAX_ATTEMPTS + 1;
        let limit = MAX_ATTEMPTS;
        let expected = FlowError::TooManyAttempts { found, limit };
        assert_eq!(good.max_attempts(found), Err(expected));
        // The least step is not above the greatest one.
        assert_eq!(FlowSettings::new(100.0, 1.0).map(|s| s.min_step), Ok(1.0));
    }
}
