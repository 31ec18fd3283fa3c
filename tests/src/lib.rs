//! What minvar is checked against: the thesis's Appendix A as data and an independent reference solver built on Ceres.

pub mod appendix;
pub mod ceres;
pub mod compare;
pub mod curves;
pub mod paths;
pub mod toolchain;
