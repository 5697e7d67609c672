//! What is asked for is answered, and every picture is the one that was asked for.

#[expect(dead_code, reason = "code of several tests")]
mod common;

use std::path::PathBuf;
use std::time::{Duration, Instant};

use common::{Folder, picture_of};
use raydsl::prelude::*;
use raydsl_viewer::{Action, Config, Device, Next, Player, Session, Show};

/// Plays a script; one that has not ended after a minute hangs.
fn play(text: &str, folder: &Folder) -> Session {
    let mut player = Player::read(text).expect("a script");
    let mut session = Session::new(Config::scripted(folder.path("")), Device::default(), || {});
    let start = Instant::now();
    while player.step(&mut session) != Next::Done {
        assert!(start.elapsed() < Duration::from_secs(60), "it hangs: {:#?}", session.log());
        session.poll();
        std::thread::sleep(Duration::from_millis(1));
    }
    session.finish_files();
    session
}

/// Writes voxels of a byte whose size is in the name, and returns the line that opens them.
fn open_voxels(folder: &Folder, side: u32, value: impl Fn(UVec3) -> u8) -> String {
    let path = folder.path(&format!("made_{side}x{side}x{side}_uint8.raw"));
    let place = |i: u32| uvec3(i % side, i / side % side, i / side / side);
    let voxels: Vec<u8> = (0..side.pow(3)).map(|i| value(place(i))).collect();
    std::fs::write(&path, voxels).expect("a temporary folder");
    format!("open {}", path.display())
}

#[test]
fn questions_without_an_answer_do_not_hang() {
    let folder = Folder::new("questions");
    let script = "size 32 18\nwgsl none.wgsl\npick 0 0\nopen head:16\nshow cost\nwgsl a.wgsl\n\
                  pick 16 9\nwait 1\nwgsl folder/b.wgsl\npicture a.png\n";
    let session = play(script, &folder);
    let log = session.log().join("\n");
    assert_eq!(session.errors(), 3, "{log}");
    assert!(log.contains("error: show cost: a volume has no tree"), "{log}");
    assert!(log.contains("error: wgsl none.wgsl: nothing is open"), "{log}");
    for name in ["a.wgsl", "folder/b.wgsl", "a.png"] {
        assert!(folder.path(name).exists(), "{name}: {log}");
    }
    assert!(!session.is_asking() && !folder.path("none.wgsl").exists());
}

#[test]
fn nobody_waits_for_no_samples() {
    let folder = Folder::new("no-samples");
    let mut session = play("size 16 9\nopen head:16", &folder);
    let error = session.apply(&Action::Wait(0)).expect_err("nothing to wait for");
    assert_eq!(error, "wait for 1 sample or more");
    assert!(Player::read("wait 0").is_err());
}

/// Each variant has its film: a question between both must not leave them with other samples.
#[test]
fn a_pick_does_not_spoil_a_difference() {
    let folder = Folder::new("pick");
    let config = Config { samples: 32, ..Config::interactive(folder.path("")) };
    let mut session = Session::new(config, Device::default(), || {});
    for line in ["size 160 90", "open tests/data/room.obj"] {
        session.apply(&line.parse().expect(line)).expect(line);
    }
    common::until(&mut session, |session| session.info().is_some());
    for line in ["mode path", "variant scalar", "show difference packet8"] {
        session.apply(&line.parse().expect(line)).expect(line);
    }
    let mut frames = 0;
    while !session.has(32) {
        session.apply(&Action::Pick(80, 45)).expect("a pixel");
        common::until(&mut session, |session| !session.is_asking());
        let frame = session.frame().filter(|frame| frame.number == session.number());
        let Some(found) = frame.and_then(|frame| frame.difference) else { continue };
        assert_eq!(found.most, 0.0, "{:?}", session.frame().map(|frame| frame.samples));
        frames += 1;
    }
    assert!(frames > 0);
    session.close();
}

#[test]
fn a_picture_is_that_of_the_last_change() {
    let folder = Folder::new("last");
    let mut session = play("size 16 9\nopen head:16\nwait 1", &folder);
    session.apply(&Action::Orbit(10.0, 0.0)).expect("a camera turns");
    let error = session.apply(&Action::Picture("a".to_owned())).expect_err("none was asked for");
    assert_eq!(error, "the last change has no picture");
    let error = session.apply(&Action::Show(Show::Cost)).expect_err("no tree");
    assert!(error.starts_with("a volume has no tree"), "{error}");
    common::wait(&mut session, 1);
    session.apply(&Action::Picture("deep/a".to_owned())).expect("there is one");
    session.finish_files();
    assert_eq!(picture_of(&folder.path("deep/a.png")).0, (16, 9), "{:#?}", session.log());
    let left = std::fs::read_dir(folder.path("deep")).expect("a folder").count();
    assert_eq!(left, 1, "no part of a file stays");
}

/// A shell of 100 around a core of 255 in air: one transfer function shows the shell, and the other
/// the core. No picture is made in between; whether the question comes before the kernel of the new
/// look is a matter of chance.
#[test]
fn picks_are_of_what_is_to_be_seen() {
    let folder = Folder::new("voxels");
    let open = open_voxels(&folder, 11, |p| {
        let from_middle = (p.as_ivec3() - 5).abs().max_element();
        match from_middle {
            0..=1 => 255,
            2..=4 => 100,
            _ => 0,
        }
    });
    let both = "preset tissue\npick 16 16\npreset bone\npick 16 16\n".repeat(50);
    let cut = "cut ball 0.5 0.5 0.5 0.5\npick 16 16\n";
    let session = play(&format!("size 33 33\n{open}\n{both}{cut}"), &folder);
    assert_eq!(session.errors(), 0, "{:#?}", session.log());
    let picks = session.log().iter().filter(|line| line.starts_with("picked "));
    let mut picks: Vec<&str> = picks.map(String::as_str).collect();
    assert_eq!(picks.pop(), Some("picked nothing"));
    assert_eq!(picks.len(), 100);
    for pair in picks.chunks(2) {
        assert!(pair[0].contains("voxel (8, 10, 7), value "), "{pair:#?}");
        assert!(pair[1].contains("voxel (6, 6, 6), value "), "{pair:#?}");
    }
}

/// Layers of 12 pictures whose names have no leading zeros: the one of number 2 is the second.
#[test]
fn layers_of_a_folder_are_in_order() {
    let folder = Folder::new("layers");
    let stack = folder.path("stack");
    std::fs::create_dir_all(&stack).expect("a temporary folder");
    for i in 0..12u8 {
        let layer = image::GrayImage::from_pixel(4, 4, image::Luma([20 * i]));
        layer.save(stack.join(format!("{i}.png"))).expect("a temporary folder");
    }
    let script = format!("size 33 33\nopen {}\npick 16 16\n", stack.display());
    let session = play(&script, &folder);
    assert_eq!(session.errors(), 0, "{:#?}", session.log());
    let picked = session.picked().flatten().expect("the middle is opaque");
    let value: f32 = picked.value.rsplit(' ').next().and_then(|v| v.parse().ok()).expect("a value");
    let z: f32 =
        picked.value.split([',', ')']).nth(2).and_then(|z| z.trim().parse().ok()).expect("a place");
    assert!((value / 20.0 - z).abs() <= 0.5, "{}", picked.value);
}

#[test]
fn an_exposure_keeps_the_film() {
    let folder = Folder::new("exposure");
    let script = "size 32 18\nopen head:16\nwait 8\npicture a.png\nexposure 1\npicture b.png\n\
                  exposure 0\npicture c.png\n";
    let session = play(script, &folder);
    assert_eq!(session.errors(), 0, "{:#?}", session.log());
    assert_eq!(session.frame().map(|frame| frame.samples), Some(8));
    let picture = |name: &str| picture_of(&folder.path(name)).1;
    assert!(picture("a.png") != picture("b.png") && picture("a.png") == picture("c.png"));
}

#[test]
fn what_does_not_open_leaves_the_series() {
    let folder = Folder::new("series");
    let script = "size 16 9\nopen head:16\nadd head:17\nadd gone.vti\nstep 1\nstep 2\nstep 9\n\
                  open gone.nii\nopen head:4\nstep 0\nopen head:18\ncancel\n";
    let mut session = play(script, &folder);
    assert_eq!(session.errors(), 4, "{:#?}", session.log());
    let log = session.log().join("\n");
    assert!(log.contains("step 9: steps are from 0 to 2"), "{log}");
    assert!(log.contains("head:4: choose a number from 8 to 1024"), "{log}");
    assert_eq!((session.steps().0.len(), session.steps().1), (3, 0));
    assert!(session.info().is_some_and(|info| info.size.starts_with("16 x")));
    // Files that are added while the first is loading are its steps.
    for line in ["open head:19", "add head:20"] {
        session.apply(&line.parse().expect(line)).expect(line);
    }
    assert_eq!(session.steps().0.len(), 3);
    common::until(&mut session, |session| session.progress().is_none());
    let files = ["head:19", "head:20"].map(PathBuf::from);
    assert_eq!(session.steps(), (&files[..], 0));
}

#[test]
fn a_log_is_written_as_it_goes() {
    let folder = Folder::new("log");
    let mut session = Session::new(Config::scripted(folder.path("")), Device::default(), || {});
    session.keep_log(&folder.path("new/log.txt")).expect("a temporary folder");
    for line in ["orbit 1 0", "orbit 2 0", "size 5 5", "step 3", "size 6 6", "size 7 7"] {
        // Without data there is no step, which is in the log.
        let _ = session.apply(&line.parse().expect(line));
    }
    let text = std::fs::read_to_string(folder.path("new/log.txt")).expect("a log");
    assert_eq!(text, "orbit 3 0\nsize 5 5\nerror: step 3: nothing is open\nsize 7 7\n");
}
