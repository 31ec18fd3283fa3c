//! A number in a sentence: rounded up to four digits, so that who gives it back is not refused again.
//!
//! `core` prints numbers exactly; the code for that is large and can panic as far as a compiler sees.

use core::fmt::{self, Write};

/// Displays as at most four digits, the next number upwards that has them; from 0.001 to 999999 without exponent.
pub(super) struct RoundedUp(pub(super) f64);

/// The digits that are printed, as a factor.
const DIGITS: f64 = 1e4;

impl fmt::Display for RoundedUp {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(number) = *self;
        if !number.is_finite() {
            return f.write_str("a number that is not finite");
        }
        if number < 0.0 {
            f.write_char('-')?;
        }
        let size = number.abs();
        if size == 0.0 {
            return f.write_char('0');
        }
        // `size` is `digits · 10^(exponent − 3)`, with digits from 1000 to 9999 and something behind the point.
        let (mut digits, mut exponent) = (size, 3_i32);
        while digits >= DIGITS {
            digits /= 10.0;
            exponent += 1;
        }
        while digits < 0.1 * DIGITS {
            digits *= 10.0;
            exponent -= 1;
        }
        // The products may have rounded to either side: the printed number as a reader gets it decides.
        let mut power = 1.0;
        for _ in 0..(exponent - 3).abs() {
            power *= 10.0;
        }
        let read = |digits: f64| if exponent < 3 { digits / power } else { digits * power };
        let nearest = libm::round(digits);
        let digits = match (number > 0.0, read(nearest) >= size, read(nearest) <= size) {
            (true, false, _) => nearest + 1.0,
            (false, _, false) => nearest - 1.0,
            _ => nearest,
        };
        let mut digits = digits as u32;
        if digits >= 10_000 {
            (digits, exponent) = (1000, exponent + 1);
        } else if digits < 1000 {
            (digits, exponent) = (9999, exponent - 1);
        }
        let plain = (-3..=5).contains(&exponent);
        // Where the point stands: after so many digits.
        let mut before = if plain { exponent + 1 } else { 1 };
        if before <= 0 {
            f.write_str("0.")?;
            for _ in before..0 {
                f.write_char('0')?;
            }
        }
        while digits > 0 || before > 0 {
            f.write_char(char::from(b'0' + (digits / 1000 % 10) as u8))?;
            digits = digits % 1000 * 10;
            before -= 1;
            if before == 0 && digits > 0 {
                f.write_char('.')?;
            }
        }
        if plain { Ok(()) } else { write!(f, "e{exponent}") }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Room for a printed number.
    #[derive(Default)]
    struct Text(heapless::Vec<u8, 64>);

    impl Write for Text {
        fn write_str(&mut self, s: &str) -> fmt::Result {
            self.0.extend_from_slice(s.as_bytes()).map_err(|_| fmt::Error)
        }
    }

    fn check(number: f64, expected: &str) {
        let mut text = Text::default();
        assert!(write!(text, "{}", RoundedUp(number)).is_ok());
        assert_eq!(core::str::from_utf8(&text.0), Ok(expected), "{number:e}");
    }

    #[test]
    fn prints_the_next_number_upwards_that_has_four_digits() {
        for (number, expected) in [
            (0.0, "0"),
            (1.0, "1"),
            (-1.0, "-1"),
            (1.664e-5, "1.664e-5"),
            (1.66401e-5, "1.665e-5"),
            (-1.66409e-5, "-1.664e-5"),
            (0.001, "0.001"),
            (0.012345, "0.01235"),
            (0.5, "0.5"),
            // One unit of the last bit above and below a number that has four digits.
            (1.664_000_000_000_000_2e-5, "1.665e-5"),
            (-1.000_000_000_000_000_2, "-1"),
            (-0.999_999_999_999_999_9, "-0.9999"),
            (12.5, "12.5"),
            (99.991, "100"),
            (9999.1, "10000"),
            (-9999.9, "-9999"),
            (123_456.0, "123500"),
            (1e6, "1e6"),
            (3.0e-320, "3.001e-320"),
            (f64::MAX, "1.798e308"),
            (f64::INFINITY, "a number that is not finite"),
            (f64::NAN, "a number that is not finite"),
        ] {
            check(number, expected);
        }
    }

    #[test]
    fn a_length_that_is_printed_is_never_below_what_it_stands_for() {
        let mut number = 1.2345e-30;
        while number < 1e30 {
            let mut text = Text::default();
            assert!(write!(text, "{}", RoundedUp(number)).is_ok());
            let printed: f64 =
                core::str::from_utf8(&text.0).ok().and_then(|text| text.parse().ok()).unwrap_or(0.0);
            assert!(printed >= number && printed <= number * 1.001_001, "{number:e} {printed:e}");
            number *= 1.037;
        }
    }
}
