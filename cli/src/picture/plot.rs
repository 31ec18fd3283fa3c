//! A quantity against the arc length.

use super::page::{Anchor, Page, Path, width};
use super::scale::{Axis, Ticks};
use super::{LABEL, steepest};
use crate::trace::{STRAIGHT, Trace};

const HEIGHT: f64 = 150.0;
/// Arc length labels stand about so far apart.
const SPACING_X: f64 = 95.0;
const SPACING_Y: f64 = 26.0;
/// More joints than this are not marked.
const MOST_STATIONS: usize = 100;

/// One quantity and its axis.
pub(super) struct Plot<'a> {
    trace: &'a Trace,
    caption: &'static str,
    class: &'static str,
    values: Vec<Option<f64>>,
    low: f64,
    high: f64,
}

/// Curvature, and of a space curve the torsion.
pub(super) fn plots(trace: &Trace) -> Vec<Plot<'_>> {
    let curvature = trace.samples.iter().map(|sample| Some(sample.kappa)).collect();
    let mut plots = vec![Plot::new(trace, "curvature κ", "kappa", curvature, |_| true)];
    if trace.plane.is_none() {
        // Where a curve is nearly straight the torsion may be anything: it must not set the scale.
        let least = 0.02 * steepest(trace).unwrap_or(0.0);
        let torsion = trace.samples.iter().map(|sample| sample.torsion).collect();
        plots.push(Plot::new(trace, "torsion τ", "torsion", torsion, |i| trace.samples[i].kappa > least));
    }
    plots
}

impl<'a> Plot<'a> {
    /// The range holds zero and every value that counts; rounding noise about zero is drawn as zero.
    fn new(
        trace: &'a Trace,
        caption: &'static str,
        class: &'static str,
        mut values: Vec<Option<f64>>,
        counts: impl Fn(usize) -> bool,
    ) -> Self {
        let noise = STRAIGHT / trace.length();
        let (mut low, mut high) = (0.0_f64, 0.0_f64);
        for (i, value) in values.iter_mut().enumerate() {
            *value = value.filter(|value| value.is_finite());
            if let Some(value) = value
                && counts(i)
            {
                low = low.min(*value);
                high = high.max(*value);
            }
        }
        let varies = high - low > noise;
        if !varies {
            let unit = if trace.length() > 0.0 { 1.0 / trace.length() } else { 1.0 };
            (low, high) = (-unit, unit);
            values.iter_mut().for_each(|value| *value = value.map(|_| 0.0));
        }
        let pad = 0.07 * (high - low);
        let low = if low < 0.0 { low - pad } else { low };
        let high = if high > 0.0 { high + pad } else { high };
        Self { trace, caption, class, values, low, high }
    }

    fn axis(&self, top: f64) -> Axis {
        Axis::new(self.low, self.high, top + HEIGHT, top)
    }

    fn ticks(&self) -> Ticks {
        self.axis(0.0).ticks(SPACING_Y)
    }

    /// The width of the widest label.
    pub(super) fn label_width(&self) -> f64 {
        let ticks = self.ticks();
        ticks.values.iter().map(|value| width(&ticks.label(*value), LABEL)).fold(0.0, f64::max)
    }

    /// Draws the plot with its upper edge at `top` and gives its lower end.
    pub(super) fn draw(
        &self,
        page: &mut Page,
        [left, right]: [f64; 2],
        top: f64,
        stations: &[(f64, &str)],
        first: bool,
        last: bool,
    ) -> f64 {
        let bottom = top + HEIGHT;
        let (x, y) = (Axis::new(0.0, self.trace.length(), left, right), self.axis(top));
        let (x_ticks, y_ticks) = (x.ticks(SPACING_X), self.ticks());

        page.open("grid", None);
        for value in &x_ticks.values {
            page.line("", [x.place(*value), top], [x.place(*value), bottom]);
        }
        for value in &y_ticks.values {
            page.line("", [left, y.place(*value)], [right, y.place(*value)]);
        }
        page.close();
        if stations.len() <= MOST_STATIONS {
            let mut free_from = f64::NEG_INFINITY;
            for (s, name) in stations {
                let at = x.place(*s);
                page.line("station", [at, top], [at, bottom]);
                let half = 0.5 * width(name, LABEL);
                if first && at - half > free_from {
                    page.text("", [at, top - 5.0], Anchor::Middle, name);
                    free_from = at + half + 3.0;
                }
            }
        }
        page.line("zero", [left, y.place(0.0)], [right, y.place(0.0)]);
        page.rectangle("frame", [left, top], [right - left, HEIGHT]);

        let clip = format!("clip-{}", self.class);
        page.clip(&clip, [left, top], [right - left, HEIGHT]);
        page.open("plot", Some(&clip));
        let mut run = Path::default();
        for (sample, value) in self.trace.samples.iter().zip(&self.values) {
            match value {
                Some(value) => run.point([x.place(sample.s), y.place(*value)]),
                None => page.path(self.class, &std::mem::take(&mut run)),
            }
        }
        page.path(self.class, &run);
        page.close();

        for value in &y_ticks.values {
            page.text("", [left - 6.0, y.place(*value) + 3.6], Anchor::End, &y_ticks.label(*value));
        }
        let caption = format!("{}{}", self.caption, y_ticks.factor());
        let above = if first { 21.0 } else { 8.0 };
        page.text("caption", [left, top - above], Anchor::Start, &caption);
        if !last {
            return bottom - 14.0;
        }
        for value in &x_ticks.values {
            page.text("", [x.place(*value), bottom + 15.0], Anchor::Middle, &x_ticks.label(*value));
        }
        let caption = format!("arc length s{}", x_ticks.factor());
        page.text("caption", [0.5 * (left + right), bottom + 33.0], Anchor::Middle, &caption);
        bottom + 33.0
    }
}
