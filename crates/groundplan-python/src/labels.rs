//! Labels as they were found: of a large map they take several times as much memory in Python, where most are never
//! looked at.

use crate::convert;
use groundplan::Label;
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
        all.take(to).skip(start).map(|(label, &confidence)| convert::from_label(py, label, confidence)).collect()
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
