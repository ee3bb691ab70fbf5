//! Counts of entities in the NIST files.
//!
//! Oracle: `tests/data/counts.json`, counted by a plain-text reader in Python that shares no code with this package. All counts are exact.

use std::collections::BTreeMap;

use serde_json::Value;

use super::files::bytes;
use sensitol_step::part21::EntityTable;
use sensitol_step::semantic::{DatumReference, MaterialCondition, StepModel, StepUnit, ToleranceKind, ZoneShape};

fn model(name: &str) -> StepModel {
    let bytes = bytes(name);
    let table = EntityTable::read(&bytes).unwrap();
    StepModel::read(&table, false).unwrap()
}

/// Name of a kind as the oracle writes it.
fn oracle_name(kind: ToleranceKind) -> String {
    let entity = ToleranceKind::ENTITIES.iter().find(|(_, one)| *one == kind).unwrap().0;
    let words = entity.trim_end_matches("_TOLERANCE").split('_');
    words.map(|word| format!("{}{}", &word[..1], word[1..].to_lowercase())).collect::<Vec<_>>().join("_")
}

#[test]
fn counts_of_all_files_are_exact() {
    let all: Value = serde_json::from_str(include_str!("../data/counts.json")).unwrap();
    let all = all.as_array().unwrap();
    assert_eq!(all.len(), 6);
    for expected in all {
        let name = expected["file"].as_str().unwrap();
        let model = model(name);
        let [part] = &model.parts[..] else { panic!("{name} has one part") };
        let mut by_type: BTreeMap<String, u64> = BTreeMap::new();
        part.tolerances.iter().for_each(|tolerance| *by_type.entry(oracle_name(tolerance.kind)).or_default() += 1);
        let expected_types: BTreeMap<String, u64> = serde_json::from_value(expected["by_type"].clone()).unwrap();
        assert_eq!(by_type, expected_types, "{name}");
        let found = [
            ("dims", part.dimensions.len()),
            ("with_value", part.dimensions.iter().filter(|one| one.value.is_some()).count()),
            ("plus_minus", part.dimensions.iter().filter(|one| one.has_plus_minus).count()),
            ("tolerances", part.tolerances.len()),
            ("complete", part.tolerances.iter().filter(|one| one.is_complete()).count()),
            ("datums", part.datums.len()),
            (
                "letters_with_feature",
                part.datums.iter().filter(|one| !one.faces.is_empty() || !one.targets.is_empty()).count(),
            ),
        ];
        for (key, count) in found {
            assert_eq!(Some(count as u64), expected[key].as_u64(), "{name}: {key}");
        }
    }
}

/// The two tolerances without a face: in the text, #957 of ctc_05 names a TRIMMED_CURVE, and no usage names the aspect of #348 of ftc_06.
#[test]
fn tolerances_without_a_face_are_those_of_the_text() {
    let incomplete = |name: &str| {
        let all = model(name).parts.remove(0).tolerances;
        all.into_iter().filter(|one| !one.is_complete()).map(|one| (one.entity, one.other)).collect::<Vec<_>>()
    };
    assert_eq!(incomplete("nist_ctc_05_asme1_ap242-e1"), [(957, Some((3891, "TRIMMED_CURVE".to_owned())))]);
    assert_eq!(incomplete("nist_ftc_06_asme1_ap242-e2"), [(348, None)]);
}

/// 60 TESSELLATED_ANNOTATION_OCCURRENCE stand in the text, and no tolerance.
#[test]
fn drawn_annotations_are_counted() {
    let model = model("nist_ftc_08_asme1_ap242-e1-tg");
    assert_eq!((model.tolerance_count(), model.annotations), (0, 60));
}

/// Values, units, modifiers and zones of single entities, as read in the text by eye.
#[test]
fn single_entities_are_read_whole() {
    let part = model("nist_stc_06_asme1_ap242-e3").parts.remove(0);
    let tolerance = |id: u64| part.tolerances.iter().find(|one| one.entity == id).unwrap();
    let letters = |one: &DatumReference| one.letters.concat();
    let hole = tolerance(10006);
    // 0.025 inch at maximum material, to C, A and B, in a cylindrical zone, on a composite group of two groups of two faces.
    let value = hole.value.unwrap();
    assert_eq!((value.value, value.unit), (0.025, StepUnit::Length(0.0254)));
    assert_eq!(
        (hole.condition, &hole.zone, hole.faces.len()),
        (Some(MaterialCondition::Maximum), &ZoneShape::Cylinder, 4)
    );
    assert_eq!(hole.datums.iter().map(letters).collect::<Vec<_>>(), ["C", "A", "B"]);
    assert_eq!(tolerance(10803).zone, ZoneShape::Sphere);
    // The lower segment of a composite frame.
    assert_eq!((tolerance(9773).upper, tolerance(9761).upper), (Some(9761), None));
    let shaft = model("nist_ctc_05_asme1_ap242-e1").parts.remove(0);
    assert_eq!(shaft.unit, StepUnit::Length(0.0254));
    let runout = shaft.tolerances.iter().find(|one| one.entity == 946).unwrap();
    assert_eq!(runout.datums[0].letters, ["A", "B"], "a common datum");
    let target = &shaft.datums.iter().find(|datum| datum.letter == "C").unwrap().targets[0];
    assert_eq!(target.placement.unwrap().place, [10.375, 0.0, 1.175]);
    let sizes: Vec<f64> = target.sizes.iter().map(|(_, size)| size.value).collect();
    assert_eq!(sizes, [1.25, 2.0]);
    let sheet = model("nist_ftc_11_asme1_ap242-e2").parts.remove(0);
    assert!(sheet.tolerances.iter().all(|one| one.modifiers == ["FREE_STATE"]));
}
