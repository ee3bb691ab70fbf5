//! Evaluations that samples of a cheap model may still use.

/// Rest of the budget for points of a cheap model: for its verification, the joint yield, correlations and Sobol' indices. A budget limits
/// them as it limits the points of a plan, although no report counts them as evaluations.
#[derive(Debug, Clone, Copy)]
pub(in crate::analysis) struct SampleBudget {
    /// Evaluations that are left. None if there is no budget.
    left: Option<usize>,
}

impl SampleBudget {
    /// Budget with `left` evaluations. None if there is no budget.
    pub(in crate::analysis) fn new(left: Option<usize>) -> Self {
        Self { left }
    }

    /// Evaluations for each of `parts` equal parts. None if there is no budget.
    pub(in crate::analysis) fn each(&self, parts: usize) -> Option<usize> {
        self.left.map(|left| left / parts.max(1))
    }

    /// Takes evaluations that were spent already.
    pub(in crate::analysis) fn spend(&mut self, evaluations: usize) {
        self.left = self.left.map(|left| left.saturating_sub(evaluations));
    }

    /// Takes evaluations that are to be spent. Returns false, and takes nothing, if not so many are left.
    pub(in crate::analysis) fn take(&mut self, evaluations: usize) -> bool {
        let affordable = self.left.is_none_or(|left| evaluations <= left);
        if affordable {
            self.spend(evaluations);
        }
        affordable
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_budget_is_never_exceeded() {
        let mut budget = SampleBudget::new(Some(100));
        assert_eq!(budget.each(3), Some(33));
        assert!(budget.take(60) && !budget.take(41) && budget.take(40) && !budget.take(1));
        budget.spend(5);
        assert_eq!(budget.each(1), Some(0));
    }

    #[test]
    fn without_a_budget_everything_is_affordable() {
        let mut budget = SampleBudget::new(None);
        assert!(budget.take(usize::MAX) && budget.each(2).is_none());
    }
}
