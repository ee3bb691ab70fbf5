//! Zones of three coordinates: points of the maps have the moments of the zone, of two coordinates too.

use std::sync::Arc;

use sensitol_numeric::correlation::{Block, Correlation, JointLaw, SolidShape, SolidZone};
use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::distribution::{Beta, Distribution, SolidAxis, SolidCoordinate, behind_normal, standard_normal};
use sensitol_testing::close;

/// Distribution of a coordinate of a zone.
fn coordinate(shape: SolidShape, coordinate: usize) -> Arc<dyn Distribution> {
    match (shape, coordinate) {
        (SolidShape::Ball, _) => Arc::new(Beta::about(0.0, 1.0, 2.0, 2.0).unwrap()),
        (SolidShape::Bicone, 1 | 2) => Arc::new(SolidCoordinate::about(SolidAxis::Bicone, 0.0, 1.0).unwrap()),
        _ => Arc::new(SolidCoordinate::about(SolidAxis::Octahedron, 0.0, 1.0).unwrap()),
    }
}

/// Distance from the middle at which a point leaves the zone.
fn reach(shape: SolidShape, [x, y, z]: [f64; 3]) -> f64 {
    match shape {
        SolidShape::Octahedron => x.abs() + y.abs() + z.abs(),
        SolidShape::Bicone => x.abs() + y.hypot(z),
        SolidShape::Ball => (x * x + y * y + z * z).sqrt(),
    }
}

/// Squares and their products over the zone: integrals of Dirichlet for the octahedron, of powers of the radius for the others.
fn squares(shape: SolidShape) -> ([f64; 3], [f64; 3]) {
    match shape {
        SolidShape::Octahedron => ([0.1; 3], [1.0 / 210.0; 3]),
        SolidShape::Bicone => ([0.1, 0.15, 0.15], [1.0 / 140.0, 1.0 / 140.0, 1.0 / 56.0]),
        SolidShape::Ball => ([0.2; 3], [1.0 / 35.0; 3]),
    }
}

/// Normal variables at the middles of this many equal shares.
fn middles(count: usize) -> Vec<f64> {
    (0..count).map(|i| standard_normal::quantile((i as f64 + 0.5) / count as f64)).collect()
}

#[test]
fn points_of_a_solid_have_its_moments() {
    // The maps are roots at the ends, up to cube roots, so that the midpoint rule of 60 places has an error of the order of 60^(-4/3), 0.4 %,
    // times some three.
    const PLACES: usize = 60;
    let normals = middles(PLACES);
    for shape in [SolidShape::Octahedron, SolidShape::Bicone, SolidShape::Ball] {
        let block = Block { members: vec![0, 1, 2], law: JointLaw::Solid(SolidZone::new(shape)) };
        let laws = [0, 1, 2].map(|of| coordinate(shape, of));
        let (exact, products) = squares(shape);
        let (mut found, mut together, mut scratch) = ([0.0; 3], [0.0; 3], Vec::new());
        for a in &normals {
            for b in &normals {
                for c in &normals {
                    let mut row = vec![*a, *b, *c];
                    block.apply(&mut row, &mut scratch);
                    let place = [0, 1, 2].map(|of| behind_normal(laws[of].probability().unwrap(), row[of]));
                    assert!(reach(shape, place) <= 1.0 + 1e-9, "{shape:?} {place:?}");
                    found.iter_mut().zip(place).for_each(|(found, place)| *found += place * place);
                    for (k, (i, j)) in [(0, 1), (0, 2), (1, 2)].into_iter().enumerate() {
                        together[k] += (place[i] * place[j]).powi(2);
                    }
                }
            }
        }
        let count = PLACES.pow(3) as f64;
        for (found, exact) in found.into_iter().zip(exact).chain(together.into_iter().zip(products)) {
            close(found / count, exact, 1.5e-2, exact);
        }
    }
}

#[test]
fn two_coordinates_of_a_solid_keep_their_law() {
    const PLACES: usize = 300;
    let normals = middles(PLACES);
    let dimensions: Vec<Dimension> =
        ["x", "y", "z"].map(|name| Dimension::uniform(name, 0.0, 1.0).unwrap()).into_iter().collect();
    for shape in [SolidShape::Octahedron, SolidShape::Bicone, SolidShape::Ball] {
        let block = Block { members: vec![0, 1, 2], law: JointLaw::Solid(SolidZone::new(shape)) };
        let whole = Correlation::with_blocks(&dimensions, &[], vec![block]).unwrap();
        let (exact, products) = squares(shape);
        for (pair, (i, j)) in [(0, 1), (0, 2), (1, 2)].into_iter().enumerate() {
            let two = whole.among(&[i, j]).unwrap();
            let laws = [i, j].map(|of| coordinate(shape, of));
            let (mut found, mut together, mut scratch) = ([0.0; 2], 0.0, Vec::new());
            for a in &normals {
                for b in &normals {
                    let mut row = vec![*a, *b];
                    two.blocks()[0].apply(&mut row, &mut scratch);
                    let place = [0, 1].map(|of| behind_normal(laws[of].probability().unwrap(), row[of]));
                    found[0] += place[0] * place[0];
                    found[1] += place[1] * place[1];
                    together += (place[0] * place[1]).powi(2);
                }
            }
            let count = PLACES.pow(2) as f64;
            // The midpoint rule as above: 300^(-4/3) is 0.05 %.
            close(found[0] / count, exact[i], 2e-3, exact[i]);
            close(found[1] / count, exact[j], 2e-3, exact[j]);
            close(together / count, products[pair], 3e-3, products[pair]);
        }
    }
}
