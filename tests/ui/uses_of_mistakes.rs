use raydsl::kernel;
use raydsl::prelude::*;

#[derive(Clone, Copy, Type)]
struct Fine {
    wide: f64, //~ macro
    narrow: f32,
}

#[kernel]
impl Fine {
    fn twice(&self) -> f32 {
        self.narrow * 2.0
    }
}

#[kernel]
fn used(fine: Fine, x: f32) -> f32 {
    fine.narrow + fine.twice() * x
}

#[kernel]
fn counted(n: u64) -> f32 { //~ macro
    0.5
}

#[kernel]
fn calls(x: f32) -> f32 {
    counted(1) + x
}

#[primitive]
struct Disk(Vec3, f32); //~ macro

#[primitive]
impl Disk {
    fn intersect(&self, ray: Ray) -> Hit {
        Hit::new(ray.t_min < self.1, self.1)
    }

    fn get_bounds(&self) -> Aabb {
        Aabb { min: self.0 - self.1, max: self.0 + self.1 }
    }
}

#[primitive]
struct Ball {
    center: Vec3,
    radius: f32,
}

#[primitive]
impl Ball { //~ macro
    fn intersect(&self, ray: Ray) -> Hit {
        Hit::new(ray.t_min < self.radius, self.radius)
    }
}

#[kernel]
fn looped(x: f32) -> f32 {
    println!("{x}"); //~ macro
    x
}

fn shade(disks: &[Disk], balls: &[Ball], fine: Fine) {
    let disks = Bvh::build(disks).unwrap();
    let balls = Bvh::build(balls).unwrap();
    let k = kernel!(|ray: Ray| {
        disks.closest_hit(ray).t + balls.closest_hit(ray).t + fine.narrow + looped(ray.t_min)
    });
    k.wgsl();
    let k = Kernel::of::<counted>();
    k.wgsl();
    let k = kernel!(|x: f32| x.sin()); //~ macro
    k.wgsl();
}

fn main() {}
