//! What stands by itself and recurs: the posts of racks, which tell how long bays are, legs that are all one sees of a rack, and
//! pillars.

pub(super) mod against;
pub(super) mod bays;
pub(super) mod faces;
pub(super) mod framed;
pub(super) mod frames;
pub(super) mod grounds;
pub(super) mod lags;
pub(super) mod legs;
pub(super) mod map;
pub(super) mod period;
pub(super) mod pillars;
pub(super) mod pitch;
pub(super) mod rack;
pub(super) mod uprights;
