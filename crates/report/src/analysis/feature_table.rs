//! Table of contributions by feature and joint, for studies of assemblies in space.

use crate::Report;
use crate::assembly::{OwnerShare, owner_shares};
use crate::document::number::percent;
use crate::document::{Blocks, Cell, Columns, DataTable, Element, Section};
use sensitol::analysis::CharacteristicAnalysis;

/// Share of the variance below which a row is left out.
const SMALL: f64 = 5e-5;

/// Row of the table: a feature, a joint, or a dimension of one.
struct FeatureRow {
    name: String,
    kind: String,
    share: f64,
}

impl Report {
    /// Adds contributions by feature to a section, with the dimensions of each if everything is requested.
    pub(crate) fn features(&self, one: &CharacteristicAnalysis, section: &mut Section) {
        let Some(assembly) = &self.assembly else { return };
        let Some(shares) = owner_shares(assembly, one) else { return };
        let shown: Vec<&OwnerShare> = shares.iter().filter(|share| share.value.abs() >= SMALL).collect();
        let row = |share: &OwnerShare| FeatureRow {
            name: share.name.clone(),
            kind: share.kind(&assembly.scene),
            share: share.value,
        };
        let mut all = Vec::new();
        for share in &shown {
            all.push(row(share));
            let is_itself = matches!(&share.components[..], [(only, _)] if *only == share.name);
            let components = share.components.iter().filter(|(_, value)| !is_itself && value.abs() >= SMALL);
            all.extend(components.map(|(name, share)| FeatureRow {
                name: format!("  {name}"),
                kind: String::new(),
                share: *share,
            }));
        }
        // The short table of contributions groups the dimensions of an element already. Pages have the picture with its tables.
        section.detail(vec![Element::Gap, Element::Table(table(all).at_most([usize::MAX, 0], String::new()))]);
    }
}

fn table(rows: Vec<FeatureRow>) -> DataTable {
    Columns::default()
        .named("", "feature or joint", |row: &FeatureRow| Cell::text(&row.name))
        .shown("by feature", |row| Cell::text(&row.kind))
        .shown("contrib. %", |row| Cell::number(row.share, percent))
        .table("", rows)
}
