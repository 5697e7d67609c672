//! Changes of a look that need no data.

use raydsl::prelude::*;
use raydsl_scenes::Pose;

use crate::action::Action;
use crate::look::{CutObject, Knot, Look, MOST_KNOTS, preset};

/// The most pixels along a side of a picture.
const MOST_SIDE: u32 = 16384;
/// The most pixels of a picture: a film has 80 bytes for each.
const MOST_PIXELS: u64 = 1 << 26;
/// The most objects that are cut out.
const MOST_CUTS: usize = 64;
/// The least and the greatest vertical field of view, in radians.
pub(crate) const FIELDS_OF_VIEW: (f32, f32) = (0.1f32.to_radians(), 170f32.to_radians());

/// Returns the size of a picture, if it is one that fits into memory.
pub(crate) fn size(width: u32, height: u32) -> Result<(u32, u32), String> {
    let is_possible = (1..=MOST_SIDE).contains(&width) && (1..=MOST_SIDE).contains(&height);
    if is_possible && u64::from(width) * u64::from(height) <= MOST_PIXELS {
        return Ok((width, height));
    }
    Err(format!("sides are from 1 to {MOST_SIDE}, and pixels at most {MOST_PIXELS}"))
}

/// Returns a camera, if it has a direction and sees something; what is up is made a unit vector.
pub(crate) fn camera(pose: Pose) -> Result<Pose, String> {
    let (least, most) = FIELDS_OF_VIEW;
    if !(least..=most).contains(&pose.fov_y) {
        return Err("the field of view is from 0.1 to 170 degrees".to_owned());
    }
    // A unit vector keeps its bits: an animation ends at the camera that it began with.
    let up = if pose.up.is_normalized() { pose.up } else { pose.up.normalize_or_zero() };
    let pose = Pose { up, ..pose };
    // Squares of larger distances are infinite.
    if pose.is_valid() && pose.distance().is_finite() {
        return Ok(pose);
    }
    Err("the camera has no direction".to_owned())
}

/// Returns an exposure in stops, if it is finite: the nearest from -20 to 20.
pub(crate) fn exposure(stops: f32) -> Result<f32, String> {
    if stops.is_finite() {
        return Ok(stops.clamp(-20.0, 20.0));
    }
    Err("an exposure is finite".to_owned())
}

/// Changes a look.
pub(crate) fn edit(look: &mut Look, action: &Action) -> Result<(), String> {
    match action {
        Action::Orbit(..) | Action::Turn(..) | Action::Fly(_) | Action::Zoom(_) => {
            steer(look, action)
        }
        Action::Preset(name) => {
            look.knots = preset(name)
                .ok_or_else(|| format!("choose from {}", crate::look::PRESETS.join(", ")))?;
            Ok(())
        }
        Action::AddKnot(_) | Action::SetKnot(..) | Action::RemoveKnot(_) => {
            edit_knots(look, action)
        }
        Action::AddCut(_) | Action::MoveCut(..) | Action::RemoveCut(_) => edit_cuts(look, action),
        other => Err(format!("`{other}` changes no picture")),
    }
}

fn steer(look: &mut Look, action: &Action) -> Result<(), String> {
    let mut pose = look.pose;
    match action {
        Action::Orbit(x, y) => pose.orbit(*x, *y),
        Action::Turn(x, y) => pose.turn(*x, *y),
        Action::Fly(by) => pose.fly(*by),
        Action::Zoom(factor) if *factor > 0.0 => pose.zoom(*factor),
        _ => return Err("the factor is above 0".to_owned()),
    }
    if !pose.is_valid() {
        return Err("the camera would lose its direction".to_owned());
    }
    look.pose = pose;
    Ok(())
}

fn checked(knot: &Knot) -> Result<Knot, String> {
    let is_color = knot.color.is_finite() && knot.color.min_element() >= 0.0;
    if (0.0..=1.0).contains(&knot.at) && (0.0..=1.0).contains(&knot.opacity) && is_color {
        return Ok(*knot);
    }
    Err("place and opacity are from 0 to 1, and colours not negative".to_owned())
}

fn edit_knots(look: &mut Look, action: &Action) -> Result<(), String> {
    let knots = &mut look.knots;
    let none = || "there is no knot of this number".to_owned();
    match action {
        Action::AddKnot(_) if knots.len() >= MOST_KNOTS => {
            return Err(format!("there are {MOST_KNOTS} knots already"));
        }
        Action::AddKnot(knot) => knots.push(checked(knot)?),
        Action::SetKnot(i, knot) => *knots.get_mut(*i).ok_or_else(none)? = checked(knot)?,
        Action::RemoveKnot(_) if knots.len() < 2 => return Err("one knot is left".to_owned()),
        Action::RemoveKnot(i) if *i < knots.len() => {
            knots.remove(*i);
        }
        _ => return Err(none()),
    }
    knots.sort_by(|a, b| a.at.total_cmp(&b.at));
    Ok(())
}

fn checked_cut(cut: CutObject) -> Result<CutObject, String> {
    let is_right = match cut {
        CutObject::Ball { center, radius } => {
            center.is_finite() && radius > 0.0 && radius.is_finite()
        }
        CutObject::Half { through, normal } => {
            through.is_finite() && normal.is_finite() && normal.length() > 1e-6
        }
    };
    if is_right {
        Ok(cut)
    } else {
        Err("a radius is above 0, and a normal has a length".to_owned())
    }
}

fn edit_cuts(look: &mut Look, action: &Action) -> Result<(), String> {
    let cuts = &mut look.cuts;
    let none = || "there is no cut object of this number".to_owned();
    match action {
        Action::AddCut(_) if cuts.len() >= MOST_CUTS => {
            return Err(format!("there are {MOST_CUTS} cut objects already"));
        }
        Action::AddCut(cut) => cuts.push(checked_cut(*cut)?),
        Action::MoveCut(i, by) => {
            let cut = cuts.get_mut(*i).ok_or_else(none)?;
            *cut = checked_cut(cut.moved(*by))?;
        }
        Action::RemoveCut(i) if *i < cuts.len() => {
            cuts.remove(*i);
        }
        _ => return Err(none()),
    }
    Ok(())
}

/// Moves a cut object in the plane of the picture, until it is seen in this place; `bounds` is the box
/// that its place is a share of.
pub(crate) fn drag_cut(look: &mut Look, i: usize, to: Vec2, bounds: Aabb) -> Result<(), String> {
    let (pose, size) = (look.pose, look.size);
    let cut = look.cuts.get_mut(i).ok_or("there is no cut object of this number")?;
    let place = bounds.min + cut.place() * bounds.size();
    let moved = pose.beside(size, to, place).ok_or("it is behind the camera")?;
    let by = (moved - place) / bounds.size().max(Vec3::splat(f32::MIN_POSITIVE));
    *cut = checked_cut(cut.moved(by))?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cameras_that_see_nothing_are_refused() {
        let pose = Pose::default();
        assert_eq!(camera(pose), Ok(pose));
        let long = Pose { up: vec3(0.0, 0.0, 5.0), ..pose };
        assert_eq!(camera(long), Ok(pose), "what is up is a direction");
        for fov_y in [f32::NAN, f32::INFINITY, 0.0, -0.7, 3.0] {
            let error = camera(Pose { fov_y, ..pose }).expect_err("it has no such field of view");
            assert_eq!(error, "the field of view is from 0.1 to 170 degrees", "{fov_y}");
        }
        for wrong in [
            Pose { eye: vec3(f32::NAN, 0.0, 0.0), ..pose },
            Pose { target: vec3(0.0, f32::INFINITY, 0.0), ..pose },
            Pose { target: pose.eye, ..pose },
            Pose { eye: vec3(0.0, -2e38, 0.0), target: vec3(0.0, 2e38, 0.0), ..pose },
            Pose { up: Vec3::ZERO, ..pose },
            Pose { up: vec3(0.0, 0.0, f32::INFINITY), ..pose },
            Pose { up: Vec3::NAN, ..pose },
            Pose { up: pose.target - pose.eye, ..pose },
        ] {
            let error = camera(wrong).expect_err("it has no direction");
            assert_eq!(error, "the camera has no direction", "{wrong:?}");
        }
    }
}
