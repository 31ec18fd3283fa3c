//! The figures of thesis chapter 4, drawn anew from Appendix A: what `make figures` writes to `docs/figures`.
//!
//! One file has one figure or a few of the same data; `svg`, `scale`, `view`, `plot`, `shape`, `room`, `marks` and `sheet`
//! draw. The same data give the same bytes.

mod box_corners;
mod coving;
mod figure_eight;
mod helix;
mod marks;
mod natural_spline;
mod plot;
mod reference_shape;
mod room;
mod scale;
mod shape;
mod sheet;
mod solved;
mod space_curve;
mod specification;
mod svg;
mod table;
mod tangents;
mod two_minima;
mod view;
mod wicket;
mod woodford;

use std::fmt::Write;

pub use table::table;

/// A figure.
#[derive(Clone, Debug)]
pub struct Figure {
    /// The thesis's number, `4.11`.
    pub number: &'static str,
    /// What it shows.
    pub title: &'static str,
    /// What is to be seen in it.
    pub caption: String,
    /// The rows of the table below it, a curve each, as Markdown.
    pub rows: Vec<String>,
    /// The picture.
    pub svg: String,
}

impl Figure {
    /// The picture's file.
    pub fn file(&self) -> String {
        format!("{}.svg", self.number)
    }
}

/// All figures in the thesis's order.
///
/// # Panics
///
/// If minvar refuses the data.
pub fn all() -> Vec<Figure> {
    let mut figures = vec![
        specification::figure(),
        wicket::figure(),
        reference_shape::figure(),
        two_minima::figure(),
        box_corners::figure(),
        woodford::comparison(),
        woodford::scale_invariant(),
        tangents::s_shaped(),
        tangents::antipodal(),
        figure_eight::figure(),
        space_curve::schematic(),
        space_curve::plots(),
        space_curve::profiles(),
    ];
    figures.extend(helix::figures());
    figures.push(coving::figure());
    figures
}

/// The page that shows figures, and a table below them.
///
/// # Panics
///
/// Never: a string takes all that is written.
pub fn page(figures: &[Figure], table: &str) -> String {
    let mut page = String::from(
        "# Chapter 4 in figures\n\n\
         The figures of chapter 4 of the thesis, computed anew from the data of its Appendix A. This page and its pictures are \
         written by `make figures`; the same machine writes the same bytes.\n\n\
         With the elements a span that the tables say the curves are the true ones as far as the eye can tell, but for 4.3, \
         whose reference is compared element by element. V is \
         the variation ∫(dκ/ds)² ds, E the bending energy ∫κ² ds, L the length. The curvature of a planar curve is signed, \
         positive to the left; of a space curve it is the size. Teeth of curvature combs stand on the outside of the bend. \
         What is compared is drawn at one scale.\n",
    );
    let mut put =
        |text: std::fmt::Arguments<'_>| page.write_fmt(text).expect("a string takes all that is written");
    for figure in figures {
        let (number, title, caption, file) = (figure.number, figure.title, &figure.caption, figure.file());
        put(format_args!("\n## Figure {number}. {title}\n\n![{title}]({file})\n\n{caption}\n"));
        if !figure.rows.is_empty() {
            put(format_args!("\n{}\n{}\n", solved::HEAD, figure.rows.join("\n")));
        }
    }
    put(format_args!("\n{table}"));
    page
}
