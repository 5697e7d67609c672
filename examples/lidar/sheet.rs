//! A picture of points: from above, and a section.

use colorous::VIRIDIS;
use image::{Rgb, RgbImage};

use super::points::Point;

/// Pixels along the plan's side and up the section.
const PLAN: u32 = 500;
const SECTION: u32 = 150;
const GAP: u32 = 10;
/// Heights of the first and the last colour, in metres.
const HEIGHTS: [f64; 2] = [-2.0, 45.0];
/// The section is of points this near to a line along x through the wood, in metres.
const MIDDLE: f64 = 62.0;
const THICKNESS: f64 = 2.0;
const PAPER: Rgb<u8> = Rgb([16, 17, 21]);
/// Colours of first, second and later returns.
const NUMBERS: [Rgb<u8>; 3] = [Rgb([120, 190, 235]), Rgb([250, 180, 70]), Rgb([240, 80, 90])];

/// The plan of a square of this side above the section: the highest points from above, coloured by
/// height, brighter where more light came back; then points by the number of their return.
pub(crate) fn picture(points: &[Point], side: f64) -> RgbImage {
    let mut image = RgbImage::from_pixel(PLAN, PLAN + GAP + SECTION, PAPER);
    let scale = f64::from(PLAN) / side;
    let column = |p: &Point| pixel((p.position.x + 0.5 * side) * scale, PLAN);
    let mut tops = vec![f64::NEG_INFINITY; (PLAN * PLAN) as usize];
    for point in points {
        let row = pixel((0.5 * side - point.position.y) * scale, PLAN);
        let (Some(x), Some(y)) = (column(point), row) else { continue };
        let top = &mut tops[(y * PLAN + x) as usize];
        if point.position.z > *top {
            *top = point.position.z;
            image.put_pixel(x, y, tint(point));
        }
    }
    // Later returns lie below others, so they are drawn last.
    for number in 1..=NUMBERS.len() {
        let is_drawn = |p: &&Point| {
            usize::from(p.return_number).min(NUMBERS.len()) == number
                && (p.position.y - MIDDLE).abs() < 0.5 * THICKNESS
        };
        for point in points.iter().filter(is_drawn) {
            let row = pixel((HEIGHTS[1] + 5.0 - point.position.z) * scale, SECTION);
            if let (Some(x), Some(y)) = (column(point), row) {
                image.put_pixel(x, PLAN + GAP + y, NUMBERS[number - 1]);
            }
        }
    }
    image
}

/// The pixel at a place, if it is one of `count`.
fn pixel(place: f64, count: u32) -> Option<u32> {
    (place >= 0.0 && place < f64::from(count)).then_some(place as u32)
}

fn tint(point: &Point) -> Rgb<u8> {
    let [low, high] = HEIGHTS;
    // Low land has more colours than hills.
    let share = ((point.position.z - low) / (high - low)).clamp(0.0, 1.0);
    let color = VIRIDIS.eval_continuous(share.sqrt());
    // Half of the brightness is the light that came back.
    let light = 0.45 + 0.55 * (f64::from(point.intensity) / 20_000.0).min(1.0);
    Rgb([color.r, color.g, color.b].map(|c| (f64::from(c) * light) as u8))
}
