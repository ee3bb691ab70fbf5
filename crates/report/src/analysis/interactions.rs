//! Interactions of a characteristic: number, sum and strongest ones.

use crate::analysis::analysis_document::CharacteristicSections;
use crate::analysis::statistics::CharacteristicStatistics;
use crate::analysis::statistics::{derivative, part};
use crate::document::number::{NEWS, percent, short};
use crate::document::{Blocks, Cell, Columns, DataTable, Section, Value};
use crate::figures::FittedFigures;
use crate::figures::Named;
use sensitol::analysis::{CharacteristicAnalysis, DerivativeOrigin, Interaction, VerificationKind};

/// Most interactions on a terminal unless all are asked for.
pub(crate) const SHOWN: usize = 2;
/// Most interactions on a page.
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
}

impl InteractionSections for CharacteristicAnalysis {
    fn has_negative_contributions(&self) -> bool {
        let own = self.sensitivities.iter().filter_map(part);
        own.chain(self.interactions.iter().filter_map(|pair| pair.share)).any(|share| share <= -0.5 * NEWS)
    }

    fn pairs(&self, section: &mut Section, pairs: usize) {
        let (possible, examined) = (self.possible_interactions, self.examined());
        self.together(section);
        if let Some(of_model) = self.indices.as_ref().filter(|_| self.is_of_model()) {
            section.note(self.of_model(of_model));
        } else if possible > 0 {
            section.note(self.interactions_in_words(possible, examined));
        }
        section.table(self.interaction_table(pairs));
    }

    fn interactions_in_words(&self, possible: usize, examined: usize) -> String {
        let screened = self.screened().count();
        let sum = |screened: bool| {
            let own =
                self.interactions.iter().filter(|pair| screened == (pair.origin == Some(DerivativeOrigin::Screened)));
            let known: Option<Vec<f64>> = own.map(|interaction| interaction.share).collect();
            let sum = known.map(|shares| format!("{} %", percent(shares.iter().sum())));
            sum.unwrap_or_else(|| "an unknown part".to_owned())
        };
        let by_formula = self.verification.as_ref().is_some_and(|of| matches!(of.kind, VerificationKind::Exact { .. }));
        let known = match (examined, by_formula) {
            (0, _) => format!("none of {possible} examined"),
            _ if self.is_proven_linear() => "none, by the formula".to_owned(),
            (_, true) => format!("all {possible} by the formula, {} of the variance together", sum(false)),
            (_, false) => format!("{examined} of {possible} examined, {} of the variance together", sum(false)),
        };
        match screened {
            0 => format!("interactions: {known}"),
            _ => format!("interactions: {known}; {screened} estimated without being examined, {}", sum(true)),
        }
    }

    fn interaction_table(&self, rows: usize) -> DataTable {
        let news = self.interactions.iter().filter(|pair| pair.share.is_none_or(|share| share >= NEWS)).count();
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
            .table("interactions", self.interactions.iter().take(rows))
            .at_most(most, String::new())
    }
}
