//! The map as labels see it: turned so that one direction lies along its columns, as sums of what is free and taken in any
//! part of it, and looked along straight lines.

pub(super) mod axes;
pub(super) mod lined;
pub(super) mod look;
pub(super) mod panes;
pub(super) mod patches;
pub(super) mod quarter;
pub(super) mod runs;
pub(super) mod sampled;
pub(super) mod shares;
pub(super) mod squares;
pub(super) mod summed;
pub(super) mod sums;
pub(super) mod sweep;
pub(super) mod turned;
