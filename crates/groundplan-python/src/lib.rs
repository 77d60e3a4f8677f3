//! The Python module `groundplan._core`: arrays and parameters in, arrays out; no logic.

mod convert;
mod labels;
mod layout;
mod named;
mod parameters;
#[allow(clippy::needless_pass_by_value)]
mod queries;

// What PyO3 hands over it hands over by value.
#[allow(clippy::needless_pass_by_value)]
/// The method, as Python sees it. Every stage takes and gives dictionaries of arrays, which `groundplan.survey` wraps.
#[pyo3::pymodule]
mod _core {
    #[pymodule_export]
    use crate::convert::Memory;
    #[pymodule_export]
    use crate::labels::Labels;
    #[pymodule_export]
    use crate::queries::{Locator, Ways};
    #[pymodule_export]
    const SAME_DIRECTION: f64 = directions::SAME_DIRECTION;
    #[pymodule_export]
    const UNSURE: f64 = groundplan::UNSURE;
    use crate::{convert, labels::from_patterns, layout::Layout, named::Named, parameters};
    use groundplan::{Given, subdivision::Subdivision, sums::FaceSums, walls};
    use groundplan::{TABLE, adjacency, arrangement, directions, gradients, labels, lines, occupancy, radiograms};
    use numpy::PyArray2;
    use pyo3::prelude::*;
    use pyo3::types::PyDict;

    /// The version of the method.
    #[pyfunction]
    fn version() -> &'static str {
        groundplan::VERSION
    }

    /// Rows of TABLE: name, unit, default, range, sentence, section.
    #[pyfunction]
    fn table(py: Python<'_>) -> PyResult<Vec<Bound<'_, PyDict>>> {
        TABLE.iter().map(|row| parameters::row(py, row)).collect()
    }

    /// Every parameter's value, with those of `parameters` set.
    #[pyfunction]
    fn resolve<'py>(py: Python<'py>, parameters: &Bound<'py, PyDict>) -> PyResult<Bound<'py, PyDict>> {
        parameters::values(py, &parameters::read(parameters)?)
    }

    /// All stages in a row, but for those that are given; gradients that were found are kept where they will be wanted again.
    #[pyfunction]
    fn survey<'py>(
        py: Python<'py>,
        layout: Layout<'py>,
        parameters: &Bound<'py, PyDict>,
        threads: usize,
        given: &Bound<'py, PyDict>,
        keep: bool,
    ) -> PyResult<Bound<'py, PyDict>> {
        let parameters = parameters::read(parameters)?;
        let given = Given { keep, ..convert::given(given, &layout.frame())? };
        let are_new = keep && given.gradients.is_none();
        let made = layout.with_grid(py, |grid| groundplan::survey(grid, &parameters, given, threads))?;
        // There is a face at least: none are where they are not kept.
        let divided = Some(made.subdivision).filter(|made| made.faces() > 0);
        let gradients = are_new.then_some(made.gradients).map(|kept| convert::from_gradients(py, kept)).transpose()?;
        Ok(Named::new(py)
            .with("gradients", gradients)?
            .with("memory", Memory(made.memory))?
            .with("directions", convert::from_directions(py, made.directions)?)?
            .with("radiograms", convert::from_radiograms(py, &made.radiograms)?)?
            .with("lines", convert::from_lines(py, made.lines)?)?
            .with("subdivision", divided.map(|made| convert::from_subdivision(py, made)).transpose()?)?
            .with("occupancy", convert::from_occupancy(py, made.occupancy)?)?
            .with("walls", convert::from_walls(py, made.walls)?)?
            .with("labels", Py::new(py, Labels::new(made.labels, made.confidence))?)?
            .with("patterns", from_patterns(py, &made.patterns)?)?
            .with("warnings", made.warnings.into_iter().map(|w| (w.code, w.message)).collect::<Vec<_>>())?
            .done())
    }

    /// Whether a map is of so many pixels that memory is spared.
    #[pyfunction]
    fn is_large(layout: Layout<'_>) -> bool {
        groundplan::is_large(&layout.frame())
    }

    /// II-A: oriented gradients of the edge pixels.
    #[pyfunction]
    fn find_gradients<'py>(
        py: Python<'py>,
        layout: Layout<'py>,
        parameters: &Bound<'py, PyDict>,
        threads: usize,
    ) -> PyResult<Bound<'py, PyDict>> {
        let parameters = parameters::read(parameters)?;
        let made = layout.with_grid(py, |grid| gradients::find_gradients(grid, &parameters, threads))?;
        convert::from_gradients(py, made)
    }

    /// II-A: oriented gradients of some rows and columns of a map, of which only the layout's rows are at hand.
    #[pyfunction]
    fn find_gradients_in<'py>(
        py: Python<'py>,
        layout: Layout<'py>,
        held: (usize, usize),
        rows: (usize, usize),
        columns: (usize, usize),
        parameters: &Bound<'py, PyDict>,
        threads: usize,
    ) -> PyResult<Bound<'py, PyDict>> {
        let parameters = parameters::read(parameters)?;
        let reach = gradients::reach(layout.frame().resolution, &parameters);
        let made = layout.with_part(py, held, [rows, columns], reach, |grid, [rows, columns]| {
            gradients::find_gradients_in(grid, rows, columns, &parameters, threads)
        })?;
        convert::from_gradients(py, made)
    }

    /// How far a pixel bears on gradients around it, pixels.
    #[pyfunction]
    fn reach(resolution: f64, parameters: &Bound<'_, PyDict>) -> PyResult<usize> {
        Ok(gradients::reach(resolution, &parameters::read(parameters)?))
    }

    /// II-A: dominant directions.
    #[pyfunction]
    fn find_directions<'py>(
        py: Python<'py>,
        layout: Layout<'py>,
        gradients: &Bound<'py, PyDict>,
        parameters: &Bound<'py, PyDict>,
        threads: usize,
    ) -> PyResult<Bound<'py, PyDict>> {
        let frame = layout.frame();
        let (gradients, parameters) = (convert::gradients_on(gradients, &frame)?, parameters::read(parameters)?);
        let made = py.detach(|| directions::find_directions(&frame, &gradients, &parameters, threads));
        convert::from_directions(py, made)
    }

    /// II-B: one radiogram for each direction.
    #[pyfunction]
    fn find_radiograms<'py>(
        py: Python<'py>,
        layout: Layout<'py>,
        gradients: &Bound<'py, PyDict>,
        directions: &Bound<'py, PyDict>,
        parameters: &Bound<'py, PyDict>,
        threads: usize,
    ) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let frame = layout.frame();
        let gradients = convert::gradients_on(gradients, &frame)?;
        let (directions, parameters) = (convert::directions(directions)?, parameters::read(parameters)?);
        let made = py.detach(|| radiograms::find_radiograms(&frame, &gradients, &directions, &parameters, threads));
        convert::from_radiograms(py, &made)
    }

    /// II-B: the wavelet response that a radiogram's peaks are read from: widths in metres, and a row for each.
    #[pyfunction]
    fn find_response<'py>(
        py: Python<'py>,
        radiogram: &Bound<'py, PyDict>,
        parameters: &Bound<'py, PyDict>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let radiogram = convert::radiogram(radiogram)?;
        let made = lines::respond(&radiogram, &parameters::read(parameters)?);
        convert::from_response(py, &made, radiogram.step)
    }

    /// II-B: lines.
    #[pyfunction]
    fn find_lines<'py>(
        py: Python<'py>,
        radiograms: Vec<Bound<'py, PyDict>>,
        parameters: &Bound<'py, PyDict>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let radiograms = radiograms.iter().map(convert::radiogram).collect::<PyResult<Vec<_>>>()?;
        convert::from_lines(py, lines::find_lines(&radiograms, &parameters::read(parameters)?, 1))
    }

    /// The lines, and those along the faces of racks on legs.
    #[pyfunction]
    fn add_rack_faces<'py>(
        py: Python<'py>,
        layout: Layout<'py>,
        gradients: &Bound<'py, PyDict>,
        directions: &Bound<'py, PyDict>,
        lines: &Bound<'py, PyDict>,
        parameters: &Bound<'py, PyDict>,
        threads: usize,
    ) -> PyResult<Bound<'py, PyDict>> {
        let gradients = convert::gradients_on(gradients, &layout.frame())?;
        let (directions, lines) = convert::lines_of(directions, lines)?;
        let parameters = parameters::read(parameters)?;
        let made = layout
            .with_grid(py, |grid| labels::add_rack_faces(grid, &gradients, &directions, lines, &parameters, threads))?;
        convert::from_lines(py, made)
    }

    /// II-C: vertices, edges, faces.
    #[pyfunction]
    fn subdivide<'py>(
        py: Python<'py>,
        layout: Layout<'py>,
        directions: &Bound<'py, PyDict>,
        lines: &Bound<'py, PyDict>,
        threads: usize,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (directions, lines) = convert::lines_of(directions, lines)?;
        let frame = layout.frame();
        let made = py.detach(|| {
            let made = arrangement::arrange(&frame, &directions.angles, &lines, threads);
            Subdivision::new(&frame, made, threads)
        });
        convert::from_subdivision(py, made)
    }

    /// Every broken invariant of a subdivision.
    #[pyfunction]
    fn problems(subdivision: &Bound<'_, PyDict>) -> PyResult<Vec<String>> {
        Ok(convert::subdivision(subdivision)?.problems())
    }

    /// II-D: what some rows of a map add to the faces; only the layout's rows are at hand.
    #[pyfunction]
    fn sum_faces<'py>(
        py: Python<'py>,
        layout: Layout<'py>,
        held: (usize, usize),
        rows: (usize, usize),
        directions: &Bound<'py, PyDict>,
        lines: &Bound<'py, PyDict>,
        threads: usize,
    ) -> PyResult<Bound<'py, PyArray2<i64>>> {
        let (directions, lines) = convert::lines_of(directions, lines)?;
        let made = layout.with_part(py, held, [rows, (0, 0)], 0, |grid, [rows, _]| {
            let arrangement = arrangement::arrange(&grid.frame, &directions.angles, &lines, threads);
            FaceSums::new(grid, &arrangement, rows, threads)
        })?;
        convert::from_sums(py, &made)
    }

    /// II-D: O(face), O(edge).
    #[pyfunction]
    fn find_occupancy<'py>(
        py: Python<'py>,
        layout: Layout<'py>,
        gradients: &Bound<'py, PyDict>,
        directions: &Bound<'py, PyDict>,
        lines: &Bound<'py, PyDict>,
        parameters: &Bound<'py, PyDict>,
        threads: usize,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (directions, lines) = convert::lines_of(directions, lines)?;
        let gradients = convert::gradients_on(gradients, &layout.frame())?;
        let parameters = parameters::read(parameters)?;
        let made = layout.with_grid(py, |grid| {
            let arrangement = arrangement::arrange(&grid.frame, &directions.angles, &lines, threads);
            let sums = FaceSums::new(grid, &arrangement, 0..grid.frame.height, threads);
            occupancy::find_occupancy(&grid.frame, &sums, &arrangement, &directions, &lines, &gradients, &parameters)
        })?;
        convert::from_occupancy(py, made)
    }

    /// II-D: C(edge) and the walls.
    #[pyfunction]
    fn find_walls<'py>(
        py: Python<'py>,
        subdivision: &Bound<'py, PyDict>,
        occupancy: &Bound<'py, PyDict>,
        parameters: &Bound<'py, PyDict>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (subdivision, occupancy) = (convert::subdivision(subdivision)?, convert::occupancy(occupancy)?);
        let states = occupancy.states.len().min(occupancy.faces.len());
        convert::demand_subdivision(&subdivision, states, occupancy.edges.len())?;
        convert::from_walls(py, walls::find_walls(&subdivision, &occupancy, &parameters::read(parameters)?, 1))
    }

    /// II-D, II-E: the dual.
    #[pyfunction]
    fn find_adjacency<'py>(
        py: Python<'py>,
        subdivision: &Bound<'py, PyDict>,
        walls: &Bound<'py, PyDict>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (edge_faces, cogent) = convert::edges(subdivision, walls)?;
        convert::from_adjacency(py, adjacency::find_adjacency(&edge_faces, &cogent))
    }

    /// II-E: what is what.
    #[pyfunction]
    #[expect(clippy::too_many_arguments, reason = "one for each stage that the labels are found from")]
    fn find_labels<'py>(
        py: Python<'py>,
        layout: Layout<'py>,
        gradients: &Bound<'py, PyDict>,
        directions: &Bound<'py, PyDict>,
        lines: &Bound<'py, PyDict>,
        occupancy: &Bound<'py, PyDict>,
        walls: &Bound<'py, PyDict>,
        parameters: &Bound<'py, PyDict>,
        threads: usize,
    ) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let (directions, lines) = convert::lines_of(directions, lines)?;
        let frame = layout.frame();
        let (gradients, parameters) = (convert::gradients_on(gradients, &frame)?, parameters::read(parameters)?);
        let arrangement = arrangement::arrange(&frame, &directions.angles, &lines, threads);
        let subdivision = Subdivision::new(&frame, arrangement, threads);
        let (occupancy, walls) = (convert::occupancy(occupancy)?, convert::walls(walls)?);
        let states = occupancy.states.len().min(occupancy.faces.len());
        convert::demand_subdivision(&subdivision, states, occupancy.edges.len().min(walls.cogent.len()))?;
        let adjacency = adjacency::find_adjacency(&subdivision.edge_faces, &walls.cogent);
        let (made, confidence) = layout.with_grid(py, |grid| {
            let evidence = labels::Evidence {
                grid,
                gradients: &gradients,
                directions: &directions,
                lines: &lines,
                parameters: &parameters,
                threads,
                recall: &groundplan::Recall::default(),
            };
            let division = labels::Division { subdivision: &subdivision, occupancy: &occupancy, adjacency: &adjacency };
            let made = labels::find_labels(&evidence, &division);
            let confidence = labels::find_confidence(&evidence, &made);
            (made, confidence)
        })?;
        Labels::new(made, confidence).all(py)
    }
}
