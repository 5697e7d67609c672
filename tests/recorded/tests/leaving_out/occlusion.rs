//! Ambient occlusion: a kernel that a program reduced, and the pictures that it must give.
//!
//! `cargo test --all-features --test leaving_out reduces_occlusion -- --ignored` makes
//! `by_hand/occlusion.wgsl` from the generated text if that is empty, and goes on with it otherwise.

use std::error::Error;
use std::io::{BufRead, BufReader, Write, stdin};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

use raydsl::prelude::*;
use raydsl_report::Program;
use raydsl_tests::gpu::{gpu, keeps_denormals};
use raydsl_tests::scenes::triangles;

use super::by_hand::with_numbers;
use super::reduce::reduce;
use super::scenes::{Face, open_sky};

/// What the reduced text begins with.
const HEADER: &str = "\
// Ambient occlusion of triangles by two rays, reduced by a program: the generated text without all that
// the pictures of its tests do not need (../occlusion.rs says which, ../reduce.rs how). Names are the
// generated ones.

";

/// Columns and rows: neither is a multiple of a workgroup's. One size, so that what is left of the last
/// picture is never that of the next.
const SIZE: (u32, u32) = (29, 19);

/// Triangles, and a view of them.
pub(super) struct Case {
    name: &'static str,
    pub(super) soup: Vec<Face>,
    pub(super) camera: Pinhole,
}

fn face([v0, v1, v2]: [Vec3; 3]) -> Face {
    Face { v0, v1, v2 }
}

/// A floor of squares under steps and leaning plates, as wide as 6.
fn steps() -> Vec<Face> {
    let mut all = Vec::new();
    let mut quad = |at: Vec3, u: Vec3, v: Vec3| {
        all.push(face([at, at + u, at + u + v]));
        all.push(face([at, at + u + v, at + v]));
    };
    for i in 0..6 {
        for k in 0..6 {
            quad(vec3(i as f32 - 3.0, 0.0, k as f32 - 3.0), Vec3::X, Vec3::Z);
        }
        let (x, h) = (i as f32 - 3.0, 0.25 * i as f32);
        quad(vec3(x, h, -1.0), Vec3::X, Vec3::Z);
        quad(vec3(x, 0.0, -1.0), Vec3::Y * h, Vec3::Z);
        quad(vec3(x, 0.0, 1.0), vec3(0.5, 0.3, 0.4), vec3(-0.2, 0.5, 0.1));
    }
    all
}

/// Moves and scales triangles.
fn placed(soup: &[Face], scale: f32, shift: Vec3) -> Vec<Face> {
    let place = |v: Vec3| v * scale + shift;
    soup.iter().map(|f| face([f.v0, f.v1, f.v2].map(place))).collect()
}

/// Triangles that are points, lines, needles, and one that is seen from its edge.
fn degenerate() -> Vec<Face> {
    let (a, b) = (vec3(-1.0, -1.0, 0.0), vec3(1.0, 1.0, 0.5));
    let middle = (a + b) * 0.5;
    let thin = vec3(1e-7, 0.0, 0.0);
    let mut all = vec![face([a; 3]), face([a, b, middle]), face([a, a, b]), face([b, a, a + thin])];
    all.push(face([Vec3::ZERO, Vec3::Z * 3.0, vec3(0.0, 1.0, 3.0)]));
    all.push(face([vec3(-1e18, -2.0, -1e18), vec3(1e18, -2.0, -1e18), vec3(0.0, -2.0, 1e18)]));
    all.push(face([vec3(-1.0, 0.0, 0.0), vec3(1.0, 1e-30, 0.0), vec3(0.0, 1.0, 1e-30)]));
    all.extend(placed(&steps(), 0.3, vec3(0.3, -1.5, 0.0)));
    all
}

/// What triangles have along a ray from `o` in the direction `d`.
type Along = fn(o: Vec3, d: Vec3) -> [Face; 2];

/// Triangles for each ray of a camera.
fn along_rays(camera: &Pinhole, make: Along) -> Vec<Face> {
    let frame = camera.begin_frame(SIZE.0, SIZE.1);
    let pixels = (0..SIZE.1).flat_map(|y| (0..SIZE.0).map(move |x| (x, y)));
    let ray = |(x, y): (u32, u32)| frame.primary_ray(x as f32 + 0.5, y as f32 + 0.5);
    pixels.map(ray).flat_map(|ray| make(ray.origin, ray.direction)).collect()
}

/// Two triangles that share an edge, which the ray runs along, but for rounding.
fn edges(o: Vec3, d: Vec3) -> [Face; 2] {
    let (a, b, side) = (o + d * 3.0, o + d * 5.0, d.cross(Vec3::Y));
    [face([a, b, o + d * 4.0 + side]), face([a, b, o + d * 4.5 - side * 1e-4])]
}

/// Two triangles that share a corner, which the ray meets, and a side.
fn corners(o: Vec3, d: Vec3) -> [Face; 2] {
    let (a, side) = (o + d * 4.0, d.cross(Vec3::Y) * 0.05);
    [face([a, a + side, a + Vec3::Y * 0.04]), face([a, a + Vec3::Y * 0.04, a - side])]
}

/// A triangle that is a line through the ray, and one so thin that it is nearly one.
fn lines(o: Vec3, d: Vec3) -> [Face; 2] {
    let (a, b) = (o + d * 4.0, o + d * 6.0);
    let (near, far) = (a - Vec3::X * 0.02, a + Vec3::X * 0.03);
    [face([near, a, far]), face([b - Vec3::X * 0.02, b, b + vec3(0.03, 1e-7, 0.0)])]
}

/// Two small triangles, which the ray meets in an edge and in a corner.
fn specks(o: Vec3, d: Vec3) -> [Face; 2] {
    let (a, side) = (o + d * 4.0, d.cross(Vec3::Y) * 1e-3);
    [face([a - side, a + side, a + Vec3::Y * 1e-3]), face([a, a + side, a - Vec3::Y * 1e-5])]
}

/// What must be the same: hits, misses, occluded and open rays; equal distances; triangles at all sizes
/// and distances that have a floating-point number; rays along axes; rays that are no rays.
pub(super) fn cases() -> Vec<Case> {
    let soup: Vec<Face> = triangles(900).iter().map(|t| face([t.v0, t.v1, t.v2])).collect();
    let nested =
        (-40..40).flat_map(|i| placed(&steps()[72..75], (0.5 * i as f32).exp2(), Vec3::ZERO));
    let look = |eye, at, angle| Pinhole::new(eye, at, Vec3::Y, angle);
    let (eye, middle) = (vec3(2.0, 3.0, 6.0), vec3(0.0, 0.3, 0.0));
    let far = vec3(3e5, -7e4, 1e5);
    let front = look(vec3(0.25, 0.5, 8.0), vec3(0.0, 0.0, 2.0), 0.8);
    let within = look(Vec3::ZERO, vec3(1.0, -0.25, 0.125), 1.6);
    let tiny = look(vec3(0.0, 0.0, 1e-3), Vec3::ZERO, 0.1);
    let case = |name, soup, camera| Case { name, soup, camera };
    vec![
        case("a soup", soup.clone(), look(vec3(0.5, 1.0, 11.0), Vec3::ZERO, 0.9)),
        case("steps", steps(), look(eye, middle, 0.8)),
        case("in the soup", soup.clone(), look(vec3(0.1, 0.2, 0.3), Vec3::X, 1.8)),
        case("steps along an axis", steps(), Pinhole::new(Vec3::Y * 9.0, Vec3::ZERO, Vec3::Z, 0.6)),
        case("steps from their edge", steps(), look(vec3(0.0, 0.5, 9.0), Vec3::Y * 0.5, 0.6)),
        case("nothing", Vec::new(), look(eye, middle, 0.8)),
        case("one triangle", steps()[..1].to_vec(), look(eye, vec3(-2.5, 0.0, -2.5), 0.2)),
        case("degenerate triangles", degenerate(), look(vec3(0.0, 0.5, 4.0), Vec3::ZERO, 0.9)),
        case("far away", placed(&steps(), 1.0, far), look(eye + far, middle + far, 0.8)),
        case("small", placed(&steps(), 1e-12, Vec3::ZERO), look(eye * 1e-12, middle * 1e-12, 0.8)),
        case("tiny", placed(&steps(), 1e-26, Vec3::ZERO), look(eye * 1e-26, middle * 1e-26, 0.8)),
        case("huge", placed(&steps(), 1e15, Vec3::ZERO), look(eye * 1e15, middle * 1e15, 0.8)),
        case("immense", placed(&steps(), 1e26, Vec3::ZERO), look(eye * 1e26, middle * 1e26, 0.8)),
        case("all sizes", nested.collect(), look(vec3(0.3, 0.5, 1.0), vec3(0.5, 0.1, 0.0), 1.2)),
        case("rays along edges", along_rays(&front, edges), front),
        case("rays through corners", along_rays(&front, corners), front),
        case("rays through corners from within", along_rays(&within, corners), within),
        case("rays through lines", along_rays(&front, lines), front),
        case("rays through specks", along_rays(&tiny, specks), tiny),
        case("a view of nowhere", steps(), look(eye, eye, 0.8)),
        case("a view from nowhere", steps(), look(vec3(f32::INFINITY, 0.0, 0.0), middle, 0.8)),
    ]
}

/// A picture's bits, by the generated text or by what is made of it.
type Bits = Vec<[u32; 4]>;

fn picture(case: &Case, text: &dyn Fn(&str) -> String) -> Result<Bits, Box<dyn Error>> {
    let gpu = gpu().ok_or("a device is needed")?;
    let bvh = Bvh::build(&case.soup)?;
    let kernel = kernel!(|ray: Ray, pixel: UVec2| open_sky(&bvh, ray, pixel));
    let mut image = Image::filled(SIZE.0, SIZE.1, Vec4::ZERO);
    gpu.frame_by_text(&case.camera, &kernel, &mut image, text)?;
    Ok(image.pixels().iter().map(|p| p.to_array().map(f32::to_bits)).collect())
}

/// Returns a text whose pictures are how many nodes and triangles each pixel reads.
fn counted(text: &str) -> String {
    let mut counted = "var<private> reads: u32;\n".to_owned();
    for line in text.lines() {
        counted += &format!("{line}\n");
        if ["fn bvh_at(", "fn bvh_nodes_at("].iter().any(|head| line.starts_with(head)) {
            counted += "reads = reads + 1u;\n";
        }
    }
    let (begin, _) = counted.rsplit_once("= StoredVec4(").expect("a pixel is stored at the end");
    format!("{begin}= StoredVec4(vec4<f32>(f32(reads)));\n}}\n")
}

fn reads(picture: &[[u32; 4]]) -> f64 {
    picture.iter().map(|pixel| f64::from(f32::from_bits(pixel[0]))).sum()
}

/// What the generated text gives, case by case. Reads are counted, since a kernel that visits all nodes has
/// the same pixels and fewer statements.
struct Judge {
    cases: Vec<(Case, Bits, f64)>,
}

impl Judge {
    fn new() -> Result<Self, Box<dyn Error>> {
        let known = |case: Case| {
            let bits = picture(&case, &str::to_owned)?;
            let count = reads(&picture(&case, &counted)?);
            Ok((case, bits, count))
        };
        Ok(Self { cases: cases().into_iter().map(known).collect::<Result<_, Box<dyn Error>>>()? })
    }

    /// Returns what is another, or takes more reads of nodes or triangles, by a text without numbers.
    fn fault(&self, text: &str) -> Result<Option<String>, Box<dyn Error>> {
        for (case, bits, _) in &self.cases {
            if picture(case, &|own| with_numbers(text, own))? != *bits {
                return Ok(Some(format!("{}: other pixels", case.name)));
            }
        }
        for (case, _, count) in &self.cases {
            let taken = reads(&picture(case, &|own| with_numbers(&counted(text), own))?);
            if taken > *count {
                return Ok(Some(format!("{}: {taken} reads, not {count}", case.name)));
            }
        }
        Ok(None)
    }
}

/// What the child begins its answers with.
const ANSWER: &str = "ANSWER ";

/// The child of `reduces_occlusion`: reads names of files, and says of each whether its text is as good.
#[test]
#[ignore = "the child of another test"]
fn judges() -> Result<(), Box<dyn Error>> {
    let judge = Judge::new()?;
    for name in stdin().lines() {
        let fault = judge.fault(&std::fs::read_to_string(name?)?);
        println!("\n{ANSWER}{}", matches!(fault, Ok(None)));
    }
    Ok(())
}

/// A process that judges: what is deleted may be what ends a loop, or what keeps an index in its range.
struct Process {
    child: Child,
    answers: Receiver<bool>,
}

impl Process {
    fn start() -> Result<Self, Box<dyn Error>> {
        let test = ["--exact", "occlusion::judges", "--ignored", "--nocapture"];
        let mut command = Command::new(std::env::current_exe()?);
        command.args(test).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null());
        let mut child = command.spawn()?;
        let (send, answers) = channel();
        let output = BufReader::new(child.stdout.take().ok_or("it has an output")?);
        std::thread::spawn(move || {
            for line in output.lines().map_while(Result::ok) {
                let Some(answer) = line.strip_prefix(ANSWER) else { continue };
                let _ = send.send(answer == "true");
            }
        });
        Ok(Self { child, answers })
    }

    /// Returns its answer; none if it ended or takes too long.
    fn ask(&mut self, file: &Path) -> Option<bool> {
        writeln!(self.child.stdin.as_mut()?, "{}", file.display()).ok()?;
        self.answers.recv_timeout(Duration::from_secs(30)).ok()
    }

    fn end(&mut self) -> Result<(), Box<dyn Error>> {
        self.child.kill()?;
        self.child.wait()?;
        Ok(())
    }
}

#[test]
#[ignore = "takes half an hour, and writes a file that is kept"]
fn reduces_occlusion() -> Result<(), Box<dyn Error>> {
    let candidate = std::env::temp_dir().join("raydsl_reduced.wgsl");
    let file =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/leaving_out/by_hand/occlusion.wgsl");
    let case = cases().remove(0);
    let bvh = Bvh::build(&case.soup)?;
    let kernel = kernel!(|ray: Ray, pixel: UVec2| open_sky(&bvh, ray, pixel));
    let text = kernel.record_frame(&case.camera, SIZE).module(&Default::default()).source;
    let (structs, rest) = text.split_once("struct Params {").ok_or("it has numbers")?;
    let (_, functions) = rest.split_once("}\n").ok_or("they end")?;
    let own = match std::fs::read_to_string(&file)? {
        begun if begun.is_empty() => format!("{structs}{functions}"),
        begun => begun,
    };
    // The end stays: it is the frame around every kernel.
    let (own, frame) = own.split_at(own.rfind("@group").ok_or("it has outputs")?);
    let (mut process, mut asked, mut accepted) = (Process::start()?, 0, 0);
    let mut is_same = |part: &str| {
        let whole = format!("{HEADER}{part}\n{frame}");
        if Program::read(&with_numbers(&whole, &text)).is_err() {
            return false;
        }
        std::fs::write(&candidate, &whole).expect("the folder can be written to");
        let answer = process.ask(&candidate);
        if answer.is_none() {
            process.end().expect("it was there");
            process = Process::start().expect("it starts again");
        }
        asked += 1;
        if answer == Some(true) {
            accepted += 1;
            std::fs::write(&file, &whole).expect("the folder can be written to");
        }
        let (answer, lines) = (answer.unwrap_or(false), whole.lines().count());
        eprintln!("{answer}: {accepted} of {asked}, {lines} lines");
        answer
    };
    reduce(own, &mut is_same);
    process.end()
}

/// Of drivers for CPUs alone: it was reduced by one, and leaves tests out that comparisons with NaN replace.
#[test]
fn the_reduced_kernel_is_as_good() -> Result<(), Box<dyn Error>> {
    if gpu().is_some_and(keeps_denormals) {
        assert_eq!(Judge::new()?.fault(include_str!("by_hand/occlusion.wgsl"))?, None);
    }
    Ok(())
}
