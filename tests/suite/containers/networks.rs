//! Networks that fail: a replica that is cut off, a slow and lossy way, connections of which one end knows nothing of the
//! other. Streams end or are continued by their cursor, and every point comes once.
//!
//! Packets are dropped by the rules of the engine's network namespace, which is the tests' own; the time of the way is
//! that of a relay, because kernels often lack `netem`.

use std::{
    io::{self, BufRead as _, BufReader, Read, Write as _},
    net::{Shutdown, SocketAddr, TcpListener, TcpStream},
    process::Command,
    thread,
    time::{Duration, Instant},
};

use strew_testkit::{http1, wait::until};

use super::docker::{self, Container, IMAGE, command, docker};

/// Some 800,000 points, 50 MB.
const LONG: &str = "/v1/points?bbox=0,0,900,900&spacing=1&seed=5&format=csv";
const PROXY: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/deploy/haproxy/haproxy.cfg:/usr/local/etc/haproxy/haproxy.cfg:ro"
);
/// How long a reader waits for the next bytes before it asks elsewhere.
const QUIET: Duration = Duration::from_secs(4);

/// A rule of the packet filter, removed when dropped.
struct Rule(Vec<String>);

impl Rule {
    fn add(rule: &str) -> Self {
        let words: Vec<String> = rule.split(' ').map(str::to_owned).collect();
        iptables("-I", &words);
        Self(words)
    }
}

impl Drop for Rule {
    fn drop(&mut self) {
        iptables("-D", &self.0);
    }
}

fn iptables(what: &str, rule: &[String]) {
    let done = Command::new("iptables")
        .args(["-w", what])
        .args(rule)
        .status()
        .expect("iptables runs");
    assert!(done.success(), "iptables {what} {}", rule.join(" "));
}

/// A reader of the lines of a long answer, which continues at an address when the answer ends early.
#[derive(Default)]
struct Reader {
    lines: Vec<String>,
    /// Of the whole answer.
    cursor: Option<String>,
    count: usize,
    /// The answers that were begun.
    begun: usize,
}

impl Reader {
    /// Reads an answer from where the last one ended. Returns whether all points have come now. `seen` is called after
    /// each line with the number of lines so far and the own address of the connection.
    fn read(
        &mut self,
        from: SocketAddr,
        mut seen: impl FnMut(usize, SocketAddr),
    ) -> io::Result<()> {
        let mut path = LONG.to_owned();
        if let Some(cursor) = &self.cursor {
            path += &format!("&cursor={cursor}&offset={}", self.lines.len());
        }
        self.begun += 1;
        let mut stream = TcpStream::connect_timeout(&from, QUIET)?;
        stream.set_read_timeout(Some(QUIET))?;
        write!(
            stream,
            "GET {path} HTTP/1.1\r\nhost: x\r\nconnection: close\r\n\r\n"
        )?;
        let own = stream.local_addr()?;
        let response = http1::Response::read_head(stream, "GET")?;
        if response.status != 200 {
            return Err(io::Error::other(format!("status {}", response.status)));
        }
        if self.cursor.is_none() {
            self.cursor = Some(response.header("strew-cursor").to_owned());
            self.count = response.header("strew-count").parse().expect("a number");
        }
        let mut body = BufReader::new(response);
        let mut line = String::new();
        // The names of the columns.
        body.read_line(&mut line)?;
        loop {
            line.clear();
            if body.read_line(&mut line)? == 0 {
                return Ok(());
            }
            // A line that breaks off is no point.
            if let Some(point) = line.strip_suffix('\n') {
                self.lines.push(point.to_owned());
                seen(self.lines.len(), own);
            }
        }
    }

    fn is_whole(&self) -> bool {
        self.cursor.is_some() && self.lines.len() == self.count
    }
}

/// All lines of the answer, from one replica without trouble.
fn expected(replica: &Container) -> Vec<String> {
    let answer = replica.get(LONG);
    answer.text().lines().skip(1).map(Into::into).collect()
}

/// Two replicas behind the proxy in a network of their own, which is removed when dropped.
struct Network {
    replicas: Vec<Container>,
    proxy: Option<Container>,
}

impl Network {
    fn start() -> Self {
        docker(&["network", "create", "strew-test"]);
        let member = ["--network", "strew-test"];
        let replica = [&member[..], &["--network-alias", "strew"]].concat();
        let settings = ["STREW_SERVER_STALLED_READER_SECONDS=3"];
        let replicas = (0..2).map(|_| Container::daemon(&replica, &settings));
        let replicas: Vec<Container> = replicas.collect();
        replicas.iter().for_each(Container::until_healthy);
        let proxy = ["-v", PROXY, "haproxy:ci"];
        let proxy = Container::run(&[&member[..], &proxy].concat());
        until("the proxy has found a replica", || {
            let answer = http1::try_open(proxy.address(), "GET", "/readyz", &[], None);
            answer.is_ok_and(|answer| answer.status == 200)
        });
        Self {
            replicas,
            proxy: Some(proxy),
        }
    }

    fn proxy(&self) -> SocketAddr {
        self.proxy.as_ref().expect("running").address()
    }

    /// The replica that streams at the moment.
    fn streaming(&self) -> Option<&Container> {
        self.replicas.iter().find(|replica| {
            let streams = replica.get("/readyz").json()["streams"].as_u64();
            streams > Some(0)
        })
    }
}

impl Drop for Network {
    fn drop(&mut self) {
        self.proxy = None;
        self.replicas.clear();
        command(&["network", "rm", "strew-test"]);
    }
}

#[test]
fn a_replica_cut_off_from_the_proxy_is_left_and_its_stream_continued() {
    if !docker::has(IMAGE) || !docker::has("haproxy:ci") {
        return;
    }
    let network = Network::start();
    let expected = expected(&network.replicas[0]);
    let mut reader = Reader::default();
    let (mut cut, start) = (None, Instant::now());
    while !reader.is_whole() {
        assert!(
            start.elapsed() < Duration::from_secs(300),
            "{} lines",
            reader.lines.len()
        );
        let ended = reader.read(network.proxy(), |lines, _| {
            if lines == 1000 && cut.is_none() {
                let id = &network.streaming().expect("a stream").id;
                docker(&["network", "disconnect", "-f", "strew-test", id]);
                cut = Some(id.clone());
            }
        });
        println!(
            "{} lines of {}: {ended:?}",
            reader.lines.len(),
            reader.count
        );
    }
    assert!(reader.begun > 1, "the stream was not cut");
    assert!(reader.lines == expected, "the points differ");
}

#[test]
fn a_connection_whose_other_end_is_gone_is_given_up_and_its_stream_continued() {
    if !docker::has(IMAGE) {
        return;
    }
    let settings = ["STREW_SERVER_STALLED_READER_SECONDS=3"];
    let replicas = [(); 2].map(|()| Container::daemon(&[], &settings));
    replicas.iter().for_each(Container::until_healthy);
    let expected = expected(&replicas[0]);
    let mut reader = Reader::default();
    let mut rules = vec![];
    let ended = reader.read(replicas[0].address(), |lines, own| {
        if lines == 1000 {
            // Nothing of this connection passes any more, not even its end.
            rules.push(Rule::add(&format!(
                "OUTPUT -p tcp --sport {} -j DROP",
                own.port()
            )));
            rules.push(Rule::add(&format!(
                "INPUT -p tcp --dport {} -j DROP",
                own.port()
            )));
        }
    });
    assert!(ended.is_err() && !reader.is_whole(), "{ended:?}");
    until("the daemon gives the stream up", || {
        replicas[0].get("/readyz").json()["streams"] == 0
    });
    reader
        .read(replicas[1].address(), |_, _| {})
        .expect("a stream");
    assert_eq!(reader.begun, 2);
    assert!(reader.lines == expected, "the points differ");
}

#[test]
fn a_slow_and_lossy_way_changes_no_point() {
    if !docker::has(IMAGE) {
        return;
    }
    let replica = Container::daemon(&[], &[]);
    replica.until_healthy();
    let expected = expected(&replica);
    let address = replica.address();
    // One packet in a hundred, each way.
    let loss = "-m statistic --mode random --probability 0.01 -j DROP";
    let _rules = [
        Rule::add(&format!("OUTPUT -d {} {loss}", address.ip())),
        Rule::add(&format!("INPUT -s {} {loss}", address.ip())),
    ];
    let far = relay(address, Duration::from_millis(100));
    let start = Instant::now();
    let mut reader = Reader::default();
    while !reader.is_whole() {
        assert!(
            start.elapsed() < Duration::from_secs(300),
            "{} lines",
            reader.lines.len()
        );
        let ended = reader.read(far, |_, _| {});
        println!(
            "200 ms and 1 % loss: {} lines of {} after {:?}: {ended:?}",
            reader.lines.len(),
            reader.count,
            start.elapsed()
        );
    }
    assert!(reader.lines == expected, "the points differ");
}

/// The address of a relay that passes everything on after a time, both ways.
fn relay(to: SocketAddr, delay: Duration) -> SocketAddr {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    let address = listener.local_addr().expect("bound");
    thread::spawn(move || {
        for near in listener.incoming() {
            let near = near.expect("a client");
            let Ok(far) = TcpStream::connect(to) else {
                continue;
            };
            let both = || Some((near.try_clone().ok()?, far.try_clone().ok()?));
            let (near_too, far_too) = both().expect("open");
            thread::spawn(move || pass(near, far, delay));
            thread::spawn(move || pass(far_too, near_too, delay));
        }
    });
    address
}

/// Passes bytes on, each `delay` after it came.
fn pass(mut from: TcpStream, mut to: TcpStream, delay: Duration) {
    let (sender, late) = std::sync::mpsc::sync_channel::<(Instant, Vec<u8>)>(1000);
    thread::spawn(move || {
        for (came, bytes) in late {
            while let Some(early) = delay.checked_sub(came.elapsed()) {
                thread::park_timeout(early);
            }
            if to.write_all(&bytes).is_err() {
                break;
            }
        }
        let _ = to.shutdown(Shutdown::Write);
    });
    let mut buffer = vec![0; 1 << 14];
    while let Ok(read @ 1..) = from.read(&mut buffer) {
        if sender
            .send((Instant::now(), buffer[..read].to_vec()))
            .is_err()
        {
            return;
        }
    }
}
