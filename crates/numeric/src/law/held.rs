//! The choices that a tail was computed with, to compute others with them: through an optimisation figures then are smooth in the
//! coefficients of the surface, because neither a contour nor a point changes from one to the next.

use std::sync::Arc;

use super::exact::is_poor;
use super::inversion::Line;
use super::sampled::Held;
use super::{Kind, LawFigure, LawTail, SurfaceLaw};

/// The contour, or the direction, points and proposal, of one tail.
///
/// Choose it again where an optimisation ends: it stays right for other coefficients, but not as accurate.
#[derive(Debug, Clone)]
pub struct HeldTail {
    tail: LawTail,
    kind: HeldKind,
}

#[derive(Debug, Clone)]
enum HeldKind {
    Line(Line),
    Points(Arc<Held>),
    /// Panels and lists need nothing.
    Nothing,
}

impl HeldTail {
    pub(super) fn of(law: &SurfaceLaw, y: f64, tail: LawTail) -> Self {
        let kind = match &law.kind {
            Kind::Exact(exact) if !exact.inversion.is_normal() => HeldKind::Line(exact.inversion.held(y, tail)),
            Kind::Sampled(sampled) => HeldKind::Points(Arc::new(sampled.held(y, tail, law.mean))),
            _ => HeldKind::Nothing,
        };
        Self { tail, kind }
    }

    /// The tail of a law beyond a limit, along this contour or at these points; the law's own where its structure is another
    /// one.
    pub fn tail(&self, law: &SurfaceLaw, y: f64) -> LawFigure {
        let [least, most] = law.range;
        let own = || law.tail(y, self.tail);
        if y.is_nan() || y <= least || y >= most {
            return own();
        }
        let y = law.beyond(y, self.tail);
        match (&self.kind, &law.kind) {
            (HeldKind::Line(line), Kind::Exact(exact)) => {
                exact.inversion.tail_along(y, line).filter(|figure| !is_poor(*figure)).unwrap_or_else(own)
            }
            (HeldKind::Points(held), Kind::Sampled(sampled)) => sampled.tail_held(y, held).unwrap_or_else(own),
            _ => own(),
        }
    }
}
