//! Tables in `booktabs` style: columns of numbers are `siunitx` columns, aligned at the decimal marker.

use std::fmt::Write as _;

/// What stands in a cell.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Cell {
    /// Text in LaTeX.
    Text(String),
    /// A number in digits, `-1.23e-17`.
    Number(String),
}

/// How wide a column of text may be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Width {
    /// As wide as what it holds.
    Natural,
    /// Broken at this many hundredths of the line.
    Share(u8),
}

/// A table: heads in LaTeX, rows of as many cells, or headings over all columns.
pub(super) struct Table {
    pub(super) heads: Vec<(String, Width)>,
    pub(super) rows: Vec<Row>,
}

pub(super) enum Row {
    Cells(Vec<Cell>),
    Heading(String),
}

impl Table {
    /// Over as many pages as it takes (`longtable`).
    pub(super) fn long(&self) -> String {
        let head = self.head();
        let columns = self.heads.len();
        let more = format!("\\midrule\n\\multicolumn{{{columns}}}{{r}}{{continued}}\\\\\n\\endfoot\n");
        format!(
            "\\begin{{longtable}}{{{}}}\n\\toprule\n{head}\\midrule\n\\endhead\n{more}\\bottomrule\n\\endlastfoot\n{}\\end{{longtable}}\n",
            self.columns(),
            self.body()
        )
    }

    /// In one piece, made as narrow as the line if it is wider.
    pub(super) fn short(&self) -> String {
        format!(
            "\\remainderfit{{%\n\\begin{{tabular}}{{{}}}\n\\toprule\n{}\\midrule\n{}\\bottomrule\n\\end{{tabular}}}}\n",
            self.columns(),
            self.head(),
            self.body()
        )
    }

    fn head(&self) -> String {
        let heads = self.heads.iter().enumerate().map(|(index, (head, _))| match self.format(index) {
            // Braces: a head is no number.
            Some(_) => format!("{{{head}}}"),
            None => head.clone(),
        });
        format!("{} \\\\\n", heads.collect::<Vec<_>>().join(" & "))
    }

    fn columns(&self) -> String {
        let column = |(index, (_, width)): (usize, &(String, Width))| match (self.format(index), width) {
            (Some(format), _) => format!("S[table-format={format}]"),
            (None, Width::Natural) => "l".to_owned(),
            (None, Width::Share(share)) => {
                format!(">{{\\raggedright\\arraybackslash}}p{{{}\\linewidth}}", f64::from(*share) / 100.0)
            }
        };
        let columns: Vec<String> = self.heads.iter().enumerate().map(column).collect();
        format!("@{{}}{}@{{}}", columns.join(" "))
    }

    fn body(&self) -> String {
        let mut text = String::new();
        for (at, row) in self.rows.iter().enumerate() {
            match row {
                Row::Heading(heading) => {
                    let columns = self.heads.len();
                    let rule = if at > 0 { "\\midrule\n" } else { "" };
                    let _ = writeln!(
                        text,
                        "{rule}\\multicolumn{{{columns}}}{{@{{}}p{{\\linewidth}}@{{}}}}{{\\raggedright {heading}}} \\\\*"
                    );
                }
                Row::Cells(cells) => {
                    let cells =
                        cells.iter().enumerate().map(|(index, cell)| match (cell, self.format(index)) {
                            (Cell::Number(number), _) => number.clone(),
                            (Cell::Text(text), Some(_)) => format!("{{{text}}}"),
                            (Cell::Text(text), None) => text.clone(),
                        });
                    let _ = writeln!(text, "{} \\\\", cells.collect::<Vec<_>>().join(" & "));
                }
            }
        }
        text
    }

    /// Of a column that holds numbers, the room they take: sign, digits before and after the marker, exponent.
    fn format(&self, column: usize) -> Option<String> {
        let cells = self.rows.iter().filter_map(|row| match row {
            Row::Cells(cells) => cells.get(column),
            Row::Heading(_) => None,
        });
        let numbers: Vec<&str> = cells
            .filter_map(|cell| match cell {
                Cell::Number(number) => Some(number.as_str()),
                Cell::Text(_) => None,
            })
            .collect();
        if numbers.is_empty() {
            return None;
        }
        let (mut sign, mut whole, mut decimals, mut exponent) = ("", 1, 0, 0);
        let mut exponent_sign = "";
        for number in numbers {
            let (mantissa, power) = number.split_once('e').unwrap_or((number, ""));
            if mantissa.starts_with('-') {
                sign = "-";
            }
            let digits = mantissa.trim_start_matches('-');
            let (before, after) = digits.split_once('.').unwrap_or((digits, ""));
            whole = whole.max(before.len());
            decimals = decimals.max(after.len());
            if power.starts_with('-') {
                exponent_sign = "-";
            }
            exponent = exponent.max(power.trim_start_matches('-').len());
        }
        let mut format = format!("{sign}{whole}.{decimals}");
        if exponent > 0 {
            let _ = write!(format, "e{exponent_sign}{exponent}");
        }
        Some(format)
    }
}

#[cfg(test)]
mod tests {
    use super::{Cell, Row, Table, Width};

    #[test]
    fn columns_of_numbers_have_the_room_they_need() {
        let number = |text: &str| Cell::Number(text.into());
        let text = Cell::Text("–".into());
        let heads = ["a", "b"].map(|head| (head.to_owned(), Width::Natural)).to_vec();
        let rows = vec![
            Row::Cells(vec![number("-1.234"), Cell::Text("x".into())]),
            Row::Cells(vec![number("56e-17"), text.clone()]),
            Row::Cells(vec![text, Cell::Text("y".into())]),
        ];
        let table = Table { heads, rows }.short();
        assert!(table.contains("{@{}S[table-format=-2.3e-2] l@{}}"), "{table}");
        assert!(table.contains("{a} & b \\\\") && table.contains("{–} & y \\\\"), "{table}");
    }
}
