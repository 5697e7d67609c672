//! Pictures by 1, 2 and 3 ranks: the same bits, and of divided volumes the same to rounding.

use crate::common::{Folder, alone, has_mpirun, succeed};

/// Returns the colours of a PFM.
fn colors(bytes: &[u8]) -> Vec<f32> {
    let header = bytes.iter().enumerate().filter(|(_, byte)| **byte == b'\n').nth(2);
    let (end, _) = header.expect("three lines of a header");
    let numbers = bytes[end + 1..].chunks_exact(4);
    numbers.map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect()
}

/// Whether a picture shows something, and no NaN.
fn check_shows(bytes: &[u8], what: &str) {
    let colors = colors(bytes);
    assert!(colors.iter().all(|c| c.is_finite()), "{what}");
    let mean = colors.iter().sum::<f32>() / colors.len() as f32;
    let spread = colors.iter().map(|c| (c - mean).powi(2)).sum::<f32>() / colors.len() as f32;
    assert!(mean > 0.01 && spread > 1e-4, "{what}: mean {mean}, variance {spread}");
}

fn film_of(name: &str, words: &str) -> Vec<u8> {
    let out = Folder::new(name);
    succeed(&out, words);
    assert!(out.path("film.png").exists() && !out.path("film.parts").exists());
    out.read("film.pfm")
}

#[test]
fn films_have_the_same_bits_for_every_division() {
    if !has_mpirun() {
        return;
    }
    let _alone = alone();
    for scene in ["cornell", "ao"] {
        let words = format!("--scene {scene} --size 61x47 --samples 300");
        let one = film_of("one", &format!("{words} --ranks 1"));
        check_shows(&one, scene);
        for division in [
            "--ranks 2",
            "--ranks 3",
            "--ranks 3 --blocks 2",
            "--ranks 2 --tile 17 --blocks 128",
            "--ranks 3 --tile 4096",
            "--ranks 1 --threads 3 --tile 8",
        ] {
            let film = film_of("more", &format!("{words} {division}"));
            assert!(film == one, "{scene} {division}");
        }
        let other = film_of("other", &format!("{words} --ranks 2 --seed 1"));
        assert!(other != one, "{scene}: another seed");
    }
}

#[test]
fn a_rank_that_is_started_alone_renders_all() {
    if !has_mpirun() {
        return;
    }
    let _alone = alone();
    let words = "--scene ao --size 20x10 --samples 64";
    let alone = film_of("alone", words);
    assert!(alone == film_of("launched", &format!("{words} --ranks 2")));
}

#[test]
fn bytes_are_counted() {
    if !has_mpirun() {
        return;
    }
    let _alone = alone();
    let out = Folder::new("bytes");
    succeed(&out, "--ranks 1 --size 32x32 --samples 64");
    assert_eq!(out.report().bytes_per_frame, 0.0);
    succeed(&out, "--ranks 3 --size 64x64 --samples 192 --tile 16");
    let report = out.report();
    let film = report.film.as_ref().expect("a film");
    // Parts of 16 x 16 pixels with 32 bytes each, behind 32 bytes of a header.
    assert!(film.part_bytes > 0 && film.part_bytes.is_multiple_of(32 + 256 * 32));
    let units = film.part_bytes / (32 + 256 * 32);
    let from_others: u64 = report.ranks[1..].iter().map(|rank| rank.samples / (256 * 64)).sum();
    assert_eq!(units, from_others);
    let samples: u64 = report.ranks.iter().map(|rank| rank.samples).sum();
    assert_eq!(samples, 64 * 64 * 192);
    // Each was asked for by a message of six numbers.
    assert_eq!(report.bytes_per_frame, (film.part_bytes + 24 * units) as f64);
    assert_eq!(report.messages_per_frame, (2 * units) as f64);
}

/// Returns the frames of a divided scene.
fn frames_of(name: &str, words: &str) -> (Vec<Vec<u8>>, raydsl_ranks::report::Report) {
    let out = Folder::new(name);
    succeed(&out, words);
    let report = out.report();
    let frames = (0..report.frames).map(|i| out.read(&format!("frame_{i:04}.pfm")));
    (frames.collect(), report)
}

#[test]
fn points_have_the_same_bits_for_every_division() {
    if !has_mpirun() {
        return;
    }
    let _alone = alone();
    let words = "--scene points --points 60000 --size 90x60 --frames 2";
    let (one, whole) = frames_of("points", &format!("{words} --ranks 1"));
    one.iter().for_each(|frame| check_shows(frame, "points"));
    assert!(one[0] != one[1]);
    for (division, ranks) in
        [("--ranks 2", 2), ("--ranks 3", 3), ("--ranks 3 --parts 7", 3), ("--ranks 3 --parts 2", 3)]
    {
        let (frames, report) = frames_of("points", &format!("{words} {division}"));
        assert!(frames == one, "{division}");
        assert!(report.bytes_per_frame > 0.0 && report.ranks.len() == ranks);
        // Each point is held once, with its index, and trees of parts are about one tree.
        let bytes: u64 = report.ranks.iter().map(|rank| rank.scene_bytes).sum();
        let of_one = whole.ranks[0].scene_bytes;
        assert!(bytes.abs_diff(of_one) < of_one / 20, "{division}: {bytes} and {of_one}");
        assert!(bytes > 60_000 * (20 + 4) * 5 / 4, "{division}: {bytes} with trees");
        let most = report.ranks.iter().map(|rank| rank.scene_bytes).max();
        assert!(most.is_some_and(|most| most < bytes * 3 / 5), "{division}");
    }
}

/// How far colours of a divided volume may be from those of the whole one: the whole one's own
/// rounding, whose sums have some hundred cells.
const ROUNDING: f32 = 2e-5;

#[test]
fn volumes_are_the_same_to_rounding() {
    if !has_mpirun() {
        return;
    }
    let _alone = alone();
    let words = "--scene volume --voxels 48 --size 80x80 --frames 2";
    let exact = format!("{words} --least 0");
    let (whole, one) = frames_of("volume", &format!("{exact} --ranks 1"));
    whole.iter().for_each(|frame| check_shows(frame, "volume"));
    let mut eight = None;
    for (division, is_eight) in [
        ("--ranks 2", false),
        ("--ranks 3", false),
        ("--ranks 1 --parts 8", true),
        ("--ranks 2 --parts 8", true),
        ("--ranks 3 --parts 8", true),
        ("--ranks 3 --parts 27", false),
    ] {
        let (frames, report) = frames_of("volume", &format!("{exact} {division}"));
        for (divided, whole) in frames.iter().zip(&whole) {
            let pairs = colors(divided).into_iter().zip(colors(whole));
            let apart = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            println!("{division}: {apart:e}");
            assert!(apart <= ROUNDING, "{division}: {apart:e}");
        }
        if is_eight {
            // Of the same parts, ranks have no influence.
            assert!(eight.get_or_insert_with(|| frames.clone()) == &frames, "{division}");
        }
        // A rank has its share of the parts, and the layers around them.
        let most = report.ranks.iter().map(|rank| rank.scene_bytes).max().expect("ranks");
        let parts = u64::from(report.divided.as_ref().expect("divided").parts);
        let own = parts.div_ceil(report.ranks.len() as u64);
        assert!(most * parts * 2 <= one.ranks[0].scene_bytes * own * 3, "{division}");
    }
}

#[test]
fn what_rays_leave_out_is_bounded() {
    if !has_mpirun() {
        return;
    }
    let _alone = alone();
    let words = "--scene volume --voxels 48 --size 80x80 --frames 1";
    let (whole, _) = frames_of("volume", &format!("{words} --least 0 --ranks 1"));
    for least in [0.001f32, 0.05] {
        let (divided, _) =
            frames_of("volume", &format!("{words} --least {least} --ranks 2 --parts 9"));
        let pairs = colors(&divided[0]).into_iter().zip(colors(&whole[0]));
        let apart = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        // Each part leaves out this share of what is behind in it, whose colours are at most 1; the
        // next ones are seen through it.
        let most = least / (1.0 - least);
        assert!(apart > 0.0 && apart <= most + ROUNDING, "{least}: {apart}");
    }
}
