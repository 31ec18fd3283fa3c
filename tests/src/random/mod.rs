//! Random curve problems, and a judge who believes nothing that the kernel says of itself.
//!
//! ```text
//! dice → samples (a family of shapes) → problem (what is given where, and where it lies) → solve → judge → table
//! ```
//!
//! A problem is named by a seed and a number, and is the same everywhere. [`judge`] looks at one result by itself,
//! [`invariance`] at the results of the same problem moved, scaled, turned and reversed, [`truth`] at those that did not
//! converge; what they find are [`finding`]s, which [`table`] adds up and [`mvc`] writes down as constraint files.
//! [`peers`] gives the same problems to other programs. `make random` runs it all.

pub mod dice;
pub mod finding;
pub mod invariance;
pub mod judge;
pub mod measured;
pub mod mvc;
pub mod peers;
pub mod problem;
pub mod run;
pub mod samples;
pub mod similarity;
pub mod table;
pub mod truth;
