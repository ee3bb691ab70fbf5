//! `sensitol serve`: a folder of studies for a page with the token. The page itself is tested in a browser.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use super::command::sensitol;

#[cfg(unix)]
mod limits;
mod programs;
mod saves;

/// Parts of a page that the command checks.
const PAGE: &str = concat!(
    "<!DOCTYPE html>\n<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'x'\">\n",
    "<meta name=\"generator\" content=\"sensitol ",
    env!("CARGO_PKG_VERSION"),
    " workbench\">\n<script type=\"application/json\" id=\"study-data\">null</script>\n",
    "<script type=\"application/json\" id=\"server-data\">null</script>\n"
);
const STUDY: &str = "[dimensions]\na = { nominal = 10, tolerance = 0.3 }\nb = { nominal = 4, tolerance = 0.1 }\n\
                     [characteristics]\ny = { formula = \"a*b\", lower = 39, upper = 41 }\n";

/// Time after which a silent server counts as hanging: many times every limit that tests meet.
const SILENCE: Duration = Duration::from_secs(120);

struct Server {
    child: Child,
    at: SocketAddr,
    token: String,
    folder: tempfile::TempDir,
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

struct Answer {
    status: u16,
    head: String,
    body: String,
}

impl Answer {
    fn json(&self) -> Value {
        serde_json::from_str(&self.body).unwrap_or_else(|error| panic!("{error}: {}", self.body))
    }
}

impl Server {
    /// Starts a server over a folder with these files.
    fn with(files: &[(&str, &str)]) -> Self {
        Self::started(files, Command::new(env!("CARGO_BIN_EXE_sensitol")))
    }

    /// Starts the program of this command over a folder with these files.
    fn started(files: &[(&str, &str)], mut program: Command) -> Self {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("studies")).unwrap();
        std::fs::write(folder.path().join("page.html"), PAGE).unwrap();
        for (name, text) in files {
            let path = folder.path().join("studies").join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, text).unwrap();
        }
        program.args(["serve", "studies", "--page", "page.html"]);
        Self::listening(program, folder)
    }

    /// Starts the program of this command, whose arguments are complete, in a folder.
    fn listening(mut program: Command, folder: tempfile::TempDir) -> Self {
        let mut child = program.current_dir(folder.path()).stdout(Stdio::piped()).spawn().unwrap();
        let mut said = String::new();
        BufReader::new(child.stdout.as_mut().unwrap()).read_line(&mut said).unwrap();
        assert!(said.starts_with("The workbench over studies: http://127.0.0.1:"), "{said}");
        let address = said.trim_end().rsplit("http://").next().unwrap();
        let (at, token) = address.trim_end_matches('/').split_once('/').unwrap();
        Self { child, at: at.parse().unwrap(), token: token.to_owned(), folder }
    }

    fn studies(&self) -> PathBuf {
        self.folder.path().join("studies")
    }

    /// Sends these lines and bytes as they are, and returns the stream for the response. A server that is silent fails the test.
    fn send(&self, lines: &[&str], text: &[u8]) -> TcpStream {
        let mut stream = TcpStream::connect(self.at).unwrap();
        stream.set_read_timeout(Some(SILENCE)).unwrap();
        stream.write_all(lines.iter().map(|line| format!("{line}\r\n")).collect::<String>().as_bytes()).unwrap();
        stream.write_all(text).unwrap();
        stream
    }

    /// Returns the status of the response to a request with these fields and this text.
    fn status(&self, line: &str, fields: &[&str], text: &[u8]) -> u16 {
        let host = format!("Host: {}", self.at);
        let mut stream = self.send(&[&[line, &host], fields, &[""]].concat(), text);
        status(&mut stream)
    }

    /// Sends a request with the host first, and returns the stream for the response.
    fn ask(&self, method: &str, path: &str, headers: &[&str], body: &str) -> TcpStream {
        let mut stream = TcpStream::connect(self.at).unwrap();
        stream.set_read_timeout(Some(SILENCE)).unwrap();
        let host = format!("Host: {}", self.at);
        let host = if headers.iter().any(|header| header.starts_with("Host:")) { None } else { Some(host.as_str()) };
        let headers: Vec<&str> = host.into_iter().chain(headers.iter().copied()).collect();
        let length = body.len();
        let head = headers.join("\r\n");
        write!(
            stream,
            "{method} {path} HTTP/1.1\r\n{head}\r\nConnection: close\r\nContent-Length: {length}\r\n\r\n{body}"
        )
        .unwrap();
        stream
    }

    fn answer(&self, method: &str, path: &str, headers: &[&str], body: &str) -> Answer {
        let mut stream = self.ask(method, path, headers, body);
        let mut text = String::new();
        stream.read_to_string(&mut text).unwrap();
        let (head, body) = text.split_once("\r\n\r\n").unwrap();
        let status = head.split(' ').nth(1).unwrap().parse().unwrap();
        Answer { status, head: head.to_owned(), body: body.to_owned() }
    }

    fn at(&self, what: &str) -> String {
        format!("/{}/{what}", self.token)
    }

    fn get(&self, what: &str) -> Answer {
        self.answer("GET", &self.at(what), &[], "")
    }

    fn put(&self, what: &str, text: &str) -> Answer {
        self.answer("PUT", &self.at(what), &[], text)
    }

    /// Returns the lines of a run except empty ones, which only test if the page is still there.
    fn run(&self, path: &str, task: &Value) -> Vec<Value> {
        let mut stream = self.ask("POST", &self.at(&format!("run?path={path}")), &[], &task.to_string());
        let mut text = String::new();
        stream.read_to_string(&mut text).unwrap();
        let chunks = text.split_once("\r\n\r\n").unwrap().1;
        // Each chunk is one line. Lengths of chunks are on lines of their own.
        chunks
            .split("\r\n")
            .filter(|line| line.starts_with('{'))
            .map(|line| serde_json::from_str(line).unwrap())
            .collect()
    }
}

/// Status of a response.
fn status(stream: &mut TcpStream) -> u16 {
    let mut text = Vec::new();
    stream.read_to_end(&mut text).unwrap();
    let text = String::from_utf8(text).unwrap();
    text.split(' ').nth(1).unwrap_or_else(|| panic!("no response: {text:?}")).parse().unwrap()
}

fn task(text: &str, name: &str) -> Value {
    json!({ "text": text, "format": "toml", "name": name, "asked": { "command": "analyze" }, "forms": ["json"] })
}

#[test]
fn only_the_page_itself_is_answered() {
    let server = Server::with(&[("gap.toml", STUDY)]);
    let page = server.get("");
    assert_eq!(page.status, 200);
    assert!(page.body.contains("id=\"server-data\">{\"folder\":\"studies\"}</script>"), "{}", page.body);
    assert!(page.body.contains("default-src 'none'; connect-src 'self'; style-src"), "{}", page.body);
    assert!(page.head.contains("Referrer-Policy: no-referrer"), "{}", page.head);
    let studies = server.at("studies");
    let refused = |path: &str, headers: &[&str], said: &str| {
        let answer = server.answer("GET", path, headers, "");
        assert_eq!(answer.status, 403, "{headers:?}: {}", answer.body);
        assert!(answer.body.contains(said), "{}", answer.body);
    };
    for path in ["/", "/studies", "/00000000000000000000000000000000/studies", "//studies"] {
        refused(path, &[], "needs the token");
    }
    // A foreign name that DNS points at this machine, and a page of another site with the right address.
    refused(&studies, &["Host: evil.example"], "not that of this server");
    refused(&studies, &["Origin: http://evil.example"], "another site");
    refused(&studies, &["Origin: null"], "another site");
    refused(&studies, &["Sec-Fetch-Site: cross-site"], "another site");
    let own = format!("Origin: http://{}", server.at);
    assert_eq!(server.answer("GET", &studies, &[&own, "Sec-Fetch-Site: same-origin"], "").status, 200);
    assert_eq!(server.get("elsewhere").status, 404);
    assert_eq!(server.answer("DELETE", &server.at("study?path=gap.toml"), &[], "").status, 404);
}

#[test]
fn studies_of_the_folder_are_opened_and_saved() {
    let json = r#"{ "dimensions": { "a": { "nominal": 1, "tolerance": 0.1 } }, "characteristics": { "y": { "formula": "2*a" } } }"#;
    let server = Server::with(&[
        ("gap.toml", STUDY),
        ("in/two words.toml", STUDY),
        ("old.json", json),
        ("Cargo.toml", "[package]"),
    ]);
    assert_eq!(server.get("studies").json()["studies"], json!(["gap.toml", "in/two words.toml", "old.json"]));
    let read = server.get("study?path=in%2Ftwo%20words.toml").json();
    assert_eq!((read["text"].as_str(), read["name"].as_str()), (Some(STUDY), Some("in/two words.toml")));
    let old = server.get("study?path=old.json").json();
    assert_eq!((old["name"].as_str(), old["hash"].is_null()), (Some("old.toml"), true));
    assert_eq!(
        sensitol_study::Study::from_toml(old["text"].as_str().unwrap(), "old.toml").unwrap().problem.dimensions().len(),
        1
    );

    let hash = server.get("study?path=gap.toml").json()["hash"].as_str().unwrap().to_owned();
    let changed = STUDY.replace("0.3", "0.2");
    let saved = server.put(&format!("study?path=gap.toml&hash={hash}"), &changed);
    assert_eq!(saved.status, 200, "{}", saved.body);
    assert_eq!(std::fs::read_to_string(server.studies().join("gap.toml")).unwrap(), changed);
    // The page has the old content: the save is refused, and the file stays.
    let conflict = server.put(&format!("study?path=gap.toml&hash={hash}"), STUDY);
    assert_eq!(conflict.status, 409, "{}", conflict.body);
    assert_eq!(server.put("study?path=gap.toml&hash=", STUDY).status, 409);
    assert_eq!(std::fs::read_to_string(server.studies().join("gap.toml")).unwrap(), changed);
    assert_eq!(server.put(&format!("study?path=gap.toml&hash={hash}&overwrite=yes"), STUDY).status, 200);
    assert_eq!(server.put("study?path=new.toml&hash=", STUDY).status, 200);
    assert_eq!(std::fs::read_to_string(server.studies().join("new.toml")).unwrap(), STUDY);
    // No other file is left beside the saved one.
    assert_eq!(std::fs::read_dir(server.studies()).unwrap().count(), 5);
}

#[test]
fn nothing_outside_the_folder_is_touched() {
    let server = Server::with(&[("gap.toml", STUDY)]);
    let outside = server.folder.path().join("outside.toml");
    std::fs::write(&outside, "secret").unwrap();
    let mut wrong =
        vec!["../outside.toml", "studies/../../outside.toml", "", "..%5Coutside.toml", "gap.txt", "page.html"];
    let absolute = outside.display().to_string();
    wrong.push(&absolute);
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(&outside, server.studies().join("link.toml")).unwrap();
        std::os::unix::fs::symlink(server.folder.path(), server.studies().join("up")).unwrap();
        wrong.extend(["link.toml", "up/outside.toml"]);
    }
    for path in wrong {
        for answer in [
            server.get(&format!("study?path={path}")),
            server.put(&format!("study?path={path}&overwrite=yes"), STUDY),
            server.get(&format!("changed?path={path}")),
            server.answer("POST", &server.at(&format!("run?path={path}")), &[], &task(STUDY, path).to_string()),
        ] {
            assert_eq!(answer.status, 403, "{path}: {}", answer.body);
            assert!(!answer.body.contains("secret"));
        }
    }
    assert_eq!(std::fs::read_to_string(&outside).unwrap(), "secret");
    assert_eq!(server.get("study?path=none.toml").status, 404);
    assert_eq!(server.get("study").status, 400);
    assert_eq!(server.get("study?path=%ff.toml").status, 400);
    assert_eq!(server.put("study?path=none/new.toml", STUDY).status, 404);
    let long = server.answer("PUT", &server.at("study?path=long.toml&hash="), &[], &" ".repeat((16 << 20) + 1));
    assert_eq!(long.status, 413, "{}", long.body);
}

/// A run has the engine of the command line.
#[test]
fn a_run_is_that_of_the_command_line() {
    let server = Server::with(&[("gap.toml", STUDY)]);
    let found = server.run("gap.toml", &task(STUDY, "gap.toml"));
    let found: Value = serde_json::from_str(found.last().unwrap()["found"]["json"].as_str().unwrap()).unwrap();
    let output = sensitol(&["analyze", "gap.toml", "--json", "-v"]).current_dir(server.studies()).output().unwrap();
    let expected: Value = serde_json::from_slice(&output.stdout).unwrap();
    let timeless = |mut report: Value| {
        for key in ["wall_s", "in_model_s"] {
            report.as_object_mut().unwrap().remove(key);
        }
        report
    };
    assert_eq!(timeless(found), timeless(expected));
    let wrong = server.run(
        "gap.toml",
        &task("[dimensions]\na = { nominal = 1 }\n[characteristics]\ny = { formula = \"a*c\" }", "gap.toml"),
    );
    let fault = &wrong.last().unwrap()["found"]["faults"][0];
    assert_eq!(fault["key"], "characteristics.y.formula");
    let keys = server.answer("POST", &server.at("keys?path=gap.toml"), &[], &task(STUDY, "gap.toml").to_string());
    assert_eq!(keys.json()["study"]["dimensions"]["a"]["nominal"], 10.0);
    assert_eq!(server.answer("POST", &server.at("run?path=gap.toml"), &[], "no JSON").status, 400);
}

/// Program that counts its points in a file and takes its time.
const PROGRAM: &str = r#"
import json, sys, time
for line in sys.stdin:
    told = json.loads(line)
    if "id" not in told:
        print(json.dumps({"ready": True, "name": "slow"}), flush=True)
        continue
    time.sleep(0.05)
    open("points", "a").write("x")
    print(json.dumps({"id": told["id"], "y": [sum(told["x"])]}), flush=True)
"#;

fn external() -> String {
    let dimensions: String = (0..12).map(|i| format!("d{i} = {{ nominal = {i}, tolerance = 0.1 }}\n")).collect();
    format!("[dimensions]\n{dimensions}[model]\ncommand = [\"python3\", \"slow.py\"]\n[characteristics]\ny = {{}}\n")
}

#[test]
fn external_models_run_in_their_folder_and_end_with_the_page() {
    let text = external();
    let server = Server::with(&[("in/gap.toml", &text), ("in/slow.py", PROGRAM)]);
    let folder = server.studies().join("in");
    let points = || std::fs::read_to_string(folder.join("points")).map_or(0, |text| text.len());
    let task = |method: &str| {
        let mut task = task(&text, "in/gap.toml");
        task["analysis"] = json!({ "method": method });
        task
    };
    let found = server.run("in%2Fgap.toml&programs=yes", &task("second-order"));
    let last = found.last().unwrap();
    let report: Value =
        serde_json::from_str(last["found"]["json"].as_str().unwrap_or_else(|| panic!("{last}"))).unwrap();
    // Root of the sum of twelve squares of 0.1/3.
    let sigma = report["characteristics"][0]["sigma"].as_f64().unwrap();
    assert!((sigma - 0.1 / 3.0 * 12f64.sqrt()).abs() < 1e-9, "{sigma}");
    assert!(found.iter().any(|line| line["answered"].as_u64() > Some(0)), "{found:?}");
    assert!(folder.join("gap.journal.sqlite").exists());

    // Closing the page ends the run, which would have some 150 more points.
    let before = points();
    let stream = server.ask("POST", &server.at("run?path=in%2Fgap.toml&programs=yes"), &[], &task("full").to_string());
    let begun = Instant::now();
    while points() < before + 3 && begun.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(20));
    }
    drop(stream);
    let settled = || {
        let now = points();
        // Twenty times the duration of a point.
        std::thread::sleep(Duration::from_secs(1));
        (points() == now).then_some(now)
    };
    let ended = (0..20).find_map(|_| settled()).expect("the program goes on without its page");
    assert!(ended < before + 120, "{before} and {ended} points");
}

#[test]
fn a_change_is_told() {
    let server = Server::with(&[("gap.toml", STUDY)]);
    let hash = server.get("study?path=gap.toml").json()["hash"].as_str().unwrap().to_owned();
    let mut stream = server.ask("GET", &server.at(&format!("changed?path=gap.toml&hash={hash}")), &[], "");
    std::thread::sleep(Duration::from_millis(300));
    std::fs::write(server.studies().join("gap.toml"), STUDY.replace("0.3", "0.4")).unwrap();
    let mut text = String::new();
    stream.read_to_string(&mut text).unwrap();
    let told: Value = serde_json::from_str(text.split_once("\r\n\r\n").unwrap().1).unwrap();
    assert_eq!(told["hash"], server.get("study?path=gap.toml").json()["hash"]);
    assert_ne!(told["hash"], json!(hash));
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_it() {
    let mut server = Server::with(&[]);
    Command::new("kill").args(["-INT", &server.child.id().to_string()]).status().unwrap();
    assert_eq!(server.child.wait().unwrap().code(), Some(0));
}

#[track_caller]
fn refused(folder: &Path, arguments: &[&str], said: &str) {
    let output = sensitol(arguments).current_dir(folder).output().unwrap();
    let error = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{error}");
    assert!(error.contains(said), "{error}");
}

#[test]
fn what_cannot_be_served_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("page.html", PAGE);
    write("old.html", &PAGE.replace("server-data", "other-data"));
    write("gap.toml", STUDY);
    refused(
        folder.path(),
        &["serve", "gap.toml", "--page", "page.html"],
        "gap.toml is no folder of studies: it is a file",
    );
    refused(folder.path(), &["serve", "none", "--page", "page.html"], "none is no folder of studies");
    refused(folder.path(), &["serve", "--page", "old.html"], "run web/build again");
    refused(folder.path(), &["serve", "--page", "page.html", "--port", "70000"], "70000");
    let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port().to_string();
    refused(
        folder.path(),
        &["serve", "--page", "page.html", "--port", &port],
        &format!("nothing can listen at 127.0.0.1:{port}"),
    );
}

/// A program without a built page beside it serves its own: the same texts without an engine, which opens the studies of the folder.
#[test]
fn a_program_alone_serves_its_own_page() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("studies")).unwrap();
    std::fs::write(folder.path().join("studies/s.toml"), STUDY).unwrap();
    let copy = folder.path().join("alone");
    std::fs::copy(env!("CARGO_BIN_EXE_sensitol"), &copy).unwrap();
    let mut program = Command::new(&copy);
    program.env_remove("SENSITOL_WORKBENCH").args(["serve", "studies"]);
    let server = Server::listening(program, folder);
    let page = server.get("");
    assert_eq!(page.status, 200);
    assert!(page.body.contains("connect-src 'self'") && page.body.contains("\"folder\":\"studies\""));
    // Without the engine it is a tenth of the page with it.
    assert!(page.body.len() < 200_000, "{}", page.body.len());
    let task = json!({ "text": STUDY, "format": "toml", "name": "s.toml", "files": {}, "asked": { "command": "analyze" }, "forms": ["json"] });
    let told = server.run("s.toml", &task);
    assert!(told.last().unwrap()["found"].is_object(), "{told:?}");
    // A page that works alone needs the engine in it.
    let refused = Command::new(server.folder.path().join("alone"))
        .env_remove("SENSITOL_WORKBENCH")
        .current_dir(server.folder.path())
        .arg("workbench")
        .output()
        .unwrap();
    assert_eq!(refused.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("sensitol serve"), "{refused:?}");
}
