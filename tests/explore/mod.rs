//! The explorer: its protocol, its defences, its campaign, and the page in a browser.

mod browser;
mod browser_files;
mod browser_life;
mod browser_looks;
mod browser_maps;
mod browser_menu;
mod browser_run;
mod browser_sizes;
mod browser_values;
mod campaign;
pub(crate) mod chromium;
mod defences;
mod patience;
mod protocol;
pub(crate) mod server;
