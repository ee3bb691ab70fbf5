//! State of a search along derivatives, and its transitions. Nothing here evaluates a model.
//!
//! ```text
//!         +-- Ask(question) -- answer --> next round, at the point of the answer or with shorter steps
//! round --+-- Shorten ------------------> next round, at the point that kept everything
//!         +-- Done(finish)
//! ```
//!
//! `P` is a linearization point.

use crate::allocation::result::allocation::{Attainable, Proof, Status};
use crate::allocation::result::solver_result::{Chosen, Solved};
use crate::allocation::search::step::Steps;

/// Greatest factor of a tolerance within which derivatives are trusted to prove that nothing is possible. It is also the factor by which
/// tolerances may move in a step after the model has failed farther out.
const REACH: f64 = 1.5;
/// Greatest relative rise of the cost that counts as rounding, or as an effect of the margin of tolerances.
const DEARER: f64 = 1e-8;
/// Greatest move of a nominal value with which tolerances are chosen in the same round, in sigmas.
const SMALL_MOVE: f64 = 1.0;

/// Step that a round leads to.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::allocation) enum Next {
    /// Evaluation of the model.
    Ask(Question),
    /// Return to the point that kept everything, for shorter steps from there.
    Shorten,
    /// End of the search.
    Done(Finish),
}

/// Tolerances at which the model is evaluated.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::allocation) enum Question {
    /// Present tolerances, about moved nominal values.
    MovedNominals,
    /// Half bands that no choice led to: the tightest, and those that belong to moved nominal values.
    Tolerances(Vec<f64>),
    /// Chosen tolerances. The present point becomes the fallback if it kept everything at this cost.
    Choice { chosen: Box<Chosen>, kept_at_cost: Option<f64> },
}

/// Answer of the model to a question.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::allocation) enum Answer<P> {
    /// Linearization point.
    Point(P),
    /// Linearization point without the moments of every requirement: the model fails there.
    Failed(P),
    /// Part of an answer, because the run was stopped.
    Stopped(P),
    /// None, because the budget does not allow it.
    OverBudget,
}

/// End of a search.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::allocation) enum Finish {
    /// Tolerances chosen last.
    LastChoice,
    /// No tolerances: the status with the reason, and the best value of the requirement that is not kept.
    Nothing { status: Status, attainable: Option<Attainable> },
}

/// Order in which a round changes nominal values and tolerances.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::allocation) enum Recentring {
    /// Tolerances, about nominal values at rest.
    AtRest,
    /// Tolerances, about nominal values that move a little.
    Together,
    /// Nominal values alone. Tolerances are chosen about the place where they come to rest.
    First,
}

/// Point that keeps everything by the model. The search returns to it if derivatives mislead.
#[derive(Debug)]
struct Fallback<P> {
    point: P,
    at: Vec<f64>,
    last: Option<Chosen>,
    cost: f64,
}

/// Evidence of a search that has ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::allocation) struct Ended {
    /// True if the model confirmed the last choice.
    pub(in crate::allocation) agreed: bool,
    pub(in crate::allocation) within_budget: bool,
    /// Residual of nominal values and tolerances together, if both may change.
    pub(in crate::allocation) at_rest: Option<f64>,
}

/// Starts of the last round that began from several places.
#[derive(Debug, Default)]
struct SeveralStarts {
    begun: Option<usize>,
    reached: Option<usize>,
    other_optimum: Option<f64>,
}

/// State of a search between two rounds.
#[derive(Debug)]
pub(in crate::allocation) struct SearchState<P> {
    /// Present linearization point.
    pub(in crate::allocation) point: P,
    /// Half bands of the groups there.
    pub(in crate::allocation) at: Vec<f64>,
    /// Choice that led to the point. None if there was no choice.
    pub(in crate::allocation) last: Option<Chosen>,
    pub(in crate::allocation) ended: Ended,
    /// Greatest factor of a tolerance in a step.
    pub(in crate::allocation) reach: f64,
    fallback: Option<Fallback<P>>,
    steps: Steps,
    at_tightest: bool,
    starts: SeveralStarts,
}

impl<P> SearchState<P> {
    /// State before the first round.
    pub(in crate::allocation) fn new(point: P, at: Vec<f64>) -> Self {
        Self {
            point,
            at,
            last: None,
            ended: Ended { agreed: false, within_budget: true, at_rest: None },
            reach: f64::INFINITY,
            fallback: None,
            steps: Steps::default(),
            at_tightest: false,
            starts: SeveralStarts::default(),
        }
    }

    /// True if nothing is known yet that a search from elsewhere could lose.
    pub(in crate::allocation) fn is_fresh(&self) -> bool {
        self.last.is_none() && self.fallback.is_none()
    }

    /// Order of a move of nominal values by `far` sigmas. They are at rest within `rest`. `joint` is true if tolerances
    /// belong to them, `priced` if there are tolerances to choose.
    pub(in crate::allocation) fn recentring([far, rest]: [f64; 2], joint: bool, priced: bool) -> Recentring {
        match far <= rest {
            true => Recentring::AtRest,
            false if joint || far > SMALL_MOVE || !priced => Recentring::First,
            false => Recentring::Together,
        }
    }

    /// True if the model finds the point dearer than the fallback. Losses may be greater than derivatives foretold.
    pub(in crate::allocation) fn is_dearer_than_fallback(&self, cost_here: f64) -> bool {
        let limit = self.fallback.as_ref().map(|fallback| fallback.cost * (1.0 + DEARER));
        self.last.is_some() && limit.is_some_and(|limit| cost_here > limit)
    }

    /// Step after derivatives by which no tolerances keep everything, even the tightest. Returns None if the model has
    /// confirmed that.
    pub(in crate::allocation) fn without_choice(&mut self, tightest: Vec<f64>) -> Option<Next> {
        // Derivatives led astray: shorter steps from where everything was kept.
        if self.fallback.is_some() {
            return Some(Next::Shorten);
        }
        // Derivatives at other tolerances may be wrong there: the model is asked first.
        if !self.at_tightest && farthest(&self.at, &tightest) > libm::log(REACH) {
            self.at_tightest = true;
            return Some(Next::Ask(Question::Tolerances(tightest)));
        }
        None
    }

    /// Carries the starts of the last round that had several into the proof of a later one.
    pub(in crate::allocation) fn keep_starts(&mut self, proof: &mut Proof) {
        if proof.starts.is_some() {
            let (begun, reached) = (proof.starts, proof.reached);
            self.starts = SeveralStarts { begun, reached, other_optimum: proof.other_optimum };
        }
        let SeveralStarts { begun, reached, other_optimum } = self.starts;
        (proof.starts, proof.reached, proof.other_optimum) = (begun, reached, other_optimum);
    }

    /// True if the choice that led to the point is chosen again, within a relative change. Offers are compared if
    /// processes of one tolerance may differ.
    pub(in crate::allocation) fn is_chosen_again(
        &self,
        (solved, offers, _): &Chosen,
        change: f64,
        by_offer: bool,
    ) -> bool {
        let alike = |(_, last, _): &Chosen| !by_offer || last == offers;
        self.last.as_ref().is_some_and(alike) && farthest(&self.at, &solved.at) <= change
    }

    /// Confirms the tolerances at which the model was evaluated, with the multipliers of the same choice and its residual there.
    pub(in crate::allocation) fn confirm(&mut self, (solved, _, proof): Chosen, residual_at: impl Fn(&[f64]) -> f64) {
        self.last = self.last.take().map(|(old, offers, _)| {
            let residual = proof.residual.map(|_| residual_at(&old.at));
            (Solved { multipliers: solved.multipliers, ..old }, offers, Proof { residual, ..proof })
        });
        self.ended.agreed = true;
    }

    /// Half bands part of the way to chosen ones, as far as the last steps advise. Returns None for the whole way.
    pub(in crate::allocation) fn part_way(&mut self, to: &[f64]) -> Option<Vec<f64>> {
        self.steps.shortened(&self.at, to)
    }

    /// Returns to the fallback, for shorter steps from there.
    pub(in crate::allocation) fn shorten(&mut self) {
        if let Some(Fallback { point, at, last, .. }) = self.fallback.take() {
            (self.point, self.at, self.last) = (point, at, last);
        }
        (self.reach, self.steps) = (shorter(self.reach), Steps::default());
    }

    /// Takes the answer to a question. Returns the end, if this is one.
    pub(in crate::allocation) fn take(&mut self, question: Question, answer: Answer<P>) -> Option<Finish> {
        match question {
            Question::MovedNominals => self.move_to(answer),
            Question::Tolerances(at) => {
                (self.at, self.last) = (at, None);
                self.move_to(answer)
            }
            Question::Choice { chosen, kept_at_cost } => self.take_choice(*chosen, kept_at_cost, answer),
        }
    }

    /// Moves to the point of an answer. A point where the model fails is still one to choose from.
    fn move_to(&mut self, answer: Answer<P>) -> Option<Finish> {
        match answer {
            Answer::Point(point) | Answer::Failed(point) => {
                self.point = point;
                return None;
            }
            Answer::Stopped(_) => {}
            Answer::OverBudget => self.ended.within_budget = false,
        }
        Some(Finish::LastChoice)
    }

    /// Takes the answer at chosen tolerances. The point before becomes the fallback if it kept everything.
    fn take_choice(&mut self, chosen: Chosen, kept_at_cost: Option<f64>, answer: Answer<P>) -> Option<Finish> {
        let stopped = matches!(answer, Answer::Stopped(_));
        match answer {
            Answer::Point(point) | Answer::Stopped(point) => {
                let at = std::mem::replace(&mut self.at, chosen.0.at.clone());
                let point = std::mem::replace(&mut self.point, point);
                let last = self.last.replace(chosen);
                if let Some(cost) = kept_at_cost {
                    self.fallback = Some(Fallback { point, at, last, cost });
                }
            }
            // The model fails so far out: shorter steps from where it did not.
            Answer::Failed(_) => self.reach = shorter(self.reach),
            Answer::OverBudget => {
                self.at.clone_from(&chosen.0.at);
                (self.ended.within_budget, self.last) = (false, Some(chosen));
                return Some(Finish::LastChoice);
            }
        }
        stopped.then_some(Finish::LastChoice)
    }
}

/// Largest change of a half band, in logarithms.
fn farthest(from: &[f64], to: &[f64]) -> f64 {
    from.iter().zip(to).map(|(a, b)| libm::log(b / a).abs()).fold(0.0, f64::max)
}

/// Reach for shorter steps.
fn shorter(reach: f64) -> f64 {
    if reach.is_finite() { reach.sqrt() } else { REACH }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::allocation::result::solver_result::Starts;

    /// Points are named by letters here.
    type State = SearchState<char>;

    fn state() -> State {
        SearchState::new('a', vec![0.1, 0.2])
    }

    fn chosen(at: &[f64], offers: &[usize]) -> Chosen {
        let solved = Solved {
            at: at.to_vec(),
            cost: 3.0,
            multipliers: vec![0.5],
            residual: 1e-9,
            value: 1.0,
            closed: false,
            converged: true,
            sequential: false,
            starts: Starts::default(),
        };
        (solved, offers.to_vec(), Proof { residual: Some(1e-9), ..Proof::default() })
    }

    fn choice(at: &[f64], kept_at_cost: Option<f64>) -> Question {
        Question::Choice { chosen: Box::new(chosen(at, &[0, 0])), kept_at_cost }
    }

    /// State after a choice at `b`, from `a`, which kept everything at a cost of 5.
    fn after_a_choice() -> State {
        let mut state = state();
        assert_eq!(state.take(choice(&[0.3, 0.4], Some(5.0)), Answer::Point('b')), None);
        state
    }

    #[test]
    fn an_answer_to_a_choice_is_the_next_point() {
        let state = after_a_choice();
        assert_eq!((state.point, &state.at[..]), ('b', &[0.3, 0.4][..]));
        assert!(state.last.is_some() && !state.is_fresh() && !state.ended.agreed);
    }

    #[test]
    fn a_point_that_kept_everything_is_returned_to() {
        let mut state = after_a_choice();
        state.shorten();
        assert_eq!((state.point, &state.at[..], state.reach), ('a', &[0.1, 0.2][..], REACH));
        assert!(state.is_fresh());
        // Without a fallback only the reach falls.
        state.shorten();
        assert_eq!((state.point, state.reach), ('a', REACH.sqrt()));
    }

    #[test]
    fn a_point_that_broke_a_requirement_is_no_fallback() {
        let mut state = state();
        state.take(choice(&[0.3, 0.4], None), Answer::Point('b'));
        state.shorten();
        assert_eq!(state.point, 'b');
    }

    #[test]
    fn a_failed_choice_shortens_the_steps() {
        let mut state = state();
        assert_eq!(state.take(choice(&[0.3, 0.4], Some(5.0)), Answer::Failed('b')), None);
        assert_eq!((state.point, &state.at[..], state.reach), ('a', &[0.1, 0.2][..], REACH));
        assert!(state.is_fresh());
    }

    #[test]
    fn a_choice_beyond_the_budget_is_the_end() {
        let mut state = state();
        assert_eq!(state.take(choice(&[0.3, 0.4], None), Answer::OverBudget), Some(Finish::LastChoice));
        assert_eq!((state.point, &state.at[..], state.ended.within_budget), ('a', &[0.3, 0.4][..], false));
        assert!(state.last.is_some());
    }

    #[test]
    fn a_stopped_choice_is_the_end_at_its_point() {
        let mut state = state();
        assert_eq!(state.take(choice(&[0.3, 0.4], None), Answer::Stopped('b')), Some(Finish::LastChoice));
        assert_eq!((state.point, state.ended.within_budget), ('b', true));
    }

    #[test]
    fn tolerances_without_a_choice_forget_the_last_one() {
        let mut state = after_a_choice();
        assert_eq!(state.take(Question::Tolerances(vec![0.01, 0.02]), Answer::Failed('c')), None);
        assert_eq!((state.point, &state.at[..], state.last.is_none()), ('c', &[0.01, 0.02][..], true));
    }

    #[test]
    fn moved_nominal_values_keep_the_tolerances() {
        let mut state = after_a_choice();
        assert_eq!(state.take(Question::MovedNominals, Answer::Point('c')), None);
        assert_eq!((state.point, &state.at[..], state.last.is_some()), ('c', &[0.3, 0.4][..], true));
        assert_eq!(state.take(Question::MovedNominals, Answer::OverBudget), Some(Finish::LastChoice));
        assert_eq!((state.point, state.ended.within_budget), ('c', false));
    }

    #[test]
    fn a_stopped_move_stays_where_it_was() {
        let mut state = state();
        assert_eq!(state.take(Question::MovedNominals, Answer::Stopped('b')), Some(Finish::LastChoice));
        assert_eq!((state.point, state.ended.within_budget), ('a', true));
    }

    #[test]
    fn nominal_values_move_first_if_they_move_far() {
        assert_eq!(State::recentring([1e-7, 1e-6], true, true), Recentring::AtRest);
        assert_eq!(State::recentring([0.5, 1e-6], false, true), Recentring::Together);
        assert_eq!(State::recentring([0.5, 1e-6], true, true), Recentring::First);
        assert_eq!(State::recentring([0.5, 1e-6], false, false), Recentring::First);
        assert_eq!(State::recentring([2.0, 1e-6], false, true), Recentring::First);
    }

    #[test]
    fn a_dearer_point_is_left() {
        let state = after_a_choice();
        assert!(!state.is_dearer_than_fallback(5.0) && state.is_dearer_than_fallback(5.1));
        // A start is dearer than nothing.
        assert!(!self::state().is_dearer_than_fallback(1e9));
    }

    #[test]
    fn without_a_choice_the_search_goes_back_then_to_the_tightest_then_ends() {
        assert_eq!(after_a_choice().without_choice(vec![0.01, 0.02]), Some(Next::Shorten));
        let mut state = state();
        let tightest = vec![0.01, 0.02];
        let asked = Question::Tolerances(tightest.clone());
        assert_eq!(state.without_choice(tightest.clone()), Some(Next::Ask(asked.clone())));
        state.take(asked, Answer::Point('t'));
        assert_eq!(state.without_choice(tightest), None);
        // Tolerances near the tightest need no question.
        assert_eq!(self::state().without_choice(vec![0.09, 0.18]), None);
    }

    #[test]
    fn a_choice_is_the_same_within_a_change() {
        let state = after_a_choice();
        let near = chosen(&[0.3 * 1.0005, 0.4], &[0, 0]);
        assert!(state.is_chosen_again(&near, 1e-3, true) && !state.is_chosen_again(&near, 1e-4, true));
        let other = chosen(&[0.3, 0.4], &[0, 1]);
        assert!(state.is_chosen_again(&other, 1e-3, false) && !state.is_chosen_again(&other, 1e-3, true));
        assert!(!self::state().is_chosen_again(&chosen(&[0.1, 0.2], &[0, 0]), 1.0, false));
    }

    #[test]
    fn a_confirmed_choice_keeps_its_tolerances_and_takes_the_multipliers() {
        let mut state = after_a_choice();
        let mut again = chosen(&[0.3001, 0.4], &[0, 0]);
        again.0.multipliers = vec![0.75];
        state.confirm(again, |at| at[0]);
        let (solved, _, proof) = state.last.expect("a choice");
        assert_eq!((&solved.at[..], solved.multipliers, proof.residual), (&[0.3, 0.4][..], vec![0.75], Some(0.3)));
        assert!(state.ended.agreed);
    }

    #[test]
    fn the_starts_of_an_earlier_round_stay_in_the_proof() {
        let mut state = state();
        let mut several = Proof { starts: Some(8), reached: Some(5), other_optimum: Some(2.0), ..Proof::default() };
        state.keep_starts(&mut several);
        let mut single = Proof::default();
        state.keep_starts(&mut single);
        assert_eq!((single.starts, single.reached, single.other_optimum), (Some(8), Some(5), Some(2.0)));
    }
}
