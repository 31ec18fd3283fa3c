//! What minvar is checked against: the thesis's Appendix A as data, an independent reference solver built on Ceres, and
//! true planar curves in arc length.

pub mod appendix;
pub mod bench;
pub mod ceres;
pub mod compare;
pub mod cross;
pub mod curves;
pub mod figures;
pub mod interface;
pub mod iterations;
pub mod kinds;
pub mod paths;
pub mod random;
pub mod solving;
pub mod stack;
pub mod toolchain;
pub mod truth;
pub mod valley;
