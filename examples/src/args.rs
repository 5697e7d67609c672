//! What command lines of several programs are made of.

use std::time::Duration;

use raydsl::kernel::Variant;

/// `1920x1200`.
///
/// # Errors
///
/// A text that is no size, with the remedy.
pub fn size(text: &str) -> Result<(u32, u32), String> {
    let parse = |n: &str| n.parse::<u32>().ok().filter(|n| (1..=65_535).contains(n));
    text.split_once('x').and_then(|(w, h)| Some((parse(w)?, parse(h)?))).ok_or_else(|| {
        "write WIDTHxHEIGHT with numbers from 1 to 65535, for example 640x480".to_owned()
    })
}

/// `packet8`.
///
/// # Errors
///
/// A text that names no variant, with the names.
pub fn variant(name: &str) -> Result<Variant, String> {
    Variant::from_name(name).ok_or_else(|| format!("choose from {}", variant_names()))
}

/// The variants' names, for help texts.
pub fn variant_names() -> String {
    Variant::ALL.map(Variant::name).join(",")
}

/// `1,2,3`.
///
/// # Errors
///
/// A text that is no point, with the remedy.
pub fn point(text: &str) -> Result<[f64; 3], String> {
    let number = |part: &str| part.trim().parse().ok().filter(|v: &f64| v.is_finite());
    let parts: Option<Vec<f64>> = text.split(',').map(number).collect();
    let point = parts.and_then(|parts| parts.try_into().ok());
    point.ok_or_else(|| "write three numbers, for example 1,2,3".to_owned())
}

/// `0.5`, above 0.
///
/// # Errors
///
/// A text that is no such number, with the remedy.
pub fn length(text: &str) -> Result<f32, String> {
    let number = text.trim().parse().ok().filter(|n: &f32| *n > 0.0 && n.is_finite());
    number.ok_or_else(|| "write a number above 0, for example 0.5".to_owned())
}

/// `30s`, or `30`.
///
/// # Errors
///
/// A text that is no time, with the remedy.
pub fn seconds(text: &str) -> Result<Duration, String> {
    let number = text.strip_suffix('s').unwrap_or(text).parse().ok();
    let time = number.and_then(|s: f64| Duration::try_from_secs_f64(s).ok());
    time.ok_or_else(|| "write seconds, for example 30s".to_owned())
}

/// `1%`, or `0.01`.
///
/// # Errors
///
/// A text that is no number above 0, with the remedy.
pub fn share(text: &str) -> Result<f64, String> {
    let (number, whole) = text.strip_suffix('%').map_or((text, 1.0), |n| (n, 100.0));
    let share = number.trim_end().parse().ok().map(|n: f64| n / whole);
    share
        .filter(|s| *s > 0.0 && s.is_finite())
        .ok_or_else(|| "write a percentage above 0 or a share, for example 1% or 0.01".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_read() {
        assert_eq!(point("1,-2.5, 3e2"), Ok([1.0, -2.5, 300.0]));
        // No part is passed over.
        for wrong in ["", "1,2", "1,2,3,4", "1,,2,3", "1,x,2,3", "1,2,nan,3", "inf,0,0", "1 2 3"] {
            assert!(point(wrong).is_err_and(|e| e.contains("1,2,3")), "{wrong}");
        }
    }

    #[test]
    fn lengths_are_read() {
        assert_eq!(length("2.5"), Ok(2.5));
        for wrong in ["", "0", "-1", "nan", "inf", "1e-99", "1e99", "one"] {
            assert!(length(wrong).is_err_and(|e| e.contains("0.5")), "{wrong}");
        }
    }

    #[test]
    fn times_and_shares_are_read() {
        assert_eq!(seconds("1.5s"), Ok(Duration::from_millis(1500)));
        assert_eq!(seconds("2"), Ok(Duration::from_secs(2)));
        for wrong in ["", "s", "-1s", "nan", "1m", "1e99"] {
            assert!(seconds(wrong).is_err_and(|e| e.contains("30s")), "{wrong}");
        }
        assert_eq!(share("2%"), Ok(0.02));
        assert_eq!(share("2 %"), Ok(0.02));
        assert_eq!(share("0.5"), Ok(0.5));
        for wrong in ["", "%", "0%", "-1%", "nan", "inf", "1e999%", "one"] {
            assert!(share(wrong).is_err_and(|e| e.contains("1%")), "{wrong}");
        }
    }
}
