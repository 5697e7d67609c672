mod shapes {
    use raydsl::kernel;
    use raydsl::prelude::*;

    #[derive(Clone, Copy, Type)]
    pub struct Ball {
        pub radius: f32,
    }

    #[kernel]
    impl Ball {
        fn intersect(&self, x: f32) -> f32 {
            self.radius * x
        }
    }
}

use raydsl::kernel;
use raydsl::prelude::*;

#[kernel]
fn shade(ball: shapes::Ball, x: f32) -> f32 {
    ball.intersect(x) //~ rustc
}

fn main() {}
