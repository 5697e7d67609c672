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

    fn get_bounds(&self) -> Vec3 { //~ macro
        self.center
    }
}

fn main() {}
