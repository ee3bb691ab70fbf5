//! `sensitol serve`: the workbench over a folder of studies, run by this program.
//!
//! The page is that of `sensitol workbench`. It opens and saves studies of the folder, hears when a file changes, and has the engine of
//! this program: external models run too. Only who knows the token in the address is answered, and nothing outside the folder is read
//! or written.

mod answer;
mod folder;
mod guard;
mod runs;

use std::io::Read;
use std::net::{IpAddr, SocketAddr};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use tiny_http::{Method, Request, Server};

use super::args::ServeArgs;
use super::failure::{Exit, Failure};
use super::interrupt;
use super::output::Destination;
use super::workbench::page;
use answer::Answer;
use folder::Folder;
use guard::Guard;

/// How often the server looks whether it is to end.
const TICK: Duration = Duration::from_millis(200);
/// The longest text that a page sends.
const LONGEST: u64 = 16 << 20;
/// Where the page says whose it is.
const ALONE: &str = "<script type=\"application/json\" id=\"server-data\">null</script>";
/// The policy of a page that asks no network.
const OFFLINE: &str = "default-src 'none';";

/// The parts that every request needs.
struct Served {
    page: String,
    folder: Folder,
    guard: Guard,
    /// Requests that are under way.
    active: AtomicUsize,
}

pub(super) fn run(asked: &ServeArgs) -> Result<Exit, Failure> {
    let folder = Folder::open(&asked.folder)?;
    let page = with_server(&page(asked.page.as_deref())?, &folder.name())?;
    let address = SocketAddr::new(asked.address.unwrap_or(IpAddr::from([127, 0, 0, 1])), asked.port);
    let cannot = |reason: String| Failure::NotServed { address, reason };
    let server = Server::http(address).map_err(|error| cannot(error.to_string()))?;
    let at = server.server_addr().to_ip().ok_or_else(|| cannot("it has no address".to_owned()))?;
    let guard = Guard::new(at).map_err(cannot)?;
    interrupt::listen();
    let warning = if at.ip().is_loopback() {
        String::new()
    } else {
        "Everyone who reaches this machine and knows the address may run programs here.\n".to_owned()
    };
    let shown = folder.shown();
    Destination::Stdout
        .write(&format!("The workbench over {shown}: {}\n{warning}Ctrl-C ends it.\n", guard.address()))?;
    let served = Arc::new(Served { page, folder, guard, active: AtomicUsize::new(0) });
    while !interrupt::stopped() {
        // A connection that broke says nothing of the next one.
        let Ok(Some(request)) = server.recv_timeout(TICK) else { continue };
        let served = Arc::clone(&served);
        served.active.fetch_add(1, Ordering::SeqCst);
        std::thread::spawn(move || {
            served.answer(request);
            served.active.fetch_sub(1, Ordering::SeqCst);
        });
    }
    // Runs hear the interruption too, and end with what they have.
    while served.active.load(Ordering::SeqCst) > 0 && !interrupt::abandoned() {
        std::thread::sleep(TICK);
    }
    Ok(Exit::Done)
}

/// The page that knows that it is served, and may ask this server and no other.
fn with_server(page: &str, folder: &str) -> Result<String, Failure> {
    if !page.contains(ALONE) || !page.contains(OFFLINE) {
        return Err(Failure::OldPage);
    }
    let data = serde_json::json!({ "folder": folder }).to_string();
    let data = data.replace('<', "\\u003c").replace('>', "\\u003e").replace('&', "\\u0026");
    let page = page.replacen(ALONE, &ALONE.replace("null", &data), 1);
    Ok(page.replacen(OFFLINE, &format!("{OFFLINE} connect-src 'self';"), 1))
}

impl Served {
    fn answer(&self, mut request: Request) {
        let method = request.method().clone();
        let query = match self.guard.admits(&request) {
            Ok(query) => query,
            Err(refusal) => return refusal.send(request),
        };
        let posts = matches!(method, Method::Post | Method::Put);
        let text = match posts.then(|| body(&mut request)).transpose() {
            Ok(text) => text.unwrap_or_default(),
            Err(refusal) => return refusal.send(request),
        };
        let answer = match (&method, query.what.as_str()) {
            (Method::Get, "") => Answer::page(&self.page),
            (Method::Get, "models") => Answer::json(sensitol_report::task::models()),
            (Method::Get, "studies") => self.folder.list(),
            (Method::Get, "study") => self.folder.read(&query),
            (Method::Get, "changed") => self.folder.changed(&query),
            (Method::Put, "study") => self.folder.save(&query, &text),
            (Method::Post, "keys") => runs::keys(&self.folder, &query, &text),
            (Method::Post, "run") => return runs::run(&self.folder, &query, &text, request),
            _ => Answer::not_found(),
        };
        answer.send(request);
    }
}

/// The text that a page sends with its question.
fn body(request: &mut Request) -> Result<String, Answer> {
    let mut bytes = Vec::new();
    let read = request.as_reader().take(LONGEST + 1).read_to_end(&mut bytes);
    match (read, String::from_utf8(bytes)) {
        (Ok(length), _) if length as u64 > LONGEST => Err(Answer::refused(413, "the text is longer than 16 MiB")),
        (Ok(_), Ok(text)) => Ok(text),
        (Ok(_), Err(_)) => Err(Answer::refused(400, "the text is not UTF-8")),
        (Err(error), _) => Err(Answer::refused(400, &format!("the text could not be read: {error}"))),
    }
}
