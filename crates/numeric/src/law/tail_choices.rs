//! Choices that a tail was computed with, reused so that tails vary smoothly in an optimisation. Figures are smooth in the coefficients of
//! the surface because neither the contour nor the points change from one computation to the next.

use std::sync::Arc;

use crate::law::inversion::tail_inversion::Line;
use crate::law::inverted_law::is_poor;
use crate::law::sampled_law::Held;
use crate::law::{Kind, LawFigure, LawTail, SurfaceLaw};

/// Contour, or direction, points and proposal, of one tail.
///
/// Choose it again at the end of an optimisation: with other coefficients it stays right but becomes less accurate.
#[derive(Debug, Clone)]
pub struct TailChoices {
    tail: LawTail,
    kind: TailChoiceKind,
}

#[derive(Debug, Clone)]
enum TailChoiceKind {
    Line(Line),
    Points(Arc<Held>),
    /// Panels and lists take no choices.
    Nothing,
}

impl TailChoices {
    pub(super) fn of(law: &SurfaceLaw, y: f64, tail: LawTail) -> Self {
        let kind = match &law.kind {
            Kind::Exact(exact) if !exact.inversion.is_normal() => TailChoiceKind::Line(exact.inversion.held(y, tail)),
            Kind::Sampled(sampled) => TailChoiceKind::Points(Arc::new(sampled.held(y, tail, law.mean))),
            _ => TailChoiceKind::Nothing,
        };
        Self { tail, kind }
    }

    /// Tail of another law beyond a limit, along this contour or at these points. Falls back to [`SurfaceLaw::tail`] if the structure of
    /// that law differs.
    pub fn tail(&self, law: &SurfaceLaw, y: f64) -> LawFigure {
        let [least, most] = law.range;
        let own = || law.tail(y, self.tail);
        if y.is_nan() || y <= least || y >= most {
            return own();
        }
        let y = law.beyond(y, self.tail);
        match (&self.kind, &law.kind) {
            (TailChoiceKind::Line(line), Kind::Exact(exact)) => {
                exact.inversion.tail_along(y, line).filter(|figure| !is_poor(*figure)).unwrap_or_else(own)
            }
            (TailChoiceKind::Points(held), Kind::Sampled(sampled)) => sampled.tail_held(y, held).unwrap_or_else(own),
            _ => own(),
        }
    }
}
