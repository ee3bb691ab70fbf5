//! Coverage of the errors of quantiles, on functions that no constant is tuned with. The right values are order statistics of plain random
//! points: another sampler, without strata, surface or control variate.

use rayon::prelude::*;
use sensitol::analysis::{CharacteristicAnalysis, YieldSource};

use sensitol::simulation::{Sampler, SimulationOptions, simulate};
use sensitol::{Method, Options, analyze};
use sensitol_numeric::sampling::Estimate;

use super::trust::{Truth, truths};

/// Number of random points of a reference: 1400 lie beyond the quantile 0.00135.
const POINTS: u64 = 1 << 20;
/// Part of sigma that is felt at a quantile.
const FELT: f64 = 1e-3;
/// Part of sigma by which a quantile must not be wrong without an error that says so.
const WRONG: f64 = 0.1;

/// Quantiles of the reported probabilities by random points. None at one with too few points beyond it.
fn references(truth: &Truth) -> [Option<Estimate>; 7] {
    let first = truth.study.problem.characteristics()[0].clone();
    let problem = truth.study.problem.clone().asking([first]).unwrap();
    let options = SimulationOptions::default().with_samples(POINTS).with_sampler(Sampler::Random).with_seed(77);
    simulate(&problem, &options).unwrap().characteristics[0].quantiles
}

fn analysed(truth: &Truth, options: &Options) -> CharacteristicAnalysis {
    let first = truth.study.problem.characteristics()[0].clone();
    let problem = truth.study.problem.clone().asking([first]).unwrap();
    analyze(&problem, options).unwrap().characteristics.remove(0)
}

/// Three errors of every quantile of a verified formula reach the right value, and the errors are small enough to be useful. The allowed
/// distance includes three standard errors of the reference.
#[test]
fn quantiles_of_formulas_are_covered_by_their_errors() {
    let truths = truths();
    let judged: Vec<(String, f64, f64)> = (truths.par_iter())
        .flat_map_iter(|truth| {
            let right = references(truth);
            let methods = [Method::Auto, Method::Full, Method::SecondOrder];
            methods.into_iter().flat_map(move |method| {
                let found = analysed(truth, &method.into());
                let sigma = truth.figures[1].0;
                let quantiles = found.distribution.quantiles.unwrap_or_else(|| panic!("{}: no quantiles", truth.name));
                let each = quantiles.values.iter().zip(right).filter_map(move |((name, own), right)| {
                    let (own, right) = ((*own)?, right?);
                    let error = own.error.unwrap_or_else(|| panic!("{}: no error of {name}", truth.name));
                    let off = (own.value - right.value).abs();
                    let allowed = 3.0 * error + 3.0 * right.standard_error? + FELT * sigma;
                    let label = format!("{} {} {name}: {own:?} for {right:?}", truth.name, method.name());
                    assert!(off <= allowed.max(WRONG * sigma), "{label}");
                    Some((label, off / allowed, error / sigma))
                });
                each.collect::<Vec<_>>()
            })
        })
        .collect();
    let wrong: Vec<&(String, f64, f64)> = judged.iter().filter(|(_, excess, _)| *excess > 1.0).collect();
    // 65 functions, 3 methods, up to 7 quantiles.
    assert!(judged.len() > 1200, "{} quantiles", judged.len());
    assert!(wrong.len() * 100 <= judged.len(), "{} of {} not covered: {wrong:#?}", wrong.len(), judged.len());
    let mut errors: Vec<f64> = judged.iter().map(|(.., error)| *error).collect();
    errors.sort_by(f64::total_cmp);
    // Nine of ten errors are below a twentieth of sigma.
    assert!(errors[errors.len() * 9 / 10] < 0.05, "error {} sigma", errors[errors.len() * 9 / 10]);
}

/// A function with a kink far out: the surface knows nothing of it, so that quantiles come from points of the model as the yield does.
#[test]
fn quantiles_of_a_kink_come_from_points_of_the_model() {
    let kinks =
        truths().into_iter().filter(|truth| ["max-two", "step-half", "clip-two"].contains(&truth.name.as_str()));
    let mut seen = 0;
    for truth in kinks {
        let found = analysed(&truth, &Method::SecondOrder.into());
        if found.distribution.yield_source == Some(YieldSource::Samples) {
            assert_eq!(found.distribution.quantiles.unwrap().source, YieldSource::Samples, "{}", truth.name);
            seen += 1;
        }
    }
    assert!(seen > 0, "no function with a kink");
}
