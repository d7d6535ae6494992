//! The measured column.
