//! Hostile names and starved systems: text on a terminal, a full stderr, a protected file, a process without memory or threads.

use std::io::Read;
use std::os::unix::fs::PermissionsExt;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

use sensitol_study::Study;

use super::command::sensitol;
use sensitol_testing::{faults, parse};

fn study(folder: &tempfile::TempDir, name: &str, text: &str) -> PathBuf {
    let path = folder.path().join(name);
    std::fs::write(&path, text).unwrap();
    path
}

const PLAIN: &str =
    "[dimensions]\na = { nominal = 10, tolerance = 0.3 }\n[characteristics]\ngap = { formula = \"a\", lower = 9.8 }\n";

/// Runs the command in a shell with this limit or redirection; `$0` is the program.
fn in_shell(script: &str, arguments: &[&str]) -> Output {
    let program = sensitol(&[]).get_program().to_owned();
    // The path of the program becomes `$0` of the script.
    Command::new("bash").arg("-c").arg(script).arg(program).args(arguments).env("LC_ALL", "C.UTF-8").output().unwrap()
}

#[test]
fn names_that_are_not_seen_are_refused() {
    let all = faults(&[
        "[dimensions]\n\"a\\u001B[2Jb\" = { nominal = 1 }\n[characteristics]\ny = { formula = \"1\" }\n",
        "[dimensions]\n\"a\\u202Eb\" = { nominal = 1 }\n[characteristics]\ny = { formula = \"1\" }\n",
        "[dimensions]\na = { nominal = 1 }\n[characteristics]\n\"y\\u0007\" = { formula = \"a\" }\n",
        "[dimensions]\na = { nominal = 1 }\n[constants]\n\"k\\n\" = 3\n[characteristics]\ny = { formula = \"a\" }\n",
    ]);
    insta::assert_snapshot!("hidden-characters", all);
    // Letters of any script are names.
    assert!(
        parse("[dimensions]\n\"Länge ℓ\" = { nominal = 1 }\n[characteristics]\ny = { formula = \"`Länge ℓ`\" }\n")
            .is_ok()
    );
}

/// Titles, units and the stderr of a model are foreign text: none of their escape sequences reaches the terminal, on any stream of any
/// command, with colours on or off.
#[test]
fn nothing_moves_the_cursor() {
    let folder = tempfile::tempdir().unwrap();
    let hostile = "title = \"t\\u001B[2J\\u202Et\"\n[dimensions]\na = { nominal = 10, tolerance = 0.3, unit = \"m\\u001B]0;x\\u0007m\" }\n\
        idle = { nominal = 1, tolerance = 0.1 }\n[characteristics]\ngap = { formula = \"sqrt(a - 10)\", lower = 0, unit = \"\\u0008\\u009Bm\" }\n";
    let path = study(&folder, "hostile.toml", hostile).display().to_string();
    let commands: [&[&str]; 8] = [
        &["check", &path],
        &["plan", &path],
        &["analyze", &path],
        &["analyze", &path, "--stack"],
        &["analyze", &path, "-v"],
        &["simulate", &path, "--samples", "200"],
        &["compare", &path, "--samples", "2000"],
        &["check", "no\u{1b}[2Jfile\u{202e}.toml"],
    ];
    for command in commands {
        for color in ["always", "never"] {
            let output = sensitol(&[command, &["--color", color]].concat()).output().unwrap();
            for bytes in [&output.stdout, &output.stderr] {
                let text = String::from_utf8(bytes.clone()).unwrap();
                let colours = text
                    .split("\u{1b}[")
                    .skip(1)
                    .all(|rest| rest.trim_start_matches(|c: char| c.is_ascii_digit() || c == ';').starts_with('m'));
                let hidden = text.chars().find(|&c| {
                    (c.is_control() && c != '\n' && c != '\u{1b}') || ('\u{202a}'..='\u{202e}').contains(&c)
                });
                assert!(colours && hidden.is_none(), "{command:?} {color}: {hidden:?} in {text:?}");
            }
        }
    }
}

/// Exit code and stdout are unaffected by a stderr that fails.
#[test]
fn a_stderr_that_takes_nothing_changes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let warned = PLAIN.replace("[characteristics]", "idle = { nominal = 1, tolerance = 0.1 }\n[characteristics]");
    let path = study(&folder, "a.toml", &warned).display().to_string();
    let second = study(&folder, "b.toml", PLAIN).display().to_string();
    let expected = sensitol(&["analyze", &path, &second]).output().unwrap();
    assert!(expected.status.success() && !expected.stderr.is_empty());
    for script in ["\"$0\" \"$@\" 2>/dev/full", "\"$0\" \"$@\" 2>&-"] {
        let output = in_shell(script, &["analyze", &path, &second]);
        assert_eq!((output.status.code(), output.stdout), (Some(0), expected.stdout.clone()), "{script}");
        assert_eq!(in_shell(script, &["check", "nowhere.toml"]).status.code(), Some(2), "{script}");
    }
}

#[test]
fn a_full_stdout_is_one_line_and_exit_2() {
    let folder = tempfile::tempdir().unwrap();
    let path = study(&folder, "a.toml", PLAIN).display().to_string();
    let output = in_shell("\"$0\" \"$@\" >/dev/full", &["analyze", &path]);
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(said.contains("cannot write to standard output") && said.lines().count() == 1, "{said}");
}

/// Without memory there is one line and exit code 2, or the whole report, but never a panic.
#[test]
fn little_memory_is_no_panic() {
    let folder = tempfile::tempdir().unwrap();
    let path = study(&folder, "a.toml", PLAIN).display().to_string();
    for kilobytes in [20_000, 60_000, 200_000] {
        let output = in_shell(&format!("ulimit -v {kilobytes}; \"$0\" \"$@\""), &["analyze", &path, "--threads", "4"]);
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(!said.contains("panicked"), "{kilobytes}: {said}");
    }
}

/// Overwriting keeps the mode, a protected file stays, and no other file is left in the folder.
#[test]
fn files_keep_their_mode_and_protection() {
    let folder = tempfile::tempdir().unwrap();
    let path = study(&folder, "a.toml", PLAIN).display().to_string();
    let report = study(&folder, "report.txt", "");
    std::fs::set_permissions(&report, std::fs::Permissions::from_mode(0o640)).unwrap();
    let to = report.display().to_string();
    assert!(sensitol(&["analyze", &path, "-o", &to]).status().unwrap().success());
    assert_eq!(std::fs::metadata(&report).unwrap().permissions().mode() & 0o777, 0o640);
    std::fs::set_permissions(&report, std::fs::Permissions::from_mode(0o440)).unwrap();
    let before = std::fs::read_to_string(&report).unwrap();
    let output = sensitol(&["analyze", &path, "--method", "rss", "-o", &to]).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.code() == Some(2) && said.contains("read-only"), "{said}");
    assert_eq!(std::fs::read_to_string(&report).unwrap(), before);
    let mut left: Vec<_> = std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    left.sort();
    assert_eq!(left, ["a.toml", "report.txt"]);
}

/// A run that is killed leaves no temporary file.
#[test]
fn a_killed_run_leaves_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = study(&folder, "a.toml", PLAIN).display().to_string();
    let to = folder.path().join("report.txt").display().to_string();
    let mut child = sensitol(&["simulate", &path, "--samples", "100000000000", "-o", &to, "--progress", "always"])
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // The run works as soon as it shows progress.
    let mut first = [0];
    let _ = child.stderr.as_mut().unwrap().read(&mut first);
    child.kill().unwrap();
    child.wait().unwrap();
    let left: Vec<_> = std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left, ["a.toml"]);
}

/// All independent faults in the order of the file, at most twenty.
#[test]
fn all_faults_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let text = "[dimensions]\na = { nominal = 10, tolerence = 0.3 }\nb = { nominal = \"x\" }\n[characteristics]\ny = { formula = \"a\", lower = true }\n";
    let error = Study::from_toml(text, "s.toml").unwrap_err();
    let keys: Vec<&str> = std::iter::once(&error).chain(&error.more).map(|one| one.key.as_str()).collect();
    assert_eq!(keys, ["dimensions.a.tolerence", "dimensions.b.nominal", "characteristics.y.lower"]);
    assert!(error.to_string().ends_with("; and 2 more faults"), "{error}");
    let text = "[dimensions]\na = { nominal = 10, tolerance = -0.3 }\nc = { tolerance = 0.3 }\n[characteristics]\n\
        y = { formula = \"a +* 1\" }\nz = { formula = \"sqrt(a\", lower = 3, upper = 2 }\n";
    study(&folder, "s.toml", text);
    let output = sensitol(&["check", "s.toml"]).current_dir(&folder).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    insta::assert_snapshot!("all-faults", String::from_utf8(output.stderr).unwrap());
    let many: String = (0..30).map(|i| format!("d{i} = {{ nominal = 1, tolerance = -1 }}\n")).collect();
    let error = parse(&format!("[dimensions]\n{many}[characteristics]\ny = {{ formula = \"1\" }}\n")).unwrap_err();
    assert_eq!(1 + error.more.len(), Study::MOST_FAULTS);
}

#[test]
fn slips_are_told_what_was_meant() {
    let of = |line: &str| format!("[dimensions]\n{line}\n[characteristics]\ny = {{ formula = \"1\" }}\n");
    let formula = |text: &str| {
        format!(
            "[dimensions]\npin-d = {{ nominal = 1 }}\n\"pin length\" = {{ nominal = 1 }}\na = {{ nominal = 1 }}\n[characteristics]\ny = {{ formula = \"{text}\" }}\n"
        )
    };
    let texts = [
        of("a = { nominal = 10,0, tolerance = 0.3 }"),
        of("a = { nominal = \"10,0\" }"),
        of("a = { nominal = \"10.0\" }"),
        of("a = { nominal = 1, unit = \u{201c}mm\u{201d} }"),
        of("a = { nominal = \u{2212}10 }"),
        of("a = { nominal = 10 tolerance = 0.3 }"),
        formula("a \u{2212} 1"),
        formula("math.sin(a)"),
        formula("pin-d + 1"),
        formula("2*pin length"),
        formula("a \u{d7} 2"),
        of("a = { nominal = 1 }").replace("formula = \"1\"", "formula = \"a\", lower = 0, target_yield = 99.73"),
        of("a = { nominal = 1 }").replace("{ formula = \"1\" }", "{}\n[model]\ncommand = \"python3 model.py\""),
    ];
    insta::assert_snapshot!("slips", faults(&texts.iter().map(String::as_str).collect::<Vec<_>>()));
}

/// A formula of 100 kB is cut in messages, and shown only around the fault.
#[test]
fn long_formulas_make_short_messages() {
    let folder = tempfile::tempdir().unwrap();
    let sum = vec!["a"; 50_000].join("+");
    for formula in [format!("sqrt({sum} - 1e9)"), format!("{sum} +* a"), format!("{sum} + b")] {
        let text = format!(
            "[dimensions]\na = {{ nominal = 1, tolerance = 0.1 }}\n[characteristics]\ny = {{ formula = \"{formula}\" }}\n"
        );
        let path = study(&folder, "long.toml", &text).display().to_string();
        let output = sensitol(&["analyze", &path, "--verify", "0"]).output().unwrap();
        let said = String::from_utf8([output.stdout, output.stderr].concat()).unwrap();
        let longest = said.lines().map(|line| line.chars().count()).max().unwrap();
        assert!(longest < 600, "{longest}: {}", said.lines().next().unwrap());
    }
}

/// The temporary files of a killed run disappear when the next run writes there. Files that another run is writing stay.
#[test]
fn leftovers_go_at_the_next_start() {
    let folder = tempfile::tempdir().unwrap();
    let path = study(&folder, "a.toml", PLAIN).display().to_string();
    let [old, young, other] = [".sensitol-old", ".sensitol-young", "sensitol-old"].map(|name| study(&folder, name, ""));
    let long_ago = std::time::SystemTime::now() - std::time::Duration::from_secs(2 * 3600);
    for file in [&old, &other] {
        std::fs::File::options().write(true).open(file).unwrap().set_modified(long_ago).unwrap();
    }
    let report = folder.path().join("report.txt");
    assert!(sensitol(&["analyze", &path, "-o", &report.display().to_string()]).status().unwrap().success());
    assert_eq!([old, young, other, report].map(|file| file.exists()), [false, true, true, true]);
}

/// Units of different kinds in a sum give one warning for all formulas. Converted units give none.
#[test]
fn sums_of_different_units_warn() {
    let text = "[dimensions]\na = { nominal = 1, unit = \"mm\" }\nphi = { nominal = 1, unit = \"deg\" }\n[formulas]\nboth = \"a + phi\"\n\
        [characteristics]\ny = { formula = \"2*both\" }\nz = { formula = \"a < phi\" }\nok = { formula = \"a + 7*phi + a*sin(phi*deg)\" }\n";
    let warnings = parse(text).unwrap().warnings;
    let messages: Vec<String> =
        warnings.iter().map(|warning| format!("[{}] {}", warning.code(), warning.message())).collect();
    assert_eq!(
        messages,
        [
            "[unit-mismatch] The units of formulas.both do not go together. Column 1, `a + phi`, is a sum of mm and deg. The numbers are used as they \
             are. To correct it, correct the unit of one of them, or the formula. The same is true of `z`."
        ]
    );
    let alike = text.replace("unit = \"deg\"", "unit = \"mm\"").replace("a + 7*phi + a*sin(phi*deg)", "a + phi");
    assert_eq!(parse(&alike).unwrap().warnings, []);
}

/// Many warnings with one code: three are printed, then the names of the others. --verbose prints all.
#[test]
fn warnings_of_one_code_are_counted() {
    let folder = tempfile::tempdir().unwrap();
    let many: String = (0..40).map(|i| format!("y{i} = {{ formula = \"abs(a - 10) + {i}\" }}\n")).collect();
    let text = format!("[dimensions]\na = {{ nominal = 10, tolerance = 0.3 }}\n[characteristics]\n{many}");
    let path = study(&folder, "a.toml", &text).display().to_string();
    let said = |more: &[&str]| {
        let output =
            sensitol(&[&["analyze", &path, "--verify", "0", "--method", "rss"], more].concat()).output().unwrap();
        String::from_utf8(output.stderr)
            .unwrap()
            .lines()
            .filter(|line| line.starts_with("warning"))
            .map(str::to_owned)
            .collect::<Vec<_>>()
    };
    let short = said(&[]);
    let codes: std::collections::BTreeSet<&str> = short.iter().map(|line| line.split(':').next().unwrap()).collect();
    assert!(!codes.is_empty());
    for code in codes {
        let all = said(&["--verbose"]).iter().filter(|line| line.starts_with(code)).count();
        let own: Vec<&String> = short.iter().filter(|line| line.starts_with(code)).collect();
        assert_eq!((all, own.len()), (40, 4), "{code}");
        assert_eq!(own[3], &format!("{code}: 37 more of this kind: `y3`, `y4`, `y5`, `y6`, `y7`, ..."));
    }
}

/// Results are right at any size: never infinite or unknown, and never 0 instead.
#[test]
fn results_that_overflow_say_so() {
    let folder = tempfile::tempdir().unwrap();
    for size in ["1e90", "1e110", "1e160", "1e200", "1e300"] {
        let text = format!(
            "[dimensions]\na = {{ nominal = 10, tolerance = 0.3 }}\nb = {{ nominal = 10, tolerance = 0.3 }}\n[characteristics]\n\
             y = {{ formula = \"{size}*a*b\", lower = 0, require = {{ cpk = 0.5 }} }}\n[costs]\n\
             a = {{ model = \"reciprocal\", b = 1 }}\nb = {{ model = \"reciprocal\", b = 1 }}\n"
        );
        let path = study(&folder, "big.toml", &text).display().to_string();
        for command in [
            &["analyze", &path, "--stack", "text"][..],
            &["analyze", &path],
            &["simulate", &path, "--samples", "200"],
            &["simulate", &path, "--samples", "300", "--rare"],
            &["compare", &path, "--samples", "1000"],
            &["sweep", &path, "--over", "a=9:11:3"],
            &["allocate", &path],
        ] {
            let output = sensitol(command).output().unwrap();
            let (shown, said) = (String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap());
            let odd = shown.split(|c: char| !c.is_alphanumeric()).find(|word| ["inf", "NaN", "nan"].contains(word));
            assert_eq!(odd, None, "{command:?} {size}:\n{shown}");
            assert!(!said.contains("panicked"), "{command:?} {size}: {said}");
            assert!(!said.contains("warning[overflow]"), "{command:?} {size}: {said}");
        }
        // At a = b = 10, sigma is sqrt(2) times 10 times a tenth, times the size.
        let output = sensitol(&["simulate", &path, "--samples", "200", "--json"]).output().unwrap();
        let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        let sigma = report["characteristics"][0]["sigma"].as_f64().unwrap() / size.parse::<f64>().unwrap();
        // Four standard errors of 200 points.
        assert!((sigma / 2f64.sqrt() - 1.0).abs() < 0.2, "{size}: {sigma}");
    }
}
