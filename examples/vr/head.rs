//! A tracked head before a screen: where its eyes are, and what each of them sees through the screen.

use std::path::Path;

use raydsl::camera::{CameraError, DepthRange};
use raydsl::prelude::*;

/// A screen in the world: its lower left corner, and the edges to the right and up, at a right angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Screen {
    pub(crate) corner: Vec3,
    pub(crate) right: Vec3,
    pub(crate) up: Vec3,
}

/// Matrices of an eye, as a program that draws has them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Eye {
    pub(crate) view: Mat4,
    pub(crate) proj: Mat4,
}

/// Distances of the near and the far plane from an eye.
const RANGE: (f32, f32) = (0.1, 60.0);

/// Why an eye has no picture.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "an eye at {at} is {distance} before the screen, and sees through it from {least} on: check the \
     head's frames, their unit, and that x of the screen is to the right of who looks at it"
)]
pub(crate) struct BehindScreen {
    at: Vec3,
    distance: f32,
    least: f32,
}

impl Eye {
    /// Returns the eye at a place before a screen, whose edges are those of the picture. (Kooima,
    /// "Generalized Perspective Projection", 2008.)
    ///
    /// # Errors
    ///
    /// If the screen is behind the eye, or nearer than the near plane.
    pub(crate) fn new(at: Vec3, screen: &Screen) -> Result<Self, BehindScreen> {
        let (x, y) = (screen.right.normalize(), screen.up.normalize());
        let z = x.cross(y);
        let low = screen.corner - at;
        let (near, far) = RANGE;
        let distance = -z.dot(low);
        // Not of a NaN either.
        if !(near..f32::INFINITY).contains(&distance) {
            return Err(BehindScreen { at, distance, least: near });
        }
        // On the near plane the screen is as much smaller as it is nearer.
        let scale = near / distance;
        let (left, bottom) = (x.dot(low) * scale, y.dot(low) * scale);
        let (wide, high) = (screen.right.length() * scale, screen.up.length() * scale);
        let proj = Mat4::from_cols(
            vec4(2.0 * near / wide, 0.0, 0.0, 0.0),
            vec4(0.0, 2.0 * near / high, 0.0, 0.0),
            vec4(2.0 * left / wide + 1.0, 2.0 * bottom / high + 1.0, far / (near - far), -1.0),
            vec4(0.0, 0.0, near * far / (near - far), 0.0),
        );
        let to_world = Mat4::from_cols(x.extend(0.0), y.extend(0.0), z.extend(0.0), at.extend(1.0));
        Ok(Self { view: to_world.inverse(), proj })
    }

    /// Returns what a rasteriser needs: from the world to clip space.
    pub(crate) fn clip(&self) -> Mat4 {
        self.proj * self.view
    }

    /// Returns the camera for rays.
    pub(crate) fn camera(&self) -> Result<Matrix, CameraError> {
        Matrix::new(self.view, self.proj, DepthRange::ZERO_TO_ONE)
    }
}

/// Returns the left and the right eye of a head, whose frame has x to the right.
///
/// # Errors
///
/// If either is not before the screen.
pub(crate) fn eyes(head: Mat4, between: f32, screen: &Screen) -> Result<[Eye; 2], BehindScreen> {
    let eye = |aside: f32| Eye::new(head.transform_point3(vec3(aside * between, 0.0, 0.0)), screen);
    Ok([eye(-0.5)?, eye(0.5)?])
}

/// Returns frames of a head that looks around what is behind the screen, and nods.
pub(crate) fn path(count: u32) -> Vec<Mat4> {
    let head = |i: u32| {
        let t = i as f32 / count.max(1) as f32 * core::f32::consts::TAU;
        let at = vec3(1.1 * t.sin(), 1.75 + 0.3 * (2.0 * t).sin(), 5.4 + 0.4 * t.cos());
        Mat4::from_translation(at) * Mat4::from_rotation_z(0.12 * (t + 0.5).sin())
    };
    (0..count).map(head).collect()
}

/// Reads frames of a head from a file: 16 numbers a line, column by column, from the head's frame (x to
/// the right, y up, z back, of length 1 and at right angles) to the world. Empty lines and those that
/// begin with `#` are passed over.
pub(crate) fn read(path: &Path) -> Result<Vec<Mat4>, String> {
    let text = std::fs::read_to_string(path);
    let text = text.map_err(|e| format!("{}: {e}; check the path", path.display()))?;
    frames(&text).map_err(|e| format!("{}, {e}", path.display()))
}

fn frames(text: &str) -> Result<Vec<Mat4>, String> {
    let lines = text.lines().zip(1..).map(|(line, number)| (line.trim(), number));
    let matrix = |(line, number): (&str, u32)| {
        let numbers: Result<Vec<f32>, _> = line.split_whitespace().map(str::parse).collect();
        let numbers =
            numbers.map_err(|_| format!("line {number}: there is a word that is no number"))?;
        let columns: [f32; 16] = numbers
            .try_into()
            .map_err(|n: Vec<f32>| format!("line {number}: {} numbers, not 16", n.len()))?;
        let matrix = Mat4::from_cols_array(&columns);
        is_frame(&matrix).then_some(matrix).ok_or_else(|| {
            format!(
                "line {number}: no frame; its columns end with 0 0 0 1, and the first three are \
                 right, up and back: of length 1 and at right angles, to within {ROUNDING}"
            )
        })
    };
    let is_data = |(line, _): &(&str, u32)| !line.is_empty() && !line.starts_with('#');
    let found: Vec<Mat4> = lines.filter(is_data).map(matrix).collect::<Result<_, _>>()?;
    if found.is_empty() { Err("there is no frame".to_owned()) } else { Ok(found) }
}

/// How far lengths of a frame may be from 1, and cosines of its angles from 0: what a tracker writes is
/// rounded.
const ROUNDING: f32 = 1e-3;

/// Whether a matrix turns and moves, and does nothing else. One that mirrors would change the eyes.
fn is_frame(matrix: &Mat4) -> bool {
    let turn = Mat3::from_mat4(*matrix);
    let Mat3 { x_axis: x, y_axis: y, z_axis: z } = turn;
    matrix.is_finite()
        && matrix.row(3) == Vec4::W
        && [x, y, z].iter().all(|axis| (axis.length() - 1.0).abs() <= ROUNDING)
        && [x.dot(y), y.dot(z), z.dot(x)].iter().all(|cosine| cosine.abs() <= ROUNDING)
        && turn.determinant() > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCREEN: Screen = Screen {
        corner: vec3(-2.0, 0.1, 1.0),
        right: vec3(3.9, 0.0, 0.4),
        up: vec3(0.0, 2.5, 0.0),
    };

    #[test]
    fn the_screen_is_the_picture_for_every_eye() {
        for head in path(7) {
            for eye in eyes(head, 0.2, &SCREEN).expect("before the screen") {
                for (x, y) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0), (0.3, 0.8)] {
                    let point = SCREEN.corner + SCREEN.right * x + SCREEN.up * y;
                    let seen = eye.clip().project_point3(point);
                    let expected = vec2(2.0 * x - 1.0, 2.0 * y - 1.0);
                    assert!((seen.truncate() - expected).length() < 1e-4, "{seen} {expected}");
                    assert!((0.0..1.0).contains(&seen.z), "{seen}");
                }
            }
        }
    }

    #[test]
    fn eyes_are_apart_and_rays_begin_there() {
        let head = Mat4::from_translation(vec3(0.3, 1.5, 5.0)) * Mat4::from_rotation_z(0.3);
        let eyes = eyes(head, 0.2, &SCREEN).expect("before the screen");
        let [left, right] = eyes.map(|eye| eye.camera().expect("an inverse"));
        let [left, right] = [left, right].map(|camera| camera.begin_frame(64, 64).eye);
        assert!((left.distance(right) - 0.2).abs() < 1e-4, "{left} {right}");
        let across = (right - left).normalize();
        assert!((across - vec3(0.3f32.cos(), 0.3f32.sin(), 0.0)).length() < 1e-3, "{across}");
    }

    #[test]
    fn an_eye_behind_the_screen_is_refused() {
        let normal = SCREEN.right.cross(SCREEN.up).normalize();
        let middle = SCREEN.corner + 0.5 * (SCREEN.right + SCREEN.up);
        let eye = |before: f32| Eye::new(middle + normal * before, &SCREEN);
        assert!(eye(1.01 * RANGE.0).is_ok());
        for before in [0.99 * RANGE.0, 0.0, -1.0, f32::INFINITY, f32::NAN] {
            let error = eye(before).expect_err("it is not before the screen").to_string();
            assert!(error.contains("before the screen") && error.contains("check"), "{error}");
        }
        // One of both is enough: this head is in the plane, and looks along it.
        let head = Mat4::from_translation(middle) * Mat4::from_rotation_y(1.5);
        assert!(eyes(head, 0.5, &SCREEN).is_err());
        let head = Mat4::from_translation(middle + normal) * Mat4::from_rotation_y(1.5);
        assert!(eyes(head, 0.5, &SCREEN).is_ok());
        assert!(eyes(head, 2.0, &SCREEN).is_err());
    }

    #[test]
    fn frames_are_read() {
        let line = |m: Mat4| m.to_cols_array().map(|v| v.to_string()).join(" ");
        let all = path(3);
        let text = all.iter().map(|m| line(*m)).collect::<Vec<_>>().join("\n\n# a comment\n");
        assert_eq!(frames(&text), Ok(all));
        assert!(frames("1.0009 0 0 0 0.0009 1 0 0 0 0 1 0 7 8 9 1").is_ok(), "rounded");
        for (text, part) in [
            ("", "no frame"),
            ("# 1 2\n", "no frame"),
            ("1 2 3", "line 1: 3 numbers, not 16"),
            ("\n1 x", "line 2: there is a word"),
            ("1 0 0 0 0 1 0 0 0 0 0 0 0 0 0 1", "line 1: no frame"),
            ("1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 2", "line 1: no frame"),
            ("NaN 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", "line 1: no frame"),
            // In millimetres, mirrored, and sheared.
            ("1000 0 0 0 0 1000 0 0 0 0 1000 0 0 0 0 1", "line 1: no frame"),
            ("-1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", "line 1: no frame"),
            ("1 0 0 0 0.002 1 0 0 0 0 1 0 0 0 0 1", "line 1: no frame"),
            ("1.002 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", "line 1: no frame"),
        ] {
            let error = frames(text).expect_err(text);
            assert!(error.contains(part), "{text:?}: {error}");
        }
    }
}
