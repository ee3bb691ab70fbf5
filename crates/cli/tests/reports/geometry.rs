//! Geometric tolerances: the inputs that each line stands for, its exact moments, and faults of a line.

use sensitol::distribution::{Distribution, Jacobi, StandardMoments, TwoValues};

use sensitol::{Analysis, Method, Options, analyze};
use sensitol_study::Study;

use super::elements::same_as_expanded;
use sensitol_testing::{analysed, case, close, faults, parse, relative};

/// Returns variance and kurtosis of the first characteristic by methods that examine no pairs, some and all.
fn moments(text: &str) -> Vec<(f64, f64)> {
    let of = |method: Method| {
        let moments = analysed(text, method).characteristics[0].moments.unwrap();
        (moments.variance(), moments.kurtosis().unwrap())
    };
    [Method::SecondOrder, Method::SixN, Method::Full].map(of).to_vec()
}

#[track_caller]
fn holds(text: &str, exact: &serde_json::Value) {
    let of = |key: &str| exact[key].as_f64().unwrap();
    for (variance, kurtosis) in moments(text) {
        // The surface equals the formula: rounding of products of some hundreds of terms.
        relative(variance, of("variance"), 1e-11);
        relative(kurtosis, of("kurtosis"), 1e-11);
    }
    let auto = analysed(text, Method::Auto).characteristics[0].moments.unwrap();
    // `auto` promises 1 % of sigma. If it has not examined every pair, its moments may come from 41984 points of the formula, with an
    // error of some thousandths in the kurtosis.
    relative(auto.sigma(), of("variance").sqrt(), 1e-2);
    relative(auto.kurtosis().unwrap(), of("kurtosis"), 2e-2);
}

/// Returns the proven worst case of a characteristic.
#[track_caller]
fn worst(text: &str) -> [f64; 2] {
    let analysis = analysed(text, Method::SecondOrder);
    let bounds = analysis.characteristics[0].range.bounds.clone().expect("a formula has bounds");
    assert!(bounds.proven, "{bounds:?}");
    bounds.bounds
}

fn study(lines: &str, formula: &str) -> String {
    format!("[dimensions]\n{lines}\n[characteristics]\ny = {{ formula = \"{formula}\" }}\n")
}

const BONUS: &str = "D = { nominal = 10.1, tolerance = 0.1 }\nh = { nominal = [50, 30], position = { zone = 0.2, hole = \"D\", at = \"MMC\" } }";

/// Position of a hole whose zone is 0.2 at maximum material, with a bonus of 0.1 on average: moments in closed form. Size and position
/// interact, and every method includes that.
#[test]
fn a_bonus_widens_the_scatter() {
    holds(&study(BONUS, "h_x - 50"), &case("bonus-coordinate")["exact"]);
    holds(&study(BONUS, "h_y"), &case("bonus-coordinate")["exact"]);
    // The pair needs no further evaluation: 2 N + 1 points.
    let analysis = analysed(&study(BONUS, "h_x"), Method::SecondOrder);
    assert_eq!(analysis.run.evaluations, 5);
    same_as_expanded(&study(BONUS, "h_x + 2*h_y"), Method::SecondOrder);
    same_as_expanded(&study(BONUS, "h_x + 2*h_y"), Method::Auto);
}

/// Position spread evenly over the zone: for a disc's coordinate, E xi^2 = 1/4 and E xi^4 = 1/8.
#[test]
fn a_bonus_of_a_place_spread_evenly() {
    let even = BONUS.replace("} }", "}, distribution = \"uniform\" }");
    let (total, square) = (0.3f64, (0.1f64 / 3.0).powi(2));
    let (e2, e4) = (0.25, 0.125);
    let variance = (total * total + square) / 4.0 * e2;
    let fourth = (total.powi(4) + 6.0 * total * total * square + 3.0 * square * square) / 16.0 * e4;
    for (found, kurtosis) in moments(&study(&even, "h_x")) {
        relative(found, variance, 1e-11);
        relative(kurtosis, fourth / (variance * variance), 1e-11);
    }
    same_as_expanded(&study(&even, "h_x + 2*h_y"), Method::SecondOrder);
}

/// Virtual and resultant condition of a hole 10.0 .. 10.2 and a pin 9.8 .. 10.0, position 0.1 at maximum material: the worst-case place
/// of the surface from size and bonus together.
#[test]
fn boundaries_of_features_with_a_bonus() {
    let exact = |kind: &str, index: usize| case("boundaries")["exact"][kind][index].as_f64().unwrap();
    let feature = |kind: &str, limits: &str, at: &str, formula: &str| {
        let lines = format!(
            "D = {{ limits = {limits} }}\nh = {{ nominal = [0, 0], position = {{ zone = 0.1, {kind} = \"D\", at = \"{at}\" }} }}"
        );
        worst(&study(&lines, formula))
    };
    // Bounds are rounded outward, and ends of boxes are within a thousandth of sigma.
    let near = |found: f64, expected: f64| close(found, expected, 1e-9, 1.0);
    near(feature("hole", "[10.0, 10.2]", "MMC", "D - 2*h_x")[0], exact("hole", 0));
    near(feature("hole", "[10.0, 10.2]", "MMC", "D + 2*h_x")[1], exact("hole", 1));
    near(feature("pin", "[9.8, 10.0]", "MMC", "D + 2*h_y")[1], exact("pin", 0));
    near(feature("pin", "[9.8, 10.0]", "MMC", "D - 2*h_y")[0], exact("pin", 1));
    // At least material it is the reverse: the zone is 0.1 if the hole is largest.
    near(feature("hole", "[10.0, 10.2]", "LMC", "D + 2*h_x")[1], 10.3);
    near(feature("hole", "[10.0, 10.2]", "LMC", "D - 2*h_x")[0], 9.7);
    near(feature("pin", "[9.8, 10.0]", "LMC", "D - 2*h_x")[0], 9.7);
    // Regardless of feature size, the zone is independent of the size.
    near(feature("hole", "[10.0, 10.2]", "RFS", "D - 2*h_x")[0], 9.9);
    near(feature("hole", "[10.0, 10.2]", "RFS", "D + 2*h_x")[1], 10.3);
}

/// In both directions at once the worst case is that of the widest zone: half of 0.2 + 0.2 along the length of the slope.
#[test]
fn the_worst_case_of_a_zone_with_a_bonus() {
    let text = study(BONUS, "3*h_x + 4*h_y");
    let sigma = analysed(&text, Method::SecondOrder).characteristics[0].moments.unwrap().sigma();
    let [least, greatest] = worst(&text);
    // Proven to a thousandth of sigma, and never inside.
    assert!((269.0 - least) / sigma < 1e-3 && least <= 269.0, "{least}");
    assert!((greatest - 271.0) / sigma < 1e-3 && greatest >= 271.0, "{greatest}");
    // The linear worst case holds the size at its mean.
    let linear = analysed(&text, Method::SecondOrder).characteristics[0].range.worst_case.unwrap();
    close(linear[1], 270.75, 1e-9, 1.0);
}

/// A distribution of two values: moments of a coin, and a step function.
#[test]
fn two_values_alike() {
    let coin = TwoValues::new(1.0, 4.0).unwrap();
    let law = coin.probability().unwrap();
    assert_eq!((coin.mean(), coin.sigma(), coin.support()), (2.5, 1.5, [1.0, 4.0]));
    assert_eq!(coin.standard_moments(), StandardMoments::from_standard([0.0, 1.0, 0.0, 1.0, 0.0, 1.0]));
    assert_eq!([0.9, 1.0, 3.9, 4.0].map(|x| law.cdf(x)), [0.0, 0.5, 0.5, 1.0]);
    assert_eq!([0.0, 0.5, 0.6, 1.0].map(|p| law.quantile(p)), [1.0, 1.0, 4.0, 4.0]);
    assert_eq!([0.0, 0.4, 0.5, 1.0].map(|p| law.upper_quantile(p)), [4.0, 4.0, 1.0, 1.0]);
    assert_eq!(law.atoms(), [(1.0, 0.5), (4.0, 0.5)]);
    assert_eq!(coin.jacobi(4), Jacobi::new(vec![0.0, 0.0], vec![1.0, 0.0]));
    assert!(TwoValues::new(4.0, 1.0).is_err());
    let written =
        sensitol_testing::dimension("{ nominal = 3, tolerance = [-1, 2], distribution = \"two-point\" }").unwrap();
    assert_eq!((written.mean(), written.sigma()), (3.5, 1.5));
}

/// Zone of a pin 11.2 .. 11.8 with position 0.5 at maximum material, at three sizes, as printed.
#[test]
fn the_zone_that_a_size_leaves() {
    let case = case("bonus-pin");
    for (size, key) in [(11.8, "zone at 11.8"), (11.5, "zone at 11.5"), (11.2, "zone at 11.2")] {
        let lines = "P = { limits = [11.2, 11.8] }\nh = { nominal = [0, 0], position = { zone = 0.5, pin = \"P\", at = \"MMC\" } }";
        let text = study(lines, "`h.zone` + 0*h_x")
            .replace("limits = [11.2, 11.8]", &format!("nominal = {size}, limits = [11.2, 11.8]"));
        let nominal = analysed(&text, Method::SecondOrder).characteristics[0].nominal.unwrap();
        close(nominal, case["printed"][key]["value"].as_f64().unwrap(), 1e-12, 1.0);
    }
}

/// A hole of measured size .502, with .499 at maximum material, has a bonus of .003, or .001 if it is out of perpendicularity by .002: a
/// zone of .016, as printed. Form never makes the zone smaller than stated.
#[test]
fn form_lessens_a_bonus() {
    let case = case("bonus-envelope");
    let printed = |key: &str| case["printed"][key]["value"].as_f64().unwrap();
    let lines = |form: &str| {
        format!(
            "D = {{ nominal = 0.502, limits = [0.499, 0.505] }}\nt = {{ nominal = 0.002, limits = [0, 0.004] }}\n\
             h = {{ nominal = [0, 0], position = {{ zone = 0.015, hole = \"D\", at = \"MMC\"{form} }} }}"
        )
    };
    let zone = |form: &str| {
        let analysis = analysed(&study(&lines(form), "`h.zone` + 0*h_x"), Method::SecondOrder);
        analysis.characteristics[0].nominal.unwrap()
    };
    close(zone("") - 0.015, printed("bonus without the tilt"), 1e-12, 1.0);
    for form in [", form = \"t\"", ", form = 0.002", ", form = \"t/2 + 0.001\""] {
        close(zone(form) - 0.015, printed("bonus"), 1e-12, 1.0);
        close(zone(form), printed("zone"), 1e-12, 1.0);
    }
    close(zone(", form = 0.004"), 0.015, 1e-12, 1.0);
    // The greatest hole with the best form: half of .015 and .006.
    close(worst(&study(&lines(", form = \"t\""), "h_x"))[1], 0.0105, 1e-9, 1.0);
    same_as_expanded(&study(&lines(", form = \"t\""), "h_x"), Method::SecondOrder);
    // A pin with a form error acts as a thicker one: 11.8 minus 11.5 minus 0.1.
    let pin = "P = { nominal = 11.5, limits = [11.2, 11.8] }\nh = { nominal = [0, 0], position = { zone = 0.5, pin = \"P\", at = \"MMC\", form = 0.1 } }";
    let found = analysed(&study(pin, "`h.zone` + 0*h_x"), Method::SecondOrder);
    close(found.characteristics[0].nominal.unwrap(), 0.7, 1e-12, 1.0);
}

/// A pitch between two holes that share a datum shift: the shift cancels. Twice half of 0.2 + 0.1 remains on either side.
#[test]
fn the_worst_case_of_a_pitch_is_proven() {
    let lines = "bore = { limits = [40.0, 40.025] }\nspigot = { limits = [39.95, 39.975] }\n\
                 A = { float = { hole = \"bore\", pin = \"spigot\", law = \"disc\" } }\nhole = { limits = [8.4, 8.5] }\n\
                 l = { nominal = [-35, 0], position = { zone = 0.2, hole = \"hole\", at = \"MMC\" }, from = \"A\" }\n\
                 r = { nominal = [35, 0], position = { zone = 0.2, hole = \"hole\", at = \"MMC\" }, from = \"A\" }";
    let [lower, upper] = worst(&study(lines, "r_x - l_x"));
    close(lower, 69.7, 1e-9, 1.0);
    close(upper, 70.3, 1e-9, 1.0);
    // With another factor the shift does not cancel: half of it remains, at most (40.025 - 39.95)/4 with the least shift of the zones.
    let [lower, upper] = worst(&study(lines, "2*r_x - l_x - r_x/2 - 0.5*r_x + A_x/2"));
    close(upper - lower, 0.6 + 0.0375, 1e-9, 1.0);
}

/// A bonus at its cap widens the zone no further.
#[test]
fn a_bonus_is_capped() {
    let capped = BONUS.replace("at = \"MMC\"", "at = \"MMC\", most = 0.05");
    close(worst(&study(&capped, "h_x"))[1], 50.125, 1e-9, 1.0);
    let analysis =
        analysed(&study(&BONUS.replace("at = \"MMC\"", "at = \"MMC\", most = 0.05"), "`h.zone`"), Method::SecondOrder);
    close(analysis.characteristics[0].nominal.unwrap(), 0.25, 1e-12, 1.0);
    same_as_expanded(&study(&capped, "h_x"), Method::Auto);
}

/// Radial clearance, normal about 0.05 with sigma 0.008: a hole and a pin each have a share of the variance.
fn play(law: &str) -> String {
    // 2 c = A - B: sigma 0.016 = hypot(0.0096, 0.0128).
    format!(
        "A = {{ nominal = 8.1, sigma = 0.0096 }}\nB = {{ nominal = 8.0, sigma = 0.0128 }}\nds = {{ float = {{ hole = \"A\", pin = \"B\", law = \"{law}\" }} }}"
    )
}

#[test]
fn floats_have_exact_moments() {
    for (law, output) in [("uniform", "ds"), ("contact", "ds"), ("disc", "ds_x"), ("rim", "ds_y")] {
        holds(&study(&play(law), output), &case(&format!("float-{law}"))["exact"]);
        same_as_expanded(&study(&play(law), output), Method::SecondOrder);
        same_as_expanded(&study(&play(law), output), Method::Auto);
    }
    // A direction across a disc and a rim: the slope is the length of the vector.
    for (law, share) in [("disc", 0.25), ("rim", 0.5)] {
        let variance = moments(&study(&play(law), "3*ds_x + 4*ds_y"))[0].0;
        relative(variance, 25.0 * (0.05f64.powi(2) + 0.008f64.powi(2)) * share, 1e-11);
    }
}

/// Float of parts that are pressed to one side: the clearance itself.
#[test]
fn a_float_that_is_always_on_one_side() {
    for (law, sign) in [("+", 1.0), ("-", -1.0)] {
        let analysis = analysed(&study(&play(law), "ds"), Method::SecondOrder);
        let moments = analysis.characteristics[0].moments.unwrap();
        close(moments.mean(), sign * 0.05, 1e-12, 1.0);
        relative(moments.sigma(), 0.008, 1e-12);
        same_as_expanded(&study(&play(law), "ds"), Method::SecondOrder);
    }
}

/// Sizes as numbers and formulas, with a kink only if the bands allow a pin that is larger than the hole.
#[test]
fn clearances_of_numbers_and_formulas() {
    let float = |sizes: &str| {
        parse(&study(&format!("A = {{ nominal = 8.1, tolerance = 0.05 }}\nds = {{ float = {{ {sizes} }} }}"), "ds"))
            .unwrap()
    };
    let clearance =
        |study: &Study| study.expanded.lines().find(|line| line.starts_with("\"ds.clearance\"")).unwrap().to_owned();
    assert!(clearance(&float("hole = \"A\", pin = 8")).contains("= \"(A - 8.0)/2\""));
    assert!(clearance(&float("hole = \"A + 0.1\", pin = 8")).contains("= \"((A + 0.1) - 8.0)/2\""));
    assert!(clearance(&float("hole = \"A\", pin = 8.05")).contains("= \"(A - 8.05)/2\""));
    let close = float("hole = \"A\", pin = 8.1");
    // Half of the holes are smaller than this pin.
    let warnings: Vec<_> = close.warnings.iter().map(|warning| warning.message()).collect();
    assert!(warnings.len() == 1 && warnings[0].starts_with("50.00 % of the pairs"), "{warnings:?}");
    let both = study(
        "A = { nominal = 8.1, tolerance = 0.06 }\nB = { nominal = 8.0, tolerance = 0.08 }\nds = { float = { hole = \"A\", pin = \"B\" } }",
        "ds",
    );
    // A difference of 0.1 with sigma hypot(0.06, 0.08)/3 = 1/30: three sigma, 0.13 %.
    assert!(parse(&both).unwrap().warnings[0].message().starts_with("0.13 % of the pairs"));
    assert!(clearance(&float("hole = \"A\", pin = 8.1")).contains("= \"max(0, A - 8.1)/2\""));
}

/// A part on a round pin and in a slot: variance and worst case of its rotation in closed form.
#[test]
fn a_part_on_a_pin_and_in_a_slot() {
    let lines = "H = 8.1\nP = 8.0\nS = 6.06\nQ = 6.0\n[dimensions]\nedge = { nominal = 5, tolerance = 0.1 }\n\
                 base = { locate = { hole = \"H\", pin = \"P\", slot = \"S\", pin2 = \"Q\", distance = 80 } }";
    let text = study(lines, "base_rot").replacen("[dimensions]", "[constants]", 1);
    let exact = |key: &str| case("pin-slot")["exact"][key].as_f64().unwrap();
    relative(moments(&text)[0].0, exact("variance of rotation"), 1e-11);
    close(worst(&text)[1], exact("worst case"), 1e-9, 1e-3);
    same_as_expanded(&text, Method::SecondOrder);
    // A hole 60 along x and 20 along y from the pin. The part moves and turns it: 60 rot along y and -20 rot along x.
    let hole = "hole = { nominal = [60, 20], position = 0.2, from = \"base\" }";
    for (output, lever, own) in [("hole_x", -20.0, "base_x"), ("hole_y", 60.0, "base_y")] {
        let related =
            text.replace("base_rot", output).replace("[characteristics]", &format!("{hole}\n[characteristics]"));
        let direct = format!("`hole.own{}` + {own} + {lever}*base_rot", &output[4..]);
        let written = related.replace(&format!("\"{output}\""), &format!("\"{direct}\""));
        let [a, b] =
            [&related, &written].map(|text| analysed(text, Method::SecondOrder).characteristics[0].moments.unwrap());
        close(a.mean(), b.mean(), 1e-12, 1.0);
        relative(a.variance(), b.variance(), 1e-11);
        same_as_expanded(&related, Method::SecondOrder);
    }
}

/// Offset and tilt of a face share the zone of a profile.
#[test]
fn offset_and_tilt_share_a_profile() {
    let line = "face = { profile = 0.4, length = 60 }";
    let exact = &case("shared-zone")["exact"];
    let of = |key: &str, index: usize| exact[key].get(index).unwrap_or(&exact[key]).as_f64().unwrap();
    relative(moments(&study(line, "face"))[0].0, of("variances", 0), 1e-11);
    relative(moments(&study(line, "face_tilt"))[0].0, of("variances", 1), 1e-11);
    // The product has mean 0, and its variance is the mean of both squares.
    let product = &study(line, "face*face_tilt");
    relative(
        analysed(product, Method::Full).characteristics[0].moments.unwrap().variance(),
        of("E offset^2 tilt^2", 0),
        1e-9,
    );
    same_as_expanded(&study(line, "face + 30*face_tilt"), Method::SecondOrder);
}

/// Bands and circles as stated by the frames.
#[test]
fn zones_are_bands_and_circles() {
    let dimension = |line: &str, index: usize| {
        let parsed = parse(&study(&format!("a = {line}\nb = {{ nominal = 1, tolerance = 0.1 }}"), "b")).unwrap();
        let dimension = &parsed.problem.dimensions()[index];
        (dimension.nominal(), dimension.tolerance().unwrap(), dimension.sigma())
    };
    let third = |half: f64| half / 3.0;
    assert_eq!(dimension("{ profile = 0.4 }", 0), (0.0, [-0.2, 0.2], third(0.2)));
    assert_eq!(dimension("{ profile = { zone = 0.4, outward = 0.3 } }", 0), (0.0, [-0.1, 0.3], third(0.2)));
    assert_eq!(dimension("{ flatness = 0.02 }", 0), (0.0, [-0.01, 0.01], third(0.01)));
    assert_eq!(dimension("{ roundness = 0.02, side = \"out\" }", 0), (0.0, [0.0, 0.02], third(0.01)));
    assert_eq!(dimension("{ symmetry = 0.04, nominal = 3 }", 0), (3.0, [-0.02, 0.02], third(0.02)));
    for runout in ["runout", "total_runout", "coaxiality", "concentricity"] {
        for axis in [0, 1] {
            assert_eq!(dimension(&format!("{{ {runout} = 0.06 }}"), axis), (0.0, [-0.03, 0.03], third(0.03)));
        }
    }
    let reach = case("tilt")["exact"]["half band rad"].as_f64().unwrap();
    for angle in ["perpendicularity", "parallelism", "angularity"] {
        let (_, [lower, upper], _) = dimension(&format!("{{ {angle} = 0.1, length = 40 }}"), 0);
        relative(upper, reach, 1e-14);
        relative(-lower, reach, 1e-14);
        let (_, [_, upper], _) = dimension(&format!("{{ {angle} = 0.1, length = 40, axis = true }}"), 1);
        relative(upper, reach, 1e-14);
    }
    for line in [
        "{ profile = { zone = 0.4, outward = 0.3 } }",
        "{ perpendicularity = 0.1, length = 40, unit = \"mm\" }",
        "{ flatness = 0.02, side = \"out\" }",
        "{ symmetry = 0.04 }",
    ] {
        same_as_expanded(
            &study(&format!("a = {line}\nb = {{ nominal = 1, tolerance = 0.1 }}"), "a + b"),
            Method::SecondOrder,
        );
    }
    for line in ["{ runout = 0.06, distribution = \"uniform\" }", "{ parallelism = 0.1, length = 40, axis = true }"] {
        same_as_expanded(
            &study(&format!("a = {line}\nb = {{ nominal = 1, tolerance = 0.1 }}"), "a_x + 2*a_y + b"),
            Method::SecondOrder,
        );
    }
}

/// Formulas of ASME Y14.5, appendix B, for fasteners of 6 in holes of 6.44: the worst case uses all clearance at 0.44 floating, 0.22
/// fixed, and 0.18 with 0.26.
#[test]
fn fasteners_of_asme() {
    let play = |fastener: &str, zones: [f64; 2]| {
        let text = format!(
            "[constants]\nH = 6.44\nF = 6\n[dimensions]\na = {{ nominal = [0, 0], position = {} }}\nb = {{ nominal = [0, 0], position = {} }}\n\
             [characteristics]\nplay = {{ fastener = {fastener}, lower = 0 }}\n",
            zones[0], zones[1]
        );
        same_as_expanded(&text, Method::SecondOrder);
        let options = Options::from(Method::SecondOrder).with_extremes(true);
        let analysis: Analysis = analyze(&parse(&text).unwrap().problem, &options).unwrap();
        analysis.characteristics[0].range.extremes.as_ref().unwrap().least.value
    };
    let printed = |name: &str| case(name)["printed"]["T"]["value"].as_f64().unwrap();
    let floating = "{ kind = \"floating\", holes = [\"H\", \"H\"], pin = \"F\", places = [\"a\", \"b\"] }";
    let fixed = "{ kind = \"fixed\", hole = \"H\", pin = \"F\", places = [\"a\", \"b\"] }";
    // The search ends at the corners of two opposed zones: rounding of a sum of six digits.
    let t = printed("fastener-floating");
    close(play(floating, [t, t]), 0.0, 1e-6, 1.0);
    let t = printed("fastener-fixed");
    close(play(fixed, [t, t]), 0.0, 1e-6, 1.0);
    close(play(fixed, [0.18, 0.26]), 0.0, 1e-6, 1.0);
    // A stud that stands out by 10 with threads 14 deep: the second zone counts 1 + 2*10/14 times.
    let tilted = fixed.replace("] }", "], projection = 10, depth = 14 }");
    close(play(&tilted, [0.18, 0.26 / (1.0 + 20.0 / 14.0)]), 0.0, 1e-6, 1.0);
}

/// The one-way clutch of Chase as a loop, with form errors at the roller's contacts: an angle of 7.018 degrees as printed, slopes by
/// hand.
#[test]
fn form_in_a_loop() {
    let text = "[dimensions]\na = { nominal = 27.645, tolerance = 0.0125 }\nc = { nominal = 11.43, tolerance = 0.01 }\ne = { nominal = 50.8, tolerance = 0.0125 }\n\
                hub = { roundness = 0.005 }\nring = { roundness = 0.005 }\n[unknowns]\nphi = { start = 0.1, lower = 0, upper = 1 }\nb = { start = 4, lower = 0 }\n\
                [loops]\nclutch = [\n  { length = \"b\", angle = 0 },\n  { length = \"a + hub + c\", angle = \"pi/2\" },\n  { length = \"e - c - ring\", angle = \"3*pi/2 - phi\" },\n]\n\
                [characteristics]\nphi = {}\n";
    let analysis = analysed(text, Method::SecondOrder);
    let one = &analysis.characteristics[0];
    let case = case("clutch");
    let printed = &case["printed"]["phi deg"];
    let of = |value: &serde_json::Value| value.as_f64().unwrap();
    assert!((one.nominal.unwrap().to_degrees() - of(&printed["value"])).abs() <= of(&printed["tolerance"]));
    relative(one.nominal.unwrap(), of(&case["exact"]["phi"]), 1e-12);
    let slopes = &case["exact"]["slopes a, c, e"];
    let form = &case["exact"]["slopes of form at hub and ring contact"];
    let expected = [&slopes[0], &slopes[1], &slopes[2], &form[0], &form[1]].map(of);
    for (row, expected) in one.sensitivities.iter().zip(expected) {
        // A ring that moves closer acts as a shorter e.
        relative(row.first.unwrap().abs(), expected.abs(), 1e-9);
    }
}

/// Generated inputs have units too, with `units = "convert"`.
#[test]
fn elements_are_converted() {
    let text = "units = \"convert\"\n[dimensions]\nD = { nominal = 0.4, tolerance = 0.004, unit = \"in\" }\nP = { nominal = 10, tolerance = 0.05, unit = \"mm\" }\n\
                h = { nominal = [50, 30], position = { zone = 0.2, hole = \"D\", at = \"MMC\", most = 0.3 }, unit = \"mm\" }\n\
                ds = { float = { hole = \"D\", pin = \"P\" }, unit = \"mm\" }\np = { perpendicularity = 0.1, length = 40, unit = \"mm\" }\n\
                [characteristics]\ny = { formula = \"h_x + ds + 40[mm]*sin(p)\", unit = \"mm\" }\n";
    let nominal = analysed(text, Method::SecondOrder).characteristics[0].nominal.unwrap();
    close(nominal, 50.0, 1e-12, 1.0);
    // Half the zone of 0.2 and a mean bonus of 0.004 in, with 1/3 as sigma of each coordinate; a uniform float of (10.16 - 10)/2; 0.1
    // along 40.
    let place = ((0.2f64 + 0.1016).powi(2) + (0.1016f64 / 3.0).powi(2)) / 36.0;
    let clearance = (0.08f64.powi(2) + ((0.1016f64 / 3.0).powi(2) + (0.05f64 / 3.0).powi(2)) / 4.0) / 3.0;
    // The size widens both: their common part is a product of two positions with mean 0. The sine's third order is a millionth.
    let tilt = (40.0 * (0.1f64 / 40.0) / 3.0).powi(2);
    let variance = analysed(text, Method::Full).characteristics[0].moments.unwrap().variance();
    relative(variance, place + clearance + tilt, 1e-4);
    same_as_expanded(text, Method::SecondOrder);
}

/// The parts of an element are one contributor of a report, and are listed singly with -v.
#[test]
fn reports_name_the_element() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("study.toml");
    std::fs::write(&path, study(BONUS, "h_x + h_y")).unwrap();
    let shown = |more: &[&str]| {
        let mut command = assert_cmd::Command::cargo_bin("sensitol").unwrap();
        let output = command.arg("analyze").arg(&path).args(more).output().unwrap();
        String::from_utf8(output.stdout).unwrap()
    };
    let brief = shown(&[]);
    assert!(brief.lines().any(|line| line.trim_start().starts_with("h ")), "{brief}");
    assert!(!brief.contains("  h.unit_x "), "{brief}");
    let all = shown(&["-v"]);
    assert!(all.contains("h.unit_x") && all.contains("h.unit_y"), "{all}");
}

#[test]
fn what_is_wrong_is_said_at_its_place() {
    let element = |line: &str| {
        study(
            &format!(
                "D = {{ nominal = 10, tolerance = 0.1 }}\nF = {{ nominal = 9 }}\nS = {{ nominal = 10, sigma = 0.1 }}\nh = {line}"
            ),
            "D",
        )
    };
    let position = |keys: &str| element(&format!("{{ nominal = [1, 2], position = {{ {keys} }} }}"));
    let float = |keys: &str| element(&format!("{{ float = {{ {keys} }} }}"));
    let locate = |keys: &str| element(&format!("{{ locate = {{ {keys} }} }}"));
    let fastener = |keys: &str| {
        format!(
            "[dimensions]\nH = {{ nominal = 10, tolerance = 0.1 }}\na = {{ nominal = [1, 2], position = 0.1 }}\nb = {{ position = 0.1, nominal = [1, 2] }}\n\
             [characteristics]\ny = {{ fastener = {{ {keys} }} }}\n"
        )
    };
    let texts = [
        position("hole = \"D\", at = \"MMC\""),
        position("zone = -0.2"),
        position("zone = 0.2, hole = \"E\", at = \"MMC\""),
        position("zone = 0.2, at = \"MMC\""),
        position("zone = 0.2, hole = \"D\", at = \"MMB\""),
        position("zone = 0.2, hole = \"D\", pin = \"D\", at = \"MMC\""),
        position("zone = 0.2, hole = \"F\", at = \"MMC\""),
        position("zone = 0.2, hole = \"S\", at = \"LMC\""),
        position("zone = 0.2, hole = 10, at = \"MMC\""),
        position("zone = 0.2, most = 0.1"),
        position("zone = 0.2, hole = \"D\", at = \"MMC\", form = -0.1"),
        position("zone = 0.2, hole = \"D\", at = \"MMC\", form = \"E\""),
        position("zone = 0.2, hole = \"D\", at = \"MMC\", form = \"D - 10\""),
        position("zone = 0.2, hole = \"D\", form = 0.1"),
        element("{ position = { zone = 0.2, hole = \"D\", at = \"MMC\" } }"),
        element("{ nominal = 3, position = { zone = 0.2, hole = \"D\", at = \"MMC\" } }"),
        element("{ nominal = [1, 2], sigma = 0.1, position = { zone = 0.2, hole = \"D\", at = \"MMC\" } }"),
        element("{ nominal = [1, 2], tolerance = 0.1, position = { zone = 0.2, hole = \"D\", at = \"MMC\" } }"),
        element("{ nominal = [1, 2], position = \"0.2\" }"),
        float("hole = \"D\""),
        float("hole = \"E\", pin = 9"),
        float("hole = \"D +\", pin = 9"),
        float("hole = \"D\", pin = 11"),
        float("hole = \"D\", pin = 9, law = \"normal\""),
        float("hole = \"D\", pin = 9, slack = 2"),
        element("{ float = 0.1 }"),
        element("{ float = { hole = \"D\", pin = 9 }, tolerance = 0.1 }"),
        element("{ float = { hole = \"D\", pin = 9 }, from = \"D\" }"),
        element("{ float = { hole = \"D\", pin = 9 }, colour = 1 }"),
        locate("hole = \"D\", pin = 9, slot = 6"),
        locate("hole = \"D\", pin = 9, slot = 6.1, pin2 = 6"),
        locate("hole = \"D\", pin = 9, slot = 6.1, pin2 = 6, distance = 0"),
        element("{ profile = { zone = 0.4, outward = 0.5 } }"),
        element("{ profile = 0.4, tolerance = 0.1 }"),
        element("{ profile = 0.4, length = 60, distribution = \"normal\" }"),
        element("{ profile = 50, length = 40 }"),
        element("{ perpendicularity = 0.1 }"),
        element("{ parallelism = 0.1, length = 0 }"),
        element("{ angularity = 0.1, length = 40, axis = 1 }"),
        element("{ flatness = 0.1, side = \"in\" }"),
        element("{ flatness = \"0.1\" }"),
        element("{ flatness = 0.1, length = 3 }"),
        element("{ nominal = 3, tolerance = 0.1, length = 3 }"),
        element("{ runout = 0.1, symmetry = 0.1 }"),
        format!("{}\n[formulas]\nh_x = \"D\"\n", position("zone = 0.2, hole = \"D\", at = \"MMC\"")),
        fastener("kind = \"fixed\", hole = \"H\", pin = 9, places = [\"a\"]"),
        fastener("kind = \"fixed\", hole = \"H\", pin = 9, places = [\"a\", \"c\"]"),
        fastener("kind = \"fixed\", hole = \"H\", pin = 9"),
        fastener("kind = \"fixed\", pin = 9, places = [\"a\", \"b\"]"),
        fastener("kind = \"fixed\", holes = [\"H\", \"H\"], pin = 9, places = [\"a\", \"b\"]"),
        fastener("kind = \"fixed\", hole = \"H\", pin = 9, places = [\"a\", \"b\"], projection = 10"),
        fastener("kind = \"loose\", hole = \"H\", pin = 9, places = [\"a\", \"b\"]"),
        fastener("kind = \"floating\", hole = \"H\", pin = 9, places = [\"a\", \"b\"]"),
        fastener("kind = \"floating\", holes = [\"H\"], pin = 9, places = [\"a\", \"b\"]"),
        fastener("kind = \"floating\", holes = [\"H\", \"G\"], pin = 9, places = [\"a\", \"b\"]"),
        fastener("hole = \"H\", pin = 9, places = [\"a\", \"b\"]"),
        fastener("kind = \"fixed\", hole = \"H\", pin = 9, places = [\"a\", \"b\"] }, formula = { a = 1"),
    ];
    insta::assert_snapshot!(faults(&texts.iter().map(String::as_str).collect::<Vec<_>>()));
}
