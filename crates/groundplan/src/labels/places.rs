//! Names by place: the site in squares along its dominant direction, so that a name says where a thing is, and what
//! appears, goes or is cut in two renames nothing else.

use super::Evidence;
use super::view::turned::Turned;
use crate::bands::map_each;
use crate::ends::around;
use std::f64::consts::FRAC_PI_2;

/// Rows of squares run along the dominant direction, or square to it: whichever is nearer to this. It lies between the
/// angles at which people build, so that a map made again, a little turned, has the same rows.
const FORWARDS: [f64; 2] = [0.927, 0.375];
/// The first square begins where so much of the free space lies before it, so that a ray through a window moves none.
const BEFORE: f64 = 0.01;
/// Every so many columns and rows of the turned map are looked at.
const STRIDE: usize = 3;
/// So many rows are worth a thread's while.
const ROWS: usize = 512;

/// What is named is this many times as large as the squares that it is named by, or larger.
const SMALL: f64 = 2.0;

/// Something to be named: its middle in the squares' frame, how much it weighs against others in its square, and how
/// large it is, metres; of what is small, 0.
pub struct Placed {
    pub place: [f64; 2],
    pub weight: f64,
    pub size: f64,
}

/// The squares, between the corners of the site in their own frame.
pub struct Squares {
    heading: [f64; 2],
    corners: [[f64; 2]; 2],
    side: f64,
}

impl Squares {
    /// Squares over the map as it is seen along a direction; along the map's own axes when there is none.
    pub fn new(view: Option<&Turned>, evidence: &Evidence) -> Self {
        let side = evidence.parameters.labels_square;
        let Some(view) = view else {
            let corner = evidence.grid.frame.to_metres([0.0, 0.0]);
            return Self { heading: [1.0, 0.0], corners: [corner; 2], side };
        };
        let quarters = (0..4).map(|n| view.angle + f64::from(n) * FRAC_PI_2);
        let headings = quarters.map(|angle| [libm::cos(angle), libm::sin(angle)]);
        let nearer = |h: &[f64; 2]| h[0] * FORWARDS[0] + h[1] * FORWARDS[1];
        let heading = headings.max_by(|a, b| nearer(a).total_cmp(&nearer(b))).unwrap_or([1.0, 0.0]);
        let mut made = Self { heading, corners: [[0.0; 2]; 2], side };
        // Of the view's own axes, each is one of the squares', be it backwards.
        let along = extent(&free_columns(view), view.start[0], view.cell);
        let across = extent(&free_rows(view, evidence.threads), view.start[1], view.cell);
        let corners: Vec<_> = view.rectangle(along, across).into_iter().map(|corner| made.place(corner)).collect();
        let [u, v] = [0, 1].map(|axis| around(corners.iter().map(|corner| corner[axis])));
        made.corners = [0, 1].map(|end| [u[end], v[end]]);
        made
    }

    /// Metres along the rows and across them.
    pub fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [c, s] = self.heading;
        [x * c + y * s, y * c - x * s]
    }

    /// How far on a place is, whichever way a row through it runs.
    pub fn ahead(&self, place: [f64; 2]) -> f64 {
        let [u, v] = self.place(place);
        u * FORWARDS[0] + v * FORWARDS[1]
    }

    /// In which of the rows along an angle, as wide as a square and counted from the site's edge on, a place lies.
    pub fn row(&self, angle: f64, place: [f64; 2]) -> usize {
        let normal = [-libm::sin(angle), libm::cos(angle)];
        let across = if self.ahead(normal) < 0.0 { normal.map(|part| -part) } else { normal };
        let [across, place] = [across, place].map(|vector| self.place(vector));
        let edge = |axis: usize| self.corners.iter().map(|c| c[axis] * across[axis]).fold(f64::MAX, f64::min);
        self.count(place[0] * across[0] + place[1] * across[1] - edge(0) - edge(1))
    }

    /// So many squares a side are taken together for what is so large, metres: its middle is then the less often so near
    /// to a side that a map made again has it in another.
    fn together(&self, size: f64) -> usize {
        let mut together = 1;
        while SMALL * 2.0 * self.side * together as f64 <= size {
            together *= 2;
        }
        together
    }

    /// So many sides of a square go whole into metres.
    fn count(&self, metres: f64) -> usize {
        (metres / self.side).floor().max(0.0) as usize
    }

    /// A name for each place: the letter, the row from below and the square in it from the left. Of several in one
    /// square the one that weighs most has the plain name.
    pub fn names(&self, letter: &str, items: &[Placed]) -> Vec<String> {
        let square = |item: &Placed| {
            let together = self.together(item.size);
            let [u, v] = [0, 1].map(|axis| self.count(item.place[axis] - self.corners[0][axis]) / together * together);
            [v, u]
        };
        let squares: Vec<_> = items.iter().map(square).collect();
        let mut order: Vec<usize> = (0..items.len()).collect();
        order.sort_by(|&a, &b| squares[a].cmp(&squares[b]).then(items[b].weight.total_cmp(&items[a].weight)));
        told_apart(&order, &squares, |[row, column]| format!("{letter}{}-{:02}", row + 1, column + 1))
    }
}

/// The names of some places, of which those of one place follow one another in an order and are told apart by suffixes.
pub fn told_apart<P: PartialEq>(order: &[usize], places: &[P], name: impl Fn(&P) -> String) -> Vec<String> {
    let mut names = vec![String::new(); places.len()];
    for group in order.chunk_by(|&a, &b| places[a] == places[b]) {
        for (n, &item) in group.iter().enumerate() {
            names[item] = name(&places[item]) + &suffix(n);
        }
    }
    names
}

/// Nothing for the first, then b to z, then numbers.
fn suffix(n: usize) -> String {
    match n {
        0 => String::new(),
        1..=25 => char::from(b'a' + n as u8).to_string(),
        _ => format!("-{}", n + 1),
    }
}

/// Free share of each column.
fn free_columns(view: &Turned) -> Vec<f64> {
    let [low, top] = view.reach_across();
    view.all_blocked(low, top).into_iter().map(|blocked| 1.0 - blocked).collect()
}

/// How much of each row is free.
fn free_rows(view: &Turned, threads: usize) -> Vec<f64> {
    let row = |n: usize| {
        let low = view.start[1] + n as f64 * view.cell;
        let blocked = view.blocked_in(low, low + view.cell);
        // Counted together: a sum of shares would wait for each of them.
        let columns = (0..view.size[0]).step_by(STRIDE);
        columns.len() as f64 - blocked.share(columns.map(|column| blocked.at(column)).sum())
    };
    let parts = view.size[1].div_ceil(ROWS);
    map_each(parts, threads, |n| (n * ROWS..view.size[1].min((n + 1) * ROWS)).map(row).collect::<Vec<_>>()).concat()
}

/// Between which places all but a little of the free space lies.
fn extent(free: &[f64], start: f64, cell: f64) -> [f64; 2] {
    let least = BEFORE * free.iter().sum::<f64>();
    let reach = |values: &mut dyn Iterator<Item = &f64>| {
        let mut before = 0.0;
        let mut steps = 0.0;
        for value in values {
            if before + value > least {
                return steps + (least - before) / value;
            }
            before += value;
            steps += 1.0;
        }
        steps
    };
    [start + cell * reach(&mut free.iter()), start + cell * (free.len() as f64 - reach(&mut free.iter().rev()))]
}
