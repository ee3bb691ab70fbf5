//! Built-in models of published cases, against derivatives in 60-digit arithmetic and independent samples.

use serde_json::Value;

use sensitol::assembly::{AssemblyFunction, EvaluationError, Points, Request, Responses, Run};
use sensitol::simulation::{SimulationOptions, simulate};
use sensitol::{Dimension, Method, Options, Problem, analyze};
use sensitol_models::{self, Model};
use sensitol_testing::{data, relative};

fn model(name: &str) -> &'static Model {
    name.parse().unwrap()
}

fn nominal(model: &Model) -> Vec<f64> {
    model.inputs.iter().map(|input| input.nominal).collect()
}

fn output(model: &Model, name: &str) -> usize {
    model.outputs.iter().position(|output| output.name == name).unwrap_or_else(|| panic!("no output {name}"))
}

fn values(model: &'static Model, outputs: &[usize], rows: &[Vec<f64>]) -> Responses {
    let mut out = Responses::open(rows.len(), outputs.len());
    let points = Points::from_rows(rows);
    model.function().evaluate(&Request::values(&points, outputs), &Run::to_the_end(), &mut out);
    out
}

fn value(model: &'static Model, name: &str, point: &[f64]) -> f64 {
    let out = values(model, &[output(model, name)], &[point.to_vec()]);
    out.value(0, 0).unwrap_or_else(|| panic!("{name}: {:?}", out.error(0, 0)))
}

/// A case of the data: the model at the case's nominal values, with its tolerances.
struct Case {
    model: &'static Model,
    inputs: Vec<(usize, f64)>,
    nominal: Vec<f64>,
    truth: Value,
}

impl Case {
    fn of(name: &str, truth: Value) -> Self {
        let model = model(name);
        let mut at = nominal(model);
        let input = |entry: &Value| {
            let name = entry["name"].as_str().unwrap();
            let place = model.inputs.iter().position(|input| input.name == name).unwrap();
            assert_eq!(entry["unit"].as_str().unwrap(), model.inputs[place].unit, "{name}");
            (place, entry["nominal"].as_f64().unwrap(), entry["tolerance"].as_f64().unwrap() / 3.0)
        };
        let inputs: Vec<_> = truth["inputs"].as_array().unwrap().iter().map(input).collect();
        inputs.iter().for_each(|&(place, value, _)| at[place] = value);
        for input in ["mc_F", "mc_T"] {
            if let Some(metres) = truth["settings"][input].as_f64() {
                at[model.inputs.iter().position(|one| one.name == input).unwrap()] = 1e3 * metres;
            }
        }
        Self { model, inputs: inputs.iter().map(|&(place, _, sigma)| (place, sigma)).collect(), nominal: at, truth }
    }

    fn rods() -> [Self; 2] {
        let all = data("connecting-rod.json");
        ["r41", "paper_r82"].map(|variant| Self::of("connecting-rod", all[variant].clone()))
    }

    fn flywheel() -> Self {
        Self::of("dual-mass-flywheel", data("dual-mass-flywheel.json"))
    }

    /// Characteristics that the model has. It lacks only the lobes of the rod's T_opt.
    fn outputs(&self) -> Vec<(&String, &Value)> {
        let all = self.truth["kcs"].as_object().unwrap();
        let known = |name: &str| self.model.outputs.iter().any(|output| output.name == name);
        let (has, lacks): (Vec<_>, Vec<_>) = all.iter().partition(|(name, _)| known(name));
        assert!(lacks.iter().all(|(name, _)| name.starts_with("T_opt_lobe")), "{lacks:?}");
        has
    }

    fn problem(&self, names: &[&str]) -> Problem {
        let dimension = |(place, input): (usize, &sensitol_models::ModelInput)| {
            let sigma = self.inputs.iter().find(|(at, _)| *at == place).map_or(0.0, |(_, sigma)| *sigma);
            Dimension::normal(input.name, self.nominal[place], 3.0 * sigma).unwrap()
        };
        let dimensions = self.model.inputs.iter().enumerate().map(dimension);
        Problem::new(dimensions, self.model.function()).unwrap().only(names).unwrap()
    }
}

fn number(value: &Value, key: &str) -> f64 {
    value[key].as_f64().unwrap_or_else(|| panic!("{key}"))
}

#[test]
fn nominal_values_are_those_of_sixty_digits() {
    for case in Case::rods().into_iter().chain([Case::flywheel()]) {
        for (name, kc) in case.outputs() {
            relative(value(case.model, name, &case.nominal), number(kc, "nominal"), 1e-9);
        }
    }
    let rod = &Case::rods()[0];
    relative(value(rod.model, "theta_F_comp", &rod.nominal), 18.990673566903546, 1e-8);
    relative(value(rod.model, "theta_H_req", &rod.nominal), 19.06421106831657, 1e-8);
    let wheel = Case::flywheel();
    let rounded = |name: &str| (100.0 * value(wheel.model, name, &wheel.nominal)).round() / 100.0;
    assert_eq!((rounded("n_crit_DMF"), rounded("n_crit_SMF"), rounded("n_cross").round()), (614.81, 2124.10, 837.0));
}

/// Five-point differences at 0.05 sigma have an error of the fifth derivative times 2e-7 sigma^4, and a rounding error of 1e-10 of sigma. A
/// slope that adds less than 1e-4 to the characteristic's sigma may be wrong by that part of it.
#[test]
fn gradients_are_those_of_sixty_digits() {
    for case in Case::rods().into_iter().chain([Case::flywheel()]) {
        for (name, kc) in case.outputs() {
            let sigma_y = number(&kc["second_order"], "sigma");
            let expected = kc["gradient"].as_array().unwrap();
            for (&(place, sigma), expected) in case.inputs.iter().zip(expected) {
                let expected = expected.as_f64().unwrap();
                let at = |u: f64| {
                    let mut point = case.nominal.clone();
                    point[place] += u * sigma;
                    point
                };
                let h = 0.05;
                let out = values(case.model, &[output(case.model, name)], &[at(-2.0 * h), at(-h), at(h), at(2.0 * h)]);
                let y = |row: usize| out.value(row, 0).unwrap();
                let slope = (y(0) - 8.0 * y(1) + 8.0 * y(2) - y(3)) / (12.0 * h * sigma);
                let error = (slope - expected).abs() * sigma;
                let allowed = 1e-6 * (expected.abs() * sigma).max(1e-4 * sigma_y);
                assert!(error <= allowed, "{name} by {}: {slope} {expected}", case.model.inputs[place].name);
            }
        }
    }
}

/// Second order with true derivatives: `full` with steps of 0.05 sigma. Its error is 4e-4 of the third derivative by sigma^2 in slopes, and
/// 2e-4 of the fourth in curvatures. For the most curved outputs, A_peak_DMF and T_opt_tied, it is 1e-5.
#[test]
fn second_order_moments_are_those_listed() {
    for case in Case::rods().into_iter().chain([Case::flywheel()]) {
        let names: Vec<&str> = case.outputs().iter().map(|(name, _)| name.as_str()).collect();
        let problem = case.problem(&names);
        let analysis = analyze(&problem, &Options::from(Method::Full).with_step(0.05)).unwrap();
        for found in &analysis.characteristics {
            let (name, moments) = (found.characteristic.name(), found.moments.unwrap());
            let expected = &case.truth["kcs"][name]["second_order"];
            let sigma = number(expected, "sigma");
            assert!((moments.mean() - number(expected, "mean")).abs() < 2e-6 * sigma, "{name} mean {}", moments.mean());
            relative(moments.sigma(), sigma, 3e-5);
            let skewness = (moments.skewness().unwrap() - number(expected, "skewness")).abs();
            let kurtosis = (moments.kurtosis().unwrap() - 3.0 - number(expected, "excess_kurtosis")).abs();
            assert!(skewness < 1e-5 && kurtosis < 2e-5, "{name}: {skewness} {kurtosis}");
        }
    }
}

/// Both results are sampled, so the tolerance is four standard errors of both together: 4 million independent points, 40 000 of the engine.
#[test]
fn samples_agree_with_other_peoples() {
    for case in Case::rods().into_iter().chain([Case::flywheel()]) {
        let mut names: Vec<&str> = case.outputs().iter().map(|(name, _)| name.as_str()).collect();
        names.extend(case.model.outputs.iter().map(|output| output.name).filter(|name| *name == "Fn_opt"));
        let options = SimulationOptions::default().with_samples(40_000).with_seed(7);
        let simulation = simulate(&case.problem(&names), &options).unwrap();
        for found in &simulation.characteristics {
            let name = found.characteristic.name();
            let theirs = &case.truth["monte_carlo"][name];
            assert_eq!(found.failed, 0, "{name}");
            for (what, ours, shift) in [
                ("mean", found.mean, 0.0),
                ("sigma", found.sigma, 0.0),
                ("skewness", found.skewness, 0.0),
                ("excess_kurtosis", found.kurtosis, 3.0),
            ] {
                let ours = ours.unwrap();
                let error = ours.standard_error.unwrap().hypot(number(theirs, &format!("{what}_se")));
                let off = (ours.value - shift - number(theirs, what)).abs();
                assert!(off < 4.0 * error, "{name} {what}: {off:e} is {} standard errors", off / error);
            }
        }
    }
}

/// `Fn_opt` is the larger of two lobes. With five points along a line derivative methods warn of the kink, and `auto` samples the model
/// instead.
#[test]
fn the_kink_is_seen_and_sampled_around() {
    let rod = &Case::rods()[0];
    let problem = rod.problem(&["Fn_opt"]);
    let theirs = &rod.truth["monte_carlo"]["Fn_opt"];
    // Verification is off, since it would sample a built-in model.
    let alone = |method: Method| sensitol::Options::from(method).with_verify(0);
    let warned = |method: Method| {
        let analysis = analyze(&problem, &alone(method)).unwrap();
        let codes: Vec<&str> = analysis.warnings.iter().map(|warning| warning.code()).collect();
        assert!(codes.contains(&"kink"), "{method:?} {codes:?}");
        analysis
    };
    let off = |analysis: &sensitol::Analysis| {
        let moments = analysis.characteristics[0].moments.unwrap();
        let sigma = number(theirs, "sigma");
        [(moments.mean() - number(theirs, "mean")) / sigma, moments.sigma() / sigma - 1.0]
    };
    // Three points along a line do not show a kink. The wrong figures prove that the warning is needed.
    let blind = off(&analyze(&problem, &alone(Method::SecondOrder)).unwrap());
    assert!(blind.iter().any(|off| off.abs() > 0.1), "{blind:?}");
    warned(Method::SixN);
    let auto = warned(Method::Auto);
    let sampled = auto.characteristics[0].evidence.model_sampled.as_ref().expect("auto sampled the model");
    assert!(sampled.samples >= 1000, "{sampled:?}");
    // The tolerance of `auto` is one percent of sigma. The reference's own error is a tenth of that.
    let [mean, sigma] = off(&auto);
    assert!(mean.abs() < 0.03 && sigma.abs() < 0.03, "{mean} {sigma}");
}

/// Maxima over the crank angle: second differences at 0.01 sigma equal those at sigma, except for the fourth derivative. An influence of
/// the search grid or of its last step would show here a thousandfold.
#[test]
fn maxima_over_the_angle_are_smooth() {
    for case in Case::rods().into_iter().chain([Case::flywheel()]) {
        let names = ["F_comp_3000", "T_peak_3000", "Fn_rod_3000", "T_rod_3000", "H_req_3000", "n_zz", "Fn_opt_lobeA"];
        let names = names.into_iter().chain(["Fn_opt_lobeB", "T_opt_tied", "dW2_1000_multi", "A_peak_DMF"]);
        for name in names.filter(|name| case.model.outputs.iter().any(|output| output.name == *name)) {
            let column = output(case.model, name);
            let sigma_y = number(&case.truth["kcs"][name]["second_order"], "sigma");
            for &(place, sigma) in
                case.inputs.iter().filter(|(place, _)| case.model.outputs[column].depends_on.contains(place))
            {
                let second = |h: f64| {
                    let at = |u: f64| {
                        let mut point = case.nominal.clone();
                        point[place] += u * sigma;
                        point
                    };
                    let out = values(case.model, &[column], &[at(-h), at(0.0), at(h)]);
                    let y = |row: usize| out.value(row, 0).unwrap();
                    let realised = at(h)[place] - at(-h)[place];
                    // Values near y: rounding by 4 units in the last place of each is divided by h^2.
                    let rounding = 16.0 * f64::EPSILON * y(1).abs() / (h * h);
                    ((y(2) - 2.0 * y(1) + y(0)) / (realised / sigma / 2.0).powi(2), rounding)
                };
                let ((small, rounding), (large, _)) = (second(0.01), second(1.0));
                let off = (small - large).abs();
                // Fourth derivatives by sigma^4/12 are below 1e-3 of the characteristic's sigma here.
                assert!(
                    off < 2e-3 * sigma_y + rounding,
                    "{name} by {}: {small:e} {large:e}",
                    case.model.inputs[place].name
                );
            }
        }
    }
}

/// No lobe replaces another: along 64 diagonals of the box, to six sigma on either side, the angle of the maximum moves without a jump.
#[test]
fn lobes_are_not_switched() {
    for case in Case::rods() {
        for name in ["theta_F_comp", "theta_H_req"] {
            let column = output(case.model, name);
            for direction in 0..64u64 {
                // Signs are the bits of a multiple of an odd number, so that every direction has its own corner.
                let signs = direction.wrapping_mul(0x9e37_79b9_7f4a_7c15);
                let at = |u: f64| {
                    let mut point = case.nominal.clone();
                    for (bit, &(place, sigma)) in case.inputs.iter().enumerate() {
                        point[place] += if signs >> bit & 1 == 1 { u * sigma } else { -u * sigma };
                    }
                    point
                };
                let rows: Vec<Vec<f64>> = (0..=48).map(|step| at(0.25 * f64::from(step) - 6.0)).collect();
                let out = values(case.model, &[column], &rows);
                let angles: Vec<f64> = (0..rows.len()).map(|row| out.value(row, 0).unwrap()).collect();
                // Another lobe is at least 20 degrees away. A quarter of sigma moves the ignition by a sixth of a degree.
                assert!(angles.windows(2).all(|pair| (pair[1] - pair[0]).abs() < 1.0), "{name} {angles:?}");
            }
        }
    }
}

/// Independent formulas: the four cylinders of the paper one by one, and an engine whose forces cancel.
#[test]
fn inline_engines_of_any_layout() {
    let (general, four) = (model("inline-engine-balance"), model("engine-balance"));
    let (at, of_four) = (nominal(general), nominal(four));
    relative(value(general, "F", &at), value(four, "F", &of_four), 1e-13);
    relative(value(general, "M", &at), value(four, "M", &of_four), 1e-13);
    let set = |at: &mut Vec<f64>, name: &str, to: f64| {
        at[general.inputs.iter().position(|input| input.name == name).unwrap()] = to;
    };
    // Six in line, 1-5-3-6-2-4: cranks 0, 120, 240, 240, 120, 0 degrees; free forces and moments vanish in both orders.
    let mut six = at.clone();
    set(&mut six, "n", 6.0);
    for (cylinder, degrees) in [0.0, 120.0, 240.0, 240.0, 120.0, 0.0f64].into_iter().enumerate() {
        set(&mut six, &format!("phi{}", cylinder + 1), degrees.to_radians());
    }
    for t in [0.0, 0.3, 2.0] {
        set(&mut six, "t", t);
        for name in ["F1", "F2", "M1", "M2"] {
            // The single forces are 1e4 N.
            assert!(value(general, name, &six).abs() < 1e-9, "{name}");
        }
    }
    // Three in line at 120 degrees: no free force, a first-order moment of sqrt(3) m r w^2 a in its worst position.
    let mut three = at.clone();
    set(&mut three, "n", 3.0);
    for (cylinder, degrees) in [0.0, 120.0, 240.0f64].into_iter().enumerate() {
        set(&mut three, &format!("phi{}", cylinder + 1), degrees.to_radians());
    }
    let worst = (0..3600).map(|step| {
        let mut at = three.clone();
        set(&mut at, "t", f64::from(step) * std::f64::consts::PI / 1800.0);
        value(general, "M1", &at).abs()
    });
    let (mr, r, omega) = (0.427 + 0.597 * 0.0372 / (0.0372 + 0.0973), 0.0425, 628.3185f64);
    // A tenth of a degree off the worst position changes the moment by 1e-6.
    relative(worst.fold(0.0, f64::max), 3f64.sqrt() * mr * r * omega * omega * 0.05, 2e-6);
    for n in [0.0, 2.5, 13.0, f64::NAN] {
        let mut at = at.clone();
        set(&mut at, "n", n);
        let out = values(general, &[0], &[at]);
        assert!(matches!(out.error(0, 0), Some(EvaluationError::Refused { .. })), "{n}");
    }
}

/// Published figures of twelve parts: 0.8411, root of the sum of squares 0.09047, worst case 0.229.
#[test]
fn compression_clearance() {
    let model = model("compression-clearance");
    let tolerances = [0.05, 0.0105, 0.05, 0.04, 0.0035, 0.003, 0.0075, 0.02, 0.0195, 0.0095, 0.03, 0.011];
    let dimensions = model.inputs.iter().zip(tolerances);
    let dimensions = dimensions.map(|(input, t)| Dimension::normal(input.name, input.nominal, t).unwrap());
    let analysis = analyze(&Problem::new(dimensions, model.function()).unwrap(), &Method::Rss.into()).unwrap();
    let found = &analysis.characteristics[0];
    assert!((found.nominal.unwrap() - 0.8411).abs() < 1e-12);
    // To the published digits.
    assert!((found.linear.rss.unwrap() - 0.09047).abs() < 5e-6);
    let [low, high] = found.range.worst_case.unwrap();
    assert!((0.5 * (high - low) - 0.229).abs() < 1e-12 && (0.5 * (high + low) - 0.8411).abs() < 1e-12);
    // The published sigma, and 3 sigma.
    assert!((found.moments.unwrap().sigma() - 0.0301).abs() < 1e-4);
    assert!((3.0 * found.moments.unwrap().sigma() - 0.0905).abs() < 5e-5);
}

/// Figures of the design: nominal values, and samples of 4 million points.
#[test]
fn quick_return() {
    let model = model("quick-return");
    let at = nominal(model);
    // The formulas by angles, as they are published, agree to rounding.
    let [r, d, e, q, c, height, s] = at[..] else { panic!("seven inputs") };
    let (delta, gamma) = (e.atan2(d), ((r + 0.5 * s) / d.hypot(e)).asin());
    let ram = |b: f64| q * b.sin() + (c * c - (height - q * b.cos()).powi(2)).sqrt();
    relative(value(model, "stroke", &at), ram(delta + gamma) - ram(delta - gamma), 1e-13);
    let pi = std::f64::consts::PI;
    relative(value(model, "ratio", &at), (pi + 2.0 * gamma) / (pi - 2.0 * gamma), 1e-13);
    assert!((value(model, "stroke", &at) - 175.43082).abs() < 5e-6);
    assert!((value(model, "ratio", &at) - 1.719703).abs() < 5e-7);
    let tolerances = [0.2, 0.2, 0.1, 0.3, 0.2, 0.2, 0.02];
    let dimensions = model.inputs.iter().zip(tolerances);
    let dimensions = dimensions.map(|(input, t)| Dimension::normal(input.name, input.nominal, t).unwrap());
    let analysis = analyze(&Problem::new(dimensions, model.function()).unwrap(), &Method::Full.into()).unwrap();
    // Standard errors of 4e6 points: 5e-4 of sigma in the mean, 4e-4 of sigma, 1.2e-3 and 2.4e-3. The tolerance is four of each.
    for (found, expected) in analysis
        .characteristics
        .iter()
        .zip([[175.4309, 0.23581, 0.0016, 3.0047], [1.719704, 0.0013204, 0.0057, 3.0051]])
    {
        let (moments, [mean, sigma, skewness, kurtosis]) = (found.moments.unwrap(), expected);
        assert!((moments.mean() - mean).abs() < 2e-3 * sigma);
        relative(moments.sigma(), sigma, 1.6e-3);
        assert!((moments.skewness().unwrap() - skewness).abs() < 5e-3);
        assert!((moments.kurtosis().unwrap() - kurtosis).abs() < 1e-2);
    }
    // A crank longer than the distance of its centre has no swing.
    let mut long = at;
    long[0] = 150.0;
    let out = values(model, &[0, 1], &[long]);
    assert!((0..2).all(|output| matches!(out.error(0, output), Some(EvaluationError::NotFinite { .. }))));
}

type Matrix = [[f64; 4]; 4];

fn times(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..4).map(|k| a[i][k] * b[k][j]).sum()))
}

fn shift(by: [f64; 3]) -> Matrix {
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            if i == j {
                1.0
            } else if j == 3 && i < 3 {
                by[i]
            } else {
                0.0
            }
        })
    })
}

/// Rotation about a unit axis by the quaternion of half the angle.
fn turn(axis: [f64; 3], degrees: f64) -> Matrix {
    let half = 0.5 * degrees.to_radians();
    let w = half.cos();
    let [x, y, z] = axis.map(|part| part * half.sin());
    [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y), 0.0],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x), 0.0],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y), 0.0],
        [0.0, 0.0, 0.0, 1.0],
    ]
}

/// The chain of rigid bodies by homogeneous matrices, with rotations by quaternions: agrees to 1e-12 of its 300 mm.
#[test]
fn spot_weld_is_a_chain_of_rigid_bodies() {
    let model = model("spot-weld");
    assert!(model.inputs.len() >= 20);
    let tip = |x: &[f64], sign: f64| {
        let [px, py, pz, tilt, yaw, close, rear, bend, skew, front, tip] = x[..] else { panic!("eleven inputs") };
        let (ax, ay, az) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
        let chain = [
            shift([px, py, pz]),
            turn(az, yaw),
            turn(ax, tilt),
            turn(ay, close),
            shift([rear, 0.0, 0.0]),
            turn(az, skew),
            turn(ay, bend),
            shift([front, 0.0, -sign * tip]),
        ];
        let all = chain.iter().skip(1).fold(chain[0], |all, next| times(&all, next));
        [all[0][3], all[1][3], all[2][3]]
    };
    let at = nominal(model);
    let nominal = values(model, &[0, 1, 2], std::slice::from_ref(&at));
    for (output, expected) in [10.0, 0.0, 0.0].into_iter().enumerate() {
        assert!((nominal.value(0, output).unwrap() - expected).abs() < 1e-12);
    }
    // Far from nominal, so that no term hides: every input is off by up to a tenth of an arm, or 20 degrees.
    let rows: Vec<Vec<f64>> = (1..=300u32)
        .map(|row| {
            let off = |place: usize| 20.0 * (f64::from(row) * (1.0 + 0.37 * place as f64)).sin();
            at.iter().enumerate().map(|(place, x)| x + off(place)).collect()
        })
        .collect();
    let out = values(model, &[0, 1, 2], &rows);
    for (index, row) in rows.iter().enumerate() {
        let (upper, lower) = (tip(&row[..11], 1.0), tip(&row[11..], -1.0));
        for (output, axis) in [2, 0, 1].into_iter().enumerate() {
            let expected = upper[axis] - lower[axis];
            let found = out.value(index, output).unwrap();
            assert!((found - expected).abs() < 1e-12 * 300.0, "{found} {expected}");
        }
    }
}

/// An output depends on exactly the declared inputs. Its value does not depend on the other requested outputs.
#[test]
fn outputs_depend_on_what_they_say() {
    for model in sensitol_models::ALL {
        let at = nominal(model);
        let all: Vec<usize> = (0..model.outputs.len()).collect();
        // Slightly off the nominal, since zero angles hide a dependence.
        let base: Vec<f64> = at.iter().map(|x| if x.fract() == 0.0 && *x == 4.0 { *x } else { x + 1e-3 }).collect();
        let row = |place: usize| {
            let mut point = base.clone();
            point[place] += if model.inputs[place].name == "n" && model.name.starts_with("inline") {
                -1.0
            } else {
                1e-3 * point[place].abs().max(0.1)
            };
            point
        };
        let rows: Vec<Vec<f64>> = [base.clone()].into_iter().chain((0..at.len()).map(row)).collect();
        let out = values(model, &all, &rows);
        for (column, output) in model.outputs.iter().enumerate() {
            let value = |row: usize| {
                out.value(row, column).unwrap_or_else(|| panic!("{} {:?}", output.name, out.error(row, column)))
            };
            let alone = values(model, &[column], &rows);
            for place in 0..at.len() {
                let moves = value(place + 1) != value(0);
                let says = output.depends_on.contains(&place);
                // Missing cylinders, and the crank angle of a balanced order, have no effect.
                assert!(says || !moves, "{}: {} moves with {}", model.name, output.name, model.inputs[place].name);
                let rod = model.name == "connecting-rod" || model.name == "spot-weld" || model.name == "quick-return";
                assert!(
                    moves || !says || !rod,
                    "{}: {} stays with {}",
                    model.name,
                    output.name,
                    model.inputs[place].name
                );
                assert_eq!(alone.value(place + 1, 0), out.value(place + 1, column), "{} alone", output.name);
            }
        }
    }
}

/// The value at a point has the same bits for any blocks, lanes and neighbours.
#[test]
fn a_value_belongs_to_its_point_alone() {
    for model in sensitol_models::ALL {
        let all: Vec<usize> = (0..model.outputs.len()).collect();
        let at = nominal(model);
        let row = |row: usize| -> Vec<f64> {
            let off = |place: usize| 1e-3 * ((row * (place + 3)) as f64).sin();
            at.iter().enumerate().map(|(place, x)| if *x == 4.0 { *x } else { x + off(place) }).collect()
        };
        let rows: Vec<Vec<f64>> = (0..1500).map(row).collect();
        let many = values(model, &all, &rows);
        for index in [0, 1, 127, 128, 300, 1023, 1024, 1499] {
            let one = values(model, &all, std::slice::from_ref(&rows[index]));
            for output in 0..all.len() {
                assert_eq!(one.value(0, output), many.value(index, output), "{} {index} {output}", model.name);
            }
        }
    }
}
