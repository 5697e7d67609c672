use raydsl::kernel;
use raydsl::prelude::*;

#[primitive]
struct Ball {
    center: Vec3,
    radius: f32,
}

#[primitive]
impl Ball {
    fn intersect(&self, ray: Ray) -> Hit {
        sphere::intersect(ray, self.center, self.radius)
    }

    fn get_bounds(&self) -> Aabb {
        sphere::get_bounds(self.center, self.radius)
    }

    fn normal(&self, ray: Ray, hit: Hit) -> Vec3 {
        sphere::normal(ray, hit, self.center, self.radius)
    }
}

#[primitive(
    normal,
    area, //~ lifted
)]
enum Shape {
    Ball(Ball),
    Facet(Triangle),
}

fn main() {}
