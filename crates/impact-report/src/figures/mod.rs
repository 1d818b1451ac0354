//! The figures, one file each: its drawing, its data as CSV, its points for hovering.

pub(super) mod boundaries;
pub(super) mod boundary_fit;
pub(super) mod comparison;
pub(super) mod correlation;
pub(super) mod decays;
pub(super) mod estimates;
pub(super) mod impacts;
pub(super) mod map;
pub mod plane;
pub(super) mod profiles;
pub mod regions;
pub(super) mod residuals;
pub(super) mod resonance;
pub(super) mod trend;

use rayon::prelude::*;

use crate::content::ReportContent;
use crate::kit::figure::{Figure, numbered};
use crate::locale::Locale;
use impact_fit::Method;
use impact_fit::methods::answer::found_by;

/// A figure waiting to be drawn.
type Job<'a> = Box<dyn Fn() -> Option<Figure> + Send + Sync + 'a>;

/// Draws all figures that the content allows, side by side on all cores, in a fixed order.
pub(crate) fn draw_all(content: &ReportContent, locale: Locale<'_>) -> Vec<Figure> {
    jobs(content, locale)
        .par_iter()
        // a map takes as long as ten small figures
        .with_max_len(1)
        .filter_map(|job| job())
        .collect()
}

fn jobs<'a>(content: &'a ReportContent, locale: Locale<'a>) -> Vec<Job<'a>> {
    let mut jobs: Vec<Job<'a>> = vec![
        Box::new(move || map::draw(content, map::MapSize::Full, locale)),
        Box::new(move || map::draw(content, map::MapSize::Small, locale)),
    ];
    for comparison in &content.compared.comparisons {
        jobs.push(Box::new(move || comparison::draw(comparison, locale)));
    }
    jobs.push(Box::new(move || estimates::draw(content, locale)));
    jobs.push(Box::new(move || {
        boundary_fit::draw(&content.compared.brackets, locale)
    }));
    jobs.push(Box::new(move || {
        profiles::draw(&content.identification, locale)
    }));
    if let Some(correlation) = &content.compared.correlation {
        jobs.push(Box::new(move || correlation::draw(correlation, locale)));
    }
    method_jobs(content, locale, &mut jobs);
    jobs
}

/// Figures of which there may be several.
fn method_jobs<'a>(content: &'a ReportContent, locale: Locale<'a>, jobs: &mut Vec<Job<'a>>) {
    for (i, scatter) in content.compared.impacts.iter().enumerate() {
        jobs.push(Box::new(move || {
            impacts::draw(scatter, &numbered("impacts", i), locale)
        }));
    }
    let method = found_by(&content.identification.methods, Method::observes_response);
    let fits = method.and_then(|m| m.fits);
    for (i, curve) in content.compared.resonance.iter().enumerate() {
        jobs.push(Box::new(move || {
            resonance::draw((curve, fits), &numbered("resonance", i), locale)
        }));
    }
    for (i, few) in content
        .compared
        .free_decays
        .chunks(decays::PER_FIGURE)
        .enumerate()
    {
        jobs.push(Box::new(move || {
            decays::draw(few, &numbered("free_decays", i), locale)
        }));
    }
    for (i, set) in content.compared.residuals.iter().enumerate() {
        jobs.push(Box::new(move || {
            residuals::draw(set, &numbered("residuals", i), locale)
        }));
    }
}
