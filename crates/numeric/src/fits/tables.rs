//! Published tables: standard tolerances and fundamental deviations of sizes to 500 mm.

use Column::{Ranges, Steps};

use crate::fits::grade::{Grade, Side};

/// Fundamental deviations, from far within the material to far outside it (shafts), or the other way (holes).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Letter {
    A,
    B,
    C,
    Cd,
    D,
    E,
    Ef,
    F,
    Fg,
    G,
    H,
    Js,
    J,
    K,
    M,
    N,
    P,
    R,
    S,
    T,
    U,
    V,
    X,
    Y,
    Z,
    Za,
    Zb,
    Zc,
}

/// Names of holes and shafts, in the order of [`Letter`].
const NAMES: [(&str, &str); 28] = [
    ("A", "a"),
    ("B", "b"),
    ("C", "c"),
    ("CD", "cd"),
    ("D", "d"),
    ("E", "e"),
    ("EF", "ef"),
    ("F", "f"),
    ("FG", "fg"),
    ("G", "g"),
    ("H", "h"),
    ("JS", "js"),
    ("J", "j"),
    ("K", "k"),
    ("M", "m"),
    ("N", "n"),
    ("P", "p"),
    ("R", "r"),
    ("S", "s"),
    ("T", "t"),
    ("U", "u"),
    ("V", "v"),
    ("X", "x"),
    ("Y", "y"),
    ("Z", "z"),
    ("ZA", "za"),
    ("ZB", "zb"),
    ("ZC", "zc"),
];

impl Letter {
    #[rustfmt::skip]
    pub(super) const ALL: [Self; 28] = [
        Self::A, Self::B, Self::C, Self::Cd, Self::D, Self::E, Self::Ef, Self::F, Self::Fg, Self::G, Self::H, Self::Js, Self::J,
        Self::K, Self::M, Self::N, Self::P, Self::R, Self::S, Self::T, Self::U, Self::V, Self::X, Self::Y, Self::Z, Self::Za,
        Self::Zb, Self::Zc,
    ];

    pub(super) fn name(self, side: Side) -> &'static str {
        let (hole, shaft) = NAMES[self as usize];
        match side {
            Side::Hole => hole,
            Side::Shaft => shaft,
        }
    }

    /// Sizes with values for the letter: above the first and up to the second, in mm.
    pub(super) fn sizes(self) -> [f64; 2] {
        match (self, self.column()) {
            // A and B exist above 1 mm only: smaller sizes leave no room for such deviations.
            (Self::A | Self::B, _) => [1.0, 500.0],
            (_, Ranges(values)) => [0.0, RANGES[values.len() - 1]],
            (_, Steps(0, _)) => [0.0, 500.0],
            (_, Steps(first, _)) => [STEPS[first - 1], 500.0],
        }
    }
}

/// Upper ends of the size ranges, in mm.
const RANGES: [f64; 13] = [3.0, 6.0, 10.0, 18.0, 30.0, 50.0, 80.0, 120.0, 180.0, 250.0, 315.0, 400.0, 500.0];

/// Upper ends of the size ranges of the finer division, in mm.
const STEPS: [f64; 25] = [
    3.0, 6.0, 10.0, 14.0, 18.0, 24.0, 30.0, 40.0, 50.0, 65.0, 80.0, 100.0, 120.0, 140.0, 160.0, 180.0, 200.0, 225.0,
    250.0, 280.0, 315.0, 355.0, 400.0, 450.0, 500.0,
];

/// Standard tolerances, in tenths of a micrometre: a row per grade, a column per size range.
#[rustfmt::skip]
const TOLERANCES: [[i32; 13]; 20] = [
    [3, 4, 4, 5, 6, 6, 8, 10, 12, 20, 25, 30, 40], // IT01
    [5, 6, 6, 8, 10, 10, 12, 15, 20, 30, 40, 50, 60], // IT0
    [8, 10, 10, 12, 15, 15, 20, 25, 35, 45, 60, 70, 80], // IT1
    [12, 15, 15, 20, 25, 25, 30, 40, 50, 70, 80, 90, 100], // IT2
    [20, 25, 25, 30, 40, 40, 50, 60, 80, 100, 120, 130, 150], // IT3
    [30, 40, 40, 50, 60, 70, 80, 100, 120, 140, 160, 180, 200], // IT4
    [40, 50, 60, 80, 90, 110, 130, 150, 180, 200, 230, 250, 270], // IT5
    [60, 80, 90, 110, 130, 160, 190, 220, 250, 290, 320, 360, 400], // IT6
    [100, 120, 150, 180, 210, 250, 300, 350, 400, 460, 520, 570, 630], // IT7
    [140, 180, 220, 270, 330, 390, 460, 540, 630, 720, 810, 890, 970], // IT8
    [250, 300, 360, 430, 520, 620, 740, 870, 1000, 1150, 1300, 1400, 1550], // IT9
    [400, 480, 580, 700, 840, 1000, 1200, 1400, 1600, 1850, 2100, 2300, 2500], // IT10
    [600, 750, 900, 1100, 1300, 1600, 1900, 2200, 2500, 2900, 3200, 3600, 4000], // IT11
    [1000, 1200, 1500, 1800, 2100, 2500, 3000, 3500, 4000, 4600, 5200, 5700, 6300], // IT12
    [1400, 1800, 2200, 2700, 3300, 3900, 4600, 5400, 6300, 7200, 8100, 8900, 9700], // IT13
    [2500, 3000, 3600, 4300, 5200, 6200, 7400, 8700, 10000, 11500, 13000, 14000, 15500], // IT14
    [4000, 4800, 5800, 7000, 8400, 10000, 12000, 14000, 16000, 18500, 21000, 23000, 25000], // IT15
    [6000, 7500, 9000, 11000, 13000, 16000, 19000, 22000, 25000, 29000, 32000, 36000, 40000], // IT16
    [10000, 12000, 15000, 18000, 21000, 25000, 30000, 35000, 40000, 46000, 52000, 57000, 63000], // IT17
    [14000, 18000, 22000, 27000, 33000, 39000, 46000, 54000, 63000, 72000, 81000, 89000, 97000], // IT18
];

/// Values of a fundamental deviation over the sizes.
enum Column {
    /// Value per size range, from the first range on.
    Ranges(&'static [i32]),
    /// Value per range of the finer division, from the range with this index on.
    Steps(usize, &'static [i32]),
}

impl Letter {
    /// Distance of the shaft's nearer limit from the zero line, in micrometres: below it (a to g), above it (k to zc).
    #[rustfmt::skip]
    fn column(self) -> Column {
        match self {
            Self::A => Steps(0, &[270, 270, 280, 290, 290, 300, 300, 310, 320, 340, 360, 380, 410, 460, 520, 580, 660, 740, 820, 920, 1050, 1200, 1350, 1500, 1650]),
            Self::B => Steps(0, &[140, 140, 150, 150, 150, 160, 160, 170, 180, 190, 200, 220, 240, 260, 280, 310, 340, 380, 420, 480, 540, 600, 680, 760, 840]),
            Self::C => Steps(0, &[60, 70, 80, 95, 95, 110, 110, 120, 130, 140, 150, 170, 180, 200, 210, 230, 240, 260, 280, 300, 330, 360, 400, 440, 480]),
            Self::Cd => Ranges(&[34, 46, 56, 70, 85, 100]),
            Self::D => Ranges(&[20, 30, 40, 50, 65, 80, 100, 120, 145, 170, 190, 210, 230]),
            Self::E => Ranges(&[14, 20, 25, 32, 40, 50, 60, 72, 85, 100, 110, 125, 135]),
            Self::Ef => Ranges(&[10, 14, 18, 23, 28, 35]),
            Self::F => Ranges(&[6, 10, 13, 16, 20, 25, 30, 36, 43, 50, 56, 62, 68]),
            Self::Fg => Ranges(&[4, 6, 8, 10, 12, 15]),
            Self::G => Ranges(&[2, 4, 5, 6, 7, 9, 10, 12, 14, 15, 17, 18, 20]),
            Self::K => Ranges(&[0, 1, 1, 1, 2, 2, 2, 3, 3, 4, 4, 4, 5]),
            Self::M => Ranges(&[2, 4, 6, 7, 8, 9, 11, 13, 15, 17, 20, 21, 23]),
            Self::N => Ranges(&[4, 8, 10, 12, 15, 17, 20, 23, 27, 31, 34, 37, 40]),
            Self::P => Ranges(&[6, 12, 15, 18, 22, 26, 32, 37, 43, 50, 56, 62, 68]),
            Self::R => Steps(0, &[10, 15, 19, 23, 23, 28, 28, 34, 34, 41, 43, 51, 54, 63, 65, 68, 77, 80, 84, 94, 98, 108, 114, 126, 132]),
            Self::S => Steps(0, &[14, 19, 23, 28, 28, 35, 35, 43, 43, 53, 59, 71, 79, 92, 100, 108, 122, 130, 140, 158, 170, 190, 208, 232, 252]),
            Self::T => Steps(6, &[41, 48, 54, 66, 75, 91, 104, 122, 134, 146, 166, 180, 196, 218, 240, 268, 294, 330, 360]),
            Self::U => Steps(0, &[18, 23, 28, 33, 33, 41, 48, 60, 70, 87, 102, 124, 144, 170, 190, 210, 236, 258, 284, 315, 350, 390, 435, 490, 540]),
            Self::V => Steps(4, &[39, 47, 55, 68, 81, 102, 120, 146, 172, 202, 228, 252, 284, 310, 340, 385, 425, 475, 530, 595, 660]),
            Self::X => Steps(0, &[20, 28, 34, 40, 45, 54, 64, 80, 97, 122, 146, 178, 210, 248, 280, 310, 350, 385, 425, 475, 525, 590, 660, 740, 820]),
            Self::Y => Steps(5, &[63, 75, 94, 114, 144, 174, 214, 254, 300, 340, 380, 425, 470, 520, 580, 650, 730, 820, 920, 1000]),
            Self::Z => Steps(0, &[26, 35, 42, 50, 60, 73, 88, 112, 136, 172, 210, 258, 310, 365, 415, 465, 520, 575, 640, 710, 790, 900, 1000, 1100, 1250]),
            Self::Za => Steps(0, &[32, 42, 52, 64, 77, 98, 118, 148, 180, 226, 274, 335, 400, 470, 535, 600, 670, 740, 820, 920, 1000, 1150, 1300, 1450, 1600]),
            Self::Zb => Steps(0, &[40, 50, 67, 90, 108, 136, 160, 200, 242, 300, 360, 445, 525, 620, 700, 780, 880, 960, 1050, 1200, 1300, 1500, 1650, 1850, 2100]),
            Self::Zc => Steps(0, &[60, 80, 97, 130, 150, 188, 218, 274, 325, 405, 480, 585, 690, 800, 900, 1000, 1150, 1250, 1350, 1550, 1700, 1900, 2100, 2400, 2600]),
            Self::H | Self::Js | Self::J => Ranges(&[0; 13]),
        }
    }
}

/// Upper deviations of J6, J7 and J8, in micrometres.
const HOLE_J: [[i32; 13]; 3] = [
    [2, 5, 5, 6, 8, 10, 13, 16, 18, 22, 25, 29, 33],
    [4, 6, 8, 10, 12, 14, 18, 22, 26, 30, 36, 39, 43],
    [6, 10, 12, 15, 20, 24, 28, 34, 41, 47, 55, 60, 66],
];

/// Lower deviations without their sign, in micrometres: of j5 and j6, then of j7.
const SHAFT_J: [[i32; 13]; 2] =
    [[2, 2, 2, 3, 4, 5, 7, 9, 11, 13, 16, 18, 20], [4, 4, 5, 6, 8, 10, 12, 15, 18, 21, 26, 28, 32]];

/// Lower deviation of j8 without its sign, in micrometres. It exists up to 3 mm.
const SHAFT_J8: i32 = 6;

/// Index of the range that contains a size, among upper ends that belong to their ranges. The size must not exceed the last.
fn place(ends: &[f64], nominal: f64) -> usize {
    ends.partition_point(|&end| end < nominal)
}

/// Standard tolerance IT, in tenths of a micrometre.
pub(super) fn tolerance(grade: Grade, nominal: f64) -> i32 {
    TOLERANCES[grade.row()][place(&RANGES, nominal)]
}

/// Distance of the shaft's nearer limit from the zero line, in tenths of a micrometre. The letter must exist at this size.
pub(super) fn magnitude(letter: Letter, nominal: f64) -> i32 {
    10 * match letter.column() {
        Ranges(values) => values[place(&RANGES, nominal)],
        Steps(first, values) => values[place(&STEPS, nominal) - first],
    }
}

/// Upper deviation of J6 to J8, in tenths of a micrometre.
pub(super) fn hole_j(grade: Grade, nominal: f64) -> i32 {
    10 * HOLE_J[grade.row() - Grade::number(6).row()][place(&RANGES, nominal)]
}

/// Lower deviation of j5 to j8 without its sign, in tenths of a micrometre.
pub(super) fn shaft_j(grade: Grade, nominal: f64) -> i32 {
    let row = grade.row() - Grade::number(5).row();
    10 * if row == 3 { SHAFT_J8 } else { SHAFT_J[row.saturating_sub(1)][place(&RANGES, nominal)] }
}
