//! Stretches by their two ends, the lower one first: along a direction or across it, metres.

/// From the lower of two places to the higher.
pub fn sorted([one, two]: [f64; 2]) -> [f64; 2] {
    [one.min(two), one.max(two)]
}

/// With so much more at both ends.
pub fn wider([low, high]: [f64; 2], by: f64) -> [f64; 2] {
    [low - by, high + by]
}

/// What two share; where they share nothing, what lies between them, from its higher end to its lower.
pub fn shared(one: [f64; 2], two: [f64; 2]) -> [f64; 2] {
    [one[0].max(two[0]), one[1].min(two[1])]
}

/// From the lower end of two to the higher.
pub fn both(one: [f64; 2], two: [f64; 2]) -> [f64; 2] {
    [one[0].min(two[0]), one[1].max(two[1])]
}

/// How much two share; less than nothing by as much as they are apart.
pub fn overlap(one: [f64; 2], two: [f64; 2]) -> f64 {
    let [low, high] = shared(one, two);
    high - low
}

/// True when a place lies between two ends, or is one.
pub fn holds([low, high]: [f64; 2], place: f64) -> bool {
    low <= place && place <= high
}

/// From the lowest of some places to the highest.
pub fn around(places: impl Iterator<Item = f64>) -> [f64; 2] {
    places.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], place| [low.min(place), high.max(place)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_apart_shares_less_than_nothing() {
        assert_eq!(overlap([0.0, 3.0], [1.0, 7.0]), 2.0);
        assert_eq!(overlap([0.0, 3.0], [3.0, 7.0]), 0.0);
        assert_eq!(overlap([5.0, 7.0], [0.0, 3.0]), -2.0);
        assert_eq!(shared([0.0, 3.0], [1.0, 7.0]), [1.0, 3.0]);
        assert_eq!(both([0.0, 3.0], [5.0, 7.0]), [0.0, 7.0]);
    }
}
