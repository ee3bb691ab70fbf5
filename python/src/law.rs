//! Distribution of a dimension or of a fit: density, probabilities and quantiles of whole arrays.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use sensitol::Dimension;
use sensitol::distribution::Probability;
use sensitol::pearson::Pearson;

enum Of {
    Dimension(Box<Dimension>),
    Fit(Box<Pearson>),
}

/// Distribution of a value.
#[pyclass(frozen, module = "sensitol._core")]
pub(crate) struct Law(Of);

impl Law {
    /// Returns the distribution of a dimension, or None if it does not vary.
    pub(crate) fn of(dimension: &Dimension) -> Option<Self> {
        dimension.distribution().map(|_| Self(Of::Dimension(Box::new(dimension.clone()))))
    }
}

/// Returns a function of a fitted distribution by its name.
fn fitted(what: &str) -> Option<fn(&Pearson, f64) -> f64> {
    Some(match what {
        "pdf" => Pearson::pdf,
        "cdf" => Pearson::cdf,
        "sf" => Pearson::sf,
        "ppf" => Pearson::quantile,
        "isf" => Pearson::upper_quantile,
        _ => return None,
    })
}

/// Returns a function of a dimension's distribution by its name.
fn known(what: &str) -> Option<fn(&dyn Probability, f64) -> f64> {
    Some(match what {
        "pdf" => |law, x| law.density(x).unwrap_or(f64::NAN),
        "cdf" => |law, x| law.cdf(x),
        "sf" => |law, x| law.sf(x),
        "ppf" => |law, p| law.quantile(p),
        "isf" => |law, p| law.upper_quantile(p),
        _ => return None,
    })
}

#[pymethods]
impl Law {
    /// Distribution of the Pearson system with these moments.
    #[staticmethod]
    fn pearson(mean: f64, sigma: f64, skewness: f64, kurtosis: f64) -> PyResult<Self> {
        let law = Pearson::new(mean, sigma, skewness, kurtosis);
        law.map(|law| Self(Of::Fit(Box::new(law)))).map_err(|error| PyValueError::new_err(error.to_string()))
    }

    /// Values of `pdf`, `cdf`, `sf`, `ppf` or `isf` at the numbers in `at`. Arguments and results are doubles of eight bytes each.
    fn values<'py>(&self, py: Python<'py>, what: &str, at: &[u8]) -> PyResult<Bound<'py, PyBytes>> {
        let unknown = || PyValueError::new_err(format!("a law has no function `{what}`"));
        let numbers = at.chunks_exact(8).map(|bytes| f64::from_ne_bytes(bytes.try_into().unwrap_or_default()));
        let found: Vec<u8> = match &self.0 {
            Of::Fit(law) => {
                let function = fitted(what).ok_or_else(unknown)?;
                py.detach(|| numbers.flat_map(|x| function(law, x).to_ne_bytes()).collect())
            }
            Of::Dimension(dimension) => {
                let name = dimension.name();
                let law = dimension.distribution().and_then(|distribution| distribution.probability());
                let law = law.ok_or_else(|| PyValueError::new_err(format!("only moments of `{name}` are known")))?;
                if what == "pdf" && law.density(dimension.mean()).is_none() {
                    let message = format!("`{name}` has values with probabilities of their own, and no density");
                    return Err(PyValueError::new_err(message));
                }
                let function = known(what).ok_or_else(unknown)?;
                py.detach(|| numbers.flat_map(|x| function(law, x).to_ne_bytes()).collect())
            }
        };
        Ok(PyBytes::new(py, &found))
    }
}
