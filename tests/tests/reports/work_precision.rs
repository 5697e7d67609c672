//! Error against run time: measurements whose outcome is known.

use std::cell::Cell;
use std::collections::HashMap;
use std::error::Error;
use std::time::Duration;

use raydsl::prelude::*;
use raydsl_report::Missing;
use raydsl_report::work_precision::*;

const SCALAR: Backend = Backend::Variant(Variant::Scalar);

/// Settings that need no device and end soon.
fn quick() -> WorkPrecision<'static> {
    WorkPrecision::new().backends(&[SCALAR]).repetitions(3).size(2, 2)
}

/// The integral of exp over the unit interval.
const EXACT: f64 = core::f64::consts::E - 1.0;

/// It by a rule of quadrature that takes exp at this share of each step.
fn rule(run: &Run<'_>) -> Estimates {
    let n = f64::from(run.knob());
    let share = if run.method().name() == "left" { 0.0 } else { 0.5 };
    let sum: f64 = (0..run.knob()).map(|i| ((f64::from(i) + share) / n).exp()).sum();
    Estimates::new(vec![sum / n], u64::from(run.knob()))
}

fn quadrature(name: &str) -> Case<'static> {
    Case::new(name, Reference::closed_form(EXACT), |run| Ok(rule(run)))
        .knob("steps")
        .method("left", Some(Order::near(-1.0, 0.02)))
        .method("middle", Some(Order::near(-2.0, 0.02)))
}

/// What a number of the run gives, for each of four pixels.
fn case(name: &str, number: impl Fn(&Run<'_>) -> f64 + 'static) -> Case<'static> {
    let estimates = move |run: &Run<'_>| Estimates::new(vec![number(run); 4], 1);
    Case::new(name, Reference::closed_form(1.0), move |run| Ok(estimates(run)))
        .method(SampleMethod::Random, Some(Order::RANDOM))
}

/// The error falls as n^-1 down to a floor.
fn with_floor(uncertainty: f64) -> Case<'static> {
    let reference = Reference::quadrature([1.0], uncertainty);
    Case::new("floor", reference, |run| {
        let error = (1.0 / f64::from(run.knob())).max(1e-3);
        Ok(Estimates::new(vec![1.0 + error], 1))
    })
    .method("rule", Some(Order::near(-1.0, 0.02)))
}

#[test]
fn rules_of_quadrature_have_their_orders() -> Result<(), Box<dyn Error>> {
    let report = quick().knobs(&[4, 8, 16, 32, 64]).run(&[quadrature("exp")])?;
    let [left, middle] = &report.cases[0].curves[..] else { panic!("two curves") };
    for (curve, order) in [(left, -1.0), (middle, -2.0)] {
        let fit = curve.fit.ok_or("five points")?;
        assert!((fit.order - order).abs() < 0.02, "{fit:?}");
        // Repetitions of what has no random numbers say nothing new.
        assert_eq!(fit.points, 5);
        assert_eq!(curve.verdict(), Verdict::AsExpected);
    }
    // The error of the midpoint rule is about e^x / 24 n^2 in the mean, 4.7e-3 for n = 4.
    assert!(matches!(middle.time_to_error(1e-2), Reached::AtMost(_)));
    assert!(matches!(middle.time_to_error(1e-3), Reached::At(_)));
    assert_eq!(middle.time_to_error(1e-6), Reached::Never);
    Ok(())
}

/// Cases have values of their own; a family has a table, whose least number is 1 where one curve is the
/// quickest of all.
#[test]
fn families_have_a_table_to_choose_by() -> Result<(), Box<dyn Error>> {
    let slow = |name: &str, until: u32| {
        Case::new(name, Reference::closed_form(1.0), move |run: &Run<'_>| {
            let is_slow = run.method().name() == "slow";
            std::thread::sleep(Duration::from_millis(if is_slow { 20 } else { 1 }));
            let is_good = run.knob() >= until && run.method().name() != "bad";
            Ok(Estimates::new(vec![if is_good { 1.0 + 1e-6 } else { 1.5 }], u64::from(run.knob())))
        })
        .values(&[1, 2, 3])
        .family("sleepers")
        .method("slow", None)
        .method("swift", None)
        .method("bad", None)
    };
    let cases = [slow("first", 2), slow("never", 9), slow("at-once", 1), quadrature("exp")];
    let report = quick().run(&cases)?;
    assert_eq!(report.families(), ["sleepers"]);
    let knobs = |i: usize| report.cases[i].curves[0].points.iter().map(|p| p.knob);
    assert!(knobs(0).eq(1..=3) && knobs(3).eq([16, 64, 256, 1024, 4096]));
    let text = report.choice("sleepers");
    assert!(text.starts_with("sleepers: first, never, at-once\n\nerror 1e-2; 1 is "), "{text}");
    assert!(text.contains(" s, in 2 of 3 cases\n"), "{text}");
    let row = |name: &str| {
        let line = text.lines().find(|l| l.starts_with(name)).unwrap_or_default();
        line[name.len()..].trim().trim_start_matches('<').to_owned()
    };
    assert_eq!((row("swift").as_str(), row("bad").as_str()), ("1.0", "-"), "{text}");
    let ratio: f64 = row("slow").parse()?;
    assert!((2.0..40.0).contains(&ratio), "{text}");
    // Values that are asked for are those of all cases, and wrong ones of a case are refused.
    let asked = quick().knobs(&[5]).run(&[slow("first", 2)])?;
    assert_eq!(asked.cases[0].curves[0].points[0].knob, 5);
    let wrong = quick().run(&[slow("first", 2).values(&[3, 3])]);
    assert!(matches!(wrong, Err(WorkPrecisionError::Knob { value: 3 })), "{wrong:?}");
    Ok(())
}

#[test]
fn what_is_below_a_floor_is_not_fitted() -> Result<(), Box<dyn Error>> {
    let knobs: Vec<u32> = (2..14).map(|i| 1 << i).collect();
    let verdict = |uncertainty| {
        let report = quick().knobs(&knobs).run(&[with_floor(uncertainty)]);
        report.map(|r| (r.cases[0].curves[0].clone(), r.omissions()))
    };
    let (curve, left_out) = verdict(1e-3)?;
    assert_eq!((curve.verdict(), curve.fit.ok_or("a fit")?.points), (Verdict::AsExpected, 8));
    assert_eq!(curve.points[11].status(), Status::Floor);
    assert!(left_out.contains("spp = 1024, 2048"), "{left_out}");
    assert_eq!(verdict(0.0)?.0.verdict(), Verdict::TooSlow);
    Ok(())
}

/// A method that diverges, one that has no device, one that takes too long: each has its rows.
#[test]
fn nothing_is_missing() -> Result<(), Box<dyn Error>> {
    let bad = case("bad", |run| if run.knob() > 16 { f64::NAN } else { 1.5 });
    let inf = case("infinite", |_| f64::INFINITY);
    let nowhere = Case::new("nowhere", Reference::closed_form(1.0), |_| {
        Err(Missing::NoDevice("no device, \"none\"\nat all".to_owned()))
    });
    let slow = case("slow", |run| {
        std::thread::sleep(Duration::from_millis(5 * u64::from(run.knob())));
        1.1
    });
    let cases = [bad, inf, nowhere.method("m,n", None), slow];
    let report = quick().knobs(&[4, 16, 64]).time(Duration::from_millis(110)).run(&cases)?;
    let verdicts: Vec<Verdict> = report.cases.iter().map(|c| c.curves[0].verdict()).collect();
    let [diverged, not_run] = [Verdict::Diverged, Verdict::NotRun];
    assert_eq!(verdicts[..3], [diverged, diverged, not_run]);
    let slow: Vec<Status> = report.cases[3].curves[0].points.iter().map(Point::status).collect();
    assert_eq!(slow[2], Status::Budget, "{slow:?}");
    let (csv, table, left_out) = (report.csv(), report.table(), report.omissions());
    for word in [",diverged", ",budget", "\"omitted: no device, \"\"none\"\"\"", "\"m,n\""] {
        assert!(csv.contains(word), "{word}\n{csv}");
    }
    assert!(table.contains("diverged") && table.contains("no device"), "{table}");
    for word in ["the time was up", "no finite numbers", "no device, \"none\" at all"] {
        assert!(left_out.contains(word), "{left_out}");
    }
    for case in &report.cases {
        let svg = case.plot().svg();
        assert!(!svg.contains("NaN") && !svg.contains("inf,"), "{svg}");
    }
    Ok(())
}

/// The cells of a line of CSV.
fn cells(line: &str) -> usize {
    let mut is_quoted = false;
    let commas = line.chars().filter(|c| {
        is_quoted ^= *c == '"';
        *c == ',' && !is_quoted
    });
    commas.count() + 1
}

#[test]
fn shapes_of_files() -> Result<(), Box<dyn Error>> {
    let long = "a name, quite \"long\" <&> that goes on and on and on and on and on and on and on";
    let absent = Case::new("absent", Reference::closed_form(1.0), |_| {
        Err(Missing::Refused("no".repeat(200)))
    });
    let cases = [quadrature("exp"), quadrature(long), absent.method("none", None)];
    let why = "there is no file,\nnone";
    let folder = std::env::temp_dir().join(format!("raydsl-report-{}", std::process::id()));
    let report = quick().knobs(&[4, 8, 16, 32]).omit("a | file", why).run(&cases)?;
    let plots = report.write(&folder)?;
    let read = |name: &str| std::fs::read_to_string(folder.join(name));
    let (csv, json) = (read("points.csv")?, read("report.json")?);
    let header = csv.lines().next().map_or(0, cells);
    assert!(csv.lines().all(|l| cells(l) == header), "{csv}");
    let columns = if cfg!(feature = "flip") { 67 } else { 61 };
    // Two cases of two methods with four points of three runs each, one that was not run, and one
    // that was left out.
    assert_eq!((csv.lines().count(), header), (1 + 2 * 2 * 4 * 3 + 1 + 1, columns));
    assert!(csv.ends_with(",\"omitted: there is no file,\"\n"), "{csv}");
    let json: serde_json::Value = serde_json::from_str(&json)?;
    let curve = &json["cases"][0]["curves"][1];
    assert_eq!(
        (curve["method"].as_str(), curve["verdict"].as_str()),
        (Some("middle"), Some("expected"))
    );
    assert_eq!(curve["points"].as_array().map(Vec::len), Some(4));
    assert_eq!(curve["points"][0]["repetitions"].as_array().map(Vec::len), Some(3));
    let order = curve["order"].as_f64().ok_or("an order")?;
    assert!((order + 2.0).abs() < 0.02, "{order}");
    assert_eq!(json["cases"][2]["curves"][0]["points"][0]["rmse"].as_str(), Some("NaN"));
    for table in [read("table.txt")?, read("errors.txt")?] {
        assert!(table.lines().all(|l| l.chars().count() <= 100), "{table}");
        assert!(table.contains("nono") && table.contains("middle"), "{table}");
    }
    let left_out = read("omissions.md")?;
    let row = "| a \\| file | all | all | the case | there is no file, none |";
    assert!(left_out.contains("nono") && left_out.contains(row), "{left_out}");
    assert_eq!(json["omitted"], serde_json::json!([["a | file", why]]));
    assert_eq!(plots.len(), 3);
    for plot in plots {
        let svg = std::fs::read_to_string(plot.with_extension("svg"))?;
        assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n") && !svg.contains("<&>"));
        #[cfg(feature = "gpu")]
        assert_eq!(&std::fs::read(plot.with_extension("png"))?[1..4], b"PNG");
    }
    std::fs::remove_dir_all(&folder)?;
    let file = std::env::temp_dir().join(format!("raydsl-file-{}", std::process::id()));
    std::fs::write(&file, "in the way")?;
    let refused = report.write(&file);
    std::fs::remove_file(&file)?;
    assert!(matches!(refused, Err(WorkPrecisionError::File { .. })), "{refused:?}");
    Ok(())
}

#[test]
fn bad_input_is_refused() {
    use WorkPrecisionError as E;
    let one = || [case("one", |_| 1.0)];
    let error = |settings: WorkPrecision<'_>, cases: &[Case<'_>]| match settings.run(cases) {
        Ok(_) => panic!("accepted"),
        Err(e) => e,
    };
    assert!(matches!(error(quick(), &[]), E::Nothing { what: "case" }));
    assert!(matches!(error(quick().knobs(&[]), &one()), E::Nothing { .. }));
    assert!(matches!(error(quick().backends(&[]), &one()), E::Nothing { what: "backend" }));
    assert!(matches!(error(quick().methods(&["none"]), &one()), E::Nothing { .. }));
    for knobs in [&[0, 1][..], &[4, 4], &[8, 4], &[1, MAX_KNOB + 1]] {
        assert!(matches!(error(quick().knobs(knobs), &one()), E::Knob { .. }), "{knobs:?}");
    }
    assert!(matches!(error(quick().size(0, 5), &one()), E::Size { .. }));
    assert!(matches!(error(quick().size(u32::MAX, u32::MAX), &one()), E::Size { .. }));
    let twice = [case("one", |_| 1.0), case("one", |_| 1.0)];
    assert!(matches!(error(quick(), &twice), E::Name { .. }));
    assert!(matches!(error(quick(), &[case("", |_| 1.0)]), E::Name { .. }));
    let with = |reference| {
        let case = Case::new("c", reference, |_| Ok(Estimates::new(vec![1.0; 4], 1)));
        error(quick(), &[case.method("m", None)])
    };
    assert!(matches!(with(Reference::closed_form(f64::NAN)), E::Reference { index: 0, .. }));
    assert!(matches!(with(Reference::quadrature([], 0.0)), E::Nothing { .. }));
    assert!(matches!(with(Reference::quadrature([1.0], -1.0)), E::Uncertainty { .. }));
    assert!(matches!(with(Reference::f64([1.0], f64::NAN)), E::Uncertainty { .. }));
    assert!(matches!(with(Reference::f64([1.0; 3], 0.0)), E::Length { found: 4, expected: 3, .. }));
    assert!(matches!(with(Reference::halves([1.0; 4], [1.0; 3])), E::Length { .. }));
    assert!(matches!(with(Reference::halves([1.0; 4], [f64::INFINITY; 4])), E::Reference { .. }));
}

/// A knob of steps takes no more samples; what takes none takes one.
#[test]
fn samples_need_not_be_the_knob() -> Result<(), Box<dyn Error>> {
    let method = Method::from("left");
    let run = Run::new(&method, SCALAR, 64).sized(3, 2);
    let samples = |run: Run<'_>| {
        let found = run.integral(&kernel!(|_ray: Ray| 1.0));
        found.map(|found| found.samples).map_err(|missing| missing.to_string())
    };
    assert_eq!((samples(run)?, samples(run.with_samples(5))?), (6 * 64, 6 * 5));
    assert_eq!(samples(run.with_samples(0))?, 6);
    let one = |_| Work { rays: Some(1), ..Work::default() };
    assert_eq!(run.with_samples(5).integral_work(one).rays, Some(30));
    Ok(())
}

/// A floor far below all errors is told in words, a near one is drawn, and an exact reference has
/// none.
#[test]
fn no_floor_is_passed_over() -> Result<(), Box<dyn Error>> {
    let texts = |uncertainty: f64| {
        let reference = Reference::quadrature([1.0], uncertainty);
        let case = Case::new("c", reference, |_| Ok(Estimates::new(vec![1.01], 1)));
        let report = quick().knobs(&[4]).run(&[case.method("m", None)])?;
        Ok::<_, WorkPrecisionError>(report.cases[0].plot().svg())
    };
    let far = texts(1e-5)?;
    let note = ">f32 floor: 1.2e-7, below the picture; reference floor: 1.0e-5, below the picture<";
    assert!(far.contains(note), "{far}");
    let near = texts(1e-3)?;
    assert!(near.contains(">f32 floor: 1.2e-7, below the picture<"), "{near}");
    assert!(near.contains(">reference floor<"), "{near}");
    assert!(!texts(0.0)?.contains("reference floor"));
    Ok(())
}

/// The optical depth of a ramp by the left rule, with as many steps as the knob says, counted in
/// green.
#[test]
fn a_kernel_counts_its_steps_on_every_backend() -> Result<(), Box<dyn Error>> {
    let march = |run: &Run<'_>| {
        let steps = run.knob();
        let camera = Orthographic::new(Vec3::Z, Vec3::ZERO, Vec3::Y, 1.0);
        run.film_counted(
            &camera,
            &kernel!(|_ray: Ray| {
                let mut depth = 0.0;
                let mut count: u32 = 0;
                while count < steps {
                    depth += count as f32 / (steps as f32 * steps as f32);
                    count += 1;
                }
                vec3(depth, count as f32, 0.0)
            }),
        )
    };
    let case = Case::new("ramp", Reference::closed_form(0.5), march).method("left", None);
    let backends: Vec<Backend> = Backend::ALL.to_vec();
    let report = WorkPrecision::new().backends(&backends).knobs(&[3, 12]).size(3, 3).repetitions(2);
    let report = report.run(&[case])?;
    let curves = &report.cases[0].curves;
    for curve in curves {
        let runs = curve.points.iter().flat_map(|p| &p.repetitions);
        if !raydsl::testing::can_run(Variant::Wgsl, "work_precision") && curve.missing.is_some() {
            continue;
        }
        for (run, steps) in runs.zip([3u64, 3, 12, 12]) {
            // Each of nine pixels takes `steps` samples of as many steps.
            assert_eq!(run.counted, Some(9 * steps * steps), "{}", curve.backend.name());
            let exact = 0.5 - 0.5 / steps as f64;
            assert!(run.values.iter().all(|v| (v - exact).abs() < 1e-6), "{:?}", run.values);
        }
    }
    assert!(report.cases[0].plot().svg().contains(">counted in all<"));
    let rounding = curves[0].points[1].rounding.ok_or("f64 was run")?;
    assert!(rounding > 0.0 && rounding < 1e-7, "{rounding}");
    assert_eq!(curves[5].points[1].rounding, None);
    Ok(())
}

#[primitive(sphere(center, radius))]
struct Ball {
    center: Vec3,
    radius: f32,
}

/// Balls above the square that the camera sees, some before others.
fn balls() -> Vec<Ball> {
    let ball = |i: u16| {
        let (x, y) = (f32::from(i % 8), f32::from(i / 8 % 8));
        let center = vec3(0.25 * x - 0.9, 0.25 * y - 0.9, 0.1 * f32::from(i % 5));
        Ball { center, radius: 0.05 + 0.02 * f32::from(i % 3) }
    };
    (0..128).map(ball).collect()
}

fn above() -> Orthographic {
    Orthographic::new(vec3(0.0, 0.0, 4.0), Vec3::ZERO, Vec3::Y, 2.0)
}

/// What is counted on the host is what a kernel counts for the same samples.
#[test]
fn work_is_that_of_the_samples_of_a_run() -> Result<(), Box<dyn Error>> {
    let balls = balls();
    let tree = Bvh::build(&balls)?;
    let lens = ThinLens::new(Pinhole::new(vec3(0.0, 0.0, 4.0), Vec3::ZERO, Vec3::Y, 0.5), 0.1, 4.0);
    for sampling in [SampleMethod::Random, SampleMethod::Stratified, SampleMethod::Sobol] {
        let method = Method::from(sampling);
        let run = Run::new(&method, SCALAR, 9).sized(5, 4).seeded(3);
        let total = |found: Result<Estimates, Missing>| {
            let found = found.unwrap_or_else(|missing| panic!("{missing}"));
            (9.0 * found.values.iter().sum::<f64>()).round() as u64
        };
        let nodes = kernel!(|ray: Ray| {
            let (_, cost) = tree.closest_hit_with_cost(ray);
            cost.nodes as f32
        });
        let tested = kernel!(|ray: Ray| {
            let (_, cost) = tree.closest_hit_with_cost(ray);
            cost.primitives as f32
        });
        let count = |ray, _| Work::from(tree.closest_hit_with_cost(ray).1);
        let (flat, deep) = (run.film_work(&above(), count), run.film_work(&lens, count));
        assert_eq!(flat.rays, Some(5 * 4 * 9));
        assert_eq!(flat.nodes, Some(total(run.film(&above(), &nodes))));
        assert_eq!(flat.primitives, Some(total(run.film(&above(), &tested))));
        assert_eq!(deep.nodes, Some(total(run.film(&lens, &nodes))));
        assert_ne!(deep.nodes, flat.nodes, "a lens needs numbers of its own");
        // Of an integral the numbers alone say what is done: a look-up where the first is large.
        let looks = kernel!(|_ray: Ray, sampler: Sampler| {
            let mut sampler = sampler;
            if sampler.next_2d().x > 0.7 { 1.0 } else { 0.0 }
        });
        let looked = run.integral_work(|mut sampler| {
            let is_large = sampler.next_2d().x > 0.7;
            Work { texture_fetches: Some(u64::from(is_large)), ..Work::default() }
        });
        assert_eq!(looked.texture_fetches, Some(total(run.integral(&looks))));
        assert_eq!((looked.rays, looked.texture_fetches > Some(9)), (None, true));
    }
    Ok(())
}

/// The cells of a line of CSV by their column's name; for text without commas in cells.
fn row(csv: &str, line: usize) -> HashMap<&str, &str> {
    let mut lines = csv.lines();
    let header = lines.next().unwrap_or_default().split(',');
    header.zip(lines.nth(line).unwrap_or_default().split(',')).collect()
}

#[test]
fn what_is_counted_apart_is_in_the_files() -> Result<(), Box<dyn Error>> {
    let balls = balls();
    let tree = Bvh::build(&balls)?;
    let calls = Cell::new(0);
    let covered = |run: &Run<'_>| {
        let kernel = kernel!(|ray: Ray, sampler: Sampler| {
            let mut sampler = sampler;
            let shift = 0.01 * sampler.next_2d().x;
            if tree.any_hit(Ray { t_max: 9.0 + shift, ..ray }) { 1.0 } else { 0.0 }
        });
        run.film(&above(), &kernel)
    };
    let case = Case::new("covered", Reference::closed_form(0.5), covered)
        .method(SampleMethod::Random, Some(Order::RANDOM))
        .method(SampleMethod::Sobol, None)
        .counted(|run| {
            calls.set(calls.get() + 1);
            run.film_work(&above(), |ray, _| tree.any_hit_with_cost(ray).1.into())
        })
        .built_in(Duration::from_millis(125));
    let backends = [SCALAR, Backend::Variant(Variant::Packet8)];
    let settings = quick().backends(&backends).knobs(&[2, 8, 32]).repetitions(4).size(4, 4);
    let report = settings.commit("abc-dirty").run(&[case])?;
    assert_eq!(calls.get(), 2 * 3, "once for each method and value of the knob");
    let measured = &report.cases[0];
    let [random, packets, sobol, _] = &measured.curves[..] else { panic!("four curves") };
    let work = |curve: &Curve, i: usize| curve.points[i].work();
    assert_eq!(work(random, 2).rays, Some(16 * 32));
    assert!(work(random, 2).nodes > work(random, 1).nodes && work(random, 0).primitives > Some(0));
    assert_eq!(work(random, 1), work(packets, 1));
    assert_ne!(work(random, 1), work(sobol, 1));
    // The kernel is the same; the film's sampling has the method.
    assert!(random.code.is_some() && random.code == packets.code && random.code == sobol.code);
    assert!(random.first_run > Some(0.0));
    // Of the first curve the point of 32 samples is in rows 8 to 11.
    let csv = report.csv();
    let cells = row(&csv, 8);
    let number = |name: &str| cells[name].parse::<f64>().unwrap_or(f64::NAN);
    assert_eq!((cells["method"], cells["knob_value"], cells["repetitions"]), ("random", "32", "4"));
    assert_eq!(cells["nodes"], work(random, 2).nodes.unwrap_or(0).to_string());
    assert_eq!(
        (cells["rays"], cells["texture_fetches"], cells["commit"]),
        ("512", "", "abc-dirty")
    );
    assert_eq!((cells["t_build"], cells["status"]), ("1.25e-1", "ok"));
    assert_eq!(cells["code"], format!("{:016x}", random.code.unwrap_or(0)));
    assert_eq!((number("expected_low"), number("expected_high")), (-0.55, -0.45));
    let rising = ["t_min", "t_p10", "t_median", "t_p90"].map(number);
    assert!(rising.windows(2).all(|t| 0.0 < t[0] && t[0] <= t[1]), "{rising:?}");
    // No upper bound: other tests run in this process.
    assert!(number("cpu_s") >= 0.0, "{cells:?}");
    assert_eq!(number("t_compile"), 0.0);
    let rising = ["efficiency_low", "efficiency", "efficiency_high"].map(number);
    assert!(rising.windows(2).all(|e| 0.0 < e[0] && e[0] < e[1]), "{rising:?}");
    assert!(number("rmse_p10") <= number("rmse_p90") && number("mrse") > 0.0);
    let rising = ["error_low", "error", "error_high"].map(number);
    assert!(rising.windows(2).all(|e| 0.0 < e[0] && e[0] < e[1]), "{rising:?}");
    assert_eq!(number("mse").sqrt(), number("rmse"));
    assert_eq!((cells["gpu"], cells["driver"]), ("", ""), "no curve is of a device");
    let json = report.json();
    let point = &json["cases"][0]["curves"][0]["points"][2];
    assert_eq!(point["work"]["nodes"].as_u64(), work(random, 2).nodes);
    assert!(point["work"]["texture_fetches"].is_null());
    assert_eq!(point["efficiency"]["value"].as_f64(), Some(number("efficiency")));
    assert_eq!(json["environment"]["commit"].as_str(), Some("abc-dirty"));
    assert_eq!(json["cases"][0]["curves"][0]["t_compile"].as_f64(), Some(0.0));
    let runs = point["repetitions"].as_array().ok_or("four runs")?;
    let sum: f64 = runs.iter().filter_map(|r| r["cpu_s"].as_f64()).sum();
    let all = point["cpu_s"].as_f64().ok_or("a clock")?;
    assert!(runs.len() == 4 && (all - sum).abs() <= 1e-12 * sum, "{all} {sum}");
    assert_eq!(json["cases"][0]["t_build"].as_f64(), Some(0.125));
    let left_out = report.omissions();
    assert!(left_out.contains("| texture fetches | the case does not count them |"), "{left_out}");
    let svg = measured.plot().svg();
    assert!(svg.contains(">tests of nodes and primitives in all<"), "{svg}");
    Ok(())
}

/// What a picture of balls looks like against one that has converged: the more samples, the more
/// alike. An integral is no picture.
#[cfg(feature = "flip")]
#[test]
fn pictures_are_compared_by_flip() -> Result<(), Box<dyn Error>> {
    let balls = balls();
    let tree = Bvh::build(&balls)?;
    let lit = |run: &Run<'_>| {
        run.film(&above(), &kernel!(|ray: Ray| if tree.any_hit(ray) { 4.0 } else { 0.5 }))
    };
    let method = Method::from(SampleMethod::Sobol);
    let half = |seed| {
        let run = Run::new(&method, Backend::Variant(Variant::widest()), 1024).sized(24, 24);
        lit(&run.seeded(seed)).map(|e| e.values).map_err(|missing| missing.to_string())
    };
    let case = Case::new("balls", Reference::halves(half(90)?, half(91)?), lit)
        .method(SampleMethod::Sobol, None);
    let report = quick().size(24, 24).knobs(&[1, 16, 256]);
    let report = report.run(&[case, quadrature("exp")])?;
    let curve = &report.cases[0].curves[0];
    let first = |p: &Point| p.repetitions[0].flip.zip(p.repetitions[0].hdr_flip);
    let found: Vec<_> = curve.points.iter().filter_map(first).collect();
    assert_eq!(found.len(), 3);
    for pair in found.windows(2) {
        assert!(pair[1].0.mean < 0.5 * pair[0].0.mean, "LDR {found:?}");
        assert!(pair[1].1.mean < 0.5 * pair[0].1.mean, "HDR {found:?}");
    }
    let (csv, json, errors) = (report.csv(), report.json(), report.errors());
    let (mean, hdr) = (found[0].0.mean, found[0].1.p95);
    assert_eq!(row(&csv, 0)["flip_mean"].parse(), Ok(mean));
    assert_eq!(row(&csv, 0)["hdr_flip_p95"].parse(), Ok(hdr));
    assert_eq!(row(&csv, 9)["flip_mean"], "");
    let of_case = |i: usize| &json["cases"][i]["curves"][0]["points"][0]["repetitions"][0];
    assert_eq!(of_case(0)["flip"]["mean"].as_f64(), Some(mean));
    assert!(of_case(1)["flip"].is_null());
    assert_eq!(errors.lines().filter(|l| l.contains("hdr_flip ")).count(), 2, "{errors}");
    let left_out = report.omissions();
    assert!(left_out.contains("| exp | all | all | FLIP | the estimates are no picture |"));
    assert!(!left_out.contains("| balls | all | all | FLIP |"), "{left_out}");
    Ok(())
}

/// A pipeline is made once, in the run before all others; the CPU has none.
#[test]
fn compilation_is_timed_apart() -> Result<(), Box<dyn Error>> {
    if !raydsl::testing::can_run(Variant::Wgsl, "work_precision") {
        return Ok(());
    }
    // Not the one of all tests, which may compile meanwhile.
    let gpu = &raydsl::gpu::GpuScheduler::new()?;
    let kernel = |run: &Run<'_>| {
        let seed = 77.25 + run.seed() as f32;
        run.integral(&kernel!(|_ray: Ray| seed - 76.25))
    };
    let case = Case::new("one", Reference::closed_form(1.0), kernel);
    let case = case.method("first", None).method("again", None);
    let backends = [SCALAR, Backend::Variant(Variant::Wgsl)];
    let report = quick().backends(&backends).gpu(gpu).knobs(&[2]).run(&[case])?;
    let [scalar, first, _, again] = &report.cases[0].curves[..] else { panic!("four curves") };
    assert_eq!((scalar.compile, again.compile), (Some(0.0), Some(0.0)));
    assert!(first.compile > Some(0.0) && first.compile < first.first_run, "{:?}", first.compile);
    Ok(())
}

/// A method without random numbers has no variance, and a closure no WGSL: that is said.
#[test]
fn what_is_not_known_is_not_made_up() -> Result<(), Box<dyn Error>> {
    let report = quick().knobs(&[4, 8]).run(&[quadrature("exp")])?;
    let curve = &report.cases[0].curves[0];
    assert_eq!((curve.code, curve.points[0].efficiency()), (None, None));
    let (csv, left_out, errors) = (report.csv(), report.omissions(), report.errors());
    let cells = row(&csv, 0);
    for name in ["code", "efficiency", "nodes", "primitive_tests", "rays", "t_build", "rounding"] {
        assert_eq!(cells[name], "", "{name}");
    }
    assert_eq!(cells["commit"], "unknown");
    for word in ["the efficiency at steps = 4, 8", "rays, nodes, primitive tests", "| FLIP |"] {
        assert!(left_out.contains(word), "{word}\n{left_out}");
    }
    for (name, formula) in FORMULAS {
        let start = formula.split(' ').next().unwrap_or_default();
        let line = errors.lines().find(|l| l.starts_with(&format!("{name} ")));
        assert!(line.is_some_and(|l| l.contains(start)), "{name}\n{errors}");
    }
    assert!(errors.lines().any(|l| l.starts_with("left") && l.ends_with('-')), "{errors}");
    Ok(())
}

/// Five runs with errors of 1 to 5 hundredths: the symbol is at 3, the bar goes from 1.4 to 4.6.
#[test]
fn bars_go_from_the_tenth_to_the_ninetieth() -> Result<(), Box<dyn Error>> {
    let off = case("off", |run| {
        let turned = (run.seed() * 3) % 5;
        1.0 + 0.01 * f64::from(turned + 1)
    });
    let report = quick().knobs(&[4]).repetitions(5).run(&[off])?;
    let plot = report.cases[0].plot();
    let at = plot.marks.iter().filter_map(|m| match m {
        Mark::Symbol { at, radius, .. } if *radius < 5.0 => Some(*at),
        _ => None,
    });
    let symbols: Vec<(f64, f64)> = at.collect();
    assert_eq!(symbols.len(), 2, "one in each panel");
    // The scale of errors, from the grid's lines at 1e-2 and 1e-1.
    let grid = |label: &str| {
        let at = plot.marks.iter().find_map(|m| match m {
            Mark::Text { at, text, anchor: Anchor::End, .. } if text == label => Some(at.1),
            _ => None,
        });
        at.ok_or(format!("no label {label}"))
    };
    let (low, high) = (grid("1e-2")?, grid("1e-1")?);
    let place = |error: f64| low + (high - low) * (error.log10() + 2.0);
    for (x, y) in symbols {
        assert!((y - place(0.03)).abs() < 1e-6, "{y}");
        let bar = plot.marks.iter().any(|m| match m {
            Mark::Line { points, .. } => matches!(points[..], [a, b]
                if a.0 == x && b.0 == x
                && (a.1 - place(0.014)).abs() < 1e-6 && (b.1 - place(0.046)).abs() < 1e-6),
            _ => false,
        });
        assert!(bar, "no bar at {x}");
    }
    Ok(())
}
