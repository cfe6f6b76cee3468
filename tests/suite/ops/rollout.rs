//! A rollout, replica by replica, behind a real proxy: keys, certificates and named fields are replaced while clients
//! read. No request fails, and what is pinned to a digest is answered by no replica that has another world.

use std::{
    fs,
    net::SocketAddr,
    sync::{
        Arc,
        atomic::{AtomicBool, AtomicUsize, Ordering},
    },
};

use rustls::ClientConfig;
use strew_testkit::{
    certificates::Authority,
    http1::{self, Answer},
    wait::until,
};
use tempfile::TempDir;

use crate::support::{
    clients,
    daemon::Daemon,
    keys::entry,
    proxy::Proxy,
    tls::{client, connect, get_with},
};

const WORLD: &str = "spacing = 2\nseed = 3\nprofile = \"test\"\nfield = \"grove\"\n";
const CHUNK: &str = "/v1/worlds/wood/chunks/32/0/-1?format=csv";

/// A replica with files of its own, read again on a signal.
struct Replica {
    daemon: Daemon,
    files: TempDir,
}

impl Replica {
    fn start(keys: &str, authority: &Authority, share: f64) -> Self {
        let files = tempfile::tempdir().expect("a folder");
        for folder in ["fields", "worlds"] {
            fs::create_dir(files.path().join(folder)).expect("writable");
        }
        fs::write(files.path().join("worlds/wood.toml"), WORLD).expect("writable");
        write_keys(&files, keys);
        write_field(&files, share);
        authority.issue_server().write_server(files.path());
        let setting =
            |name: &str, file: &str| format!("{name}={}", files.path().join(file).display());
        let settings = [
            setting("access.keys_file", "keys.toml"),
            setting("fields.folder", "fields"),
            setting("worlds.folder", "worlds"),
            "reload.watch_seconds=0".to_owned(),
        ];
        let daemon = Daemon::with_tls(files.path(), &settings.each_ref().map(String::as_str));
        Self { daemon, files }
    }

    /// The status line of an answer without the proxy.
    fn status(&self, config: &Arc<ClientConfig>, path: &str, key: &str) -> String {
        let mut connected = connect(&self.daemon, config);
        let answer = get_with(&mut connected, path, &format!("x-api-key: {key}\r\n"));
        let answer = answer.expect("an answer");
        answer.lines().next().unwrap_or_default().to_owned()
    }
}

fn write_keys(files: &TempDir, keys: &str) {
    fs::write(files.path().join("keys.toml"), keys).expect("writable");
}

fn write_field(files: &TempDir, share: f64) {
    let field = format!("radial = {{ center = [0, 0], radii = [8, 40], shares = [1, {share}] }}\n");
    fs::write(files.path().join("fields/grove.toml"), field).expect("writable");
}

/// A client that repeats a request and looks at each answer.
struct Reader<'a> {
    key: &'a str,
    path: &'a str,
    check: &'a (dyn Fn(&Answer) + Sync),
}

/// Ends the readers, also when a test fails.
struct Over<'a>(&'a AtomicBool);

impl Drop for Over<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// Rolls something out while clients read. `roll` calls its argument to wait until all clients have more answers, from
/// each of three replicas at least one.
fn while_read(proxy: SocketAddr, readers: &[Reader<'_>], roll: impl FnOnce(&dyn Fn())) {
    const MORE: usize = 6;
    let is_over = &AtomicBool::new(false);
    let answered: Vec<AtomicUsize> = readers.iter().map(|_| AtomicUsize::new(0)).collect();
    std::thread::scope(|scope| {
        let _over = Over(is_over);
        let read = |(reader, answered): (&'_ Reader<'_>, &AtomicUsize)| {
            while !is_over.load(Ordering::Relaxed) {
                let headers = [("x-api-key", reader.key)];
                (reader.check)(&http1::get(proxy, reader.path, &headers));
                answered.fetch_add(1, Ordering::Relaxed);
            }
        };
        let pairs = readers.iter().zip(&answered);
        let threads: Vec<_> = pairs.map(|pair| scope.spawn(move || read(pair))).collect();
        let count = |counter: &AtomicUsize| counter.load(Ordering::Relaxed);
        roll(&|| {
            for (thread, counter) in threads.iter().zip(&answered) {
                let before = count(counter);
                until("clients have more answers", || {
                    assert!(!thread.is_finished(), "a client failed");
                    count(counter) >= before + MORE
                });
            }
        });
    });
}

fn expect_served(answer: &Answer) {
    assert_eq!(answer.status, 200, "{}", answer.text());
}

fn keys_certificates_and_fields_are_rolled_out(program: &str) {
    let (before, after) = (Authority::new(), Authority::new());
    let [old, new] = ["old", "new"].map(|name| entry(name, name, ""));
    let replicas: Vec<Replica> = (0..3).map(|_| Replica::start(&old, &before, 0.2)).collect();
    let trusted = tempfile::tempdir().expect("a folder");
    let trusted = trusted.path().join("authorities.pem");
    fs::write(&trusted, before.pem() + &after.pem()).expect("writable");
    let addresses: Vec<SocketAddr> = replicas.iter().map(|r| r.daemon.address()).collect();
    let balancer = Proxy::balancer(program, &addresses, Some(&trusted));
    let proxy = balancer.address;
    until("the proxy has found a replica", || {
        http1::open(proxy, "GET", "/readyz", &[]).status == 200
    });
    let get = |path: &str, key: &str| http1::get(proxy, path, &[("x-api-key", key)]);
    let first = get(CHUNK, "old");
    expect_served(&first);
    let pin = |answer: &Answer| format!("{CHUNK}&world_digest={}", answer.header("strew-world"));
    let pinned = pin(&first);

    // Keys and certificates: a client with the old key reads on, and its pinned answers stay the same.
    let same = |answer: &Answer| {
        expect_served(answer);
        assert!(answer.body == first.body);
    };
    let readers = [Reader {
        key: "old",
        path: &pinned,
        check: &same,
    }];
    let trust = client(&after, None, &[b"http/1.1"]);
    while_read(proxy, &readers, |read_on| {
        for replica in &replicas {
            write_keys(&replica.files, &[&old[..], &new].concat());
            after.issue_server().write_server(replica.files.path());
            replica.daemon.signal("HUP");
            until("the new authority vouches for the replica", || {
                get_with(&mut connect(&replica.daemon, &trust), "/livez", "").ok()
            });
            for key in ["old", "new"] {
                assert_eq!(replica.status(&trust, CHUNK, key), "HTTP/1.1 200 OK");
            }
            read_on();
        }
    });

    // A field: clients that pin the world get what they pinned or a refusal, others either world. Both keys are in use.
    let is_conflict = |answer: &Answer| {
        answer.status == 409 && answer.json()["type"] == "urn:strew:problem:other-world"
    };
    let refused = AtomicUsize::new(0);
    let same_or_conflict = |answer: &Answer| {
        if is_conflict(answer) {
            refused.fetch_add(1, Ordering::Relaxed);
        } else {
            same(answer);
        }
    };
    let readers = [
        Reader {
            key: "old",
            path: CHUNK,
            check: &expect_served,
        },
        Reader {
            key: "new",
            path: &pinned,
            check: &same_or_conflict,
        },
    ];
    while_read(proxy, &readers, |read_on| {
        for (i, replica) in replicas.iter().enumerate() {
            write_field(&replica.files, 0.9);
            replica.daemon.signal("HUP");
            until("the replica has the new field", || {
                replica.status(&trust, &pinned, "new").contains("409")
            });
            let before = refused.load(Ordering::Relaxed);
            read_on();
            assert!(
                refused.load(Ordering::Relaxed) > before,
                "no answer of replica {i}"
            );
        }
    });
    assert!(is_conflict(&get(&pinned, "new")));
    let second = get(CHUNK, "new");
    expect_served(&second);
    assert!(second.body != first.body);
    expect_served(&get(&pin(&second), "new"));

    // The old key goes, replica by replica, once all clients have the new one.
    let readers = [Reader {
        key: "new",
        path: CHUNK,
        check: &expect_served,
    }];
    while_read(proxy, &readers, |read_on| {
        for replica in &replicas {
            write_keys(&replica.files, &new);
            replica.daemon.signal("HUP");
            until("the old key is refused", || {
                replica.status(&trust, CHUNK, "old").contains("401")
            });
            read_on();
        }
    });
    assert_eq!(get(CHUNK, "old").status, 401);
}

#[test]
fn behind_haproxy_keys_certificates_and_fields_are_rolled_out() {
    if clients::find("haproxy").is_some() {
        keys_certificates_and_fields_are_rolled_out("haproxy");
    }
}

#[test]
fn behind_nginx_keys_certificates_and_fields_are_rolled_out() {
    if clients::find("nginx").is_some() {
        keys_certificates_and_fields_are_rolled_out("nginx");
    }
}
