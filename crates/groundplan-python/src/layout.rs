//! Maps as Python holds them.

use crate::named::demand;
use groundplan::{Frame, Grid, Table};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

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
