//! The NC path: the command's options in the kernel's words.

use crate::arguments::{MachinePlane, PathArguments, Units};
use minvar::curve::{Element, measure};
use minvar::toolpath::{self, GcodeOptions, Motion, Plane, Summary};

/// The program's text and what it does, or the option's fault.
pub(crate) fn program(elements: &[Element], arguments: &PathArguments) -> Result<(String, Summary), String> {
    // What is usual for foam and wood, in the program's unit.
    let (feed, clearance) = match arguments.units {
        Units::Mm => (600.0, 5.0),
        Units::Inch => (24.0, 0.2),
    };
    let top = measure::bounding_box(elements).map_or(0.0, |[_, high]| high[2]);
    let options = GcodeOptions {
        units: match arguments.units {
            Units::Mm => toolpath::Units::Millimetres,
            Units::Inch => toolpath::Units::Inches,
        },
        plane: match arguments.plane {
            MachinePlane::Xy => Plane::Xy,
            MachinePlane::Zx => Plane::Zx,
            MachinePlane::Yz => Plane::Yz,
        },
        motion: if arguments.chords { Motion::Chords } else { Motion::Arcs },
        plunge_feed: arguments.plunge_feed,
        depth: arguments.depth,
        decimals: arguments.decimals,
        comments: arguments.comments,
        ..GcodeOptions::new(
            arguments.path_tolerance,
            arguments.feed.unwrap_or(feed),
            arguments.safe_height.unwrap_or(top + arguments.depth + clearance),
        )
    };
    let mut text = String::new();
    let summary = toolpath::write_gcode(elements, &options, &mut text)
        .map_err(|error| format!("no NC path: {error}"))?;
    Ok((text, summary))
}
