//! Matrices of influence coefficients as models.

use sensitol::{Analysis, Method, analyze};
use sensitol_study::{Study, StudyError, StudyText};
use sensitol_testing::close;

const STUDY: &str = "units = \"check\"\n[dimensions]\n\
    shim = { nominal = 2, tolerance = 0.03, unit = \"mm\" }\n\
    tilt = { nominal = 0.5, tolerance = 0.3, unit = \"deg\" }\n\
    load = { nominal = -40, tolerance = 6, distribution = \"uniform\", unit = \"N\" }\n\
    [characteristics]\n\
    gap = { unit = \"mm\", lower = 0.9, upper = 1.1 }\n\
    twice = { formula = \"2*sag\", unit = \"mm\" }\n\
    [model]\nmatrix = \"influence.csv\"\n";

/// The outputs are sums by hand: mean and variance follow from the rows.
const INFLUENCE: &str = "output,unit,y0,shim,tilt,load\ngap,mm,-0.9,1,-0.05,0.002\nsag,mm,0.1,0,0.02,-0.001\n";

fn study(text: &str, matrix: &str) -> Result<Study, StudyError> {
    Study::from_text(StudyText::toml("study.toml", text).with_file("influence.csv", matrix))
}

fn analysed(text: &str, matrix: &str) -> Analysis {
    analyze(&study(text, matrix).unwrap().problem, &Method::SecondOrder.into()).unwrap()
}

#[test]
fn a_row_is_a_linear_function() {
    let analysis = analysed(STUDY, INFLUENCE);
    let moments = |place: usize| analysis.characteristics[place].moments.unwrap();
    let variances = [0.01f64.powi(2), 0.1f64.powi(2), 12.0];
    let variance = |row: [f64; 3]| row.iter().zip(variances).map(|(a, variance)| a * a * variance).sum::<f64>();
    // -0.9 + 2 - 0.05*0.5 - 0.002*40; the tolerance of the test is that of a sum of doubles.
    close(moments(0).mean(), 0.995, 1e-12, 1.0);
    close(moments(0).variance(), variance([1.0, -0.05, 0.002]), 1e-12, 1.0);
    // An output that is no characteristic is a formula of other characteristics.
    close(moments(1).mean(), 2.0 * (0.1 + 0.02 * 0.5 + 0.04), 1e-12, 1.0);
    close(moments(1).variance(), 4.0 * variance([0.0, 0.02, -0.001]), 1e-12, 1.0);
}

#[test]
fn a_matrix_about_the_nominal_dimensions_is_the_same_function() {
    let centred = "output;unit;nominal;shim;tilt [deg];load\ngap;mm;0,995;1;-0,05;0,002\nsag;mm;0,15;0;0,02;-0,001\n";
    let [at_zero, about] = [INFLUENCE, centred].map(|matrix| analysed(STUDY, matrix));
    for (one, other) in at_zero.characteristics.iter().zip(&about.characteristics) {
        close(one.moments.unwrap().mean(), other.moments.unwrap().mean(), 1e-12, 1.0);
        close(one.moments.unwrap().variance(), other.moments.unwrap().variance(), 1e-12, 1.0);
    }
}

/// Coefficients per mrad and in um are converted to the degrees and mm of the study.
#[test]
fn units_of_the_matrix_are_converted() {
    let text = STUDY.replace("\"check\"", "\"convert\"");
    let per_mrad = 0.05 * 1000.0 / (std::f64::consts::PI / 180.0 * 1000.0);
    let matrix =
        format!("output,unit,y0,shim [mm],tilt [mrad],load\ngap,um,-900,1000,{},2\nsag,mm,0.1,0,0,0.001\n", -per_mrad);
    let moments = analysed(&text, &matrix).characteristics[0].moments.unwrap();
    let expected = analysed(STUDY, INFLUENCE).characteristics[0].moments.unwrap();
    close(moments.mean(), expected.mean(), 1e-12, 1.0);
    close(moments.variance(), expected.variance(), 1e-12, 1.0);
    // About the nominal dimensions, which have the units of the study.
    let centred = matrix.replace("y0", "nominal").replace("-900", "995").replace("sag,mm,0.1", "sag,mm,0.15");
    let moments = analysed(&text, &centred).characteristics[0].moments.unwrap();
    close(moments.mean(), expected.mean(), 1e-12, 1.0);
    close(moments.variance(), expected.variance(), 1e-12, 1.0);
}

#[test]
fn wrong_matrices_are_said() {
    let fault = |text: &str, matrix: &str, words: &[&str]| {
        let error = study(text, matrix).err().unwrap_or_else(|| panic!("valid: {matrix}"));
        let told = format!("{error} {}", error.help().unwrap_or_default());
        assert!(words.iter().all(|words| told.contains(words)), "{told}");
    };
    for (matrix, words) in [
        (
            "output,unit,y0,shim,tilt,load\ngap,mm,-0.9,1,,0.002\nsag,mm,0,0,0,1\n",
            &["influence.csv, line 2, column `tilt`: the cell is empty", "write 0"][..],
        ),
        ("output,unit,y0,shin\ngap,mm,-0.9,1\nsag,mm,0,0\n", &["no dimension, constant or formula `shin`", "`shim`"]),
        ("output,unit,shim\ngap,mm,1\nsag,mm,0\n", &["`y0` or `nominal` is missing", "at zero inputs"]),
        ("output,y0,nominal,shim\ngap,0,0,1\nsag,0,0,0\n", &["`y0` and `nominal` are two columns"]),
        ("output,y0,shim\ngap,0,1\ngap,0,0\n", &["line 3", "the output `gap` stands in line 2 already"]),
        ("output,y0,shim,shim\ngap,0,1,1\nsag,0,0,1\n", &["the column `shim` stands twice"]),
        ("output,y0,shim [mm],shim [um]\ngap,0,1,1\nsag,0,0,1\n", &["the column `shim` stands twice"]),
        ("output,y0,shim [mm],shim\ngap,0,1,1\nsag,0,0,1\n", &["the column `shim` stands twice"]),
        ("output,y0,shim\ngapp,0,1\nsag,0,1\n", &["no row of the matrix `gap`", "did you mean `gapp`?"]),
        ("output,y0,shim\ngap,0,1\ntwice,0,1\n", &["the name `twice` is taken"]),
        ("output,y0,shim\ngap,0,x\nsag,0,1\n", &["column `shim`: `x` is not a number"]),
        ("output,unit,y0,shim,tilt [rad]\ngap,mm,0,1,1\nsag,mm,0,1,0\n", &["a sum of mm", "units = \"convert\""]),
        ("", &["the file is empty"]),
    ] {
        fault(STUDY, matrix, words);
    }
    fault(&format!("{STUDY}builtin = \"gas\"\n"), INFLUENCE, &["`matrix` and `builtin` are two models"]);
    fault(&format!("{STUDY}workers = 2\n"), INFLUENCE, &["`workers` means nothing for a matrix"]);
    fault(&STUDY.replace("\"influence.csv\"", "3"), INFLUENCE, &["the name of a CSV file"]);
    fault(&STUDY.replace("influence.csv", "influenc.csv"), INFLUENCE, &["no file of this name", "influence.csv"]);
}
