//! The measured column: least squares (`fit`) and, on top of it, power laws on ladders of measurements (`window`).
pub mod fit;
pub mod window;
