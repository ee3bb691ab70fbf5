//! Picture of an assembly in space on a page: what it adds, what it shows, and that it stays closed.

use sensitol::analyze;
use sensitol::assembly::Run;
use sensitol_report::html::{WhatIf, analyze_html};
use sensitol_report::{About, Detail, Report, Style, text};
use sensitol_study::Study;
use sensitol_testing::{close, repository};
use serde_json::Value;

/// Pages of an example with its picture and without.
fn pages(name: &str) -> [String; 2] {
    let study = Study::read(&repository(&format!("examples/{name}.toml"))).unwrap();
    let analysis = analyze(&study.problem, &study.options).unwrap();
    let what_if = WhatIf::of(&study.problem, &analysis, &study.lines, &study.costs);
    [study.scene(), None].map(|scene| {
        let about = About { title: study.title.clone(), scene, ..About::default() };
        let report = Report::of(&study.problem, &analysis, about);
        analyze_html(&report.with_deviations(&study, &Run::to_the_end()).unwrap(), Some(&what_if))
    })
}

/// Data of the script.
fn data(page: &str) -> Value {
    let text = page.split("id=\"scene\">").nth(1).unwrap().split("</script>").next().unwrap();
    serde_json::from_str(text).unwrap()
}

/// First drawing of a page.
fn wide(page: &str) -> &str {
    let start = page.find("<svg class=\"assembly wide\"").unwrap();
    &page[start..start + page[start..].find("</svg>").unwrap() + 6]
}

#[test]
fn a_picture_adds_at_most_60_kilobytes() {
    for name in ["locating-plate/study", "six-legged-platform/study", "crank-slider-space/study"] {
        let [with, without] = pages(name);
        let added = with.len() - without.len();
        assert!(added < 60_000, "{name}: {added} bytes");
        assert!(!without.contains("picture"), "a page without an assembly has nothing of it");
        for address in ["http:", "https:", "src=\"", "url(", "@import", "<link", "style=\"", " onclick"] {
            assert!(!with.contains(address), "{name}: the page holds {address}");
        }
    }
}

#[test]
fn a_picture_of_a_plate_is_the_one_that_was_looked_at() {
    let [page, _] = pages("locating-plate/study");
    insta::assert_snapshot!(wide(&page).replace("/><", "/>\n<"));
}

/// The drawn hole is 150 from the middle of the extents along x: half of the 160 between the edges is its place on the grid.
#[test]
fn points_of_the_grid_are_places_of_features() {
    let [page, _] = pages("locating-plate/study");
    let data = data(&page);
    let study = Study::read(&repository("examples/locating-plate/study.toml")).unwrap();
    let scene = study.scene().unwrap();
    let of = |name: &str| {
        let index = scene.features.iter().position(|feature| feature.name == name).unwrap();
        [0, 1, 2].map(|i| data["bodies"][index][i].as_f64().unwrap())
    };
    // All features lie between x = 0 and x = 160, which are 10 000 steps. Half a step is lost by rounding, twice.
    let [corner, drill] = ["plate.corner", "plate.drill"].map(of);
    close(corner[0], 5000.0, 1.0, 1.0);
    close(drill[0], 5000.0 - 10_000.0 * 10.0 / 160.0, 1.0, 1.0);
    close(drill[1] - corner[1], 10_000.0 * 70.0 / 160.0, 1.0, 1.0);
}

/// At one sigma along the slopes the height has moved by its sigma, so the corner has, and the table has not.
#[test]
fn a_measure_moves_by_its_sigma() {
    let [page, _] = pages("locating-plate/study");
    let data = data(&page);
    let study = Study::read(&repository("examples/locating-plate/study.toml")).unwrap();
    let scene = study.scene().unwrap();
    let index = |name: &str| scene.features.iter().position(|feature| feature.name == name).unwrap();
    let of = &data["characteristics"][2];
    assert_eq!(of["name"], "height");
    let up = |name: &str| data["moves"][2][6 * index(name) + 2].as_f64().unwrap() / of["enlarged"].as_f64().unwrap();
    // The step of the grid is 160/10000, and displacements have a tenth of a step after enlargement: 0.2 % here.
    close(
        up("plate.corner") * 160.0 / 10_000.0,
        of["sigma"].as_f64().unwrap(),
        5e-3,
        1.0 * of["sigma"].as_f64().unwrap(),
    );
    assert_eq!(up("fixture.table"), 0.0);
}

#[test]
fn the_face_that_costs_most_is_the_thickest() {
    let [page, _] = pages("shaft-two-bores/study");
    let data = data(&page);
    let study = Study::read(&repository("examples/shaft-two-bores/study.toml")).unwrap();
    let scene = study.scene().unwrap();
    let heat = |name: &str| {
        let index = scene.features.iter().position(|feature| feature.name == name).unwrap();
        data["heat"][0][index].as_u64().unwrap()
    };
    assert_eq!(heat("housing.bore2"), 4);
    assert!(heat("housing.bore1") < 3);
    assert_eq!(heat("housing.A"), 0);
    let bores = wide(&page).matches("class=\"round h4\"").count();
    // A cylinder has two rings, and the shaft none of this thickness.
    assert_eq!(bores, 2);
}

#[test]
fn the_terminal_lists_features_with_their_contributions() {
    let study = Study::read(&repository("examples/locating-plate/study.toml")).unwrap();
    let analysis = analyze(&study.problem, &study.options).unwrap();
    let about = About { scene: study.scene(), ..About::default() };
    let report = Report::of(&study.problem, &analysis, about);
    let shown = text(&report.document(), Style { detail: Detail::Full, unicode: true, color: false, width: 100 });
    // The table of features follows that of dimensions.
    let mut features = shown.lines().skip_while(|line| !line.contains("by feature"));
    let drill = features.find(|line| line.trim_start().starts_with("plate.drill")).unwrap_or_default();
    // Of x, with the slopes of the closed form: px and hx have 1, hy, py, qy and sy the arm of 40 mm over 100 mm.
    let [a, b, c] = [0.015f64, 0.02, 0.05].map(|tolerance| (tolerance / 3.0).powi(2));
    let whole = a + 2.0 * 0.16 * a + b + 2.0 * 0.16 * b + c;
    let found: f64 = drill.split_whitespace().last().unwrap().parse().unwrap();
    close(found, 100.0 * c / whole, 0.05, 100.0);
}
