use raydsl::kernel;
use raydsl::prelude::*;

#[primitive]
struct Disk {
    center: Vec3,
    radius: f32,
}

#[primitive]
impl Disk {
    fn intersect(&self, ray: Ray) -> Hit {
        Hit::new(ray.t_min < self.radius, self.radius)
    }

    fn get_bounds(&self, time: f32) -> Aabb { //~ macro
        Aabb { min: self.center - time, max: self.center + time }
    }
}

fn main() {}
