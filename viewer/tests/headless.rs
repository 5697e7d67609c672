//! The viewer without a window: scripts, variants, and what goes wrong.

mod common;

use std::path::Path;
use std::time::{Duration, Instant};

use common::{Folder, data, picture_of, play};
use raydsl::prelude::*;
use raydsl_viewer::{Action, Config, Device, Kind, Mode, Session, Show};

#[test]
fn scripts_play_without_errors() {
    for name in ["points", "surface", "volume", "cells", "film"] {
        let folder = Folder::new(&format!("script-{name}"));
        let text = std::fs::read_to_string(format!("tests/scripts/{name}.txt")).expect(name);
        let session = play(&text, &folder);
        assert_eq!(session.errors(), 0, "{name}: {:#?}", session.log());
        let pictures = text.lines().filter_map(|line| line.strip_prefix("picture "));
        for picture in pictures {
            let (size, rgba) = picture_of(&folder.path(picture));
            assert_eq!(size, (160, 90), "{name} {picture}");
            let first = &rgba[..4];
            let is_flat = rgba.chunks_exact(4).all(|pixel| pixel == first);
            assert!(!is_flat, "{name}: {picture} shows nothing");
        }
    }
}

/// Every mode of every kind of data: packets have the bits of the scalar function, and a device
/// those of its contract.
#[test]
fn variants_agree() {
    for open in ["landscape:20000", "tests/data/room.obj", "head:48", "ropes:12"] {
        let folder = Folder::new("agree");
        let mut session = play(&format!("size 96 54\nopen {open}\nwait 1"), &folder);
        let kind = session.info().expect(open).kind;
        for mode in Mode::of(kind) {
            session.apply(&Action::Mode(*mode)).expect("one of these data");
            session.apply(&Action::Variant(Variant::Scalar)).expect("always there");
            for other in [Variant::Packet4, Variant::Packet8, Variant::Packet16, Variant::Wgsl] {
                session.apply(&Action::Show(Show::Difference(other))).expect("always there");
                common::wait(&mut session, 2);
                let found = session.frame().and_then(|frame| frame.difference);
                let most = found.expect("a difference is shown").most;
                let limit = if other == Variant::Wgsl { 1e-4 } else { 0.0 };
                assert!(most <= limit, "{open} {} {}: {most}", mode.name(), other.name());
            }
        }
        assert_eq!(session.errors(), 0, "{:#?}", session.log());
    }
}

#[test]
fn pictures_are_those_of_the_library() {
    use raydsl::volume::{Centering, ExactCell, Grid, GridConfig};
    use raydsl::volume::{TransferFunction, Volume, VolumeLight};
    const SIDE: u32 = 32;
    let folder = Folder::new("direct");
    let script = format!("size 80 60\nopen head:{SIDE}\nmode exact-cell\nwait 4\npicture a.png");
    let session = play(&script, &folder);
    let pose = session.look().pose;

    let to_world = glam::Affine3::from_scale_rotation_translation(
        Vec3::splat(2.0 / SIDE as f32),
        glam::Quat::IDENTITY,
        Vec3::splat(1.0 / SIDE as f32 - 1.0),
    );
    let config = GridConfig::new().to_world(to_world).centering(Centering::Cell);
    let voxels: Vec<f32> = raydsl_examples::head::head(SIDE).into_iter().map(f32::from).collect();
    let grid = Grid::new(voxels, UVec3::splat(SIDE), config).expect("a grid");
    let range = grid.range();
    let value = |share: f32| range.x + (range.y - range.x) * share;
    let knots = raydsl_viewer::preset("tissue").expect("it is one");
    let colors: Vec<_> = knots.iter().map(|k| (value(k.at), k.color)).collect();
    let opacities: Vec<_> = knots.iter().map(|k| (value(k.at), k.opacity)).collect();
    let function = TransferFunction::new(&colors, &opacities, 2.0 / 200.0).expect("a function");
    let volume = Volume::new(&grid, function);
    let (exact, background) = (ExactCell::new(), vec3(0.015, 0.018, 0.026));
    let kernel = kernel!(|ray: Ray| {
        volume.integrate(&exact, ray, VolumeLight::new()).over(background).extend(1.0)
    });
    let mut film = Film::new(80, 60);
    let scheduler = TiledScheduler::new().variant(Variant::Scalar);
    scheduler.accumulate(&pose.camera(), &kernel, &Sampling::new(256), &mut film, 4);
    let expected = raydsl::render::Display::new().show(&film.image());
    let rows = expected.rows().rev().flatten();
    let expected: Vec<u8> = rows.flat_map(|p| p.map(|c| c.to_bits())).collect();
    let (_, rgba) = picture_of(&folder.path("a.png"));
    let apart = rgba.iter().zip(&expected).map(|(a, b)| a.abs_diff(*b)).max();
    assert!(apart <= Some(1), "{apart:?} levels apart");
}

#[test]
fn what_cannot_be_opened_leaves_what_is_there() {
    let folder = Folder::new("broken");
    let broken = folder.path("broken.laz");
    std::fs::write(&broken, b"no scan").expect("a temporary folder");
    let script = format!(
        "size 32 18\nopen head:16\nwait 1\nopen gone.nii\nopen {}\nopen odd.raw\nopen a.txt\n\
         mode path\nview none\nstep 7\npicture a.png\nsize 0 5\nshow cost\nwait 1\n",
        broken.display()
    );
    let session = play(&script, &folder);
    let log = session.log().join("\n");
    for part in [
        "gone.nii: no such file",
        "broken.laz",
        "size and type in its name",
        "a.txt",
        "from 0 to 0",
    ] {
        assert!(log.contains(part), "{part}: {log}");
    }
    assert!(log.contains("mode path: choose from shaded-cell"), "{log}");
    assert!(log.contains("a volume has no tree"), "{log}");
    assert_eq!(session.errors(), 9, "{log}");
    assert_eq!(session.info().map(|info| info.kind), Some(Kind::Volume));
    assert!(folder.path("a.png").exists());
}

#[test]
fn one_pixel_is_a_picture() {
    let folder = Folder::new("pixel");
    let script = "size 1 1\nopen landscape:500\nwait 3\npicture a.png\npick 0 0\npick 1 0";
    let session = play(script, &folder);
    assert_eq!(picture_of(&folder.path("a.png")).0, (1, 1));
    assert_eq!(session.errors(), 1, "only the second pixel is none: {:#?}", session.log());
}

#[test]
fn a_lost_device_gives_way_to_packets() {
    let folder = Folder::new("lost");
    let mut session = play("size 48 27\nopen head:24\nvariant wgsl\nwait 1", &folder);
    assert_eq!(session.look().variant, Variant::Wgsl, "{:#?}", session.log());
    session.device().destroy();
    session.apply(&Action::Orbit(10.0, 0.0)).expect("a camera turns");
    common::wait(&mut session, 1);
    assert_eq!(session.look().variant, Variant::widest());
    assert!(session.log().join("\n").contains("going on with packet"), "{:#?}", session.log());
    // Another one is made for the next try.
    session.apply(&Action::Variant(Variant::Wgsl)).expect("always there");
    common::wait(&mut session, 1);
    assert_eq!(session.look().variant, Variant::Wgsl, "{:#?}", session.log());
    // An error that was asked for is reached without it.
    session.device().destroy();
    session.apply(&"until 0.05 60".parse().expect("a goal")).expect("something is open");
    common::until(&mut session, |session| !session.is_aiming());
    assert_eq!(session.look().variant, Variant::widest(), "{:#?}", session.log());
    let outcome = session.reached().map(|reached| reached.outcome);
    assert_eq!(outcome, Some(raydsl::render::Outcome::Converged), "{:#?}", session.log());
}

#[test]
fn loading_is_cancelled_and_steps_keep_the_view() {
    let folder = Folder::new("steps");
    let script = "size 32 18\nopen landscape:5000000\ncancel\nopen head:16\nadd head:24\n\
                  orbit 30 0\nknot remove 0\nstep 1\nwait 1\npicture a.png";
    let session = play(script, &folder);
    assert_eq!(session.errors(), 0, "{:#?}", session.log());
    let log = session.log().join("\n");
    assert!(log.contains("cancelled landscape"), "{log}");
    assert!(!log.contains("5000000 points"), "{log}");
    assert!(log.contains("24 x 24 x 24"), "{log}");
    let look = session.look();
    assert!(look.pose != session.info().expect("a head").home);
    assert_eq!(look.knots.len(), 4);
}

/// While a slow picture is made, actions return at once, and a coarse picture of the last one comes
/// soon.
#[test]
fn nobody_waits_for_rendering() {
    let folder = Folder::new("waits");
    let config = Config::interactive(folder.path(""));
    let mut session = Session::new(config, Device::default(), || {});
    for line in ["size 960 540", "open tests/data/room.obj"] {
        session.apply(&line.parse().expect(line)).expect(line);
    }
    common::until(&mut session, |session| session.info().is_some());
    for line in ["mode path", "variant scalar"] {
        session.apply(&line.parse().expect(line)).expect(line);
    }
    common::until(&mut session, |session| session.has(1));
    let (mut pictures, begin) = (0, Instant::now());
    // The other tests use the same cores.
    while pictures < 3 && begin.elapsed() < Duration::from_secs(20) {
        let start = Instant::now();
        session.apply(&Action::Orbit(1.0, 0.0)).expect("a camera turns");
        let is_new = session.poll();
        assert!(start.elapsed() < Duration::from_millis(100));
        // On a fast machine they have all of the pixels.
        let coarse = session.frame().filter(|frame| is_new && frame.is_coarse);
        pictures += usize::from(coarse.is_some());
        std::thread::sleep(Duration::from_millis(16));
    }
    assert!(pictures > 2, "{pictures} coarse pictures while the camera moved");
    common::until(&mut session, |session| session.has(2));
    assert_eq!(session.frame().map(|frame| frame.size), Some((960, 540)));
    session.close();
}

#[test]
fn files_of_every_kind_open() {
    let Some(folder) = data() else {
        println!("LEFT OUT: RAYDSL_DATA is not set");
        return;
    };
    let out = Folder::new("files");
    for name in [
        "lion_takanawa.copc.laz",
        "bunny.obj",
        "sibenik.tri",
        "frog_tissues.vti",
        "fire_ug.vtu",
        "chinese_garden_1k.hdr",
    ] {
        let path = Path::new(&folder).join(name);
        let script = format!("size 64 36\nopen {}\nwait 1\npicture a.png\n", path.display());
        let session = play(&script, &out);
        assert_eq!(session.errors(), 0, "{name}: {:#?}", session.log());
    }
}
