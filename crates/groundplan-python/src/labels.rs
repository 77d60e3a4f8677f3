//! Labels as they were found: of a large map they take several times as much memory in Python, where most are never
//! looked at.

use crate::named::Named;
use groundplan::Label;
use groundplan::labels::Pattern;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// What is what, and how sure that is.
#[pyclass(frozen)]
pub struct Labels {
    labels: Vec<Label>,
    confidence: Vec<f64>,
}

#[pymethods]
impl Labels {
    fn __len__(&self) -> usize {
        self.labels.len()
    }

    /// Those from one to before another, as dictionaries.
    fn some<'py>(&self, py: Python<'py>, start: usize, to: usize) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let all = self.labels.iter().zip(&self.confidence);
        all.take(to).skip(start).map(|(label, &confidence)| from_label(py, label, confidence)).collect()
    }
}

impl Labels {
    pub fn new(labels: Vec<Label>, confidence: Vec<f64>) -> Self {
        Self { labels, confidence }
    }

    pub fn all<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        self.some(py, 0, self.labels.len())
    }
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
