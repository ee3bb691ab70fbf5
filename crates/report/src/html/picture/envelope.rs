//! Envelope of points: the faces of their convex hull, which stand for a part whose shape the study does not give.

/// Greatest number of points of an envelope. The search for faces takes the fourth power of it.
const MOST: usize = 40;
/// Distance, relative to the extent of the points, below which points are one, or lie in one plane.
const SAME: f64 = 1e-6;

type Point = [f64; 3];

fn minus(a: Point, b: Point) -> Point {
    [0, 1, 2].map(|i| a[i] - b[i])
}

fn dot(a: Point, b: Point) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(a: Point) -> Option<Point> {
    let length = dot(a, a).sqrt();
    (length > 0.0).then(|| a.map(|part| part / length))
}

/// Polygons around points: the faces of their hull, one polygon if they lie in a plane, two points if they lie on a line. Returns an empty
/// list if they are one point.
pub(super) fn envelope(points: &[Point]) -> Vec<Vec<Point>> {
    let extent = extent(points);
    let mut own: Vec<Point> = Vec::new();
    for &point in points {
        let is_known = own.iter().any(|&other| dot(minus(point, other), minus(point, other)).sqrt() <= SAME * extent);
        if !is_known && own.len() < MOST {
            own.push(point);
        }
    }
    let Some(&first) = own.first().filter(|_| own.len() > 1) else { return Vec::new() };
    let off = SAME * extent;
    let mut faces: Vec<(Point, f64)> = Vec::new();
    let mut flat = true;
    let mut straight = true;
    for (i, &a) in own.iter().enumerate() {
        for (j, &b) in own.iter().enumerate().skip(i + 1) {
            for &c in &own[j + 1..] {
                let across = cross(minus(b, a), minus(c, a));
                // Three points on a line span no plane.
                let Some(normal) = unit(across).filter(|_| dot(across, across).sqrt() > off * extent) else { continue };
                straight = false;
                let heights: Vec<f64> = own.iter().map(|&point| dot(minus(point, a), normal)).collect();
                let (below, above) = (heights.iter().any(|&h| h < -off), heights.iter().any(|&h| h > off));
                flat &= !below && !above;
                if below && above {
                    continue;
                }
                // The normal points out of the hull.
                let outward = if above { normal.map(|part| -part) } else { normal };
                let distance = dot(minus(a, first), outward);
                let is_known = |(other, at): &(Point, f64)| {
                    dot(*other, outward) > 1.0 - SAME && (at - distance).abs() <= 2.0 * off
                };
                if !faces.iter().any(is_known) {
                    faces.push((outward, distance));
                }
            }
        }
    }
    if straight {
        return vec![ends(&own)];
    }
    if flat {
        faces.truncate(1);
    }
    let on_face = |&(normal, distance): &(Point, f64)| {
        let on: Vec<Point> = own
            .iter()
            .copied()
            .filter(|&point| (dot(minus(point, first), normal) - distance).abs() <= 2.0 * off)
            .collect();
        polygon(&on, normal)
    };
    faces.iter().map(on_face).collect()
}

/// Largest distance along an axis.
fn extent(points: &[Point]) -> f64 {
    let along = |i: usize| {
        let values = points.iter().map(|point| point[i]);
        values.clone().fold(f64::MIN, f64::max) - values.fold(f64::MAX, f64::min)
    };
    (0..3).map(along).fold(0.0, f64::max)
}

/// The two points of a line that are farthest from each other.
fn ends(points: &[Point]) -> Vec<Point> {
    let Some(along) = unit(minus(points[points.len() - 1], points[0])) else { return points.to_vec() };
    let mut sorted = points.to_vec();
    sorted.sort_by(|&a, &b| dot(a, along).total_cmp(&dot(b, along)));
    vec![sorted[0], sorted[sorted.len() - 1]]
}

/// Convex polygon around points of a plane, by the monotone chain of Andrew (1979).
fn polygon(points: &[Point], normal: Point) -> Vec<Point> {
    let axis = if normal[0].abs() < 0.9 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
    let Some(x) = unit(cross(axis, normal)) else { return points.to_vec() };
    let y = cross(normal, x);
    let mut flat: Vec<([f64; 2], Point)> =
        points.iter().map(|&point| ([dot(point, x), dot(point, y)], point)).collect();
    flat.sort_by(|(a, _), (b, _)| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let size = extent(points);
    let turn = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    let half = |points: &mut dyn Iterator<Item = &([f64; 2], Point)>| {
        let mut chain: Vec<([f64; 2], Point)> = Vec::new();
        for &point in points {
            while let [.., a, b] = chain[..]
                && turn(a.0, b.0, point.0) <= SAME * size * size
            {
                chain.pop();
            }
            chain.push(point);
        }
        chain.pop();
        chain
    };
    let lower = half(&mut flat.iter());
    let upper = half(&mut flat.iter().rev());
    lower.into_iter().chain(upper).map(|(_, point)| point).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corners(size: f64) -> Vec<Point> {
        (0..8).map(|i| [0, 1, 2].map(|k| if i >> k & 1 == 1 { size } else { 0.0 })).collect()
    }

    #[test]
    fn a_cube_has_six_faces_of_four_corners() {
        let mut points = corners(25.0);
        // Points within, on a face and on an edge change nothing.
        points.extend([[12.0, 13.0, 14.0], [12.0, 13.0, 0.0], [12.0, 0.0, 0.0], [0.0, 0.0, 0.0]]);
        let faces = envelope(&points);
        assert_eq!(faces.len(), 6);
        for face in &faces {
            assert_eq!(face.len(), 4, "{face:?}");
            // Each side has the length of an edge.
            for (i, &a) in face.iter().enumerate() {
                let side = minus(face[(i + 1) % 4], a);
                assert!((dot(side, side) - 625.0).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn points_of_a_plane_make_one_polygon_and_points_of_a_line_two_ends() {
        let flat = [[0.0, 0.0, 3.0], [4.0, 0.0, 3.0], [4.0, 4.0, 3.0], [0.0, 4.0, 3.0], [2.0, 2.0, 3.0]];
        let faces = envelope(&flat);
        assert_eq!((faces.len(), faces[0].len()), (1, 4));
        let line = [[1.0, 0.0, 0.0], [5.0, 0.0, 0.0], [-2.0, 0.0, 0.0]];
        let mut ends = envelope(&line);
        assert_eq!(ends.len(), 1);
        // Either end may stand first.
        ends[0].sort_by(|a, b| a[0].total_cmp(&b[0]));
        assert_eq!(ends[0], [[-2.0, 0.0, 0.0], [5.0, 0.0, 0.0]]);
        assert!(envelope(&[[1.0; 3], [1.0; 3]]).is_empty());
    }
}
