//! Serves the page, and takes the reports of pages that a test opens.

use std::collections::HashMap;
use std::io::Read;
use std::net::SocketAddr;
use std::path::{Component, Path, PathBuf};
use std::sync::mpsc::Sender;

use tiny_http::{Header, Method, Request, Response, Server, StatusCode};

/// What a page that was opened with `report` sends: the text of each part, or its numbers.
pub type Report = HashMap<String, Vec<u8>>;

/// The longest part of a report.
const LONGEST: u64 = 1 << 30;

/// Serves a folder at an address, and port 0 for one that is free.
pub struct PageServer {
    server: Server,
    folder: PathBuf,
}

impl PageServer {
    /// Opens the port.
    ///
    /// # Errors
    ///
    /// If it cannot be opened: the reason.
    pub fn open(folder: &Path, address: SocketAddr) -> Result<Self, String> {
        let server = Server::http(address).map_err(|e| format!("cannot serve {address}: {e}"))?;
        Ok(Self { server, folder: folder.to_owned() })
    }

    /// Returns where a browser finds the page.
    pub fn url(&self) -> String {
        format!("http://{}/", self.server.server_addr())
    }

    /// Answers until the process ends. Reports go to `reports`, if anyone takes them.
    pub fn serve(&self, reports: Option<&Sender<Report>>) {
        let mut report = Report::new();
        for mut request in self.server.incoming_requests() {
            let path = request.url().split('?').next().unwrap_or_default().to_owned();
            let answer = match (request.method(), path.strip_prefix("/report/"), reports) {
                (Method::Get, ..) => self.file(&path),
                (Method::Post, Some(part), Some(reports)) => {
                    let answer = read(&mut request).map(|bytes| report.insert(part.into(), bytes));
                    if part == "end" {
                        // A test that has gone needs no report.
                        let _ = reports.send(std::mem::take(&mut report));
                    }
                    match answer {
                        Ok(_) => Response::from_data(Vec::new()),
                        Err(e) => status(400, &e.to_string()),
                    }
                }
                _ => status(405, "this server has files alone"),
            };
            // A browser that has gone needs no answer.
            let _ = request.respond(answer);
        }
    }

    /// Returns a file of the folder.
    fn file(&self, path: &str) -> Response<std::io::Cursor<Vec<u8>>> {
        let name = match path.trim_start_matches('/') {
            "" => "index.html",
            name => name,
        };
        // Nothing outside of the folder.
        let is_inside = Path::new(name).components().all(|c| matches!(c, Component::Normal(_)));
        let Some(bytes) = is_inside.then(|| std::fs::read(self.folder.join(name)).ok()).flatten()
        else {
            return status(404, "there is no such file");
        };
        let kind = match Path::new(name).extension().and_then(|e| e.to_str()) {
            Some("html") => "text/html; charset=utf-8",
            Some("css") => "text/css; charset=utf-8",
            Some("js") => "text/javascript; charset=utf-8",
            Some("wasm") => "application/wasm",
            _ => "application/octet-stream",
        };
        let answer = Response::from_data(bytes);
        // A page that was built anew is another one.
        let headers = [("Content-Type", kind), ("Cache-Control", "no-cache")];
        headers
            .into_iter()
            .filter_map(|(name, value)| Header::from_bytes(name, value).ok())
            .fold(answer, |answer, header| answer.with_header(header))
    }
}

fn status(code: u16, text: &str) -> Response<std::io::Cursor<Vec<u8>>> {
    Response::from_data(text.as_bytes().to_vec()).with_status_code(StatusCode(code))
}

fn read(request: &mut Request) -> std::io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    request.as_reader().take(LONGEST).read_to_end(&mut bytes)?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use std::io::{Read, Write};
    use std::net::{Ipv4Addr, TcpStream};
    use std::sync::mpsc::channel;

    use super::*;

    /// Sends a request as it is and returns the answer.
    fn ask(address: &str, text: &str) -> String {
        let mut stream = TcpStream::connect(address).expect("the server is there");
        stream.write_all(text.as_bytes()).expect("it listens");
        let mut answer = String::new();
        stream.read_to_string(&mut answer).expect("it answers");
        answer
    }

    #[test]
    fn files_of_the_folder_are_served_and_no_others() {
        let folder = std::env::temp_dir().join(format!("raydsl-web-{}", std::process::id()));
        std::fs::create_dir_all(folder.join("inner")).expect("a folder can be made");
        std::fs::write(folder.join("inner/index.html"), "hello").expect("a file can be written");
        std::fs::write(folder.join("secret.txt"), "secret").expect("a file can be written");
        let inner = folder.join("inner");
        let server = PageServer::open(&inner, (Ipv4Addr::LOCALHOST, 0).into()).expect("a port");
        let url = server.url();
        let address = url.trim_start_matches("http://").trim_end_matches('/').to_owned();
        let (sender, reports) = channel();
        std::thread::spawn(move || server.serve(Some(&sender)));

        let get = |path: &str| {
            ask(&address, &format!("GET {path} HTTP/1.1\r\nHost: a\r\nConnection: close\r\n\r\n"))
        };
        for path in ["/", "/?scene=head", "/index.html"] {
            let answer = get(path);
            assert!(answer.starts_with("HTTP/1.1 200") && answer.ends_with("hello"), "{answer}");
            assert!(answer.contains("text/html"), "{answer}");
        }
        for path in ["/../secret.txt", "//../secret.txt", "/a/../../secret.txt", "/gone.js"] {
            let answer = get(path);
            assert!(answer.starts_with("HTTP/1.1 404"), "{path}: {answer}");
        }

        for (part, body) in [("light", "abcd"), ("end", "")] {
            let length = body.len();
            let head = format!("POST /report/{part} HTTP/1.1\r\nHost: a\r\nConnection: close\r\n");
            let answer = ask(&address, &format!("{head}Content-Length: {length}\r\n\r\n{body}"));
            assert!(answer.starts_with("HTTP/1.1 200"), "{answer}");
        }
        let report = reports.recv().expect("a report");
        assert_eq!(report.get("light").map(Vec::as_slice), Some(&b"abcd"[..]));
        std::fs::remove_dir_all(&folder).expect("the folder can be removed");
    }
}
