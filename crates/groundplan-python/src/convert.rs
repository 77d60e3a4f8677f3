//! What the stages make <-> dictionaries of arrays.

use crate::named::{Named, demand, list, number, pairs};
use groundplan::adjacency::Adjacency;
use groundplan::arrangement::NONE;
use groundplan::directions::Directions;
use groundplan::gradients::Gradients;
use groundplan::lines::Lines;
use groundplan::occupancy::Occupancy;
use groundplan::radiograms::Radiogram;
use groundplan::subdivision::Subdivision;
use groundplan::sums::{FaceSums, Sums};
use groundplan::walls::{Wall, WallKind, Walls};
use groundplan::wavelets::Response;
use groundplan::{Frame, Given, State};
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Lines and the directions that they name.
fn demand_directions(lines: &Lines, directions: &Directions) -> PyResult<()> {
    let known = |&d: &u32| (d as usize) < directions.angles.len();
    demand(lines.directions.iter().all(known), "a line names a direction that there is not")
}

/// Directions, and lines of them.
pub fn lines_of(directions: &Bound<'_, PyDict>, lines: &Bound<'_, PyDict>) -> PyResult<(Directions, Lines)> {
    let made = (self::directions(directions)?, self::lines(lines)?);
    demand_directions(&made.1, &made.0)?;
    Ok(made)
}

/// Gradients that lie on the grid.
pub fn gradients_on(dict: &Bound<'_, PyDict>, frame: &Frame) -> PyResult<Gradients> {
    let made = gradients(dict)?;
    let outside = |[x, y]: [u32; 2]| x as usize >= frame.width || y as usize >= frame.height;
    // None is as a rule, so that to look at all of them is quickest.
    let any = made.pixels.iter().fold(false, |any, pixel| any | outside(pixel));
    demand(!any, "the gradients have pixels outside this map")?;
    Ok(made)
}

/// A row for each face: percent, unknown, free and pixels of the pixels within it, then of the one under a sliver.
pub fn from_sums<'py>(py: Python<'py>, made: &FaceSums) -> PyResult<Bound<'py, PyArray2<i64>>> {
    let row = |sums: &Sums| [sums.percent, sums.unknown, sums.free, sums.pixels];
    let mut rows = vec![0; 8 * made.within.len()];
    for (to, sums) in rows.chunks_exact_mut(8).zip(&made.within) {
        to[..4].copy_from_slice(&row(sums));
    }
    for (face, sums) in &made.under {
        rows[8 * *face as usize + 4..][..4].copy_from_slice(&row(sums));
    }
    PyArray1::from_vec(py, rows).reshape([made.within.len(), 8])
}

fn sums(array: &Bound<'_, PyAny>) -> PyResult<FaceSums> {
    let array = array.cast::<PyArray2<i64>>()?.readonly();
    let array = array.as_array();
    demand(array.ncols() == 8, "the sums have not 8 columns")?;
    let columns = |from: usize| {
        let sums = move |row: numpy::ndarray::ArrayView1<'_, i64>| Sums {
            percent: row[from],
            unknown: row[from + 1],
            free: row[from + 2],
            pixels: row[from + 3],
        };
        array.rows().into_iter().map(sums)
    };
    let under = (0..).zip(columns(4)).filter(|(_, sums)| sums.pixels > 0).collect();
    let made = FaceSums { within: columns(0).collect(), under };
    demand(made.evidence().all(|sums| sums.pixels > 0), "the sums are not those of all rows")?;
    Ok(made)
}

/// What a survey keeps for another one.
#[pyclass(frozen, module = "groundplan._core")]
pub struct Memory(pub groundplan::Memory);

/// The stages that are given, by their names.
pub fn given(dict: &Bound<'_, PyDict>, frame: &Frame) -> PyResult<Given> {
    let record = |name: &str| -> PyResult<Option<Bound<'_, PyDict>>> {
        dict.get_item(name)?.map(|item| item.cast_into().map_err(Into::into)).transpose()
    };
    let given = Given {
        gradients: record("gradients")?.map(|dict| gradients_on(&dict, frame)).transpose()?,
        directions: record("directions")?.as_ref().map(directions).transpose()?,
        lines: record("lines")?.as_ref().map(lines).transpose()?,
        sums: dict.get_item("sums")?.as_ref().map(sums).transpose()?,
        memory: dict
            .get_item("memory")?
            .map(|kept| Ok::<_, PyErr>(kept.cast::<Memory>()?.get().0.clone()))
            .transpose()?,
        keep: false,
    };
    if let Some(lines) = &given.lines {
        let none = Directions::default();
        demand_directions(lines, given.directions.as_ref().unwrap_or(&none))?;
    }
    Ok(given)
}

/// Measures and the subdivision that they are of.
pub fn demand_subdivision(subdivision: &Subdivision, faces: usize, edges: usize) -> PyResult<()> {
    let fits = faces == subdivision.faces() && edges == subdivision.edge_vertices.len();
    demand(fits, "the faces or edges are not those of this subdivision")
}

/// Ids as Python has them: none is -1, which has the bits of [`NONE`].
fn signed(ids: Vec<u32>) -> Vec<i32> {
    ids.into_iter().map(|id| id as i32).collect()
}

fn unsigned(ids: &[i32]) -> Vec<u32> {
    ids.iter().map(|&id| u32::try_from(id).unwrap_or(NONE)).collect()
}

pub fn from_gradients(py: Python<'_>, made: Gradients) -> PyResult<Bound<'_, PyDict>> {
    Ok(Named::new(py)
        .pairs("pixels", made.pixels.iter().collect())?
        .list("angles", made.angles)?
        .list("magnitudes", made.magnitudes)?
        .done())
}

fn gradients(dict: &Bound<'_, PyDict>) -> PyResult<Gradients> {
    let made = Gradients {
        pixels: pairs(dict, "pixels")?.into_iter().collect(),
        angles: list(dict, "angles")?,
        magnitudes: list(dict, "magnitudes")?,
    };
    let count = made.pixels.len();
    demand(made.angles.len() == count && made.magnitudes.len() == count, "the gradients' arrays differ in length")?;
    let any = made.angles.iter().fold(false, |any, angle| any | !angle.is_finite());
    demand(!any, "an angle of the gradients is not finite")?;
    Ok(made)
}

pub fn from_directions(py: Python<'_>, made: Directions) -> PyResult<Bound<'_, PyDict>> {
    Ok(Named::new(py)
        .list("angles", made.angles)?
        .list("weights", made.weights)?
        .list("histogram", made.histogram)?
        .with("explained", made.explained)?
        .done())
}

pub fn directions(dict: &Bound<'_, PyDict>) -> PyResult<Directions> {
    let made = Directions {
        angles: list(dict, "angles")?,
        weights: list(dict, "weights")?,
        histogram: list(dict, "histogram")?,
        explained: number(dict, "explained")?,
    };
    demand(made.angles.len() == made.weights.len(), "the directions' arrays differ in length")?;
    demand(made.angles.iter().all(|a| a.is_finite()), "an angle of the directions is not finite")?;
    Ok(made)
}

pub fn from_radiograms<'py>(py: Python<'py>, made: &[Radiogram]) -> PyResult<Vec<Bound<'py, PyDict>>> {
    let convert = |r: &Radiogram| {
        Ok(Named::new(py)
            .with("direction", r.direction)?
            .with("start", r.start)?
            .with("step", r.step)?
            .list("values", r.values.clone())?
            .done())
    };
    made.iter().map(convert).collect()
}

pub fn radiogram(dict: &Bound<'_, PyDict>) -> PyResult<Radiogram> {
    Ok(Radiogram {
        direction: number(dict, "direction")?,
        start: number(dict, "start")?,
        step: number(dict, "step")?,
        values: list(dict, "values")?,
    })
}

pub fn from_response<'py>(py: Python<'py>, made: &Response, step: f64) -> PyResult<Bound<'py, PyDict>> {
    Ok(Named::new(py)
        .list("widths", made.widths.iter().map(|w| w * step).collect())?
        .with("rows", PyArray2::from_vec2(py, &made.rows).map_err(|e| PyValueError::new_err(e.to_string()))?)?
        .done())
}

pub fn from_lines(py: Python<'_>, made: Lines) -> PyResult<Bound<'_, PyDict>> {
    Ok(Named::new(py)
        .list("directions", made.directions)?
        .list("offsets", made.offsets)?
        .list("amplitudes", made.amplitudes)?
        .list("widths", made.widths)?
        .with("min_amplitude", made.min_amplitude)?
        .done())
}

pub fn lines(dict: &Bound<'_, PyDict>) -> PyResult<Lines> {
    let made = Lines {
        directions: list(dict, "directions")?,
        offsets: list(dict, "offsets")?,
        amplitudes: list(dict, "amplitudes")?,
        widths: list(dict, "widths")?,
        min_amplitude: number(dict, "min_amplitude")?,
    };
    let count = made.offsets.len();
    let same = [made.directions.len(), made.amplitudes.len(), made.widths.len()].iter().all(|n| *n == count);
    demand(same, "the lines' arrays differ in length")?;
    demand(made.offsets.iter().all(|o| o.is_finite()), "an offset of the lines is not finite")?;
    Ok(made)
}

pub fn from_subdivision(py: Python<'_>, made: Subdivision) -> PyResult<Bound<'_, PyDict>> {
    let sides = made.edge_faces.into_iter().map(|f| f.map(|f| f as i32)).collect();
    Ok(Named::new(py)
        .pairs("vertices", made.vertices)?
        .pairs("edge_vertices", made.edge_vertices)?
        .list("edge_lines", signed(made.edge_lines))?
        .pairs("edge_faces", sides)?
        .list("face_vertices", made.face_vertices)?
        .list("face_edges", made.face_edges)?
        .list("face_offsets", made.face_offsets)?
        .pairs("centres", made.centres)?
        .list("areas", made.areas)?
        .with("map_area", made.map_area)?
        .done())
}

fn edge_faces(dict: &Bound<'_, PyDict>) -> PyResult<Vec<[u32; 2]>> {
    let sides: Vec<[i32; 2]> = pairs(dict, "edge_faces")?;
    Ok(sides.into_iter().map(|f| f.map(|f| u32::try_from(f).unwrap_or(NONE))).collect())
}

/// The two faces of each edge, and whether it is cogent.
pub fn edges(subdivision: &Bound<'_, PyDict>, walls: &Bound<'_, PyDict>) -> PyResult<(Vec<[u32; 2]>, Vec<bool>)> {
    let (faces, cogent) = (edge_faces(subdivision)?, list(walls, "cogent")?);
    demand(faces.len() == cogent.len(), "the faces or edges are not those of this subdivision")?;
    Ok((faces, cogent))
}

pub fn subdivision(dict: &Bound<'_, PyDict>) -> PyResult<Subdivision> {
    Ok(Subdivision {
        vertices: pairs(dict, "vertices")?,
        edge_vertices: pairs(dict, "edge_vertices")?,
        edge_lines: unsigned(&list::<i32>(dict, "edge_lines")?),
        edge_faces: edge_faces(dict)?,
        face_vertices: list(dict, "face_vertices")?,
        face_edges: list(dict, "face_edges")?,
        face_offsets: list(dict, "face_offsets")?,
        centres: pairs(dict, "centres")?,
        areas: list(dict, "areas")?,
        map_area: number(dict, "map_area")?,
    })
}

pub fn from_occupancy(py: Python<'_>, made: Occupancy) -> PyResult<Bound<'_, PyDict>> {
    Ok(Named::new(py)
        .list("faces", made.faces)?
        .list("unknown", made.unknown)?
        .list("free", made.free)?
        .list("pixels", made.pixels)?
        .list("states", made.states.into_iter().map(|s| s as u8).collect())?
        .list("edges", made.edges)?
        .pairs("runs", made.runs)?
        .list("run_offsets", made.run_offsets)?
        .done())
}

pub fn occupancy(dict: &Bound<'_, PyDict>) -> PyResult<Occupancy> {
    let states: Vec<u8> = list(dict, "states")?;
    let state = |s: u8| match s {
        0 => State::Free,
        1 => State::Occupied,
        _ => State::Unknown,
    };
    let made = Occupancy {
        faces: list(dict, "faces")?,
        unknown: list(dict, "unknown")?,
        free: list(dict, "free")?,
        pixels: list(dict, "pixels")?,
        states: states.into_iter().map(state).collect(),
        edges: list(dict, "edges")?,
        runs: pairs(dict, "runs")?,
        run_offsets: list(dict, "run_offsets")?,
    };
    demand(made.run_offsets.len() == made.edges.len() + 1, "the runs are not those of these edges")?;
    demand(made.run_offsets.is_sorted(), "the offsets of the runs do not rise")?;
    let last = made.run_offsets.last().map_or(0, |&n| n as usize);
    demand(last <= made.runs.len(), "the offsets of the runs go beyond them")?;
    Ok(made)
}

pub fn from_walls(py: Python<'_>, made: Walls) -> PyResult<Bound<'_, PyDict>> {
    let ends: Vec<[f64; 2]> = made.walls.iter().flat_map(|w| w.points).collect();
    Ok(Named::new(py)
        .list("cogent", made.cogent)?
        .list("disparity", made.disparity)?
        .pairs("points", ends)?
        .list("lines", made.walls.iter().map(|w| w.line).collect())?
        .list("freestanding", made.walls.iter().map(|w| w.kind == WallKind::Freestanding).collect())?
        .done())
}

pub fn walls(dict: &Bound<'_, PyDict>) -> PyResult<Walls> {
    let ends: Vec<[f64; 2]> = pairs(dict, "points")?;
    let lines: Vec<u32> = list(dict, "lines")?;
    let freestanding: Vec<bool> = list(dict, "freestanding")?;
    let wall = |((ends, &line), &free): ((&[[f64; 2]], &u32), &bool)| Wall {
        points: [ends[0], ends[1]],
        line,
        kind: if free { WallKind::Freestanding } else { WallKind::Separating },
    };
    Ok(Walls {
        cogent: list(dict, "cogent")?,
        disparity: list(dict, "disparity")?,
        walls: ends.chunks_exact(2).zip(&lines).zip(&freestanding).map(wall).collect(),
    })
}

pub fn from_adjacency(py: Python<'_>, made: Adjacency) -> PyResult<Bound<'_, PyDict>> {
    Ok(Named::new(py).pairs("faces", made.faces)?.list("edges", made.edges)?.list("connected", made.connected)?.done())
}
