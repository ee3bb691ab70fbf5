//! Models that count, record or refuse their points.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

use sensitol::assembly::{AssemblyFunction, EvaluationError, Request, Responses, Run, Signature};
use sensitol::{Closure, Problem};
use sensitol_numeric::correlation::Pair;

/// Record of all points at which a function was evaluated.
#[derive(Clone, Default)]
pub struct Asked(Arc<Mutex<Vec<Vec<f64>>>>);

impl Asked {
    /// Points so far, in order of their coordinates.
    pub fn points(&self) -> Vec<Vec<f64>> {
        let mut points = self.0.lock().unwrap().clone();
        points.sort_by(|a, b| a.partial_cmp(b).unwrap());
        points
    }

    /// Number of points. Asserts that each was evaluated once only.
    #[track_caller]
    pub fn distinct(&self) -> usize {
        let points = self.points();
        let mut once = points.clone();
        once.dedup();
        assert_eq!(once.len(), points.len(), "a point was evaluated twice");
        points.len()
    }

    /// Function of a characteristic `y` that records its points.
    pub fn watching(&self, function: impl Fn(&[f64]) -> f64 + Send + Sync + 'static) -> Closure {
        let asked = self.clone();
        Closure::scalar("y", move |x| {
            asked.0.lock().unwrap().push(x.to_vec());
            function(x)
        })
    }
}

/// Function with one output that refuses some points.
pub fn refusing(
    function: impl Fn(&[f64]) -> f64 + Send + Sync + 'static,
    refuses: impl Fn(&[f64]) -> bool + Send + Sync + 'static,
) -> Closure {
    Closure::fallible(["y"], move |x| {
        if refuses(x) {
            return Err(EvaluationError::Refused { message: "does not assemble".into() });
        }
        Ok([function(x)])
    })
}

/// A formula that counts as costly. It counts its points and gives no information about its structure.
struct Costly {
    signature: Signature,
    inner: Problem,
    asked: Arc<AtomicUsize>,
}

impl AssemblyFunction for Costly {
    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn evaluate(&self, request: &Request<'_>, run: &Run<'_>, out: &mut Responses) {
        self.asked.fetch_add(request.points.rows(), Ordering::Relaxed);
        self.inner.function().evaluate(request, run, out);
    }
}

/// The problem as a costly external model, and the count of its points.
pub fn costly(problem: &Problem) -> (Problem, Arc<AtomicUsize>) {
    counted(problem, true)
}

/// The problem with a count of its points, as a costly or as a cheap model.
pub fn counted(problem: &Problem, costly: bool) -> (Problem, Arc<AtomicUsize>) {
    let asked = Arc::new(AtomicUsize::new(0));
    let signature = Signature { costly, cheap: !costly, ..problem.function().signature().clone() };
    let function = Costly { signature, inner: problem.clone(), asked: Arc::clone(&asked) };
    let mut again = Problem::new(problem.dimensions().to_vec(), function).unwrap();
    if let Some(correlation) = problem.correlation() {
        let dimensions = problem.dimensions();
        let all = (0..dimensions.len()).flat_map(|a| (0..a).map(move |b| (a, b)));
        let name = |d: usize| dimensions[d].name().to_owned();
        let pair = |(a, b)| Pair { between: [name(a), name(b)], value: correlation.of(a, b) };
        let pairs: Vec<Pair> = all.map(pair).filter(|pair| pair.value != 0.0).collect();
        again = again.correlated(&pairs).unwrap();
    }
    (again.asking(problem.characteristics().to_vec()).unwrap(), asked)
}
