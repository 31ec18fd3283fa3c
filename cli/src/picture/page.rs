//! Writing SVG: a page of lines, paths and words.

use std::fmt::Write;

/// A place on the page: to the right and down, in user units of about a point.
pub(super) type Spot = [f64; 2];

/// The elements of an SVG file, written in order.
#[derive(Clone, Debug, Default)]
pub(super) struct Page {
    body: String,
}

/// How a word is set against its spot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

impl Page {
    /// Opens a group of a class; `clip` names a clip path.
    pub(super) fn open(&mut self, class: &str, clip: Option<&str>) {
        let clip = clip.map_or(String::new(), |id| format!(" clip-path=\"url(#{id})\""));
        let _ = writeln!(self.body, "<g class=\"{class}\"{clip}>");
    }

    pub(super) fn close(&mut self) {
        self.body += "</g>\n";
    }

    pub(super) fn line(&mut self, class: &str, a: Spot, b: Spot) {
        let [[x1, y1], [x2, y2]] = [a.map(number), b.map(number)];
        let class = attribute(class);
        let _ = writeln!(self.body, "<line{class} x1=\"{x1}\" y1=\"{y1}\" x2=\"{x2}\" y2=\"{y2}\"/>");
    }

    pub(super) fn circle(&mut self, class: &str, centre: Spot, radius: f64) {
        let [x, y] = centre.map(number);
        let _ = writeln!(
            self.body,
            "<circle{} cx=\"{x}\" cy=\"{y}\" r=\"{}\"/>",
            attribute(class),
            number(radius)
        );
    }

    pub(super) fn rectangle(&mut self, class: &str, low: Spot, size: Spot) {
        let ([x, y], [w, h]) = (low.map(number), size.map(number));
        let class = attribute(class);
        let _ = writeln!(self.body, "<rect{class} x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\"/>");
    }

    /// A clip path of one rectangle.
    pub(super) fn clip(&mut self, id: &str, low: Spot, size: Spot) {
        let _ = writeln!(self.body, "<clipPath id=\"{id}\">");
        self.rectangle("", low, size);
        self.body += "</clipPath>\n";
    }

    pub(super) fn path(&mut self, class: &str, path: &Path) {
        if !path.data.is_empty() {
            let _ = writeln!(self.body, "<path{} d=\"{}\"/>", attribute(class), path.data);
        }
    }

    pub(super) fn text(&mut self, class: &str, at: Spot, anchor: Anchor, text: &str) {
        let [x, y] = at.map(number);
        let anchor = match anchor {
            Anchor::Start => "",
            Anchor::Middle => " text-anchor=\"middle\"",
            Anchor::End => " text-anchor=\"end\"",
        };
        let (class, text) = (attribute(class), escape(text));
        let _ = writeln!(self.body, "<text{class} x=\"{x}\" y=\"{y}\"{anchor}>{text}</text>");
    }

    /// The whole file.
    pub(super) fn finish(self, size: Spot, title: &str, style: &str) -> String {
        let [w, h] = size.map(|x| number(x.ceil()));
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\">\n\
             <title>{}</title>\n<style>\n{style}</style>\n<rect class=\"paper\" width=\"{w}\" height=\"{h}\"/>\n{}</svg>\n",
            escape(title),
            self.body
        )
    }
}

/// The commands of a path.
#[derive(Clone, Debug, Default)]
pub(super) struct Path {
    data: String,
}

impl Path {
    pub(super) fn polyline(spots: impl IntoIterator<Item = Spot>) -> Self {
        let mut path = Self::default();
        for spot in spots {
            path.point(spot);
        }
        path
    }

    /// A line to the spot; the first command moves there.
    pub(super) fn point(&mut self, spot: Spot) {
        let command = if self.data.is_empty() { "M" } else { "L" };
        self.command(command, &[spot]);
    }

    pub(super) fn start(&mut self, spot: Spot) {
        self.command("M", &[spot]);
    }

    pub(super) fn cubic(&mut self, a: Spot, b: Spot, end: Spot) {
        self.command("C", &[a, b, end]);
    }

    pub(super) fn close(&mut self) {
        self.data += "Z";
    }

    fn command(&mut self, letter: &str, spots: &[Spot]) {
        self.data += letter;
        for (i, [x, y]) in spots.iter().enumerate() {
            let blank = if i == 0 { "" } else { " " };
            let _ = write!(self.data, "{blank}{},{}", number(*x), number(*y));
        }
    }
}

/// Hundredths of a unit are finer than any printer; nothing off the page is written larger than it must be.
fn number(x: f64) -> String {
    let text = format!("{:.2}", if x.is_finite() { x.clamp(-1e6, 1e6) } else { 0.0 });
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

fn attribute(class: &str) -> String {
    if class.is_empty() { String::new() } else { format!(" class=\"{class}\"") }
}

/// Text as XML can hold it: what XML forbids becomes a replacement character.
fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out += "&amp;",
            '<' => out += "&lt;",
            '>' => out += "&gt;",
            '"' => out += "&quot;",
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}

/// About how wide a text is at a font size: enough to keep labels apart.
pub(super) fn width(text: &str, size: f64) -> f64 {
    text.chars().map(|c| if c.is_ascii() || c < '\u{2e80}' { 0.54 } else { 1.0 }).sum::<f64>() * size
}
