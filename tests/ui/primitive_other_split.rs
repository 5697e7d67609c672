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

    fn get_bounds(&self) -> Aabb {
        Aabb { min: self.center - self.radius, max: self.center + self.radius }
    }

    fn split_primitive(&self, axis: u32, at: f32) -> Aabb { //~ macro
        self.get_bounds()
    }
}

fn main() {}
