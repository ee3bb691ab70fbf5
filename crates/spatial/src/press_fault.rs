//! Faults of joints that press a part against contacts.

/// Reason why a force holds a part against no contacts.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PressFault {
    /// Contacts on a feature that is not a plane.
    #[error("presses on {} `{feature}`, and needs a plane", article(kind))]
    NoPlane {
        /// Name of the feature.
        feature: String,
        /// Kind of the feature.
        kind: &'static str,
    },
    /// A contact that is not a point.
    #[error("has {} `{feature}` among its targets, and needs points", article(kind))]
    NoPoint {
        /// Name of the feature.
        feature: String,
        /// Kind of the feature.
        kind: &'static str,
    },
    /// A contact that is named twice.
    #[error("names `{feature}` twice among its targets")]
    Twice {
        /// Name of the feature.
        feature: String,
    },
    /// Contacts of several parts, or of the part with the plane.
    #[error("has `{feature}` among its targets, which is not of the part that lies against `{plane}`")]
    OtherPart {
        /// Name of the feature.
        feature: String,
        /// Name of the plane.
        plane: String,
    },
    /// Too few or too many contacts.
    #[error("names {found} {}, and needs 3 to {most}", if *found == 1 { "contact" } else { "contacts" })]
    Count {
        /// Number of contacts.
        found: usize,
        /// Greatest number of contacts.
        most: usize,
    },
    /// A force on a part that stands still, or on a part without a contact.
    #[error("has its force at `{weight}`, and that part is not moved by it")]
    Still {
        /// Feature or part on which the force acts.
        weight: String,
    },
    /// Contacts in a line.
    #[error("has its contacts in a line: {}", list(contacts))]
    InLine {
        /// Names of the contacts.
        contacts: Vec<String>,
    },
    /// Joints before hold all that the contacts could.
    #[error("presses `{part}` against contacts, and the joints before it leave nothing to press")]
    NothingLeft {
        /// Name of the part.
        part: String,
    },
    /// A force along the plane.
    #[error("leaves `{part}` sliding: its force has a part along `{plane}`, and no joint before it stops that")]
    Slides {
        /// Name of the part.
        part: String,
        /// Name of the plane.
        plane: String,
    },
    /// A force away from the contacts.
    #[error("presses `{part}` away from its contacts")]
    Away {
        /// Name of the part.
        part: String,
    },
    /// A force outside the contacts.
    #[error("lets `{part}` tip over: its force lies outside the contacts")]
    Tips {
        /// Name of the part.
        part: String,
    },
    /// A force over the line of some contacts, and a measure that depends on the side to which the part rocks.
    #[error("lets `{part}` rock on {}, and `{measure}` depends on the side to which it does", list(about))]
    Rocks {
        /// Name of the part.
        part: String,
        /// Names of the contacts that carry the force.
        about: Vec<String>,
        /// Name of the measure.
        measure: String,
    },
}

impl PressFault {
    /// Text to write instead.
    pub(crate) fn help(&self) -> String {
        match self {
            Self::NoPlane { .. } => "name a plane: on = \"floor.top\", and the contact points as `targets`".into(),
            Self::NoPoint { .. } => "write the contact as a feature with `point`".into(),
            Self::Twice { .. } => "name each contact once".into(),
            Self::OtherPart { .. } => "name contacts of one part, and `on` a plane of another one".into(),
            Self::Count { found, .. } if *found < 3 => {
                "add points to `targets`, or hold each contact by a joint of its own: against = \"part.point\"".into()
            }
            Self::Count { .. } => "leave out contacts that lie between others".into(),
            Self::Still { .. } => "let `weight_at` name a feature of the part that rests on the contacts".into(),
            Self::InLine { .. } => "add a contact beside the line to `targets`".into(),
            Self::NothingLeft { .. } => "remove `press`, or let the joints before it take less".into(),
            Self::Slides { plane, .. } => {
                format!("press along the normal of `{plane}`, or put the joints that stop the part before this one")
            }
            Self::Away { .. } => "turn the direction of `press` around".into(),
            Self::Tips { .. } => {
                "move `weight_at` between the contacts, or add the contact to `targets` on which it then rests".into()
            }
            Self::Rocks { about, measure, .. } => format!(
                "move `weight_at` off the line of {}, or let `{measure}` measure something that rocking does not move",
                list(about)
            ),
        }
    }
}

fn list(names: &[String]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    match quoted.split_last() {
        Some((last, others)) if !others.is_empty() => format!("{} and {last}", others.join(", ")),
        _ => quoted.join(""),
    }
}

fn article(kind: &str) -> String {
    format!("{} {kind}", if kind == "axis" { "an" } else { "a" })
}
