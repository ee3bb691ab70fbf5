//! Answers of a journal to the rows of a request, and the rows that it lacks.

use super::Open;
use super::content::Answer;
use super::error::JournalError;
use super::store::Recalled;

/// Answers of the journal to some points.
#[derive(Default)]
pub(super) struct Recollection {
    /// Rows with known answers.
    pub(super) known: Vec<(usize, Vec<Answer>)>,
    /// Indices in `known` of the rows without a confirmation, in ascending order.
    pub(super) unconfirmed: Vec<usize>,
    /// Stages of these rows.
    pub(super) stages: Vec<i64>,
    pub(super) missing: Vec<usize>,
}

impl Recollection {
    pub(super) fn of(open: &Open, names: &[&str], rows: &[Vec<f64>], wanted: &[usize]) -> Result<Self, JournalError> {
        let mut found = Self::default();
        for &row in wanted {
            let recalled = names.iter().map(|name| open.store.recall(open.model, &rows[row], name));
            let Some(recalled) = recalled.collect::<Result<Option<Vec<Recalled>>, JournalError>>()? else {
                found.missing.push(row);
                continue;
            };
            // An answer without derivatives is evaluated again if the model sends them now.
            let lacks = |(name, one): (&&str, &Recalled)| {
                Ok(one.answer.is_ok() && open.store.gradient(open.model, &rows[row], name)?.is_none())
            };
            let lacks = names.iter().zip(&recalled).filter(|_| open.gradients).map(lacks);
            if lacks.collect::<Result<Vec<bool>, JournalError>>()?.contains(&true) {
                found.missing.push(row);
                continue;
            }
            let stages = recalled.iter().filter_map(|one| one.unconfirmed);
            let before = found.stages.len();
            found.stages.extend(stages);
            if found.stages.len() > before {
                found.unconfirmed.push(found.known.len());
            }
            found.known.push((row, recalled.into_iter().map(|one| one.answer).collect()));
        }
        found.stages.sort_unstable();
        found.stages.dedup();
        Ok(found)
    }

    /// Drops the rows whose run ended before their check. They count as missing.
    pub(super) fn drop_unconfirmed(&mut self) {
        self.missing.extend(self.unconfirmed_rows());
        let unconfirmed = std::mem::take(&mut self.unconfirmed);
        let known = std::mem::take(&mut self.known).into_iter().enumerate();
        let confirmed = known.filter(|(place, _)| unconfirmed.binary_search(place).is_err());
        self.known = confirmed.map(|(_, answered)| answered).collect();
    }

    /// Rows with answers whose run ended before their check.
    pub(super) fn unconfirmed_rows(&self) -> Vec<usize> {
        self.unconfirmed.iter().map(|&place| self.known[place].0).collect()
    }

    /// Rows that are unknown, or known but not confirmed.
    pub(super) fn unsettled(&self) -> Vec<usize> {
        let mut rows = self.unconfirmed_rows();
        rows.extend(&self.missing);
        rows.sort_unstable();
        rows
    }

    pub(super) fn rows(&self) -> Vec<usize> {
        let mut rows: Vec<usize> = self.known.iter().map(|(row, _)| *row).collect();
        rows.extend(&self.missing);
        rows.sort_unstable();
        rows
    }

    /// Points and values of the known rows that an earlier run has checked.
    pub(super) fn confirmed_values(&self, rows: &[Vec<f64>]) -> (Vec<Vec<f64>>, Vec<Vec<Option<f64>>>) {
        let (points, values) = self.values(rows);
        let answered = points.into_iter().zip(values).enumerate();
        let confirmed = answered.filter(|(place, _)| self.unconfirmed.binary_search(place).is_err());
        confirmed.map(|(_, answered)| answered).unzip()
    }

    /// Points and values of the known rows.
    pub(super) fn values(&self, rows: &[Vec<f64>]) -> (Vec<Vec<f64>>, Vec<Vec<Option<f64>>>) {
        let values = |answers: &[Answer]| answers.iter().map(|answer| answer.as_ref().ok().copied()).collect();
        self.known.iter().map(|(row, answers)| (rows[*row].clone(), values(answers))).unzip()
    }
}
