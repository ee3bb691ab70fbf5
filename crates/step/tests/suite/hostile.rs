//! Damaged and hostile files: one error, no panic, no endless search.

use std::sync::LazyLock;

use proptest::prelude::*;

use super::files::bytes;
use sensitol_step::part21::EntityTable;
use sensitol_step::semantic::StepModel;
use sensitol_step::tables::{TableRequest, tables_of};

const HEAD: &str = "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nENDSEC;\nDATA;\n";
const TAIL: &str = "ENDSEC;\nEND-ISO-10303-21;\n";

/// Text of the error of a file with these entities, or "read".
fn outcome(entities: &str) -> String {
    outcome_of(format!("{HEAD}{entities}\n{TAIL}").as_bytes())
}

fn outcome_of(bytes: &[u8]) -> String {
    let request = TableRequest { joints: true, ..TableRequest::default() };
    match tables_of(bytes, &request) {
        Ok(_) => "read".to_owned(),
        Err(error) => error.to_string(),
    }
}

#[test]
fn every_damage_has_its_message() {
    let cases = [
        (outcome_of(b"PK\x03\x04 zip"), "compressed: unpack it"),
        (outcome_of(b"\x1f\x8b gz"), "compressed: unpack it"),
        (outcome_of(b"solid cube"), "does not begin with ISO-10303-21: export"),
        (outcome_of(b""), "does not begin with ISO-10303-21"),
        (outcome("#1=A();\n#1=B();"), "line 7: #1 is defined twice"),
        (outcome("#1=A(;"), "no semantic tolerances"),
        (outcome("#1 A();"), "line 6: expected `=` after the number of an entity, found `A();`"),
        (outcome("#1=;"), "line 6: expected the type of an entity"),
        (outcome("point"), "line 6: expected an entity such as #1=POINT(), found `point`"),
        (outcome("#99999999999999999999=A();"), "line 6: expected a number below 2^64"),
        (outcome("#1=A('it"), "END-ISO-10303-21: it was cut off"),
        (outcome("#1=A(/* "), "END-ISO-10303-21: it was cut off"),
        (
            outcome_of(format!("{HEAD}{TAIL}").replace("DATA", "ANCHOR").as_bytes()),
            "a section ANCHOR is of Part 21 edition 3",
        ),
        (outcome("#1=FLATNESS_TOLERANCE('','',#2,#3);"), "line 6: #1 refers to #2, which is not in the file"),
        (outcome("#1=FLATNESS_TOLERANCE('','',#,#3);"), "line 6: expected a number after `#`"),
        (outcome("#1=FLATNESS_TOLERANCE('','',1.5.5,#3);"), "line 6: expected a number"),
        (outcome("#1=DATUM('','',$,.F.,'A' 'B');"), "line 6: expected `,` or `)`"),
        (
            outcome(&format!("#1=DATUM({}1{});", "(".repeat(9000), ")".repeat(9000))),
            "#1 has lists inside lists, more than 32 deep",
        ),
    ];
    for (found, expected) in cases {
        assert!(found.contains(expected), "{found:?} lacks {expected:?}");
        assert!(!found.contains('\n'), "{found}");
    }
}

#[test]
fn cycles_end() {
    // An assembly that contains itself, alone and below another one.
    let uses = |pairs: &[(u64, u64)]| {
        let lines = pairs.iter().enumerate().map(|(index, (above, part))| {
            format!("#{}=NEXT_ASSEMBLY_USAGE_OCCURRENCE('','','',#{above},#{part},$);", 100 + index)
        });
        lines.collect::<Vec<_>>().join("\n")
    };
    let parts =
        "#1=PRODUCT_DEFINITION('','',$,$);\n#2=PRODUCT_DEFINITION('','',$,$);\n#3=PRODUCT_DEFINITION('','',$,$);\n";
    let alone = outcome(&format!("{parts}{}", uses(&[(1, 2), (2, 1)])));
    assert!(alone.contains("line 6: assembly #1 contains itself"), "{alone}");
    let below = outcome(&format!("{parts}{}", uses(&[(3, 1), (1, 2), (2, 1)])));
    assert!(below.contains("contains itself"), "{below}");
    // Aspects that relate to each other in a ring, and a unit that is defined by itself.
    let ring = "#1=FLATNESS_TOLERANCE('','',#5,#2);\n#2=SHAPE_ASPECT('','',$,.T.);\n#3=SHAPE_ASPECT('','',$,.T.);\n\
                #4=SHAPE_ASPECT_RELATIONSHIP('','',#2,#3);\n#7=SHAPE_ASPECT_RELATIONSHIP('','',#3,#2);\n\
                #5=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(0.1),#6);\n#6=(CONVERSION_BASED_UNIT('U',#5)LENGTH_UNIT()NAMED_UNIT(*));";
    assert_eq!(outcome(ring), "read");
}

/// Every level has two of the next: 2^40 parts from 40 lines. And a million references in one list, a thousand times.
#[test]
fn small_files_do_not_grow() {
    let mut text = String::new();
    for level in 1..=40 {
        text += &format!("#{level}=PRODUCT_DEFINITION('','',$,$);\n");
        for half in 0..2 {
            let id = 100 + 2 * level + half;
            text += &format!("#{id}=NEXT_ASSEMBLY_USAGE_OCCURRENCE('','','',#{level},#{},$);\n", level + 1);
        }
    }
    text += "#41=PRODUCT_DEFINITION('','',$,$);\n";
    assert!(outcome(&text).contains("more than 10000 placed parts"), "{}", outcome(&text));
    let loops: String = (0..1000).map(|index| format!("#{}=FACE_BOUND('',#5000,.T.);\n", 10_000 + index)).collect();
    let bounds = (0..1000).map(|index| format!("#{}", 10_000 + index)).collect::<Vec<_>>().join(",");
    let faces: String = (0..1000)
        .map(|index| {
            format!(
                "#{}=ADVANCED_FACE('',({bounds}),#5002,.T.);\n#{}=GEOMETRIC_ITEM_SPECIFIC_USAGE('','',#5003,$,#{0});\n",
                20_000 + index,
                30_000 + index
            )
        })
        .collect();
    let edges = vec!["#5001"; 100_000].join(",");
    let text = format!(
        "{loops}{faces}#5000=EDGE_LOOP('',({edges}));\n#5001=UNKNOWN_THING('',$);\n#5002=PLANE('',$);\n\
         #5003=SHAPE_ASPECT('','',$,.T.);\n#5004=FLATNESS_TOLERANCE('','',$,#5003);\n"
    );
    let found = outcome(&text);
    assert!(found.contains("lead to more than 20000000 entities"), "{found}");
}

/// A file that is cut off anywhere has one message.
#[test]
fn truncated_files_say_so() {
    let whole = bytes("nist_ctc_01_asme1_ap242-e1");
    let end = whole.windows(16).rposition(|window| window == b"END-ISO-10303-21").unwrap();
    let places = (1..end).step_by(end / 400).chain((end - 200)..end).chain(1..200);
    for place in places {
        let found = EntityTable::read(&whole[..place]).unwrap_err().to_string();
        assert!(found.contains("it was cut off"), "cut at {place}: {found}");
    }
}

/// Files that are changed.
const CHANGED: [&str; 3] = ["nist_ctc_01_asme1_ap242-e1", "nist_ctc_03_asme1_ap242-e2", "nist_stc_06_asme1_ap242-e3"];

fn cut_and_changed() -> impl Strategy<Value = Vec<u8>> {
    let changes = prop::collection::vec((0.0..1.0f64, any::<u8>(), 0..4usize), 1..12);
    (prop::sample::select(&CHANGED[..]), changes).prop_map(|(name, changes)| {
        let mut found = LINES.iter().find(|(known, _)| *known == name).unwrap().1.clone();
        for (place, byte, kind) in changes {
            let at = ((found.len() - 1) as f64 * place) as usize;
            match kind {
                0 => found[at] = byte,
                1 => found.insert(at, byte),
                2 => _ = found.remove(at),
                // Another number of an entity, where there is one.
                _ => {
                    let digit = found[at..].iter().position(u8::is_ascii_digit).map_or(at, |more| at + more);
                    found[digit] = b'0' + byte % 10;
                }
            }
        }
        found
    })
}

/// Semantic lines of the files that are changed.
static LINES: LazyLock<Vec<(&str, Vec<u8>)>> =
    LazyLock::new(|| CHANGED.into_iter().map(|name| (name, semantic_lines(name))).collect());

/// A file without the drawn annotations, so that changes meet entities that are read.
fn semantic_lines(name: &str) -> Vec<u8> {
    let bytes = bytes(name);
    let text: String = bytes.iter().map(|&byte| char::from(byte)).collect();
    let statements = text.split_inclusive(";\n");
    let drawn = ["TESSELLATED", "COORDINATES_LIST", "TRIANGULATED", "STYLE", "ANNOTATION", "POLYLINE", "COLOUR"];
    let kept = statements.filter(|statement| !drawn.iter().any(|word| statement.contains(word)));
    kept.collect::<String>().into_bytes()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]
    #[test]
    fn no_change_of_a_file_panics(bytes in cut_and_changed()) {
        let found = outcome_of(&bytes);
        prop_assert!(!found.is_empty() && !found.contains('\n'));
        if let Ok(table) = EntityTable::read(&bytes) {
            let _ = StepModel::read(&table, true);
        }
    }
}
