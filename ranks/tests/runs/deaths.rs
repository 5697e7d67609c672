//! Runs that are cut short: a message, the films so far, and the same picture in the end.

use std::process::{Command, Stdio};
use std::time::Duration;

use crate::common::{
    Folder, alone, command, end_of, has_mpirun, kill, process_of_rank, run, said, succeed, wait_for,
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
        kill(process_of_rank(dead, &out));
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
    kill(process_of_rank(2, &out));
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
}

/// Tells this test that it is a rank of itself.
const IS_RANK: &str = "RAYDSL_RANKS_TEST_OF_PANICS";

/// A panic of a thread ends its rank, and the others, which would wait for long.
#[test]
fn a_panic_ends_the_run() {
    if std::env::var_os(IS_RANK).is_some() {
        raydsl_ranks::run::end_by_panics();
        if std::env::var("OMPI_COMM_WORLD_RANK").is_ok_and(|rank| rank == "1") {
            let _ = std::thread::spawn(|| panic!("as this test asks for")).join();
            std::process::exit(0);
        }
        std::thread::sleep(Duration::from_secs(3600));
    }
    if !has_mpirun() {
        return;
    }
    let _alone = alone();
    let mut mpirun = Command::new("mpirun");
    mpirun.args(["--allow-run-as-root", "--oversubscribe", "-n", "2"]);
    mpirun.arg(std::env::current_exe().expect("a program"));
    mpirun.args(["--exact", "deaths::a_panic_ends_the_run", "--nocapture"]).env(IS_RANK, "1");
    let child = mpirun.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
    let output = end_of(child.expect("mpirun starts"), "a rank panics");
    assert_eq!(output.status.code(), Some(101), "{}", said(&output));
    assert!(said(&output).contains("as this test asks for"), "{}", said(&output));
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
    ] {
        let output = run(&out, words);
        assert_eq!(output.status.code(), Some(2), "{words}: {}", said(&output));
    }
    if has_mpirun() {
        let _alone = alone();
        let output = run(&out, "--scene volume --voxels 3 --parts 9 --ranks 2");
        assert_eq!(output.status.code(), Some(2), "{}", said(&output));
        assert!(said(&output).contains("--parts"), "{}", said(&output));
    }
}
