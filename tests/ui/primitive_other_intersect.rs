use raydsl::kernel;
use raydsl::prelude::*;

#[primitive]
struct Disk {
    center: Vec3,
    radius: f32,
}

#[primitive]
impl Disk {
    fn intersect(&self, ray: Ray, t: f32) -> Hit { //~ macro
        Hit::new(ray.t_min < self.radius, t)
    }

    fn get_bounds(&self) -> Aabb {
        Aabb { min: self.center - self.radius, max: self.center + self.radius }
    }
}

fn main() {}
