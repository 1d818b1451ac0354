//! Names of arrays: their paths, subscripts, fields and classes.

/// The way that leads to an array.
#[derive(Debug, Clone)]
pub(crate) struct Path {
    /// From the top of the file, e.g. `runs(2).x`.
    pub name: String,
    /// Inside the element of the variable, e.g. `.x`.
    pub tail: String,
    /// The element of the variable, if it has several.
    pub element: Option<u64>,
    /// How deep it is nested.
    pub depth: usize,
}

impl Path {
    /// The path of a variable.
    pub(crate) fn to(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            tail: String::new(),
            element: None,
            depth: 0,
        }
    }

    /// The path to an element of a container of `count`; a single one is the container itself.
    pub(crate) fn element(
        &self,
        index: u64,
        count: u64,
        dims: &[u64],
        brackets: [char; 2],
    ) -> Self {
        if count == 1 {
            return Self {
                depth: self.depth + 1,
                ..self.clone()
            };
        }
        let child = self.child(&subscript(dims, index, brackets));
        match self.depth {
            0 => Self {
                element: Some(index),
                tail: String::new(),
                ..child
            },
            _ => child,
        }
    }

    /// One step further.
    pub(crate) fn child(&self, suffix: &str) -> Self {
        let tail = format!("{}{suffix}", self.tail);
        let name = format!("{}{suffix}", self.name);
        Self {
            name,
            tail,
            depth: self.depth + 1,
            ..*self
        }
    }

    /// The path inside the element; the whole path if there is none.
    pub(crate) fn leaf_tail(&self) -> String {
        let tail = self.tail.trim_start_matches('.');
        if tail.is_empty() {
            self.name.clone()
        } else {
            tail.to_owned()
        }
    }
}

/// `(2)` or `{2}` for a vector, `(2,1)` or `{2,1}` otherwise; counts from 1 as MATLAB does.
pub(crate) fn subscript(dims: &[u64], mut index: u64, [open, close]: [char; 2]) -> String {
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

/// Field names of fixed width; a name that comes again gets `_1_`, `_2_` before it.
pub(crate) fn field_names(bytes: &[u8], width: usize) -> Vec<String> {
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
pub(crate) fn class_name(class: u8) -> &'static str {
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
