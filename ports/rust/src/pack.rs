//! Packs as text: docs/port/formats.md, "Formats".

use crate::vector::{Point, Vector};
use std::collections::{BTreeMap, HashMap};
use std::fmt::{Display, Write};

/// One operator at one step: columns by name, such as "in.position.x".
#[derive(Default)]
pub struct Group<'a> {
    columns: HashMap<&'a str, Vec<&'a str>>,
}

pub struct Pack<'a> {
    pub groups: BTreeMap<(&'a str, u64), Group<'a>>,
}

impl<'a> Pack<'a> {
    pub fn parse(text: &'a str) -> Result<Pack<'a>, String> {
        let mut groups: BTreeMap<(&str, u64), Group> = BTreeMap::new();
        for line in text.lines().filter(|line| !line.starts_with('#') && !line.trim().is_empty()) {
            let words: Vec<&str> = line.split_whitespace().collect();
            let wrong = || format!("not a line of a pack: {}", line);
            if words.len() != 5 {
                return Err(wrong());
            }
            let step = words[1].parse().map_err(|_| wrong())?;
            let row: usize = words[2].parse().map_err(|_| wrong())?;
            let column = groups.entry((words[0], step)).or_default().columns.entry(words[3]).or_default();
            if column.len() <= row {
                column.resize(row + 1, "");
            }
            column[row] = words[4];
        }
        Ok(Pack { groups })
    }

    pub fn group(&self, operator: &str, step: u64) -> Result<&Group<'a>, String> {
        let found = self.groups.iter().find(|(key, _)| **key == (operator, step));
        found.map(|(_, group)| group).ok_or_else(|| format!("no {}.{} in the pack", operator, step))
    }
}

impl<'a> Group<'a> {
    /// A column that is missing is empty: "one that is missing is empty".
    fn column(&self, table: &str, name: &str) -> &[&'a str] {
        let full = format!("in.{}.{}", table, name);
        self.columns.get(full.as_str()).map_or(&[], |values| values.as_slice())
    }

    fn numbers<T: std::str::FromStr>(&self, table: &str, name: &str) -> Vec<T> {
        let parse = |text: &&str| match text.parse() {
            Ok(value) => value,
            Err(_) => panic!("in.{}.{}: '{}' is no number", table, name, text),
        };
        self.column(table, name).iter().map(parse).collect()
    }

    pub fn integers(&self, table: &str, name: &str) -> Vec<i64> {
        self.numbers(table, name)
    }

    pub fn reals(&self, table: &str, name: &str) -> Vec<f64> {
        self.numbers(table, name)
    }

    /// All columns of a table of integers, by name.
    pub fn columns_of(&self, table: &str) -> Vec<(String, Vec<i64>)> {
        let prefix = format!("in.{}.", table);
        let names = self.columns.keys().filter_map(|full| full.strip_prefix(prefix.as_str()));
        names.map(|name| (name.to_string(), self.integers(table, name))).collect()
    }

    pub fn integer(&self, table: &str, name: &str) -> i64 {
        self.integers(table, name)[0]
    }

    pub fn real(&self, table: &str, name: &str) -> f64 {
        self.reals(table, name)[0]
    }

    pub fn points(&self, table: &str) -> Vec<Point> {
        self.triples(table, ["x", "y", "z"])
    }

    pub fn vectors(&self, table: &str) -> Vec<Vector> {
        self.triples(table, ["x", "y", "z"])
    }

    pub fn triples<T: std::str::FromStr + Copy>(&self, table: &str, names: [&str; 3]) -> Vec<[T; 3]> {
        let [x, y, z] = names.map(|name| self.numbers::<T>(table, name));
        (0..x.len()).map(|row| [x[row], y[row], z[row]]).collect()
    }
}

/// The outputs of one operator, line by line.
pub struct Writer<'a> {
    pub text: &'a mut String,
    pub operator: &'a str,
    pub step: u64,
}

/// Whole numbers in digits, reals in the shortest decimals that read back as the same double.
pub trait Value {
    fn text(&self) -> String;
}

impl Value for f64 {
    fn text(&self) -> String {
        format!("{:?}", self)
    }
}

macro_rules! whole {
    ($($kind:ty),*) => { $(impl Value for $kind {
        fn text(&self) -> String { self.to_string() }
    })* };
}
whole!(i64, u64, u32, usize);

impl<'a> Writer<'a> {
    pub fn value(&mut self, row: usize, table: &str, name: impl Display, value: impl Value) {
        let (operator, step) = (self.operator, self.step);
        writeln!(self.text, "{} {} {} out.{}.{} {}", operator, step, row, table, name, value.text()).unwrap();
    }

    pub fn column<T: Value + Copy>(&mut self, table: &str, name: &str, values: &[T]) {
        for (row, value) in values.iter().enumerate() {
            self.value(row, table, name, *value);
        }
    }

    pub fn triple<T: Value + Copy>(&mut self, row: usize, table: &str, value: [T; 3]) {
        for (axis, name) in ["x", "y", "z"].iter().enumerate() {
            self.value(row, table, name, value[axis]);
        }
    }

    pub fn triples<T: Value + Copy>(&mut self, table: &str, values: &[[T; 3]]) {
        for (row, value) in values.iter().enumerate() {
            self.triple(row, table, *value);
        }
    }
}
