//! A page in a real browser: headless Chromium, controlled by its debugging protocol.
//!
//! [`Page::open`] returns a page, or `None` if no browser is installed; the test is then skipped, with a message. With
//! `POLICY_ALIGN_BROWSER=required` it fails instead. The tests of `policy-align`'s pages also use this module.

#![allow(dead_code, reason = "each test uses a part")]

mod connection;
mod program;

use std::path::Path;
use std::time::{Duration, Instant};

use serde::de::DeserializeOwned;
use serde_json::{Value, json};

use connection::Connection;

/// Longest time that a test waits for a page.
const PATIENCE: Duration = Duration::from_secs(60);

/// A position in the window, CSS pixels.
pub(crate) type Point = (f64, f64);

/// An open page.
pub(crate) struct Page {
    connection: Connection,
    address: String,
    /// Number of screen pixels per CSS pixel along a side.
    pixels: f64,
}

impl Page {
    /// Opens a file and waits until it is loaded; returns `None` if there is no browser.
    pub(crate) fn open(file: &Path) -> Option<Page> {
        Page::open_on(file, 1.0)
    }

    /// The same on a screen with `pixels` screen pixels per CSS pixel along a side. Without a graphics card, drawing time is
    /// proportional to the number of pixels.
    pub(crate) fn open_on(file: &Path, pixels: f64) -> Option<Page> {
        let program = program::find()?;
        let mut page = Page {
            connection: Connection::open(&program),
            address: format!("file://{}", file.canonicalize().unwrap().display()),
            pixels,
        };
        for domain in ["Page", "Runtime", "Log", "Network"] {
            page.call(&format!("{domain}.enable"), &json!({}));
        }
        page.resize(1280, 900);
        let address = page.address.clone();
        let failure = page.call("Page.navigate", &json!({ "url": address }))["errorText"].clone();
        assert!(failure.is_null(), "{address}: {failure}");
        page.connection.wait_for("Page.loadEventFired");
        // The address as the browser writes it.
        page.address = page.evaluate("location.href");
        Some(page)
    }

    /// The value of an expression; a promise is awaited.
    pub(crate) fn evaluate<T: DeserializeOwned>(&mut self, expression: &str) -> T {
        let arguments = json!({ "expression": expression, "returnByValue": true, "awaitPromise": true });
        let answer = self.call("Runtime.evaluate", &arguments);
        assert!(answer.get("exceptionDetails").is_none(), "{expression}: {}", answer["exceptionDetails"]);
        serde_json::from_value(answer["result"]["value"].clone()).unwrap_or_else(|e| panic!("{expression}: {e}"))
    }

    /// Waits until a condition holds.
    pub(crate) fn wait_until(&mut self, condition: &str) {
        let started = Instant::now();
        while !self.evaluate::<bool>(condition) {
            assert!(started.elapsed() < PATIENCE, "waited in vain for {condition}");
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// Resizes the window, CSS pixels.
    pub(crate) fn resize(&mut self, width: u32, height: u32) {
        let size = json!({ "width": width, "height": height, "deviceScaleFactor": self.pixels, "mobile": false });
        self.call("Emulation.setDeviceMetricsOverride", &size);
    }

    /// Sets the answer to a media query: `("prefers-color-scheme", "dark")`.
    pub(crate) fn prefer(&mut self, feature: &str, value: &str) {
        self.call("Emulation.setEmulatedMedia", &json!({ "features": [{ "name": feature, "value": value }] }));
    }

    /// Switches the page to its print layout.
    pub(crate) fn show_as_printed(&mut self) {
        self.call("Emulation.setEmulatedMedia", &json!({ "media": "print" }));
    }

    /// The accessibility tree, as a screen reader receives it: role and name of every node, in order.
    pub(crate) fn accessible(&mut self) -> Vec<(String, String)> {
        let tree = self.call("Accessibility.getFullAXTree", &json!({}));
        let nodes = tree["nodes"].as_array().unwrap().iter().filter(|node| node["ignored"] == false);
        let text = |value: &Value| value["value"].as_str().unwrap_or_default().to_owned();
        nodes.map(|node| (text(&node["role"]), text(&node["name"]))).collect()
    }

    /// Presses and releases a key that has a name: Tab, Enter, Escape, ArrowLeft, ..
    pub(crate) fn press(&mut self, key: &str) {
        let code = match key {
            "Tab" => 9,
            "Enter" => 13,
            "Escape" => 27,
            "ArrowLeft" => 37,
            "ArrowUp" => 38,
            "ArrowRight" => 39,
            "ArrowDown" => 40,
            _ => 0,
        };
        let text = if key == "Enter" { "\r" } else { "" };
        let event =
            |kind| json!({ "type": kind, "key": key, "code": key, "text": text, "windowsVirtualKeyCode": code });
        self.call("Input.dispatchKeyEvent", &event(if text.is_empty() { "rawKeyDown" } else { "keyDown" }));
        self.call("Input.dispatchKeyEvent", &event("keyUp"));
    }

    /// Types a character.
    pub(crate) fn type_character(&mut self, character: char) {
        let event = |kind| json!({ "type": kind, "key": character.to_string(), "text": character.to_string() });
        self.call("Input.dispatchKeyEvent", &event("keyDown"));
        self.call("Input.dispatchKeyEvent", &event("keyUp"));
    }

    /// Clicks with the left button.
    pub(crate) fn click(&mut self, at: Point) {
        self.drag(at, at);
    }

    /// Presses the left button at one position and releases it at another.
    pub(crate) fn drag(&mut self, from: Point, to: Point) {
        self.drag_with("left", 0, from, to);
    }

    /// Double-clicks with the left button.
    pub(crate) fn double_click(&mut self, at: Point) {
        for (kind, count) in [("mousePressed", 1), ("mouseReleased", 1), ("mousePressed", 2), ("mouseReleased", 2)] {
            let event = json!({ "type": kind, "x": at.0, "y": at.1, "button": "left", "clickCount": count });
            self.call("Input.dispatchMouseEvent", &event);
        }
    }

    /// Drags with a button, "left" or "right", and the protocol's modifiers: 8 is Shift.
    pub(crate) fn drag_with(&mut self, button: &str, modifiers: u32, from: Point, to: Point) {
        let pressed = if button == "left" { 1 } else { 2 };
        let middle = (f64::midpoint(from.0, to.0), f64::midpoint(from.1, to.1));
        for (kind, at, buttons) in [
            ("mouseMoved", from, 0),
            ("mousePressed", from, pressed),
            ("mouseMoved", middle, pressed),
            ("mouseMoved", to, pressed),
            ("mouseReleased", to, 0),
        ] {
            let button = if kind == "mouseMoved" && buttons == 0 { "none" } else { button };
            let event = json!({ "type": kind, "x": at.0, "y": at.1, "button": button, "buttons": buttons,
                                "modifiers": modifiers, "clickCount": 1 });
            self.call("Input.dispatchMouseEvent", &event);
        }
    }

    /// Turns the mouse wheel.
    pub(crate) fn wheel(&mut self, at: Point, turn: f64) {
        let event = json!({ "type": "mouseWheel", "x": at.0, "y": at.1, "deltaX": 0, "deltaY": turn });
        self.call("Input.dispatchMouseEvent", &event);
    }

    /// The middle of the first element that a selector matches, scrolled into view.
    pub(crate) fn middle_of(&mut self, selector: &str) -> Point {
        self.evaluate(&format!(
            "(() => {{ const element = document.querySelector({selector:?});
                element.scrollIntoView({{ block: 'center', behavior: 'instant' }});
                const box = element.getBoundingClientRect();
                return [box.x + box.width / 2, box.y + box.height / 2]; }})()"
        ))
    }

    /// Width that the page needs with all details open, CSS pixels.
    pub(crate) fn width_needed(&mut self) -> u32 {
        self.evaluate(
            "(document.querySelectorAll('details').forEach(details => { details.open = true; }),
                document.documentElement.scrollWidth)",
        )
    }

    /// A screenshot of the window, as PNG in base 64.
    pub(crate) fn screenshot(&mut self) -> String {
        self.call("Page.captureScreenshot", &json!({}))["data"].as_str().unwrap().to_owned()
    }

    /// Brightness of each pixel of the first element that a selector matches, 0 to 255, in ascending order. The element is cut from a
    /// screenshot of the window, which is enlarged as required; a screenshot of the element alone would redraw the whole page.
    pub(crate) fn shades(&mut self, selector: &str) -> Vec<u8> {
        let sides = format!(
            "(box => [box.left, box.top, box.right, box.bottom])(document.querySelector({selector:?}).getBoundingClientRect())"
        );
        let [width, height]: [u32; 2] = self.evaluate("[innerWidth, innerHeight]");
        let [_, top, _, bottom]: [f64; 4] = self.evaluate(&sides);
        let needed = (bottom - top).ceil() as u32;
        if needed > height {
            self.resize(width, needed);
        }
        self.middle_of(selector);
        let [left, top, right, bottom]: [f64; 4] = self.evaluate(&sides);
        let (seen_across, seen_down) = (-1.0..=f64::from(width) + 1.0, -1.0..=f64::from(needed.max(height)) + 1.0);
        let whole = [left, right].iter().all(|x| seen_across.contains(x))
            && [top, bottom].iter().all(|y| seen_down.contains(y));
        assert!(whole, "{selector} is not seen whole: {:?}", [left, top, right, bottom]);
        let file = data_encoding::BASE64.decode(self.screenshot().as_bytes()).unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(file)).read_info().unwrap();
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        let frame = reader.next_frame(&mut bytes).unwrap();
        let within = |from: f64, to: f64| (from * self.pixels).ceil() as usize..(to * self.pixels).floor() as usize;
        let (columns, rows) = (within(left, right), within(top, bottom));
        let lines = bytes[..frame.buffer_size()].chunks(frame.line_size).take(rows.end).skip(rows.start);
        let pixels =
            lines.flat_map(|line| line.chunks(frame.color_type.samples()).take(columns.end).skip(columns.start));
        let mut shades: Vec<u8> =
            pixels.map(|pixel| (pixel[..3].iter().map(|&part| u16::from(part)).sum::<u16>() / 3) as u8).collect();
        shades.sort_unstable();
        if needed > height {
            self.resize(width, height);
        }
        shades
    }

    /// Errors and warnings on the console, uncaught exceptions, and other messages of the browser, except about slow drawing without a
    /// graphics card.
    pub(crate) fn complaints(&mut self) -> Vec<String> {
        self.settle();
        let complaint = |event: &Value| match event["method"].as_str()? {
            "Runtime.exceptionThrown" => Some(event["params"].to_string()),
            "Log.entryAdded" => {
                let slow =
                    event["params"]["entry"]["text"].as_str()?.contains("GL Driver Message (OpenGL, Performance");
                (!slow).then(|| event["params"].to_string())
            }
            "Runtime.consoleAPICalled" => {
                let kind = event["params"]["type"].as_str()?;
                ["error", "warning", "assert"].contains(&kind).then(|| event["params"].to_string())
            }
            _ => None,
        };
        self.connection.events().iter().filter_map(complaint).collect()
    }

    /// Requested addresses, except the page's own and embedded data.
    pub(crate) fn requests(&mut self) -> Vec<String> {
        self.settle();
        let sent = self.connection.events().iter().filter(|event| event["method"] == "Network.requestWillBeSent");
        let addresses = sent.filter_map(|event| event["params"]["request"]["url"].as_str());
        addresses
            .filter(|address| *address != self.address && !address.starts_with("data:"))
            .map(str::to_owned)
            .collect()
    }

    /// Waits for the events that the browser has already sent.
    fn settle(&mut self) {
        self.evaluate::<u32>("new Promise(done => requestAnimationFrame(() => setTimeout(() => done(0), 50)))");
    }

    fn call(&mut self, method: &str, arguments: &Value) -> Value {
        self.connection.call(method, arguments)
    }
}
