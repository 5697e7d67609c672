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
        self.intersect(ray) //~ macro
    }

    fn get_bounds(&self) -> Aabb {
        Aabb { min: self.center - self.radius, max: self.center + self.radius }
    }
}

fn main() {}
