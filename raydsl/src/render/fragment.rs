//! Compositing of pictures from several renderers.

use glam::Vec4;

use crate::{Type, kernel};

/// The colour and depth of a pixel from one renderer, a ray tracer or a rasteriser.
#[derive(Clone, Copy, Debug, Default, PartialEq, Type)]
#[repr(C)]
pub struct Fragment {
    /// Colour times alpha, and alpha: transparent black where there is nothing.
    pub color: Vec4,
    /// The depth in the window, from 0 (near) to 1 (far), 1 where there is nothing; with
    /// [`DepthRange::REVERSED`](crate::camera::DepthRange::REVERSED), from 1 to 0 where there is
    /// nothing.
    pub depth: f32,
}

/// Composites `front` over `back`; both are colours times their alpha. (Porter and Duff,
/// "Compositing Digital Images", SIGGRAPH 1984, table 4.3.)
#[kernel]
#[inline]
pub fn over(front: Vec4, back: Vec4) -> Vec4 {
    front + back * (1.0 - front.w)
}

/// Composites the fragments of one pixel from two renderers: the nearer, with the smaller depth,
/// over the farther; for equal depths `a` over `b`.
#[kernel]
#[inline]
pub fn composite(a: Fragment, b: Fragment) -> Fragment {
    if b.depth < a.depth {
        Fragment { color: over(b.color, a.color), depth: b.depth }
    } else {
        Fragment { color: over(a.color, b.color), depth: a.depth }
    }
}

/// Does the same as [`composite()`] where the greater depth is the nearer, as with
/// [`DepthRange::REVERSED`](crate::camera::DepthRange::REVERSED).
#[kernel]
#[inline]
pub fn composite_reversed(a: Fragment, b: Fragment) -> Fragment {
    if b.depth > a.depth {
        Fragment { color: over(b.color, a.color), depth: b.depth }
    } else {
        Fragment { color: over(a.color, b.color), depth: a.depth }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearer_is_over_the_farther_whoever_made_it() {
        let glass = Fragment { color: Vec4::new(0.25, 0.0, 0.0, 0.5), depth: 0.25 };
        let wall = Fragment { color: Vec4::new(0.0, 1.0, 0.0, 1.0), depth: 0.5 };
        let nothing = Fragment { color: Vec4::ZERO, depth: 1.0 };
        let seen = Fragment { color: Vec4::new(0.25, 0.5, 0.0, 1.0), depth: 0.25 };
        assert_eq!(composite(glass, wall), seen);
        assert_eq!(composite(wall, glass), seen);
        assert_eq!(composite(nothing, wall), wall);
        assert_eq!(composite(wall, nothing), wall);
        let behind = Fragment { depth: 0.75, ..glass };
        assert_eq!(composite(behind, wall), wall, "what is opaque hides");
        let turned = |f: Fragment| Fragment { depth: 1.0 - f.depth, ..f };
        for (a, b) in [(glass, wall), (wall, glass), (nothing, wall), (wall, nothing)] {
            assert_eq!(composite_reversed(turned(a), turned(b)), turned(composite(a, b)));
        }
    }
}
