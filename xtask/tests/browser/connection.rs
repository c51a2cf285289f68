//! The debugging protocol: numbered calls, and events, as JSON over a web socket.

use std::net::TcpStream;
use std::path::Path;
use std::sync::Arc;

use serde_json::{Value, json};
use tungstenite::{Message, WebSocket};

use super::program::Program;

/// A page of the browser, in a window that shares neither storage nor settings with other pages.
pub(super) struct Connection {
    socket: WebSocket<TcpStream>,
    /// Id of the page's session; empty for calls to the browser itself.
    session: String,
    calls: u64,
    events: Vec<Value>,
    /// Keeps the browser running; it ends with the last page.
    _program: Arc<Program>,
}

impl Connection {
    /// Opens an empty page.
    pub(super) fn open(browser: &Path) -> Connection {
        let program = Program::running(browser);
        let socket = program.socket();
        let mut connection =
            Connection { socket, session: String::new(), calls: 0, events: Vec::new(), _program: program };
        // The context ends with this connection, and so does its page.
        let context = connection.call("Target.createBrowserContext", &json!({ "disposeOnDetach": true }));
        let page = json!({ "url": "about:blank", "browserContextId": context["browserContextId"], "newWindow": true });
        let target = connection.call("Target.createTarget", &page)["targetId"].clone();
        let attached = connection.call("Target.attachToTarget", &json!({ "targetId": target, "flatten": true }));
        attached["sessionId"].as_str().unwrap().clone_into(&mut connection.session);
        connection
    }

    /// Calls a method and returns its result.
    pub(super) fn call(&mut self, method: &str, arguments: &Value) -> Value {
        self.send(method, arguments);
        loop {
            let mut message = self.receive();
            if message["id"] == self.calls {
                assert!(message.get("error").is_none(), "{method}: {}", message["error"]);
                return message["result"].take();
            }
            self.events.push(message);
        }
    }

    /// Waits for an event, unless it has occurred since the page was opened.
    pub(super) fn wait_for(&mut self, event: &str) {
        while !self.events.iter().any(|seen| seen["method"] == event) {
            let message = self.receive();
            self.events.push(message);
        }
    }

    /// All events received so far.
    pub(super) fn events(&self) -> &[Value] {
        &self.events
    }

    fn send(&mut self, method: &str, arguments: &Value) {
        self.calls += 1;
        let mut call = json!({ "id": self.calls, "method": method, "params": arguments });
        if !self.session.is_empty() {
            call["sessionId"] = self.session.as_str().into();
        }
        self.socket.send(Message::text(call.to_string())).unwrap();
    }

    fn receive(&mut self) -> Value {
        loop {
            if let Message::Text(text) = self.socket.read().expect("the browser has stopped answering") {
                return serde_json::from_str(&text).unwrap();
            }
        }
    }
}
