//! Names of the user's beside those of generated code: none of them meet.

use raydsl::prelude::*;
use raydsl::{assert_variants_agree, kernel};

/// Variables named like locals of the macro's own, which closures of lifted code mention.
#[kernel]
#[expect(clippy::needless_late_init, reason = "it is what the test is about")]
fn named_like_locals(v: Vec3, n: u32) -> f32 {
    let args = v;
    let m = vec2(v.x, v.y);
    let list = [args, args * 2.0];
    let (whole, part, old) = (m, args.z, n);
    let mut result = 0.0;
    for by in 0..n % 3 {
        let later: Vec2;
        if args.dot(list[by as usize % 2]) > m.y {
            later = whole + m;
        } else {
            later = m;
        }
        result += later.x + part;
        if old > 5 {
            result -= m.y * list[0].y;
        }
    }
    result
}

#[test]
fn variables_are_named_like_locals_of_the_macro() {
    let inputs = [(vec3(0.5, 1.0, 2.0), 1), (vec3(-1.0, 3.0, 0.5), 2), (vec3(2.0, 0.0, 1.0), 8)];
    assert_variants_agree!(named_like_locals, &inputs);
}

#[kernel]
trait Brdf {
    fn weight(&self, x: f32) -> f32;
}

#[derive(Clone, Copy, Type)]
struct Scaled {
    by: f32,
}

#[kernel]
impl Brdf for Scaled {
    fn weight(&self, x: f32) -> f32 {
        x * self.by
    }
}

/// Operators with type parameters, and a method, for a struct whose parameters have short names.
macro_rules! named {
    ($($test:ident $pair:ident $make:ident $a:ident $b:ident;)+) => {
        $(
            #[derive(Clone, Copy, Type)]
            struct $pair<$a: Brdf, $b: Brdf> {
                first: $a,
                second: $b,
            }

            #[kernel]
            impl<$a: Brdf, $b: Brdf> $pair<$a, $b> {
                fn both(&self, x: f32) -> f32 {
                    let first: $a = self.first;
                    let second: $b = self.second;
                    first.weight(x) + second.weight(x)
                }
            }

            #[kernel]
            fn $make<$a: Brdf, $b: Brdf>(first: $a, second: $b, x: f32) -> f32 {
                $pair::<$a, $b> { first, second }.both(x)
            }

            #[test]
            fn $test() {
                #[kernel]
                fn whole(x: f32) -> f32 {
                    $make(Scaled { by: 2.0 }, Scaled { by: 0.5 }, x)
                }
                assert_variants_agree!(whole, &[(1.0,), (-3.5,)]);
            }
        )+
    };
}

named! {
    a_and_m PairAM of_a_m A M;
    n_and_p PairNP of_n_p N P;
    r_and_v PairRV of_r_v R V;
    f_and_t PairFT of_f_t F T;
    c_and_d PairCD of_c_d C D;
    e_and_g PairEG of_e_g E G;
    via_and_name PairVia of_via Via NAME;
}

#[derive(Clone, Copy, Type)]
struct M {
    r: f32,
}

#[kernel]
impl core::ops::Add for M {
    type Output = M;

    fn add(self, right: M) -> M {
        M { r: self.r + right.r }
    }
}

#[derive(Clone, Copy, PartialEq, Type)]
enum A {
    R,
    Via,
}

#[derive(Clone, Copy, Type)]
struct Few<const N: usize, const NAME: usize> {
    first: [f32; N],
    second: [f32; NAME],
}

#[kernel]
fn few<const N: usize, const NAME: usize>(few: Few<N, NAME>) -> f32 {
    few.first[0] + few.second[NAME - 1]
}

#[test]
fn types_and_constants_have_short_names() {
    #[kernel]
    fn whole(x: f32) -> f32 {
        let m = M { r: x } + M { r: 1.0 };
        let a = if x > 0.0 { A::R } else { A::Via };
        let parts = Few::<2, 3> { first: [x; 2], second: [m.r; 3] };
        if a == A::R { m.r + few(parts) } else { x }
    }
    assert_variants_agree!(whole, &[(1.0,), (-3.5,)]);
}

#[primitive]
struct R {
    center: Vec3,
    radius: f32,
}

#[primitive]
impl R {
    fn intersect(&self, ray: Ray) -> Hit {
        let ball = self.center;
        let t = dot(ball - ray.origin, ray.direction);
        Hit::new(t > ray.t_min && t < ray.t_max, t)
    }

    fn get_bounds(&self) -> Aabb {
        Aabb { min: self.center - self.radius, max: self.center + self.radius }
    }
}

#[primitive(sphere(center, radius))]
struct M2 {
    center: Vec3,
    radius: f32,
}

#[primitive]
enum P {
    A(R),
    M(M2),
}

#[test]
fn primitives_have_short_names() {
    let ball = R { center: vec3(0.0, 0.0, 4.0), radius: 1.0 };
    let sphere = M2 { center: vec3(0.0, 3.0, 4.0), radius: 1.0 };
    let all = [P::A(ball), P::M(sphere)];
    let bvh = Bvh::build(&all).expect("finite bounds");
    let k = kernel!(|y: f32| {
        let ray = Ray::new(vec3(0.0, y, 0.0), Vec3::Z);
        bvh.closest_hit(ray).t
    });
    assert_variants_agree!(&k, &[(0.0,), (3.0,), (9.0,)]);
}

/// Types that have the names of those in the text of queries.
mod types_of_queries {
    use raydsl::kernel;
    use raydsl::prelude::{self as library, *};
    use raydsl::testing::validate;

    macro_rules! types {
        ($($name:ident $sum:ident)+) => {
            $(
                #[derive(Clone, Copy, Type)]
                struct $name {
                    x: f32,
                    next: u32,
                }

                #[kernel]
                fn $sum(v: $name) -> f32 {
                    v.x + v.next as f32
                }
            )+

            #[kernel]
            fn sums(x: f32) -> f32 {
                let mut sum = 0.0;
                $(sum += $sum($name { x, next: 2 });)+
                sum
            }
        };
    }

    types! {
        Ray of_ray
        Hit of_hit
        Node of_node
        Slabs of_slabs
        Traversal of_traversal
        Place of_place
        TraversalLevel of_level
        InstanceTraversal of_descent
        CountedInstanceTraversal of_counted_descent
        NextPrimitive of_next
        Cost of_cost
        CountedHit of_counted
        Affine3 of_affine
    }

    #[primitive(sphere(center, radius))]
    struct Ball {
        center: Vec3,
        radius: f32,
    }

    /// Asks a scene, with the user's own types in front of the library's.
    macro_rules! asked {
        ($scene:ident) => {{
            let found = kernel!(|x: f32| {
                let own = sums(x);
                let ray = library::Ray::new(vec3(x, 0.0, 0.0), Vec3::Z);
                let hit = $scene.closest_hit(ray);
                let far = $scene.closest_hit_where(ray, |hit: library::Hit| hit.t > 4.0);
                let local = $scene.local_ray(ray, hit);
                (
                    own,
                    hit.t,
                    far.t,
                    $scene.any_hit(ray),
                    local.origin,
                    $scene.to_object(hit).transform_point3(ray.origin),
                )
            });
            raydsl::assert_variants_agree!(&found, &[(0.0,), (0.25,), (3.0,)]);
            let counted = kernel!(|x: f32| {
                let own = sums(x);
                let ray = library::Ray::new(vec3(x, 0.0, 0.0), Vec3::Z);
                let (hit, cost) = $scene.closest_hit_with_cost(ray);
                (own, hit.t, cost.nodes)
            });
            validate(&counted).expect("its WGSL is valid");
        }};
    }

    #[test]
    fn stand_beside_the_users() {
        let balls = [3.0, 6.0, 9.0].map(|z| Ball { center: vec3(0.0, 0.0, z), radius: 1.0 });
        let trees = [&balls[..2], &balls[2..]].map(|part| Bvh::build(part).expect("finite bounds"));
        let slice = &balls[..];
        asked!(slice);
        let tree = &trees[0];
        asked!(tree);
        let list = BvhList::new(&trees).expect("few trees");
        asked!(list);
        let moved = glam::Affine3::from_translation(vec3(0.0, 0.0, 1.0));
        let placed = [Instance::new(0, moved), Instance::new(1, moved)];
        let instances = Instances::build(&trees, &placed).expect("few instances");
        asked!(instances);
    }
}
