//! The arrangement is right for every input, degenerate input most of all.

mod common;

use common::{Arranged, Case, STEP};

fn sound(case: &Case) -> Arranged {
    case.check().unwrap_or_else(|fault| panic!("{fault} in {case:?}"))
}

fn faces(case: &Case) -> usize {
    sound(case).subdivision.faces()
}

/// The degree of the vertex that lies at a point of the grid.
fn degree(made: &Arranged, x: f64, y: f64) -> usize {
    let vertices = &made.arrangement.vertices;
    let near = |[vx, vy]: [f64; 2]| (vx - x).abs() < 1e-9 && (vy - y).abs() < 1e-9;
    let at: Vec<u32> = (0..vertices.len() as u32).filter(|&v| near(vertices[v as usize])).collect();
    assert_eq!(at.len(), 1, "one vertex at {x} {y}");
    made.arrangement.edges.iter().flatten().filter(|&&v| v == at[0]).count()
}

#[test]
fn no_lines_leave_one_face() {
    let made = sound(&Case::new(30, 20));
    assert_eq!(made.subdivision.faces(), 1);
    assert_eq!(made.subdivision.areas, [600.0]);
    assert_eq!(made.subdivision.centres, [[15.0, 10.0]]);
    let mut directions_only = Case::new(30, 20);
    directions_only.family(30.0);
    directions_only.family(-60.0);
    assert_eq!(faces(&directions_only), 1);
}

#[test]
fn two_families_that_cross_inside_make_a_grid() {
    for (one, two) in [(0.0, -90.0), (17.0, -73.0), (45.0, -45.0), (10.0, 80.0), (30.0, -80.0)] {
        let (n, m) = (4, 3);
        let mut case = Case::new(100, 100);
        let (f, g) = (case.family(one), case.family(two));
        // Near the middle, so that every crossing lies inside.
        let middle = |case: &mut Case, family: u32, count: i32| {
            for k in 0..count {
                let shift = 2.0 * f64::from(k) + 0.3;
                let angle = case.angles[family as usize];
                case.through(family, 50.0 - shift * angle.sin(), 50.0 + shift * angle.cos());
            }
        };
        middle(&mut case, f, n);
        middle(&mut case, g, m);
        assert_eq!(faces(&case) as i32, n * m + n + m + 1, "{one} and {two} degrees");
    }
}

#[test]
fn three_lines_through_a_point_share_one_vertex() {
    let mut case = Case::new(60, 50);
    for degrees in [0.0, 60.0, -60.0] {
        let family = case.family(degrees);
        case.through(family, 20.0, 30.0);
    }
    let made = sound(&case);
    assert_eq!(made.subdivision.faces(), 6);
    assert_eq!(degree(&made, 20.0, 30.0), 6);
}

#[test]
fn three_lines_that_miss_each_other_by_a_lattice_step_make_a_triangle() {
    let mut case = Case::new(60, 50);
    for degrees in [0.0, 60.0, -60.0] {
        let family = case.family(degrees);
        case.through(family, 20.0, 30.0);
    }
    case.offsets[1] += STEP;
    assert_eq!(faces(&case), 7);
}

#[test]
fn eight_families_meet_in_the_middle() {
    let mut case = Case::new(64, 64);
    for n in 0..8 {
        let family = case.family(-90.0 + 22.5 * f64::from(n));
        case.through(family, 32.0, 32.0);
    }
    let made = sound(&case);
    assert_eq!(made.subdivision.faces(), 16);
    assert_eq!(degree(&made, 32.0, 32.0), 16);
}

#[test]
fn four_families_meet_in_every_point_of_a_grid() {
    let mut case = Case::new(40, 40);
    for degrees in [0.0, -90.0, 45.0, -45.0] {
        let family = case.family(degrees);
        for n in -10..=20 {
            let at = 4.0 * f64::from(n);
            let (x, y) = if degrees == 0.0 { (0.0, at) } else { (at, 0.0) };
            case.through(family, x, y);
        }
    }
    let made = sound(&case);
    let whole = |value: f64| value == 4.0 * (value / 4.0).round();
    for (v, &[x, y]) in made.arrangement.vertices.iter().enumerate() {
        let inside = x > 0.0 && x < 40.0 && y > 0.0 && y < 40.0;
        let ways = made.arrangement.edges.iter().flatten().filter(|&&end| end as usize == v).count();
        assert!(!inside || ways == if whole(x) && whole(y) { 8 } else { 4 }, "{x} {y}: {ways}");
    }
    // Every square of the grid is four triangles.
    assert_eq!(made.subdivision.faces(), 10 * 10 * 4);
}

#[test]
fn lines_of_one_direction_never_meet() {
    for degrees in [0.0, -90.0, 45.0, 17.0] {
        for apart in [1.0, 1e-3, STEP] {
            let mut case = Case::new(60, 60);
            let (family, across) = (case.family(degrees), case.family(degrees + 90.0));
            for n in 0..5 {
                let angle = case.angles[0];
                let shift = apart * f64::from(n);
                case.through(family, 30.0 - shift * angle.sin(), 30.0 + shift * angle.cos());
            }
            case.through(across, 30.25, 30.25);
            assert_eq!(faces(&case), 12, "{degrees} degrees, {apart} apart");
        }
    }
}

#[test]
fn the_same_line_twice_counts_once() {
    let mut case = Case::new(60, 50);
    let family = case.family(17.0);
    let again = case.family(17.0);
    for _ in 0..3 {
        case.through(family, 30.0, 30.0);
        case.through(again, 30.0, 30.0);
    }
    let made = sound(&case);
    assert_eq!(made.subdivision.faces(), 2);
    let with_edges = made.arrangement.line_edges.iter().filter(|edges| !edges.is_empty()).count();
    assert_eq!(with_edges, 1);
}

#[test]
fn a_direction_and_its_opposite_are_one() {
    let mut case = Case::new(60, 50);
    let (there, back) = (case.family(17.0), case.family(197.0));
    case.line(there, 12.0);
    case.line(back, -12.0);
    assert_eq!(faces(&case), 2);
}

#[test]
fn two_directions_half_a_degree_apart_cross_far_off_or_not_at_all() {
    let mut case = Case::new(400, 300);
    let (one, two) = (case.family(20.0), case.family(20.5));
    for n in 0..40 {
        let y = 7.0 * f64::from(n);
        case.through(one, 200.0, y);
        case.through(two, 200.0, y);
    }
    let made = sound(&case);
    assert_eq!(degree(&made, 200.0, 70.0), 4);
}

#[test]
fn nearly_parallel_lines_cross_where_they_do() {
    for turn in [1e-3, 1e-5, 1e-6] {
        let mut case = Case::new(1000, 1000);
        let (one, two) = (case.family(31.0), case.family(31.0 + turn));
        for n in 1..10 {
            let at = 100.0 * f64::from(n);
            case.through(one, at, at);
            case.through(two, at, at);
        }
        assert_eq!(faces(&case), 1 + 18 + 9, "{turn} degrees");
    }
}

#[test]
fn lines_through_the_corners_cut_no_slivers() {
    let (w, h) = (60.0, 40.0);
    let mut case = Case::new(60, 40);
    let (rising, falling) = (case.family(45.0), case.family(-45.0));
    for (x, y) in [(0.0, 0.0), (w, h)] {
        case.through(rising, x, y);
        // Outside but for the corner.
        case.through(falling, x, y);
    }
    for (x, y) in [(w, 0.0), (0.0, h)] {
        case.through(falling, x, y);
        case.through(rising, x, y);
    }
    let made = sound(&case);
    // Four lines cross the interior, two of each family: 2 * 2 + 2 + 2 + 1.
    assert_eq!(made.subdivision.faces(), 9);
    assert_eq!(degree(&made, 0.0, 0.0), 3);
}

#[test]
fn a_fan_from_a_corner_has_one_vertex_there() {
    for (x, y) in [(0.0, 0.0), (60.0, 0.0), (60.0, 40.0), (0.0, 40.0)] {
        let mut case = Case::new(60, 40);
        for n in 0..18 {
            let family = case.family(-90.0 + 10.0 * f64::from(n));
            case.through(family, x, y);
        }
        let made = sound(&case);
        assert_eq!(made.subdivision.faces(), 9, "{x} {y}");
        assert_eq!(degree(&made, x, y), 10, "{x} {y}");
    }
}

#[test]
fn diagonals_from_corner_to_corner_make_four_triangles() {
    let mut case = Case::new(40, 40);
    for (degrees, x) in [(45.0, 0.0), (-45.0, 40.0)] {
        let family = case.family(degrees);
        case.through(family, x, 0.0);
    }
    let made = sound(&case);
    assert_eq!((made.subdivision.faces(), made.arrangement.vertices.len()), (4, 5));
    assert_eq!(made.subdivision.areas, [400.0; 4]);
}

#[test]
fn lines_along_the_border_and_outside_cut_nothing() {
    let mut case = Case::new(60, 40);
    let (level, upright, slanted) = (case.family(0.0), case.family(-90.0), case.family(30.0));
    for offset in [0.0, 40.0, -1.0, 41.0, 1e9, -1e9, 1e300, f64::MAX] {
        case.line(level, offset);
    }
    for offset in [0.0, 60.0, -1.0, 61.0, -1e9, f64::MIN] {
        case.line(upright, offset);
    }
    for offset in [-31.0, 36.0, 1e12, -1e12] {
        case.line(slanted, offset);
    }
    let made = sound(&case);
    assert_eq!(made.subdivision.faces(), 1);
    assert_eq!(made.arrangement.lines.len(), case.offsets.len());
    assert!(made.arrangement.line_edges.iter().all(std::ops::Range::is_empty));
}

#[test]
fn level_and_upright_lines_alone() {
    let mut case = Case::new(60, 40);
    let level = case.family(0.0);
    for y in [STEP, 0.5, 20.0, 39.5, 40.0 - STEP] {
        case.through(level, 0.0, y);
    }
    assert_eq!(faces(&case), 6);
    let mut case = Case::new(60, 40);
    let upright = case.family(90.0);
    for x in [STEP, 0.5, 30.0, 59.5, 60.0 - STEP] {
        case.through(upright, x, 0.0);
    }
    assert_eq!(faces(&case), 6);
}

#[test]
fn a_map_of_one_pixel_can_be_cut() {
    let mut case = Case::new(1, 1);
    for n in 0..8 {
        let family = case.family(-90.0 + 22.5 * f64::from(n));
        case.through(family, 0.5, 0.5);
    }
    assert_eq!(faces(&case), 16);
}

#[test]
fn a_map_of_one_row_can_be_cut() {
    for degrees in [-90.0, 45.0, 1.0, -1.0] {
        let mut case = Case::new(200, 1);
        let (family, level) = (case.family(degrees), case.family(0.0));
        for n in 0..200 {
            case.through(family, f64::from(n) + 0.5, 0.5);
        }
        case.through(level, 0.0, 0.5);
        assert_eq!(faces(&case), 402, "{degrees} degrees");
        let mut turned = Case::new(1, 200);
        let (family, upright) = (turned.family(degrees + 90.0), turned.family(-90.0));
        for n in 0..200 {
            turned.through(family, 0.5, f64::from(n) + 0.5);
        }
        turned.through(upright, 0.5, 0.0);
        assert_eq!(faces(&turned), 402, "{degrees} degrees, turned");
    }
}

#[test]
fn a_map_of_forty_thousand_pixels_square_is_as_exact_as_a_small_one() {
    let side = 40_000;
    let mut case = Case::new(side, side);
    let far = side as f64 - 1.0;
    for degrees in [0.0, -90.0, 45.0, 12.3, -77.7, 33.0, 33.5] {
        let family = case.family(degrees);
        for (x, y) in [(1.0, 1.0), (far, far), (far, 1.0), (20_001.0, 19_999.0), (12_345.0, 34_567.0)] {
            case.through(family, x, y);
        }
    }
    let made = sound(&case);
    assert_eq!(degree(&made, far, far), 14);
    assert_eq!(degree(&made, 12_345.0, 34_567.0), 14);
}

#[test]
fn the_largest_map_in_a_far_frame_holds() {
    // 131,072 pixels of 5 cm square, UTM coordinates, turned.
    let mut case = Case::new(131_072, 131_072);
    case.frame = groundplan::Frame::new(131_072, 131_072, 0.05, [500_000.0, 6_000_000.0, 0.7]);
    for degrees in [0.0, 90.0, 45.0, 45.000_001, 12.3] {
        let family = case.family(degrees);
        for n in 1..8 {
            let at = 16_384.0 * f64::from(n);
            case.through(family, at, at);
        }
    }
    sound(&case);
}

#[test]
fn a_thousand_lines_by_a_thousand_make_a_million_faces() {
    let mut case = Case::new(5000, 4000);
    let (one, two) = (case.family(3.0), case.family(-87.0));
    for n in 0..1000 {
        let at = f64::from(n);
        case.through(one, 2500.0, 1000.0 + at);
        case.through(two, 2000.0 + at, 2000.0);
    }
    let made = case.arrange();
    assert_eq!(made.subdivision.faces(), 1000 * 1000 + 1000 + 1000 + 1);
    assert_eq!(made.subdivision.problems(), Vec::<String>::new());
}

#[test]
fn many_faces_smaller_than_a_square_millimetre_still_add_up() {
    let mut case = Case::new(60, 60);
    case.frame = groundplan::Frame::new(60, 60, 0.05, [0.0; 3]);
    let (one, two) = (case.family(0.0), case.family(-90.0));
    for n in 0..300 {
        let at = 30.0 + 0.017 * f64::from(n);
        case.through(one, at, at);
        case.through(two, at, at);
    }
    let made = case.arrange();
    assert_eq!(made.subdivision.faces(), 301 * 301);
    assert_eq!(made.subdivision.problems(), Vec::<String>::new());
}

#[test]
fn many_directions_at_one_point_keep_their_order() {
    let mut case = Case::new(50, 50);
    for n in 0..90 {
        let family = case.family(-90.0 + 2.0 * f64::from(n));
        case.through(family, 25.0, 25.0);
    }
    assert_eq!(faces(&case), 180);
}

#[test]
fn two_thousand_random_arrangements_hold() {
    for seed in 0..2000 {
        if let Err(fault) = Case::random(seed).check() {
            panic!("seed {seed}: {fault}");
        }
    }
}
