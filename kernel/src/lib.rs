//! Fair curves for people who make things: the kernel of minvar.
//!
//! A designer gives points and, where it matters, tangents and curvatures; minvar gives the shape whose curvature
//! *changes* as little as possible: circles where the data allow them, otherwise the smoothest way through. The
//! sources are H. P. Moreton's thesis (Berkeley 1992, "the thesis" in these pages), Moreton and Séquin's paper
//! (SIGGRAPH 1992, "the paper") and L. Fang's thesis (MIT 1994, "Fang").
//!
//! This crate is `no_std`, never allocates and forbids unsafe code. It computes with `+ − × ÷ √` and the `libm` crate
//! alone, in a fixed order, so that results have the same bits on every target with IEEE 754 doubles. Lengths are in
//! the caller's unit, curvatures in 1/length, angles in radians; a tolerance is a length.
//!
//! # Layers
//!
//! Each uses those above it and none below. All are public.
//!
//! ## `basis`
//!
//! Polynomials on [0, 1]: [Gauss–Lobatto and Gauss–Legendre rules](basis::quadrature) of up to 32 points, the
//! [quintic Hermite basis](basis::hermite), [Bernstein polynomials](basis::bernstein) with their roots.
//!
//! ## `solve`
//!
//! [Minimising a sum of elements](solve) over blocks of unknowns on manifolds: ordering, envelope Cholesky, trust
//! region, relaxation, report. The one solver of everything that is minimised here.
//!
//! ## `curve`
//!
//! [Minimum variation curves](curve): joints and elements, functionals, start values, solving, measuring, converting.
//!
//! ## `toolpath`
//!
//! [Paths for machines](toolpath): chords, biarcs within a proven tolerance, G-code.
//!
//! # Memory
//!
//! The caller's. Solvers come as three calls: how much, here it is, solve. Too little is an error that says how much is
//! needed. Any number of threads may solve at once, each in its own memory.
//!
//! # No panic
//!
//! Built for release, no function of the C library can panic, abort or allocate, whatever numbers, sizes and codes it is
//! given: a library in which a panic were reachable would not link (`make no-panic`). The same code serves Rust; what can
//! panic here is what the caller brings: an [`Executor`](solve::Executor), an [`Observer`](solve::Observer), a
//! [`Problem`](solve::Problem), a writer. An index that were out of range, a defect of this crate, is found where debug
//! assertions are on, as in all tests; in a release build it reads as zero and writes nothing.
//!
//! # Status is not error
//!
//! An error means that nothing was computed: bad input, found before any work. A [status](solve::Status) tells how a
//! computation ended.

#![no_std]
#![forbid(unsafe_code)]

pub mod basis;
pub mod curve;
mod order;
mod root;
pub mod solve;
pub mod toolpath;
mod total;
