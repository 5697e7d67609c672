use raydsl::kernel;
use raydsl::prelude::*;

#[primitive]
struct Ball {
    center: Vec3,
    radius: u32,
}

#[primitive]
impl Ball {
    fn intersect(&self, ray: Ray, radii: &[f32]) -> Hit {
        sphere::intersect(ray, self.center, radii[self.radius as usize])
    }

    fn get_bounds(&self, radii: &[f32]) -> Aabb {
        sphere::get_bounds(self.center, radii[self.radius as usize])
    }
}

#[primitive(shared(Vec3, u32))]
enum Shape {
    Face(IndexedTriangle),
    Ball(Ball), //~ lifted
}

fn main() {}
