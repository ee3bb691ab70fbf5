//! Tests of published models.

mod models;
