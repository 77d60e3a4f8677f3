//! Ways through rows that are no wider than bays: posts stand a pitch apart in each row, but those beyond a way do not stand
//! where the ones before it would go on, and it is not as wide as bays are.

/// So many bays on either side of a section tell where posts stand.
pub const BAYS: f64 = 8.0;
/// A bay is free for so much of its pitch at least, and a section that differs from bays by less is one.
const FREE: f64 = 0.7;
const ALIKE: f64 = 0.06;
/// A post may stand so far within what is free, metres.
const MARGIN: f64 = 0.05;
/// It is asked part by part of a pitch; where posts stand is known when it is in no more of them.
const PARTS: usize = 120;
const KNOWN: usize = 30;
/// By which shares of it the pitch may be off: so many steps of so much, either way.
const STEPS: i32 = 10;
const STEP: f64 = 0.005;

/// What is free between two places along a row.
pub struct Section {
    pub ends: [f64; 2],
    /// Where nothing stands on one of the faces, below it and above.
    pub beside: [Vec<[f64; 2]>; 2],
}

/// In which parts of a pitch, from a place on, posts may stand.
type Places = [bool; PARTS];

/// Which sections of a direction's rows are no bays, though they may be as wide as some, by about how far it is from post to
/// post there, metres.
pub fn are_out(sections: &[Section], pitch: f64) -> Vec<bool> {
    let pitches = (-STEPS..=STEPS).map(|n| pitch * (1.0 + STEP * f64::from(n)));
    let fits =
        |pitch: f64| sections.iter().flat_map(|section| section.places(pitch)).map(count).map(|n| n.min(KNOWN)).sum();
    let fitting: Vec<(usize, f64)> = pitches.map(|pitch| (fits(pitch), pitch)).collect();
    let most = fitting.iter().map(|(fits, _)| *fits).max().unwrap_or(0);
    let best: Vec<f64> = fitting.into_iter().filter(|(fits, _)| *fits == most).map(|(_, pitch)| pitch).collect();
    let pitch = best[best.len() / 2];
    sections.iter().map(|section| section.is_out(pitch)).collect()
}

impl Section {
    /// Where the posts on each of its sides may stand, from its lower end on.
    fn places(&self, pitch: f64) -> [Places; 2] {
        self.beside.each_ref().map(|free| {
            let mut may = [true; PARTS];
            for [from, to] in free {
                let [first, last] = [self.part(from + MARGIN, pitch) + 1, self.part(to - MARGIN, pitch)];
                (first..last.min(first + PARTS as i64)).for_each(|part| may[around(part)] = false);
            }
            may
        })
    }

    fn part(&self, place: f64, pitch: f64) -> i64 {
        ((place - self.ends[0]) / pitch * PARTS as f64).floor() as i64
    }

    /// True when its ends are where posts stand, by those on its two sides, but these are of two lots, and no bay beside is
    /// as wide.
    fn is_out(&self, pitch: f64) -> bool {
        let lengths = self.beside.iter().flatten().map(|[from, to]| to - from);
        let mut bays: Vec<f64> = lengths.filter(|length| (FREE * pitch..pitch).contains(length)).collect();
        bays.sort_by(f64::total_cmp);
        let width = self.ends[1] - self.ends[0];
        if bays.get(bays.len() / 2).is_none_or(|bay| (width - bay).abs() <= ALIKE * pitch) {
            return false;
        }
        let [below, above] = self.places(pitch);
        let near = (MARGIN / pitch * PARTS as f64).ceil() as i64;
        let stands = |may: &Places, end: f64| {
            let part = self.part(end, pitch);
            (part - 2 * near..=part + 2 * near).any(|part| may[around(part)])
        };
        let is_known = |may: &Places| (1..=KNOWN).contains(&count(*may));
        let is_apart = |by: i64| (0..PARTS).all(|part| !below[part] || !above[around(part as i64 + by)]);
        is_known(&below)
            && is_known(&above)
            && stands(&below, self.ends[0])
            && stands(&above, self.ends[1])
            && (-near..=near).all(is_apart)
    }
}

fn count(may: Places) -> usize {
    may.into_iter().filter(|may| *may).count()
}

/// A part of the pitch that it is in.
fn around(part: i64) -> usize {
    part.rem_euclid(PARTS as i64) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bays of 2.7 m with posts of 0.1 m on both sides of a section.
    fn section(width: f64) -> Section {
        let bay = |from: f64| [from + 0.1, from + 2.7];
        let below = (1..=5).map(|n| bay(-2.7 * f64::from(n) - 0.1)).collect();
        let above = (0..5).map(|n| bay(width + 2.7 * f64::from(n))).collect();
        Section { ends: [0.0, width], beside: [below, above] }
    }

    #[test]
    fn what_posts_go_on_beyond_is_a_bay_and_what_they_do_not_is_a_way() {
        for (width, is_way) in [(2.6, false), (2.3, true), (1.9, true), (5.3, false), (2.65, false)] {
            // The pitch that is told may be off.
            for pitch in [2.65, 2.7, 2.8] {
                assert_eq!(are_out(&[section(width)], pitch), [is_way], "{width} at {pitch}");
            }
        }
    }

    #[test]
    fn without_bays_beside_nothing_is_told() {
        let bare = Section { beside: [Vec::new(), Vec::new()], ..section(2.3) };
        assert_eq!(are_out(&[bare], 2.7), [false]);
        assert!(are_out(&[], 2.7).is_empty());
    }
}
