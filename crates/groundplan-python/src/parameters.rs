//! Parameters by their names, and the rows of their table.

use crate::named::Named;
use groundplan::parameters::{Parameter, Range};
use groundplan::{ParameterError, Parameters, Value};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyString};

/// Parameters, those that are named being set.
pub fn read(dict: &Bound<'_, PyDict>) -> PyResult<Parameters> {
    let raised = |fault: ParameterError| raise(dict.py(), &fault);
    let mut parameters = Parameters::default();
    for (name, value) in dict {
        let name: String = name.extract()?;
        // A name that there is not is told before a value that no parameter has.
        let parameter = Parameter::named(&name).map_err(raised)?;
        parameter.put(&mut parameters, to_value(&name, &value)?).map_err(raised)?;
    }
    parameters.check().map_err(raised)?;
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

/// Every parameter's value.
pub fn values<'py>(py: Python<'py>, parameters: &Parameters) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for (name, value) in parameters.values() {
        dict.set_item(name, from_value(py, &value)?)?;
    }
    Ok(dict)
}

/// A row of the table.
pub fn row<'py>(py: Python<'py>, row: &Parameter) -> PyResult<Bound<'py, PyDict>> {
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
