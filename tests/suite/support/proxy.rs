//! Real proxies and web servers with settings of their own: HAProxy, nginx.

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
