//! Choice of the result among the end of a search, the study's own tolerances, and a search by trials.

/// Relative difference of costs within which they are the same.
pub(super) const SAME: f64 = 1e-9;

/// Facts about the end of a search along derivatives and the study's own tolerances.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Standing {
    /// True if the study's own tolerances keep everything and are offered.
    pub(super) start_kept: bool,
    /// True if the search has chosen tolerances.
    pub(super) end_exists: bool,
    /// True if these keep everything.
    pub(super) end_kept: bool,
    /// True if the model confirmed that derivatives choose them again.
    pub(super) end_agreed: bool,
    /// True if they cost more than the study's own.
    pub(super) end_dearer: bool,
    /// True if it is proven that no tolerances keep everything.
    pub(super) infeasible: bool,
}

/// Step after a search along derivatives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum AfterSearch {
    /// The end of the search is the result.
    TakeEnd,
    /// There is no result.
    TakeNothing,
    /// A search by trials follows.
    SearchByTrials,
}

/// Origin of the result.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Origin {
    Trials,
    Start,
    End,
}

impl Standing {
    /// Step that follows.
    pub(super) fn next(self) -> AfterSearch {
        if self.end_kept && self.end_agreed && !self.end_dearer {
            return AfterSearch::TakeEnd;
        }
        match !self.end_exists && self.infeasible && !self.start_kept {
            true => AfterSearch::TakeNothing,
            false => AfterSearch::SearchByTrials,
        }
    }
}

/// Origin of the cheapest result by the costs of those that keep everything. The start stands before an end of the same
/// cost, and the end is left if nothing keeps everything.
pub(super) fn cheapest(trials: Option<f64>, start: Option<f64>, end: Option<f64>) -> Origin {
    let cheaper = |cost: f64, other: Option<f64>| other.is_none_or(|other| cost < other * (1.0 - SAME));
    match (trials, start) {
        (Some(cost), _) if cheaper(cost, end) && cheaper(cost, start) => Origin::Trials,
        (_, Some(_)) if end.is_none_or(|end| !cheaper(end, start)) => Origin::Start,
        _ => Origin::End,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD_END: Standing = Standing {
        start_kept: true,
        end_exists: true,
        end_kept: true,
        end_agreed: true,
        end_dearer: false,
        infeasible: false,
    };

    #[test]
    fn a_confirmed_end_that_is_not_dearer_is_the_result() {
        assert_eq!(GOOD_END.next(), AfterSearch::TakeEnd);
        for doubtful in [
            Standing { end_kept: false, ..GOOD_END },
            Standing { end_agreed: false, ..GOOD_END },
            Standing { end_dearer: true, ..GOOD_END },
        ] {
            assert_eq!(doubtful.next(), AfterSearch::SearchByTrials, "{doubtful:?}");
        }
    }

    #[test]
    fn only_a_proof_ends_without_a_result() {
        let nothing = Standing { end_exists: false, end_kept: false, start_kept: false, infeasible: true, ..GOOD_END };
        assert_eq!(nothing.next(), AfterSearch::TakeNothing);
        assert_eq!(Standing { infeasible: false, ..nothing }.next(), AfterSearch::SearchByTrials);
        assert_eq!(Standing { start_kept: true, ..nothing }.next(), AfterSearch::SearchByTrials);
    }

    #[test]
    fn the_cheapest_that_keeps_everything_is_the_result() {
        assert_eq!(cheapest(Some(1.0), Some(3.0), Some(2.0)), Origin::Trials);
        assert_eq!(cheapest(Some(2.0), Some(3.0), Some(1.0)), Origin::End);
        assert_eq!(cheapest(Some(2.0), Some(1.0), Some(3.0)), Origin::Start);
        assert_eq!(cheapest(None, Some(1.0), None), Origin::Start);
        assert_eq!(cheapest(Some(1.0), None, None), Origin::Trials);
        assert_eq!(cheapest(None, None, None), Origin::End);
    }

    #[test]
    fn equal_costs_change_nothing() {
        assert_eq!(cheapest(Some(1.0), Some(1.0), Some(1.0)), Origin::Start);
        assert_eq!(cheapest(Some(1.0), None, Some(1.0 + 1e-12)), Origin::End);
    }
}
