//! What command lines of several programs are made of.

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
    let parts: Vec<f64> = text
        .split(',')
        .filter_map(|p| p.trim().parse().ok())
        .filter(|v: &f64| v.is_finite())
        .collect();
    parts.try_into().map_err(|_| "write three numbers, for example 1,2,3".to_owned())
}
