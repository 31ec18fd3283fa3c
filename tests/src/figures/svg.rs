//! Writing SVG: lines, paths and words on a page, and the one style sheet of all figures.

use std::fmt::Write;

/// A place on the page: to the right and down, in user units of about a point.
pub(super) type Spot = [f64; 2];

/// The width of every page.
pub(super) const WIDTH: f64 = 860.0;

// Okabe and Ito's colours, told apart by every eye; dashes tell them apart in grey.
const STYLE: &str = "\
text { font-family: 'Helvetica Neue', Helvetica, Arial, 'Liberation Sans', sans-serif; font-size: 10.5px; fill: #555 }
.title { font-size: 17px; font-weight: 600; fill: #1a1a1a }
.caption { font-size: 11.5px; fill: #333 }
.part { font-size: 15px; fill: #1a1a1a }
.name { font-size: 11.5px; fill: #1a1a1a }
.paper { fill: #fff }
.frame { fill: none; stroke: #bdbdbd }
.grid { stroke: #ececec }
.zero { stroke: #8f8f8f }
.station { stroke: #b0b0b0; stroke-width: 0.7; stroke-dasharray: 2 2.5 }
.solid { fill: #ececec; stroke: #8f8f8f }
.shadow { fill: none; stroke: #d2d2d2; stroke-width: 1.2 }
.a, .b, .c, .d { fill: none; stroke-width: 1.7; stroke-linejoin: round; stroke-linecap: butt }
.a { stroke: #0072b2 }
.b { stroke: #d55e00; stroke-dasharray: 9 3 }
.c { stroke: #00795a; stroke-dasharray: 2.5 2.5 }
.d { stroke: #4d4d4d; stroke-dasharray: 10 3 2 3 }
.shade { fill: none; stroke-width: 1.4 }
.comb-a, .comb-b, .comb-c { fill: none; stroke-width: 0.55; stroke-opacity: 0.6 }
.comb-a { stroke: #0072b2 }
.comb-b { stroke: #d55e00 }
.comb-c { stroke: #00795a }
.fixed { fill: #1a1a1a; stroke: #fff; stroke-width: 1 }
.free { fill: #fff; stroke: #1a1a1a; stroke-width: 1.2 }
.ring { fill: none; stroke: #1a1a1a; stroke-width: 1 }
.tangent { stroke: #1a1a1a; stroke-width: 1.3; stroke-linecap: round }
";

/// How words are set against their spot.
#[derive(Clone, Copy, Debug)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// The elements of an SVG file, written in order.
#[derive(Debug, Default)]
pub(super) struct Page {
    body: String,
    clips: usize,
}

impl Page {
    pub(super) fn line(&mut self, class: &str, [x1, y1]: Spot, [x2, y2]: Spot) {
        let [x1, y1, x2, y2] = [x1, y1, x2, y2].map(number);
        put(
            &mut self.body,
            format_args!("<line class=\"{class}\" x1=\"{x1}\" y1=\"{y1}\" x2=\"{x2}\" y2=\"{y2}\"/>\n"),
        );
    }

    pub(super) fn circle(&mut self, class: &str, centre: Spot, radius: f64) {
        let [x, y] = centre.map(number);
        put(
            &mut self.body,
            format_args!("<circle class=\"{class}\" cx=\"{x}\" cy=\"{y}\" r=\"{}\"/>\n", number(radius)),
        );
    }

    pub(super) fn rectangle(&mut self, class: &str, low: Spot, size: Spot) {
        let ([x, y], [w, h]) = (low.map(number), size.map(number));
        put(
            &mut self.body,
            format_args!("<rect class=\"{class}\" x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\"/>\n"),
        );
    }

    /// A polyline; `style` is CSS of its own, empty for that of the class.
    pub(super) fn path(&mut self, class: &str, style: &str, spots: &[Spot], closed: bool) {
        if spots.is_empty() {
            return;
        }
        let style = if style.is_empty() { String::new() } else { format!(" style=\"{style}\"") };
        put(&mut self.body, format_args!("<path class=\"{class}\"{style} d=\""));
        for (i, spot) in spots.iter().enumerate() {
            let [x, y] = spot.map(number);
            put(&mut self.body, format_args!("{}{x},{y}", if i == 0 { "M" } else { "L" }));
        }
        self.body += if closed { "Z\"/>\n" } else { "\"/>\n" };
    }

    /// Teeth from one spot to another each, as one path.
    pub(super) fn teeth(&mut self, class: &str, teeth: &[[Spot; 2]]) {
        put(&mut self.body, format_args!("<path class=\"{class}\" d=\""));
        for tooth in teeth {
            let [[x1, y1], [x2, y2]] = tooth.map(|spot| spot.map(number));
            put(&mut self.body, format_args!("M{x1},{y1}L{x2},{y2}"));
        }
        self.body += "\"/>\n";
    }

    pub(super) fn text(&mut self, class: &str, at: Spot, anchor: Anchor, text: &str) {
        let [x, y] = at.map(number);
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let text = escape(text);
        put(
            &mut self.body,
            format_args!(
                "<text class=\"{class}\" x=\"{x}\" y=\"{y}\" text-anchor=\"{anchor}\">{text}</text>\n"
            ),
        );
    }

    /// What is drawn until [`Page::unclip`] shows in a rectangle only.
    pub(super) fn clip(&mut self, low: Spot, size: Spot) {
        let id = self.clips;
        self.clips += 1;
        put(&mut self.body, format_args!("<clipPath id=\"clip-{id}\">\n"));
        self.rectangle("clip", low, size);
        put(&mut self.body, format_args!("</clipPath>\n<g clip-path=\"url(#clip-{id})\">\n"));
    }

    pub(super) fn unclip(&mut self) {
        self.body += "</g>\n";
    }

    /// The whole file, of a height.
    pub(super) fn finish(self, height: f64, title: &str) -> String {
        let (w, h) = (number(WIDTH), number(height.ceil()));
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\">\n\
             <title>{}</title>\n<style>\n{STYLE}</style>\n<rect class=\"paper\" width=\"{w}\" height=\"{h}\"/>\n{}</svg>\n",
            escape(title),
            self.body
        )
    }
}

fn put(body: &mut String, text: std::fmt::Arguments<'_>) {
    body.write_fmt(text).expect("a string takes all that is written");
}

/// Hundredths of a unit are finer than any printer.
fn number(x: f64) -> String {
    let text = format!("{x:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// About how wide a text of the smallest size is.
pub(super) fn width(text: &str) -> f64 {
    text.chars().count() as f64 * 5.6
}
