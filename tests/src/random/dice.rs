//! Random numbers that are the same everywhere: ChaCha8 below, `libm` above.

use crate::curves::{Vector, cross, dot, sub, times, unit};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{RngCore, SeedableRng};
use std::f64::consts::{PI, TAU};

/// A stream of random choices.
#[derive(Clone, Debug)]
pub struct Dice(ChaCha8Rng);

impl Dice {
    /// The stream of one problem: no other problem's draws change it.
    pub fn new(seed: u64, stream: u64) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        generator.set_stream(stream);
        Self(generator)
    }

    /// From 0 to below 1.
    pub fn unit(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Evenly between two numbers.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// From `-most` to `most`.
    pub fn within(&mut self, most: f64) -> f64 {
        self.between(-most, most)
    }

    /// Between two positive numbers, every factor as likely as any other.
    pub fn factor(&mut self, low: f64, high: f64) -> f64 {
        libm::exp(self.between(libm::log(low), libm::log(high)))
    }

    /// From 0 to below `count`.
    pub fn below(&mut self, count: usize) -> usize {
        (self.unit() * count as f64) as usize
    }

    /// From `low` to `high`, both included.
    pub fn count(&mut self, low: usize, high: usize) -> usize {
        low + self.below(high - low + 1)
    }

    /// True with this probability.
    pub fn chance(&mut self, probability: f64) -> bool {
        self.unit() < probability
    }

    /// A unit vector, any direction as likely as any other.
    pub fn direction(&mut self) -> Vector {
        let z = self.within(1.0);
        let (sin, cos) = libm::sincos(self.between(0.0, TAU));
        let r = (1.0 - z * z).sqrt();
        [r * cos, r * sin, z]
    }

    /// A unit vector perpendicular to another: in the plane one of two.
    pub fn across(&mut self, to: Vector, planar: bool) -> Vector {
        if planar {
            let side = if self.chance(0.5) { 1.0 } else { -1.0 };
            return unit(times([-to[1], to[0], 0.0], side));
        }
        loop {
            let any = self.direction();
            let across = sub(any, times(to, dot(any, to)));
            if dot(across, across) > 1e-4 {
                return unit(across);
            }
        }
    }

    /// A unit vector turned by an angle, in the plane z = 0 or about any axis across.
    pub fn turned(&mut self, vector: Vector, angle: f64, planar: bool) -> Vector {
        let axis = if planar { [0.0, 0.0, 1.0] } else { self.across(vector, false) };
        unit(rotated(vector, axis, angle))
    }

    /// An angle up to half a turn to either side.
    pub fn angle(&mut self) -> f64 {
        self.within(PI)
    }
}

/// A vector turned about a unit axis (Rodrigues).
pub fn rotated(v: Vector, axis: Vector, angle: f64) -> Vector {
    let (sin, cos) = libm::sincos(angle);
    let (lift, along) = (cross(axis, v), dot(axis, v) * (1.0 - cos));
    std::array::from_fn(|d| v[d] * cos + lift[d] * sin + axis[d] * along)
}
