//! The chains of `NI_Scale[k]_…` properties that turn raw samples into physical values.
//!
//! Linear, polynomial and table scales are done; any other kind is refused by its name.

use std::collections::BTreeMap;

use super::value::Value;

/// Input of a scale that is the channel's raw data itself.
const RAW: u32 = u32::MAX;
/// Longest chain, table or polynomial that is accepted.
const LONGEST: u32 = 1 << 16;

/// One step of a chain.
#[derive(Debug, Clone, PartialEq)]
enum Step {
    /// y = slope x + intercept.
    Linear { slope: f64, intercept: f64 },
    /// y = c0 + c1 x + c2 x² + …
    Polynomial(Vec<f64>),
    /// Straight lines between points, constant beyond the ends; the inputs increase.
    Table { inputs: Vec<f64>, outputs: Vec<f64> },
}

impl Step {
    fn apply(&self, values: &mut [f64]) {
        match self {
            Self::Linear { slope, intercept } => {
                values.iter_mut().for_each(|v| *v = *v * slope + intercept);
            }
            Self::Polynomial(coefficients) => values.iter_mut().for_each(|v| {
                let x = *v;
                let horner = coefficients
                    .iter()
                    .rev()
                    .copied()
                    .reduce(|all, c| all * x + c);
                *v = horner.unwrap_or(0.0);
            }),
            Self::Table { inputs, outputs } => {
                values
                    .iter_mut()
                    .for_each(|v| *v = interpolate(*v, inputs, outputs));
            }
        }
    }
}

fn interpolate(x: f64, inputs: &[f64], outputs: &[f64]) -> f64 {
    let above = inputs.partition_point(|&input| input <= x);
    let last = inputs.len() - 1;
    match above {
        _ if x.is_nan() => x,
        0 => outputs[0],
        _ if above > last => outputs[last],
        _ => {
            let (x0, x1) = (inputs[above - 1], inputs[above]);
            let (y0, y1) = (outputs[above - 1], outputs[above]);
            y0 + (y1 - y0) / (x1 - x0) * (x - x0)
        }
    }
}

/// Why the scaling that properties describe is not done.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub(super) enum ScalingFault {
    #[error("{0} scaling")]
    Unread(String),
    #[error("a scale without {0}")]
    Missing(String),
    #[error("scale {scale} that takes its input from scale {source_scale}")]
    Input { scale: u32, source_scale: u32 },
    #[error("a table of {0} and {1} values")]
    TableLengths(usize, usize),
    #[error("a table whose inputs neither rise nor fall throughout")]
    TableOrder,
}

/// The scaling of a channel.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Scaling {
    /// Which scaler of a `DAQmx` channel gives the raw samples; `None`: the only data there are.
    pub scaler: Option<u32>,
    steps: Vec<Step>,
}

impl Scaling {
    /// Whether the samples are changed.
    pub(super) fn changes(&self) -> bool {
        !self.steps.is_empty()
    }

    /// Turn raw samples into physical values.
    pub(super) fn apply(&self, values: &mut [f64]) {
        self.steps.iter().for_each(|step| step.apply(values));
    }

    /// The scaling that the properties of one object describe, where they describe one.
    pub(super) fn of(properties: &BTreeMap<String, Value>) -> Option<Result<Self, ScalingFault>> {
        let count = number_of_scales(properties);
        let done = properties
            .get("NI_Scaling_Status")
            .is_some_and(|s| s.text() == "scaled");
        (count > 0 && !done).then(|| chain(properties, count))
    }
}

/// A number that counts something, at most `most`; 0 for one below and for NaN.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped"
)]
fn whole(number: f64, most: u32) -> u32 {
    number.clamp(0.0, f64::from(most)) as u32
}

fn number_of_scales(properties: &BTreeMap<String, Value>) -> u32 {
    if let Some(count) = properties
        .get("NI_Number_Of_Scales")
        .and_then(Value::number)
    {
        return whole(count, LONGEST);
    }
    let index = |key: &str| -> Option<u32> {
        key.strip_prefix("NI_Scale[")?
            .strip_suffix("]_Scale_Type")?
            .parse()
            .ok()
    };
    properties
        .keys()
        .filter_map(|key| index(key))
        .max()
        .map_or(0, |k| k.saturating_add(1).min(LONGEST))
}

/// Follow the chain from the last scale back to the raw samples.
fn chain(properties: &BTreeMap<String, Value>, count: u32) -> Result<Scaling, ScalingFault> {
    let mut steps = Vec::new();
    let (mut scale, mut scaler) = (count - 1, None);
    loop {
        let Some(kind) = properties.get(&format!("NI_Scale[{scale}]_Scale_Type")) else {
            // A scale without a type is the DAQmx scaler of that number.
            scaler = Some(scale);
            break;
        };
        let reader = Reader {
            properties,
            scale,
            kind: kind.text(),
        };
        if let Some(step) = reader.step()? {
            steps.push(step);
        }
        match reader
            .optional("Input_Source")
            .map_or(RAW, |source| whole(source, RAW))
        {
            RAW => break,
            next if next < scale => scale = next,
            source_scale => {
                return Err(ScalingFault::Input {
                    scale,
                    source_scale,
                });
            }
        }
    }
    steps.reverse();
    Ok(Scaling { scaler, steps })
}

struct Reader<'a> {
    properties: &'a BTreeMap<String, Value>,
    scale: u32,
    kind: String,
}

impl Reader<'_> {
    fn key(&self, name: &str) -> String {
        format!("NI_Scale[{}]_{}_{name}", self.scale, self.kind)
    }

    fn optional(&self, name: &str) -> Option<f64> {
        self.properties.get(&self.key(name)).and_then(Value::number)
    }

    fn number(&self, name: &str) -> Result<f64, ScalingFault> {
        self.optional(name)
            .ok_or_else(|| ScalingFault::Missing(self.key(name)))
    }

    fn list(&self, name: &str, default: Option<f64>) -> Result<Vec<f64>, ScalingFault> {
        let size = format!("{name}_Size");
        let size = match default {
            Some(default) => self.optional(&size).unwrap_or(default),
            None => self.number(&size)?,
        };
        (0..whole(size, LONGEST))
            .map(|index| self.number(&format!("{name}[{index}]")))
            .collect()
    }

    fn step(&self) -> Result<Option<Step>, ScalingFault> {
        Ok(Some(match self.kind.as_str() {
            "Linear" => Step::Linear {
                slope: self.number("Slope")?,
                intercept: self.number("Y_Intercept")?,
            },
            "Polynomial" => Step::Polynomial(self.list("Coefficients", Some(4.0))?),
            "Table" => self.table()?,
            "AdvancedAPI" => return Ok(None),
            other => return Err(ScalingFault::Unread(other.to_owned())),
        }))
    }

    fn table(&self) -> Result<Step, ScalingFault> {
        let mut inputs = self.list("Pre_Scaled_Values", None)?;
        let mut outputs = self.list("Scaled_Values", None)?;
        if inputs.len() != outputs.len() || inputs.is_empty() {
            return Err(ScalingFault::TableLengths(inputs.len(), outputs.len()));
        }
        if inputs.windows(2).all(|pair| pair[0] > pair[1]) {
            inputs.reverse();
            outputs.reverse();
        }
        if inputs.windows(2).all(|pair| pair[0] < pair[1]) {
            Ok(Step::Table { inputs, outputs })
        } else {
            Err(ScalingFault::TableOrder)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn properties(pairs: &[(&str, f64)], kinds: &[&str]) -> BTreeMap<String, Value> {
        let mut all: BTreeMap<String, Value> = pairs
            .iter()
            .map(|&(key, value)| {
                (
                    format!("NI_Scale[{key}"),
                    Value::Number(value, String::new()),
                )
            })
            .collect();
        for (index, kind) in kinds
            .iter()
            .enumerate()
            .filter(|(_, kind)| !kind.is_empty())
        {
            all.insert(
                format!("NI_Scale[{index}]_Scale_Type"),
                Value::Text((*kind).to_owned()),
            );
        }
        all
    }

    fn scaled(all: &BTreeMap<String, Value>, mut values: Vec<f64>) -> Vec<f64> {
        Scaling::of(all).unwrap().unwrap().apply(&mut values);
        values
    }

    #[test]
    fn chain_of_polynomial_and_linear() {
        let all = properties(
            &[
                ("0]_Polynomial_Coefficients_Size", 3.0),
                ("0]_Polynomial_Coefficients[0]", 1.0),
                ("0]_Polynomial_Coefficients[1]", 2.0),
                ("0]_Polynomial_Coefficients[2]", 3.0),
                ("1]_Linear_Slope", 10.0),
                ("1]_Linear_Y_Intercept", -1.0),
                ("1]_Linear_Input_Source", 0.0),
            ],
            &["Polynomial", "Linear"],
        );
        assert_eq!(scaled(&all, vec![0.0, 2.0]), [9.0, 169.0]);
    }

    #[test]
    fn table_rises_or_falls_and_ends_constant() {
        let table = |inputs: [f64; 3]| {
            let mut pairs = vec![
                ("0]_Table_Pre_Scaled_Values_Size", 3.0),
                ("0]_Table_Scaled_Values_Size", 3.0),
            ];
            let names = [
                ("0]_Table_Pre_Scaled_Values[0]", "0]_Table_Scaled_Values[0]"),
                ("0]_Table_Pre_Scaled_Values[1]", "0]_Table_Scaled_Values[1]"),
                ("0]_Table_Pre_Scaled_Values[2]", "0]_Table_Scaled_Values[2]"),
            ];
            for ((pre, post), (x, y)) in names
                .into_iter()
                .zip(inputs.into_iter().zip([10.0, 20.0, 40.0]))
            {
                pairs.extend([(pre, x), (post, y)]);
            }
            properties(&pairs, &["Table"])
        };
        assert_eq!(
            scaled(&table([0.0, 1.0, 2.0]), vec![-1.0, 0.5, 1.0, 1.5, 9.0]),
            [10.0, 15.0, 20.0, 30.0, 40.0]
        );
        assert_eq!(scaled(&table([2.0, 1.0, 0.0]), vec![0.5]), [30.0]);
        assert!(Scaling::of(&table([0.0, 0.0, 1.0])).unwrap().is_err());
    }

    #[test]
    fn other_scales_are_refused_by_name() {
        let error = Scaling::of(&properties(&[], &["Thermocouple"]))
            .unwrap()
            .unwrap_err();
        assert_eq!(error.to_string(), "Thermocouple scaling");
        let error = Scaling::of(&properties(&[], &["Linear"]))
            .unwrap()
            .unwrap_err();
        assert!(
            error.to_string().contains("NI_Scale[0]_Linear_Slope"),
            "{error}"
        );
        let endless = [
            ("0]_Linear_Slope", 1.0),
            ("0]_Linear_Y_Intercept", 1.0),
            ("0]_Linear_Input_Source", 0.0),
        ];
        assert!(
            Scaling::of(&properties(&endless, &["Linear"]))
                .unwrap()
                .is_err()
        );
    }
}
