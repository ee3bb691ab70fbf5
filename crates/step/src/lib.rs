//! STEP files: a reader of Part 21, and the tolerances, datums, sizes and faces of AP242.
//!
//! [`part21`] reads entities and has no notion of tolerances. [`semantic`] finds what a designer wrote: geometric tolerances with their
//! datums, dimensions with their limits, the faces on which they are, and the placed parts of an assembly. [`tables`] writes them as tables of a study.
//!
//! # Source
//! ISO 10303-21:2016 (clear text), ISO 10303-242 (entities), and the recommended practices of the CAx Interoperability Forum for
//! representation of PMI.

pub mod part21;
pub mod semantic;
pub mod tables;
