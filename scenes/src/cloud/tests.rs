//! Tests of the whole module; each file follows one part of it.

mod landscape;
mod scaling;

use raydsl_io::cloud::PointCloud;

use super::*;
