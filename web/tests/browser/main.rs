//! The page in headless Chromium, against the scalar variant of this machine.
//!
//! `cargo test --release -p raydsl-web --test browser -- --ignored --test-threads 1`. With
//! `RAYDSL_PICTURES=FOLDER` the picture of the book is written there.

mod chromium;
mod expected;

use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::PathBuf;

use chromium::{Browser, WebGpu};
use expected::{Expected, Seen};
use raydsl_web::Request;

/// Opens the page with a query and returns what it shows.
fn open(query: &str) -> Seen {
    Seen::of(&Browser::shared().open(&format!("?{query}"), WebGpu::SwiftShader))
}

/// Opens the page, compares its light with that of the scalar variant here and returns the share of
/// pixels whose light is another.
fn difference(name: &str, query: &str) -> (Seen, Expected, f64) {
    let request = Request::parse(query).expect("the query is one");
    let (seen, expected) = (open(query), Expected::of(&request));
    assert_eq!(seen.error, "", "{query}");
    assert!(seen.status.contains(&format!("{} samples", request.samples)), "{}", seen.status);
    assert_eq!(seen.light.len(), expected.light.len(), "{query}");
    let pixels = seen.light.chunks_exact(4).zip(expected.light.chunks_exact(4));
    let others = pixels.filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| a.to_bits() != b.to_bits()));
    let share = others.count() as f64 / (expected.light.len() / 4) as f64;
    println!("{name}: {}; {:.3} % of the pixels have another light", seen.status, 100.0 * share);
    (seen, expected, share)
}

/// Packets in WebAssembly have the bits of scalar code on this machine, and the canvas shows them.
#[test]
#[ignore = "needs Chromium"]
fn packets_have_the_bits_of_scalar_code() {
    for (name, query) in [
        ("landscape_packet4", "scene=landscape&detail=20000&variant=packet4"),
        ("landscape_packet16", "scene=landscape&detail=20000&variant=packet16"),
        ("head_packet8", "scene=head&detail=32&variant=packet8"),
        ("cornell_packet4", "scene=cornell&variant=packet4"),
        ("cornell_scalar", "scene=cornell&variant=scalar"),
    ] {
        let (seen, expected, share) =
            difference(name, &format!("{query}&size=96x64&samples=4&readback"));
        assert!(share == 0.0, "{name}: {share}");
        assert!(seen.shown == expected.shown, "{name}: the canvas shows something else");
        let isa = if name.contains("scalar") { "scalar" } else { "simd128" };
        assert!(seen.status.contains(isa), "{}", seen.status);
    }
}

/// WGSL by the browser's own compiler, drawn through a 2-D canvas.
#[test]
#[ignore = "needs Chromium"]
fn wgsl_agrees_with_scalar_code() {
    for (name, query) in [
        ("landscape_wgsl", "scene=landscape&detail=20000"),
        ("head_wgsl", "scene=head&detail=32"),
        ("cornell_wgsl", "scene=cornell"),
    ] {
        let (seen, expected, share) =
            difference(name, &format!("{query}&size=96x64&samples=4&readback"));
        assert!(seen.status.contains("WebGPU"), "{}", seen.status);
        assert!(share < 0.01, "{name}: {share}");
        let levels = seen.shown.iter().zip(&expected.shown).map(|(a, b)| a.abs_diff(*b));
        let others = levels.filter(|d| *d > 1).count();
        assert!((others as f64) < 0.01 * expected.shown.len() as f64, "{name}: {others} channels");
    }
}

/// The same where light stays on the device until the picture is done: the canvas cannot be read,
/// but every call of it is checked.
#[test]
#[ignore = "needs Chromium"]
fn a_presented_canvas_has_no_error() {
    let query = "scene=landscape&detail=20000&size=96x64&samples=4";
    let (seen, _, share) = difference("landscape_presented", query);
    assert!(share < 0.01, "{share}");
    assert!(seen.shown.is_empty(), "a presented canvas was read");
}

/// Pictures that nothing waits for, in buffers of the page.
#[test]
#[ignore = "needs Chromium"]
fn submitted_pictures_are_in_their_buffers() {
    for (name, query) in [
        ("landscape_submitted", "scene=landscape&detail=20000"),
        ("head_submitted", "scene=head&detail=32"),
    ] {
        let query = format!("{query}&size=96x64&samples=1&submit&readback");
        let (seen, expected, share) = difference(name, &query);
        assert!(share < 0.01, "{name}: {share}");
        assert_eq!(seen.shown.len(), expected.shown.len(), "{name}");
        assert!(expected.light.iter().any(|x| *x != expected.light[0]), "{name}: all is even");
    }
}

/// Their errors come with the next call, be it a picture that is awaited or submitted.
#[test]
#[ignore = "needs Chromium"]
fn errors_of_submitted_pictures_are_shown() {
    for flags in ["samples=1&fault=window", "submit&fault=window", "submit&fault=call"] {
        let seen = open(&format!("scene=cornell&size=16x16&readback&{flags}"));
        assert!(seen.error.contains("wgpu refused"), "{flags}: {:?}", seen.error);
        let is_destroyed = seen.error.contains("destroyed");
        assert_eq!(is_destroyed, flags.contains("window"), "{flags}: {:?}", seen.error);
        assert!(seen.light.is_empty(), "{flags}: there is a picture in spite of the error");
    }
}

#[test]
#[ignore = "needs Chromium"]
fn errors_of_validation_are_shown() {
    let small = "scene=cornell&size=16x16&samples=1&readback";
    let seen = open(&format!("{small}&fault=shader"));
    assert!(seen.error.contains("the WGSL is invalid at line 8"), "{:?}", seen.error);
    assert!(seen.error.contains("no_such_function"), "{:?}", seen.error);
    assert!(seen.light.is_empty(), "there is a picture in spite of the error");

    let seen = open(&format!("{small}&fault=call"));
    assert!(seen.error.contains("wgpu refused"), "{:?}", seen.error);
    assert!(seen.error.contains("MapRead") || seen.error.contains("usage"), "{:?}", seen.error);
}

#[test]
#[ignore = "needs Chromium"]
fn a_query_that_cannot_be_shown_is_refused() {
    let seen = open("scene=teapot");
    assert_eq!(seen.error, "?scene=teapot: choose landscape, head or cornell");
}

/// A report with another id, as of a page that was open before, is none of this page.
#[test]
#[ignore = "needs Chromium"]
fn reports_of_other_pages_are_left_out() {
    let browser = Browser::shared();
    let address = browser.url.trim_start_matches("http://").trim_end_matches('/');
    let mut stream = TcpStream::connect(address).expect("the server is there");
    let other = "POST /report/other HTTP/1.1\r\nContent-Length: 5\r\n\r\nother";
    stream.write_all(other.as_bytes()).expect("the server listens");
    let mut answer = String::new();
    stream.read_to_string(&mut answer).expect("the server answers");
    assert!(answer.starts_with("HTTP/1.1 200 "), "{answer}");
    let seen = Seen::of(&browser.open("?scene=teapot", WebGpu::None));
    assert!(seen.error.contains("teapot"), "{:?}", seen.error);
}

/// Anything can be thrown.
#[test]
#[ignore = "needs Chromium"]
fn what_is_thrown_is_never_shown_as_nothing() {
    let script = r#"<script type="module">
        import { detail } from "./detail.js";
        const { proxy, revoke } = Proxy.revocable({}, {});
        revoke();
        const thrown = [
            new Error("a message"), "a text", new DOMException("of the browser", "AbortError"),
            new TypeError(""), new Error("  "), undefined, null, "", 0, {}, { message: {} },
            Symbol("symbol"), Object.create(null), { get message() { throw 1; } }, proxy,
        ];
        const id = new URLSearchParams(location.search).get("report");
        const body = JSON.stringify(thrown.map(detail));
        await fetch(`/report/${id}`, { method: "POST", body });
    </script>"#;
    let browser = Browser::shared();
    browser.alter("thrown", "index.html", script);
    let report = browser.open("thrown/index.html?", WebGpu::None);
    let texts: Vec<String> = serde_json::from_slice(&report).expect("texts");
    let (said, unsaid) = texts.split_at(3);
    assert_eq!(said, ["a message", "a text", "of the browser"]);
    assert_eq!(unsaid.len(), 12);
    for text in unsaid {
        assert!(text.starts_with("it failed without a message"), "{text:?}");
    }
}

/// Whatever goes wrong with a worker, and with the page itself, the page says so.
#[test]
#[ignore = "needs Chromium"]
fn a_worker_that_fails_is_never_a_page_that_waits() {
    let browser = Browser::shared();
    for (name, worker, error) in [
        ("nothing", "throw undefined;", "undefined"),
        ("syntax", "}", "the worker cannot be loaded"),
        ("missing", "import './gone.js';", "the worker cannot be loaded"),
        ("empty", "postMessage({ name: 'failed' });", "it failed without a message"),
        ("unknown", "postMessage({ name: 'sung' });", "not a function"),
        ("malformed", "postMessage({ name: 'shown', value: { samples: 1 } });", "toFixed"),
    ] {
        browser.alter(name, "worker.js", worker);
        let page = format!("{name}/index.html?scene=cornell");
        let seen = Seen::of(&browser.open(&page, WebGpu::None));
        assert!(seen.error.contains(error), "{name}: {:?}", seen.error);
        assert_eq!(seen.status, "Failed", "{name}");
    }
}

/// Without WebGPU the page says so, and packets still run.
#[test]
#[ignore = "needs Chromium"]
fn a_browser_without_webgpu_is_told_what_to_do() {
    let small = "?scene=cornell&size=16x16&samples=1";
    let browser = Browser::shared();
    let seen = Seen::of(&browser.open(small, WebGpu::None));
    assert!(seen.error.contains("no GPU adapter"), "{:?}", seen.error);
    assert!(seen.error.contains("a browser with WebGPU"), "{:?}", seen.error);
    let seen = Seen::of(&browser.open(&format!("{small}&variant=packet4"), WebGpu::None));
    assert_eq!(seen.error, "");
    assert_eq!(seen.light.len(), 4 * 16 * 16);
}

/// The picture of the book: three canvases side by side.
#[test]
#[ignore = "needs Chromium"]
fn canvases_have_pictures() {
    let size = (300, 240);
    let queries = [
        "scene=landscape&samples=16",
        "scene=head&samples=4",
        "scene=cornell&variant=packet4&samples=64",
    ];
    let canvases = queries.map(|query| {
        let seen = open(&format!("{query}&size={}x{}&readback", size.0, size.1));
        assert_eq!(seen.error, "", "{query}");
        println!("{}", seen.status);
        let canvas = image::RgbaImage::from_raw(size.0, size.1, seen.shown);
        canvas.unwrap_or_else(|| panic!("{query}: the canvas has another size"))
    });
    for (canvas, query) in canvases.iter().zip(queries) {
        let levels = canvas.pixels().map(|pixel| u64::from(pixel.0[1]));
        let mean = levels.sum::<u64>() / u64::from(size.0 * size.1);
        assert!((20..220).contains(&mean), "{query}: {mean}");
    }
    let Some(folder) = std::env::var_os("RAYDSL_PICTURES") else { return };
    let mut all = image::RgbaImage::new(3 * size.0, size.1);
    for (canvas, i) in canvases.iter().zip(0i64..) {
        image::imageops::replace(&mut all, canvas, i * i64::from(size.0), 0);
    }
    let path = PathBuf::from(folder).join("in_the_browser.png");
    all.save(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
}
