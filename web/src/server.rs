//! Serves the page, and takes the reports of pages that a test opens.

use std::io::{self, BufRead, BufReader, Read, Write};
use std::net::{Shutdown, SocketAddr, TcpListener, TcpStream};
use std::path::{Component, Path, PathBuf};
use std::sync::mpsc::Sender;
use std::time::{Duration, Instant};

use crate::request::LARGEST_SIDE;

/// What a page that was opened with `report=ID` sends, once.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Report {
    /// What the page was opened with. A page that was opened before has another one, and may still
    /// report.
    pub id: String,
    /// What it shows.
    pub body: Vec<u8>,
}

/// The longest head of a request.
const LONGEST_HEAD: u64 = 1 << 14;
/// The longest report: four numbers and four bytes for each pixel of the largest picture, and text.
const LONGEST_REPORT: u64 = 20 * (LARGEST_SIDE as u64).pow(2) + (1 << 16);
/// What is still read of a request that is already answered.
const LONGEST_REST: u64 = 1 << 20;
/// The connections that are answered at a time; a browser has six, and may open more ahead.
const CONNECTIONS: usize = 16;
/// The time for a head, for a body and for an answer.
const PATIENCE: Duration = Duration::from_secs(30);

/// Serves a folder at an address, and port 0 for one that is free.
pub struct PageServer {
    listener: TcpListener,
    address: SocketAddr,
    folder: PathBuf,
    patience: Duration,
}

impl PageServer {
    /// Opens the port.
    ///
    /// # Errors
    ///
    /// If it cannot be opened: the reason.
    pub fn open(folder: &Path, address: SocketAddr) -> Result<Self, String> {
        let bound = TcpListener::bind(address).and_then(|port| Ok((port.local_addr()?, port)));
        let (address, listener) = bound.map_err(|e| format!("cannot serve {address}: {e}"))?;
        Ok(Self { listener, address, folder: folder.to_owned(), patience: PATIENCE })
    }

    /// Returns where a browser finds the page.
    pub fn url(&self) -> String {
        format!("http://{}/", self.address)
    }

    /// Answers until the process ends. Reports go to `reports`, if anyone takes them.
    pub fn serve(&self, reports: Option<&Sender<Report>>) {
        std::thread::scope(|scope| {
            for _ in 0..CONNECTIONS {
                scope.spawn(move || {
                    for stream in self.listener.incoming() {
                        match stream {
                            // A browser that has gone needs no answer.
                            Ok(stream) => drop(self.connection(&stream, reports)),
                            // With too many open files, say, the next call would fail at once too.
                            Err(_) => std::thread::sleep(Duration::from_millis(100)),
                        }
                    }
                });
            }
        });
    }

    /// Answers the one request of a connection and closes it.
    fn connection(&self, stream: &TcpStream, reports: Option<&Sender<Report>>) -> io::Result<()> {
        let mut reader = BufReader::new(self.timed(stream));
        let answer = self.answer(&mut reader, reports)?;
        answer.write(&mut self.timed(stream))?;
        stream.shutdown(Shutdown::Write)?;
        // To close a connection with unread bytes resets it, and the answer may be lost.
        let end = Instant::now() + self.patience.min(Duration::from_secs(1));
        io::copy(&mut Timed { stream, end }.take(LONGEST_REST), &mut io::sink())?;
        Ok(())
    }

    fn timed<'a>(&self, stream: &'a TcpStream) -> Timed<'a> {
        Timed { stream, end: Instant::now() + self.patience }
    }

    /// Reads a request and returns its answer.
    fn answer(
        &self,
        reader: &mut BufReader<Timed<'_>>,
        reports: Option<&Sender<Report>>,
    ) -> io::Result<Answer> {
        let Some(head) = Head::read(reader)? else {
            return Ok(Answer::status(400, "this is no request"));
        };
        match (head.method.as_str(), head.path.strip_prefix("/report/"), reports) {
            ("GET", ..) => Ok(self.file(&head.path)),
            ("POST", Some(id), Some(reports)) => {
                let length = match head.length {
                    None => return Ok(Answer::status(411, "a report has a Content-Length")),
                    Some(length) if length > LONGEST_REPORT => {
                        return Ok(Answer::status(413, "the report is too long"));
                    }
                    Some(length) => length,
                };
                *reader.get_mut() = self.timed(reader.get_ref().stream);
                let mut body = Vec::new();
                reader.take(length).read_to_end(&mut body)?;
                if (body.len() as u64) < length {
                    return Ok(Answer::status(400, "the report is shorter than its head says"));
                }
                // A test that has gone needs no report.
                let _ = reports.send(Report { id: id.to_owned(), body });
                Ok(Answer::status(200, ""))
            }
            _ => Ok(Answer::status(405, "this server has files alone")),
        }
    }

    /// Returns a file of the folder.
    fn file(&self, path: &str) -> Answer {
        let name = match path.trim_start_matches('/') {
            "" => "index.html",
            name => name,
        };
        // Nothing outside of the folder.
        let is_inside = Path::new(name).components().all(|c| matches!(c, Component::Normal(_)));
        let Some(body) = is_inside.then(|| std::fs::read(self.folder.join(name)).ok()).flatten()
        else {
            return Answer::status(404, "there is no such file");
        };
        let kind = match Path::new(name).extension().and_then(|e| e.to_str()) {
            Some("html") => "text/html; charset=utf-8",
            Some("css") => "text/css; charset=utf-8",
            Some("js") => "text/javascript; charset=utf-8",
            Some("wasm") => "application/wasm",
            _ => "application/octet-stream",
        };
        Answer { code: 200, kind, body }
    }
}

/// A connection until a moment: one that gives a byte now and then would begin a timeout anew.
struct Timed<'a> {
    stream: &'a TcpStream,
    end: Instant,
}

impl Timed<'_> {
    /// Returns the time that is left; none is an error of the stream as a timeout.
    fn left(&self) -> Option<Duration> {
        Some(self.end.saturating_duration_since(Instant::now()))
    }
}

impl Read for Timed<'_> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        self.stream.set_read_timeout(self.left())?;
        self.stream.read(bytes)
    }
}

impl Write for Timed<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.stream.set_write_timeout(self.left())?;
        self.stream.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.stream.flush()
    }
}

/// What is used of the head of a request.
struct Head {
    method: String,
    /// Without the query.
    path: String,
    /// The bytes of the body, and `u64::MAX` for more than that.
    length: Option<u64>,
}

impl Head {
    /// Reads a head, and `None` of what is none, is too long or ends early.
    fn read(reader: &mut impl BufRead) -> io::Result<Option<Self>> {
        let mut reader = reader.take(LONGEST_HEAD);
        let Some(first) = line(&mut reader)? else { return Ok(None) };
        let words: Vec<&str> = first.split_ascii_whitespace().collect();
        let &[method, target, version] = words.as_slice() else { return Ok(None) };
        if !version.starts_with("HTTP/1.") {
            return Ok(None);
        }
        let path = target.split('?').next().unwrap_or_default();
        let mut head = Self { method: method.to_owned(), path: path.to_owned(), length: None };
        loop {
            let Some(line) = line(&mut reader)? else { return Ok(None) };
            if line.is_empty() {
                return Ok(Some(head));
            }
            let Some((name, value)) = line.split_once(':') else { return Ok(None) };
            if name.eq_ignore_ascii_case("Content-Length") {
                let digits = value.trim();
                if digits.is_empty() || !digits.bytes().all(|b| b.is_ascii_digit()) {
                    return Ok(None);
                }
                head.length = Some(digits.parse().unwrap_or(u64::MAX));
            }
        }
    }
}

/// Reads a line without its end, and `None` if it has none.
fn line(reader: &mut impl BufRead) -> io::Result<Option<String>> {
    let mut bytes = Vec::new();
    reader.read_until(b'\n', &mut bytes)?;
    let text = bytes.strip_suffix(b"\n");
    Ok(text.map(|text| String::from_utf8_lossy(text).trim_end_matches('\r').to_owned()))
}

struct Answer {
    code: u16,
    /// The type of the body.
    kind: &'static str,
    body: Vec<u8>,
}

impl Answer {
    fn status(code: u16, text: &str) -> Self {
        Self { code, kind: "text/plain; charset=utf-8", body: text.into() }
    }

    fn write(&self, stream: &mut impl Write) -> io::Result<()> {
        let Self { code, kind, body } = self;
        let length = body.len();
        // A page that was built anew is another one.
        let head = format!(
            "HTTP/1.1 {code} \r\nContent-Type: {kind}\r\nContent-Length: {length}\r\n\
             Cache-Control: no-cache\r\nConnection: close\r\n\r\n"
        );
        stream.write_all(head.as_bytes())?;
        stream.write_all(body)
    }
}

#[cfg(test)]
mod tests {
    use std::net::Ipv4Addr;
    use std::sync::mpsc::{Receiver, channel};

    use super::*;

    /// A served folder with a file, beside another file.
    struct Served {
        folder: PathBuf,
        address: SocketAddr,
        reports: Receiver<Report>,
    }

    impl Served {
        fn new(name: &str, patience: Duration) -> Self {
            let folder = std::env::temp_dir().join(format!("raydsl-{name}-{}", std::process::id()));
            let inner = folder.join("inner");
            std::fs::create_dir_all(&inner).expect("a folder can be made");
            std::fs::write(inner.join("index.html"), "hello").expect("a file can be written");
            std::fs::write(folder.join("secret.txt"), "secret").expect("a file can be written");
            let opened = PageServer::open(&inner, (Ipv4Addr::LOCALHOST, 0).into());
            let server = PageServer { patience, ..opened.expect("a port is free") };
            let address = server.address;
            let (sender, reports) = channel();
            std::thread::spawn(move || server.serve(Some(&sender)));
            Self { folder, address, reports }
        }

        fn connect(&self) -> TcpStream {
            let stream = TcpStream::connect(self.address).expect("the server is there");
            stream.set_read_timeout(Some(Duration::from_secs(20))).expect("a timeout can be set");
            stream
        }

        /// Sends bytes as they are and returns the answer, which ends with the connection.
        fn ask(&self, bytes: impl AsRef<[u8]>) -> String {
            let mut stream = self.connect();
            stream.write_all(bytes.as_ref()).expect("the server listens");
            let mut answer = Vec::new();
            stream.read_to_end(&mut answer).expect("the server answers and closes");
            String::from_utf8_lossy(&answer).into_owned()
        }

        fn get(&self, path: &str) -> String {
            self.ask(format!("GET {path} HTTP/1.1\r\nHost: a\r\n\r\n"))
        }
    }

    impl Drop for Served {
        fn drop(&mut self) {
            let _ = std::fs::remove_dir_all(&self.folder);
        }
    }

    fn post(id: &str, length: impl std::fmt::Display, body: &str) -> String {
        format!("POST /report/{id} HTTP/1.1\r\nHost: a\r\ncontent-length: {length}\r\n\r\n{body}")
    }

    #[test]
    fn files_of_the_folder_are_served_and_no_others() {
        let served = Served::new("files", PATIENCE);
        for path in ["/", "/?scene=head", "/index.html"] {
            let answer = served.get(path);
            assert!(answer.starts_with("HTTP/1.1 200 ") && answer.ends_with("hello"), "{answer}");
            assert!(answer.contains("text/html"), "{answer}");
        }
        for path in
            ["/../secret.txt", "//../secret.txt", "/a/../../secret.txt", "/gone.js", "/\0", "/a\0"]
        {
            let answer = served.get(path);
            assert!(answer.starts_with("HTTP/1.1 404 "), "{path}: {answer}");
        }
        let answer = served.ask("DELETE /index.html HTTP/1.1\r\n\r\n");
        assert!(answer.starts_with("HTTP/1.1 405 "), "{answer}");
    }

    /// Of two pages that report at a time, each has its own report.
    #[test]
    fn reports_keep_to_their_ids() {
        let served = Served::new("reports", PATIENCE);
        let mut slow = served.connect();
        slow.write_all(post("1", 6, "abc").as_bytes()).expect("the server listens");
        let answer = served.ask(post("2", 4, "wxyz"));
        assert!(answer.starts_with("HTTP/1.1 200 "), "{answer}");
        slow.write_all(b"def").expect("the server listens");
        for (id, body) in [("2", "wxyz"), ("1", "abcdef")] {
            let report = served.reports.recv_timeout(PATIENCE).expect("there is a report");
            assert_eq!(report, Report { id: id.to_owned(), body: body.into() });
        }
    }

    /// The answer is there before the body is, and nothing waits for that.
    #[test]
    fn a_body_that_is_too_long_is_not_read() {
        let served = Served::new("long", PATIENCE);
        let lengths = [
            (LONGEST_REPORT + 1).to_string(),
            u64::MAX.to_string(),
            "9".repeat(50),
            "8".repeat(19),
        ];
        for length in lengths {
            for body in ["", &"a".repeat(100_000)] {
                let answer = served.ask(post("1", &length, body));
                assert!(answer.starts_with("HTTP/1.1 413 "), "{length}: {answer}");
                assert!(answer.contains("Connection: close"), "{length}: {answer}");
            }
        }
        // Of one that goes on for ever the rest is refused.
        let mut stream = served.connect();
        stream.write_all(post("1", u64::MAX, "").as_bytes()).expect("the server listens");
        let sent = (0..10_000).take_while(|_| stream.write_all(&[0; 1 << 16]).is_ok());
        assert!(sent.count() < 10_000, "all of the body is read");
        assert!(served.reports.try_recv().is_err(), "there is a report");
        assert!(served.get("/").ends_with("hello"));
    }

    #[test]
    fn what_is_no_request_is_refused_and_others_are_answered() {
        let served = Served::new("hostile", PATIENCE);
        let many = format!("GET / HTTP/1.1\r\n{}", "A: b\r\n".repeat(10_000));
        let requests: [&[u8]; 16] = [
            b"",
            b"\0",
            b"GET",
            b"GET /",
            b"GET / HTTP/1.1",
            b"GET / HTTP/1.1\r\nHost: a",
            b"GET / HTTP/1.1\r\nHost\r\n\r\n",
            b"GET / HTTP/2\r\n\r\n",
            b"\r\n\r\n",
            b"\xff\xfe \xff \xff\r\n\r\n",
            b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03",
            &[b'a'; 100_000],
            many.as_bytes(),
            b"POST /report/1 HTTP/1.1\r\nContent-Length: 10\r\n\r\nabc",
            b"POST /report/1 HTTP/1.1\r\nContent-Length: -1\r\n\r\nabc",
            b"POST /report/1 HTTP/1.1\r\nContent-Length: 0x10\r\n\r\nabc",
        ];
        for bytes in requests {
            let mut stream = served.connect();
            stream.write_all(bytes).expect("the server listens");
            stream.shutdown(Shutdown::Write).expect("the server listens");
            let mut answer = String::new();
            stream.read_to_string(&mut answer).expect("the server answers and closes");
            let shown = String::from_utf8_lossy(&bytes[..bytes.len().min(60)]);
            assert!(answer.starts_with("HTTP/1.1 400 "), "{shown:?}: {answer}");
        }
        let chunks = "Transfer-Encoding: chunked\r\n\r\nFFFFFFFFFFFFFFFF\r\nabc";
        let answer = served.ask(format!("POST /report/1 HTTP/1.1\r\n{chunks}"));
        assert!(answer.starts_with("HTTP/1.1 411 "), "{answer}");
        assert!(served.reports.try_recv().is_err(), "there is a report");
        assert!(served.get("/").ends_with("hello"));
    }

    /// More silent connections than are answered at a time, and some that say a little.
    #[test]
    fn silent_connections_are_closed() {
        let served = Served::new("silent", Duration::from_millis(500));
        let mut silent: Vec<TcpStream> = (0..2 * CONNECTIONS).map(|_| served.connect()).collect();
        for (stream, text) in silent.iter_mut().zip(["GET / HT", &post("1", 100, "abc")]) {
            stream.write_all(text.as_bytes()).expect("the server listens");
        }
        assert!(served.get("/").ends_with("hello"));
        for mut stream in silent {
            let mut answer = Vec::new();
            // A connection with unread bytes is reset.
            let _ = stream.read_to_end(&mut answer);
            assert!(answer.is_empty(), "{answer:?}");
        }
    }
}
