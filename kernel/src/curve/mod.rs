//! Curves: from a designer's points, tangents and curvatures to quintic elements of least variation (thesis chapter 4).
//!
//! A [`Curve`] is a row of [`Joint`]s, at each of which position, tangent and curvature are fixed, given as start values
//! or free. [`solve()`] finds the piecewise quintic that meets them and minimises a [`Functional`]: the MVC, whose
//! curvature changes as little as possible, or the MEC, which bends as little as possible. The result is a slice of
//! [`Element`]s, plain data, which [`measure`] and [`convert`] read.
//!
//! Memory is the caller's, in three calls: [`workspace_len`] and [`elements_len`] say how much, the caller brings it,
//! [`solve()`] works in it.
//!
//! A solved curve is edited by [`update`], which starts from the last solution, or locally: a [`Region`] of it is computed
//! anew and joins the rest, which stays as it is.
//!
//! ```
//! use minvar::curve::{Curve, Element, Joint, Options, Quantity, elements_len, solve, workspace_len};
//! use minvar::solve::{Silent, Status};
//!
//! // Two points with opposite tangents: the curve of least variation is the half circle.
//! let joints = [
//!     Joint::at([-1.0, 0.0, 0.0]).with_tangent(Quantity::fixed([0.0, 1.0, 0.0])),
//!     Joint::at([1.0, 0.0, 0.0]).with_tangent(Quantity::fixed([0.0, -1.0, 0.0])),
//! ];
//! let curve = Curve::open(&joints);
//! let options = Options::DEFAULT;
//!
//! let mut workspace = [0.0; 512];
//! assert!(workspace_len(&curve, &options)? <= workspace.len());
//! let mut elements = [Element::ZERO; 1];
//! assert_eq!(elements_len(&curve, &options), elements.len());
//!
//! let report = solve(&curve, &options, &mut workspace, &mut elements, &mut [], &mut Silent)?;
//! assert_eq!(report.status, Status::Converged);
//! assert!((report.length - core::f64::consts::PI).abs() < 1e-5);
//! # Ok::<(), minvar::curve::CurveError>(())
//! ```

mod accuracy;
mod anchors;
mod check;
mod contacts;
pub mod convert;
mod element;
mod end;
mod error;
pub(crate) mod fairness;
mod figures;
pub(crate) mod functional;
mod guard;
mod joint;
mod layout;
pub mod measure;
mod minima;
mod model;
mod natural;
mod obstacle;
mod options;
mod passes;
mod placement;
mod region;
mod report;
mod rows;
mod solve;
mod space;
mod start;
#[cfg(test)]
mod tests;
mod torsion;

pub use element::Element;
pub use error::{CurveError, OptionName, Part};
pub use functional::Functional;
pub use joint::{Continuity, Curve, Given, Joint, Quantity, Reference};
pub use measure::{CurvePoint, MeasureError};
pub use minima::{minima, minima_as};
pub use obstacle::{Obstacle, Side};
pub use options::Options;
pub use passes::LENGTH_TRUSTED;
pub use region::Region;
pub use report::{FARTHEST, Report, SHOWN_GROWTH, TRUSTED};
pub use solve::{elements_len, solve, update, workspace_len};
