//! The figures of thesis chapter 4: complete, well formed, and the same in every run.

use minvar_tests::appendix;
use minvar_tests::figures::{Figure, all, page};
use roxmltree::{Document, Node};
use std::collections::BTreeSet;
use std::sync::LazyLock;

static FIGURES: LazyLock<Vec<Figure>> = LazyLock::new(all);

#[test]
fn every_figure_of_chapter_4_is_there() {
    let drawn: Vec<&str> = FIGURES.iter().map(|figure| figure.number).collect();
    let wanted = [
        "4.1", "4.2", "4.3", "4.9", "4.10", "4.11", "4.12", "4.13", "4.14", "4.15", "4.16", "4.17", "4.18",
        "4.19", "4.20", "4.21", "4.22",
    ];
    assert_eq!(drawn, wanted);
    for figure in appendix::figures() {
        let number = figure.id.split('-').next().expect("an id");
        assert!(drawn.contains(&number), "Appendix A's {} is not drawn", figure.id);
    }
}

#[test]
fn every_picture_is_well_formed_and_draws_curves_on_the_page() {
    for figure in FIGURES.iter() {
        let document =
            Document::parse(&figure.svg).unwrap_or_else(|error| panic!("{}: {error}", figure.number));
        let root = document.root_element();
        assert!(root.has_tag_name(("http://www.w3.org/2000/svg", "svg")));
        let number = |node: Node<'_, '_>, name: &str| -> f64 {
            node.attribute(name).expect(name).parse().expect(name)
        };
        let size = [number(root, "width"), number(root, "height")];
        let paths: Vec<_> = document.descendants().filter(|node| node.has_tag_name("path")).collect();
        assert!(!paths.is_empty(), "{} draws nothing", figure.number);
        for path in paths {
            let data = path.attribute("d").expect("a path has data");
            assert!(data.starts_with('M') && data.contains('L'), "{}: {data}", figure.number);
            let numbers = data.split(['M', 'L', 'Z', ',']).filter(|word| !word.is_empty());
            assert!(numbers.map(str::parse::<f64>).all(|x| x.is_ok_and(f64::is_finite)), "{}", figure.number);
        }
        for text in document.descendants().filter(|node| node.has_tag_name("text")) {
            let (x, y) = (number(text, "x"), number(text, "y"));
            assert!(
                x >= 0.0 && x <= size[0] && y >= 0.0 && y <= size[1],
                "{}: {:?}",
                figure.number,
                text.text()
            );
        }
    }
}

#[test]
fn the_same_data_give_the_same_bytes() {
    let again = all();
    for (first, second) in FIGURES.iter().zip(&again) {
        assert!(first.svg == second.svg, "{} differs", first.number);
        assert_eq!(first.rows, second.rows);
        assert_eq!(first.caption, second.caption);
    }
}

#[test]
fn the_page_shows_every_picture_once() {
    let page = page(&FIGURES, "");
    let shown: Vec<&str> = page.split("](").skip(1).filter_map(|rest| rest.split(')').next()).collect();
    let files: Vec<String> = FIGURES.iter().map(Figure::file).collect();
    assert_eq!(shown, files);
    assert_eq!(files.iter().collect::<BTreeSet<_>>().len(), files.len());
}

/// Only the MVC of the antipodal tangents, which has no minimum, and what was not solved for may not be converged.
#[test]
fn the_curves_that_are_drawn_have_converged() {
    for figure in FIGURES.iter() {
        for row in &figure.rows {
            let cells: Vec<&str> = row.split('|').map(str::trim).collect();
            let (name, status) = (cells[1], cells[3]);
            let expected = match (figure.number, name) {
                ("4.14", "MVC (not drawn)") => "unbounded",
                ("4.11", "① natural spline") | ("4.19", "start") => "–",
                _ => "converged",
            };
            assert_eq!(status, expected, "{} {name}", figure.number);
        }
    }
}
