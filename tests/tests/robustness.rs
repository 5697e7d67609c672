//! Rays at what is hard: a share of the campaigns that the program `robustness` runs in full.

use raydsl::bvh::BuildError;
use raydsl_tests::campaigns::{Tally, bounces, slabs, watertight};
use raydsl_tests::scaled;

const RAYS: usize = 1_000_000;
const RAYS_OF_WGSL: usize = 100_000;
const BOUNCES: usize = 1_000_000;

#[test]
fn no_ray_passes_a_closed_mesh() -> Result<(), BuildError> {
    for tally in watertight::campaign(scaled(RAYS), scaled(RAYS_OF_WGSL))? {
        tally.assert_none();
    }
    Ok(())
}

#[test]
fn no_box_is_lost() -> Result<(), BuildError> {
    for row in &slabs::ROWS {
        slabs::campaign(row, scaled(RAYS), scaled(RAYS_OF_WGSL))?.assert_none();
    }
    Ok(())
}

#[test]
fn no_ray_hits_where_it_begins() -> Result<(), BuildError> {
    for tally in bounces::on_triangles(scaled(BOUNCES), scaled(RAYS_OF_WGSL), 1.0)? {
        tally.assert_none();
    }
    for tally in bounces::on_spheres(scaled(BOUNCES), scaled(RAYS_OF_WGSL), 1.0)? {
        tally.assert_none();
    }
    Ok(())
}

/// Without the shift, and with half of it, rays do hit where they begin: the test above can fail.
#[test]
fn without_the_shift_they_do() -> Result<(), BuildError> {
    for share in [0.0, 0.25] {
        let found = bounces::on_triangles(scaled(BOUNCES / 10), 0, share)?;
        let lost: Vec<u64> = found.iter().map(Tally::lost).collect();
        println!("{share} of the shift: {lost:?}");
        assert!(lost.iter().sum::<u64>() > 0, "{share} of the shift is enough");
    }
    Ok(())
}
