//! Names beside the points of a chart, placed without overlap.

/// Width of a letter at a font size of 12, on the generous side.
pub(super) const LETTER: f64 = 6.9;
/// Height of a line at a font size of 12, on the generous side.
const LINE: f64 = 13.0;
/// Radius of a point's circle.
const RADIUS: f64 = 5.0;
/// Points closer than this look like one point and share a label.
const SAME: f64 = 3.0;

/// A rectangle: left, right, above, below.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Space([f64; 4]);

impl Space {
    fn meets(&self, other: &Self) -> bool {
        let ([a, b, c, d], [e, f, g, h]) = (self.0, other.0);
        a < f && e < b && c < h && g < d
    }
}

/// Position of a name.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Label {
    pub(super) text: String,
    /// End of the text that is nearer to the point.
    pub(super) x: f64,
    /// Base line of the text.
    pub(super) y: f64,
    /// True if the text ends at `x`; otherwise it begins there.
    pub(super) ends: bool,
    /// True if the text is so far away that it needs a line to its point.
    pub(super) far: bool,
    /// Position of the point.
    pub(super) of: [f64; 2],
    /// Index of the first of the points that it names.
    pub(super) point: usize,
}

impl Label {
    fn space(&self) -> Space {
        let width = LETTER * self.text.chars().count() as f64;
        let [from, to] = if self.ends { [self.x - width, self.x] } else { [self.x, self.x + width] };
        Space([from, to, self.y - LINE + 3.0, self.y + 3.0])
    }
}

/// Places labels for points within `[left, right, above, below]`, beside their point if there is space, else as near as possible. Points
/// in one place share a label. Earlier points choose first. No label covers the rectangles `held`. A name without space overlaps others
/// if `all` is set, and is left out otherwise.
pub(super) fn placed(points: &[([f64; 2], &str)], within: [f64; 4], held: &[[f64; 4]], all: bool) -> Vec<Label> {
    let near = |a: [f64; 2], b: [f64; 2]| libm::hypot(a[0] - b[0], a[1] - b[1]) < SAME;
    let mut named: Vec<(usize, String)> = Vec::new();
    for (i, (at, name)) in points.iter().enumerate() {
        match named.iter_mut().find(|(of, _)| near(points[*of].0, *at)) {
            Some((_, names)) => *names = format!("{names}, {name}"),
            None => named.push((i, (*name).to_owned())),
        }
    }
    let circle = |&([x, y], _): &([f64; 2], &str)| Space([x - RADIUS, x + RADIUS, y - RADIUS, y + RADIUS]);
    let mut taken: Vec<Space> = points.iter().map(circle).chain(held.iter().map(|of| Space(*of))).collect();
    let [left, right, above, below] = within;
    named
        .into_iter()
        .filter_map(|(point, text)| {
            let [x, y] = points[point].0;
            // Candidates: beside the point, then farther and farther up and down.
            let levels = [-5.0, 13.0].into_iter().chain((1..12).flat_map(|i| {
                let off = f64::from(i) * LINE;
                [-5.0 - off, 13.0 + off]
            }));
            let choices = levels.flat_map(|off| {
                [false, true].map(|ends| Label {
                    text: text.clone(),
                    x: x + if ends { -7.0 } else { 7.0 },
                    y: y + off,
                    ends,
                    far: !(-6.0..14.0).contains(&off),
                    of: [x, y],
                    point,
                })
            });
            let fits = |label: &Label| {
                let space = label.space();
                let [a, b, c, d] = space.0;
                let inside = a >= left && b <= right && c >= above && d <= below;
                inside && !taken.iter().any(|other| space.meets(other))
            };
            let mut choices = choices.peekable();
            let first = choices.peek().cloned().filter(|_| all);
            let label = choices.find(fits).or(first)?;
            taken.push(label.space());
            Some(label)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const WITHIN: [f64; 4] = [80.0, 715.0, 30.0, 360.0];

    #[test]
    fn names_do_not_meet() {
        let names: Vec<String> = (0..14).map(|i| format!("a method of some name {i}")).collect();
        let points: Vec<([f64; 2], &str)> = names
            .iter()
            .enumerate()
            .map(|(i, name)| ([100.0 + 9.0 * i as f64, 200.0 + (i % 3) as f64], &**name))
            .collect();
        let labels = placed(&points, WITHIN, &[], true);
        assert_eq!(labels.len(), 14);
        for (i, one) in labels.iter().enumerate() {
            assert!(labels[i + 1..].iter().all(|other| !one.space().meets(&other.space())), "{one:?}");
        }
        // A single label stands to the right, above its point.
        let alone = placed(&points[..1], WITHIN, &[], true);
        assert_eq!((alone[0].x, alone[0].y, alone[0].ends, alone[0].far), (107.0, 195.0, false, false));
        // At the right edge the label fits only on the left.
        assert!(placed(&[([700.0, 200.0], "monte-carlo 100000")], WITHIN, &[], true)[0].ends);
    }

    #[test]
    fn points_in_one_place_share_a_name() {
        let labels = placed(
            &[([100.0, 100.0], "rss"), ([101.0, 100.0], "worst-case"), ([300.0, 90.0], "full")],
            WITHIN,
            &[],
            true,
        );
        let texts: Vec<&str> = labels.iter().map(|label| label.text.as_str()).collect();
        assert_eq!(texts, ["rss, worst-case", "full"]);
        assert_eq!(labels[1].point, 2);
    }
}
