//! Runs that are cut short: a message, the films so far, and the same picture in the end.

use std::process::Stdio;
use std::time::{Duration, Instant};

use crate::common::{
    Folder, alone, command, command_to, end_of, has_mpirun, kill, process_of_mpirun, run, said,
    succeed, wait_for, wait_for_rank, wait_for_the_end,
};

/// A film that takes some seconds, with films so far after each second.
const FILM: &str = "--scene cornell --size 160x120 --samples 1024 --tile 32";

#[test]
fn a_film_goes_on_after_a_death() {
    if !has_mpirun() {
        return;
    }
    let _alone = alone();
    let whole = Folder::new("uninterrupted");
    succeed(&whole, &format!("{FILM} --ranks 1"));

    for dead in [1, 0] {
        let out = Folder::new("death");
        let mut started = command(&out, &format!("{FILM} --ranks 3 --every 0"));
        let child = started.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
        let child = child.expect("the program starts");
        wait_for(&out.path("film.parts"));
        kill(wait_for_rank(dead, &out));
        let output = end_of(child, "a rank was killed");
        let said_then = said(&output);
        assert!(!output.status.success(), "rank {dead}: {said_then}");
        for words in ["a rank died", "film.parts", "--resume"] {
            assert!(said_then.contains(words), "rank {dead}: {words} in {said_then}");
        }
        assert!(!out.path("film.pfm").exists(), "rank {dead}: the film was not whole");

        // Without --resume the films so far are not overwritten.
        let refused = run(&out, &format!("{FILM} --ranks 2"));
        assert!(!refused.status.success() && said(&refused).contains("--resume"));

        let output = run(&out, &format!("{FILM} --ranks 2 --resume"));
        assert!(output.status.success(), "{}", said(&output));
        assert!(out.read("film.pfm") == whole.read("film.pfm"), "rank {dead}");
        let rendered: u64 = out.report().ranks.iter().map(|rank| rank.samples).sum();
        assert!(rendered < 160 * 120 * 1024, "what was there was not rendered again");
        assert!(!out.path("film.parts").exists());
    }
}

#[test]
fn films_so_far_that_are_of_no_use_are_refused() {
    if !has_mpirun() {
        return;
    }
    let _alone = alone();
    let out = Folder::new("refused");
    let words = "--size 16x16 --samples 64 --ranks 2 --resume";
    std::fs::write(out.path("film.parts"), b"raydsl film parts 1\nshort").expect("a folder");
    let output = run(&out, words);
    let text = said(&output);
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert!(text.contains("film.parts") && text.contains("remove it"), "{text}");
    std::fs::remove_file(out.path("film.parts")).expect("it is there");
    // Without films so far it begins anew.
    succeed(&out, words);
}

#[test]
fn frames_go_on_after_a_death() {
    if !has_mpirun() {
        return;
    }
    let _alone = alone();
    let words = "--scene points --points 30000 --size 300x200 --frames 12";
    let whole = Folder::new("uninterrupted-frames");
    succeed(&whole, &format!("{words} --ranks 1"));
    let out = Folder::new("frames");
    let mut started = command(&out, &format!("{words} --ranks 3"));
    let child = started.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
    let child = child.expect("the program starts");
    wait_for(&out.path("frame_0001.pfm"));
    kill(wait_for_rank(2, &out));
    let output = end_of(child, "a rank was killed");
    assert!(!output.status.success() && said(&output).contains("--resume"), "{}", said(&output));
    assert!(!out.path("frame_0011.pfm").exists(), "it was cut short");
    succeed(&out, &format!("{words} --ranks 2 --resume"));
    assert!(out.report().frames < 12);
    for frame in 0..12 {
        let name = format!("frame_{frame:04}.pfm");
        assert!(out.read(&name) == whole.read(&name), "{name}");
    }
    let other =
        run(&out, "--scene points --points 30001 --size 300x200 --frames 12 --ranks 2 --resume");
    assert_eq!(other.status.code(), Some(2), "{}", said(&other));
    assert!(said(&other).contains("another run"), "{}", said(&other));
    // Frames stay where nothing says what they are.
    std::fs::remove_file(out.path("frames.txt")).expect("it is there");
    let unknown = run(&out, &format!("{words} --ranks 2 --resume"));
    assert_eq!(unknown.status.code(), Some(2), "{}", said(&unknown));
    assert!(said(&unknown).contains("frames.txt is missing"), "{}", said(&unknown));
    assert!(out.path("frame_0011.pfm").exists());
}

/// The longest from a fault to the end of all processes.
const SOON: Duration = Duration::from_secs(60);

/// Runs that would take days. The first prints nothing for hours: it cannot notice by writing that
/// nobody reads.
const LONG: [&str; 2] = [
    "--scene cornell --size 640x480 --samples 60000000 --tile 4096 --blocks 131072",
    "--scene points --points 30000 --size 3000x3000 --frames 9999",
];

/// A panic of a thread that renders ends its rank and the others, which would wait for long.
#[test]
fn a_panic_ends_the_run() {
    if !has_mpirun() {
        return;
    }
    let _alone = alone();
    for (words, rank) in LONG.iter().flat_map(|words| [(words, 0), (words, 2)]) {
        let out = Folder::new("panic");
        let begin = Instant::now();
        let output = run(&out, &format!("{words} --ranks 3 --panics {rank}"));
        let text = said(&output);
        assert_eq!(output.status.code(), Some(2), "{words}, rank {rank}: {text}");
        assert!(begin.elapsed() < SOON, "{words}, rank {rank}: {text}");
        for part in ["as --panics asks for", "a rank died", "101", "--resume"] {
            assert!(text.contains(part), "{words}, rank {rank}: {part} in {text}");
        }
        wait_for_the_end(&out, SOON);
    }
}

/// Nobody waits for ranks whose launcher is gone: they end, and so does `mpirun`; or they end with
/// `mpirun`, and the launcher tells so.
#[test]
fn ranks_end_with_their_launcher() {
    if !has_mpirun() {
        return;
    }
    let _alone = alone();
    for words in LONG {
        let out = Folder::new("launcher");
        let mut started = command(&out, &format!("{words} --ranks 3"));
        let child = started.stdout(Stdio::null()).stderr(Stdio::null()).spawn();
        let mut child = child.expect("the program starts");
        for rank in 0..3 {
            wait_for_rank(rank, &out);
        }
        child.kill().expect("it runs");
        child.wait().expect("it was killed");
        wait_for_the_end(&out, SOON);

        let child = command(&out, &format!("{words} --ranks 3")).stderr(Stdio::piped()).spawn();
        let child = child.expect("the program starts");
        for rank in 0..3 {
            wait_for_rank(rank, &out);
        }
        kill(process_of_mpirun(&out));
        let output = end_of(child, "mpirun was killed");
        assert_eq!(output.status.code(), Some(2), "{}", said(&output));
        wait_for_the_end(&out, SOON);
    }
}

#[test]
fn folders_need_not_be_utf_8() {
    use std::os::unix::ffi::OsStrExt;

    if !has_mpirun() {
        return;
    }
    let _alone = alone();
    let out = Folder::new("utf");
    let inner = out.path("").join(std::ffi::OsStr::from_bytes(b"\xff pictures"));
    let words = "--size 16x16 --samples 64 --ranks 2";
    let run = |resume: &[&str]| {
        let mut started = command_to(&inner, words);
        started.args(resume);
        let child = started.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
        end_of(child.expect("the program starts"), words)
    };
    let output = run(&[]);
    assert!(output.status.success(), "{}", said(&output));
    assert!(inner.join("film.pfm").exists());
    // It is named in messages, too.
    std::fs::write(inner.join("film.parts"), b"no parts").expect("a folder");
    let refused = run(&["--resume"]);
    assert_eq!(refused.status.code(), Some(2), "{}", said(&refused));
    assert!(said(&refused).contains("pictures/film.parts"), "{}", said(&refused));
}

#[test]
fn few_points_are_few_parts() {
    if !has_mpirun() {
        return;
    }
    let _alone = alone();
    let out = Folder::new("few");
    let words = "--scene points --size 30x20 --frames 1 --ranks 2";
    // The second rank has nothing.
    succeed(&out, &format!("{words} --points 1 --parts 1"));
    let output = run(&out, &format!("{words} --points 3 --parts 9"));
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    assert!(said(&output).contains("--parts"), "{}", said(&output));
}

#[test]
fn wrong_arguments_are_refused() {
    let out = Folder::new("arguments");
    for words in [
        "--ranks 0",
        "--ranks -1",
        "--size 0x10",
        "--samples 0",
        "--tile 7",
        "--parts 0",
        "--scene nothing",
        "--least nan",
        "--least 1",
        "--blocks 0",
        "--blocks 3",
        "--blocks 2097152",
    ] {
        let output = run(&out, words);
        assert_eq!(output.status.code(), Some(2), "{words}: {}", said(&output));
        if words.starts_with("--blocks") {
            assert!(said(&output).contains("write a power of two"), "{}", said(&output));
        }
    }
    if has_mpirun() {
        let _alone = alone();
        let output = run(&out, "--scene volume --voxels 3 --parts 9 --ranks 2");
        assert_eq!(output.status.code(), Some(2), "{}", said(&output));
        assert!(said(&output).contains("--parts"), "{}", said(&output));
    }
}
