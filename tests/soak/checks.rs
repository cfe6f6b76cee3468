//! Requests over REST and commands, whose answers are compared with the library's, byte by byte.

use std::{
    io::{self, Read as _},
    net::SocketAddr,
    time::Duration,
};

use serde_json::{Value, json};
use strew_encode::{Answer, Encoding, Output};
use strew_error::Error;
use strew_plan::Planned;
use strew_query::{groups, read_body};
use strew_testkit::{
    http1::{self, Response},
    random::SplitMix,
};

use crate::{
    library::{Library, with},
    replica::strew,
    tally::{Done, Trouble},
};

/// The library's own answer, in blocks.
pub fn answer(library: &Library, planned: &Planned, encoding: Encoding) -> Result<Answer, Error> {
    let mut output = Output::new(encoding);
    output.relative_to = planned.query.region.corner;
    planned.answer(&output, library.limits.block_bytes)
}

/// The library's own answer.
pub fn whole(library: &Library, planned: &Planned, encoding: Encoding) -> Result<Vec<u8>, Error> {
    let mut bytes = vec![];
    for block in answer(library, planned, encoding)? {
        bytes.extend_from_slice(&block.expect("encoded"));
    }
    Ok(bytes)
}

fn wrong(what: impl Into<String>) -> Trouble {
    Trouble::Wrong(what.into())
}

/// Sends a query as a body.
fn post(
    at: SocketAddr,
    path: &str,
    headers: &[(&str, &str)],
    body: &Value,
) -> Result<Response, Trouble> {
    let body = body.to_string();
    answered(http1::try_open(
        at,
        "POST",
        path,
        headers,
        Some(body.as_bytes()),
    )?)
}

/// The response, unless the server had no room for the request.
fn answered(opened: Response) -> Result<Response, Trouble> {
    match opened.status {
        503 => Err(Trouble::Busy),
        _ => Ok(opened),
    }
}

/// The whole body, decompressed.
fn decoded(opened: Response) -> io::Result<Vec<u8>> {
    let coding = opened.header("content-encoding").to_owned();
    let body = opened.body()?;
    match &*coding {
        "zstd" => zstd::decode_all(&*body),
        "gzip" => {
            let mut plain = vec![];
            flate2::read::MultiGzDecoder::new(&*body).read_to_end(&mut plain)?;
            Ok(plain)
        }
        _ => Ok(body),
    }
}

/// Compares a response with the library's answer to the same query.
fn compare(library: &Library, opened: Response, body: &Value, encoding: Encoding) -> Done {
    let planned = library.planned(body);
    let expected = planned.and_then(|planned| {
        let bytes = whole(library, &planned, encoding)?;
        Ok((planned, bytes))
    });
    let status = opened.status;
    let id = opened.header("x-request-id").to_owned();
    let bytes = decoded(opened)?;
    match expected {
        Ok((planned, expected)) if status == 200 && bytes == expected => Ok(planned.count() as u64),
        Ok((_, expected)) => {
            let at = bytes.iter().zip(&expected).position(|(a, b)| a != b);
            Err(wrong(format!(
                "request {id}: status {status}, {} bytes instead of {}, the first difference is at {at:?}: {body}",
                bytes.len(),
                expected.len()
            )))
        }
        Err(error) if error.kind().wire().status == status => Ok(0),
        Err(error) => Err(wrong(format!(
            "request {id}: status {status} where the library says `{error}`: {body}"
        ))),
    }
}

/// A query in any format, compressed or not.
pub fn query(library: &Library, at: SocketAddr, random: &mut SplitMix, body: &Value) -> Done {
    let encodings = Encoding::ALL;
    let encoding = encodings[random.index(encodings.len())];
    let coding = ["identity", "gzip", "zstd"][random.index(3)];
    let asked = with(body, &[("format", json!(encoding.name()))]);
    let opened = post(
        at,
        "/v1/points:query",
        &[("accept-encoding", coding)],
        &asked,
    )?;
    compare(library, opened, body, encoding)
}

/// The exact count.
pub fn count(library: &Library, at: SocketAddr, body: &Value) -> Done {
    let opened = post(at, "/v1/count", &[], body)?;
    let status = opened.status;
    let answer: Value = serde_json::from_slice(&decoded(opened)?).unwrap_or_default();
    match library.planned(body) {
        Ok(planned) if answer["count"].as_u64().map(u128::from) == Some(planned.count()) => Ok(0),
        Err(error) if error.kind().wire().status == status => Ok(0),
        expected => Err(wrong(format!(
            "count: status {status}, {answer} instead of {:?}: {body}",
            expected.map(|planned| planned.count())
        ))),
    }
}

/// Page by page, each from the cursor of the one before.
pub fn pages(library: &Library, at: SocketAddr, random: &mut SplitMix, body: &Value) -> Done {
    let Ok(planned) = library.planned(body) else {
        return count(library, at, body);
    };
    let expected = whole(library, &planned, Encoding::Csv).expect("csv holds all");
    let page = 1 + planned.count() as u64 / (1 + random.below(4));
    let mut read: Vec<u8> = vec![];
    let mut asked = with(body, &[("format", json!("csv")), ("limit", json!(page))]);
    loop {
        let opened = post(at, "/v1/points:query", &[], &asked)?;
        let (status, next) = (opened.status, opened.header("strew-next").to_owned());
        let bytes = decoded(opened)?;
        if status != 200 {
            let text = String::from_utf8_lossy(&bytes);
            return Err(wrong(format!("page: status {status}, {text}: {asked}")));
        }
        let from = match read.is_empty() {
            true => 0,
            // Each page repeats the column names.
            false => bytes
                .iter()
                .position(|&b| b == b'\n')
                .map_or(0, |at| at + 1),
        };
        read.extend_from_slice(&bytes[from..]);
        if next.is_empty() {
            break;
        }
        asked["cursor"] = json!(next);
    }
    match read == expected {
        true => Ok(planned.count() as u64),
        false => Err(wrong(format!("pages of {page} are not the whole: {body}"))),
    }
}

/// The parts of a split, as parallel readers take them.
pub fn parts(library: &Library, at: SocketAddr, random: &mut SplitMix, body: &Value) -> Done {
    let Ok(planned) = library.planned(body) else {
        return count(library, at, body);
    };
    let expected = whole(library, &planned, Encoding::Ndjson).expect("ndjson holds all");
    let lines = |bytes: &[u8]| -> Vec<String> {
        let text = String::from_utf8_lossy(bytes).into_owned();
        let points = text
            .lines()
            .filter(|line| !line.starts_with("{\"summary\""));
        points.map(Into::into).collect()
    };
    let path = format!("/v1/points:split?parts={}", 1 + random.below(5));
    let opened = post(at, &path, &[], &with(body, &[("format", json!("ndjson"))]))?;
    let answer: Value = serde_json::from_slice(&decoded(opened)?).unwrap_or_default();
    let mut read = vec![];
    for part in answer["parts"].as_array().into_iter().flatten() {
        let opened = post(at, "/v1/points:query", &[], &part["query"])?;
        read.extend(lines(&decoded(opened)?));
    }
    match read == lines(&expected) {
        true => Ok(planned.count() as u64),
        false => Err(wrong(format!(
            "the parts are not the whole: {answer}: {body}"
        ))),
    }
}

/// A long stream of packed points, compared as it arrives; sometimes read slowly.
pub fn long(library: &Library, at: SocketAddr, random: &mut SplitMix) -> Done {
    let side = 300 + random.below(1700);
    let seed = random.below(1000);
    let (encoding, warp) = match random.below(3) {
        0 => (Encoding::F64, "off"),
        1 => (Encoding::F32, "on"),
        _ => (Encoding::F32, "off"),
    };
    let body = json!({
        "region": { "bbox": [0, 0, side, side] }, "spacing": 1, "seed": seed, "warp": warp,
    });
    let planned = library.planned(&body).expect("valid");
    let name = encoding.name();
    let path = format!(
        "/v1/points?bbox=0,0,{side},{side}&spacing=1&seed={seed}&warp={warp}&format={name}"
    );
    let is_slow = random.once_in(4);
    let mut opened = answered(http1::try_open(at, "GET", &path, &[], None)?)?;
    let mut part = vec![0; 1 << 17];
    let mut offset = 0;
    for block in answer(library, &planned, encoding).expect("fits") {
        let block = block.expect("encoded");
        let mut rest = &block[..];
        while !rest.is_empty() {
            let room = rest.len().min(part.len());
            let read = opened.read(&mut part[..room])?;
            if read == 0 || part[..read] != rest[..read] {
                return Err(wrong(format!("{path}: other bytes after {offset}")));
            }
            rest = &rest[read..];
            offset += read;
            if is_slow && random.once_in(16) {
                std::thread::park_timeout(Duration::from_millis(20));
            }
        }
    }
    match opened.read(&mut part)? {
        0 => Ok(planned.count() as u64),
        _ => Err(wrong(format!("{path}: more than {offset} bytes"))),
    }
}

/// `strew sample`, which needs no server.
pub fn command(library: &Library, random: &mut SplitMix, body: &Value) -> Done {
    let encoding = [Encoding::Csv, Encoding::F64, Encoding::Json][random.index(3)];
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
    let expected = library.planned(body).and_then(|planned| {
        let bytes = whole(library, &planned, encoding)?;
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

/// A query with a few characters changed. Most are invalid; none may be a server error.
pub fn spoiled(library: &Library, at: SocketAddr, random: &mut SplitMix, body: &Value) -> Done {
    let mut text = body.to_string().into_bytes();
    for _ in 0..=random.below(3) {
        if text.is_empty() {
            break;
        }
        let place = random.index(text.len());
        match random.below(3) {
            0 => text[place] = b" \"{}[]:,-+.eE09atx\\\xff\0"[random.index(20)],
            1 => drop(text.remove(place)),
            _ => text.truncate(place.max(1)),
        }
    }
    let opened = answered(http1::try_open(at, "POST", "/v1/count", &[], Some(&text))?)?;
    let status = opened.status;
    let answer = decoded(opened)?;
    let shown = || String::from_utf8_lossy(&text).into_owned();
    let expected = read_body(&text, groups::QUERY)
        .map_err(Error::from)
        .and_then(|draft| {
            draft.check(&library.catalog.clone().into(), library.limits.max_vertices)
        });
    match expected {
        // A changed query may be too much to count here: that the server takes it is enough.
        Ok(_) if status == 200 || status == 400 || status == 413 => Ok(0),
        Err(error) if error.kind().wire().status == status => Ok(0),
        expected => Err(wrong(format!(
            "status {status}, {}, where the library says {:?}: {}",
            String::from_utf8_lossy(&answer),
            expected.map(|_| "a valid query"),
            shown()
        ))),
    }
}
