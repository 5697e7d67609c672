//! Independence of hits from the build settings.

use super::*;

#[test]
fn every_quality_answers_as_brute_force() {
    let mut numbers = Numbers::of(1);
    for count in [0, 1, 2, 5, 64, 1000] {
        let balls = numbers.balls(count);
        for quality in BuildQuality::ALL {
            let bvh = Bvh::build_with(&balls, &quality.into()).expect("finite bounds");
            assert_eq!(bvh.config().quality, quality);
            let hits = assert_as_brute_force(&bvh, &balls);
            assert!(count < 1000 || hits > 200, "{hits} hits");
        }
    }
}

/// Returns balls that are hard for builders: each three times, so that the least index must win.
fn hostile() -> Vec<Vec<Ball>> {
    let mut numbers = Numbers::of(2);
    let balls = numbers.balls(200);
    let changed = |change: &dyn Fn(usize, Ball) -> Ball| {
        let changed = balls.iter().enumerate().map(|(k, &ball)| change(k, ball));
        let once: Vec<_> = changed.collect();
        [&once[..], &once, &once].concat()
    };
    let scaled =
        |s: f32| changed(&|_, ball| Ball { center: ball.center * s, radius: ball.radius * s });
    let with = |one: Ball| changed(&|k, ball| if k == 77 { one } else { ball });
    vec![
        changed(&|_, _| Ball { center: Vec3::ONE, radius: 0.5 }),
        changed(&|_, ball| Ball { center: Vec3::ZERO, ..ball }),
        changed(&|_, ball| Ball { center: ball.center * Vec3::X, ..ball }),
        changed(&|k, ball| Ball { center: Vec3::X * 1.1f32.powi(k as i32), ..ball }),
        with(Ball { center: Vec3::ZERO, radius: 100.0 }),
        with(Ball { center: Vec3::splat(1e6), radius: 1.0 }),
        scaled(1e-6),
        scaled(1e6),
    ]
}

#[test]
fn every_quality_answers_as_brute_force_on_hostile_scenes() {
    for balls in hostile() {
        for quality in BuildQuality::ALL {
            let bvh = Bvh::build_with(&balls, &quality.into()).expect("finite bounds");
            assert_as_brute_force(&bvh, &balls);
        }
    }
}

/// A wall across the x axis, whose distance is exact.
#[primitive]
#[derive(Debug)]
struct Wall {
    x: f32,
    size: f32,
}

#[primitive]
impl Wall {
    const SLACK: f32 = 0.0;

    fn intersect(&self, ray: Ray) -> Hit {
        let (to_wall, to_origin) = (self.x / ray.direction.x, ray.origin.x / ray.direction.x);
        Hit::new(true, to_wall - to_origin)
    }

    fn get_bounds(&self) -> Aabb {
        Aabb::new(vec3(self.x, -self.size, -self.size), vec3(self.x, self.size, self.size))
    }
}

/// The distance to the scene is infinite as a float, and the primitives ask for no padding.
#[test]
fn walls_without_slack_are_hit_from_farther_than_floats_reach() {
    let walls = [0.0, -1.0, -2.0].map(|x| Wall { x: x * 1e38, size: 1e38 });
    let ray = Ray::new(vec3(2e38, 0.0, 0.0), vec3(-1e38, 0.0, 0.0));
    let bvh = Bvh::build(&walls).expect("finite bounds");
    let hit = bvh.closest_hit(ray);
    assert_eq!((hit.t, hit.prim_id), (2.0, 0));
    let farther = Ray { t_min: 2.5, ..ray };
    assert_eq!(bvh.closest_hit(farther).prim_id, 1);
}
