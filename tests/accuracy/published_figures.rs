//! Figures that the papers draw without printing numbers, against independent computations: `tests/data/*.info.json` names their authors.

use serde_json::Value;

use sensitol::assembly::{AssemblyFunction, Points, Request, Responses, Run};
use sensitol::{Method, Options, analyze};
use sensitol_models::Model;
use sensitol_study::Study;
use sensitol_testing::{data, repository};

/// Built-in model with some of its inputs set.
struct At {
    model: &'static Model,
    point: Vec<f64>,
}

impl At {
    fn of(name: &str, set: &[(&str, f64)]) -> Self {
        let model: &'static Model = name.parse().unwrap();
        let at = Self { model, point: model.inputs.iter().map(|input| input.nominal).collect() };
        at.with(set)
    }

    fn with(&self, set: &[(&str, f64)]) -> Self {
        let mut point = self.point.clone();
        for (name, value) in set {
            point[self.model.inputs.iter().position(|input| input.name == *name).unwrap()] = *value;
        }
        Self { model: self.model, point }
    }

    fn value(&self, output: &str) -> f64 {
        let output = self.model.outputs.iter().position(|one| one.name == output).unwrap();
        let (points, mut out) = (Points::from_rows(std::slice::from_ref(&self.point)), Responses::open(1, 1));
        self.model.function().evaluate(&Request::values(&points, &[output]), &Run::to_the_end(), &mut out);
        out.value(0, 0).unwrap_or_else(|| panic!("{:?}", out.error(0, 0)))
    }

    /// Checks an output to ten digits. Both sides have these digits relative to `scale`, which includes terms that cancel.
    #[track_caller]
    fn is(&self, output: &str, expected: f64, scale: f64) {
        let found = self.value(output);
        assert!((found - expected).abs() <= 1e-9 * expected.abs().max(scale), "{output}: {found} {expected}");
    }
}

fn numbers(value: &Value) -> Vec<Option<f64>> {
    value.as_array().unwrap().iter().map(Value::as_f64).collect()
}

/// Returns every variant of the rod at every speed.
fn rods() -> Vec<(At, Value)> {
    let all = data("rod-figures.json");
    let mut rods = Vec::new();
    for variant in ["r41", "r82"] {
        let radius = all["variants"][variant]["r_mm"].as_f64().unwrap();
        let pressure = all["variants"][variant]["p3_bar"].as_f64().unwrap();
        for speed in ["3000", "6000"] {
            let at = At::of("connecting-rod", &[("r", radius), ("p3", pressure), ("speed", speed.parse().unwrap())]);
            rods.push((at, all["computed"][variant][speed].clone()));
        }
    }
    rods
}

/// Figures 12 to 20: forces at both ends, and the height that the cycle requires in five sections.
#[test]
fn rod_over_the_crank_angle() {
    for (rod, figures) in rods() {
        let angles: Vec<f64> = numbers(&figures["angles_deg"]).into_iter().flatten().collect();
        for (output, key) in [("F_axial", "F_axial_small_end_N"), ("F_axial_big", "F_axial_big_end_N")] {
            for (&angle, expected) in angles.iter().zip(numbers(&figures[key])) {
                // Forces are differences of forces of 1e4 N.
                rod.with(&[("theta", angle)]).is(output, expected.unwrap(), 1e4);
            }
        }
        for (cut, heights) in figures["H_mm_by_cut"].as_object().unwrap() {
            for (&angle, expected) in angles.iter().zip(numbers(heights)) {
                // If the stress hardly depends on the height, the height has one or two digits less than the stress.
                rod.with(&[("theta", angle), ("cut", cut.parse().unwrap())]).is("H_theta", expected.unwrap(), 100.0);
            }
        }
        let peak = |key: &str| numbers(&figures[key]).into_iter().flatten().collect::<Vec<_>>();
        for (key, value, angle) in
            [("compression_small_end", "F_comp", Some("theta_F")), ("compression_big_end", "F_comp_big", None)]
        {
            let [expected, at] = peak(key)[..] else { panic!("{key}") };
            rod.is(value, expected, 1.0);
            // The error of the angle of a maximum is the root of that of its value.
            assert!(angle.is_none_or(|angle| (rod.value(angle) - at).abs() < 1e-4), "{key}");
        }
        rod.is("F_tens", peak("tension_small_end")[0], 1.0);
        rod.is("F_tens_big", peak("tension_big_end")[0], 1.0);
        let ends = &figures["big_end_tension_until_deg"]["with_gas"]["after_start"];
        rod.is("theta_big_tension", ends.as_f64().unwrap(), 1.0);
    }
}

/// Figures 21 to 24: height, critical angle, mass and buckling over the thickness of the flanges, up to the thickness at which the flanges
/// alone carry.
#[test]
fn rod_over_the_thickness() {
    for (rod, figures) in rods() {
        for row in figures["over_t"].as_array().unwrap() {
            let number = |value: &Value| value.as_f64().unwrap();
            let rod = rod.with(&[("t", number(&row["t_mm"]))]);
            for cut in ["0", "0.25", "0.5", "0.75", "1.0"] {
                let (rod, expected) = (rod.with(&[("cut", cut.parse().unwrap())]), &row[cut]);
                rod.is("H_req", number(&expected["H_mm"]), 100.0);
                if let Some(at) = expected["angle_deg"].as_f64() {
                    assert!((rod.value("theta_H") - at).abs() < 1e-3, "{} {at}", rod.value("theta_H"));
                }
            }
            rod.is("m_shank_req", number(&row["m_shank_root_g"]), 100.0);
            let buckling = &row["buckling"]["F_big_end_L_eyes"];
            // The only root of the cubic lies far below the flanges: every height is stable.
            rod.is("H_buckling_zz", number(&buckling["H_zz_mm"]).max(0.0), 100.0);
            rod.is("H_buckling_yy", number(&buckling["H_yy_mm"]), 1000.0);
        }
    }
}

#[test]
fn shares_of_the_rod_in_its_forces() {
    let all = data("rod-figures.json");
    for (variant, [radius, pressure]) in [("r41", [41.0, 95.5]), ("r82", [82.0, 106.5])] {
        let at = |speed: f64| At::of("connecting-rod", &[("r", radius), ("p3", pressure), ("speed", speed)]);
        let ratios = &all["computed"][variant]["ratios"];
        let close = |found: f64, key: &str| {
            let expected = ratios[key].as_f64().unwrap();
            assert!((found / expected - 1.0).abs() < 1e-8, "{variant} {key}: {found} {expected}");
        };
        let fast = at(6000.0);
        close(at(3000.0).value("F_tens") / fast.value("F_tens"), "tension_3000_over_6000");
        close(
            fast.value("F_comp_rod") / fast.value("F_comp_inertia"),
            "rod_alone_compression_over_total_compression_6000",
        );
    }
}

/// The largest axial force of the rod alone is least if tension and compression are equal. The expected values come from a scan of 20 001
/// angles and mass centres in steps of 0.01 mm, with d'Alembert's forces written out. Near a maximum the scan has an error of some 1e-8.
#[test]
fn the_mass_centre_that_is_best_for_the_axial_force() {
    for (radius, centre, expected) in [(41.0, 107.34, 17.085435580853222), (82.0, 102.45, 224.55940713451471)] {
        let rod = At::of("connecting-rod", &[("r", radius)]);
        let force = |at: f64| rod.with(&[("mc_F", at)]).value("Fa_opt");
        let found = force(centre);
        assert!((found / expected - 1.0).abs() < 1e-7, "{radius}: {found}");
        assert!(force(centre - 0.02) > found && force(centre + 0.02) > found, "{radius}");
    }
}

/// Beyond the height that the flanges alone carry, the required height stays smooth until it jumps. Every row has a height, without
/// failures.
#[test]
fn required_heights_fall_with_the_thickness() {
    for radius in [41.0, 82.0] {
        let rod = At::of("connecting-rod", &[("r", radius), ("speed", 3000.0)]);
        let heights: Vec<f64> =
            (0..=60).map(|step| rod.with(&[("t", 3.0 + 0.05 * f64::from(step))]).value("H_req")).collect();
        assert!(heights.windows(2).all(|pair| pair[1] <= pair[0]), "{heights:?}");
        assert_eq!(heights[60], 0.0);
    }
    // The same search over the strokes that determine the loads at 3000 rpm, which failed from 4.46 mm on.
    let rod = At::of("connecting-rod", &[("t", 5.0)]);
    rod.is("H_req_3000", 2.142416408, 100.0);
    // The height of the flanges alone is 2 t.
    rod.is("H_margin", 32.0 - 10.0, 100.0);
}

/// Figures 4, 5, 7 and 9.
#[test]
fn flywheel_over_the_crank_angle() {
    let figures = data("flywheel-figures.json");
    let wheel = At::of("dual-mass-flywheel", &[("n", 1000.0)]);
    let series = |value: &Value| numbers(value).into_iter().map(Option::unwrap).collect::<Vec<_>>();
    let pairs = |angles: &Value, values: &Value| series(angles).into_iter().zip(series(values)).collect::<Vec<_>>();
    let gas = &figures["fig4_pressure"];
    for (angle, bar) in pairs(&gas["crank_angle_deg"], &gas["pressure_bar"]) {
        // The cycle closes with a step of 0.05 bar, from exhaust to suction: 360 degrees belong to the next cycle.
        if angle < 360.0 {
            wheel.with(&[("theta", angle)]).is("pressure", 1e5 * bar, 1e5);
        }
    }
    let torque = &figures["fig5_torque_N_m"];
    for (output, key) in [("T_gas", "gas"), ("T_inertia", "inertia"), ("T_engine", "total")] {
        for (angle, expected) in pairs(&torque["crank_angle_deg"], &torque[key]) {
            wheel.with(&[("theta", angle)]).is(output, expected, 100.0);
        }
    }
    let speeds = &figures["figs7_9_speed_deviation_rad_s"];
    for (output, key) in
        [("dW1", "DMF_primary"), ("dW2", "DMF_secondary"), ("dWf", "SMF_flywheel"), ("dWc", "SMF_clutch_gearbox_input")]
    {
        let expected = &speeds["8_orders"][key];
        for (angle, expected) in pairs(&speeds["crank_angle_deg"], &expected["deviation_rad_s"]) {
            wheel.with(&[("theta", angle)]).is(&format!("{output}_at"), expected, 1.0);
        }
        wheel.is(&format!("{output}_half"), expected["half_range"].as_f64().unwrap(), 1.0);
    }
    for (angle, expected) in pairs(&speeds["crank_angle_deg"], &speeds["time_s"]) {
        wheel.with(&[("theta", angle)]).is("time", expected, 1.0);
    }
    let sine = &figures["sine_order_1_5_T0_420_amplitude_rad_s"];
    for (output, key) in [
        ("dW1_1000", "DMF_primary"),
        ("dW2_1000", "DMF_secondary"),
        ("dWf_1000", "SMF_flywheel"),
        ("dWc_1000", "SMF_clutch"),
    ] {
        wheel.is(output, sine[key].as_f64().unwrap(), 1.0);
    }
}

/// Figures 10 to 13.
#[test]
fn flywheel_over_its_parameters() {
    let figures = data("flywheel-figures.json");
    let wheel = At::of("dual-mass-flywheel", &[]);
    let nominal = |name: &str| wheel.point[wheel.model.inputs.iter().position(|input| input.name == name).unwrap()];
    let accelerations = &figures["fig10_acceleration_rad_s2"];
    for key in ["A_DMF", "A_SMF"] {
        for (rpm, expected) in numbers(&accelerations["rpm"]).into_iter().zip(numbers(&accelerations[key])) {
            wheel.with(&[("n", rpm.unwrap())]).is(key, expected.unwrap(), 1.0);
        }
    }
    for row in figures["figs11_12_13"].as_array().unwrap() {
        let factor = row["factor"].as_f64().unwrap();
        for name in ["k", "J1", "J2", "J2_sum_const"] {
            let changed = name.split('_').next().unwrap();
            let value = factor * nominal(changed);
            let mut set = vec![(changed, value)];
            if name.ends_with("const") {
                set.push(("J1", 0.33 - value));
            }
            let (wheel, expected) = (wheel.with(&set), &row[name]);
            wheel.is("dW2_1000", expected["amplitude_secondary"].as_f64().unwrap(), 1.0);
            let reduction = 100.0 * (1.0 - wheel.value("dW2_1000") / wheel.value("dWc_1000"));
            assert!((reduction - expected["reduction_vs_SMF_gearbox_pct"].as_f64().unwrap()).abs() < 1e-6);
        }
    }
}

/// Both readings of the crank angles are tested in all three cases. `full` omits third derivatives: their effect is 1e-5 of sigma in the
/// mean. In case 1, in which the squared angles have the larger part of the variance, it is 1e-3 in the shape.
#[test]
fn engine_under_both_readings() {
    let all = &data("engine-case1.json")["computed"];
    for (path, case, reading) in [
        ("study", "reference", "independent"),
        ("accumulated", "reference", "accumulated"),
        ("case1", "case1", "independent"),
        ("case1-accumulated", "case1", "accumulated"),
        ("wide", "case2", "independent"),
        ("wide-accumulated", "case2", "accumulated"),
    ] {
        let study = Study::read(&repository(&format!("examples/engine-balance/{path}.toml"))).unwrap();
        let found = analyze(&study.problem, &Method::Full.into()).unwrap();
        let expected = &all[case]["readings"][reading]["sigma=T/3"];
        for (found, name) in found.characteristics.iter().zip(["F", "M"]) {
            let (moments, of) = (found.moments.unwrap(), |key: &str| expected[name][key].as_f64().unwrap());
            let sigma = of("sigma");
            assert!((found.nominal.unwrap() / of("nominal") - 1.0).abs() < 1e-9, "{path} {name}");
            assert!((moments.mean() - of("mean")).abs() < 1e-4 * sigma, "{path} {name} {}", moments.mean());
            assert!((moments.sigma() / sigma - 1.0).abs() < 1e-4, "{path} {name} {}", moments.sigma());
            let (skewness, kurtosis) = (moments.skewness().unwrap(), moments.kurtosis().unwrap());
            assert!((skewness - of("skewness")).abs() < 1e-3, "{path} {name} {skewness}");
            assert!((kurtosis - of("kurtosis")).abs() < 3e-3, "{path} {name} {kurtosis}");
        }
    }
}

/// A required height below that of the flanges causes a warning, and one above does not.
#[test]
fn overlapping_flanges_are_told() {
    let rod = |t: f64| {
        let text = format!(
            "[model]\nbuiltin = \"connecting-rod\"\n[dimensions]\nt = {{ nominal = {t}, tolerance = 0.01 }}\n\
             [characteristics]\nH_req = {{}}\nspare = {{ formula = \"32 - H_req\" }}\n"
        );
        let study = Study::from_toml(&text, "rod.toml").unwrap();
        let codes = |names: &[&str]| {
            let problem = study.problem.clone().only(names).unwrap();
            let found = analyze(&problem, &Options::from(Method::SecondOrder).with_verify(0)).unwrap();
            found.warnings.iter().map(|warning| warning.code().to_owned()).collect::<Vec<_>>()
        };
        [codes(&["H_req"]), codes(&["spare"])]
    };
    assert!(rod(3.0).iter().all(|codes| !codes.contains(&"outside-model".to_owned())));
    assert!(rod(5.0).iter().all(|codes| codes.contains(&"outside-model".to_owned())));
}
