//! Random input without end, for hours when no one waits: `GROUNDPLAN_FUZZ_SECONDS` says how long and
//! `GROUNDPLAN_FUZZ_SEED` where to start. A seed that fails is printed; it stays here as a test of its own.

mod common;

use common::{Case, Random, STEP};
use groundplan::arrangement::arrange;
use groundplan::gradients::Gradients;
use groundplan::parameters::{Method, Range};
use groundplan::subdivision::Subdivision;
use groundplan::{Frame, Given, Grid, Parameters, Survey, TABLE, Table, Value, survey, survey_sparingly};
use std::time::{Duration, Instant};

/// As random cases are, on maps up to the largest, where sums of products are at their widest.
fn large_case(seed: u64) -> Case {
    let mut random = Random(seed);
    let sides = [1, 100, 4096, 40_000, 131_072];
    let mut case = Case::new(random.pick(&sides) as usize, random.pick(&sides) as usize);
    let (w, h) = (case.frame.width as f64, case.frame.height as f64);
    if random.below(2) == 0 {
        let origin = [random.between(-1e6, 1e6), random.between(-1e6, 1e6), random.between(-4.0, 4.0)];
        let resolution = random.pick(&[0.01, 0.05, 1.0, 10.0]);
        case.frame = Frame::new(case.frame.width, case.frame.height, resolution, origin);
    }
    let first = random.between(-90.0, 90.0);
    for _ in 0..=random.below(8) {
        let near = first + random.pick(&[0.0, 0.5, 1e-4, 1e-6, 4e-7, 90.0]);
        let degrees = random.pick(&[near, near, 0.0, -90.0, 45.0, 1e-6, 89.999_999]);
        case.family(degrees);
    }
    for _ in 0..random.below(40) {
        let family = random.below(case.angles.len() as u64) as u32;
        let last = case.offsets.last().copied().unwrap_or(0.0);
        match random.below(4) {
            0 => case.line(family, last + random.pick(&[0.0, STEP, 1e-6, 1e-3, 0.05, 1.0])),
            1 => case.through(family, random.pick(&[0.0, 1.0, w]), random.pick(&[0.0, 1.0, h])),
            2 => case.through(family, (w / 2.0).floor(), (h / 2.0).floor()),
            _ => case.through(family, random.between(0.0, w).floor(), random.between(0.0, h).floor()),
        }
    }
    case
}

/// Parameters anywhere in their ranges.
fn random_parameters(random: &mut Random) -> Parameters {
    let mut parameters = Parameters::default();
    for row in TABLE {
        if random.below(4) > 0 {
            continue;
        }
        let value = match row.range {
            Range::Number(low, high) | Range::Named(low, high, _) => {
                let high = if random.below(3) == 0 { high } else { high.min(1.0) };
                Value::Number(random.between(low, high.max(low)))
            }
            Range::Whole(low, high) => Value::Number(low + random.below((high - low) as u64 + 1) as f64),
            Range::Word(words) => Value::Word(random.pick(words).to_owned()),
            Range::Numbers(low, high) => {
                Value::Numbers((0..=random.below(4)).map(|_| random.between(low, high)).collect())
            }
        };
        parameters.set(row.name, value).unwrap_or_else(|fault| panic!("{fault}"));
    }
    parameters
}

/// Surveys a map of random walls and noise, with random meanings of its values and random parameters.
fn survey_case(seed: u64) -> Result<(), String> {
    let mut random = Random(seed);
    // Mostly small, so that much is tried.
    let [width, height] = [(); 2].map(|()| {
        let most = random.pick(&[3, 30, 100, 200]);
        1 + random.below(most) as usize
    });
    let fill = random.pick(&[254, 205, 0]);
    let mut pixels = vec![fill; width * height];
    let turn = random.between(-2.0, 2.0);
    for _ in 0..random.below(12) {
        let (x, y) = (random.between(0.0, width as f64), random.between(0.0, height as f64));
        let quarter = random.pick(&[0.0, std::f64::consts::FRAC_PI_2, 0.3]);
        let (cos, sin) = ((turn + quarter).cos(), (turn + quarter).sin());
        let (long, wide) = (random.between(1.0, 80.0), random.between(0.5, 6.0));
        let value = random.pick(&[0, 0, 0, 254, 205]);
        for (n, pixel) in pixels.iter_mut().enumerate() {
            let (dx, dy) = ((n % width) as f64 - x, (n / width) as f64 - y);
            if (dx * cos + dy * sin).abs() <= long && (dy * cos - dx * sin).abs() <= wide {
                *pixel = value;
            }
        }
    }
    let sparse = random.pick(&[2, 20, 1000]);
    for _ in 0..random.below(1 + (width * height) as u64 / sparse) {
        let at = random.below((width * height) as u64) as usize;
        pixels[at] = random.pick(&[0, 100, 205, 254, 255]);
    }
    let table = if random.below(4) == 0 {
        let (values, states): (Vec<i8>, Vec<u8>) =
            (0..256).map(|_| (random.next() as i8, random.below(4) as u8)).unzip();
        let sizes = "a table has 256 entries";
        Table::new(&values.try_into().map_err(|_| sizes)?, &states.try_into().map_err(|_| sizes)?)
    } else {
        Table::trinary()
    };
    let origin = random.pick(&[[0.0; 3], [12.0, -30.0, 0.4], [5e5, 6e6, -3.0]]);
    let frame = Frame::new(width, height, random.pick(&[0.05, 0.05, 0.01, 0.2, 1.0]), origin);
    let grid = Grid::new(&pixels, random.below(2) == 0, &table, frame);
    let parameters = random_parameters(&mut random);
    let made = survey(&grid, &parameters, Given::default(), 1);
    let problems = made.subdivision.problems();
    if !problems.is_empty() {
        return Err(problems.join("; "));
    }
    if made.occupancy.pixels.iter().sum::<u64>() != (width * height) as u64 {
        return Err("a pixel lies in no face, or in two".to_owned());
    }
    let shares = [&made.occupancy.faces, &made.occupancy.unknown, &made.occupancy.free, &made.occupancy.edges];
    if shares.into_iter().flatten().any(|share| !(0.0..=1.0).contains(share)) {
        return Err("a share is not between 0 and 1".to_owned());
    }
    let coordinates = made.walls.walls.iter().flat_map(|wall| wall.points).flatten();
    if coordinates.chain(made.occupancy.runs.iter().flatten().copied()).any(|value| !value.is_finite()) {
        return Err("a wall is not finite".to_owned());
    }
    let lengths = [&made.lines.offsets, &made.lines.amplitudes, &made.lines.widths];
    if lengths.into_iter().flatten().chain(&made.directions.angles).any(|value| !value.is_finite()) {
        return Err("a line or a direction is not finite".to_owned());
    }
    let again = survey(&grid, &parameters, Given::default(), 4);
    if format!("{made:?}") != format!("{again:?}") {
        return Err("four threads make another survey than one".to_owned());
    }
    if parameters.labels_method == Method::Strips {
        let sparing = survey_sparingly(&grid, &parameters, Given::default(), 2);
        let again = arrange(&frame, &sparing.directions.angles, &sparing.lines, 1);
        if format!("{:?}", made.subdivision) != format!("{:?}", Subdivision::new(&frame, again, 1)) {
            return Err("the lines make another subdivision than that of the survey".to_owned());
        }
        let kept = Survey { gradients: Gradients::default(), subdivision: Subdivision::default(), ..made };
        if format!("{kept:?}") != format!("{sparing:?}") {
            return Err("a survey that lets go what it can is another".to_owned());
        }
    }
    Ok(())
}

/// Everything that a seed stands for.
fn run(seed: u64) -> Result<(), String> {
    match seed % 3 {
        0 => Case::random(seed).check().map(drop),
        1 => large_case(seed).check().map(drop),
        _ => survey_case(seed),
    }
}

fn try_seed(seed: u64) {
    let outcome = std::panic::catch_unwind(|| run(seed)).unwrap_or_else(|_| Err("panicked".to_owned()));
    if let Err(fault) = outcome {
        panic!("seed {seed}: {fault}");
    }
}

#[test]
fn a_few_hundred_seeds_hold() {
    (0..300).for_each(try_seed);
}

#[test]
fn the_centre_of_a_sliver_lies_in_it() {
    // Rounded to micrometres, its vertices enclosed next to nothing, and the centre flew off.
    Case::random(1167).check().map_or_else(|fault| panic!("{fault}"), drop);
}

#[test]
#[ignore = "runs as long as GROUNDPLAN_FUZZ_SECONDS says"]
fn seeds_hold_for_as_long_as_asked() {
    let number = |name: &str, default: u64| std::env::var(name).ok().and_then(|n| n.parse().ok()).unwrap_or(default);
    let (seconds, first) = (number("GROUNDPLAN_FUZZ_SECONDS", 60), number("GROUNDPLAN_FUZZ_SEED", 1_000_000));
    let end = Instant::now() + Duration::from_secs(seconds);
    let mut seed = first;
    while Instant::now() < end {
        try_seed(seed);
        seed += 1;
    }
}
