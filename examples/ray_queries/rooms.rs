//! Rooms, seen from above.

use raydsl::prelude::*;

/// A wall or a pillar.
#[primitive]
pub(crate) struct Block {
    pub(crate) low: Vec3,
    pub(crate) high: Vec3,
}

#[primitive]
impl Block {
    fn intersect(&self, ray: Ray) -> Hit {
        cuboid::intersect(ray, self.low, self.high)
    }

    fn get_bounds(&self) -> Aabb {
        cuboid::get_bounds(self.low, self.high)
    }
}

/// Rooms with doors, 22 by 14, and two rows of pillars in the hall.
pub(crate) fn plan() -> Vec<Block> {
    let walls = [
        [0.0, 0.0, 22.0, 0.3],
        [0.0, 13.7, 22.0, 14.0],
        [0.0, 0.0, 0.3, 14.0],
        [21.7, 0.0, 22.0, 14.0],
        [7.0, 0.0, 7.3, 4.0],
        [7.0, 6.0, 7.3, 9.5],
        [7.0, 11.5, 7.3, 14.0],
        [0.0, 7.5, 4.2, 7.8],
        [5.6, 7.5, 7.0, 7.8],
        [15.5, 8.5, 15.8, 14.0],
        [15.5, 8.5, 18.0, 8.8],
        [19.5, 8.5, 22.0, 8.8],
    ];
    let pillars = (0..6).flat_map(|i| {
        let x = 9.0 + 2.1 * i as f32;
        [2.8, 6.2].map(|y| [x, y, x + 0.45, y + 0.45])
    });
    let block =
        |[x0, y0, x1, y1]: [f32; 4]| Block { low: vec3(x0, y0, 0.0), high: vec3(x1, y1, 2.5) };
    walls.into_iter().chain(pillars).map(block).collect()
}
