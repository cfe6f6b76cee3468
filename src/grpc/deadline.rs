//! Deadlines: a call that says by when it must be over (`grpc-timeout`) is over then, visibly, with
//! DEADLINE_EXCEEDED, and its stream's place is free.

use std::time::Duration;

use http::{HeaderMap, HeaderName, Response};
use tokio::time::Instant;
use tonic::Status;

use super::status;

const HEADER: HeaderName = HeaderName::from_static("grpc-timeout");

/// The form of a timeout.
const ALLOWED: &str = "1 to 8 digits and a unit: H, M, S, m, u or n";

/// When a call must be over.
#[derive(Clone, Copy, Debug)]
pub struct Deadline {
    allowed: Duration,
    end: Instant,
}

impl Deadline {
    /// The deadline of a call that begins now, if it has one.
    ///
    /// # Errors
    /// INVALID_ARGUMENT for one that is not written as the protocol does.
    pub fn of(headers: &HeaderMap) -> Result<Option<Self>, Status> {
        let Some(value) = headers.get(HEADER) else {
            return Ok(None);
        };
        let text = String::from_utf8_lossy(value.as_bytes());
        let fault = || status::faulty_metadata(HEADER.as_str(), &text, ALLOWED);
        let allowed = read(&text).ok_or_else(fault)?;
        // Beyond what a clock can hold is as good as never.
        let end = Instant::now().checked_add(allowed);
        Ok(end.map(|end| Self { allowed, end }))
    }

    /// The answer to a call, if its head comes in time; DEADLINE_EXCEEDED if not.
    pub async fn answer<B>(
        self,
        call: impl Future<Output = Response<B>>,
    ) -> Result<Response<B>, Status> {
        let answered = tokio::time::timeout_at(self.end, call).await;
        answered.map_err(|_| status::too_late(self.allowed))
    }

    /// When the call must be over.
    pub const fn end(&self) -> Instant {
        self.end
    }

    /// The trailers of an answer that is not complete at its deadline.
    pub fn trailers(&self) -> Option<HeaderMap> {
        status::trailers(&status::too_late(self.allowed))
    }
}

fn read(text: &str) -> Option<Duration> {
    let unit = text.chars().next_back()?;
    let digits = text.strip_suffix(unit)?;
    if digits.is_empty() || digits.len() > 8 || !digits.bytes().all(|b| b.is_ascii_digit()) {
        return None;
    }
    let value: u64 = digits.parse().ok()?;
    Some(match unit {
        'H' => Duration::from_secs(value * 3600),
        'M' => Duration::from_secs(value * 60),
        'S' => Duration::from_secs(value),
        'm' => Duration::from_millis(value),
        'u' => Duration::from_micros(value),
        'n' => Duration::from_nanos(value),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn timeouts_are_read_as_the_protocol_writes_them() {
        for (text, expected) in [
            ("1H", Some(Duration::from_secs(3600))),
            ("2M", Some(Duration::from_secs(120))),
            ("3S", Some(Duration::from_secs(3))),
            ("250m", Some(Duration::from_millis(250))),
            ("99999999u", Some(Duration::from_micros(99_999_999))),
            ("0n", Some(Duration::ZERO)),
            ("123456789S", None),
            ("S", None),
            ("", None),
            ("1", None),
            ("-1S", None),
            ("1 S", None),
            ("1s", None),
            ("1µ", None),
        ] {
            assert_eq!(read(text), expected, "{text}");
        }
    }
}
