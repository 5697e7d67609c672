//! Parts of films: the same bits for every division into windows and ranges of samples.

use std::ops::Range;

use raydsl::prelude::*;
use raydsl::render::{FilmExtent, FilmPart, PartError, SAMPLE_BLOCK};
use raydsl_tests::gpu::gpu;
use raydsl_tests::scenes::spheres;

const FILM: UVec2 = UVec2::new(37, 21);
/// Seven blocks and a part of one.
const SAMPLES: u32 = 7 * SAMPLE_BLOCK + 20;

fn camera() -> Pinhole {
    Pinhole::new(vec3(1.0, 2.0, -14.0), vec3(0.2, 0.0, 0.0), vec3(0.0, 1.0, 0.0), 0.9)
}

/// A light of random colour, seen past spheres, with the column and the row of the pixel.
macro_rules! lit {
    ($bvh:ident) => {
        kernel!(|ray: Ray, pixel: UVec2, sampler: Sampler| {
            let mut sampler = sampler;
            let u = sampler.next_2d();
            let hit = $bvh.closest_hit(ray);
            let place = pixel.as_vec2();
            if hit.is_hit { vec4(u.x, place.x, place.y, 1.0) } else { vec4(0.1, u.y, u.x, 0.0) }
        })
    };
}

fn extent(window: [u32; 4], samples: Range<u32>) -> FilmExtent {
    let [x, y, width, height] = window;
    FilmExtent::new(FILM, uvec2(x, y), uvec2(width, height), samples).expect("within the film")
}

/// The windows of a division by columns and rows.
fn windows(columns: &[u32], rows: &[u32]) -> Vec<[u32; 4]> {
    let spans = |cuts: &[u32], end: u32| -> Vec<[u32; 2]> {
        let cuts: Vec<u32> = [0].iter().chain(cuts).chain([&end]).copied().collect();
        cuts.windows(2).map(|w| [w[0], w[1] - w[0]]).collect()
    };
    let rows = spans(rows, FILM.y);
    let of_column = |[x, width]: [u32; 2]| {
        rows.iter().map(|[y, height]| [x, *y, width, *height]).collect::<Vec<_>>()
    };
    spans(columns, FILM.x).into_iter().flat_map(of_column).collect()
}

fn film(parts: &[FilmPart]) -> Film {
    Film::from_parts(FILM, parts).expect("parts of one film")
}

#[test]
fn every_division_has_the_same_bits() {
    let points = spheres(300);
    let bvh = Bvh::build(&points).expect("spheres");
    let (camera, kernel, sampling) = (camera(), lit!(bvh), Sampling::new(SAMPLES));
    let scheduler = TiledScheduler::new();
    let part = |window, samples| {
        scheduler.render_part(&camera, &kernel, &sampling, &extent(window, samples))
    };
    let whole = film(&[part([0, 0, FILM.x, FILM.y], 0..SAMPLES)]);
    assert_eq!(whole.samples(), SAMPLES);
    assert!(whole.sample_counts().pixels().iter().all(|n| *n == SAMPLES));

    let divisions: [(&[u32], &[u32], &[u32]); 4] = [
        (&[], &[], &[1, 2, 3, 4, 5, 6, 7]),
        (&[16, 32], &[16], &[4]),
        (&[1], &[20], &[3, 6]),
        (&[36], &[], &[7]),
    ];
    for (columns, rows, blocks) in divisions {
        let cuts: Vec<u32> = [0]
            .into_iter()
            .chain(blocks.iter().map(|block| block * SAMPLE_BLOCK))
            .chain([SAMPLES])
            .collect();
        let parts = windows(columns, rows).into_iter().map(|window| {
            let ranges = cuts.windows(2).map(|w| w[0]..w[1]);
            let mut parts: Vec<FilmPart> = ranges.map(|range| part(window, range)).collect();
            // From the end: the order of joining is another one than that of the samples.
            let mut last = parts.pop().expect("there is a range");
            while let Some(before) = parts.pop() {
                last = before.join(last).expect("neighbours");
            }
            last
        });
        assert!(film(&parts.collect::<Vec<_>>()) == whole, "{columns:?} {rows:?} {blocks:?}");
    }

    // Beside passes that are added one after the other.
    let mut passes = Film::new(FILM.x, FILM.y);
    scheduler.accumulate(&camera, &kernel, &sampling, &mut passes, SAMPLES);
    for (a, b) in passes.means().zip(whole.means()) {
        let apart = (a - b).abs().max_element() / a.abs().max_element().max(1.0);
        assert!(apart < 1e-15, "{a} {b}");
    }
    let errors = passes.standard_error();
    for (a, b) in errors.pixels().iter().zip(whole.standard_error().pixels()) {
        assert!((*a - *b).abs().max_element() <= 1e-6 * a.max_element(), "{a} {b}");
    }
}

#[test]
fn every_variant_has_the_same_bits() {
    let points = spheres(300);
    let bvh = Bvh::build(&points).expect("spheres");
    let (camera, kernel, sampling) = (camera(), lit!(bvh), Sampling::new(100));
    let extent = extent([5, 3, 30, 17], 64..100);
    let reference = TiledScheduler::new().variant(Variant::Scalar);
    let reference = reference.render_part(&camera, &kernel, &sampling, &extent);
    for variant in [Variant::Packet4, Variant::Packet8, Variant::Packet16] {
        let scheduler = TiledScheduler::new().variant(variant).tile(7);
        let part = scheduler.render_part(&camera, &kernel, &sampling, &extent);
        assert!(part == reference, "{variant:?}");
    }
    if let Some(gpu) = gpu() {
        let part = gpu.render_part(&camera, &kernel, &sampling, &extent).expect("a device");
        assert!(part == reference, "wgsl");
    }
}

#[test]
fn a_window_of_a_frame_has_its_pixels() {
    let points = spheres(300);
    let bvh = Bvh::build(&points).expect("spheres");
    let (camera, kernel) = (camera(), lit!(bvh));
    let mut whole = Image::filled(FILM.x, FILM.y, Vec4::ZERO);
    TiledScheduler::new().frame(&camera, &kernel, &mut whole);
    for [x, y, width, height] in [[0, 0, 1, 1], [11, 5, 20, 16], [36, 20, 1, 1]] {
        let expected = Image::from_fn(width, height, |i, j| {
            *whole.get(x + i, y + j).expect("within the frame")
        });
        let mut window = Image::filled(width, height, Vec4::ZERO);
        let scheduler = SimpleScheduler::new();
        scheduler.frame_window(&camera, &kernel, FILM, uvec2(x, y), &mut window);
        assert_eq!(window, expected);
        if let Some(gpu) = gpu() {
            gpu.frame_window(&camera, &kernel, FILM, uvec2(x, y), &mut window).expect("a device");
            assert_eq!(window, expected);
        }
    }
}

/// Parts of a kernel without a scene.
fn noise(window: [u32; 4], samples: Range<u32>) -> FilmPart {
    let kernel = kernel!(|ray: Ray, sampler: Sampler| {
        let mut sampler = sampler;
        let u = sampler.next_2d();
        vec4(u.x, u.y - 0.5, ray.direction.x, 1e30 * u.x)
    });
    let sampling = Sampling::new(SAMPLES);
    TiledScheduler::new().render_part(&camera(), &kernel, &sampling, &extent(window, samples))
}

#[test]
fn bytes_keep_everything() {
    for samples in [0..1, 0..64, 64..65, 64..192, 128..SAMPLES, 0..SAMPLES] {
        let part = noise([3, 4, 5, 6], samples.clone());
        let bytes = part.to_bytes();
        assert_eq!(FilmPart::from_bytes(&bytes), Ok(part), "{samples:?}");
        for length in (0..bytes.len()).step_by(97).chain([bytes.len() - 1]) {
            let error = FilmPart::from_bytes(&bytes[..length]).expect_err("too short");
            assert!(matches!(error, PartError::Length { .. }), "{error}");
        }
        let longer = [&bytes[..], &[0]].concat();
        assert!(matches!(FilmPart::from_bytes(&longer), Err(PartError::Length { .. })));
    }
}

#[test]
fn hostile_headers_are_refused() {
    let header = |words: [u32; 8]| -> Vec<u8> {
        words.iter().flat_map(|word| word.to_le_bytes()).chain([0; 64]).collect()
    };
    let most = u32::MAX;
    for words in [
        [0; 8],
        [most; 8],
        [most, most, 0, 0, most, most, 0, most],
        [most, most, 1, 1, most, most, 0, 1],
        [9, 9, 0, 0, 9, 9, 0, 1],
        [1, 1, 0, 0, 1, 1, 1, 2],
        [1, 1, 0, 0, 1, 1, 64, 64],
        [1, 1, 0, 0, 1, 1, 128, 64],
        [1, 1, 0, 0, 0, 1, 0, 64],
        [1, 1, 1, 0, 1, 1, 0, 64],
    ] {
        let error = FilmPart::from_bytes(&header(words)).expect_err("no part");
        assert!(!error.to_string().is_empty());
    }
}

#[test]
fn what_does_not_belong_together_is_refused() {
    let part = |window, samples| noise(window, samples);
    let (left, right) = ([0, 0, 5, 5], [5, 0, 5, 5]);
    for (a, b) in [
        (part(left, 0..64), part(left, 128..192)),
        (part(left, 64..128), part(left, 0..64)),
        (part(left, 0..64), part(left, 0..64)),
        (part(left, 0..64), part(right, 64..128)),
        (part(left, 0..20), part(left, 64..128)),
    ] {
        assert!(matches!(a.join(b), Err(PartError::Apart { .. })));
    }
    let overlapping = [part(left, 0..64), part([4, 4, 2, 2], 0..64)];
    let error = Film::from_parts(FILM, &overlapping).expect_err("they overlap");
    assert_eq!(error, PartError::Overlap { pixel: uvec2(4, 4) });
    let late = Film::from_parts(FILM, &[part(left, 64..128)]).expect_err("no beginning");
    assert_eq!(late, PartError::NoBeginning { first: 64 });
    let other = Film::from_parts(uvec2(20, 20), &[part(left, 0..64)]).expect_err("another size");
    assert_eq!(other, PartError::OtherFilm { film: uvec2(20, 20), found: FILM });

    // What is not there has no samples.
    let film = Film::from_parts(FILM, &[part(left, 0..70), part(right, 0..3)]).expect("two");
    let counts = film.sample_counts();
    let count = |x, y| *counts.get(x, y).expect("within the film");
    assert_eq!((count(0, 0), count(9, 4), count(10, 4), film.samples()), (70, 3, 0, 70));
}
