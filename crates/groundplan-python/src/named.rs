//! Dictionaries of arrays, filled and read.

use numpy::{Element, PyArray1, PyArray2, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

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

pub fn number<'py, T: FromPyObjectOwned<'py>>(dict: &Bound<'py, PyDict>, name: &str) -> PyResult<T> {
    item(dict, name)?.extract().map_err(Into::into)
}

pub fn list<T: Element + Copy>(dict: &Bound<'_, PyDict>, name: &str) -> PyResult<Vec<T>> {
    let item = item(dict, name)?;
    let array = item.cast::<PyArray1<T>>()?.readonly();
    Ok(array.as_array().to_vec())
}

pub fn pairs<T: Element + Copy>(dict: &Bound<'_, PyDict>, name: &str) -> PyResult<Vec<[T; 2]>> {
    let item = item(dict, name)?;
    let array = item.cast::<PyArray2<T>>()?.readonly();
    let array = array.as_array();
    if array.ncols() != 2 {
        return Err(PyValueError::new_err(format!("{name} has {} columns and not 2", array.ncols())));
    }
    Ok(match array.as_slice() {
        Some(flat) => flat.chunks_exact(2).map(|row| [row[0], row[1]]).collect(),
        None => array.rows().into_iter().map(|row| [row[0], row[1]]).collect(),
    })
}

/// Arrays from outside must fit one another: the method trusts what its own stages made.
pub fn demand(fits: bool, sentence: &str) -> PyResult<()> {
    if fits { Ok(()) } else { Err(PyValueError::new_err(sentence.to_owned())) }
}
