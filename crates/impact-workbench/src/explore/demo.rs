//! Demos: text files of steps, each what the state changes to, with how long it is shown.
//!
//! A step states only what differs from the step before it; the first one differs from
//! [`State::default`]. `expect` is the motion at the cursor, which `impactid explore --check` verifies.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::ExploreError;
use super::state::{State, VERSION};

/// A demo that comes with the program: its name, its first character the key, and its text.
macro_rules! shipped {
    ($name:literal, $file:literal) => {
        ($name, include_str!(concat!("demos/", $file, ".toml")))
    };
}

/// The demos that come with the program.
const SHIPPED: [(&str, &str); 10] = [
    shipped!("0 Regions of all motions", "0-regions"),
    shipped!("1 Plastic impacts (Fig. 2)", "1-fig2"),
    shipped!("2 Characteristics along line q (Fig. 4)", "2-fig4"),
    shipped!("3 Basins of attraction (Fig. 5)", "3-fig5"),
    shipped!("4 A road into chaos (Fig. 7(b))", "4-fig7b"),
    shipped!("5 Boundaries of chaos (Fig. 8)", "5-fig8"),
    shipped!("6 Points A to H (Figs. 11 to 13)", "6-points"),
    shipped!("7 Hysteresis carried by hand", "7-hysteresis"),
    shipped!("8 Asymmetric masses (Fig. 6)", "8-fig6"),
    shipped!("9 Restitution that depends on the speed", "9-law"),
];

/// A demo.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Demo {
    pub title: String,
    /// Its steps, each with what is shown.
    pub steps: Vec<(Step, State)>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    version: u32,
    title: String,
    step: Vec<Step>,
}

/// A step of a demo.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Step {
    /// How long it is shown, s.
    pub seconds: f64,
    /// What it shows.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub caption: String,
    /// Whether the motion of the step before is carried along.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub carry: bool,
    /// The label that the motion at the cursor must have.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub expect: Option<String>,
    /// What differs from the step before.
    #[serde(default, skip_serializing_if = "Map::is_empty")]
    state: Map<String, Value>,
}

/// Longest time that a step may be shown, s.
const LONGEST_S: f64 = 600.0;
/// Most steps of a demo.
const MOST_STEPS: usize = 2000;

impl Demo {
    /// Read a demo from its text.
    ///
    /// # Errors
    /// [`ExploreError`] where it is malformed, of another version, or shows what is out of range.
    pub(super) fn read(text: &str) -> Result<Self, ExploreError> {
        let malformed = |reason: String| ExploreError::malformed("demo", reason);
        let written: Written = toml::from_str(text).map_err(|e| malformed(e.to_string()))?;
        if written.version != VERSION {
            return Err(ExploreError::Version {
                found: written.version.to_string(),
                expected: VERSION,
            });
        }
        if written.step.len() > MOST_STEPS {
            return Err(malformed(format!("more than {MOST_STEPS} steps")));
        }
        let mut state = value_of(&State::default())?;
        let mut steps = Vec::with_capacity(written.step.len());
        for (number, step) in written.step.into_iter().enumerate() {
            if !(0.0..=LONGEST_S).contains(&step.seconds) {
                let reason = format!("step {}: seconds must be 0 to 600", number + 1);
                return Err(malformed(reason));
            }
            merge(&mut state, Value::Object(step.state.clone()));
            let shown = State::read(state.clone())
                .map_err(|e| malformed(format!("step {}: {e}", number + 1)))?;
            steps.push((step, shown));
        }
        Ok(Self {
            title: written.title,
            steps,
        })
    }
}

/// Names of the demos that come with the program, in the order of their keys.
pub(super) fn list() -> Vec<&'static str> {
    SHIPPED.iter().map(|d| d.0).collect()
}

/// A demo that comes with the program.
///
/// # Errors
/// [`ExploreError::Absent`] where there is none of the name.
pub(super) fn shipped(name: &str) -> Result<Demo, ExploreError> {
    let found = SHIPPED.iter().find(|d| d.0 == name);
    let found = found.ok_or_else(|| ExploreError::Absent(format!("there is no demo “{name}”")))?;
    Demo::read(found.1)
}

/// The text of a recorded demo: each step as what differs from the one before.
///
/// # Errors
/// [`ExploreError`] where a state cannot be read.
pub(super) fn write(title: &str, steps: &[(f64, Value)]) -> Result<String, ExploreError> {
    let mut before = value_of(&State::default())?;
    let mut written = Vec::with_capacity(steps.len());
    for (seconds, state) in steps {
        let now = value_of(&State::read(state.clone())?)?;
        written.push(Step {
            seconds: *seconds,
            caption: String::new(),
            carry: false,
            expect: None,
            state: match difference(&before, &now) {
                Some(Value::Object(changed)) => changed,
                _ => Map::new(),
            },
        });
        before = now;
    }
    let demo = Written {
        version: VERSION,
        title: title.to_owned(),
        step: written,
    };
    toml::to_string(&demo).map_err(|e| ExploreError::malformed("demo", e))
}

fn value_of(state: &State) -> Result<Value, ExploreError> {
    serde_json::to_value(state).map_err(|e| ExploreError::malformed("state", e))
}

/// Keys that hold one of several forms, which replace each other as a whole.
const WHOLE: [&str; 3] = ["restitution", "line", "basins"];

/// Put what a step states over the state before it; the text "none" takes an optional key away.
fn merge(state: &mut Value, changed: Value) {
    let (Value::Object(state), Value::Object(changed)) = (state, changed) else {
        return;
    };
    for (key, value) in changed {
        match state.get_mut(&key) {
            _ if value == "none" => {
                state.remove(&key);
            }
            Some(old) if old.is_object() && value.is_object() && !WHOLE.contains(&key.as_str()) => {
                merge(old, value);
            }
            _ => {
                state.insert(key, value);
            }
        }
    }
}

/// What [`merge`] needs to make `after` of `before`; `None`: nothing.
fn difference(before: &Value, after: &Value) -> Option<Value> {
    let (Value::Object(old), Value::Object(new)) = (before, after) else {
        return (before != after).then(|| after.clone());
    };
    let mut changed = Map::new();
    for (key, value) in new.iter().filter(|(_, v)| !v.is_null()) {
        let Some(then) = old.get(key).filter(|v| !v.is_null()) else {
            changed.insert(key.clone(), value.clone());
            continue;
        };
        if WHOLE.contains(&key.as_str()) {
            if then != value {
                changed.insert(key.clone(), value.clone());
            }
        } else if let Some(part) = difference(then, value) {
            changed.insert(key.clone(), part);
        }
    }
    for (key, _) in old.iter().filter(|(_, v)| !v.is_null()) {
        if new.get(key).is_none_or(Value::is_null) {
            changed.insert(key.clone(), "none".into());
        }
    }
    (!changed.is_empty()).then_some(Value::Object(changed))
}
