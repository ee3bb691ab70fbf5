//! Derivatives of every row of the joint table against differences, and choices of the closure.

use crate::assembly::{
    Assembly, Direction, Feature, FeatureId, FeatureKind, JointKind, PartJoint, Quantity, RigidPart,
};
use crate::closure::{Closure, constant_rotation};
use crate::joint::JOINTS;
use crate::placement::{product, rotation_vector};

/// A feature in a general place, whose numbers follow from a seed.
fn feature(kind: FeatureKind, seed: f64) -> Feature {
    let number = |k: f64| Quantity::constant(libm::sin(seed * 7.3 + k * 2.9) * 20.0);
    Feature {
        name: format!("f{seed}"),
        kind,
        origin: [number(1.0), number(2.0), number(3.0)],
        z: Direction::Along([number(4.0), number(5.0), number(6.0)]),
        x: None,
        diameter: Some(Quantity::constant(3.0 + seed)),
        shift: Some([0.1, -0.2, 0.3].map(Quantity::constant)),
        tilt: Some([0.02, 0.01, -0.03].map(Quantity::constant)),
    }
}

fn pair(kind: JointKind, kinds: [FeatureKind; 2]) -> Assembly {
    let part = |name: &str, ground, kind, seed: f64| RigidPart {
        name: name.into(),
        ground,
        at: if ground { [0.0; 3] } else { [5.0, -9.0, 14.0] },
        turned: if ground { [0.0; 3] } else { [0.4, -0.3, 0.6] },
        features: vec![feature(kind, seed)],
    };
    Assembly {
        parts: vec![part("a", true, kinds[0], 1.0), part("b", false, kinds[1], 2.0)],
        joints: vec![PartJoint {
            name: "joint".into(),
            kind,
            between: [FeatureId { part: 0, feature: 0 }, FeatureId { part: 1, feature: 0 }],
            takes: None,
            value: Some(Quantity::constant(0.7)),
            offset: Some([0.1, 0.2].map(Quantity::constant)),
            tilt: Some([0.03, -0.02].map(Quantity::constant)),
            side_by_side: false,
            press: None,
        }],
        measures: Vec::new(),
        length_unit: None,
        shown_unit: None,
    }
}

/// Every row of the joint table, both ways round where the features differ.
#[test]
fn derivatives_are_those_of_differences() {
    // Truncation and rounding are then of one order.
    const STEP: f64 = 1e-6;
    for row in &JOINTS {
        for (first, second, takes) in row.fits {
            let assembly = pair(row.kind, [first[0], second[0]]);
            let mut closure = Closure::new(&assembly);
            closure.used = vec![(0..takes[0]).collect()];
            let linear = closure.linear();
            assert_eq!(linear.residuals.len(), takes[0], "{:?}", row.kind);
            let places = closure.places.clone();
            for column in 0..6 {
                let mut residuals = Vec::new();
                for sign in [1.0, -1.0] {
                    let mut step = [0.0; 6];
                    step[column] = sign * STEP;
                    closure.places.clone_from(&places);
                    closure.advance(&step, 1.0);
                    residuals.push(closure.linear().residuals);
                }
                closure.places.clone_from(&places);
                for (i, (up, down)) in residuals[0].iter().zip(&residuals[1]).enumerate() {
                    let difference = (up - down) / (2.0 * STEP);
                    // The difference has an error of the third derivative, some 1e-11, and of rounding, some 1e-10.
                    let off = (linear.jacobian[(i, column)] - difference).abs();
                    assert!(off < 5e-9, "{:?} row {i} column {column}: {difference}", row.kind);
                }
            }
        }
    }
}

#[test]
fn a_rotation_vector_comes_back() {
    for vector in [[0.0; 3], [1e-9, 0.0, 2e-9], [0.3, -0.5, 0.8], [-1.0, 2.0, 1.5], [0.0, 3.1, 0.0]] {
        let found = rotation_vector(&constant_rotation(vector));
        for i in 0..3 {
            assert!((found[i] - vector[i]).abs() < 1e-12, "{vector:?}: {found:?}");
        }
        let back = vector.map(|part: f64| -part);
        let still = product(&constant_rotation(vector), &constant_rotation(back));
        assert!((0..3).all(|i| (0..3).all(|j| (still[i][j] - f64::from(u8::from(i == j))).abs() < 1e-14)));
    }
}
