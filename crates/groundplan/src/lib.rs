//! Groundplan's method: a robot's occupancy grid in, its ground plan out.
//!
//! After Gholami Shahbandi, Åstrand and Philippsen, "Sensor Based Adaptive Metric-Topological Cell Decomposition Method
//! for Semantic Annotation of Structured Environments" (ICARCV 2014). Section numbers in this crate are the paper's.
//!
//! ```
//! use groundplan::{Frame, Given, Grid, Parameters, Table, survey};
//!
//! // A room of 4 m by 3 m, drawn into a map of 100 x 80 pixels of 5 cm: 0 is occupied, 254 free.
//! let (width, height) = (100, 80);
//! let is_wall = |x: usize, y: usize| {
//!     (10..=90).contains(&x) && (10..=70).contains(&y) && (x == 10 || x == 90 || y == 10 || y == 70)
//! };
//! let pixels: Vec<u8> =
//!     (0..width * height).map(|n| if is_wall(n % width, n / width) { 0 } else { 254 }).collect();
//! let table = Table::trinary();
//! let grid = Grid::new(&pixels, false, &table, Frame::new(width, height, 0.05, [0.0; 3]));
//!
//! let survey = survey(&grid, &Parameters::default(), Given::default(), 1);
//! assert_eq!(survey.directions.angles.len(), 2);
//! assert_eq!(survey.lines.len(), 4);
//! assert_eq!(survey.subdivision.faces(), 9);
//! ```

#![forbid(unsafe_code)]

pub mod adjacency;
mod aligned;
pub mod arrangement;
mod bands;
mod bent;
mod bits;
mod candidate;
mod coverage;
mod crossings;
pub mod directions;
mod ends;
pub mod gradients;
pub mod grid;
pub mod labels;
pub mod lines;
pub mod locate;
pub mod occupancy;
mod on_line;
mod oriented;
pub mod parameters;
pub mod pixels;
mod projection;
pub mod radiograms;
pub mod route;
mod sets;
mod sharpness;
mod sparing;
pub mod subdivision;
pub mod sums;
mod survey;
mod tiles;
pub mod walls;
pub mod wavelets;

pub use grid::{Frame, Grid, State, Table};
pub use labels::{JunctionKind, Label, Memory, Recall};
pub use parameters::{ParameterError, Parameters, TABLE, Value};
pub use sparing::is_large;
pub use survey::{Given, Survey, UNSURE, Warning, survey, survey_sparingly};

/// The version of the method, and of all of Groundplan.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
