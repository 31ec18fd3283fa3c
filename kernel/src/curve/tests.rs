//! What the tests of a curve's parts begin with: the model of a curve in its place, and the start of its state.

extern crate std;

use super::fairness::{Density, Shape};
use super::joint::Curve;
use super::model::{Division, Model};
use super::options::Options;
use super::placement::Place;
use super::solve::model;
use super::start::Start;
use crate::solve::Problem;
use std::vec;
use std::vec::Vec;

/// The model of a curve whose data lie in a plane.
pub(super) fn planar<'a>(curve: &Curve<'a>, options: &Options) -> Model<'a, 2> {
    let Ok(Place::Plane(place)) = Place::of(curve, 1.0, 0) else { panic!("planar data") };
    model(curve, options, &place)
}

/// The model of a curve whose data do not.
pub(super) fn spatial<'a>(curve: &Curve<'a>, options: &Options) -> Model<'a, 3> {
    let Ok(Place::Space(place)) = Place::of(curve, 1.0, 0) else { panic!("data in space") };
    model(curve, options, &place)
}

/// The state that a solve begins with. Of a model with marked divisions there is none.
pub(super) fn started<const D: usize>(model: &Model<'_, D>) -> Vec<f64>
where
    Shape<D>: Density<D>,
{
    let Division::Even(parts) = model.division else { panic!("even divisions") };
    let mut state = vec![f64::NAN; model.state_len()];
    assert!(Start { model, place: &model.place, parts, turned: None }.fill(&mut state).is_ok());
    state
}
