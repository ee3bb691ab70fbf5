//! Allocation of tolerances.

mod allocation;
mod allocation_costs;
mod allocation_lists;
mod allocation_made;
mod allocation_optima;
mod allocation_oracles;
mod generated_lists;
