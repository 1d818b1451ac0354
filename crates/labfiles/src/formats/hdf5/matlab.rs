//! MATLAB files of level 7.3: HDF5 with MATLAB's conventions. Their variables are arranged to
//! datasets and channels as those of the older levels are.
//!
//! An array is in the file with its dimensions reversed, so that its bytes are MATLAB's own
//! order, column by column. Structs are groups, cells and struct arrays are arrays of references.

pub(crate) mod values;

use crate::formats::hdf5::element::Element;
use crate::formats::hdf5::library::Store;
use crate::formats::hdf5::matlab::values::{content, little};
use crate::formats::hdf5::store::{
    Array, Attr, Attrs, DEEPEST, MOST_OBJECTS, StoreError, Target, Tree,
};
use crate::formats::mat::names::Path;
use crate::formats::mat::text;
use crate::formats::mat::tree::{Leaf, Tree as Variables, Variable};
use crate::numbers::ByteOrder;

/// Groups at the root that are MATLAB's own.
const OWN_GROUPS: [&str; 2] = ["#refs#", "#subsystem#"];

/// Whether a tree follows MATLAB's conventions.
pub(crate) fn is_matlab(tree: &Tree) -> bool {
    let classed = |attributes: &Attrs| attributes.contains_key("MATLAB_class");
    tree.arrays.iter().any(|a| classed(&a.attributes))
        || tree
            .groups
            .iter()
            .any(|g| classed(&g.attributes) || g.path == OWN_GROUPS[0])
}

/// The variables of a file, and the arrays to which the places of their leaves refer.
#[derive(Default)]
pub(crate) struct Found {
    /// As the older levels' readers find them.
    pub variables: Variables,
    /// The array of each leaf: [`Part::at`] counts them.
    pub arrays: Vec<Array>,
}

/// Find all variables.
///
/// # Errors
/// If references lead nowhere or too deep.
pub(crate) fn find(store: &Store, tree: &Tree) -> Result<Found, StoreError> {
    let mut walk = Walk {
        store,
        found: Found::default(),
        visited: 0,
    };
    for array in &tree.arrays {
        walk.variable(&array.name);
        walk.array(array, &Path::to(&array.name))?;
    }
    for group in tree
        .groups
        .iter()
        .filter(|g| !OWN_GROUPS.contains(&g.path.as_str()))
    {
        walk.variable(&group.path);
        walk.group(group, &Path::to(&group.path))?;
    }
    Ok(walk.found)
}

struct Walk<'a> {
    store: &'a Store,
    found: Found,
    visited: usize,
}

impl Walk<'_> {
    fn variable(&mut self, name: &str) {
        self.found.variables.variables.push(Variable {
            name: name.to_owned(),
            packed: None,
            order: ByteOrder::Little,
        });
    }

    fn current(&self) -> usize {
        self.found.variables.variables.len().saturating_sub(1)
    }

    fn leave_out(&mut self, path: &Path, kind: String) -> Result<(), StoreError> {
        let refused = &mut self.found.variables.refused;
        refused.push((path.name.clone(), kind));
        Ok(())
    }

    fn visit(&mut self, path: &Path) -> Result<(), StoreError> {
        self.visited += 1;
        if path.depth > DEEPEST || self.visited > MOST_OBJECTS {
            return Err(StoreError::TooManyValues(path.name.clone()));
        }
        Ok(())
    }

    /// A struct, a struct array, or a sparse matrix.
    fn group(&mut self, group: &Tree, path: &Path) -> Result<(), StoreError> {
        self.visit(path)?;
        if group.attributes.contains_key("MATLAB_sparse") {
            return self.leave_out(path, "sparse".to_owned());
        }
        let references =
            |a: &&Array| a.element == Element::Reference && class(&a.attributes).is_empty();
        let several: Vec<&Array> = group.arrays.iter().filter(references).collect();
        if let Some(first) = several.first()
            && several.len() == group.arrays.len()
        {
            return self.struct_array(&several, first, path);
        }
        for name in field_order(group) {
            if let Some(array) = group.arrays.iter().find(|a| a.name == name) {
                self.array(array, &path.child(&format!(".{name}")))?;
            } else if let Some(inner) = group.groups.iter().find(|g| last(&g.path) == name) {
                self.group(inner, &path.child(&format!(".{name}")))?;
            }
        }
        Ok(())
    }

    /// Fields that are arrays of references, one for each element.
    fn struct_array(
        &mut self,
        fields: &[&Array],
        first: &Array,
        path: &Path,
    ) -> Result<(), StoreError> {
        let dims = reversed(&first.shape);
        let mut columns = Vec::new();
        for field in fields {
            columns.push((&field.name, self.store.targets(field)?.into_iter()));
        }
        let count = columns.iter().map(|(_, t)| t.len()).max().unwrap_or(0);
        for index in 0..count {
            let element = path.element(index as u64, count as u64, &dims, ['(', ')']);
            for (name, targets) in &mut columns {
                if let Some(Some(target)) = targets.next() {
                    self.target(target, &element.child(&format!(".{name}")))?;
                }
            }
        }
        Ok(())
    }

    fn target(&mut self, target: Target, path: &Path) -> Result<(), StoreError> {
        match target {
            Target::Array(array) => self.array(&array, path),
            Target::Group(group) => self.group(&group, path),
        }
    }

    fn array(&mut self, array: &Array, path: &Path) -> Result<(), StoreError> {
        self.visit(path)?;
        if array.attributes.contains_key("MATLAB_object_decode") {
            let class = array.attributes.get("MATLAB_class").map(Attr::text);
            return self.leave_out(path, class.unwrap_or_else(|| "object".to_owned()));
        }
        if array.element == Element::Reference && !array.attributes.contains_key("MATLAB_empty") {
            return self.cell(array, path);
        }
        self.leaf(array, path)
    }

    fn cell(&mut self, array: &Array, path: &Path) -> Result<(), StoreError> {
        let dims = reversed(&array.shape);
        let targets = self.store.targets(array)?;
        let count = targets.len();
        for (index, target) in targets.into_iter().enumerate() {
            if let Some(target) = target {
                self.target(
                    target,
                    &path.element(index as u64, count as u64, &dims, ['{', '}']),
                )?;
            }
        }
        Ok(())
    }

    fn leaf(&mut self, array: &Array, path: &Path) -> Result<(), StoreError> {
        let name = class(&array.attributes);
        let at = self.found.arrays.len() as u64;
        let dims = dimensions(array);
        let Some(content) = content(array, &name, at) else {
            let note = format!("'{}' left out: class '{name}' is not read", path.name);
            self.found.variables.notes.push(note);
            return Ok(());
        };
        let mut leaf = Leaf {
            variable: self.current(),
            element: path.element,
            name: path.name.clone(),
            tail: path.leaf_tail(),
            dims,
            content,
            logical: name == "logical",
            class: if name.is_empty() {
                "array".to_owned()
            } else {
                name
            },
            value: None,
        };
        if leaf.count() == 1 || (!leaf.is_numeric() && leaf.count() > 0) {
            leaf.value = self.value(array, &leaf);
        }
        self.found.arrays.push(array.clone());
        self.found.variables.leaves.push(leaf);
        Ok(())
    }

    /// The value of a short array as text; one that cannot be read is noted.
    fn value(&mut self, array: &Array, leaf: &Leaf) -> Option<String> {
        let raw = |_| Ok(little(array, self.store.raw(array)?));
        let value = text::short_value(leaf, ByteOrder::Little, raw);
        value.unwrap_or_else(|fault: StoreError| {
            let note = format!("the value of '{}' cannot be read: {fault}", leaf.name);
            self.found.variables.notes.push(note);
            None
        })
    }
}

/// MATLAB's dimensions; an empty array (what it holds are its dimensions, not its elements) is
/// taken for one of 0 × 0.
fn dimensions(array: &Array) -> Vec<u64> {
    if array.attributes.contains_key("MATLAB_empty") {
        return vec![0, 0];
    }
    let mut dims = reversed(&array.shape);
    dims.resize(dims.len().max(2), 1);
    dims
}

fn class(attributes: &Attrs) -> String {
    attributes
        .get("MATLAB_class")
        .map(Attr::text)
        .unwrap_or_default()
}

fn reversed(shape: &[u64]) -> Vec<u64> {
    shape.iter().rev().copied().collect()
}

fn last(path: &str) -> &str {
    path.rsplit('/').next().unwrap_or(path)
}

/// The fields of a struct in MATLAB's order if the file states it.
fn field_order(group: &Tree) -> Vec<String> {
    let arrays = group.arrays.iter().map(|a| a.name.clone());
    let mut names: Vec<String> = arrays
        .chain(group.groups.iter().map(|g| last(&g.path).to_owned()))
        .collect();
    if let Some(Attr::Text(stated)) = group.attributes.get("MATLAB_fields") {
        names.sort_by_key(|n| stated.iter().position(|s| s == n).unwrap_or(usize::MAX));
    }
    names
}
