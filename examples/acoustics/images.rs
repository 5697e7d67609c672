//! The exact response: image sources (Allen and Berkley, "Image method for efficiently simulating
//! small-room acoustics", JASA 65(4), 1979), of energies instead of pressures, averaged over the
//! receiver.

use super::bins::Bins;
use super::room::Room;

/// Nodes and weights of Gauss and Legendre with five points on [-1, 1].
const NODES: [(f64, f64); 5] = [
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
    (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
];

/// What mirrors do along one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Mirrored {
    /// Offset from the receiver.
    pub(crate) offset: f64,
    /// Share of energy that is left.
    pub(crate) energy: f64,
}

/// The images along an axis whose offset is at most `reach`.
pub(crate) fn along(room: &Room, axis: usize, reach: f64) -> Vec<Mirrored> {
    let (side, source, receiver) = (room.size[axis], room.source[axis], room.receiver[axis]);
    let [low, high] = [0, 1].map(|far| 1.0 - room.absorption[2 * axis + far]);
    let last = (0.5 * reach / side).ceil() as i32 + 1;
    let image = |(n, is_mirrored): (i32, bool)| {
        let place = 2.0 * f64::from(n) * side + if is_mirrored { -source } else { source };
        let at_low = (n - i32::from(is_mirrored)).abs();
        Mirrored { offset: place - receiver, energy: low.powi(at_low) * high.powi(n.abs()) }
    };
    let all = (-last..=last).flat_map(|n| [(n, false), (n, true)]).map(image);
    all.filter(|m| m.offset.abs() <= reach).collect()
}

/// Energy in each bin, per square metre: what flows through the receiver, averaged over it.
pub(crate) fn response(room: &Room, bins: Bins) -> Vec<f64> {
    let mut energy = vec![0.0; bins.count];
    let reach = bins.reach() + room.radius;
    let axes = [0, 1, 2].map(|axis| along(room, axis, reach));
    for x in &axes[0] {
        for y in &axes[1] {
            let (flat, both) = (x.offset.powi(2) + y.offset.powi(2), x.energy * y.energy);
            if flat > reach * reach {
                continue;
            }
            for z in &axes[2] {
                let distance = (flat + z.offset.powi(2)).sqrt();
                add(&mut energy, room, bins, distance, both * z.energy);
            }
        }
    }
    energy
}

/// Adds a source of this energy at this distance from the receiver's centre.
fn add(into: &mut [f64], room: &Room, bins: Bins, distance: f64, energy: f64) {
    for (i, from, to) in bins.parts(distance - room.radius, distance + room.radius) {
        into[i] += energy * of_shell(room, distance, from, to);
    }
}

/// The mean over the receiver of `exp(-air r) / (4 π r²)`, as far as `r` is between `from` and `to`.
///
/// The sphere of radius `r` around the source has the area `π r (R² - (d - r)²) / d` within a ball of
/// radius `R` at the distance `d`.
pub(crate) fn of_shell(room: &Room, distance: f64, from: f64, to: f64) -> f64 {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let at = |(node, weight): &(f64, f64)| {
        let r = middle + half * node;
        weight * (room.radius.powi(2) - (distance - r).powi(2)) / r * (-room.air * r).exp()
    };
    half * NODES.iter().map(at).sum::<f64>() / (4.0 * distance * room.ball_volume())
}
