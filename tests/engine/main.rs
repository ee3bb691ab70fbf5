//! Methods, plans, formulas, searches and samples of the engine.

mod analyses;
mod analysis;
mod auto;
mod auto_cost;
mod blocks;
mod capability;
mod control;
mod derivatives;
mod extremes;
mod formulas;
mod implicit;
mod intervals;
mod law_quantiles;
mod methods;
mod plans;
mod quadratures;
mod response_surface;
mod simulation;
mod student;
mod yields;
