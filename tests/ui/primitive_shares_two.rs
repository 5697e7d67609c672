use raydsl::kernel;
use raydsl::prelude::*;

#[primitive]
struct Disk {
    center: u32,
    radius: f32,
}

#[primitive]
impl Disk {
    fn intersect(&self, ray: Ray, centers: &[Vec3]) -> Hit {
        sphere::intersect(ray, centers[self.center as usize], self.radius)
    }

    fn get_bounds(&self, radii: &[f32]) -> Aabb { //~ macro
        Aabb::EMPTY
    }
}

fn main() {}
