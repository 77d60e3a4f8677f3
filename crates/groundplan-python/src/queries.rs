//! What is asked of a survey again and again: objects that keep an index.

use crate::{convert, layout::Layout};
use groundplan::locate::Polygons;
use groundplan::route::Evidence;
use groundplan::{Frame, locate, route};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Width, height, resolution, origin.
type Place = (usize, usize, f64, [f64; 3]);

fn frame((width, height, resolution, origin): Place) -> Frame {
    Frame::new(width, height, resolution, origin)
}

fn points(array: &PyReadonlyArray2<'_, f64>) -> PyResult<Vec<[f64; 2]>> {
    let array = array.as_array();
    if array.ncols() != 2 {
        return Err(PyValueError::new_err(format!("points have 2 coordinates and not {}", array.ncols())));
    }
    Ok(array.rows().into_iter().map(|row| [row[0], row[1]]).collect())
}

/// Points of rings one after another, and where each begins.
type Ragged<'py> = (PyReadonlyArray2<'py, f64>, Vec<usize>);

/// Ragged points as rings.
fn rings(array: &PyReadonlyArray2<'_, f64>, offsets: &[usize]) -> PyResult<Vec<Vec<[f64; 2]>>> {
    let points = points(array)?;
    let ring = |pair: &[usize]| points.get(pair[0]..pair[1]).map(<[_]>::to_vec);
    let found: Option<Vec<_>> = offsets.windows(2).map(ring).collect();
    found.ok_or_else(|| PyValueError::new_err("the offsets of the rings do not fit"))
}

/// Which face and which labels hold a point.
#[pyclass(frozen)]
pub struct Locator {
    faces: locate::Locator,
    labels: Polygons,
}

#[pymethods]
impl Locator {
    /// Of the faces that the lines make, and of rings that each belong to a label.
    #[new]
    fn new(
        place: Place,
        directions: &Bound<'_, PyDict>,
        lines: &Bound<'_, PyDict>,
        ring_points: PyReadonlyArray2<'_, f64>,
        offsets: Vec<usize>,
        labels: Vec<u32>,
    ) -> PyResult<Self> {
        let (directions, lines) = convert::lines_of(directions, lines)?;
        let rings: Vec<_> = labels.into_iter().zip(rings(&ring_points, &offsets)?).collect();
        let faces = locate::Locator::new(&frame(place), &directions.angles, &lines);
        Ok(Self { faces, labels: Polygons::new(&rings) })
    }

    /// How many faces there are.
    #[getter]
    fn faces(&self) -> usize {
        self.faces.arrangement().face_count()
    }

    /// The face that holds a point.
    fn locate(&self, x: f64, y: f64) -> Option<u32> {
        self.faces.locate([x, y])
    }

    /// The face that holds each point, -1 outside.
    fn locate_all<'py>(
        &self,
        py: Python<'py>,
        array: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<i32>>> {
        let points = points(&array)?;
        let found = py.detach(|| points.iter().map(|&p| self.faces.locate(p).map_or(-1, |f| f as i32)).collect());
        Ok(PyArray1::from_vec(py, found))
    }

    /// The labels whose polygons hold a point.
    fn labels_at(&self, x: f64, y: f64) -> Vec<u32> {
        self.labels.holding([x, y])
    }

    /// The labels whose polygons hold a point of a way, of which one is asked every so many metres; ascending.
    fn labels_along(&self, way: PyReadonlyArray2<'_, f64>, step: f64) -> PyResult<Vec<u32>> {
        let points = points(&way)?;
        Ok(self.labels.along(&points, step))
    }

    /// The faces that a way passes through, in order.
    fn along<'py>(&self, py: Python<'py>, way: PyReadonlyArray2<'py, f64>) -> PyResult<Bound<'py, PyArray1<u32>>> {
        let points = points(&way)?;
        let mut faces: Vec<u32> = points.windows(2).flat_map(|pair| self.faces.between(pair[0], pair[1])).collect();
        if let [only] = points[..] {
            faces.extend(self.faces.locate(only));
        }
        faces.dedup();
        Ok(PyArray1::from_vec(py, faces))
    }
}

/// The ways that keep a clearance.
#[pyclass(frozen)]
pub struct Ways(route::Ways);

#[pymethods]
impl Ways {
    /// Over a map's own pixels, none of which are free within rings.
    #[staticmethod]
    fn of_map(py: Python<'_>, layout: Layout<'_>, closed: Ragged<'_>, clearance: f64) -> PyResult<Self> {
        let closed = rings(&closed.0, &closed.1)?;
        layout.with_grid(py, |grid| route::Ways::of_map(grid, &closed, clearance)).map(Self)
    }

    /// Over what a survey knows: free within an odd number of rings, taken along segments (two points each) and within
    /// other rings.
    #[staticmethod]
    fn of_survey(
        py: Python<'_>,
        place: Place,
        free: Ragged<'_>,
        taken: PyReadonlyArray2<'_, f64>,
        closed: Ragged<'_>,
        clearance: f64,
    ) -> PyResult<Self> {
        let ends = points(&taken)?;
        let evidence = Evidence {
            rings: rings(&free.0, &free.1)?,
            taken: ends.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect(),
            closed: rings(&closed.0, &closed.1)?,
        };
        Ok(Self(py.detach(|| route::Ways::of_survey(&frame(place), &evidence, clearance))))
    }

    /// Whether a robot's middle may be at a point.
    fn is_open(&self, x: f64, y: f64) -> bool {
        self.0.is_open([x, y])
    }

    /// The nearest place where a robot may be, no farther than `reach`.
    fn nearest(&self, x: f64, y: f64, reach: f64) -> Option<[f64; 2]> {
        self.0.nearest([x, y], reach)
    }

    /// The way between two points where a robot may be.
    fn route<'py>(
        &self,
        py: Python<'py>,
        start: [f64; 2],
        end: [f64; 2],
    ) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        let Some(way) = py.detach(|| self.0.route(start, end)) else { return Ok(None) };
        let count = way.len();
        PyArray1::from_vec(py, way.into_flattened()).reshape([count, 2]).map(Some)
    }
}
