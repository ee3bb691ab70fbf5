//! Advice as options of the command line.

use sensitol::warning::Advice;

/// Joins all advice in one line. Returns None if there is none.
pub(super) fn help(advice: &[Advice]) -> Option<String> {
    let all: Vec<String> = advice.iter().map(words).collect();
    (!all.is_empty()).then(|| all.join("; "))
}

/// Returns the advice as an option or a command if there is one, else in the words of the library.
pub(super) fn words(advice: &Advice) -> String {
    match advice {
        Advice::UseMethod { methods } => {
            let names: Vec<&str> = methods.iter().map(|method| method.name()).collect();
            match &names[..] {
                [most @ .., last] if !most.is_empty() => format!("use --method {} or {last}", most.join(", ")),
                _ => format!("use --method {}", names.concat()),
            }
        }
        Advice::RaiseBudget => "raise --budget".to_owned(),
        Advice::SetBudget => "allow that many with --budget".to_owned(),
        Advice::RaiseTimeLimit => "raise --time".to_owned(),
        Advice::LimitTime => "set a limit with --time S".to_owned(),
        Advice::Sample { points: None } => "run `sensitol simulate`".to_owned(),
        Advice::Sample { points: Some(points) } => format!("run `sensitol simulate --samples {points}`"),
        Advice::SampleRareEvents => "run `sensitol simulate --rare` where few are rejected".to_owned(),
        Advice::SamplePlainly => "leave out --rare".to_owned(),
        Advice::MorePoints => "raise --samples".to_owned(),
        Advice::Analyze => "run `sensitol analyze`, which samples the tails by themselves".to_owned(),
        Advice::SmallerStep { dimension: None } => "use a smaller --step".to_owned(),
        Advice::UseDifferences => "use --derivatives difference".to_owned(),
        Advice::ReadModelLog => "show all that the model writes to stderr with -v".to_owned(),
        Advice::IncludeFixedDimensions => "use --sensitivities all".to_owned(),
        Advice::AnalyzeWrittenStudy => "run `sensitol analyze` on the study that --write writes".to_owned(),
        Advice::NameMovableDimensions => "name dimensions to move with --recentre".to_owned(),
        Advice::WriteMissingPoints => "write them with --write-missing NEXT.csv".to_owned(),
        Advice::AnalyzeStages => {
            "run `sensitol analyze --points ANSWERS.csv --write-missing NEXT.csv` to get the next ones".to_owned()
        }
        other => phrase(&other.to_string()),
    }
}

/// Turns a sentence into a part of a line: without capital and full stop.
fn phrase(sentence: &str) -> String {
    let mut letters = sentence.trim_end_matches('.').chars();
    letters.next().map(|first| first.to_lowercase().chain(letters).collect()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use sensitol::method::Method;

    #[test]
    fn options_where_there_are_some_and_words_elsewhere() {
        let methods = vec![Method::Full, Method::Auto];
        let all = [Advice::UseMethod { methods }, Advice::CheckColumn];
        assert_eq!(help(&all).unwrap(), "use --method full or auto; check column and unit");
        assert_eq!(help(&[]), None);
    }
}
