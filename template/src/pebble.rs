//! The primitive: an ellipsoid along the axes.

use raydsl::prelude::*;

/// An ellipsoid with a colour.
#[primitive]
pub struct Pebble {
    /// Its centre.
    pub center: Vec3,
    /// From 0, grey, to 1, brown.
    pub warmth: f32,
    /// Half its size along each axis.
    pub radii: Vec3,
    /// The share of light that it reflects.
    pub albedo: f32,
}

#[primitive]
impl Pebble {
    /// Divided by the radii, the pebble is a sphere of radius 1, and a hit has the same `t`.
    fn intersect(&self, ray: Ray) -> Hit {
        let origin = (ray.origin - self.center) / self.radii;
        let scaled = Ray::new(origin, ray.direction / self.radii).with_range(ray.t_min, ray.t_max);
        sphere::intersect(scaled, Vec3::ZERO, 1.0)
    }

    /// A box around it, larger by what the sums round off. Runs on the host only.
    fn get_bounds(&self) -> Aabb {
        let slack = 1e-6 * (self.center.abs() + self.radii);
        Aabb::new(
            self.center - self.radii - slack,
            self.center + self.radii + slack,
        )
    }

    /// The unit normal at a point of its surface.
    pub fn normal(&self, point: Vec3) -> Vec3 {
        ((point - self.center) / (self.radii * self.radii)).normalize()
    }

    /// The colour of its surface, linear.
    pub fn color(&self) -> Vec3 {
        let grey = vec3(0.8, 0.8, 0.82);
        let brown = vec3(0.85, 0.6, 0.42);
        (grey + (brown - grey) * self.warmth) * self.albedo
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_from_above_hits_the_top() {
        let pebble = Pebble {
            center: vec3(1.0, 0.5, -2.0),
            warmth: 0.0,
            radii: vec3(0.5, 0.25, 1.0),
            albedo: 1.0,
        };
        let hit = pebble.intersect(Ray::new(vec3(1.0, 3.0, -2.0), -Vec3::Y));
        assert!(hit.is_hit && (hit.t - 2.25).abs() < 1e-5, "{hit:?}");
        assert!(pebble.normal(vec3(1.0, 0.75, -2.0)).distance(Vec3::Y) < 1e-5);
        assert!(
            !pebble
                .intersect(Ray::new(vec3(1.6, 3.0, -2.0), -Vec3::Y))
                .is_hit
        );
    }
}
