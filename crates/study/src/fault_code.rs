//! Stable codes of the faults of a study, for programs that read errors.

use crate::error::StudyFault;

impl StudyFault {
    /// Stable code of the kind of fault, in lower case with hyphens. Messages may change, codes do not.
    ///
    /// ```
    /// use sensitol_study::Study;
    /// let error = Study::from_toml("[dimensions]\na = { nominal = 1, tolerence = 2 }", "gap.toml").unwrap_err();
    /// assert_eq!(error.fault.code(), "unknown-key");
    /// ```
    pub fn code(&self) -> &'static str {
        match self {
            Self::Unreadable { .. } => "unreadable",
            Self::IsFolder { .. } => "is-folder",
            Self::NotUtf8 { .. } => "not-utf8",
            Self::UnknownFormat { .. } => "unknown-format",
            Self::Syntax { .. } => "syntax",
            Self::UnknownKey { .. } => "unknown-key",
            Self::DuplicateKey { .. } => "duplicate-key",
            Self::MissingKey { .. } => "missing-key",
            Self::WrongType { .. } => "wrong-type",
            Self::UnknownWord { .. } => "unknown-word",
            Self::NotFinite { .. } => "not-finite",
            Self::OutOfRange { .. } => "out-of-range",
            Self::Conflict { .. } => "conflict",
            Self::DoesNotApply { .. } => "does-not-apply",
            Self::Swapped { .. } => "swapped",
            Self::Dimension(_) => "dimension",
            Self::Fit(_) => "fit",
            Self::Limits(_) => "limits",
            Self::Conditions(_) => "conditions",
            Self::Spatial(_) => "spatial",
            Self::Zone(_) => "zone",
            Self::Compensator(_) => "compensator",
            Self::Formula(_) => "formula",
            Self::GroupName { .. } => "group-name",
            Self::ReservedName { .. } => "reserved-name",
            Self::EmptyName => "empty-name",
            Self::HiddenCharacter { .. } => "hidden-character",
            Self::NameTaken { .. } => "name-taken",
            Self::DimensionAndFormula { .. } => "dimension-and-formula",
            Self::FromCircle { .. } => "from-circle",
            Self::UnknownConfigured { .. } => "unknown-configured",
            Self::ConfiguredLimits { .. } => "configured-limits",
            Self::ReservedConfiguration => "reserved-configuration",
            Self::NoConfigurations => "no-configurations",
            Self::CorrelationOfRows { .. } => "correlation-of-rows",
            Self::CorrelationInZone { .. } => "correlation-in-zone",
            Self::JointCount { .. } => "joint-count",
            Self::JointTwice { .. } => "joint-twice",
            Self::JointFile { .. } => "joint-file",
            Self::JointBand { .. } => "joint-band",
            Self::JointDistribution { .. } => "joint-distribution",
            Self::CorrelationBesideRows { .. } => "correlation-beside-rows",
            Self::NoMaterial { .. } => "no-material",
            Self::NothingFloats { .. } => "nothing-floats",
            Self::LengthBelowZone { .. } => "length-below-zone",
            Self::FastenerPair { .. } => "fastener-pair",
            Self::Units { .. } => "units",
            Self::DrivenByOutput { .. } => "driven-by-output",
            Self::IdleFormula { .. } => "idle-formula",
            Self::NoNominal { .. } => "no-nominal",
            Self::UnknownInput { .. } => "unknown-input",
            Self::MissingFile { .. } => "missing-file",
            Self::OutsideFile { .. } => "outside-file",
            Self::MissingColumn(_) => "missing-column",
            Self::NothingExternal => "nothing-external",
            Self::NoPrograms { .. } => "no-programs",
            Self::Nothing { .. } => "no-entries",
            Self::Correlation(_) => "correlation",
            Self::Method(_) => "method",
            Self::Data(_) => "data",
            Self::ProcessFile { .. } => "process-file",
            Self::SameAsItself { .. } => "same-as-itself",
            Self::SameAsChain { .. } => "same-as-chain",
            Self::Cost(_) => "cost",
            Self::NoStep { .. } => "no-step",
            Self::OutOfOrder { .. } => "out-of-order",
            Self::NoGrade { .. } => "no-grade",
            Self::TooManySteps { .. } => "too-many-steps",
            Self::Inspection(_) => "inspection",
            Self::Requirement(_) => "requirement",
            Self::Problem(_) => "problem",
        }
    }
}
