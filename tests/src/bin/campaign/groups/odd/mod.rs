//! Values at the ends of what types hold, and beyond: each has a defined result, or is refused.

mod cameras;
mod places;
mod queries;
mod refusals;
mod shading;

use crate::row::{Group, Row};

pub(crate) const GROUP: Group = Group {
    name: "odd",
    title: "Odd values: the same defined result in every variant",
    clauses: &[
        "An inverted box, a box with a NaN, a range that ends before it begins, and a range with a \
         NaN contain nothing.",
        "From inside of a sphere the far side is hit, as exactly as from outside.",
        "Directions of any length from 1e-20 to 1e20 give the same hit, at a distance in lengths \
         of the direction.",
        "A ray from a camera is off by at most 8 eps as a direction, and by 8 eps of the film's \
         longer side in pixels, for any film and fields of view up to 179.9 degrees.",
        "A light without area lights nothing, and a lobe of roughness 0 is a mirror.",
        "In an instance a distance is off by at most 16 eps of the farthest coordinate, times the \
         amplification that the scene names.",
        "Cuts by planes through the origin of a ray leave all of it or nothing, and the parts \
         inside and outside add up to it.",
        "A grid of one voxel and a transfer function of one knot are constant.",
        "A constructor that refuses its input gives a typed error that names what is wrong.",
    ],
    rows,
};

fn rows() -> Vec<Row> {
    let mut all = queries::rows();
    all.extend(cameras::rows());
    all.extend(shading::rows());
    all.extend(places::rows());
    all.push(refusals::row());
    all
}
