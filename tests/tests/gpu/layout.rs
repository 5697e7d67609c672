//! Structs lie in the GPU's memory as they lie in the host's: naga's layouter is the witness.

use std::collections::BTreeMap;

use naga::{ScalarKind, TypeInner};
use raydsl::bvh::Node;
use raydsl::machine::{Schema, Type};
use raydsl::prelude::*;
use raydsl_tests::check::recorded;
use raydsl_tests::kernels;
use raydsl_tests::scenes::{ColorSphere, spheres, triangles};
use raydsl_tests::values::each_leaf;

/// What lies in each word: `f`, `i` or `u` by its byte offset.
type Words = BTreeMap<usize, char>;

fn host_words(schema: &Schema) -> Words {
    let mut words = Words::new();
    each_leaf(schema, 0, &mut |offset, leaf| {
        let kind = match leaf {
            Schema::F32 => 'f',
            Schema::I32 => 'i',
            _ => 'u',
        };
        words.insert(offset & !3, kind);
    });
    words
}

fn kind(scalar: naga::Scalar) -> char {
    match scalar.kind {
        ScalarKind::Float => 'f',
        ScalarKind::Sint => 'i',
        _ => 'u',
    }
}

/// Fills `words` with the scalars of a type, padding left out.
fn gpu_words(module: &naga::Module, ty: naga::Handle<naga::Type>, at: usize, words: &mut Words) {
    match &module.types[ty].inner {
        TypeInner::Scalar(s) => {
            words.insert(at, kind(*s));
        }
        TypeInner::Vector { size, scalar } => {
            (0..*size as usize).for_each(|i| {
                words.insert(at + 4 * i, kind(*scalar));
            });
        }
        TypeInner::Struct { members, .. } => {
            for m in members {
                let name = m.name.as_deref().unwrap_or_default();
                if !name.starts_with("pad") {
                    gpu_words(module, m.ty, at + m.offset as usize, words);
                }
            }
        }
        other => panic!("a stored struct has a member {other:?}"),
    }
}

/// Compares the elements of the storage buffer `buffer` with the host's `schema`.
#[track_caller]
fn assert_layout(wgsl: &str, buffer: &str, schema: &Schema, host_size: usize) {
    let module = match naga::front::wgsl::parse_str(wgsl) {
        Ok(module) => module,
        Err(e) => panic!("{}\n{wgsl}", e.emit_to_string(wgsl)),
    };
    let found = module.global_variables.iter().find(|(_, v)| v.name.as_deref() == Some(buffer));
    let Some((_, variable)) = found else { panic!("no buffer `{buffer}` in\n{wgsl}") };
    let TypeInner::Array { base, stride, .. } = module.types[variable.ty].inner else {
        panic!("`{buffer}` is no array");
    };
    let mut layouter = naga::proc::Layouter::default();
    if let Err(e) = layouter.update(module.to_ctx()) {
        panic!("{e}");
    }
    assert_eq!(stride as usize, host_size.next_multiple_of(4), "stride of `{buffer}`");
    assert_eq!(layouter[base].to_stride(), stride, "naga's stride of `{buffer}`");
    if let TypeInner::Struct { span, .. } = module.types[base].inner {
        assert_eq!(span, stride, "span of `{buffer}`");
    }
    let mut words = Words::new();
    gpu_words(&module, base, 0, &mut words);
    assert_eq!(words, host_words(schema), "members of `{buffer}` in\n{wgsl}");
}

/// Of a type of the host.
#[track_caller]
fn assert_type<T: Type>(wgsl: &str, buffer: &str) {
    assert_layout(wgsl, buffer, T::SCHEMA, size_of::<T>());
}

#[test]
fn sizes_are_those_promised() {
    assert_eq!(size_of::<ColorSphere>(), 16);
    assert_eq!(size_of::<Triangle>(), 36);
    assert_eq!(size_of::<Node>(), 32);
    assert_eq!(size_of::<Ray>(), 32);
}

#[test]
fn scenes() -> Result<(), raydsl::bvh::BuildError> {
    let balls = spheres(50);
    let bvh = Bvh::build(&balls)?;
    let kernel = kernel!(|ray: Ray| {
        let hit = bvh.closest_hit(ray);
        Shaded { color: bvh.primitive(hit).rgb(), depth: hit.t, id: hit.prim_id }
    });
    let wgsl = kernel.wgsl();
    assert_type::<ColorSphere>(&wgsl, "bvh");
    assert_type::<u32>(&wgsl, "bvh_ids");
    assert_type::<(Ray,)>(&wgsl, "inputs");
    assert_type::<Shaded>(&wgsl, "outputs");
    let offset = |name, offset, schema| raydsl::machine::Field { name, offset, schema };
    let node: &'static [_] = Box::leak(Box::new([
        offset("min", std::mem::offset_of!(Node, min), &Schema::Vector(&Schema::F32, 3)),
        offset("first", std::mem::offset_of!(Node, first), &Schema::U32),
        offset("max", std::mem::offset_of!(Node, max), &Schema::Vector(&Schema::F32, 3)),
        offset("count", std::mem::offset_of!(Node, count), &Schema::U32),
    ]));
    let node = Schema::Struct { name: "Node", fields: node, size: size_of::<Node>() };
    assert_layout(&wgsl, "bvh_nodes", &node, size_of::<Node>());
    let soup = triangles(50);
    let kernel = kernel!(|ray: Ray| soup.closest_hit(ray));
    assert_type::<Triangle>(&kernel.wgsl(), "soup");
    assert_type::<Hit>(&kernel.wgsl(), "outputs");
    Ok(())
}

/// A primitive of two kinds, of different sizes.
#[primitive]
enum Shape {
    Ball(ColorSphere),
    Face(Triangle),
}

#[test]
fn kinds_and_indices() -> Result<(), Box<dyn std::error::Error>> {
    let balls = spheres(3).into_iter().map(Shape::Ball);
    let shapes: Vec<Shape> = balls.chain(triangles(3).into_iter().map(Shape::Face)).collect();
    let kernel = kernel!(|ray: Ray| shapes.closest_hit(ray));
    // The number of the kind, and a word for each of a triangle's nine.
    assert_eq!(Shape::SCHEMA.size(), 40);
    assert_layout(&kernel.wgsl(), "shapes", Shape::SCHEMA, 40);
    let vertices = [Vec3::ZERO, Vec3::X, Vec3::Y];
    let mesh = [IndexedTriangle { vertices: [0, 1, 2] }];
    let bvh = Bvh::build_sharing(&mesh, &vertices, &BuildConfig::default())?;
    let trees = [bvh];
    let list = BvhList::new(&trees)?;
    let wgsl = kernel!(|ray: Ray| list.closest_hit(ray)).wgsl();
    assert_type::<IndexedTriangle>(&wgsl, "list");
    assert_type::<Vec3>(&wgsl, "list_shared");
    assert_type::<u32>(&wgsl, "list_roots");
    Ok(())
}

/// Bools, bytes and halves between words, in nested structs.
#[derive(Clone, Copy, Debug, Type)]
#[repr(C)]
struct Mixed {
    small: Unorm16,
    flag: bool,
    byte: Unorm8,
    at: Vec3,
    n: i32,
    on: bool,
    off: bool,
    last: Unorm16,
    flat: Vec2,
    inner: kernels::Particle,
}

#[raydsl::kernel]
fn mixed(m: Mixed, x: f32) -> Mixed {
    Mixed { flag: !m.flag, at: m.at * x, inner: kernels::Particle { mass: x, ..m.inner }, ..m }
}

/// A vector where WGSL's own alignment fits.
#[derive(Clone, Copy, Debug, Type)]
#[repr(C)]
struct Aligned {
    a: Vec3,
    b: u32,
    c: Vec4,
    d: Vec2,
    e: Vec2,
}

#[raydsl::kernel]
fn aligned(a: Aligned) -> Aligned {
    Aligned { b: a.b + 1, ..a }
}

/// Vectors of integers and truth values between others, and matrices.
#[derive(Clone, Copy, Debug, Type)]
#[repr(C)]
struct Voxel {
    at: UVec3,
    color: u32,
    offset: IVec2,
    faces: BVec3,
    open: BVec4,
    flag: bool,
    corner: IVec4,
    size: UVec2,
    frame: Affine3,
    to_world: Mat4,
    edge: BVec2,
}

#[raydsl::kernel]
fn voxel(v: Voxel, n: u32, m: Mat3) -> Voxel {
    let mut v = v;
    v.at += UVec3::splat(n);
    v.offset = v.offset.yx();
    v.faces = !v.faces;
    v.frame.matrix3 = m;
    v.to_world.y_axis.w = m.x_axis.y;
    v
}

#[test]
fn structs() {
    let wgsl = recorded::<mixed>().wgsl();
    assert_type::<(Mixed, f32)>(&wgsl, "inputs");
    assert_type::<Mixed>(&wgsl, "outputs");
    let wgsl = recorded::<aligned>().wgsl();
    assert_type::<(Aligned,)>(&wgsl, "inputs");
    assert_type::<Aligned>(&wgsl, "outputs");
    let wgsl = recorded::<voxel>().wgsl();
    assert_type::<(Voxel, u32, Mat3)>(&wgsl, "inputs");
    assert_type::<Voxel>(&wgsl, "outputs");
    let wgsl = recorded::<kernels::arrays>().wgsl();
    assert_type::<(kernels::Table, u32)>(&wgsl, "inputs");
    let wgsl = recorded::<kernels::unorms>().wgsl();
    assert_type::<(kernels::Codes,)>(&wgsl, "inputs");
    let wgsl = recorded::<kernels::truth_variables>().wgsl();
    assert_type::<bool>(&wgsl, "outputs");
}

/// The bytes arrive: a layout that is consistent but wrong would not pass this.
#[test]
fn structs_survive_the_device() {
    use raydsl_tests::check::{Wgsl, check};
    use raydsl_tests::values::Numbers;
    check::<mixed>("mixed", Numbers::Tame, Wgsl::Same);
    check::<aligned>("aligned", Numbers::Tame, Wgsl::Same);
    check::<voxel>("voxel", Numbers::Tame, Wgsl::Same);
}

/// Captured values of every kind of vector lie in the uniform block.
#[test]
fn captures_arrive() {
    let (low, high) = (uvec3(3, 5, 7), ivec2(-4, 9));
    let (mask, frame) = (bvec3(true, false, true), Affine3::from_translation(vec3(1.0, 2.0, 3.0)));
    let kernel = kernel!(|p: Vec3, n: u32| {
        let cell = UVec3::select(mask, low + n, low * 2);
        frame.transform_point3(p) + cell.as_vec3() + high.as_vec2().extend(0.5)
    });
    let inputs: Vec<_> = (0..64).map(|i| (Vec3::splat(i as f32), i as u32)).collect();
    let expected: Vec<Vec3> = inputs.iter().map(|(p, n)| kernel.call((*p, *n))).collect();
    let mut found = vec![Vec3::ZERO; inputs.len()];
    kernel.run(raydsl::kernel::Variant::Packet8, &inputs, &mut found);
    assert_eq!(expected, found);
    let Some(gpu) = raydsl_tests::gpu::gpu() else { return };
    let mut found = vec![Vec3::ZERO; inputs.len()];
    if let Err(e) = gpu.batch(&kernel, &inputs, &mut found) {
        panic!("{e}\n{}", kernel.wgsl());
    }
    assert_eq!(expected, found);
}
