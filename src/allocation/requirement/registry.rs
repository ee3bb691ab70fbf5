//! Forms of all requirements. A new kind of requirement is registered here.

use crate::allocation::requirement::constraint::Constraint;
use crate::allocation::requirement::form::RequirementForm;
use crate::allocation::requirement::required_cpk::RequiredCpk;
use crate::allocation::requirement::required_joint_yield::RequiredJointYield;
use crate::allocation::requirement::required_rss::RequiredRss;
use crate::allocation::requirement::required_sigma::RequiredSigma;
use crate::allocation::requirement::required_worst_case::RequiredWorstCase;
use crate::allocation::requirement::required_yield::RequiredYield;
use sensitol_numeric::requirement::Requirement;

/// Form of a requirement of one characteristic.
pub(in crate::allocation) fn form_of(requirement: &Requirement) -> &'static dyn RequirementForm {
    match requirement {
        Requirement::Yield(_) => &RequiredYield,
        Requirement::Cpk(_) => &RequiredCpk,
        Requirement::Sigma(_) => &RequiredSigma,
        Requirement::Rss => &RequiredRss,
        Requirement::WorstCase => &RequiredWorstCase,
    }
}

impl Constraint {
    /// Form of the requirement of this constraint.
    pub(in crate::allocation) fn form(&self) -> &'static dyn RequirementForm {
        if self.is_joint() { &RequiredJointYield } else { form_of(&self.requirement) }
    }
}
