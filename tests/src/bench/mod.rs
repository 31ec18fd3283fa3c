//! minvar against its peers, in one run and as ratios: what `make bench` measures, and how it is kept honest.
//!
//! Peers are programs of their own (`tests/peers`, C++), so that the tests need none of the libraries. They answer
//! commands, and so take turns with minvar: in every round each contender repeats its work for some milliseconds right
//! after minvar did, and a ratio is the median over the rounds of the ratios within a round. What else the machine does
//! then touches both sides alike.
//!
//! *Done* is the same for all who minimise the same sums: a functional within a millionth of the least that is known.

pub mod least_squares;
pub mod opencascade;
pub mod ours;
pub mod own;
pub mod peer;
pub mod record;
pub mod rounds;
pub mod spiro;
pub mod task;

/// Done is a functional that exceeds the least known by no more than this fraction.
pub const WITHIN: f64 = 1e-6;
