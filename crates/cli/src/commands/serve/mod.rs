//! `sensitol serve`: the workbench over a folder of studies, with the engine of this program.
//!
//! The page is that of `sensitol workbench`. It opens and saves studies of the folder, follows changes of files, and can run external
//! models. Only requests with the token are answered, and no file outside the folder is read or written.

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

use crate::args::ServeArgs;
use crate::commands::workbench::page;
use crate::failure::{Exit, Failure};
use crate::interrupt;
use crate::output::Destination;
use answer::Answer;
use folder::Folder;
use guard::Guard;

/// Interval at which the server checks for an interruption.
const TICK: Duration = Duration::from_millis(200);
/// Longest text of a request, in bytes.
const LONGEST: u64 = 16 << 20;
/// Placeholder in the page for the data of the server.
const ALONE: &str = "<script type=\"application/json\" id=\"server-data\">null</script>";
/// Beginning of the policy of a page without network.
const OFFLINE: &str = "default-src 'none';";

struct Served {
    page: String,
    folder: Folder,
    guard: Guard,
    /// Number of running requests.
    active: AtomicUsize,
}

pub(crate) fn run(asked: &ServeArgs) -> Result<Exit, Failure> {
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
        // A failed connection does not affect the next one.
        let Ok(Some(request)) = server.recv_timeout(TICK) else { continue };
        let served = Arc::clone(&served);
        served.active.fetch_add(1, Ordering::SeqCst);
        std::thread::spawn(move || {
            served.answer(request);
            served.active.fetch_sub(1, Ordering::SeqCst);
        });
    }
    // Running requests see the interruption as well, and end with their results so far.
    while served.active.load(Ordering::SeqCst) > 0 && !interrupt::abandoned() {
        std::thread::sleep(TICK);
    }
    Ok(Exit::Done)
}

/// Adds the folder's name to the page, and allows requests to this server only.
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

/// Reads the text of a request.
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
