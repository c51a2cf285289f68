//! The browser's process: finding, starting and ending it.

use std::env;
use std::fs;
use std::io::Write as _;
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::{Arc, Mutex, PoisonError, Weak};
use std::thread::sleep;
use std::time::{Duration, Instant};

use serde_json::json;
use tempfile::TempDir;
use tungstenite::{Message, WebSocket, client};

use super::PATIENCE;

/// Names of the executable in the system's packages.
const NAMES: [&str; 5] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome"];

/// No window, no dialogs, no connections to the vendor. Containers do not allow the sandbox, and the page is our own.
const ARGUMENTS: [&str; 14] = [
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--enable-unsafe-swiftshader",
    "--disable-dev-shm-usage",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-default-apps",
    "--disable-extensions",
    "--disable-quic",
    "--disable-sync",
    "--no-first-run",
    "--hide-scrollbars",
    "--remote-debugging-port=0",
];

/// Longest time for the browser to end.
const FAREWELL: Duration = Duration::from_secs(5);

/// The browser for tests: `CHROME`, or the first on the path.
pub(super) fn find() -> Option<PathBuf> {
    let named = env::var_os("CHROME").map(PathBuf::from);
    let path = env::var_os("PATH").unwrap_or_default();
    let on_path = || {
        let folders: Vec<PathBuf> = env::split_paths(&path).collect();
        NAMES.iter().flat_map(|name| folders.iter().map(move |folder| folder.join(name))).find(|file| file.is_file())
    };
    let found = named.or_else(on_path);
    if found.is_none() {
        let required = env::var("POLICY_ALIGN_BROWSER").is_ok_and(|policy| policy == "required");
        assert!(!required, "POLICY_ALIGN_BROWSER=required, but there is no Chromium on the path or in CHROME");
        // A printing macro would not do: the test harness would capture its output.
        let test = std::thread::current().name().unwrap_or("?").to_owned();
        let _ = writeln!(std::io::stderr(), "\n=== SKIPPED: {test}. No Chromium on the path or in CHROME.");
    }
    found
}

/// A running browser.
pub(super) struct Program {
    process: Child,
    profile: TempDir,
}

/// The browser of the currently open pages.
static RUNNING: Mutex<Weak<Program>> = Mutex::new(Weak::new());

impl Program {
    /// Returns the running browser, or starts one. Starting takes longer than most tests.
    pub(super) fn running(browser: &Path) -> Arc<Program> {
        // After a failed test the value is still valid.
        let mut running = RUNNING.lock().unwrap_or_else(PoisonError::into_inner);
        running.upgrade().unwrap_or_else(|| {
            let program = Arc::new(Program::start(browser));
            *running = Arc::downgrade(&program);
            program
        })
    }

    fn start(browser: &Path) -> Program {
        let profile = tempfile::tempdir().unwrap();
        let mut command = Command::new(browser);
        command.args(ARGUMENTS).arg(format!("--user-data-dir={}", profile.path().display())).arg("about:blank");
        let process = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).spawn();
        Program { process: process.unwrap_or_else(|e| panic!("{}: {e}", browser.display())), profile }
    }

    /// Opens a web socket to the browser, which writes its port and path to a file in the profile.
    pub(super) fn socket(&self) -> WebSocket<TcpStream> {
        let file = self.profile.path().join("DevToolsActivePort");
        let started = Instant::now();
        loop {
            let text = fs::read_to_string(&file).unwrap_or_default();
            if let Some((port, path)) = text.split_once('\n').filter(|(_, path)| !path.is_empty()) {
                let stream = TcpStream::connect(("127.0.0.1", port.parse().unwrap())).unwrap();
                stream.set_read_timeout(Some(PATIENCE)).unwrap();
                return client(format!("ws://127.0.0.1:{port}{}", path.trim()), stream).unwrap().0;
            }
            assert!(started.elapsed() < PATIENCE, "the browser was started but does not listen");
            sleep(Duration::from_millis(10));
        }
    }
}

impl Drop for Program {
    /// Asks the browser to end, so that its child processes end too, and then kills it.
    fn drop(&mut self) {
        let close = json!({ "id": 0, "method": "Browser.close" });
        if self.socket().send(Message::text(close.to_string())).is_ok() {
            let asked = Instant::now();
            while asked.elapsed() < FAREWELL && self.process.try_wait().is_ok_and(|status| status.is_none()) {
                sleep(Duration::from_millis(10));
            }
        }
        // Both fail if it has already ended, which is fine.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}
