//! Random assemblies: determined, under-constrained and over-constrained ones are named as such.
//!
//! In an open chain every joint is independent of the others, so that the number of free motions is 6 for every part that moves less the
//! freedoms that the joints take (Grübler). A second joint between the features of another one repeats it.

use proptest::prelude::*;
use sensitol_study::Study;
use sensitol_testing::parse;

/// Joints between two features `a` of the part before and `b` of the part, with the freedoms that each takes. Features lie at one place.
const KINDS: [(&str, usize); 9] = [
    ("revolute = [\"A.f\", \"B.f\"]", 5),
    ("slide = [\"A.f\", \"B.f\"]", 5),
    ("rigid = [\"A.f\", \"B.f\"]", 6),
    ("ball = \"A.p\", socket = \"B.p\"", 3),
    ("hole = \"A.a\", pin = \"B.a\"", 4),
    ("hole = \"A.a\", pin = \"B.a\", takes = 2", 2),
    ("hole = \"A.a\", ball = \"B.p\"", 2),
    ("on = \"A.up\", against = \"B.down\"", 3),
    ("slot = \"A.f\", pin = \"B.a\"", 2),
];

/// Words for axes, and another axis that is perpendicular.
const AXES: [[&str; 2]; 6] = [["x", "y"], ["-x", "z"], ["y", "z"], ["-y", "x"], ["z", "x"], ["-z", "y"]];

/// A chain of parts: kind of joint, axis and place of every link.
type Chain = Vec<(usize, usize, [i32; 3])>;

fn chains() -> impl Strategy<Value = Chain> {
    prop::collection::vec((0..KINDS.len(), 0..AXES.len(), prop::array::uniform3(-40i32..40)), 1..5)
}

fn opposite(axis: &str) -> String {
    axis.strip_prefix('-').map_or_else(|| format!("-{axis}"), str::to_owned)
}

/// Text of a chain with further joints and characteristics. Every part has the features by which it is joined on either side.
fn text(chain: &Chain, more: &str, characteristics: &str) -> String {
    let mut text = "[dimensions]\nt = { nominal = 3, tolerance = 0.1 }\n".to_owned();
    let features = |prefix: &str, (_, axis, place): &(usize, usize, [i32; 3])| {
        let ([z, x], place) = (AXES[*axis], format!("{place:?}"));
        format!(
            "{prefix}f = {{ frame = {place}, z = \"{z}\", x = \"{x}\" }}\n{prefix}p = {{ point = {place} }}\n\
             {prefix}a = {{ axis = {place}, along = \"{z}\" }}\n{prefix}up = {{ plane = {place}, normal = \"{z}\" }}\n\
             {prefix}down = {{ plane = {place}, normal = \"{}\" }}\n",
            opposite(z)
        )
    };
    for part in 0..=chain.len() {
        text += &format!("[parts.q{part}]\n");
        if part > 0 {
            text += &features("in_", &chain[part - 1]);
        }
        if let Some(link) = chain.get(part) {
            text += &features("out_", link);
        }
        text += "tip = { point = [\"90 + t\", 71, 83] }\nmark = { frame = [0, 0, 0], z = \"z\", x = \"x\" }\n";
    }
    text += "[joints]\n";
    for (index, link) in chain.iter().enumerate() {
        text += &format!("j{index} = {{ {} }}\n", joint(link, index));
    }
    text + more + "[characteristics]\n" + characteristics
}

fn joint(link: &(usize, usize, [i32; 3]), index: usize) -> String {
    let (a, b) = (format!("\"q{index}.out_"), format!("\"q{}.in_", index + 1));
    KINDS[link.0].0.replace("\"A.", &a).replace("\"B.", &b)
}

fn taken(chain: &Chain) -> usize {
    chain.iter().map(|link| KINDS[link.0].1).sum()
}

/// A measure within one part, which no motion changes.
const UNFELT: &str = "y = { of = \"q1.tip\", from = \"q1.mark\", along = \"x\" }\n";

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_chain_has_the_free_motions_that_its_joints_leave(chain in chains()) {
        let study = parse(&text(&chain, "", UNFELT)).unwrap();
        let mobility = study.mobility.unwrap();
        prop_assert_eq!(mobility.unknowns, 6 * chain.len());
        prop_assert_eq!(mobility.equations, taken(&chain));
        prop_assert_eq!(mobility.free.len(), 6 * chain.len() - taken(&chain));
        // Each free motion names a part of the assembly.
        for motion in &mobility.free {
            prop_assert!(motion.starts_with('q'), "{}", motion);
        }
    }

    #[test]
    fn a_motion_that_a_measure_feels_is_an_error(chain in chains(), turned in 0usize..6) {
        // The last part turns about an axis through the origin, and its tip is far from each of them.
        let mut chain = chain;
        chain.push((0, turned, [0, 0, 0]));
        let last = chain.len();
        // The turn moves the tip across the axis, so one of the other two coordinates feels it.
        let along = if AXES[turned][0].ends_with('z') { "x" } else { "z" };
        let felt = format!("y = {{ of = \"q{last}.tip\", from = \"q0.mark\", along = \"{along}\" }}\n");
        let error = parse(&text(&chain, "", &felt)).unwrap_err();
        prop_assert_eq!(&error.key, "characteristics.y");
        let said = error.to_string();
        prop_assert!(said.contains("`y` depends on it") && said.contains("add a joint that stops it"), "{}", said);
    }

    #[test]
    fn a_joint_that_repeats_another_is_an_error(chain in chains(), which in 0usize..4) {
        let which = which % chain.len();
        let again = format!("again = {{ {} }}\n", joint(&chain[which], which));
        let error = parse(&text(&chain, &again, UNFELT)).unwrap_err();
        prop_assert_eq!(&error.key, "joints.again");
        let (takes, equations) = (KINDS[chain[which].0].1, taken(&chain) + KINDS[chain[which].0].1);
        let said = error.message();
        let expected = format!("joint `again` takes {takes}, and only 0 of these are free after");
        prop_assert!(said.starts_with(&expected), "{}", said);
        let numbers = format!("{equations} equations for {} unknowns, rank {}", 6 * chain.len(), taken(&chain));
        prop_assert!(said.ends_with(&numbers), "{}", said);
    }
}

/// A determined chain of rigid joints is a study without free motions.
#[test]
fn rigid_parts_have_no_free_motion() {
    let chain: Chain = vec![(2, 0, [1, 2, 3]), (2, 4, [4, -5, 6])];
    let study: Study =
        parse(&text(&chain, "", "y = { of = \"q2.tip\", from = \"q0.mark\", along = \"x\" }\n")).unwrap();
    assert!(study.mobility.unwrap().free.is_empty());
}
