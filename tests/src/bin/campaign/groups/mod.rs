//! What is measured, a file for each subject.

mod boxes;
mod offsets;
mod triangles;

use crate::row::Group;

/// Every group, in the order of the book.
pub(crate) const ALL: &[Group] = &[triangles::GROUP, boxes::GROUP, offsets::GROUP];

/// 1 for a fault.
fn fault(is_wrong: bool) -> Option<f64> {
    Some(f64::from(u8::from(is_wrong)))
}
