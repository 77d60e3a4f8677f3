//! The faces of racks on legs as lines: a lidar sees no more of them than their legs, of which a radiogram has no peak.

use super::rack::Rack;
use crate::ends::{holds, wider};
use crate::grid::{Frame, tidy};
use crate::lines::{Lines, SHORT};
use crate::on_line;
use crate::parameters::Parameters;

/// A face of racks in line.
struct Face {
    direction: u32,
    offset: f64,
    /// From the outer sides of the legs to their middles, metres.
    depth: f64,
    /// How long the racks are, and what is seen of them, metres.
    length: f64,
    structure: f64,
}

/// The lines, and where none follows an outer face of some racks on legs one along that. Where a least amplitude is asked for, or a
/// detail that asks more of lines than they are let through for anyhow, with as much structure.
pub fn with_faces(lines: Lines, racks: &[Rack], frame: &Frame, parameters: &Parameters) -> Lines {
    let near = on_line::near(frame);
    let least = match (parameters.lines_min_amplitude, parameters.lines_detail) {
        (Some(metres), _) => metres,
        (None, Some(_)) if lines.min_amplitude > SHORT.1 => lines.min_amplitude,
        (None, _) => 0.0,
    };
    let is_line = |face: &Face| {
        let mut own = (0..lines.len()).filter(|&n| lines.directions[n] == face.direction);
        own.any(|n| holds(wider([face.offset; 2], near + face.depth), lines.offsets[n]))
    };
    let mut more = faces(racks, near);
    more.retain(|face| face.structure >= least && !is_line(face));
    if more.is_empty() {
        return lines;
    }
    let own = more.iter().map(|face| (face.direction, tidy(face.offset), tidy(face.structure), tidy(frame.resolution)));
    Lines::of(lines.each().chain(own).collect(), lines.min_amplitude)
}

/// The faces of some racks, those of racks in line together.
fn faces(racks: &[Rack], near: f64) -> Vec<Face> {
    let face = |rack: &Rack, offset: f64| Face {
        direction: rack.row.direction as u32,
        offset,
        depth: rack.leg / 2.0,
        length: rack.row.length(),
        structure: rack.structure(),
    };
    let mut all: Vec<Face> = racks.iter().flat_map(|rack| rack.faces().map(|offset| face(rack, offset))).collect();
    all.sort_by(|a, b| a.direction.cmp(&b.direction).then(a.offset.total_cmp(&b.offset)));
    let in_line = |a: &Face, b: &Face| a.direction == b.direction && b.offset - a.offset <= near / 2.0;
    let common = |faces: &[Face]| {
        let sum = |of: fn(&Face) -> f64| faces.iter().map(of).sum::<f64>();
        let length = sum(|face| face.length);
        Face {
            direction: faces[0].direction,
            offset: sum(|face| face.offset * face.length) / length,
            depth: sum(|face| face.depth * face.length) / length,
            length,
            structure: sum(|face| face.structure),
        }
    };
    all.chunk_by(in_line).map(common).collect()
}
