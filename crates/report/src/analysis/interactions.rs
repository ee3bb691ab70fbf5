//! Interactions of a characteristic: number, sum and strongest ones.

use crate::analysis::statistics::CharacteristicStatistics;
use crate::analysis::statistics::{derivative, part};
use crate::document::number::known;
use crate::document::number::{NEWS, percent, short};
use crate::document::{Blocks, Cell, Columns, DataTable, Section, Value};
use crate::figures::FittedFigures;
use crate::figures::Named;
use sensitol::analysis::{
    CharacteristicAnalysis, DerivativeOrigin, EstimatedShare, IndexSource, Interaction, SobolIndices, VerificationKind,
};

/// Greatest number of interactions on a terminal unless all are requested.
pub(crate) const SHOWN: usize = 2;
/// Greatest number of interactions on a page.
pub(crate) const SHOWN_ON_PAGE: usize = 24;

/// Parts of a document on the interactions of a characteristic.
pub(crate) trait InteractionSections {
    /// True if a dimension or an interaction has a printed contribution below 0. Only correlated dimensions have such contributions.
    fn has_negative_contributions(&self) -> bool;

    /// Adds the number of known interactions, their sum and the strongest ones.
    fn pairs(&self, section: &mut Section, pairs: usize);

    /// Sentence with the number of known interactions, their sum, and the sum of the screened guesses.
    fn interactions_in_words(&self, possible: usize, examined: usize) -> String;

    fn interaction_table(&self, rows: usize) -> DataTable;

    /// Adds the contributions of dimensions that vary together, each group as one factor. They are a detail unless the contributions come
    /// from the model.
    fn together(&self, section: &mut Section);

    /// Sentence on the source of the contributions if they do not come from the surface.
    fn of_model(&self, of: &SobolIndices) -> String;
}

impl InteractionSections for CharacteristicAnalysis {
    fn has_negative_contributions(&self) -> bool {
        let own = self.sensitivities.iter().filter_map(part);
        own.chain(self.contributions.interactions.iter().filter_map(|pair| pair.share))
            .any(|share| share <= -0.5 * NEWS)
    }

    fn pairs(&self, section: &mut Section, pairs: usize) {
        let (possible, examined) = (self.contributions.possible_interactions, self.examined());
        self.together(section);
        if let Some(of_model) = self.contributions.indices.as_ref().filter(|_| self.is_of_model()) {
            section.note(self.of_model(of_model));
        } else if possible > 0 {
            section.note(self.interactions_in_words(possible, examined));
        }
        section.table(self.interaction_table(pairs));
    }

    fn interactions_in_words(&self, possible: usize, examined: usize) -> String {
        let screened = self.screened().count();
        let sum = |screened: bool| {
            let own = self
                .contributions
                .interactions
                .iter()
                .filter(|pair| screened == (pair.origin == Some(DerivativeOrigin::Screened)));
            let known: Option<Vec<f64>> = own.map(|interaction| interaction.share).collect();
            let sum = known.map(|shares| format!("{} %", percent(shares.iter().sum())));
            sum.unwrap_or_else(|| "an unknown part".to_owned())
        };
        let by_formula = self.evidence.verification.as_ref().is_some_and(|of| of.kind == VerificationKind::Exact);
        let known = match (examined, by_formula) {
            _ if self.is_proven_linear() => "none (the formula is linear)".to_owned(),
            (0, _) => format!("none of {possible} examined"),
            (_, true) => format!("all {possible} by the formula, {} of the variance together", sum(false)),
            (_, false) => format!("{examined} of {possible} examined, {} of the variance together", sum(false)),
        };
        match screened {
            0 => format!("interactions: {known}"),
            _ => format!("interactions: {known}; {screened} estimated without being examined, {}", sum(true)),
        }
    }

    fn interaction_table(&self, rows: usize) -> DataTable {
        let news =
            self.contributions.interactions.iter().filter(|pair| pair.share.is_none_or(|share| share >= NEWS)).count();
        let trusted = !self.is_of_model();
        let most = [if trusted { news.min(SHOWN) } else { 0 }, news.min(SHOWN_ON_PAGE)];
        let both = |pair: &Interaction<'_>| {
            let [a, b] = pair.dimensions;
            Cell {
                full: Some(format!("{a} × {b}")),
                ..Cell::both(Value::Empty, format!("{} × {}", short(a), short(b)))
            }
        };
        Columns::default()
            .data("characteristic", |_| Cell::text(self.name()))
            .data("dimension_a", |pair: &Interaction<'_>| Cell::text(pair.dimensions[0]))
            .data("dimension_b", |pair| Cell::text(pair.dimensions[1]))
            .named("", "pair", both)
            .column("mixed", "mixed derivative", |pair| {
                Cell::both(Value::Number(pair.mixed), derivative(pair.mixed, pair.rounding, 6))
            })
            .column("share", "share %", |pair| Cell::number(pair.share, percent))
            .shown_if(self.screened().next().is_some(), "", |pair| match pair.origin {
                Some(DerivativeOrigin::Screened) => Cell::text("estimated"),
                _ => Cell::empty(),
            })
            .data("rounding", |pair| Cell::data(pair.rounding))
            .data("origin", |pair| Cell::optional(pair.origin.map(DerivativeOrigin::name)))
            .table("interactions", self.contributions.interactions.iter().take(rows))
            .at_most(most, String::new())
    }

    fn together(&self, section: &mut Section) {
        let Some(of) = &self.contributions.indices else { return };
        let percents =
            |index: Option<EstimatedShare>| known(index.map(|of| of.value), |share| format!("{} %", percent(share)));
        let mut lines = Vec::new();
        for factor in &of.factors {
            let names: Vec<String> = factor.dimensions.iter().map(|name| short(name)).collect();
            let (first, total) = (percents(factor.first_order), percents(factor.total));
            lines.wrapped(2, format!("{} together: contribution {first}, with interactions {total}", names.join(", ")));
        }
        match self.is_of_model() {
            false => section.detail(lines),
            true => section.brief(lines),
        }
    }

    fn of_model(&self, of: &SobolIndices) -> String {
        // A negative estimate is 0 within its error.
        let rest = of.interactions.map(|share| format!("{} %", percent(share.max(0.0))));
        match (of.source, rest) {
            (_, None) => {
                "contributions unknown: the surface is not trusted, and no sample of the model has them".to_owned()
            }
            (IndexSource::Ranks, Some(rest)) => {
                format!("contributions by the ranks of the model's points; interactions and what is left: {rest}")
            }
            (_, Some(rest)) => {
                format!("contributions by points of the model; interactions have {rest} of the variance")
            }
        }
    }
}
