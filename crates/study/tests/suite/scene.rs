//! Scenes of assemblies in space: places, extents, marks of measures, owners of dimensions and displacements, by hand.

use sensitol::assembly::{Points, Run};
use sensitol_study::{AssemblyScene, DimensionOwner, FeatureOutline, MeasureMark, SceneFeature, Study};
use sensitol_testing::{close, parse, repository};

fn study(name: &str) -> Study {
    Study::read(&repository(&format!("examples/{name}.toml"))).unwrap()
}

fn feature<'s>(scene: &'s AssemblyScene, name: &str) -> &'s SceneFeature {
    scene.features.iter().find(|feature| feature.name == name).unwrap()
}

/// Coordinates by hand have the rounding of a few operations on numbers up to 200.
fn near(found: [f64; 3], expected: [f64; 3]) {
    found.iter().zip(expected).for_each(|(found, expected)| close(*found, expected, 1e-9, 1.0));
}

/// Owner of a dimension of a study.
fn owner(study: &Study, scene: &AssemblyScene, dimension: &str) -> DimensionOwner {
    let index = study.problem.dimensions().iter().position(|one| one.name() == dimension).unwrap();
    scene.owners[index].clone()
}

fn index(scene: &AssemblyScene, name: &str) -> usize {
    scene.features.iter().position(|feature| feature.name == name).unwrap()
}

#[test]
fn features_of_a_crank_slider_are_at_their_places() {
    let scene = study("crank-slider-space/study").scene().unwrap();
    let (sine, cosine) = (libm::sin(35f64.to_radians()), libm::cos(35f64.to_radians()));
    let ball = [15.0 * cosine, 15.0 * sine, 20.0];
    near(feature(&scene, "crank.ball").origin, ball);
    near(feature(&scene, "link.small").origin, ball);
    // The other end is 60 away, at y = 5 and z = 8.
    let along = (60.0f64 * 60.0 - (ball[1] - 5.0).powi(2) - 12.0 * 12.0).sqrt();
    let end = [ball[0] + along, 5.0, 8.0];
    near(feature(&scene, "slider.ball").origin, end);
    near(feature(&scene, "crank.hub").axes[0], [cosine, sine, 0.0]);
    let takes: Vec<usize> = scene.joints.iter().map(|joint| joint.freedoms.len()).collect();
    assert_eq!(takes, [5, 1, 3, 3, 5]);
    near(scene.joints[2].at, ball);
    let MeasureMark::Line { of, from, witness } = scene.measures[0].mark else { panic!("{:?}", scene.measures[0]) };
    near(of, end);
    near(from, [0.0, 5.0, 8.0]);
    near(witness, [0.0; 3]);
    assert_eq!(scene.measured, [[0]]);
}

#[test]
fn outlines_have_the_extents_of_the_drawing() {
    let scene = study("shaft-two-bores/study").scene().unwrap();
    let outline = |name: &str| feature(&scene, name).outline;
    assert_eq!(outline("housing.A"), FeatureOutline::Rectangle(Some([120.0, 60.0])));
    assert_eq!(outline("housing.C"), FeatureOutline::Disc(36.0));
    assert_eq!(outline("housing.bore1"), FeatureOutline::Cylinder { diameter: Some(20.0), length: Some(25.0) });
    assert_eq!(outline("shaft.journal"), FeatureOutline::Cylinder { diameter: Some(20.0), length: None });
    assert_eq!(outline("shaft.collar"), FeatureOutline::Rectangle(None));
    assert_eq!(outline("shaft.tip"), FeatureOutline::Ball(None));
    assert_eq!(outline("housing.frame"), FeatureOutline::Triad);
    near(feature(&scene, "shaft.tip").origin, [127.5, 0.0, 50.0]);
    assert!(scene.parts[0].ground && !scene.parts[1].ground);
}

#[test]
fn lengths_are_in_one_unit_where_formulas_convert() {
    let text = r#"
        units = "convert"
        [dimensions]
        h = { nominal = 1.2, tolerance = 0.01, unit = "cm" }
        w = { nominal = 80, tolerance = 0.1, unit = "mm" }
        [parts.table]
        top = { plane = [0, 0, 0], normal = "z", size = ["w", 5] }
        [parts.block]
        foot = { plane = [0, 0, "-h"], normal = "-z" }
        lid = { plane = [0, 0, 0.5], normal = "z" }
        [joints]
        seat = { on = "table.top", against = "block.foot" }
        [characteristics]
        height = { of = "block.lid", from = "table.top", unit = "mm" }
    "#;
    let study = parse(text).unwrap();
    let scene = study.scene().unwrap();
    assert_eq!(scene.length_unit.as_deref(), Some("cm"));
    near(feature(&scene, "block.lid").origin, [0.0, 0.0, 1.7]);
    let FeatureOutline::Rectangle(Some(size)) = feature(&scene, "table.top").outline else { panic!("{scene:?}") };
    close(size[0], 8.0, 1e-12, 1.0);
    close(size[1], 5.0, 1e-12, 1.0);
    let points = Points::from_rows(&[[1.25, 80.0]]);
    let found = study.scene_deviations(&points, &Run::to_the_end()).unwrap().unwrap();
    near(found[0].as_ref().unwrap().features[2].displacement, [0.0, 0.0, 0.05]);
}

#[test]
fn dimensions_belong_to_the_features_that_use_them() {
    let two_bores = study("shaft-two-bores/study");
    let scene = two_bores.scene().unwrap();
    let of = |name: &str| DimensionOwner::Feature(index(&scene, name));
    for (dimension, feature) in [
        ("d", "shaft.journal"),
        ("L", "shaft.tip"),
        ("w", "housing.B"),
        ("housing.B.tilt", "housing.B"),
        ("housing.bore1.end1_x", "housing.bore1"),
        ("housing.bore2.at_y", "housing.bore2"),
        ("shaft.tip.at_x", "shaft.tip"),
    ] {
        assert_eq!(owner(&two_bores, &scene, dimension), of(feature), "{dimension}");
    }
    assert_eq!(owner(&two_bores, &scene, "second.float.unit_y"), DimensionOwner::Joint(1));
    let features = ["housing.C", "housing.bore1", "housing.bore2"].map(|name| index(&scene, name)).to_vec();
    assert_eq!(owner(&two_bores, &scene, "h"), DimensionOwner::Shared { name: "h".into(), features });

    let platform = study("six-legged-platform/study");
    let scene = platform.scene().unwrap();
    assert_eq!(owner(&platform, &scene, "l4"), DimensionOwner::Joint(3));
    assert!(scene.joints[3].is_rod);

    // A dimension of a formula belongs to no feature, and a formula shows the measures that it uses.
    let blocks = study("stacked-blocks-loops/bodies");
    let scene = blocks.scene().unwrap();
    assert_eq!(owner(&blocks, &scene, "f"), DimensionOwner::Formula);
    assert_eq!(owner(&blocks, &scene, "a"), DimensionOwner::Feature(index(&scene, "frame.wall")));
    assert_eq!(scene.measured, [[0], [0]]);
}

#[test]
fn formulas_between_a_feature_and_a_dimension_are_followed() {
    let text = r#"
        [dimensions]
        a = { nominal = 10, tolerance = 0.1 }
        b = { nominal = 3, tolerance = 0.1 }
        [formulas]
        sum = "a + b"
        top = "sum"
        [parts.table]
        face = { plane = [0, 0, "top"], normal = "z" }
        [parts.block]
        foot = { plane = [0, 0, 0], normal = "-z" }
        lid = { plane = [0, 0, "2*b"], normal = "z" }
        [joints]
        seat = { on = "table.face", against = "block.foot" }
        [characteristics]
        height = { of = "block.lid", from = "table.face" }
    "#;
    let study = parse(text).unwrap();
    let scene = study.scene().unwrap();
    assert_eq!(scene.owners[0], DimensionOwner::Feature(0));
    assert_eq!(scene.owners[1], DimensionOwner::Shared { name: "b".into(), features: vec![0, 2] });
}

#[test]
fn a_roller_touches_hub_and_ring() {
    let scene = study("one-way-clutch/bodies").scene().unwrap();
    let roller = feature(&scene, "roller.body").origin;
    // The roller lies on the hub, and its axis is a radius of the ring less its own away from the middle.
    close(roller[2], 27.645 + 11.43, 1e-9, 1.0);
    close(libm::hypot(roller[0], roller[2]), 50.8 - 11.43, 1e-9, 1.0);
    near(scene.joints[0].at, [roller[0], roller[1], 27.645]);
    let at = scene.joints[1].at;
    close(libm::hypot(at[0], at[2]), 50.8, 1e-9, 1.0);
    close(at[0] * roller[2], at[2] * roller[0], 1e-9, 1e3);
}

#[test]
fn a_plate_tilts_with_its_pads() {
    let plate = study("locating-plate/study");
    let scene = plate.scene().unwrap();
    let mut point: Vec<f64> = plate.problem.dimensions().iter().map(|one| one.nominal()).collect();
    let rise = 0.1;
    point[0] += rise;
    let found = plate.scene_deviations(&Points::from_rows(&[point]), &Run::to_the_end()).unwrap().unwrap();
    let deviation = found[0].as_ref().unwrap();
    // The plane through the pads at (20, 10), (140, 10), (80, 90) of heights 0.1, 0, 0 at the corner (160, 0). Second-order terms are of
    // the order of the rise times the tilt, 1e-4.
    let corner = rise * (1.0 - 140.0 / 120.0 + 10.0 * 0.5 / 80.0);
    let moved = deviation.features[index(&scene, "plate.corner")];
    close(moved.displacement[2], corner, 2e-4, 1.0);
    // About y it turns by the slope along x, about x by the slope along y.
    close(moved.rotation[1], rise / 120.0, 1e-6, 1.0);
    close(moved.rotation[0], -rise * 0.5 / 80.0, 1e-6, 1.0);
    // The pad itself moves in its part, which stands still.
    near(deviation.features[0].displacement, [0.0, 0.0, rise]);
    near(deviation.parts[0].displacement, [0.0; 3]);
}

#[test]
fn a_study_without_parts_has_no_scene() {
    let plain = study("first-study/study");
    assert!(plain.scene().is_none());
    assert!(plain.scene_deviations(&Points::from_rows(&[[0.0]]), &Run::to_the_end()).unwrap().is_none());
}
