//! The real window under Xvfb, driven by the mouse and the keys of xdotool. `.ci/more` runs these
//! tests.

#[expect(dead_code, reason = "code of several tests")]
mod common;

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use common::{Folder, picture_of};

/// A display without a screen, ended with the value.
struct Display {
    server: Child,
    name: String,
}

impl Display {
    fn new() -> Self {
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", "1280x800x24", "-nolisten", "tcp"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("Xvfb is installed");
        let mut number = String::new();
        let output = server.stdout.take().expect("it is piped");
        BufReader::new(output).read_line(&mut number).expect("Xvfb names its display");
        Self { server, name: format!(":{}", number.trim()) }
    }

    /// Runs xdotool with words of one line, and returns what it prints.
    fn tool(&self, words: &str) -> String {
        let mut command = Command::new("xdotool");
        command.env("DISPLAY", &self.name).args(words.split_whitespace());
        let output = command.output().expect("xdotool is installed");
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "xdotool {words}: {error}");
        String::from_utf8_lossy(&output.stdout).trim().to_owned()
    }

    fn viewer(&self, arguments: &[&str], folder: &Folder) -> Child {
        Command::new(env!("CARGO_BIN_EXE_raydsl-viewer"))
            .env("DISPLAY", &self.name)
            // No desktop: its portal is not asked for files, but `zenity` of the folder, if it is there.
            .env("DBUS_SESSION_BUS_ADDRESS", "unix:path=/nonexistent")
            .env("PATH", format!("{}:{}", folder.path("bin").display(), path()))
            .args(arguments)
            .arg("--out")
            .arg(folder.path(""))
            .stdout(Stdio::null())
            .spawn()
            .expect("the viewer starts")
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

fn path() -> String {
    std::env::var("PATH").unwrap_or_default()
}

fn pause(seconds: f64) {
    std::thread::sleep(Duration::from_secs_f64(seconds));
}

/// Waits until a file is there, and is not written any more.
fn wait_for(path: &Path) {
    let start = Instant::now();
    while image::open(path).is_err() {
        assert!(start.elapsed() < Duration::from_secs(30), "{} is not written", path.display());
        pause(0.1);
    }
}

fn end_of(mut viewer: Child) -> bool {
    let start = Instant::now();
    while start.elapsed() < Duration::from_secs(20) {
        if let Some(status) = viewer.try_wait().expect("it is a child") {
            return status.success();
        }
        pause(0.1);
    }
    let _ = viewer.kill();
    panic!("the viewer does not end");
}

#[test]
#[ignore = "needs Xvfb and xdotool: .ci/more runs it"]
fn mouse_and_keys_do_what_the_panel_says() {
    let (display, folder) = (Display::new(), Folder::new("window"));
    let viewer = display.viewer(&["landscape:100000"], &folder);
    let window = display.tool("search --sync --onlyvisible --name raydsl");
    display.tool(&format!("windowfocus {window}"));
    // The picture is right of the panels.
    display.tool("mousemove 800 400");
    pause(3.0);
    display.tool("key p");
    wait_for(&folder.path("picture-1.png"));
    display.tool("key F12");
    wait_for(&folder.path("window-2.png"));
    display.tool("mousedown 1");
    for i in 0..10 {
        display.tool(&format!("mousemove {} {}", 800 + 20 * i, 400 + 4 * i));
        pause(0.03);
    }
    display.tool("mouseup 1");
    display.tool("click --repeat 4 --delay 50 4");
    display.tool("mousemove 800 400");
    pause(1.5);
    display.tool("key p");
    wait_for(&folder.path("picture-3.png"));
    display.tool("mousemove 800 420 click 1");
    display.tool("key m");
    display.tool("key 5");
    display.tool("keydown w");
    pause(0.4);
    display.tool("keyup w");
    pause(2.0);
    display.tool("key F1");
    pause(0.7);
    display.tool("key F12");
    wait_for(&folder.path("window-4.png"));
    for size in ["60 40", "1 1", "900 600"] {
        display.tool(&format!("windowsize {window} {size}"));
        pause(1.0);
    }
    display.tool("key F12");
    wait_for(&folder.path("window-5.png"));
    // Escape leaves a text field, not the program.
    display.tool("key Escape");
    pause(0.5);
    display.tool("key ctrl+q");
    let is_well = end_of(viewer);
    let log = std::fs::read_to_string(folder.path("log.txt")).expect("a log");
    assert!(is_well, "{log}");
    for part in ["orbit ", "zoom ", "fly ", "picked ", "mode occlusion", "variant wgsl"] {
        assert!(log.lines().any(|line| line.starts_with(part)), "{part}: {log}");
    }
    look_at(&folder, &log);
}

/// Returns where a picture is in a window, somewhere between its panels: how far from the left, and
/// which share of its pixels is another there.
fn place_of(picture: &Path, window: &Path) -> (u32, f64) {
    let (size, picture) = picture_of(picture);
    let ((width, _), window) = picture_of(window);
    let differ = |left: u32, step: usize| {
        let pixel = |image: &[u8], width: u32, x: u32, y: u32| {
            let at = 4 * (y * width + x) as usize;
            [image[at], image[at + 1], image[at + 2]]
        };
        let (mut far, mut all) = (0, 0);
        for (x, y) in (0..size.1).step_by(step).flat_map(|y| (0..size.0).map(move |x| (x, y))) {
            let shown = pixel(&window, width, x + left, y);
            let file = pixel(&picture, size.0, x, y);
            far += u32::from((0..3).any(|i| shown[i].abs_diff(file[i]) > 16));
            all += 1;
        }
        f64::from(far) / f64::from(all)
    };
    let places = 0..=width - size.0;
    let place = places.min_by(|a, b| differ(*a, 90).total_cmp(&differ(*b, 90)));
    let place = place.expect("the window is wider");
    (place, differ(place, 1))
}

/// Waits until the log has a line that begins so, and returns the last of them.
fn line_of(folder: &Folder, begin: &str) -> String {
    let start = Instant::now();
    loop {
        let log = std::fs::read_to_string(folder.path("log.txt")).unwrap_or_default();
        if let Some(line) = log.lines().rev().find(|line| line.starts_with(begin)) {
            return line.to_owned();
        }
        assert!(start.elapsed() < Duration::from_secs(30), "no {begin}: {log}");
        pause(0.1);
    }
}

#[test]
#[ignore = "needs Xvfb and xdotool: .ci/more runs it"]
fn files_are_chosen_cuts_dragged_and_items_pressed() {
    let (display, folder) = (Display::new(), Folder::new("chosen"));
    // The program that is asked for files where there is no desktop.
    let dialog = folder.path("bin/zenity");
    std::fs::create_dir_all(folder.path("bin")).expect("a temporary folder");
    std::fs::write(&dialog, "#!/bin/sh\necho ropes:12\n").expect("a temporary folder");
    let run = std::os::unix::fs::PermissionsExt::from_mode(0o755);
    std::fs::set_permissions(&dialog, run).expect("it is ours");
    let viewer = display.viewer(&["head:24"], &folder);
    let window = display.tool("search --sync --onlyvisible --name raydsl");
    display.tool(&format!("windowfocus {window}"));
    display.tool("mousemove 700 400");
    line_of(&folder, "loaded head");
    display.tool("key o");
    line_of(&folder, "loaded ropes");
    display.tool("key b");
    line_of(&folder, "cut ball");
    pause(3.0);
    display.tool("key p");
    wait_for(&folder.path("picture-1.png"));
    display.tool("key F12");
    wait_for(&folder.path("window-2.png"));
    let (left, _) = place_of(&folder.path("picture-1.png"), &folder.path("window-2.png"));
    // A viewer without a window has the same camera, and tells where the handle is.
    let (width, height) = picture_of(&folder.path("picture-1.png")).0;
    let cut = line_of(&folder, "cut ball");
    let twin = common::play(&format!("size {width} {height}\nopen ropes:12\n{cut}"), &folder);
    let bounds = twin.info().expect("ropes").bounds;
    let place = bounds.min + twin.look().cuts[0].place() * bounds.size();
    let seen = twin.look().pose.seen((width, height), place).expect("before the camera");
    let (x, y) = (f64::from(seen.x), f64::from(height) - f64::from(seen.y));
    display.tool(&format!("mousemove {} {} mousedown 1", f64::from(left) + x, y));
    for i in 1..=10 {
        let (x, y) = (f64::from(left) + x - 8.0 * f64::from(i), y + 5.0 * f64::from(i));
        display.tool(&format!("mousemove {x} {y}"));
        pause(0.05);
    }
    display.tool("mouseup 1");
    let dragged = line_of(&folder, "cut drag 0 ");
    let to: Vec<f64> = dragged.split(' ').skip(3).filter_map(|word| word.parse().ok()).collect();
    let apart = (to[0] - (x - 80.0)).abs().max((to[1] - (f64::from(seen.y) - 50.0)).abs());
    assert!(apart < 10.0, "{dragged}, expected {} {}", x - 80.0, f64::from(seen.y) - 50.0);
    // The middle of the menu is the third of five variants.
    display.tool("key v");
    line_of(&folder, "menu on");
    display.tool(&format!("mousemove {} {}", left + width / 2 + 3, height / 2));
    line_of(&folder, "wand pixel");
    pause(0.5);
    display.tool("key F12");
    wait_for(&folder.path("window-3.png"));
    display.tool("click 1");
    line_of(&folder, "chose packet8");
    display.tool("key ctrl+q");
    assert!(end_of(viewer));
    let log = std::fs::read_to_string(folder.path("log.txt")).expect("a log");
    assert!(!log.contains("error: "), "{log}");
    assert!(!log.lines().any(|line| line.starts_with("orbit ")), "the handle was dragged: {log}");
}

/// Looks at the pixels of what was written.
fn look_at(folder: &Folder, log: &str) {
    let (_, before) = picture_of(&folder.path("picture-1.png"));
    let (_, after) = picture_of(&folder.path("picture-3.png"));
    let apart = before.iter().zip(&after).filter(|(a, b)| a.abs_diff(**b) > 20).count();
    assert!(apart * 10 > before.len(), "the drag turned the picture");
    let (_, differ) = place_of(&folder.path("picture-1.png"), &folder.path("window-2.png"));
    assert!(differ < 0.05, "{:.1} % of the pixels are others: {log}", 100.0 * differ);
    assert_eq!(picture_of(&folder.path("window-5.png")).0, (900, 600));
    let longest =
        log.lines().find_map(|line| line.strip_prefix("longest turn ")?.split(' ').next());
    let longest: f64 = longest.and_then(|ms| ms.parse().ok()).expect("it is in the log");
    println!("the longest turn of the window: {longest} ms");
    assert!(longest < 100.0, "{longest} ms");
}

#[test]
#[ignore = "needs Xvfb: .ci/more runs it"]
fn scripts_play_in_the_window_as_without_one() {
    let (display, folder, plain) = (Display::new(), Folder::new("played"), Folder::new("plain"));
    let script = "size 160 90\nopen head:64\ncut ball 0.65 0.75 0.7 0.35\nwait 4\npanel cuts on\n\
                  screenshot window.png\npicture a.png\n";
    std::fs::write(plain.path("script.txt"), script).expect("a temporary folder");
    let path = plain.path("script.txt");
    let path = path.to_str().expect("a plain path");
    let is_well = end_of(display.viewer(&["--window", "--script", path], &folder));
    let log = std::fs::read_to_string(folder.path("log.txt")).expect("a log");
    assert!(is_well, "{log}");
    let session = common::play(script.replace("screenshot", "picture").as_str(), &plain);
    assert_eq!(session.errors(), 0, "{:#?}", session.log());
    let (size, _) = picture_of(&folder.path("window.png"));
    assert!(size.0 > 1000, "all of the window: {size:?}");
    let bytes = |folder: &Folder| std::fs::read(folder.path("a.png")).expect("a picture");
    assert_eq!(picture_of(&folder.path("a.png")).0, (160, 90));
    assert!(bytes(&folder) == bytes(&plain), "the same bytes with a window and without");
}
