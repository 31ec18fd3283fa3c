//! From data to the page: axes with round numbers.

/// One axis: a range of data on a range of the page.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Axis {
    pub(super) low: f64,
    pub(super) high: f64,
    page_low: f64,
    page_high: f64,
}

impl Axis {
    /// Maps `low` to `page_low` and `high` to `page_high`. An empty range becomes one around its value.
    pub(super) fn new(low: f64, high: f64, page_low: f64, page_high: f64) -> Self {
        if high > low {
            Self { low, high, page_low, page_high }
        } else {
            let half = if low == 0.0 { 1.0 } else { 0.5 * low.abs() };
            Self { low: low - half, high: low + half, page_low, page_high }
        }
    }

    /// The place on the page.
    pub(super) fn place(&self, value: f64) -> f64 {
        self.page_low + (value - self.low) / (self.high - self.low) * (self.page_high - self.page_low)
    }

    /// Round numbers in the range, about one in every `spacing` of the page.
    pub(super) fn ticks(&self, spacing: f64) -> Ticks {
        let page = (self.page_high - self.page_low).abs();
        let step = round_step((self.high - self.low) * spacing / page);
        Ticks::new(self.low, self.high, step)
    }
}

/// The smallest of 1, 2 and 5 times a power of ten that is not less than `at_least`.
pub(super) fn round_step(at_least: f64) -> f64 {
    let exponent = exponent(at_least);
    let multiple = [1.0, 2.0, 5.0].into_iter().map(|m| m * ten_to(exponent)).find(|step| *step >= at_least);
    multiple.unwrap_or_else(|| ten_to(exponent + 1))
}

/// Round numbers and how to write them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Ticks {
    pub(super) values: Vec<f64>,
    /// The labels are the values divided by ten to this.
    power: i32,
    decimals: usize,
}

impl Ticks {
    /// The multiples of a step in a range.
    pub(super) fn new(low: f64, high: f64, step: f64) -> Self {
        const MOST: usize = 1000;
        let first = (low / step - 1e-9).ceil();
        let values: Vec<_> = (0..MOST)
            .map(|i| (first + i as f64) * step)
            .take_while(|value| *value <= high + 1e-9 * step)
            .map(|value| if value.abs() < 1e-9 * step { 0.0 } else { value })
            .collect();
        let largest = low.abs().max(high.abs());
        let mut power = 0;
        if !(1e-3..1e5).contains(&largest) {
            power = exponent(largest).div_euclid(3) * 3;
        }
        let decimals = |power: i32| usize::try_from(power - exponent(step * (1.0 + 1e-9))).unwrap_or(0);
        // A small range far from zero would need more digits, not fewer.
        if decimals(power) > 4 {
            power = 0;
        }
        Self { values, power, decimals: decimals(power) }
    }

    /// A value as its label.
    pub(super) fn label(&self, value: f64) -> String {
        format!("{:.*}", self.decimals, value / ten_to(self.power) + 0.0).replace('-', "\u{2212}")
    }

    /// ` (×10⁶)`, if the labels need it.
    pub(super) fn factor(&self) -> String {
        if self.power == 0 { String::new() } else { format!(" (×10{})", superscript(self.power)) }
    }
}

/// The `e` of `m × 10^e`, `1 ≤ m < 10`, exactly; 0 for zero and what is not finite.
fn exponent(value: f64) -> i32 {
    let text = format!("{value:e}");
    text.split_once('e').and_then(|(_, exponent)| exponent.parse().ok()).unwrap_or(0)
}

/// The f64 nearest to a power of ten.
fn ten_to(exponent: i32) -> f64 {
    format!("1e{exponent}").parse().unwrap_or(f64::MIN_POSITIVE)
}

/// A number with so many significant digits, as a person would write it.
pub(crate) fn figure(value: f64, digits: usize) -> String {
    let text = format!("{value:.*e}", digits.saturating_sub(1));
    let Some((mantissa, power)) = text.split_once('e') else { return text };
    let power: i32 = power.parse().unwrap_or(0);
    let text = if (-4..6).contains(&power) {
        let decimals = usize::try_from(digits as i32 - 1 - power).unwrap_or(0);
        trimmed(&format!("{:.*}", decimals, value + 0.0)).to_owned()
    } else {
        format!("{}·10{}", trimmed(mantissa), superscript(power))
    };
    text.replace('-', "\u{2212}")
}

fn trimmed(text: &str) -> &str {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }
}

fn superscript(number: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    number.to_string().chars().map(|c| c.to_digit(10).map_or('⁻', |digit| DIGITS[digit as usize])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(low: f64, high: f64) -> (Vec<String>, String) {
        let ticks = Axis::new(low, high, 0.0, 500.0).ticks(90.0);
        (ticks.values.iter().map(|value| ticks.label(*value)).collect(), ticks.factor())
    }

    #[test]
    fn ticks_are_round_and_written_short() {
        assert_eq!(
            labels(-1.0, 1.0),
            (vec!["−1.0".into(), "−0.5".into(), "0.0".into(), "0.5".into(), "1.0".into()], String::new())
        );
        assert_eq!(labels(0.0, 2.39).0, ["0.0", "0.5", "1.0", "1.5", "2.0"]);
        assert_eq!(labels(0.0, 0.3).0, ["0.0", "0.1", "0.2", "0.3"]);
        assert_eq!(
            labels(0.0, 3e6),
            (vec!["0".into(), "1".into(), "2".into(), "3".into()], " (×10⁶)".into())
        );
        assert_eq!(labels(-2e-6, 0.0).1, " (×10⁻⁶)");
        assert_eq!(labels(1e6, 1e6 + 1e-3).0[1], "1000000.0002");
    }

    #[test]
    fn an_empty_range_is_widened() {
        assert!(Axis::new(3.0, 3.0, 0.0, 1.0).ticks(0.3).values.contains(&3.0));
        assert!(Axis::new(0.0, 0.0, 0.0, 1.0).ticks(0.3).values.contains(&0.0));
    }

    #[test]
    fn figures_are_written_as_a_person_would() {
        assert_eq!(figure(0.008_351_86, 4), "0.008352");
        assert_eq!(figure(-1.20, 6), "−1.2");
        assert_eq!(figure(1.205_798e-6, 4), "1.206·10⁻⁶");
        assert_eq!(figure(123_456_789.0, 4), "1.235·10⁸");
        assert_eq!(figure(1_000_001.0, 4), "1·10⁶");
        assert_eq!(figure(12_345.6, 4), "12346");
        assert_eq!(figure(0.0, 4), "0");
    }
}
