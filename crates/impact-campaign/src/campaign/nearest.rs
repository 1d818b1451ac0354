//! The name that a misspelt one may mean.

/// The candidate nearest to a name, where one is near enough to be meant.
pub fn nearest<'a>(name: &str, candidates: &[&'a str]) -> Option<&'a str> {
    let limit = 1 + name.chars().count() / 3;
    let small = name.to_lowercase();
    candidates
        .iter()
        .map(|c| (strsim::levenshtein(&small, &c.to_lowercase()), *c))
        .filter(|(d, c)| *d <= limit || c.starts_with(name) || name.starts_with(c))
        .min_by_key(|(d, _)| *d)
        .map(|(_, c)| c)
}
