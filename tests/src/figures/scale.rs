//! Axes with round numbers.

/// A range of data on a range of the page.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis {
    pub(super) data: [f64; 2],
    pub(super) page: [f64; 2],
}

impl Axis {
    /// The place on the page.
    pub(super) fn place(&self, value: f64) -> f64 {
        let ([low, high], [from, to]) = (self.data, self.page);
        from + (value - low) / (high - low) * (to - from)
    }

    /// Round numbers in the range with their labels, about one in every `spacing` of the page.
    pub(super) fn ticks(&self, spacing: f64) -> Vec<(f64, String)> {
        let pieces = ((self.page[1] - self.page[0]).abs() / spacing).max(1.0);
        ticks(self.data, round_step((self.data[1] - self.data[0]) / pieces))
    }
}

/// The multiples of a step in a range, with their labels.
pub(super) fn ticks([low, high]: [f64; 2], step: f64) -> Vec<(f64, String)> {
    let decimals = (-libm::floor(libm::log10(step) + 1e-9)).max(0.0) as usize;
    let first = (low / step - 1e-9).ceil();
    let last = (high / step + 1e-9).floor();
    (0..=(last - first) as usize)
        .map(|i| (first + i as f64) * step)
        // `+ 0.0` takes the sign from a zero.
        .map(|value| (value, format!("{:.decimals$}", value + 0.0).replace('-', "\u{2212}")))
        .collect()
}

/// The smallest of 1, 2 and 5 times a power of ten that is not less than `at_least`.
pub(super) fn round_step(at_least: f64) -> f64 {
    let power = libm::pow(10.0, libm::floor(libm::log10(at_least)));
    [1.0, 2.0, 5.0].into_iter().map(|m| m * power).find(|step| *step >= at_least).unwrap_or(10.0 * power)
}

/// The range of values and zero, a little widened where there are values.
pub(super) fn range(values: impl IntoIterator<Item = f64>) -> [f64; 2] {
    let (low, high) = values.into_iter().fold((0.0_f64, 0.0_f64), |(low, high), x| (low.min(x), high.max(x)));
    let pad = 0.08 * (high - low);
    [if low < 0.0 { low - pad } else { 0.0 }, if high > 0.0 { high + pad } else { 0.0 }]
}
