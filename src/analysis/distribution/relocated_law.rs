//! Distribution of a surface whose inputs have moved.

use crate::analysis::distribution::moment_basis::Surface;
use crate::analysis::distribution::surface_law::{law_over, with};
use crate::problem::Problem;
use sensitol_numeric::law::{LawError, SurfaceLaw};
use sensitol_numeric::surrogate::Relocation;

/// Distribution of a characteristic's surface if its inputs have moved and keep their shapes, including the unexplained variance.
/// Interactive report pages compute the same. Returns None if the moments follow from no surface.
pub fn law_at(
    problem: &Problem,
    surface: &Surface,
    characteristic: usize,
    moved: &[Relocation],
) -> Option<Result<SurfaceLaw, LawError>> {
    let fit = surface.characteristics[characteristic].as_ref().ok()?;
    let inputs = surface.varying.iter().map(|&d| problem.dimensions()[d].law().cloned()).collect::<Option<_>>()?;
    let (surrogate, inputs) =
        with(&fit.surrogate.relocated(moved), inputs, fit.unexplained_sigma.map(|sigma| sigma * sigma));
    Some(law_over(&surrogate, &inputs, None, problem.kept_limits(characteristic).rounding()))
}
