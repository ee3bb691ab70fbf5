//! Published models.

mod models;
