//! Volumes: thin and thick media, steps of any length, and cuts.

mod cuts;
mod fields;
mod layers;

use crate::row::{Group, Row};

pub(crate) const GROUP: Group = Group {
    name: "volumes",
    title: "Volumes: optical depths from 1e-8 to 1e6, steps, and cuts",
    clauses: &[
        "Radiance and opacity of piecewise linear data are right to 1e-5 of themselves, in WGSL to \
         1e-4 and in f64 to 1e-12, in one cell as in a million, in all orders of extinction and \
         colour.",
        "Opacity is from 0 to 1, and radiance between the least and the greatest colour times it, by \
         every integrator.",
        "The opacity of a homogeneous slab is right to 1e-5 with steps from 1/4 to 16 cells, and of a \
         picture of a block to 1e-3, by every integrator but Euler's.",
        "At most one ray in a hundred is further off than the tolerance of the adaptive integrator.",
        "Skipping empty space changes nothing beyond rounding.",
        "The ends of parts inside of balls are those of balls whose radius is off by 4 eps of the \
         distance at most, to 4 ulp.",
    ],
    rows,
};

fn rows() -> Vec<Row> {
    layers::rows().into_iter().chain(fields::rows()).chain([cuts::row()]).collect()
}
