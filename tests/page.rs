//! The page in a browser: headless Chromium, driven by chromedriver over the WebDriver protocol (W3C recommendation of 2018).
//!
//! Without chromedriver the browser's part is left out, and said aloud; `POLHODE_REQUIRE_BROWSER=1` makes that a failure. Pictures of the page at two
//! widths are left under `target/tmp/page/` to be looked at.

#![expect(clippy::expect_used, clippy::panic, clippy::print_stderr, reason = "helpers of tests; a report")]

use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::OnceLock;
use std::time::Duration;

/// Everything computed once, in a folder and a store of its own.
fn site() -> &'static Path {
    static SITE: OnceLock<PathBuf> = OnceLock::new();
    SITE.get_or_init(|| {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("page");
        let done = Command::new(env!("CARGO_BIN_EXE_polhode"))
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .args(["figures", "--no-progress", "--out"])
            .arg(folder.join("figures"))
            .arg("--store")
            .arg(folder.join("store"))
            .output()
            .expect("the binary runs");
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        folder
    })
}

fn html() -> String {
    std::fs::read_to_string(site().join("figures/article/index.html")).expect("the page")
}

/// The values of an attribute.
fn attributes<'h>(html: &'h str, name: &str) -> Vec<&'h str> {
    let start = format!(" {name}=\"");
    html.split(start.as_str()).skip(1).filter_map(|rest| rest.split('"').next()).collect()
}

/// The tags of pictures that have no name: neither words of their own nor an element of the page that holds them.
fn nameless<'h>(html: &'h str, ids: &BTreeSet<&str>) -> Vec<&'h str> {
    let tags = html.split('<').filter_map(|rest| rest.split('>').next());
    let is_named = |tag: &str| {
        let has_words = attributes(tag, "aria-label").iter().any(|words| !words.trim().is_empty());
        let mut labels = attributes(tag, "aria-labelledby").into_iter().flat_map(str::split_whitespace).peekable();
        has_words || (labels.peek().is_some() && labels.all(|id| ids.contains(id)))
    };
    tags.filter(|tag| tag.contains(" role=\"img\"") && !is_named(tag)).collect()
}

#[test]
fn pictures_without_names_are_found() {
    let html = r#"<h2 id="a">A</h2><svg role="img" aria-labelledby="a"><svg role="img" aria-label="B"><svg>"#;
    let ids = BTreeSet::from(["a"]);
    assert!(nameless(html, &ids).is_empty());
    for bad in [r#"svg role="img""#, r#"svg role="img" aria-label=" ""#, r#"svg role="img" aria-labelledby="a b""#] {
        assert_eq!(nameless(&format!("{html}<{bad}>"), &ids), [bad]);
    }
}

/// Every link leads to a file that was made or to a place on the page; nothing is asked of the network; ids are unique; pictures have
/// names.
#[test]
fn every_link_resolves() {
    let html = html();
    let ids = attributes(&html, "id");
    let unique: BTreeSet<&str> = ids.iter().copied().collect();
    assert_eq!(ids.len(), unique.len(), "an id stands twice");
    let mut files = 0;
    for link in attributes(&html, "href").into_iter().chain(attributes(&html, "src")) {
        if let Some(id) = link.strip_prefix('#') {
            assert!(unique.contains(id), "no place {link}");
        } else if !link.starts_with("https://inria.hal.science/") && !link.starts_with("data:,") {
            let file = site().join("figures/article").join(link);
            assert!(file.is_file(), "no file {link}");
            files += 1;
        }
    }
    assert!(files > 200, "{files} links to files");
    assert!(html.matches(" role=\"img\"").count() >= 9, "nine figures and more");
    let nameless = nameless(&html, &unique);
    assert!(nameless.is_empty(), "{nameless:?}");
    let size = html.len();
    assert!(size < 5_000_000, "{size} bytes");
    assert!(
        !html.contains("<script src")
            && !html.contains("@import")
            && !html.replace("http://www.w3.org/", "").contains("http://"),
        "the network"
    );
}

/// A browser session.
struct Browser {
    driver: Child,
    port: u16,
    session: String,
}

impl Drop for Browser {
    fn drop(&mut self) {
        let _ = self.call("DELETE", "", &json!({}));
        let _ = self.driver.kill();
        let _ = self.driver.wait();
    }
}

impl Browser {
    /// None where there is no chromedriver.
    fn start(width: u32, height: u32) -> Option<Self> {
        let port = TcpListener::bind("127.0.0.1:0").and_then(|listener| listener.local_addr()).expect("a port").port();
        let driver = Command::new("chromedriver")
            .arg(format!("--port={port}"))
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn();
        let Ok(driver) = driver else {
            assert!(std::env::var_os("POLHODE_REQUIRE_BROWSER").is_none(), "chromedriver is missing and required");
            eprintln!(
                "CHROMEDRIVER IS MISSING: the page was not tried in a browser (apt install chromium chromium-driver)"
            );
            return None;
        };
        let mut browser = Self { driver, port, session: String::new() };
        let arguments = [
            "--headless=new",
            "--no-sandbox",
            "--disable-gpu",
            "--disable-dev-shm-usage",
            "--no-first-run",
            "--disable-background-networking",
            "--disable-component-update",
            "--disable-sync",
            "--hide-scrollbars",
            "--force-color-profile=srgb",
        ];
        let mut arguments: Vec<String> = arguments.map(str::to_owned).into();
        arguments.push(format!("--window-size={width},{height}"));
        let capabilities = json!({ "capabilities": { "alwaysMatch": {
            "browserName": "chrome",
            "goog:chromeOptions": { "args": arguments },
            "goog:loggingPrefs": { "browser": "ALL", "performance": "ALL" },
        } } });
        for _ in 0..200 {
            if let Some(session) = browser.call("POST", "", &capabilities)["sessionId"].as_str() {
                browser.session = format!("/{session}");
                // A phone is narrower than a window may be.
                let metrics = json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": false });
                let command = json!({ "cmd": "Emulation.setDeviceMetricsOverride", "params": metrics });
                browser.call("POST", "/goog/cdp/execute", &command);
                return Some(browser);
            }
            std::thread::sleep(Duration::from_millis(50));
        }
        panic!("chromedriver does not answer");
    }

    /// One command; Null where the connection fails.
    fn call(&self, method: &str, path: &str, body: &Value) -> Value {
        let body = if method == "GET" { String::new() } else { body.to_string() };
        let request = format!(
            "{method} /session{}{path} HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\nContent-Length: {}\r\nConnection: close\r\n\r\n{body}",
            self.session,
            body.len()
        );
        let answer = TcpStream::connect(("127.0.0.1", self.port)).and_then(|mut stream| {
            stream.set_read_timeout(Some(Duration::from_secs(60)))?;
            stream.write_all(request.as_bytes())?;
            let (mut answer, mut buffer) = (Vec::new(), [0; 65536]);
            loop {
                match stream.read(&mut buffer)? {
                    0 => break,
                    n => answer.extend_from_slice(&buffer[..n]),
                }
                if is_whole(&answer) {
                    break;
                }
            }
            Ok(answer)
        });
        let Ok(answer) = answer else { return Value::Null };
        let text = String::from_utf8_lossy(&answer);
        let body = text.split_once("\r\n\r\n").map_or("", |(_, body)| body);
        serde_json::from_str::<Value>(body).map_or(Value::Null, |value| value["value"].clone())
    }

    fn open(&self, file: &Path) {
        self.call("POST", "/url", &json!({ "url": format!("file://{}", file.display()) }));
    }

    fn run(&self, script: &str) -> Value {
        let answer = self.call("POST", "/execute/sync", &json!({ "script": script, "args": [] }));
        assert!(answer.get("error").is_none(), "{script}: {answer}");
        answer
    }

    fn log(&self, kind: &str) -> Vec<Value> {
        self.call("POST", "/se/log", &json!({ "type": kind })).as_array().cloned().unwrap_or_default()
    }

    /// The whole page as a PNG.
    fn picture(&self, file: &Path) {
        let width = self.run("return document.documentElement.clientWidth");
        // Longer pictures are more than the browser can make at once.
        let clip = json!({ "x": 0, "y": 0, "width": width, "height": 9000, "scale": 1 });
        let parameters = json!({ "format": "png", "captureBeyondViewport": true, "clip": clip });
        let command = json!({ "cmd": "Page.captureScreenshot", "params": parameters });
        let answer = self.call("POST", "/goog/cdp/execute", &command);
        let data = answer["data"].as_str().unwrap_or_else(|| panic!("no picture: {answer}"));
        std::fs::write(file, base64(data)).expect("written");
    }
}

/// Whether an answer holds as many bytes as its head says.
fn is_whole(answer: &[u8]) -> bool {
    let text = String::from_utf8_lossy(answer);
    let Some((head, _)) = text.split_once("\r\n\r\n") else { return false };
    let length =
        head.lines().find_map(|line| line.to_ascii_lowercase().strip_prefix("content-length:").map(str::to_owned));
    let length: usize = length.and_then(|length| length.trim().parse().ok()).unwrap_or(usize::MAX);
    answer.len() >= head.len() + 4 + length
}

fn base64(text: &str) -> Vec<u8> {
    const LETTERS: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let (mut bytes, mut bits, mut count) = (Vec::new(), 0_u32, 0);
    for letter in text.bytes().filter(|letter| *letter != b'=') {
        let value = LETTERS.iter().position(|known| *known == letter).expect("base64");
        bits = bits << 6 | value as u32;
        count += 6;
        if count >= 8 {
            count -= 8;
            bytes.push((bits >> count) as u8);
        }
    }
    bytes
}

/// No error on the console, no request but for the file itself, nothing wider than the window; layers, zoom and slider do what they say.
#[test]
fn the_page_in_chromium() {
    let page = site().join("figures/article/index.html");
    for (width, height) in [(1280, 900), (390, 844)] {
        let Some(browser) = Browser::start(width, height) else { return };
        browser.open(&page);
        let errors: Vec<Value> = browser.log("browser").into_iter().filter(|line| line["level"] != "INFO").collect();
        assert!(errors.is_empty(), "{errors:?}");
        let mut asked = 0;
        for line in browser.log("performance") {
            let message: Value = serde_json::from_str(line["message"].as_str().unwrap_or("null")).expect("JSON");
            if message["message"]["method"] == "Network.requestWillBeSent" {
                let url = message["message"]["params"]["request"]["url"].as_str().unwrap_or_default();
                assert!(url.starts_with("file://") || url.starts_with("data:"), "{url}");
                asked += 1;
            }
        }
        assert!(asked >= 1, "the performance log is there");
        let loaded = browser.run("return performance.getEntriesByType('navigation')[0].loadEventEnd");
        let wide = browser.run("return document.documentElement.scrollWidth - document.documentElement.clientWidth");
        eprintln!("{width} px: loaded in {loaded} ms");
        assert_eq!(wide, json!(0), "the page is wider than its window at {width} px");

        // Layers: unticking one hides its groups and nothing else.
        let script = "const box = document.querySelector('#fig7 input[data-layer=\"conjugate-locus\"]'); box.click();
            const groups = [...document.querySelectorAll('#fig7 svg g[data-role]')];
            const hidden = groups.filter((g) => g.style.display === 'none').map((g) => g.dataset.role);
            box.click();
            return [hidden.length, new Set(hidden).size, hidden[0], groups.filter((g) => g.style.display === 'none').length]";
        let layers = browser.run(script);
        assert!(
            layers[0].as_u64() >= Some(1) && layers[1] == 1 && layers[2] == "conjugate-locus" && layers[3] == 0,
            "{layers}"
        );

        // Zoom: in, and back to the whole.
        let script = "const figure = document.querySelector('#fig7 figure'), svg = figure.querySelector('svg');
            const before = svg.getAttribute('viewBox'); const [zoom, , whole] = figure.querySelectorAll('button');
            zoom.click(); const inside = svg.getAttribute('viewBox').split(' ').map(Number)[2]; whole.click();
            return [Number(before.split(' ')[2]), inside, svg.viewBox.baseVal.width]";
        let zoom: Vec<f64> = serde_json::from_value(browser.run(script)).expect("numbers");
        assert!(zoom[1] < zoom[0] && (zoom[2] - zoom[0]).abs() < 1e-3, "{zoom:?}");

        // Read-out: the middle of the first frame of Figure 7 is the start, (0, π/2).
        let script =
            "const svg = document.querySelector('#fig7 figure svg'), group = svg.querySelector('[data-frame]');
            const [l, t, r, b] = group.dataset.frame.split(' ').map(Number);
            const at = new DOMPoint((l + r) / 2, (t + b) / 2).matrixTransform(svg.getScreenCTM());
            svg.dispatchEvent(new PointerEvent('pointermove', { clientX: at.x, clientY: at.y, bubbles: true }));
            const text = document.querySelector('#fig7 .readout').textContent;
            const ends = (range) => { const [a, b] = range.split(' ').map(Number); return (a + b) / 2; };
            return [text, ends(group.dataset.x), ends(group.dataset.y)]";
        let read = browser.run(script);
        let shown: Vec<f64> = read[0]
            .as_str()
            .unwrap_or_default()
            .trim_matches(['(', ')'])
            .split(", ")
            .filter_map(|x| x.parse().ok())
            .collect();
        let expected: Vec<f64> = [&read[1], &read[2]].iter().filter_map(|x| x.as_f64()).collect();
        assert!(shown.len() == 2 && shown.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 0.02), "{read}");

        // The slider: another k is another curve, on the plane and on the sphere.
        let script = "const input = document.getElementById('slider-k'); const seen = [];
            for (const at of [0, Number(input.max)]) { input.value = at; input.dispatchEvent(new Event('input'));
                seen.push([document.getElementById('slider-value').value, document.querySelector('#slider-plane path').getAttribute('d').length,
                    document.querySelector('#slider-sphere path:last-of-type').getAttribute('d')]); }
            return seen";
        let seen = browser.run(script);
        assert_eq!((&seen[0][0], &seen[1][0]), (&json!("0.100"), &json!("1.500")));
        assert!(seen[0][1] != seen[1][1] && seen[0][2] != seen[1][2]);
        let play = browser.run("document.getElementById('slider-k').value = 0; const play = document.getElementById('slider-play'); play.click(); return play.textContent");
        assert_eq!(play, json!("Pause"));
        std::thread::sleep(Duration::from_millis(400));
        let moved = browser.run(
            "document.getElementById('slider-play').click(); return Number(document.getElementById('slider-k').value)",
        );
        assert!(moved.as_u64() >= Some(1), "{moved}");
        // Every picture, link and button has a name for those who don't see it.
        let nameless = "return [...document.querySelectorAll('svg[role=img], a, button, input')].filter((e) => !(e.textContent.trim() || e.getAttribute('aria-label') || e.labels?.length)).length";
        assert_eq!(browser.run(nameless), json!(0));
        browser.picture(&site().join(format!("{width}.png")));
        assert!(browser.log("browser").iter().all(|line| line["level"] == "INFO"));
    }
}
