//! A figure: a title, keys, and rows of panels.

use super::marks;
use super::plot::Plot;
use super::shape::Shape;
use super::svg::{Anchor, Page, Spot, WIDTH};

const MARGIN: f64 = 14.0;

/// What a row is made of.
pub(super) trait Panel {
    fn draw(&self, page: &mut Page, corner: Spot, size: Spot);
}

impl Panel for Plot {
    fn draw(&self, page: &mut Page, corner: Spot, size: Spot) {
        Self::draw(self, page, corner, size);
    }
}

impl Panel for Shape<'_> {
    fn draw(&self, page: &mut Page, corner: Spot, size: Spot) {
        Self::draw(self, page, corner, size);
    }
}

/// A figure in the making.
#[derive(Debug)]
pub(super) struct Sheet {
    page: Page,
    title: String,
    y: f64,
}

impl Sheet {
    /// Title and lines of keys: a class and what it means.
    pub(super) fn new(title: &str, keys: &[&[(&str, &str)]]) -> Self {
        let mut page = Page::default();
        let mut y = MARGIN + 16.0;
        page.text("title", [MARGIN + 6.0, y], Anchor::Start, title);
        y += 4.0;
        for line in keys {
            y += 20.0;
            marks::legend(&mut page, MARGIN + 6.0, y, line);
        }
        Self { page, title: title.into(), y: y + 8.0 }
    }

    /// A row of panels of equal width, each with the name of the part that it shows.
    pub(super) fn row(&mut self, height: f64, panels: &[(&str, &dyn Panel)]) {
        let width = (WIDTH - 2.0 * MARGIN) / panels.len() as f64;
        for (i, (part, panel)) in panels.iter().enumerate() {
            let corner = [MARGIN + width * i as f64, self.y];
            panel.draw(&mut self.page, corner, [width, height]);
            self.page.text("part", [corner[0] + 26.0, corner[1] + 15.0], Anchor::Middle, part);
        }
        self.y += height + 4.0;
    }

    pub(super) fn finish(self) -> String {
        self.page.finish(self.y + MARGIN, &self.title)
    }
}

/// Gives several panels of a figure the same ranges.
pub(super) fn same_ranges(plots: &mut [&mut Plot]) {
    let ranges: Vec<_> = plots.iter().map(|plot| plot.ranges()).collect();
    let joint = |d: usize| {
        let low = ranges.iter().map(|range| range[d][0]).fold(f64::INFINITY, f64::min);
        let high = ranges.iter().map(|range| range[d][1]).fold(f64::NEG_INFINITY, f64::max);
        Some([low, high])
    };
    for plot in plots {
        (plot.along_range, plot.up_range) = (joint(0), joint(1));
    }
}

/// Gives several shapes the same scale: each holds what the others hold.
pub(super) fn same_scale(shapes: &mut [&mut Shape<'_>]) {
    let all: Vec<_> = shapes.iter().flat_map(|shape| shape.content()).collect();
    for shape in shapes {
        shape.also.clone_from(&all);
    }
}
