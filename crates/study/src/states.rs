//! Combines several configurations of a study: the dimensions and tolerances are shared, and every characteristic occurs once for each.

use crate::Study;
use sensitol::allocation::QualityLoss;
use sensitol::problem::{Problem, ProblemError};

impl Study {
    /// The study with every characteristic once for each of these configurations of it, named `gap [hot]`. All requirements apply in each
    /// of them, with the same tolerances. Nominal values are those of the study itself; a configuration moves them, and sets constants.
    ///
    /// # Errors
    /// Fails if a dimension has another tolerance in a configuration, which happens for percentages of a nominal value.
    ///
    /// ```
    /// use sensitol_study::Study;
    /// use sensitol_study::{Externals, StudyText};
    /// let text = "[dimensions]\na = { nominal = 10.0, tolerance = 0.1 }\n[constants]\nplay = 0.0\n\
    ///     [characteristics]\ngap = { formula = \"a - 9 - play\", lower = 0.5 }\n\
    ///     [configurations]\ncold = { play = 0.1 }\nlong = { a = 11.0 }\n";
    /// let read = |externals| Study::from_text(StudyText::toml("gap.toml", text).with_externals(externals));
    /// let study = read(Externals::default())?;
    /// let of = |name: &str| Ok::<_, sensitol_study::StudyError>((name.to_owned(), read(Externals::default().with_configuration(name))?));
    /// let all = study.in_configurations(&[of("cold")?, of("long")?])?;
    /// let names: Vec<&str> = all.problem.characteristics().iter().map(|one| one.name()).collect();
    /// assert_eq!(names, ["gap [cold]", "gap [long]"]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn in_configurations(mut self, configurations: &[(String, Self)]) -> Result<Self, ProblemError> {
        let problems: Vec<(&str, &Problem)> =
            configurations.iter().map(|(name, study)| (name.as_str(), &study.problem)).collect();
        let problem = self.problem.in_states(&problems)?;
        let per_state = self.problem.characteristics().len();
        let again = |(name, _): &(String, Self)| {
            let of =
                |(characteristic, requirement): &(String, _)| (Problem::in_state(characteristic, name), *requirement);
            self.requirements.iter().map(of).collect::<Vec<_>>()
        };
        self.requirements = configurations.iter().flat_map(again).collect();
        let losses = |state: usize| {
            let of = move |loss: &QualityLoss| {
                let mut moved = *loss;
                moved.characteristic += state * per_state;
                moved
            };
            self.losses.iter().map(of).collect::<Vec<_>>()
        };
        self.losses = (0..configurations.len()).flat_map(losses).collect();
        self.problem = problem;
        Ok(self)
    }
}
