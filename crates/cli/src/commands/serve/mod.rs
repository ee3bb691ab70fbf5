//! `sensitol serve`: the workbench over a folder of studies, with the engine of this program.
//!
//! The page is that of `sensitol workbench`, or one without WebAssembly if none was built. It opens and saves studies of the folder,
//! follows changes of files, and can run external models. Only requests with the token are answered, and no file outside the folder is read
//! or written. A program that a study names is not confined, and starts only when the user requests a result.

mod answer;
mod connection;
mod folder;
mod guard;
mod page;
mod request;
mod runs;

use std::net::{IpAddr, SocketAddr, TcpListener};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use crate::args::ServeArgs;
use crate::commands::workbench;
use crate::failure::{Exit, Failure};
use crate::interrupt;
use crate::output::Destination;
use answer::Answer;
use connection::Visit;
use folder::Folder;
use guard::Guard;
use request::Request;

/// Interval at which the server checks for an interruption.
const TICK: Duration = Duration::from_millis(200);
/// Placeholder in the page for the data of the server.
const ALONE: &str = "<script type=\"application/json\" id=\"server-data\">null</script>";
/// Beginning of the policy of a page without network.
const OFFLINE: &str = "default-src 'none';";

struct Served {
    page: String,
    folder: Folder,
    guard: Guard,
    /// Number of requests that have arrived as a whole and are not answered yet.
    active: AtomicUsize,
}

/// Request that is being answered, until it is dropped.
struct Active<'s>(&'s AtomicUsize);

impl<'s> Active<'s> {
    fn new(count: &'s AtomicUsize) -> Self {
        count.fetch_add(1, Ordering::SeqCst);
        Self(count)
    }
}

impl Drop for Active<'_> {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::SeqCst);
    }
}

pub(crate) fn run(asked: &ServeArgs) -> Result<Exit, Failure> {
    let folder = Folder::open(&asked.folder)?;
    let page = match workbench::page(asked.page.as_deref()) {
        // A program without a built page serves one that holds no engine.
        Err(Failure::NoPage { .. }) => page::page(),
        found => found?,
    };
    let page = with_server(&page, &folder.name())?;
    let address = SocketAddr::new(asked.address.unwrap_or(IpAddr::from([127, 0, 0, 1])), asked.port);
    let cannot = |reason: String| Failure::NotServed { address, reason };
    let listener = TcpListener::bind(address).map_err(|error| cannot(error.to_string()))?;
    let at = listener.local_addr().map_err(|error| cannot(error.to_string()))?;
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
    let accepting = {
        let served = Arc::clone(&served);
        std::thread::spawn(move || connection::accept(&listener, move |visit| served.answer(visit)))
    };
    while !interrupt::stopped() {
        if accepting.is_finished() {
            let reason =
                accepting.join().map_or_else(|_| "its thread has failed".to_owned(), |error| error.to_string());
            return Err(Failure::NoLongerServed { address: at, reason });
        }
        std::thread::sleep(TICK);
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
    /// Answers the request of a connection.
    fn answer(&self, visit: Visit) {
        match Request::read(visit.connection()) {
            Ok(Some(request)) => self.answer_to(request, &visit),
            Ok(None) => return,
            Err(refusal) => refusal.send(visit.connection()),
        }
        visit.close();
    }

    fn answer_to(&self, mut request: Request, visit: &Visit) {
        let connection = visit.connection();
        let query = match self.guard.admits(&request) {
            Ok(query) => query,
            Err(refusal) => return refusal.send(connection),
        };
        visit.admit();
        let posts = matches!(request.method.as_str(), "POST" | "PUT");
        let text = match posts.then(|| request.text(connection)).transpose() {
            Ok(text) => text.unwrap_or_default(),
            Err(refusal) => return refusal.send(connection),
        };
        // A request that has not arrived as a whole does not keep the program from ending.
        let _active = Active::new(&self.active);
        if interrupt::stopped() {
            return Answer::refused(503, "the server ends").send(connection);
        }
        let answer = match (request.method.as_str(), query.what.as_str()) {
            ("GET", "") => Answer::page(&self.page),
            ("GET", "models") => Answer::json(sensitol_report::task::models()),
            ("GET", "studies") => self.folder.list(),
            ("GET", "study") => self.folder.read(&query),
            ("GET", "changed") => self.folder.changed(&query),
            ("PUT", "study") => self.folder.save(&query, &text),
            ("POST", "keys") => runs::keys(&self.folder, &query, &text),
            ("POST", "run") => return runs::run(&self.folder, &query, &text, connection),
            _ => Answer::not_found(),
        };
        answer.send(connection);
    }
}
