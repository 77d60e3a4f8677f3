//! A point is in the face that lies on its side of every line.

mod common;

use common::{Case, Random};
use groundplan::lines::Lines;
use groundplan::locate::{Locator, Polygons};

fn locator(case: &Case) -> Locator {
    let count = case.offsets.len();
    let lines = Lines {
        directions: case.directions.clone(),
        offsets: case.offsets.clone(),
        amplitudes: vec![1.0; count],
        widths: vec![0.0; count],
        min_amplitude: 0.0,
    };
    Locator::new(&case.frame, &case.angles, &lines)
}

/// Every half-edge around the face of a point must have the point on its left, or on it as the rule has it.
fn check(case: &Case, locator: &Locator, pixels: [f64; 2]) -> Result<(), String> {
    let arrangement = locator.arrangement();
    let step = (1u64 << 26) as f64;
    let metres = case.frame.to_metres(pixels);
    let again = case.frame.to_pixels(metres);
    let inside =
        (0.0..=case.frame.width as f64).contains(&again[0]) && (0.0..=case.frame.height as f64).contains(&again[1]);
    let Some(face) = locator.locate(metres) else {
        return if inside { Err(format!("{pixels:?} is in no face")) } else { Ok(()) };
    };
    let [x, y] = again.map(|p| i128::from((p * step).round() as i64));
    let on_border = x == 0 || y == 0 || x == (case.frame.width as i128) << 26 || y == (case.frame.height as i128) << 26;
    for &half in arrangement.around(face as usize) {
        let Some(line) = arrangement.lines.get(arrangement.edge_lines[(half >> 1) as usize] as usize) else { continue };
        let value = i128::from(line.a) * x + i128::from(line.b) * y - (i128::from(line.c) << 26);
        // Where lines meet on the border, the face that the rule asks for may lie outside.
        if (value >= 0) != (half & 1 == 0) && !(on_border && value == 0) {
            return Err(format!("{pixels:?} is not in face {face}: {value} from line {line:?}"));
        }
    }
    Ok(())
}

#[test]
fn a_point_is_in_the_face_on_its_side_of_every_line() {
    for seed in 0..500 {
        let case = Case::random(seed);
        let locator = locator(&case);
        let made = case.check().unwrap_or_else(|fault| panic!("seed {seed}: {fault}"));
        assert_eq!(locator.arrangement().face_count(), made.subdivision.faces());
        let mut random = Random(seed ^ 0x5eed);
        let (w, h) = (case.frame.width as f64, case.frame.height as f64);
        let vertices = locator.arrangement().vertices.clone();
        let mut points: Vec<[f64; 2]> =
            (0..40).map(|_| [random.between(-0.1 * w, 1.1 * w), random.between(0.0, h)]).collect();
        points.extend((0..20).map(|_| [random.below(w as u64 + 1) as f64, random.below(h as u64 + 1) as f64 / 2.0]));
        points.extend(vertices.iter().take(40));
        for point in points {
            if let Err(fault) = check(&case, &locator, point) {
                panic!("seed {seed}: {fault}");
            }
        }
    }
}

#[test]
fn a_point_on_a_line_is_on_the_side_of_its_normal() {
    let mut case = Case::new(100, 80);
    let (level, upright) = (case.family(0.0), case.family(-90.0));
    case.through(level, 0.0, 30.0);
    case.through(upright, 40.0, 0.0);
    let locator = locator(&case);
    assert_eq!(locator.locate([10.0, 30.0]), locator.locate([10.0, 30.5]));
    assert_eq!(locator.locate([40.0, 10.0]), locator.locate([40.5, 10.0]));
    assert_eq!(locator.locate([40.0, 30.0]), locator.locate([41.0, 31.0]));
    assert_ne!(locator.locate([40.0, 30.0]), locator.locate([39.0, 31.0]));
}

#[test]
fn the_border_is_of_the_map_and_beyond_is_nothing() {
    let locator = locator(&Case::new(100, 80));
    for inside in [[0.0, 0.0], [100.0, 80.0], [0.0, 80.0], [50.0, 40.0]] {
        assert_eq!(locator.locate(inside), Some(0));
    }
    for outside in [[-1e-9, 0.0], [100.1, 1.0], [f64::NAN, 1.0], [1.0, f64::INFINITY]] {
        assert_eq!(locator.locate(outside), None);
    }
}

#[test]
fn a_straight_line_passes_through_the_faces_in_order() {
    let mut case = Case::new(100, 80);
    let upright = case.family(-90.0);
    for x in [20.0, 40.0, 60.0] {
        case.through(upright, x, 0.0);
    }
    let locator = locator(&case);
    let faces = locator.between([10.0, 10.0], [50.0, 70.0]);
    assert_eq!(faces, [[10.0, 1.0], [30.0, 1.0], [50.0, 1.0]].map(|p| locator.locate(p).unwrap()));
    assert_eq!(locator.between([50.0, 70.0], [50.0, 70.0]).len(), 1);
}

#[test]
fn a_polygon_holds_what_is_within_it_and_not_in_its_holes() {
    let square = |x: f64, side: f64| vec![[x, x], [x + side, x], [x + side, x + side], [x, x + side]];
    let polygons = Polygons::new(&[(3, square(0.0, 10.0)), (3, square(4.0, 2.0)), (1, square(5.0, 20.0))]);
    assert_eq!(polygons.holding([1.0, 1.0]), [3]);
    assert_eq!(polygons.holding([4.5, 4.5]), []);
    assert_eq!(polygons.holding([7.0, 7.0]), [1, 3]);
    assert_eq!(polygons.holding([24.0, 24.0]), [1]);
    for outside in [[-1.0, 5.0], [5.0, -1.0], [30.0, 5.0], [5.0, 1e9], [f64::NAN, f64::NAN]] {
        assert_eq!(polygons.holding(outside), []);
    }
    assert_eq!(Polygons::new(&[]).holding([0.0, 0.0]), []);
}
