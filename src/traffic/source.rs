//! Where live traffic comes from: files, standard input, UDP, TCP.

use std::fs::File;
use std::io::{ErrorKind, Read};
use std::net::{TcpStream, ToSocketAddrs, UdpSocket};
use std::path::PathBuf;
use std::sync::mpsc::SyncSender;
use std::time::{Duration, Instant};

/// Bytes that are read at once; no datagram is longer.
const CHUNK: usize = 1 << 14;

/// Seconds between two attempts to connect: the first and the longest.
const RETRY_S: [u64; 2] = [1, 30];

/// Seconds of silence after which that is an event.
const SILENT: Duration = Duration::from_secs(60);

/// Port of NMEA over a network, where none is given.
const PORT: u16 = 10110;

/// A source of sentences or deltas.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Source {
    /// A file, read at the pace at which it was recorded.
    File(PathBuf),
    /// Standard input.
    Stdin,
    /// Datagrams that are sent to an address of this machine.
    Udp(String),
    /// A server, to which the program connects, and connects again.
    Tcp(String),
}

/// What comes from a source.
#[derive(Debug)]
pub enum Arrival {
    /// Bytes of a source, which may begin and end within a line, and when they came.
    Bytes(usize, Vec<u8>, Instant),
    /// What has happened to a source, in words.
    Event(String),
    /// The source has ended for good.
    End(usize),
}

impl Source {
    /// The allowed forms in words.
    pub const ALLOWED: &str = "udp://[HOST:]PORT, where HOST is 127.0.0.1 by default, tcp://HOST:PORT, a file, \
                               or - for standard input";

    /// A source from its word; `None` for another scheme. Host names are looked up when it is opened.
    pub fn parse(word: &str) -> Option<Self> {
        if word == "-" {
            return Some(Self::Stdin);
        }
        let Some((scheme, address)) = word.split_once("://") else {
            return (!word.is_empty()).then(|| Self::File(PathBuf::from(word)));
        };
        let has_port = address
            .rsplit_once(':')
            .is_some_and(|(_, port)| port.parse::<u16>().is_ok());
        match scheme {
            "udp" if address.parse::<u16>().is_ok_and(|port| port > 0) => {
                Some(Self::Udp(format!("127.0.0.1:{address}")))
            }
            "udp" if has_port => Some(Self::Udp(address.to_owned())),
            "udp" if address.is_empty() => Some(Self::Udp(format!("127.0.0.1:{PORT}"))),
            "tcp" if has_port => Some(Self::Tcp(address.to_owned())),
            "tcp" if !address.is_empty() => Some(Self::Tcp(format!("{address}:{PORT}"))),
            _ => None,
        }
    }

    /// Its word, with the address and port that are used.
    pub fn name(&self) -> String {
        match self {
            Self::File(file) => file.display().to_string(),
            Self::Stdin => "-".to_owned(),
            Self::Udp(address) => format!("udp://{address}"),
            Self::Tcp(address) => format!("tcp://{address}"),
        }
    }

    /// Opens a live source, which sends what arrives from a thread of its own. A file is not live.
    ///
    /// The error says why it cannot be opened: a port that is taken. A server that is not there is tried
    /// again, and that is an event.
    pub fn open(self, index: usize, to: SyncSender<Arrival>) -> std::io::Result<()> {
        match self {
            Self::File(file) => {
                let file = File::open(file)?;
                std::thread::spawn(move || copied(file, index, &to));
            }
            Self::Stdin => {
                std::thread::spawn(move || copied(std::io::stdin(), index, &to));
            }
            Self::Udp(address) => {
                let socket = UdpSocket::bind(&address)?;
                socket.set_read_timeout(Some(SILENT))?;
                std::thread::spawn(move || datagrams(&socket, &address, index, &to));
            }
            Self::Tcp(address) => {
                std::thread::spawn(move || connected(&address, index, &to));
            }
        }
        Ok(())
    }
}

/// Sends a stream to its end.
fn copied(mut from: impl Read, index: usize, to: &SyncSender<Arrival>) {
    let mut chunk = vec![0; CHUNK];
    loop {
        match from.read(&mut chunk) {
            Ok(0) => break,
            Ok(read) => {
                if to
                    .send(Arrival::Bytes(
                        index,
                        chunk[..read].to_vec(),
                        Instant::now(),
                    ))
                    .is_err()
                {
                    return;
                }
            }
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) => {
                let _ = to.send(Arrival::Event(format!(
                    "the input cannot be read on: {error}"
                )));
                break;
            }
        }
    }
    let _ = to.send(Arrival::End(index));
}

fn datagrams(socket: &UdpSocket, address: &str, index: usize, to: &SyncSender<Arrival>) {
    let mut chunk = vec![0; CHUNK];
    loop {
        let sent = match socket.recv(&mut chunk) {
            Ok(read) => {
                // a datagram holds whole lines
                let mut bytes = chunk[..read].to_vec();
                bytes.push(b'\n');
                to.send(Arrival::Bytes(index, bytes, Instant::now()))
            }
            Err(error) if is_silence(&error) => to.send(silent(address)),
            Err(error) => {
                std::thread::sleep(Duration::from_secs(RETRY_S[0]));
                to.send(Arrival::Event(format!("udp://{address}: {error}")))
            }
        };
        if sent.is_err() {
            return;
        }
    }
}

fn is_silence(error: &std::io::Error) -> bool {
    matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut)
}

fn silent(address: &str) -> Arrival {
    Arrival::Event(format!("{address}: nothing for {} s", SILENT.as_secs()))
}

/// Reads from a server, and connects again where it goes away.
fn connected(address: &str, index: usize, to: &SyncSender<Arrival>) {
    let [first, longest] = RETRY_S;
    let mut wait = first;
    loop {
        let event = match connect(address) {
            Ok(stream) => {
                wait = first;
                if to
                    .send(Arrival::Event(format!("tcp://{address}: connected")))
                    .is_err()
                {
                    return;
                }
                match read_on(stream, index, to) {
                    Some(why) => format!("tcp://{address}: {why}; connecting again"),
                    None => return,
                }
            }
            Err(error) => format!("tcp://{address}: {error}; again in {wait} s"),
        };
        // what was cut off is no line
        let ended = to.send(Arrival::Bytes(index, b"\n".to_vec(), Instant::now()));
        if ended.is_err() || to.send(Arrival::Event(event)).is_err() {
            return;
        }
        std::thread::sleep(Duration::from_secs(wait));
        wait = (2 * wait).min(longest);
    }
}

fn connect(address: &str) -> std::io::Result<TcpStream> {
    let mut last = std::io::Error::new(ErrorKind::NotFound, "no such host");
    for place in address.to_socket_addrs()? {
        match TcpStream::connect_timeout(&place, Duration::from_secs(10)) {
            Ok(stream) => {
                stream.set_read_timeout(Some(SILENT))?;
                return Ok(stream);
            }
            Err(error) => last = error,
        }
    }
    Err(last)
}

/// Reads to the end of a connection, and says why it ended; `None` where nobody listens any more.
fn read_on(mut stream: TcpStream, index: usize, to: &SyncSender<Arrival>) -> Option<String> {
    let mut chunk = vec![0; CHUNK];
    loop {
        let sent = match stream.read(&mut chunk) {
            Ok(0) => return Some("closed by the server".to_owned()),
            Ok(read) => to.send(Arrival::Bytes(
                index,
                chunk[..read].to_vec(),
                Instant::now(),
            )),
            Err(error) if error.kind() == ErrorKind::Interrupted => Ok(()),
            // the other end may be gone without a word
            Err(error) if is_silence(&error) => {
                return Some(format!("nothing for {} s", SILENT.as_secs()));
            }
            Err(error) => return Some(error.to_string()),
        };
        sent.ok()?;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sources_are_known_by_their_words() {
        let udp = |address: &str| Some(Source::Udp(address.to_owned()));
        let tcp = |address: &str| Some(Source::Tcp(address.to_owned()));
        assert_eq!(Source::parse("udp://10111"), udp("127.0.0.1:10111"));
        assert_eq!(Source::parse("udp://"), udp("127.0.0.1:10110"));
        assert_eq!(Source::parse("udp://0.0.0.0:9"), udp("0.0.0.0:9"));
        assert_eq!(Source::parse("tcp://ais.example"), tcp("ais.example:10110"));
        assert_eq!(Source::parse("tcp://[::1]:9"), tcp("[::1]:9"));
        assert_eq!(Source::parse("-"), Some(Source::Stdin));
        assert_eq!(Source::parse("a.nmea"), Some(Source::File("a.nmea".into())));
        for word in ["", "http://x", "udp://host", "tcp://"] {
            assert_eq!(Source::parse(word), None, "{word}");
        }
    }
}
