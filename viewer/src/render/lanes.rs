//! How many lanes of packets run.

use raydsl::prelude::*;
use raydsl_report::{Utilisation, utilisation};

use crate::look::Look;
use crate::subject::SubjectKernel;

/// Columns and rows of a packet of 8 lanes, as the renderer groups pixels.
const PACKET: (u32, u32) = (4, 2);
/// The most packets that are counted: lanes that count are slow.
const MOST: u32 = 4096;

/// Counts the lanes of packets that are spread evenly over the picture of a look, one ray for each
/// pixel.
pub(super) fn of(kernel: &SubjectKernel<'_>, look: &Look) -> Utilisation {
    let (camera, sampling) = (look.pose.camera(), Sampling::new(1));
    let rays = camera.begin_frame(look.size.0, look.size.1);
    let inputs: Vec<(Ray, Sampler)> =
        pixels(look.size).map(|pixel| sampling.sample(&rays, pixel, 0)).collect();
    utilisation(kernel, &inputs)
}

/// The pixels of packets, one packet after another. Those at an edge, with fewer pixels, are left out,
/// unless the picture is smaller than a packet.
fn pixels((width, height): (u32, u32)) -> impl Iterator<Item = UVec2> {
    let packet = uvec2(PACKET.0.min(width), PACKET.1.min(height));
    let (columns, rows) = (width / packet.x, height / packet.y);
    // As many are left out between two columns as between two rows.
    let step =
        (f64::from(columns) * f64::from(rows) / f64::from(MOST)).sqrt().ceil().max(1.0) as u32;
    let corners = (0..rows)
        .step_by(step as usize)
        .flat_map(move |y| (0..columns).step_by(step as usize).map(move |x| uvec2(x, y) * packet));
    corners.flat_map(move |corner| {
        (0..packet.x * packet.y).map(move |i| corner + uvec2(i % packet.x, i / packet.x))
    })
}

#[cfg(test)]
mod tests {
    use raydsl_scenes::Pose;

    use super::*;

    #[test]
    fn packets_are_whole_and_not_too_many() {
        for size in [(1, 1), (3, 5), (64, 48), (960, 540), (7, 4000), (16384, 4096)] {
            let all: Vec<UVec2> = pixels(size).collect();
            assert!(!all.is_empty() && all.len() as u32 <= 8 * MOST, "{size:?}: {}", all.len());
            assert!(all.iter().all(|p| p.x < size.0 && p.y < size.1), "{size:?}");
        }
        let first: Vec<UVec2> = pixels((64, 48)).take(8).collect();
        assert_eq!(first[..5], [uvec2(0, 0), uvec2(1, 0), uvec2(2, 0), uvec2(3, 0), uvec2(0, 1)]);
        assert_eq!(pixels((64, 48)).count(), 64 * 48);
    }

    #[raydsl::kernel]
    fn brightness(y: f32) -> f32 {
        y * y
    }

    /// Rays to the right of the middle, which is between two columns of pixels, and within a packet.
    #[test]
    fn lanes_are_those_of_the_pixels() {
        const SIZE: (u32, u32) = (20, 8);
        let pose = Pose { eye: vec3(0.0, 0.0, 3.0), target: Vec3::ZERO, up: Vec3::Y, fov_y: 0.7 };
        let kernel = kernel!(counted |ray: Ray, _sampler: Sampler| {
            let mut light = vec4(0.0, 0.0, 0.0, 1.0);
            if ray.direction.x > 0.0 {
                // An arm with a call is left out where no lane takes it.
                light.x = brightness(ray.direction.y);
            }
            light
        });
        let found = of(&kernel, &Look { pose, size: SIZE, ..Look::default() });
        let is_right = |x: u32, y: u32| pose.ray(SIZE, x, y).direction.x > 0.0;
        let (mut lanes, mut rounds) = (0, 0);
        for (x, y) in
            (0..SIZE.1).step_by(2).flat_map(|y| (0..SIZE.0).step_by(4).map(move |x| (x, y)))
        {
            let packet = (0..8).filter(|i| is_right(x + i % 4, y + i / 4)).count() as u64;
            lanes += packet;
            rounds += u64::from(packet > 0);
        }
        // Half of the pixels, of three of the five columns of packets.
        assert_eq!((lanes, rounds), (80, 12));
        let [line] = &found.lines[..] else { panic!("one condition: {found}") };
        assert_eq!((line.place.what, line.lanes, line.rounds), ("if", lanes, rounds), "{found}");
        assert_eq!((found.lanes, found.packets), (8, 20));
    }
}
