//! Questions whose answers are compared with the library's, byte by byte.

use std::{net::SocketAddr, time::Duration};

use serde_json::{Value, json};
use strew::{
    error_map,
    service::{Answer, Encoding, Error, Output, Planned},
};

use crate::{
    any::Dice,
    http::{self, Opened},
    replica::strew,
    tally::{Done, Trouble},
    world::World,
};

/// The library's own answer.
pub fn answer(world: &World, planned: &Planned, encoding: Encoding) -> Result<Answer, Error> {
    let mut output = Output::new(encoding);
    output.relative_to = planned.query.region.corner;
    Answer::new(planned, &output, world.limits.block_bytes)
}

/// All of it.
pub fn whole(world: &World, planned: &Planned, encoding: Encoding) -> Result<Vec<u8>, Error> {
    let mut bytes = vec![];
    for block in answer(world, planned, encoding)? {
        bytes.extend_from_slice(&block.expect("encoded"));
    }
    Ok(bytes)
}

fn wrong(what: impl Into<String>) -> Trouble {
    Trouble::Wrong(what.into())
}

/// Asks with a query as a body.
fn post(
    at: SocketAddr,
    path: &str,
    headers: &[(&str, &str)],
    body: &Value,
) -> Result<Opened, Trouble> {
    answered(http::ask(
        at,
        path,
        headers,
        Some(body.to_string().as_bytes()),
    )?)
}

/// An answer that is one; a server without room has none.
fn answered(opened: Opened) -> Result<Opened, Trouble> {
    match opened.status {
        503 => Err(Trouble::Busy),
        _ => Ok(opened),
    }
}

/// Compares an answer with what the library says to the same query.
fn compare(world: &World, opened: Opened, body: &Value, encoding: Encoding) -> Done {
    let planned = world.planned(body);
    let expected = planned.and_then(|planned| {
        let bytes = whole(world, &planned, encoding)?;
        Ok((planned, bytes))
    });
    let status = opened.status;
    let id = opened.header("x-request-id").unwrap_or("none").to_owned();
    let bytes = opened.whole()?;
    match expected {
        Ok((planned, expected)) if status == 200 && bytes == expected => Ok(planned.count() as u64),
        Ok((_, expected)) => {
            let at = bytes.iter().zip(&expected).position(|(a, b)| a != b);
            Err(wrong(format!(
                "request {id}: status {status}, {} bytes instead of {}, the first other one is {at:?}: {body}",
                bytes.len(),
                expected.len()
            )))
        }
        Err(error) if error_map::http(error.kind()).status.as_u16() == status => Ok(0),
        Err(error) => Err(wrong(format!(
            "request {id}: status {status} where the library says `{error}`: {body}"
        ))),
    }
}

fn with(body: &Value, members: &[(&str, Value)]) -> Value {
    let mut body = body.clone();
    for (name, value) in members {
        body[*name] = value.clone();
    }
    body
}

/// A query in any format, compressed or not.
pub fn query(world: &World, at: SocketAddr, dice: &mut Dice, body: &Value) -> Done {
    let encodings = Encoding::ALL;
    let encoding = encodings[dice.below(encodings.len() as u64) as usize];
    let coding = ["identity", "gzip", "zstd"][dice.below(3) as usize];
    let asked = with(body, &[("format", json!(encoding.name()))]);
    let opened = post(
        at,
        "/v1/points:query",
        &[("accept-encoding", coding)],
        &asked,
    )?;
    compare(world, opened, body, encoding)
}

/// The exact count.
pub fn count(world: &World, at: SocketAddr, body: &Value) -> Done {
    let opened = post(at, "/v1/count", &[], body)?;
    let status = opened.status;
    let told: Value = serde_json::from_slice(&opened.whole()?).unwrap_or_default();
    match world.planned(body) {
        Ok(planned) if told["count"].as_u64().map(u128::from) == Some(planned.count()) => Ok(0),
        Err(error) if error_map::http(error.kind()).status.as_u16() == status => Ok(0),
        expected => Err(wrong(format!(
            "count: status {status}, {told} instead of {:?}: {body}",
            expected.map(|planned| planned.count())
        ))),
    }
}

/// Page by page, each from the cursor that the one before gave.
pub fn pages(world: &World, at: SocketAddr, dice: &mut Dice, body: &Value) -> Done {
    let Ok(planned) = world.planned(body) else {
        return count(world, at, body);
    };
    let expected = whole(world, &planned, Encoding::Csv).expect("csv holds all");
    let page = 1 + planned.count() as u64 / (1 + dice.below(4));
    let mut read: Vec<u8> = vec![];
    let mut asked = with(body, &[("format", json!("csv")), ("limit", json!(page))]);
    loop {
        let opened = post(at, "/v1/points:query", &[], &asked)?;
        let (status, next) = (
            opened.status,
            opened.header("strew-next").map(str::to_owned),
        );
        let bytes = opened.whole()?;
        if status != 200 {
            let text = String::from_utf8_lossy(&bytes);
            return Err(wrong(format!("page: status {status}, {text}: {asked}")));
        }
        let from = match read.is_empty() {
            true => 0,
            // Each page has the line of names.
            false => bytes
                .iter()
                .position(|&b| b == b'\n')
                .map_or(0, |at| at + 1),
        };
        read.extend_from_slice(&bytes[from..]);
        match next {
            Some(next) => asked["cursor"] = json!(next),
            None => break,
        }
    }
    match read == expected {
        true => Ok(planned.count() as u64),
        false => Err(wrong(format!("pages of {page} are not the whole: {body}"))),
    }
}

/// In parts, as parallel readers do.
pub fn parts(world: &World, at: SocketAddr, dice: &mut Dice, body: &Value) -> Done {
    let Ok(planned) = world.planned(body) else {
        return count(world, at, body);
    };
    let expected = whole(world, &planned, Encoding::Ndjson).expect("ndjson holds all");
    let lines = |bytes: &[u8]| -> Vec<String> {
        let text = String::from_utf8_lossy(bytes).into_owned();
        let points = text
            .lines()
            .filter(|line| !line.starts_with("{\"summary\""));
        points.map(Into::into).collect()
    };
    let path = format!("/v1/points:split?parts={}", 1 + dice.below(5));
    let opened = post(at, &path, &[], &with(body, &[("format", json!("ndjson"))]))?;
    let told: Value = serde_json::from_slice(&opened.whole()?).unwrap_or_default();
    let mut read = vec![];
    for part in told["parts"].as_array().into_iter().flatten() {
        let opened = post(at, "/v1/points:query", &[], &part["query"])?;
        read.extend(lines(&opened.whole()?));
    }
    match read == lines(&expected) {
        true => Ok(planned.count() as u64),
        false => Err(wrong(format!(
            "the parts are not the whole: {told}: {body}"
        ))),
    }
}

/// A long stream of packed points, sometimes read haltingly; never held as a whole.
pub fn long(world: &World, at: SocketAddr, dice: &mut Dice) -> Done {
    let side = 300 + dice.below(1700);
    let seed = dice.below(1000);
    let (encoding, warp) = match dice.below(3) {
        0 => (Encoding::F64, "off"),
        1 => (Encoding::F32, "on"),
        _ => (Encoding::F32, "off"),
    };
    let body = json!({
        "region": { "bbox": [0, 0, side, side] }, "spacing": 1, "seed": seed, "warp": warp,
    });
    let planned = world.planned(&body).expect("in order");
    let name = encoding.name();
    let path = format!(
        "/v1/points?bbox=0,0,{side},{side}&spacing=1&seed={seed}&warp={warp}&format={name}"
    );
    let is_slow = dice.once_in(4);
    let mut opened = answered(http::ask(at, &path, &[], None)?)?;
    let mut part = vec![0; 1 << 17];
    let mut offset = 0;
    for block in answer(world, &planned, encoding).expect("fits") {
        let block = block.expect("encoded");
        let mut rest = &block[..];
        while !rest.is_empty() {
            let room = rest.len().min(part.len());
            let read = opened.more(&mut part[..room])?;
            if read == 0 || part[..read] != rest[..read] {
                return Err(wrong(format!("{path}: other bytes after {offset}")));
            }
            rest = &rest[read..];
            offset += read;
            if is_slow && dice.once_in(16) {
                std::thread::park_timeout(Duration::from_millis(20));
            }
        }
    }
    match opened.more(&mut part)? {
        0 => Ok(planned.count() as u64),
        _ => Err(wrong(format!("{path}: more than {offset} bytes"))),
    }
}

/// The program without a server.
pub fn command(world: &World, dice: &mut Dice, body: &Value) -> Done {
    let encoding = [Encoding::Csv, Encoding::F64, Encoding::Json][dice.below(3) as usize];
    let file = tempfile::NamedTempFile::new()?;
    std::fs::write(file.path(), body.to_string())?;
    let output = strew()
        .args([
            "sample",
            "-q",
            "--format",
            encoding.name(),
            "-o",
            "-",
            "--query",
        ])
        .arg(file.path())
        .output()?;
    let expected = world.planned(body).and_then(|planned| {
        let bytes = whole(world, &planned, encoding)?;
        Ok((planned.count() as u64, bytes))
    });
    match (output.status.success(), expected) {
        (true, Ok((count, bytes))) if output.stdout == bytes => Ok(count),
        (false, Err(_)) => Ok(0),
        (success, expected) => Err(wrong(format!(
            "strew sample: success {success}, {} bytes, {:?}, {}: {body}",
            output.stdout.len(),
            expected.map(|(count, bytes)| (count, bytes.len())),
            String::from_utf8_lossy(&output.stderr)
        ))),
    }
}

/// A query with a few characters changed: mostly wrong, never a fault of the server's.
pub fn spoiled(world: &World, at: SocketAddr, dice: &mut Dice, body: &Value) -> Done {
    let mut text = body.to_string().into_bytes();
    for _ in 0..=dice.below(3) {
        if text.is_empty() {
            break;
        }
        let place = dice.below(text.len() as u64) as usize;
        match dice.below(3) {
            0 => text[place] = b" \"{}[]:,-+.eE09atx\\\xff\0"[dice.below(20) as usize],
            1 => drop(text.remove(place)),
            _ => text.truncate(place.max(1)),
        }
    }
    let opened = answered(http::ask(at, "/v1/count", &[], Some(&text))?)?;
    let status = opened.status;
    let told = opened.whole()?;
    let shown = || String::from_utf8_lossy(&text).into_owned();
    let expected = strew::service::query::read_body(&text).and_then(|body| {
        body.draft
            .check(&world.catalog, world.limits.max_vertices, body.faults)
    });
    match expected {
        // What it has become may take long to count: that it is taken is enough.
        Ok(_) if status == 200 || status == 400 || status == 413 => Ok(0),
        Err(error) if error_map::http(error.kind()).status.as_u16() == status => Ok(0),
        expected => Err(wrong(format!(
            "status {status}, {}, where the library says {:?}: {}",
            String::from_utf8_lossy(&told),
            expected.map(|_| "it is in order"),
            shown()
        ))),
    }
}
