//! `[published]`: speeds as a paper prints them, instead of records.

use serde::Serialize;

use crate::campaign::keys::keys;

keys! {
    /// `[published]`: a table of published approach speeds, and values of β that it is tested against.
    #[derive(PartialEq, Serialize)]
    pub struct Published {
        /// a CSV table, relative to the folder of campaign.toml; required
        speeds: String;
        /// values of β that were printed with the speeds
        #[serde(default)]
        damping_ratio_hypotheses: Vec<f64>;
    }
}
