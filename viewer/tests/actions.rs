//! What a person can do beside opening and turning: each action with a check of its own.

#[expect(dead_code, reason = "code of several tests")]
mod common;

use std::path::Path;

use common::{Folder, picture_of, play};
use raydsl::prelude::*;
use raydsl::render::Outcome;
use raydsl_viewer::{Action, Kind, Menu, Mode, Next, Player, Session, Show, Wand};

fn apply(session: &mut Session, lines: &[&str]) {
    for line in lines {
        let action: Action = line.parse().expect(line);
        session.apply(&action).unwrap_or_else(|e| panic!("{line}: {e}"));
        if let Action::Wait(samples) = action {
            common::until(session, |session| session.has(samples));
        }
    }
}

/// Writes an environment of 8 by 4 texels of one radiance, and returns its path.
fn sky(folder: &Folder, name: &str, exponent: u8) -> String {
    let path = folder.path(name);
    let mut bytes = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n".to_vec();
    // 128 is a half of 2 to the exponent less 128.
    bytes.extend([128, 128, 128, exponent].repeat(32));
    std::fs::write(&path, bytes).expect("a temporary folder");
    path.display().to_string()
}

#[test]
fn white_light_from_everywhere_shows_albedos() {
    let folder = Folder::new("furnace");
    let open = sky(&folder, "white.hdr", 129);
    // Both balls reflect 0.8, whatever is around them: also each other's light, but for its share.
    let script = format!("size 161 90\nopen {open}\nmode path\nwait 64\npicture a.png\n");
    let session = play(&script, &folder);
    assert_eq!(session.errors(), 0, "{:#?}", session.log());
    assert_eq!(session.info().map(|info| info.kind), Some(Kind::Surface));
    let (size, rgba) = picture_of(&folder.path("a.png"));
    let pixel = |at: Vec3| {
        let seen = session.look().pose.seen(size, at).expect("before the camera");
        let (x, y) = (seen.x as u32, size.1 - 1 - seen.y as u32);
        rgba[4 * (y * size.0 + x) as usize]
    };
    let level = |light: f32| (linear_to_srgb(light) * 255.0 + 0.5) as u8;
    let to_eye = (session.look().pose.eye - vec3(-1.1, 0.0, 0.0)).normalize();
    for at in [vec3(-1.1, 0.0, 0.0) + to_eye, vec3(1.1, 0.0, 0.0) + to_eye] {
        assert!(pixel(at).abs_diff(level(0.8)) <= 3, "{at}: {} {}", pixel(at), level(0.8));
    }
    assert_eq!(rgba[0], 255, "the sky is 1");
}

#[test]
fn an_environment_lights_a_surface_and_goes() {
    let folder = Folder::new("sky");
    let (dim, white) = (sky(&folder, "dim.hdr", 127), sky(&folder, "white.hdr", 129));
    let square = folder.path("square.tri");
    let corners = [[-1f32, 0.0, -1.0], [-1.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 0.0, -1.0]];
    let order = [0, 1, 2, 0, 2, 3].map(|i| corners[i as usize]);
    let words = order.iter().flatten().flat_map(|v| v.to_le_bytes());
    // The count of triangles is first.
    let bytes: Vec<u8> = 2u32.to_le_bytes().into_iter().chain(words).collect();
    std::fs::write(&square, bytes).expect("a temporary folder");
    let open = square.display();
    let script = format!(
        "size 64 36\nopen {open}\nwait 4\npicture own.png\nenvironment {dim}\nwait 4\npicture dim.png\n\
         environment {white}\nwait 4\npicture white.png\nenvironment none\nwait 4\npicture again.png\n\
         environment gone.hdr\nwait 1\n"
    );
    let session = play(&script, &folder);
    let log = session.log().join("\n");
    assert_eq!(session.errors(), 1, "{log}");
    assert!(log.contains("gone.hdr: no such file"), "{log}");
    let picture = |name: &str| picture_of(&folder.path(name)).1;
    let corner = |name: &str| picture(name)[0];
    assert!(picture("own.png") == picture("again.png") && picture("own.png") != picture("dim.png"));
    assert!(
        corner("white.png") == 255
            && corner("dim.png") == (linear_to_srgb(0.25) * 255.0 + 0.5) as u8
    );
    let refused = play("open head:16\nenvironment a.hdr\n", &folder);
    assert!(refused.log().join("\n").contains("only surfaces are lit"), "{:#?}", refused.log());
}

#[test]
fn transfer_functions_of_paraview_are_applied() {
    let folder = Folder::new("paraview");
    let path = folder.path("a map.json");
    let text = r#"[{"Name": "fire", "ColorSpace": "RGB", "RGBPoints": [0, 0, 0, 0, 1, 1, 0.5, 0],
        "Points": [0, 0, 0.5, 0, 0.5, 0.25, 0.5, 0, 1, 1, 0.5, 0]}]"#;
    std::fs::write(&path, text).expect("a temporary folder");
    let line = format!("transfer {}", path.display());
    let script = format!(
        "size 64 36\n{line}\nopen landscape:500\n{line}\nopen head:24\nwait 1\npicture a.png\n{line}\n\
         wait 1\npicture b.png\ntransfer gone.json\nopen {}\n",
        path.display()
    );
    let session = play(&script, &folder);
    let log = session.log().join("\n");
    assert_eq!(session.errors(), 4, "{log}");
    assert!(log.contains("only volumes and cells have a transfer function"), "{log}");
    assert!(log.contains("a transfer function has no data"), "{log}");
    assert!(log.contains("transfer function fire"), "{log}");
    let knots = &session.look().knots;
    let (first, last) = (knots[0], knots[knots.len() - 1]);
    assert_eq!((first.at, first.opacity, first.color), (0.0, 0.0, Vec3::ZERO));
    assert_eq!((last.at, last.opacity), (1.0, 1.0));
    assert!((last.color - vec3(1.0, srgb_to_linear(0.5), 0.0)).abs().max_element() < 1e-6);
    assert!(picture_of(&folder.path("a.png")).1 != picture_of(&folder.path("b.png")).1);
}

#[test]
fn cut_objects_go_where_they_are_dragged() {
    let folder = Folder::new("drag");
    let mut session = play("size 160 90\nopen head:24\ncut ball 0.3 0.4 0.5 0.2\nwait 1", &folder);
    let place = |session: &Session| {
        let bounds = session.info().expect("a head").bounds;
        bounds.min + session.look().cuts[0].place() * bounds.size()
    };
    let ahead = (session.look().pose.target - session.look().pose.eye).normalize();
    let before = place(&session);
    for (x, y) in [(100.0, 30.0), (20.5, 80.25), (159.0, 1.0)] {
        apply(&mut session, &[&format!("cut drag 0 {x} {y}")]);
        let now = place(&session);
        let seen = session.look().pose.seen((160, 90), now).expect("it is before the camera");
        assert!((seen - vec2(x, y)).length() < 0.02, "{seen}");
        assert!((now - before).dot(ahead).abs() < 1e-4, "in the plane of the picture");
    }
    let refused = |session: &mut Session, line: &str| {
        session.apply(&line.parse().expect(line)).expect_err(line)
    };
    assert_eq!(refused(&mut session, "cut drag 1 5 5"), "there is no cut object of this number");
    // What is behind the camera cannot be dragged.
    let pose = session.look().pose;
    let away = raydsl_viewer::Pose { target: 2.0 * pose.eye - pose.target, ..pose };
    session.apply(&Action::Camera(away)).expect("a camera");
    assert_eq!(refused(&mut session, "cut drag 0 5 5"), "it is behind the camera");
}

#[test]
fn lanes_are_counted() {
    let folder = Folder::new("lanes");
    let session =
        play("size 64 36\nopen landscape:3000\nmode occlusion\nlanes lanes.txt\nlanes b", &folder);
    assert_eq!(session.errors(), 0, "{:#?}", session.log());
    let found = session.lanes().expect("they were asked for");
    assert_eq!((found.lanes, found.packets), (8, 64 * 36 / 8));
    // All lanes are in the arm of the mode, and none in that of another.
    let source = include_str!("../src/data/points.rs");
    let line = |text: &str| 1 + source.lines().position(|line| line.contains(text)).expect(text);
    let count = |text: &str, what: &str| {
        let is_it = |place: &raydsl::machine::Place| {
            (place.line as usize, place.what) == (line(text), what)
                && place.file.ends_with("points.rs")
        };
        let found = found.lines.iter().find(|line| is_it(&line.place));
        found.map(|line| (line.rounds, line.lanes))
    };
    assert_eq!(count("if is_cost {", "if"), None, "{found}");
    assert_eq!(count("else if is_occlusion {", "if"), Some((64 * 36 / 8, 64 * 36)), "{found}");
    let text = std::fs::read_to_string(folder.path("lanes.txt")).expect("it is written");
    assert_eq!(text, found.to_string());
    // They are of this picture: of another exposure too, but of no other camera or size.
    let mut session = session;
    apply(&mut session, &["exposure 1"]);
    assert!(session.lanes().is_some());
    for line in ["orbit 10 0", "size 32 18"] {
        apply(&mut session, &[line]);
        assert_eq!(session.lanes(), None, "{line}");
        session.apply_lanes().expect("something is open");
        common::until(&mut session, |session| !session.is_asking());
        assert!(session.lanes().is_some(), "{line}");
    }
    assert_eq!(session.lanes().map(|found| found.packets), Some(32 * 18 / 8));
    // Nor do they come late.
    session.apply_lanes().expect("something is open");
    apply(&mut session, &["orbit 10 0"]);
    common::until(&mut session, |session| !session.is_asking());
    assert_eq!(session.lanes(), None);
}

#[test]
fn an_error_is_reached() {
    let folder = Folder::new("until");
    let script = "size 48 27\nopen landscape:5000\nmode occlusion\nuntil 0.03 60\npicture a.png\n";
    let mut session = play(script, &folder);
    assert_eq!(session.errors(), 0, "{:#?}", session.log());
    let reached = *session.reached().expect("it was asked for");
    assert_eq!(reached.outcome, Outcome::Converged, "{reached:?}");
    assert!(reached.estimate.high <= 0.03 && reached.samples > 1, "{reached:?}");
    let frame = session.frame().expect("a picture").clone();
    assert_eq!((frame.samples, frame.number), (reached.samples, session.number()));
    assert!(session.log().iter().any(|line| line.starts_with("reached: error 0.")));
    // Against many samples of another kind: what is shown is as near as promised, or nearer, as the
    // display's curve has slopes of up to 13 only where it is dark.
    let mut reference = play(
        "size 48 27\nopen landscape:5000\nmode occlusion\nwait 1024\npicture b.png\n",
        &folder,
    );
    let linear = |name: &str| {
        let (_, rgba) = picture_of(&folder.path(name));
        rgba.iter().map(|b| f64::from(srgb_to_linear(f32::from(*b) / 255.0))).collect::<Vec<_>>()
    };
    let (a, b) = (linear("a.png"), linear("b.png"));
    let squares: f64 = a.iter().zip(&b).map(|(a, b)| (a - b).powi(2)).sum();
    let error = (squares / a.len() as f64).sqrt();
    assert!(error < 0.035 && error > 1e-4, "{error}");
    // More samples than the error needed, an error that takes too long, and one that is given up.
    apply(&mut session, &[&format!("wait {}", reached.samples + 1)]);
    assert!(session.goal().is_none());
    apply(&mut session, &["until 0.000001 0.2"]);
    common::until(&mut session, |session| !session.is_aiming());
    assert_eq!(session.reached().map(|reached| reached.outcome), Some(Outcome::OutOfTime));
    apply(&mut session, &["until 0.000001 3600", "until off", "wait 1"]);
    assert!(session.apply(&Action::Until(None)).is_err());
    apply(&mut session, &["show difference scalar"]);
    assert!(session.apply(&"until 0.1 1".parse().expect("a goal")).is_err());
    session.close();
    reference.close();
}

/// The frames of a moving picture, each of which is shown for one part of a second in `rate`.
fn frames_of(path: &Path, rate: u16) -> Vec<Vec<u8>> {
    let file = std::io::BufReader::new(std::fs::File::open(path).expect("it is written"));
    let mut reader = png::Decoder::new(file).read_info().expect("PNG");
    let control = *reader.info().animation_control().expect("it moves");
    (0..control.num_frames)
        .map(|_| {
            let mut bytes = vec![0; reader.output_buffer_size().expect("a small picture")];
            reader.next_frame(&mut bytes).expect("a frame");
            let shown = reader.info().frame_control().expect("it is one of several");
            assert_eq!((shown.delay_num, shown.delay_den), (1, rate), "{}", path.display());
            bytes
        })
        .collect()
}

#[test]
fn animations_are_their_pictures() {
    let folder = Folder::new("animation");
    let script = "size 40 24\nopen head:16\nadd head:17\nadd head:18\nsave-view a\norbit 90 0\n\
                  save-view b\nanimate turntable 4 1 turn\nanimate views 3 1 way\nanimate steps 1 time\n\
                  record own 10\npicture x.png\nsize 41 24\npicture y.png\nrecord end\nrecord end\n\
                  record none 5\nrecord end\n";
    let session = play(script, &folder);
    let log = session.log().join("\n");
    assert_eq!(session.errors(), 3, "{log}");
    assert!(log.contains("the pictures of the film have 40 x 24 pixels"), "{log}");
    assert!(
        log.contains("no film is recorded") && log.contains("the film has no picture"),
        "{log}"
    );
    assert_eq!(session.steps().1, 0, "the step is the one of before");
    for (name, count, rate) in [("turn", 4, 25), ("way", 3, 25), ("time", 3, 8)] {
        let frames = frames_of(&folder.path(&format!("{name}.png")), rate);
        assert_eq!(frames.len(), count, "{name}");
        for (i, frame) in frames.iter().enumerate() {
            let one = picture_of(&folder.path(&format!("{name}-{i:04}.png"))).1;
            assert!(*frame == one, "{name} {i}");
            let next = &frames[(i + 1) % count];
            assert!(frame != next, "{name}: something moves");
        }
    }
    // The way begins and ends at the cameras that were kept: the second is a quarter of a turn away.
    let picture = |name: &str| picture_of(&folder.path(name)).1;
    let others = |a: &str, b: &str| {
        let (a, b) = (picture(a), picture(b));
        a.iter().zip(&b).filter(|(a, b)| a.abs_diff(**b) > 2).count() as f32 / a.len() as f32
    };
    // Cameras that are turned there differ by rounding.
    for (a, b) in [("way-0002.png", "turn-0000.png"), ("way-0000.png", "turn-0003.png")] {
        assert!(others(a, b) < 0.02, "{a} and {b}: {}", others(a, b));
    }
    assert!(others("way-0000.png", "way-0002.png") > 0.1);
    assert_eq!(frames_of(&folder.path("own.png"), 10).len(), 1);
    assert_eq!(picture_of(&folder.path("y.png")).0, (41, 24), "it is no picture of the film");
    let refused = play("animate views 5 1 a\nopen head:16\nanimate views 5 1 a", &folder);
    assert_eq!(refused.errors(), 2, "{:#?}", refused.log());
}

#[test]
fn an_animation_leaves_a_film_alone_and_can_be_given_up() {
    let folder = Folder::new("given-up");
    let script = "size 40 24\nopen head:16\nadd head:17\nrecord own 10\nwait 1\npicture a.png\n\
                  animate turntable 3 1 turn\nrecord end\n";
    let mut session = play(script, &folder);
    let log = session.log().join("\n");
    assert_eq!(session.errors(), 1, "{log}");
    assert!(log.contains("animate turntable 3 1 turn: a film is recorded"), "{log}");
    assert_eq!(frames_of(&folder.path("own.png"), 10).len(), 1);
    assert!(!folder.path("turn.png").exists());
    let before = session.look().pose;
    for (line, name, rate) in
        [("animate turntable 9 1 half", "half", 25), ("animate steps 1 some", "some", 8)]
    {
        let mut player = Player::of(line.parse().expect(line));
        // Until it has two pictures, or the first of two steps: then it is given up.
        let most = if name == "half" { 2 } else { 1 };
        while session.recorded().unwrap_or(0) < most {
            assert_eq!(player.step(&mut session), Next::Waits, "{:#?}", session.log());
            session.poll();
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        player.cancel(&mut session);
        common::until(&mut session, |session| session.progress().is_none());
        session.finish_files();
        assert_eq!(frames_of(&folder.path(&format!("{name}.png")), rate).len(), most);
        assert_eq!((session.look().pose, session.steps().1), (before, 0));
    }
    Player::of("animate steps 1 none".parse().expect("an animation")).cancel(&mut session);
    assert_eq!(session.errors(), 1, "one that has not begun: {:#?}", session.log());
    for (line, is_free) in [
        ("orbit 1 0", false),
        ("size 5 5", false),
        ("picture a", false),
        ("panel log on", true),
        ("cancel", true),
        ("quit", true),
    ] {
        assert_eq!(Player::leaves_room_for(&line.parse().expect(line)), is_free, "{line}");
    }
}

/// The middle of an item's button in the world.
fn middle(menu: &Menu, label: &str) -> Vec3 {
    let found = menu.items().iter().position(|item| item.label == label);
    let button = menu.buttons()[found.unwrap_or_else(|| panic!("no {label}"))];
    (button.v0 + button.v1 + button.v2 + button.v3) * 0.25
}

#[test]
fn a_wand_chooses_from_the_menu() {
    let folder = Folder::new("menu");
    let mut session = play("size 160 90\nopen landscape:3000\nmenu on\nwait 1", &folder);
    let menu = session.menu().expect("it is open");
    // Two modes, five variants, and three others.
    assert_eq!(menu.items().len(), 10);
    // The mouse's wand: what it points at is what is seen in the pixel, by brute force.
    let pose = session.look().pose;
    let inside = |at: Vec2| {
        let inside = |button: &raydsl_viewer::Button| {
            let corner = |v: Vec3| pose.seen((160, 90), v).expect("before the camera");
            let [low, high] = [corner(button.v0), corner(button.v2)];
            at.cmpgt(low).all() && at.cmplt(high).all()
        };
        session.menu().expect("open").buttons().iter().position(inside)
    };
    let mut expected = Vec::new();
    for i in 0..40u16 {
        let at = vec2(f32::from(i % 8) * 19.7 + 3.3, f32::from(i / 8) * 17.3 + 4.1);
        expected.push((at, inside(at)));
    }
    assert!(expected.iter().filter(|(_, found)| found.is_some()).count() > 5);
    for (at, found) in expected {
        session.apply(&Action::Wand(Wand::Pixel(at))).expect("it is open");
        assert_eq!(session.menu().and_then(|menu| menu.pointed()), found, "{at}");
    }
    // By the mouse.
    let at = pose.seen((160, 90), middle(&menu, "occlusion")).expect("before the camera");
    apply(&mut session, &[&format!("wand pixel {} {}", at.x, at.y), "press", "wait 1"]);
    assert_eq!(session.look().mode, Mode::Occlusion);
    assert!(session.log().contains(&"chose occlusion".to_owned()));
    // By a tracked device, from the side.
    let (hand, there) = (pose.eye + vec3(1.0, 0.2, -0.5), middle(&menu, "cost"));
    let back = (hand - there).normalize();
    let side = back.any_orthonormal_vector();
    let frame = Mat4::from_cols(
        side.extend(0.0),
        back.cross(side).extend(0.0),
        back.extend(0.0),
        hand.extend(1.0),
    );
    session.apply(&Action::Wand(Wand::Tracked(frame))).expect("a frame");
    apply(&mut session, &["press"]);
    assert_eq!(session.look().show, Show::Cost);
    // Beside every item.
    apply(&mut session, &["wand pixel 1 1"]);
    let error = session.apply(&Action::Press).expect_err("nothing is there");
    assert_eq!(error, "the wand points at no item");
    // It follows the head.
    apply(&mut session, &["orbit 35 10", "show picture"]);
    let pose = session.look().pose;
    let moved = session.menu().expect("open");
    let seen = pose.seen((160, 90), middle(&moved, "occlusion")).expect("before the camera");
    assert!((seen - at).length() < 0.05, "{seen} {at}");
}

#[test]
fn a_menu_is_in_the_picture() {
    let folder = Folder::new("menu-picture");
    let script = "size 160 90\nopen landscape:3000\nwait 2\npicture a.png\nmenu on\npicture b.png\n\
                  wand pixel 30 60\npicture c.png\nmenu off\npicture d.png\n";
    let session = play(script, &folder);
    assert_eq!(session.errors(), 0, "{:#?}", session.log());
    let picture = |name: &str| picture_of(&folder.path(name)).1;
    let [a, b, c, d] = ["a.png", "b.png", "c.png", "d.png"].map(picture);
    let differ = |a: &[u8], b: &[u8]| a.chunks(4).zip(b.chunks(4)).filter(|(a, b)| a != b).count();
    assert!(a == d && differ(&a, &b) > 160 * 90 / 5, "{}", differ(&a, &b));
    // The beam, and the item that is pointed at.
    assert!(differ(&b, &c) > 50, "{}", differ(&b, &c));
    let is_beam = |p: &&[u8]| p[0] > 200 && p[1] < 160 && p[2] < 100;
    assert!(c.chunks(4).filter(is_beam).count() > 10 + b.chunks(4).filter(is_beam).count());
}
