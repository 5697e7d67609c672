//! The WGSL of the kernels, as text: compared with `golden/*.wgsl`, and valid for naga and tint.
//!
//! `RAYDSL_BLESS=1` rewrites the files; read the difference before committing it.

use std::path::{Path, PathBuf};
use std::process::Command;

use raydsl::machine::wgsl::{Arithmetic, Limits, Quotients};
use raydsl::prelude::*;
use raydsl_tests::check::recorded;
use raydsl_tests::kernels;
use raydsl_tests::scenes::{spheres, triangles};

fn golden(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("golden").join(format!("{name}.wgsl"))
}

/// Compares with the file, or writes it.
#[track_caller]
fn assert_golden(name: &str, wgsl: &str) {
    let path = golden(name);
    if std::env::var("RAYDSL_BLESS").is_ok_and(|v| v == "1") {
        if let Err(e) = std::fs::write(&path, wgsl) {
            panic!("{}: {e}", path.display());
        }
        return;
    }
    let expected = match std::fs::read_to_string(&path) {
        Ok(text) => text,
        Err(e) => panic!("{}: {e}; RAYDSL_BLESS=1 writes it", path.display()),
    };
    if expected == wgsl {
        return;
    }
    let differs = expected.lines().zip(wgsl.lines()).position(|(a, b)| a != b);
    let line = differs.unwrap_or_else(|| expected.lines().count().min(wgsl.lines().count()));
    panic!(
        "{} differs from line {} on; RAYDSL_BLESS=1 rewrites it\n expected {:?}\n    found {:?}",
        path.display(),
        line + 1,
        expected.lines().nth(line),
        wgsl.lines().nth(line),
    );
}

#[track_caller]
fn assert_naga(name: &str, wgsl: &str) {
    let module = match naga::front::wgsl::parse_str(wgsl) {
        Ok(module) => module,
        Err(e) => panic!("{name}: {}", e.emit_to_string(wgsl)),
    };
    let (flags, capabilities) = Default::default();
    let valid = naga::valid::Validator::new(flags, capabilities).validate(&module);
    if let Err(e) = valid {
        panic!("{name}: {}", e.emit_to_string(wgsl));
    }
}

#[track_caller]
fn assert_tint(name: &str, wgsl: &str) {
    let file = std::env::temp_dir().join(format!("raydsl-{}-{name}.wgsl", std::process::id()));
    if let Err(e) = std::fs::write(&file, wgsl) {
        panic!("{}: {e}", file.display());
    }
    let ran =
        Command::new("tint").args(["--format", "wgsl", "-o", "/dev/null"]).arg(&file).output();
    let _ = std::fs::remove_file(&file);
    match ran {
        Err(_) => eprintln!("SKIPPED: no tint on the PATH, {name} was checked by naga alone"),
        Ok(out) => {
            let text = String::from_utf8_lossy(&out.stderr);
            assert!(out.status.success(), "tint rejects {name}: {text}\n{wgsl}");
            assert!(!text.contains("warning"), "tint warns of {name}: {text}\n{wgsl}");
        }
    }
}

#[track_caller]
fn assert_wgsl(name: &str, wgsl: &str) {
    assert_golden(name, wgsl);
    assert_naga(name, wgsl);
    assert_tint(name, wgsl);
}

macro_rules! tests {
    ($($kernel:ident: $numbers:ident $wgsl:ident;)+) => {
        $(
            #[test]
            fn $kernel() {
                assert_wgsl(stringify!($kernel), &recorded::<kernels::$kernel>().wgsl());
            }
        )+

        /// No file outlives its kernel.
        #[test]
        fn every_file_has_a_kernel() -> std::io::Result<()> {
            let kernels = [$(stringify!($kernel)),+];
            for file in std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("golden"))? {
                let path = file?.path();
                let name = path.file_stem().and_then(|s| s.to_str()).unwrap_or_default();
                let known = kernels.contains(&name) || SCENES.contains(&name);
                assert!(known, "{} belongs to no kernel", path.display());
            }
            Ok(())
        }
    };
}

raydsl_tests::kernel_table!(tests);

const SCENES: [&str; 14] = [
    "corrected_quotients",
    "hits",
    "instances",
    "list_of_meshes",
    "primary",
    "primary_in_windows",
    "primary_plain",
    "shadow",
    "slice",
    "texture_levels",
    "texture_linear",
    "texture_sampled",
    "two_trees",
    "wide_trees",
];

/// What the crate's first page shows; with the branch on a captured `bool` pruned.
#[test]
fn primary() -> Result<(), raydsl::bvh::BuildError> {
    let points = spheres(50);
    let bvh = Bvh::build(&points)?;
    let background = vec3(0.1, 0.2, 0.3);
    let render = |shaded: bool| {
        let primary = kernel!(|ray: Ray| {
            let hit = bvh.closest_hit(ray);
            let color = if shaded {
                if hit.is_hit { bvh.primitive(hit).rgb() } else { background }
            } else {
                vec3(1.0, 1.0, 1.0)
            };
            Shaded { color, depth: hit.t, id: hit.prim_id }
        });
        let windows = Limits { max_binding_bytes: 512, ..Limits::default() };
        (primary.wgsl(), primary.record().module(&windows).source)
    };
    let (shaded, in_windows) = render(true);
    let (plain, _) = render(false);
    assert_wgsl("primary", &shaded);
    assert_wgsl("primary_in_windows", &in_windows);
    assert_wgsl("primary_plain", &plain);
    let uses = |wgsl: &str| wgsl.contains("params.background");
    assert!(uses(&shaded) && !uses(&plain), "{plain}");
    Ok(())
}

/// What a device gets whose quotients and roots are not the nearest.
#[test]
fn corrected_quotients() {
    let kernel = kernel!(|a: Vec3, b: f32| (a / b, a.y / a.z, a.abs().sqrt(), b.sqrt() / 4.0));
    let limits = Limits { quotients: Quotients::Corrected, ..Limits::default() };
    assert_wgsl("corrected_quotients", &kernel.record().module(&limits).source);
    let fast = kernel.arithmetic(Arithmetic::Fast).record().module(&limits).source;
    assert!(!fast.contains("exact_"), "{fast}");
}

#[test]
fn shadow() -> Result<(), raydsl::bvh::BuildError> {
    let soup = triangles(50);
    let walls = Bvh::build(&soup)?;
    let light = vec3(1.0, 5.0, 2.0);
    let shadow = kernel!(|ray: Ray| {
        let hit = walls.closest_hit(ray);
        let mut lit = 0.0;
        if hit.is_hit {
            let at = ray.at(hit.t);
            let to_light = Ray { origin: at, direction: light - at, t_min: 0.001, t_max: 1.0 };
            if !walls.any_hit(to_light) {
                lit = 1.0 / (light - at).length_squared();
            }
        }
        lit
    });
    assert_wgsl("shadow", &shadow.wgsl());
    Ok(())
}

#[test]
fn slice() {
    let few = triangles(5);
    let kernel = kernel!(|ray: Ray| few.any_hit(ray));
    assert_wgsl("slice", &kernel.wgsl());
}

/// Two trees over different primitives share what they can.
#[test]
fn two_trees() -> Result<(), raydsl::bvh::BuildError> {
    let (balls, soup) = (spheres(20), triangles(20));
    let (points, walls) = (Bvh::build(&balls)?, Bvh::build(&soup)?);
    let kernel = kernel!(|ray: Ray| {
        let a = points.closest_hit(ray);
        let b = walls.closest_hit(ray);
        if b.is_hit && (!a.is_hit || b.t < a.t) { b } else { a }
    });
    assert_wgsl("two_trees", &kernel.wgsl());
    Ok(())
}

/// Wide trees of a list, one after another.
#[test]
fn wide_trees() -> Result<(), Box<dyn std::error::Error>> {
    let balls = spheres(200);
    let tree = |balls| Bvh::build_wide(balls, &[], &BuildConfig::default());
    let trees = [tree(&balls[..80])?, tree(&balls[80..])?];
    let points = BvhList::new(&trees)?;
    let kernel = kernel!(|ray: Ray| {
        let hit = points.closest_hit(ray);
        let up = Ray::new(ray.at(hit.t), Vec3::Y);
        (hit.prim_id, hit.is_hit && points.any_hit(up))
    });
    assert_wgsl("wide_trees", &kernel.wgsl());
    Ok(())
}

/// A loop over hits, of shapes that are crossed twice.
#[test]
fn hits() -> Result<(), raydsl::bvh::BuildError> {
    let balls = spheres(20);
    let bvh = Bvh::build(&balls)?;
    let kernel = kernel!(|ray: Ray| {
        let mut passed = 0u32;
        let mut last = 0.0;
        for hit in bvh.hits(ray) {
            passed += 1;
            last = hit.t;
            if passed == 3 {
                break;
            }
        }
        (passed, last)
    });
    assert_wgsl("hits", &kernel.wgsl());
    Ok(())
}

/// The same whatever the transforms are: they are data.
#[test]
fn instances() -> Result<(), Box<dyn std::error::Error>> {
    let soup = triangles(20);
    let trees = [Bvh::build(&soup)?];
    let texts = [1.0, 2.0].map(|scale| -> Result<String, Box<dyn std::error::Error>> {
        let map = Affine3::from_scale(vec3(scale, 1.0, 1.0));
        let scene = Instances::build(&trees, &[Instance::new(0, map)])?;
        let kernel = kernel!(|ray: Ray| {
            let hit = scene.closest_hit(ray);
            let normal = scene.primitive(hit).normal(scene.local_ray(ray, hit), hit);
            let normal = scene.normal_in_scene(hit, normal);
            (hit.inst_id, normal, scene.any_hit(ray))
        });
        Ok(kernel.wgsl())
    });
    let [one, other] = texts;
    let one = one?;
    assert_wgsl("instances", &one);
    assert_eq!(one, other?);
    Ok(())
}

#[test]
fn list_of_meshes() -> Result<(), Box<dyn std::error::Error>> {
    let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
    let faces = [[0, 1, 2], [0, 2, 3], [0, 3, 1]].map(|vertices| IndexedTriangle { vertices });
    let (front, back) = faces.split_at(1);
    let config = BuildConfig::default();
    let tree = |faces| Bvh::build_sharing(faces, &vertices, &config);
    let trees = [tree(front)?, tree(back)?];
    let meshes = BvhList::new(&trees)?;
    let kernel = kernel!(|ray: Ray| {
        let near = meshes.closest_hit(ray);
        let far = meshes.multi_hit_by::<1>(ray, |a: Hit, b: Hit| a.t > b.t);
        (near.t, far[0].t, meshes.any_hit(ray))
    });
    assert_wgsl("list_of_meshes", &kernel.wgsl());
    Ok(())
}

/// A texture has the code of its filter and modes alone; sizes and the border are data.
#[test]
fn texture_linear() -> Result<(), raydsl::texture::TextureError> {
    use raydsl::texture::Address;
    let texels = [[Unorm8::ONE; 4]; 12];
    let texts = [([4, 3], 0.5), ([6, 2], 0.25)].map(|(size, border)| {
        let config = TextureConfig::new().border(Vec4::splat(border));
        let config = config.addresses([Address::Wrap, Address::Border]);
        let tiles = Texture2::new(&texels, size, config)?;
        let kernel = kernel!(|uv: Vec2| tex2(&tiles, uv));
        Ok(kernel.wgsl())
    });
    let [one, other] = texts;
    let one = one?;
    assert_wgsl("texture_linear", &one);
    assert_eq!(one, other?);
    for trace in ["four", "cubic", "pow", "level", "reduced_"] {
        assert!(!one.contains(trace), "{trace} in {one}");
    }
    Ok(())
}

/// Read by the device's own sampler, next to one that is not.
#[test]
fn texture_sampled() -> Result<(), raydsl::texture::TextureError> {
    use raydsl::texture::{ColorSpace, Filtering, LevelFilter};
    let (colors, heights) = ([[Unorm8::ONE; 4]; 32], [0.5; 6]);
    let config = TextureConfig::new().color_space(ColorSpace::Srgb).filtering(Filtering::Device);
    let config = config.level_filter(LevelFilter::Linear);
    let tiles = Texture2::new(&colors, [8, 4], config)?.with_levels()?;
    let relief = Texture1::new(&heights, [6], TextureConfig::new())?;
    let kernel =
        kernel!(|uv: Vec2, level: f32| { tex2_level(&tiles, uv, level) * tex1(&relief, uv.x) });
    assert_wgsl("texture_sampled", &kernel.wgsl());
    Ok(())
}

/// Trilinear filtering of colours in sRGB.
#[test]
fn texture_levels() -> Result<(), raydsl::texture::TextureError> {
    use raydsl::texture::{ColorSpace, LevelFilter};
    let texels = [[Unorm8::ONE; 3]; 32];
    let config = TextureConfig::new().color_space(ColorSpace::Srgb);
    let config = config.level_filter(LevelFilter::Linear);
    let floor = Texture2::new(&texels, [8, 4], config)?.with_levels()?;
    let kernel = kernel!(|uv: Vec2, level: f32| tex2_level(&floor, uv, level));
    assert_wgsl("texture_levels", &kernel.wgsl());
    Ok(())
}
