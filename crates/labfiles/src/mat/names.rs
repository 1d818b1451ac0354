//! Names of arrays: their paths, subscripts, fields and classes.

/// The way that leads to an array.
#[derive(Debug, Clone)]
pub struct Path {
    /// From the top of the file, e.g. `runs(2).x`.
    pub name: String,
    /// Inside the element of the variable, e.g. `.x`.
    pub tail: String,
    /// The element of the variable, where it has several.
    pub element: Option<u64>,
    /// How deep it is nested.
    pub depth: usize,
}

impl Path {
    /// One step further.
    pub fn child(&self, suffix: &str) -> Self {
        let tail = format!("{}{suffix}", self.tail);
        let name = format!("{}{suffix}", self.name);
        Self {
            name,
            tail,
            depth: self.depth + 1,
            ..*self
        }
    }

    /// The path inside the element; the whole path where there is none.
    pub fn leaf_tail(&self) -> String {
        let tail = self.tail.trim_start_matches('.');
        if tail.is_empty() {
            self.name.clone()
        } else {
            tail.to_owned()
        }
    }
}

/// `(2)` or `{2}` for a vector, `(2,1)` or `{2,1}` otherwise; counts from 1 as MATLAB does.
pub fn subscript(dims: &[u64], mut index: u64, [open, close]: [char; 2]) -> String {
    if dims.iter().filter(|&&d| d != 1).count() <= 1 {
        return format!("{open}{}{close}", index + 1);
    }
    let mut parts = Vec::new();
    for &dim in dims {
        parts.push((index % dim.max(1) + 1).to_string());
        index /= dim.max(1);
    }
    format!("{open}{}{close}", parts.join(","))
}

/// Field names of fixed width; a name that stands again gets `_1_`, `_2_` before it.
pub fn field_names(bytes: &[u8], width: usize) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    let mut seen = std::collections::HashMap::new();
    for field in bytes.chunks_exact(width.max(1)) {
        let end = field.iter().position(|&b| b == 0).unwrap_or(width);
        let name = crate::bytes::decode_text(&field[..end]).into_owned();
        let times: &mut u32 = seen.entry(name.clone()).or_default();
        names.push(if *times == 0 {
            name
        } else {
            format!("_{times}_{name}")
        });
        *times += 1;
    }
    names
}

/// The name of an array class.
pub fn class_name(class: u8) -> &'static str {
    match class {
        4 => "char",
        6 => "double",
        7 => "single",
        8 => "int8",
        9 => "uint8",
        10 => "int16",
        11 => "uint16",
        12 => "int32",
        13 => "uint32",
        14 => "int64",
        _ => "uint64",
    }
}
