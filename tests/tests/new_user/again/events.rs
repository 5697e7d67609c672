//! The first events along a ray, kept in order. (enum with fields, computed index, swap, bare
//! integers)

use raydsl::prelude::*;
use raydsl::{assert_variants_agree, kernel};

#[derive(Clone, Copy, Type)]
enum Event {
    None,
    Shell { t: f32, radius: f32 },
    Plane(f32),
}

#[kernel]
impl Event {
    fn at(&self) -> f32 {
        match *self {
            Event::None => f32::INFINITY,
            Event::Shell { t, .. } | Event::Plane(t) => t,
        }
    }
}

/// Puts an event in its place; the last one is lost.
#[kernel]
fn insert(events: &mut [Event; 4], event: Event) {
    if event.at() >= events[3].at() {
        return;
    }
    events[3] = event;
    let mut i = 3;
    while i > 0 && events[i].at() < events[i - 1].at() {
        events.swap(i, i - 1);
        i -= 1;
    }
}

#[kernel]
fn events(radii: &[f32], heights: &[f32], ray: Ray) -> [Event; 4] {
    let mut found = [Event::None; 4];
    let b = ray.origin.dot(ray.direction);
    for &radius in radii {
        let inner = b * b - ray.origin.length_squared() + radius * radius;
        if inner < 0.0 {
            continue;
        }
        for sign in [-1.0, 1.0] {
            let t = -b + sign * inner.sqrt();
            if t > 0.0 {
                insert(&mut found, Event::Shell { t, radius });
            }
        }
    }
    for &height in heights {
        let t = (height - ray.origin.z) / ray.direction.z;
        if t > 0.0 {
            insert(&mut found, Event::Plane(t));
        }
    }
    found
}

#[test]
fn events_are_in_order() {
    let (radii, heights) = (vec![1.0, 2.0, 0.5], vec![-0.75, 0.8]);
    let kernel = kernel!(|ray: Ray| {
        let found = events(&radii, &heights, ray);
        let shells = match found[0] {
            Event::Shell { radius, .. } => radius,
            _ => 0.0,
        };
        vec4(found[0].at(), found[1].at(), found[2].at(), shells)
    });
    let rays: Vec<Ray> = (0..300)
        .map(|i| {
            let d = vec3((i % 17) as f32 * 0.03 - 0.24, (i % 13) as f32 * 0.04 - 0.24, 1.0);
            Ray::new(vec3(0.1, -0.2, -4.0), d.normalize())
        })
        .collect();
    assert_variants_agree!(&kernel, &rays);
    let seen = kernel.call((Ray::new(vec3(0.0, 0.0, -4.0), Vec3::Z),));
    assert_eq!(seen, vec4(2.0, 3.0, 3.25, 2.0));
}
