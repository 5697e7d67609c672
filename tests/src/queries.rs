//! Queries of scenes in every variant of the CPU.

use raydsl::__private::{Method, name};
use raydsl::bvh::SceneView;
use raydsl::machine::{Lanes, Packet, Type};
#[cfg(feature = "gpu")]
use raydsl::prelude::Renderer;
use raydsl::prelude::{
    Bvh, Hit, HitRecord, Kernel, Primitive, Ray, RecordQuery, Triangle, Variant, kernel,
};

use crate::levels::{LevelTask, each_level, gangs, widest_level};
use crate::scenes::ColorSphere;
use crate::{in_parallel, scaled};

/// Rays that one thread takes at a time.
const PART: usize = 4096;

/// Results of queries, and what they were.
#[derive(Clone, Debug)]
pub struct Answers {
    /// The rays.
    pub rays: Vec<Ray>,
    /// The closest hit of each.
    pub closest: Vec<Hit>,
    /// Whether each hits anything.
    pub any: Vec<bool>,
}

/// A hit's members; -0 equals +0, and every NaN every other.
pub fn hit_words(hit: &Hit) -> [u32; 5] {
    let word = |x: f32| if x.is_nan() { f32::NAN.to_bits() } else { (x + 0.0).to_bits() };
    [u32::from(hit.is_hit), word(hit.t), hit.prim_id, word(hit.u), word(hit.v)]
}

/// Fills `out` on all processors.
pub fn fill<T: Send>(out: &mut [T], work: impl Fn(usize, &mut [T]) + Sync) {
    let parts: Vec<std::sync::Mutex<&mut [T]>> =
        out.chunks_mut(PART).map(std::sync::Mutex::new).collect();
    in_parallel(parts.len(), 1, |range| {
        for i in range {
            if let Ok(mut part) = parts[i].lock() {
                work(i * PART, &mut part);
            }
        }
    });
}

/// Primitives without a tree, as kernels see them.
pub fn slice_view<P: Primitive<Shared = ()>>(prims: &[P]) -> SceneView<'_, P> {
    RecordQuery::view(prims)
}

/// The scalar answers.
pub fn scalar_answers<P: Primitive>(view: SceneView<'_, P>, rays: Vec<Ray>) -> Answers {
    use raydsl::bvh::traverse::{any_hit, closest_hit};
    let mut closest = vec![Hit::miss(); rays.len()];
    fill(&mut closest, |first, part| {
        part.iter_mut().zip(&rays[first..]).for_each(|(h, r)| *h = closest_hit(&view, *r).hit());
    });
    let mut any = vec![false; rays.len()];
    fill(&mut any, |first, part| {
        part.iter_mut().zip(&rays[first..]).for_each(|(h, r)| *h = any_hit(&view, *r));
    });
    Answers { rays, closest, any }
}

impl Answers {
    /// The first `count` answers.
    pub fn first(&self, count: usize) -> Self {
        let n = count.min(self.rays.len());
        Self {
            rays: self.rays[..n].to_vec(),
            closest: self.closest[..n].to_vec(),
            any: self.any[..n].to_vec(),
        }
    }

    /// How many rays hit something.
    pub fn hits(&self) -> usize {
        self.closest.iter().filter(|h| h.is_hit).count()
    }

    /// Panics if the closest hits differ in any member.
    ///
    /// # Panics
    ///
    /// If they do.
    pub fn assert_closest(&self, who: &str, found: &[Hit]) {
        assert_eq!(self.closest.len(), found.len());
        let differs = |(a, b): (&Hit, &Hit)| hit_words(a) != hit_words(b);
        let count = self.closest.iter().zip(found).filter(|(a, b)| differs((a, b))).count();
        if let Some(i) = self.closest.iter().zip(found).position(differs) {
            panic!(
                "{who}: {count} of {} closest hits differ; the first is number {i}: {:?}\n expected {:?}\n    found {:?}",
                found.len(),
                self.rays[i],
                self.closest[i],
                found[i],
            );
        }
    }

    /// Panics if the answers of `any_hit` differ.
    ///
    /// # Panics
    ///
    /// If they do.
    pub fn assert_any(&self, who: &str, found: &[bool]) {
        let differs = |(a, b): (&bool, &bool)| a != b;
        let count = self.any.iter().zip(found).filter(|(a, b)| differs((a, b))).count();
        if let Some(i) = self.any.iter().zip(found).position(differs) {
            panic!(
                "{who}: {count} of {} any hits differ; the first is number {i}: {:?}, found {}",
                found.len(),
                self.rays[i],
                found[i],
            );
        }
    }

    /// Asks a kernel's natural variants.
    fn assert_variants(
        &self,
        who: &str,
        closest: &Kernel<'_, (Ray,), Hit>,
        any: &Kernel<'_, (Ray,), bool>,
    ) {
        let args: Vec<(Ray,)> = self.rays.iter().map(|r| (*r,)).collect();
        for v in [Variant::Scalar, Variant::Packet4, Variant::Packet8, Variant::Packet16] {
            let who = format!("{who}, {} on {:?}", v.name(), v.isa());
            let mut found = vec![Hit::miss(); args.len()];
            fill(&mut found, |first, part| closest.run(v, &args[first..first + part.len()], part));
            self.assert_closest(&who, &found);
            let mut found = vec![false; args.len()];
            fill(&mut found, |first, part| any.run(v, &args[first..first + part.len()], part));
            self.assert_any(&who, &found);
        }
    }

    /// Asks a kernel's WGSL about the first rays: `count` at full scale.
    fn assert_wgsl(
        &self,
        who: &str,
        count: usize,
        closest: &Kernel<'_, (Ray,), Hit>,
        any: &Kernel<'_, (Ray,), bool>,
    ) {
        let Some(gpu) = crate::gpu::gpu() else { return };
        let these = self.first(scaled(count));
        let args: Vec<(Ray,)> = these.rays.iter().map(|r| (*r,)).collect();
        let mut found = vec![Hit::miss(); args.len()];
        if let Err(error) = gpu.batch(closest, &args, &mut found) {
            panic!("{who}: {error}\n{}", closest.wgsl());
        }
        these.assert_closest(&format!("{who}, WGSL"), &found);
        let mut found = vec![false; args.len()];
        if let Err(error) = gpu.batch(any, &args, &mut found) {
            panic!("{who}: {error}\n{}", any.wgsl());
        }
        these.assert_any(&format!("{who}, WGSL"), &found);
    }
}

/// The checks of one kind of primitive. They are functions of this crate, so that the many
/// traversals behind them are compiled once, not once a test program.
macro_rules! checks {
    ($prim:ty: $tree:ident $slice:ident $fast:ident) => {
        impl Answers {
            /// Asks the natural variants about a tree, and WGSL about `wgsl` rays at full scale.
            pub fn $tree(&self, who: &str, bvh: &Bvh<'_, $prim>, wgsl: usize) {
                let closest = kernel!(|ray: Ray| bvh.closest_hit(ray));
                let any = kernel!(|ray: Ray| bvh.any_hit(ray));
                self.assert_variants(who, &closest, &any);
                self.assert_wgsl(who, wgsl, &closest, &any);
            }

            /// Asks the natural variants about a slice, and WGSL about `wgsl` rays at full scale.
            pub fn $slice(&self, who: &str, prims: &[$prim], wgsl: usize) {
                let closest = kernel!(|ray: Ray| prims.closest_hit(ray));
                let any = kernel!(|ray: Ray| prims.any_hit(ray));
                self.assert_variants(who, &closest, &any);
                self.assert_wgsl(who, wgsl, &closest, &any);
            }
        }

        /// The closest hits, by the widest packets of this machine.
        pub fn $fast(view: SceneView<'_, $prim>, rays: &[Ray]) -> Vec<Hit> {
            struct Widest<'a>(SceneView<'a, $prim>, &'a [Ray], Vec<Hit>);
            impl LevelTask for Widest<'_> {
                fn run<L: Lanes>(&mut self, _: &str, lanes: L) {
                    self.2 = closest_hits(lanes, L::N, &self.0, self.1);
                }
            }
            let mut task = Widest(view, rays, Vec::new());
            widest_level(&mut task);
            task.2
        }
    };
}

checks!(ColorSphere: sphere_tree sphere_slice closest_spheres);
checks!(Triangle: triangle_tree triangle_slice closest_triangles);

impl Answers {
    /// Asks packets of every level and width. Many traversals: one test program alone does it.
    pub fn assert_levels<P: Primitive>(&self, who: &str, view: SceneView<'_, P>) {
        each_level(&mut Ask { who, view, answers: self });
    }

    /// Asks gangs of 32 and 64 lanes about every fourth ray.
    pub fn assert_gangs<P: Primitive>(&self, who: &str, view: SceneView<'_, P>) {
        let answers = &Self {
            rays: self.rays.iter().step_by(4).copied().collect(),
            closest: self.closest.iter().step_by(4).copied().collect(),
            any: self.any.iter().step_by(4).copied().collect(),
        };
        let ask = Ask { who, view, answers };
        for gang in gangs() {
            ask.packets(&gang.name, gang.lanes, gang.width);
        }
    }
}

struct Ask<'a, P: Primitive> {
    who: &'a str,
    view: SceneView<'a, P>,
    answers: &'a Answers,
}

impl<P: Primitive> LevelTask for Ask<'_, P> {
    fn run<L: Lanes>(&mut self, name: &str, lanes: L) {
        self.packets(name, lanes, L::N);
    }
}

impl<P: Primitive> Ask<'_, P> {
    fn packets<L: Lanes>(&self, name: &str, lanes: L, width: usize) {
        let who = format!("{}, {name}", self.who);
        let rays = &self.answers.rays;
        self.answers.assert_closest(&who, &closest_hits(lanes, width, &self.view, rays));
        self.answers.assert_any(&who, &any_hits(lanes, width, &self.view, rays));
    }
}

#[inline(never)]
fn closest_hits<L: Lanes, P: Primitive>(
    lanes: L,
    width: usize,
    view: &SceneView<'_, P>,
    rays: &[Ray],
) -> Vec<Hit> {
    let mut found = vec![Hit::miss(); rays.len()];
    fill(&mut found, |first, out| {
        packets(lanes, width, &rays[first..], out, |m, ray| {
            let rays = (Ray::from_lanes(m, &ray),);
            let record = Method::<{ name("closest_hit") }, _, _>::call(*view, m, rays);
            let hit = P::Hit::hit_on(record);
            move |l| Hit::lane::<Packet<L>>(&hit, l)
        });
    });
    found
}

#[inline(never)]
fn any_hits<L: Lanes, P: Primitive>(
    lanes: L,
    width: usize,
    view: &SceneView<'_, P>,
    rays: &[Ray],
) -> Vec<bool> {
    let mut found = vec![false; rays.len()];
    fill(&mut found, |first, out| {
        packets(lanes, width, &rays[first..], out, |m, ray| {
            let rays = (Ray::from_lanes(m, &ray),);
            let hit = Method::<{ name("any_hit") }, _, _>::call(*view, m, rays);
            move |l| bool::lane::<Packet<L>>(&hit, l)
        });
    });
    found
}

/// Asks `query` for `out`, a packet of `width` at a time.
#[inline(always)]
fn packets<L: Lanes, T, F: Fn(usize) -> T>(
    lanes: L,
    width: usize,
    rays: &[Ray],
    out: &mut [T],
    query: impl Fn(&Packet<L>, &dyn Fn(usize) -> Ray) -> F,
) {
    lanes.vectorize(|| {
        for (rays, out) in rays.chunks(width).zip(out.chunks_mut(width)) {
            let m = Packet::with_count(lanes, out.len());
            let lane = query(&m, &|l| rays[l.min(rays.len() - 1)]);
            out.iter_mut().enumerate().for_each(|(l, out)| *out = lane(l));
        }
    });
}
