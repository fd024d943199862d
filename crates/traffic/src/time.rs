//! Times in the forms of each format, as seconds of Unix time.

use chrono::NaiveDate;

const DAY_S: f64 = 86_400.0;

/// Seconds of a day from `hhmmss`, with decimals or without.
pub(crate) fn of_day(text: &str) -> Option<f64> {
    let (hours, rest) = (text.get(..2)?, text.get(2..)?);
    clock(hours, rest.get(..2)?, rest.get(2..)?)
}

/// Seconds of a day from hours, minutes, and seconds with decimals or without. A leap second is the 60th.
fn clock(hours: &str, minutes: &str, seconds: &str) -> Option<f64> {
    let whole = seconds.split('.').next()?;
    let is_digits = |text: &str| text.len() == 2 && text.bytes().all(|byte| byte.is_ascii_digit());
    if ![hours, minutes, whole].into_iter().all(is_digits) {
        return None;
    }
    let number = |text: &str| text.parse::<f64>().ok();
    let (hours, minutes, seconds) = (number(hours)?, number(minutes)?, number(seconds)?);
    let is_sound = hours < 24.0 && minutes < 60.0 && (0.0..61.0).contains(&seconds);
    is_sound.then_some(3600.0 * hours + 60.0 * minutes + seconds)
}

/// The time of a day that is nearest to another time.
pub(crate) fn nearest_day(of_day: f64, to: f64) -> f64 {
    of_day + DAY_S * ((to - of_day) / DAY_S).round()
}

fn midnight(year: i32, month: u32, day: u32) -> Option<f64> {
    let date = NaiveDate::from_ymd_opt(year, month, day)?;
    Some(date.and_hms_opt(0, 0, 0)?.and_utc().timestamp() as f64)
}

/// Midnight of `ddmmyy`. Satellites have told the time since 1980.
pub(crate) fn of_short_date(text: &str) -> Option<f64> {
    let is_digits = text.len() == 6 && text.bytes().all(|byte| byte.is_ascii_digit());
    let number = |from: usize| text.get(from..from + 2)?.parse::<u32>().ok();
    let (day, month, year) = is_digits.then_some((number(0)?, number(2)?, number(4)?))?;
    let century = if year < 80 { 2000 } else { 1900 };
    midnight(century + year as i32, month, day)
}

/// `2022-01-03T00:00:00`, with a blank for the `T`, decimals, and `Z`, or `03/01/2022 00:00:00` with the day
/// first, or a number of Unix time in seconds or its thousandths, millionths or milliardths, which are told
/// apart by their size. All in UTC: a time with another offset is none.
pub(crate) fn of_row(text: &str) -> Option<f64> {
    let text = text.trim().trim_end_matches('Z');
    if (9..=19).contains(&text.len()) && text.bytes().all(|byte| byte.is_ascii_digit()) {
        let number: f64 = text.parse().ok()?;
        return Some(match number {
            1e17.. => 1e-9 * number,
            1e14.. => 1e-6 * number,
            1e11.. => 1e-3 * number,
            _ => number,
        });
    }
    let (date, time) = text.split_once(['T', ' '])?;
    let mut time = time.splitn(3, ':');
    let of_day = clock(time.next()?, time.next()?, time.next().unwrap_or("00"))?;
    let is_day_first = date.contains('/');
    let mut parts = date.splitn(3, if is_day_first { '/' } else { '-' });
    let mut part = || {
        parts
            .next()
            .filter(|part| part.len() <= 4)?
            .parse::<u32>()
            .ok()
    };
    let (first, month, last) = (part()?, part()?, part()?);
    let (year, day) = if is_day_first {
        (last, first)
    } else {
        (first, last)
    };
    Some(midnight(year as i32, month, day)? + of_day)
}

/// A time of RFC 3339 with any offset.
pub(crate) fn of_timestamp(text: &str) -> Option<f64> {
    let time = chrono::DateTime::parse_from_rfc3339(text).ok()?;
    Some(time.timestamp() as f64 + 1e-9 * f64::from(time.timestamp_subsec_nanos()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_of_a_day_is_of_the_nearest_day() {
        // 00:30 of a day
        let received = 1_700_006_400.0 + 1800.0;
        assert_eq!(nearest_day(1790.0, received), received - 10.0);
        assert_eq!(nearest_day(DAY_S - 10.0, received), received - 1810.0);
        assert_eq!(of_day("235959.50"), Some(DAY_S - 0.5));
        for wrong in [
            "", "1", "240000", "006000", "00000a", "0000-1", "+10000", "000061", "0000",
        ] {
            assert_eq!(of_day(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn dates_have_two_digits_or_four() {
        assert_eq!(of_short_date("010170"), Some(3_155_760_000.0));
        assert_eq!(of_short_date("060180"), Some(315_964_800.0));
        assert_eq!(of_short_date("291126"), Some(1_795_910_400.0));
        for wrong in ["310226", "000126", "0101", "0101é", "+10126"] {
            assert_eq!(of_short_date(wrong), None, "{wrong}");
        }
        let time = Some(1_641_168_000.0);
        for same in [
            "2022-01-03T00:00:00",
            "2022-01-03 00:00:00",
            "2022-01-03T00:00:00.000Z",
            "03/01/2022 00:00:00",
            "1641168000",
            "1641168000000",
            "1641168000000000",
            "1641168000000000000",
        ] {
            assert_eq!(of_row(same), time, "{same}");
        }
        for wrong in [
            "2022-01-03",
            "2022-13-03T00:00:00",
            "01/31/2022 00:00:00",
            "soon",
            "2022-01-03T00:00:00+01:00",
        ] {
            assert_eq!(of_row(wrong), None, "{wrong}");
        }
        assert_eq!(of_timestamp("2022-01-03T01:00:00.000+01:00"), time);
        assert_eq!(of_timestamp("2022-01-03"), None);
    }
}
