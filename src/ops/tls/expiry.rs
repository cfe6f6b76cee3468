//! When a certificate is valid (RFC 5280, 4.1.2.5).

use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// A certificate that expires sooner than this is worth a warning.
const SOON: u64 = 14 * DAY;
const DAY: u64 = 86_400;

/// The warning about a certificate in DER, if there is one.
pub(super) fn warning(certificate: &[u8]) -> Option<String> {
    let now = SystemTime::now().duration_since(UNIX_EPOCH);
    let now = now.as_ref().map_or(0, Duration::as_secs);
    let (_, end) = validity(certificate)?;
    if end <= now {
        let days = (now - end) / DAY;
        return Some(format!("the certificate expired {days} days ago"));
    }
    let days = (end - now) / DAY;
    (end - now < SOON).then(|| format!("the certificate expires in {days} days"))
}

/// The first and the last second of a certificate in DER, counted from 1970.
pub fn validity(certificate: &[u8]) -> Option<(u64, u64)> {
    const SEQUENCE: u8 = 0x30;
    const VERSION: u8 = 0xA0;
    let (_, certificate, _) = element(certificate)?;
    let (_, mut fields, _) = element(certificate)?;
    if fields.first() == Some(&VERSION) {
        fields = element(fields)?.2;
    }
    // After the serial number, the algorithm and the issuer comes the validity.
    for _ in 0..3 {
        fields = element(fields)?.2;
    }
    let (tag, validity, _) = element(fields)?;
    (tag == SEQUENCE).then_some(())?;
    let (form, start, rest) = element(validity)?;
    let start = time(form, start)?;
    let (form, end, _) = element(rest)?;
    Some((start, time(form, end)?))
}

/// The first element of some DER: its tag, its content, and what follows it.
fn element(bytes: &[u8]) -> Option<(u8, &[u8], &[u8])> {
    let (&tag, rest) = bytes.split_first()?;
    let (&first, mut rest) = rest.split_first()?;
    let mut length = usize::from(first);
    if first & 0x80 != 0 {
        let digits;
        (digits, rest) = rest.split_at_checked(usize::from(first & 0x7F))?;
        let fold = |length: usize, &digit: &u8| length.checked_mul(256)?.checked_add(digit.into());
        length = digits.iter().try_fold(0, fold)?;
    }
    let (content, rest) = rest.split_at_checked(length)?;
    Some((tag, content, rest))
}

/// A time as `YYMMDDHHMMSSZ` or `YYYYMMDDHHMMSSZ`, by its tag.
fn time(form: u8, text: &[u8]) -> Option<u64> {
    const UTC_TIME: u8 = 0x17;
    let text = std::str::from_utf8(text).ok()?.strip_suffix('Z')?;
    let (year, rest) = text.split_at_checked(if form == UTC_TIME { 2 } else { 4 })?;
    let year: u64 = year.parse().ok()?;
    let year = match form == UTC_TIME {
        true if year < 50 => 2000 + year,
        true => 1900 + year,
        false => year,
    };
    let part = |i: usize| rest.get(2 * i..2 * i + 2)?.parse::<u64>().ok();
    let (month, day) = (part(0)?, part(1)?);
    let seconds = part(2)? * 3600 + part(3)? * 60 + part(4)?;
    // Days of the civil calendar, with years that begin in March.
    let (year, month) = if month > 2 {
        (year, month - 3)
    } else {
        (year.checked_sub(1)?, month + 9)
    };
    let days = year * 365 + year / 4 - year / 100 + year / 400 + (month * 153 + 2) / 5 + day;
    // 719,469 such days lie before 1970.
    Some(days.checked_sub(719_469)? * DAY + seconds)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_seconds_since_1970() {
        for (form, text, expected) in [
            (0x18, "19700101000000Z", 0),
            (0x18, "20000229123456Z", 951_827_696),
            (0x17, "491231235959Z", 2_524_607_999),
            (0x17, "991231235959Z", 946_684_799),
        ] {
            assert_eq!(time(form, text.as_bytes()), Some(expected), "{text}");
        }
        assert_eq!(time(0x17, b"nonsense"), None);
    }

    #[test]
    fn what_is_not_a_certificate_is_not_warned_about() {
        for bytes in [
            &b""[..],
            &[0x30],
            &[0x30, 0x84, 1],
            &[0x30, 0xFF],
            &[0x30; 100],
        ] {
            assert_eq!(warning(bytes), None);
        }
    }
}
