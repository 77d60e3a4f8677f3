//! Dictionaries of arrays <-> the method's structures.

use groundplan::adjacency::Adjacency;
use groundplan::arrangement::NONE;
use groundplan::directions::Directions;
use groundplan::gradients::Gradients;
use groundplan::labels::Pattern;
use groundplan::lines::Lines;
use groundplan::occupancy::Occupancy;
use groundplan::parameters::{Parameter, Range};
use groundplan::radiograms::Radiogram;
use groundplan::subdivision::Subdivision;
use groundplan::sums::{FaceSums, Sums};
use groundplan::walls::{Wall, WallKind, Walls};
use groundplan::wavelets::Response;
use groundplan::{Frame, Given, Grid, Label, ParameterError, Parameters, State, Table, Value};
use numpy::{Element, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyString};

/// A grid as Python holds it: pixels (height, width) uint8 row after row, whether the first row is the lowest, values
/// (256,) int8, states (256,) uint8, resolution and origin.
#[derive(FromPyObject)]
pub struct Layout<'py>(
    PyReadonlyArray2<'py, u8>,
    bool,
    PyReadonlyArray1<'py, i8>,
    PyReadonlyArray1<'py, u8>,
    f64,
    [f64; 3],
);

impl Layout<'_> {
    /// Where the grid lies.
    pub fn frame(&self) -> Frame {
        let shape = self.0.as_array().dim();
        Frame::new(shape.1, shape.0, self.4, self.5)
    }

    /// Runs a stage over the pixels where they lie, with Python's lock released.
    pub fn with_grid<T: Send>(&self, py: Python<'_>, stage: impl FnOnce(&Grid) -> T + Send) -> PyResult<T> {
        let Frame { width, height, .. } = self.frame();
        self.with_part(py, (height, 0), [(0, height), (0, width)], 0, |grid, _| stage(grid))
    }
}

/// Rows of a grid that are at hand, counted from the bottom: the map's height, and the lowest row of those.
type Held = (usize, usize);

/// From, to.
type Span = (usize, usize);

impl Layout<'_> {
    /// Runs a stage over some rows and columns of a map, of which only the layout's rows are at hand; the stage needs
    /// those within `reach` of the rows.
    pub fn with_part<T: Send>(
        &self,
        py: Python<'_>,
        (height, first): Held,
        [rows, columns]: [Span; 2],
        reach: usize,
        stage: impl FnOnce(&Grid, [std::ops::Range<usize>; 2]) -> T + Send,
    ) -> PyResult<T> {
        let shape = self.0.as_array().dim();
        let held = first..first.saturating_add(shape.0);
        let frame = Frame::new(shape.1, height, self.4, self.5);
        let within = |(from, to): Span, end: usize| from <= to && to <= end;
        let sees = rows.0.saturating_sub(reach) >= held.start && rows.1.saturating_add(reach).min(height) <= held.end;
        demand(
            held.end <= height && within(rows, height) && within(columns, shape.1) && sees,
            "the rows asked for are not at hand",
        )?;
        let pixels = self.0.as_slice()?;
        let table = self.table()?;
        let grid = Grid::part(pixels, self.1, &table, frame, held);
        Ok(py.detach(|| stage(&grid, [rows.0..rows.1, columns.0..columns.1])))
    }

    fn table(&self) -> PyResult<Table> {
        let (values, states) = (self.2.as_slice()?, self.3.as_slice()?);
        let values: &[i8; 256] = values.try_into().map_err(|_| PyValueError::new_err("256 values"))?;
        let states: &[u8; 256] = states.try_into().map_err(|_| PyValueError::new_err("256 states"))?;
        Ok(Table::new(values, states))
    }
}

/// A dictionary being filled.
pub struct Named<'py>(Bound<'py, PyDict>);

impl<'py> Named<'py> {
    pub fn new(py: Python<'py>) -> Self {
        Self(PyDict::new(py))
    }

    pub fn with(self, name: &str, value: impl IntoPyObject<'py>) -> PyResult<Self> {
        self.0.set_item(name, value)?;
        Ok(self)
    }

    pub fn list<T: Element>(self, name: &str, values: Vec<T>) -> PyResult<Self> {
        let array = PyArray1::from_vec(self.0.py(), values).into_any();
        self.with(name, array)
    }

    pub fn pairs<T: Element>(self, name: &str, values: Vec<[T; 2]>) -> PyResult<Self> {
        let count = values.len();
        let flat = PyArray1::from_vec(self.0.py(), values.into_flattened());
        let array = flat.reshape([count, 2])?.into_any();
        self.with(name, array)
    }

    pub fn done(self) -> Bound<'py, PyDict> {
        self.0
    }
}

fn item<'py>(dict: &Bound<'py, PyDict>, name: &str) -> PyResult<Bound<'py, PyAny>> {
    dict.get_item(name)?.ok_or_else(|| PyValueError::new_err(format!("{name} is missing")))
}

fn number<'py, T: FromPyObjectOwned<'py>>(dict: &Bound<'py, PyDict>, name: &str) -> PyResult<T> {
    item(dict, name)?.extract().map_err(Into::into)
}

fn list<T: Element + Copy>(dict: &Bound<'_, PyDict>, name: &str) -> PyResult<Vec<T>> {
    let item = item(dict, name)?;
    let array = item.cast::<PyArray1<T>>()?.readonly();
    Ok(array.as_array().to_vec())
}

fn pairs<T: Element + Copy>(dict: &Bound<'_, PyDict>, name: &str) -> PyResult<Vec<[T; 2]>> {
    let item = item(dict, name)?;
    let array = item.cast::<PyArray2<T>>()?.readonly();
    let array = array.as_array();
    if array.ncols() != 2 {
        return Err(PyValueError::new_err(format!("{name} has {} columns and not 2", array.ncols())));
    }
    Ok(array.rows().into_iter().map(|row| [row[0], row[1]]).collect())
}

/// Arrays from outside must fit one another: the method trusts what its own stages made.
fn demand(fits: bool, sentence: &str) -> PyResult<()> {
    if fits { Ok(()) } else { Err(PyValueError::new_err(sentence.to_owned())) }
}

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
    let inside = |p: [u32; 2]| (p[0] as usize) < frame.width && (p[1] as usize) < frame.height;
    demand(made.pixels.iter().all(inside), "the gradients have pixels outside this map")?;
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

pub fn parameters(dict: &Bound<'_, PyDict>) -> PyResult<Parameters> {
    let mut parameters = Parameters::default();
    for (name, value) in dict {
        let name: String = name.extract()?;
        let value = to_value(&name, &value)?;
        parameters.set(&name, value).map_err(|fault| raise(dict.py(), &fault))?;
    }
    Ok(parameters)
}

fn to_value(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Value> {
    if value.is_none() {
        return Ok(Value::Auto);
    }
    if let Ok(word) = value.cast::<PyString>() {
        return Ok(Value::Word(word.to_string()));
    }
    if !value.is_instance_of::<PyBool>() {
        if let Ok(number) = value.extract::<f64>() {
            return Ok(Value::Number(number));
        }
        if let Ok(numbers) = value.extract::<Vec<f64>>() {
            return Ok(Value::Numbers(numbers));
        }
    }
    let message = format!("{name} cannot be {}", value.repr()?);
    let fault = ParameterError { code: "parameter.range", message, hint: "a number, a word or a list".to_owned() };
    Err(raise(value.py(), &fault))
}

/// The one error that crosses over: Groundplan's own, with its code and its hint.
fn raise(py: Python<'_>, fault: &ParameterError) -> PyErr {
    let made = py
        .import("groundplan._errors")
        .and_then(|module| module.getattr("ParameterError"))
        .and_then(|class| class.call1((fault.code, &fault.message, &fault.hint)));
    made.map_or_else(|error| error, PyErr::from_value)
}

fn from_value<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    match value {
        Value::Auto => Ok(py.None().into_bound(py)),
        Value::Number(n) => Ok(n.into_pyobject(py)?.into_any()),
        Value::Word(word) => Ok(word.into_pyobject(py)?.into_any()),
        Value::Numbers(ns) => ns.into_pyobject(py),
    }
}

pub fn values<'py>(py: Python<'py>, parameters: &Parameters) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for (name, value) in parameters.values() {
        dict.set_item(name, from_value(py, &value)?)?;
    }
    Ok(dict)
}

pub fn table_row<'py>(py: Python<'py>, row: &Parameter) -> PyResult<Bound<'py, PyDict>> {
    let words = if let Range::Word(words) = row.range { words.to_vec() } else { Vec::new() };
    Ok(Named::new(py)
        .with("name", row.name)?
        .with("unit", row.unit)?
        .with("default", from_value(py, &row.default())?)?
        .with("range", row.range.to_string())?
        .with("words", words)?
        .with("sentence", row.sentence)?
        .with("section", row.section)?
        .done())
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
    demand(made.angles.iter().all(|a| a.is_finite()), "an angle of the gradients is not finite")?;
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

fn kind(label: &Label) -> &'static str {
    match label {
        Label::Corridor { .. } => "corridor",
        Label::Junction { .. } => "junction",
        Label::Region { .. } => "region",
        Label::Door { .. } => "door",
        Label::Rack { .. } => "rack",
        Label::Pillar { .. } => "pillar",
    }
}

/// A label is a dictionary of plain values, as in the survey's JSON.
pub fn from_label<'py>(py: Python<'py>, label: &Label, confidence: f64) -> PyResult<Bound<'py, PyDict>> {
    let named = Named::new(py).with("kind", kind(label))?;
    let named = match label {
        Label::Corridor { faces, polygon, axis, width, name } => named
            .with("faces", faces)?
            .with("polygon", polygon)?
            .with("axis", axis)?
            .with("width", *width)?
            .with("name", name)?,
        Label::Junction { kind, faces, polygon, at, corridors } => named
            .with("type", kind.name())?
            .with("faces", faces)?
            .with("polygon", polygon)?
            .with("at", at)?
            .with("corridors", corridors)?,
        Label::Region { purpose, faces, polygon, holes, at, area, name } => named
            .with("use", purpose.name())?
            .with("faces", faces)?
            .with("polygon", polygon)?
            .with("holes", holes)?
            .with("at", at)?
            .with("area", *area)?
            .with("name", name)?,
        Label::Door { at, axis, width, between } => {
            named.with("at", at)?.with("axis", axis)?.with("width", *width)?.with("between", between)?
        }
        Label::Rack { faces, polygon, axis, width, pitch, phase, name } => named
            .with("faces", faces)?
            .with("polygon", polygon)?
            .with("axis", axis)?
            .with("width", *width)?
            .with("pitch", *pitch)?
            .with("phase", *phase)?
            .with("name", name)?,
        Label::Pillar { at, width, pattern, name } => {
            named.with("at", at)?.with("width", *width)?.with("pattern", *pattern)?.with("name", name)?
        }
    };
    Ok(named.with("confidence", confidence)?.done())
}

/// Patterns are few.
pub fn from_patterns<'py>(py: Python<'py>, made: &[Pattern]) -> PyResult<Vec<Bound<'py, PyDict>>> {
    let convert = |pattern: &Pattern| {
        Ok(Named::new(py)
            .with("kind", pattern.kind.name())?
            .with("labels", &pattern.labels)?
            .with("angle", pattern.angle)?
            .with("pitch", pattern.pitch)?
            .with("phase", pattern.phase)?
            .done())
    };
    made.iter().map(convert).collect()
}
