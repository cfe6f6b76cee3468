//! Real proxies, caches and web servers with settings of their own: HAProxy, nginx, Varnish.

use std::{
    fs,
    net::{SocketAddr, TcpListener, TcpStream},
    path::Path,
    process::{Child, Command, Stdio},
};

use strew_testkit::wait::until;

/// A running proxy; killed when dropped.
pub struct Proxy {
    child: Child,
    pub address: SocketAddr,
    _folder: tempfile::TempDir,
}

impl Drop for Proxy {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Proxy {
    /// Starts a program, which must be installed, with the settings for an address and a folder.
    pub fn start(program: &str, settings: impl FnOnce(SocketAddr, &Path) -> String) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let free = TcpListener::bind("127.0.0.1:0").expect("a port");
        let address = free.local_addr().expect("bound");
        drop(free);
        let file = folder.path().join("proxy.conf");
        fs::write(&file, settings(address, folder.path())).expect("writable");
        let mut command = Command::new(program);
        match program {
            "haproxy" => command.args(["-db", "-q", "-f"]).arg(&file),
            "varnishd" => command
                .args(["-F", "-j", "none", "-n"])
                .arg(folder.path())
                .arg("-a")
                .arg(address.to_string())
                .arg("-f")
                .arg(&file)
                .args(["-s", "malloc,64m", "-s", "Transient=malloc,16m"])
                .args(varnish_parameters()),
            _ => command.arg("-p").arg(folder.path()).arg("-c").arg(&file),
        };
        let child = command
            .stdout(Stdio::null())
            .spawn()
            .expect("the proxy runs");
        until("the proxy listens", || TcpStream::connect(address).ok());
        Self {
            child,
            address,
            _folder: folder,
        }
    }
}

impl Proxy {
    /// Starts HAProxy or nginx over replicas. With a file of trusted authorities it speaks TLS to them, verifies their
    /// certificates for `localhost`, and shakes hands in full for each request.
    pub fn balancer(program: &str, replicas: &[SocketAddr], trusted: Option<&Path>) -> Self {
        Self::start(program, |address, folder| match program {
            "haproxy" => haproxy(address, replicas, trusted),
            _ => nginx_balancer(address, replicas, trusted, folder),
        })
    }
}

fn haproxy(address: SocketAddr, replicas: &[SocketAddr], trusted: Option<&Path>) -> String {
    // A check that is late on a busy machine takes no replica away that is well.
    let checked = || " check inter 100ms fall 3 rise 1".to_owned();
    let options = trusted.map_or_else(checked, |file| {
        let file = file.display();
        format!(" ssl verify required ca-file {file} verifyhost localhost no-ssl-reuse")
    });
    let servers: String = replicas
        .iter()
        .enumerate()
        .map(|(i, replica)| format!("    server r{i} {replica}{options}\n"))
        .collect();
    format!(
        "global\n    maxconn 100\ndefaults\n    mode http\n    timeout connect 5s\n    \
         timeout client 20s\n    timeout server 20s\n    timeout check 3s\n    retries 3\n    option redispatch 1\n    \
         http-reuse never\n    retry-on conn-failure empty-response 503\nfrontend in\n    bind {address}\n    \
         default_backend strew\nbackend strew\n    balance roundrobin\n    \
         option httpchk GET /readyz\n{servers}"
    )
}

fn nginx_balancer(
    address: SocketAddr,
    replicas: &[SocketAddr],
    trusted: Option<&Path>,
    folder: &Path,
) -> String {
    let servers: String = replicas
        .iter()
        .map(|replica| format!("server {replica} max_fails=1 fail_timeout=1s; "))
        .collect();
    let (scheme, tls) = trusted.map_or(("http", String::new()), |file| {
        let file = file.display();
        let tls = format!(
            "proxy_ssl_verify on; proxy_ssl_trusted_certificate {file}; proxy_ssl_name localhost;\n\
             proxy_ssl_session_reuse off; "
        );
        ("https", tls)
    });
    let http = format!(
        "upstream strew {{ {servers} }}\n\
         server {{ listen {address}; location / {{ proxy_pass {scheme}://strew; proxy_http_version 1.1;\n\
         {tls}proxy_next_upstream error timeout http_503 non_idempotent; proxy_buffering off; }} }}"
    );
    nginx(folder, &http)
}

/// The parameters (`-p name=value`) of the command that the comment of `deploy/varnish/strew.vcl` has.
fn varnish_parameters() -> Vec<&'static str> {
    let words: Vec<&str> = include_str!("../../../deploy/varnish/strew.vcl")
        .lines()
        .take_while(|line| line.starts_with('#'))
        .flat_map(str::split_whitespace)
        .collect();
    let pairs = words.windows(2).filter(|pair| pair[0] == "-p");
    pairs.flatten().copied().collect()
}

/// Settings of nginx around those of `http`, with all that it writes in a folder.
pub fn nginx(folder: &Path, http: &str) -> String {
    let folder = folder.display();
    format!(
        "daemon off; master_process off; pid {folder}/pid; error_log {folder}/error.log;\n\
         events {{ worker_connections 100; }}\n\
         http {{ access_log off; client_body_temp_path {folder}/b; proxy_temp_path {folder}/p;\n\
         fastcgi_temp_path {folder}/f; uwsgi_temp_path {folder}/u; scgi_temp_path {folder}/s;\n\
         {http} }}\n"
    )
}
