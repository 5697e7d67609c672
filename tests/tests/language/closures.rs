//! Closures: as arguments of operations, marked inside `#[kernels]`, with values of the host.

#![allow(
    clippy::manual_is_multiple_of,
    clippy::needless_range_loop,
    reason = "what kernels are written in"
)]

use raydsl::prelude::*;
use raydsl::{kernel, kernels};
use raydsl_tests::check::{every_variant, inputs};

fn wall() -> Vec<Triangle> {
    (0..40)
        .map(|i| {
            let (x, y) = ((i % 8) as f32 * 3.0 - 12.0, (i / 8) as f32 * 4.0 - 10.0);
            let z = 1.0 + (i % 3) as f32;
            Triangle { v0: vec3(x, y, z), v1: vec3(x + 2.5, y, z), v2: vec3(x, y + 3.5, z) }
        })
        .collect()
}

#[test]
fn any_hit_each() -> Result<(), raydsl::bvh::BuildError> {
    let triangles = wall();
    let bvh = Bvh::build(&triangles)?;
    let forward = vec3(0.0, 0.0, 1.0);
    let kernel = kernel!(|x: f32, y: f32, n: u32| {
        let mut step = 0.3;
        if n % 2 == 0 {
            step += 0.4;
        }
        if n % 5 == 0 {
            return 100u32;
        }
        let hits = bvh.any_hit_each::<6>(|i: u32| {
            let origin = vec3(x * 0.2 + i as f32 * step, y * 0.2, 0.0);
            if i == 3 {
                return Ray::new(origin, -forward);
            }
            for k in 0..n {
                if k > i + 2 {
                    return Ray::new(origin, vec3(0.1, 0.0, 1.0)).with_range(0.5, 2.5);
                }
            }
            Ray::new(origin, forward)
        });
        let mut count = 0u32;
        for i in 0..hits.len() {
            count = count * 2 + hits[i] as u32;
        }
        count
    });
    every_variant(&kernel, &inputs(1));
    Ok(())
}

#[test]
fn closest_hit_each() -> Result<(), raydsl::bvh::BuildError> {
    let triangles = wall();
    let bvh = Bvh::build(&triangles)?;
    let slice = &triangles[..7];
    let kernel = kernel!(|x: f32, y: f32| {
        let ray = Ray::new(vec3(x * 0.1, y * 0.1, 0.0), vec3(0.0, 0.0, 1.0));
        let hits = bvh.closest_hit_each::<3>(|i: u32| Ray {
            origin: ray.origin + vec3(i as f32, 0.0, 0.0),
            ..ray
        });
        let near = slice.closest_hit_each::<2>(|i: u32| ray.with_range(0.0, 1.5 + i as f32));
        let mut sum = 0.0;
        for hit in 0..3usize {
            if hits[hit].is_hit {
                sum += hits[hit].t;
            }
        }
        let any = slice.any_hit_each::<2>(|_i: u32| ray);
        (sum, near[1].prim_id, near[0].is_hit, any[0] && any[1])
    });
    every_variant(&kernel, &inputs(2));
    Ok(())
}

/// The paper's spelling.
mod marked {
    use super::*;

    #[kernels]
    pub(super) fn in_a_function(scale: f32) {
        let k = #[kernel]
        |x: f32, n: u32| if n > 4 { x * scale } else { -x };
        every_variant(&k, &inputs(3));
        let several = [1.0, 2.0].map(|offset| {
            let k = #[kernel]
            |x: f32| x + offset;
            k.call((1.0,))
        });
        assert_eq!(several, [2.0, 3.0]);
    }

    pub(super) struct Scene {
        pub(super) scale: f32,
    }

    #[kernels]
    impl Scene {
        pub(super) fn run(&self) -> f32 {
            let scale = self.scale;
            (#[kernel]
            |x: f32| x * scale)
                .call((3.0,))
        }
    }

    #[kernels]
    pub(super) mod inside {
        pub(crate) fn doubled(x: f32) -> f32 {
            let k = #[kernel]
            move |x: f32| x * 2.0;
            k.call((x,))
        }
    }

    #[kernels]
    pub(super) trait Run {
        fn run(&self, x: f32) -> f32 {
            let k = #[kernel]
            |x: f32| x + 1.0;
            k.call((x,))
        }
    }

    impl Run for Scene {}
}

#[test]
fn marked_closures() {
    marked::in_a_function(1.5);
    let scene = marked::Scene { scale: 2.0 };
    assert_eq!(scene.run(), 6.0);
    assert_eq!(marked::Run::run(&scene, 1.0), 2.0);
    assert_eq!(marked::inside::doubled(4.0), 8.0);
}

const LIMIT: u32 = 3;

#[kernel]
fn power(x: f32, #[host] n: u32) -> f32 {
    let mut product = 1.0;
    if n == 0 {
        return product;
    }
    for _ in 0..n {
        product *= x;
    }
    product
}

#[test]
fn host_values() {
    for (count, fast) in [(0u32, false), (2, true), (5, false)] {
        let kernel = kernel!(|x: f32, n: u32| {
            #[host]
            let mut steps = host(count) + LIMIT;
            if host(fast) {
                steps = 1;
            }
            let mut sum = 0.0;
            for i in 0..steps {
                sum += x * i as f32;
                if i >= n {
                    break;
                }
            }
            if host(count) > 4 && !fast {
                return sum - 1.0;
            }
            sum + power(x, steps) + power(sum, 2)
        });
        every_variant(&kernel, &inputs(6));
        let wgsl = kernel.wgsl();
        let bound = if fast { 1 } else { count + LIMIT };
        assert!(wgsl.contains(&format!("i < {bound}u")), "{wgsl}");
        assert!(!wgsl.contains("params.count"), "{wgsl}");
        assert_eq!(wgsl.contains("fn power"), count <= 4, "{wgsl}");
    }
}
