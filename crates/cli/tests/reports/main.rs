//! Commands on studies of every kind, and their reports.

#[path = "../support/command.rs"]
#[allow(dead_code, reason = "each test binary uses a part of it")]
mod command;
mod driven;
mod elements;
mod geometry;
mod html;
mod inspection;
mod joint;
mod picture;
mod reports;
mod stack;
mod units;
