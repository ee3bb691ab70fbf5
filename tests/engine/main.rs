//! Methods, plans, formulas, searches and samples of the engine.

mod analyses;
mod analysis;
mod any_size;
mod auto;
mod auto_cost;
mod blocks;
mod capability;
mod control;
mod derivatives;
mod discrete;
mod extremes;
mod formulas;
mod implicit;
mod intervals;
mod law_quantiles;
mod law_studies;
mod measured_yields;
mod methods;
mod plans;
mod proofs;
mod quadratures;
mod response_surface;
mod settled;
mod simulation;
mod student;
mod yields;
