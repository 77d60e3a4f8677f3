//! TABLE: every parameter's name, unit, default, range, sentence and section of the paper.
//!
//! It feeds the Rust API, Python keywords, `--set name=value`, the settings file and the documentation. None is
//! needed to start. Degrees stand here only, at the door.

use std::fmt;

/// A value as a person sets it.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// Found by itself.
    Auto,
    /// A number; whole where the range's kind says so.
    Number(f64),
    /// One of a list of words.
    Word(String),
    /// Several numbers.
    Numbers(Vec<f64>),
}

/// What values a parameter may take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Range {
    /// From, to, both included.
    Number(f64, f64),
    /// Whole numbers from, to, both included.
    Whole(f64, f64),
    /// One of these words.
    Word(&'static [&'static str]),
    /// Any number of numbers from, to, both included.
    Numbers(f64, f64),
    /// A number from, to, or one of the named numbers.
    Named(f64, f64, &'static [(&'static str, f64)]),
}

/// One row of the table.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Stage and name, such as `lines.snr`.
    pub name: &'static str,
    /// Unit, empty when dimensionless.
    pub unit: &'static str,
    /// Values that it may take.
    pub range: Range,
    /// True when it finds itself unless set.
    pub auto: bool,
    /// What it does.
    pub sentence: &'static str,
    /// Section of the paper.
    pub section: &'static str,
    get: fn(&Parameters) -> Value,
    set: fn(&mut Parameters, Value),
}

impl Parameter {
    /// The default.
    #[must_use]
    pub fn default(&self) -> Value {
        (self.get)(&Parameters::default())
    }
}

/// A parameter that could not be set; the message names the parameter and the value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ParameterError {
    /// `parameter.unknown` or `parameter.range`.
    pub code: &'static str,
    /// A sentence.
    pub message: String,
    /// What would help.
    pub hint: String,
}

impl fmt::Display for ParameterError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for ParameterError {}

/// How a field's type goes to and from a [`Value`] that the range has let through.
trait Setting {
    fn to_value(&self) -> Value;
    fn take(&mut self, value: Value);
}

impl Setting for f64 {
    fn to_value(&self) -> Value {
        Value::Number(*self)
    }
    fn take(&mut self, value: Value) {
        if let Value::Number(n) = value {
            *self = n;
        }
    }
}

impl Setting for Option<f64> {
    fn to_value(&self) -> Value {
        self.map_or(Value::Auto, Value::Number)
    }
    fn take(&mut self, value: Value) {
        *self = if let Value::Number(n) = value { Some(n) } else { None };
    }
}

impl Setting for Option<usize> {
    fn to_value(&self) -> Value {
        self.map_or(Value::Auto, |n| Value::Number(n as f64))
    }
    fn take(&mut self, value: Value) {
        *self = if let Value::Number(n) = value { Some(n as usize) } else { None };
    }
}

impl Setting for Option<Vec<f64>> {
    fn to_value(&self) -> Value {
        self.clone().map_or(Value::Auto, Value::Numbers)
    }
    fn take(&mut self, value: Value) {
        *self = if let Value::Numbers(n) = value { Some(n) } else { None };
    }
}

/// How junctions and corridors are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Aisles as strips between facing walls, junctions where they meet.
    Strips,
    /// Algorithm 1 and Fig. 8 as printed.
    Paper,
}

const METHODS: &[&str] = &["strips", "paper"];

impl Setting for Method {
    fn to_value(&self) -> Value {
        Value::Word(METHODS[usize::from(*self == Self::Paper)].to_owned())
    }
    fn take(&mut self, value: Value) {
        if let Value::Word(word) = value {
            *self = if word == METHODS[1] { Self::Paper } else { Self::Strips };
        }
    }
}

macro_rules! parameters {
    ($($field:ident: $type:ty = $default:expr, $name:literal, $unit:literal, $range:expr, $auto:literal, $section:literal,
       $sentence:literal;)*) => {
        /// A value for every parameter.
        #[derive(Clone, Debug, PartialEq)]
        pub struct Parameters { $(#[doc = $sentence] pub $field: $type,)* }

        impl Default for Parameters {
            fn default() -> Self {
                Self { $($field: $default,)* }
            }
        }

        /// Every parameter there is.
        pub const TABLE: &[Parameter] = &[$(Parameter {
            name: $name, unit: $unit, range: $range, auto: $auto, sentence: $sentence, section: $section,
            get: |p| Setting::to_value(&p.$field), set: |p, v| Setting::take(&mut p.$field, v),
        },)*];
    };
}

/// The words of the resolution knob.
const DETAILS: &[(&str, f64)] = &[("coarse", 0.25), ("fine", 0.9)];

parameters! {
    gradients_radius: f64 = 0.35, "gradients.radius", "m", Range::Number(0.0, 5.0), false, "II-A",
        "Half the window over which the gradient of an edge pixel is taken; never under 4 pixels or over 32.";
    directions_count: Option<usize> = None, "directions.count", "", Range::Whole(1.0, 16.0), true, "II-A",
        "How many directions to take, strongest first; found by itself when not set.";
    directions_angles_deg: Option<Vec<f64>> = None, "directions.angles_deg", "deg", Range::Numbers(-360.0, 360.0), true, "II-A",
        "The directions themselves, in the map frame; found by themselves when not set.";
    directions_separation_deg: f64 = 5.0, "directions.separation_deg", "deg", Range::Number(0.5, 45.0), false, "II-A",
        "Two directions that are found closer than this are one; those that are given stay.";
    directions_min_weight: f64 = 0.15, "directions.min_weight", "", Range::Number(0.0, 1.0), false, "II-A",
        "A direction counts when the structure that lines up along it is at least this share of the strongest's; a weaker one only where another has none square to it, or two are a small wing's.";
    radiograms_tolerance_deg: f64 = 15.0, "radiograms.tolerance_deg", "deg", Range::Number(1.0, 90.0), false, "II-B",
        "An edge pixel is projected along a direction when it lies within this angle of it.";
    lines_min_width: Option<f64> = None, "lines.min_width", "m", Range::Number(0.0, 10.0), true, "II-B",
        "Narrowest wavelet (sigma); one pixel when not set.";
    lines_max_width: Option<f64> = None, "lines.max_width", "m", Range::Number(0.0, 50.0), true, "II-B",
        "Widest wavelet (sigma); twenty pixels when not set.";
    lines_snr: f64 = 3.0, "lines.snr", "", Range::Number(0.0, 1000.0), false, "II-B",
        "A peak's wavelet response must exceed the noise around it by this factor.";
    lines_detail: Option<f64> = None, "lines.detail", "", Range::Named(0.0, 1.0, DETAILS), true, "III",
        "The resolution knob: 0 keeps only the strongest lines, 1 all that stand out of the noise; coarse is 0.25, fine is 0.9.";
    lines_min_amplitude: Option<f64> = None, "lines.min_amplitude", "m", Range::Number(0.0, 1e6), true, "III",
        "Structure that must lie on a line; follows from the detail when not set.";
    walls_disparity: f64 = 0.25, "walls.disparity", "", Range::Number(0.0, 1.0), false, "II-D",
        "t1: faces whose occupancies differ by more are separated by their edge.";
    walls_occupancy: f64 = 0.5, "walls.occupancy", "", Range::Number(0.0, 1.0), false, "II-D",
        "t2: an edge occupied over more of its length is a wall.";
    walls_min_opening: f64 = 0.4, "walls.min_opening", "m", Range::Number(0.0, 10.0), false, "II-D",
        "A narrower gap in a wall is closed: nothing goes through it, and noise makes such gaps.";
    labels_method: Method = Method::Strips, "labels.method", "", Range::Word(METHODS), false, "II-E",
        "strips: aisles between facing walls, junctions where they meet; paper: Algorithm 1 as printed.";
    labels_min_width: f64 = 0.8, "labels.min_width", "m", Range::Number(0.0, 100.0), false, "II-E",
        "A corridor is at least this wide.";
    labels_max_width: f64 = 8.0, "labels.max_width", "m", Range::Number(0.1, 1000.0), false, "II-E",
        "A corridor is at most this wide.";
    labels_min_aspect: f64 = 1.5, "labels.min_aspect", "", Range::Number(0.0, 100.0), false, "II-E",
        "A corridor is at least this many times as long as it is wide.";
    labels_square: f64 = 4.0, "labels.square", "m", Range::Number(0.5, 100.0), false, "II-E",
        "Corridors, regions, racks and pillars are named by the squares of a grid along the dominant direction; the side of one.";
    pillars_min_width: f64 = 0.2, "pillars.min_width", "m", Range::Number(0.0, 10.0), false, "II-E",
        "A pillar is at least this wide.";
    pillars_max_width: f64 = 1.2, "pillars.max_width", "m", Range::Number(0.0, 10.0), false, "II-E",
        "A pillar is at most this wide.";
    pillars_min_pitch: f64 = 2.5, "pillars.min_pitch", "m", Range::Number(0.5, 100.0), false, "II-E",
        "Pillars that recur do so at least at this pitch.";
    rooms_max_opening: f64 = 3.5, "rooms.max_opening", "m", Range::Number(0.0, 100.0), false, "II-E",
        "A gap in a wall may be a door when it is at most this wide, and a gate between halls when it is at most twice as wide.";
    rooms_openness: f64 = 0.8, "rooms.openness", "", Range::Number(0.1, 1.0), false, "II-E",
        "An opening parts two regions when it is narrower than this share of the space on its tighter side.";
    rooms_min_area: f64 = 2.0, "rooms.min_area", "m2", Range::Number(0.0, 1e6), false, "II-E",
        "A smaller piece of free space is part of what it opens into.";
}

impl Parameters {
    /// Sets one parameter by name.
    ///
    /// # Errors
    /// When there is no such parameter (the nearest name is the hint) or the value is out of its range.
    pub fn set(&mut self, name: &str, value: Value) -> Result<(), ParameterError> {
        Parameter::named(name)?.put(self, value)
    }

    /// Holds parameters against one another, once all that are asked for are set: no least is above its greatest.
    ///
    /// # Errors
    /// When one is; the message has both values.
    pub fn check(&self) -> Result<(), ParameterError> {
        let values = self.values();
        let number = |name: &str| match values.iter().find(|(own, _)| *own == name) {
            Some((_, Value::Number(n))) => Some(*n),
            _ => None,
        };
        for (least, _) in values.iter().filter(|(name, _)| name.contains(".min_")) {
            let greatest = least.replace(".min_", ".max_");
            if let (Some(low), Some(high)) = (number(least), number(&greatest))
                && low > high
            {
                return Err(ParameterError {
                    code: "parameter.range",
                    message: format!("{least} cannot be {low} where {greatest} is {high}"),
                    hint: format!("{least} is {high} at most, or {greatest} {low} at least"),
                });
            }
        }
        Ok(())
    }

    /// Every parameter's name and value, in the table's order.
    #[must_use]
    pub fn values(&self) -> Vec<(&'static str, Value)> {
        TABLE.iter().map(|row| (row.name, (row.get)(self))).collect()
    }
}

impl Parameter {
    /// The parameter of a name.
    ///
    /// # Errors
    /// When there is none (the nearest name is the hint).
    pub fn named(name: &str) -> Result<&'static Self, ParameterError> {
        TABLE.iter().find(|row| row.name == name).ok_or_else(|| unknown(name))
    }

    /// Sets it.
    ///
    /// # Errors
    /// When the value is out of its range.
    pub fn put(&self, parameters: &mut Parameters, value: Value) -> Result<(), ParameterError> {
        (self.set)(parameters, self.admit(value)?);
        Ok(())
    }

    fn admit(&self, value: Value) -> Result<Value, ParameterError> {
        let within = |n: &f64, low: f64, high: f64| *n >= low && *n <= high;
        let good = match (&value, self.range) {
            (Value::Auto, _) => self.auto,
            (Value::Number(n), Range::Number(low, high) | Range::Named(low, high, _)) => within(n, low, high),
            (Value::Number(n), Range::Whole(low, high)) => within(n, low, high) && n.fract() == 0.0,
            (Value::Number(n), Range::Numbers(low, high)) if within(n, low, high) => {
                return Ok(Value::Numbers(vec![*n]));
            }
            (Value::Numbers(ns), Range::Numbers(low, high)) => {
                !ns.is_empty() && ns.iter().all(|n| within(n, low, high))
            }
            (Value::Word(word), Range::Word(words)) => words.contains(&word.as_str()),
            (Value::Word(word), Range::Named(_, _, names)) => {
                if let Some((_, n)) = names.iter().find(|(name, _)| name == word) {
                    return Ok(Value::Number(*n));
                }
                false
            }
            _ => false,
        };
        if good {
            return Ok(value);
        }
        Err(ParameterError {
            code: "parameter.range",
            message: format!("{} cannot be {value}", self.name),
            hint: format!("{} takes {}{}", self.name, self.range, if self.auto { ", or auto" } else { "" }),
        })
    }
}

fn unknown(name: &str) -> ParameterError {
    // The part behind the dot is what people remember.
    let last = |name: &'_ str| name.rsplit('.').next().unwrap_or_default().to_owned();
    let nearest = TABLE
        .iter()
        .map(|row| (edits(row.name, name).min(edits(&last(row.name), name) + 1), row.name))
        .min()
        .filter(|&(apart, _)| 3 * apart <= name.chars().count());
    ParameterError {
        code: "parameter.unknown",
        message: format!("there is no parameter {name}"),
        hint: nearest.map_or_else(
            || "groundplan parameters lists them all".to_owned(),
            |(_, nearest)| format!("did you mean {nearest}?"),
        ),
    }
}

/// Edit distance between two names (Levenshtein).
fn edits(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, ca) in a.chars().enumerate() {
        let mut diagonal = std::mem::replace(&mut row[0], i + 1);
        for (j, cb) in b.iter().enumerate() {
            let swap = diagonal + usize::from(ca != *cb);
            diagonal = row[j + 1];
            row[j + 1] = swap.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[b.len()]
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Auto => f.write_str("auto"),
            Self::Number(n) => write!(f, "{n}"),
            Self::Word(word) => write!(f, "{word:?}"),
            Self::Numbers(ns) => f.debug_list().entries(ns).finish(),
        }
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(low, high) => write!(f, "{low} to {high}"),
            Self::Whole(low, high) => write!(f, "a whole number from {low} to {high}"),
            Self::Word(words) => f.write_str(&words.join(" or ")),
            Self::Numbers(low, high) => write!(f, "numbers from {low} to {high}"),
            Self::Named(low, high, names) => {
                write!(f, "{low} to {high}")?;
                names.iter().try_for_each(|(name, _)| write!(f, ", {name}"))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_default_lies_in_its_range() {
        for row in TABLE {
            let default = row.default();
            assert_eq!(row.admit(default.clone()), Ok(default), "{}", row.name);
        }
    }

    #[test]
    fn an_unknown_name_gives_the_nearest() {
        let fault = Parameters::default().set("lines.snt", Value::Number(3.0)).unwrap_err();
        assert_eq!((fault.code, fault.hint.as_str()), ("parameter.unknown", "did you mean lines.snr?"));
        let hint = |name| Parameters::default().set(name, Value::Auto).unwrap_err().hint;
        assert_eq!(hint("disparity"), "did you mean walls.disparity?");
        assert_eq!(hint("line.detail"), "did you mean lines.detail?");
    }

    #[test]
    fn a_name_like_none_gives_no_other() {
        for name in ["", "x", "banana", "how.many.robots"] {
            let fault = Parameters::default().set(name, Value::Number(3.0)).unwrap_err();
            assert_eq!(fault.hint, "groundplan parameters lists them all", "{name}");
        }
    }

    #[test]
    fn a_value_out_of_range_names_itself() {
        let fault = Parameters::default().set("directions.count", Value::Number(2.5)).unwrap_err();
        assert_eq!(fault.message, "directions.count cannot be 2.5");
        assert!(Parameters::default().set("lines.snr", Value::Number(f64::NAN)).is_err());
        assert!(Parameters::default().set("lines.snr", Value::Auto).is_err());
    }

    #[test]
    fn no_least_is_above_its_greatest() {
        for (least, greatest) in [("labels.min_width", "labels.max_width"), ("pillars.min_width", "pillars.max_width")]
        {
            let mut parameters = Parameters::default();
            parameters.set(least, Value::Number(3.0)).unwrap();
            parameters.set(greatest, Value::Number(3.0)).unwrap();
            assert_eq!(parameters.check(), Ok(()));
            parameters.set(greatest, Value::Number(2.5)).unwrap();
            let fault = parameters.check().unwrap_err();
            assert_eq!(fault.message, format!("{least} cannot be 3 where {greatest} is 2.5"));
        }
        assert_eq!(Parameters::default().check(), Ok(()));
    }

    #[test]
    fn the_detail_has_words() {
        let mut parameters = Parameters::default();
        parameters.set("lines.detail", Value::Word("fine".into())).unwrap();
        assert_eq!(parameters.lines_detail, Some(0.9));
    }
}
