//! An XML element with its place, so that every fault says where.

use std::cell::RefCell;
use std::fmt::Display;

use roxmltree::{Document, Node, ParsingOptions};

use super::super::fault::Fault;
use super::super::file::Range;

/// Nodes of a file, text and white space counted: what 16 MiB of a recorded scenario hold, and 200 MB of memory at most.
const NODES: u32 = 2_000_000;

/// Attributes of one element at most: the parser compares each with all others.
const ATTRIBUTES: usize = 1_000;

/// The line of the first element of more attributes than there may be, before anything is parsed.
fn crowded(text: &str) -> Option<usize> {
    let bytes = text.as_bytes();
    // where what begins at `from` and ends so is over
    let after =
        |from: usize, end: &str| text.get(from..)?.find(end).map(|at| from + at + end.len());
    let mut at = 0;
    while let Some(open) = text.get(at..).and_then(|rest| rest.find('<')) {
        at += open;
        let rest = &text[at..];
        let skipped = [("<!--", "-->"), ("<![CDATA[", "]]>"), ("<?", "?>")];
        if let Some((_, end)) = skipped
            .into_iter()
            .find(|(begin, _)| rest.starts_with(begin))
        {
            at = after(at, end)?;
            continue;
        }
        let (begun, mut count) = (at, 0);
        while *bytes.get(at)? != b'>' {
            if let quote @ (b'"' | b'\'') = bytes[at] {
                at = after(at + 1, if quote == b'"' { "\"" } else { "'" })?;
                count += 1;
                if count > ATTRIBUTES {
                    return Some(1 + text[..begun].matches('\n').count());
                }
            } else {
                at += 1;
            }
        }
    }
    None
}

/// Reads a text. A document type, in which entities would be declared, is refused: nothing expands.
pub(super) fn parse(text: &str) -> Result<Document<'_>, Fault> {
    if let Some(line) = crowded(text) {
        return Err(Fault {
            path: String::new(),
            found: format!("an element of more than {ATTRIBUTES} attributes"),
            allowed: format!("at most {ATTRIBUTES}"),
            line: Some(line),
        });
    }
    let options = ParsingOptions {
        allow_dtd: false,
        nodes_limit: NODES,
        ..ParsingOptions::default()
    };
    Document::parse_with_options(text, options).map_err(|error| Fault {
        path: String::new(),
        found: error.to_string(),
        allowed: format!("XML without errors, without a document type, of at most {NODES} nodes"),
        line: Some(error.pos().row as usize),
    })
}

/// An element, where it stands, and the faults so far.
#[derive(Debug, Clone)]
pub(super) struct Xml<'a> {
    node: Node<'a, 'a>,
    path: String,
    faults: &'a RefCell<Vec<Fault>>,
}

impl<'a> Xml<'a> {
    /// The outermost element of a file.
    pub(super) fn root(document: &'a Document<'a>, faults: &'a RefCell<Vec<Fault>>) -> Self {
        let node = document.root_element();
        Self {
            path: node.tag_name().name().to_owned(),
            node,
            faults,
        }
    }

    /// The name of the element.
    pub(super) fn name(&self) -> &'a str {
        self.node.tag_name().name()
    }

    /// Where it stands, as in `commonOcean/dynamicObstacle[11]/type`.
    pub(super) fn path(&self) -> &str {
        &self.path
    }

    /// Notes a fault at this place.
    pub(super) fn fault(&self, found: impl Display, allowed: impl Display) {
        let at = self.node.document().text_pos_at(self.node.range().start);
        self.faults.borrow_mut().push(Fault {
            path: self.path.clone(),
            found: found.to_string(),
            allowed: allowed.to_string(),
            line: Some(at.row as usize),
        });
    }

    /// The elements in it, in the order of the file.
    pub(super) fn elements(&self) -> impl Iterator<Item = Xml<'a>> + use<'a> {
        let (path, faults) = (self.path.clone(), self.faults);
        self.node
            .children()
            .filter(Node::is_element)
            .map(move |node| {
                let name = node.tag_name().name();
                let path = match node.attribute("id") {
                    Some(id) => format!("{path}/{name}[{id}]"),
                    None => format!("{path}/{name}"),
                };
                Xml { node, path, faults }
            })
    }

    /// Those of one name.
    pub(super) fn all(&self, name: &str) -> impl Iterator<Item = Xml<'a>> {
        self.elements()
            .filter(move |element| element.name() == name)
    }

    /// The first of one name.
    pub(super) fn take(&self, name: &str) -> Option<Xml<'a>> {
        self.all(name).next()
    }

    /// The first of one name, which must be there.
    pub(super) fn require(&self, name: &str, allowed: impl Display) -> Option<Xml<'a>> {
        let found = self.take(name);
        if found.is_none() {
            self.fault(
                format_args!("no {name}"),
                format_args!("{name}: {allowed}; it is required"),
            );
        }
        found
    }

    /// An attribute.
    pub(super) fn attribute(&self, name: &str) -> Option<&'a str> {
        self.node.attribute(name)
    }

    /// The text in it, without the white space around.
    pub(super) fn text(&self) -> &'a str {
        self.node.text().unwrap_or_default().trim()
    }

    /// The number in it.
    pub(super) fn number(&self, range: Range, unit: &str) -> Option<f64> {
        self.parsed(self.text(), range, unit)
    }

    /// The number of an attribute that must be there.
    pub(super) fn attribute_number(&self, name: &str, range: Range, unit: &str) -> Option<f64> {
        match self.attribute(name) {
            Some(text) => self.parsed(text, range, unit),
            None => {
                self.fault(
                    format_args!("no attribute {name}"),
                    format_args!("{name}: {range} {unit}"),
                );
                None
            }
        }
    }

    fn parsed(&self, text: &str, range: Range, unit: &str) -> Option<f64> {
        match text.parse::<f64>() {
            Ok(number) if range.contains(number) => Some(number + 0.0),
            _ => {
                self.fault(shown(text), format_args!("{range} {unit}"));
                None
            }
        }
    }

    /// The number of an element that must be there.
    pub(super) fn required_number(&self, name: &str, range: Range, unit: &str) -> Option<f64> {
        self.require(name, format_args!("{range} {unit}"))?
            .number(range, unit)
    }

    /// The number in `exact` of an element that must be there.
    pub(super) fn required_exact(&self, name: &str, range: Range, unit: &str) -> Option<f64> {
        self.require(name, format_args!("{range} {unit}"))?
            .exact(range, unit)
    }

    /// The number in `exact`; an interval is none.
    pub(super) fn exact(&self, range: Range, unit: &str) -> Option<f64> {
        self.require("exact", format_args!("{range} {unit}"))?
            .number(range, unit)
    }
}

/// A text as a message shows it.
pub(super) fn shown(text: &str) -> String {
    /// Characters of a long text.
    const SHOWN: usize = 40;
    if text.chars().count() > SHOWN {
        format!("{:?}…", text.chars().take(SHOWN).collect::<String>())
    } else {
        format!("{text:?}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_element_of_very_many_attributes_is_refused_before_it_is_parsed() {
        let element = |count: usize| {
            let attributes: String = (0..count).map(|k| format!(" a{k}='>\"'")).collect();
            format!("<?xml version='1.0'?>\n<!-- it's -->\n<x{attributes}><y b=\"'\"/>é</x>")
        };
        assert!(parse(&element(ATTRIBUTES)).is_ok());
        let fault = parse(&element(ATTRIBUTES + 1)).expect_err("too many");
        assert_eq!(fault.line, Some(3));
        assert!(fault.found.contains("attributes"), "{}", fault.found);
        let many = element(100_000);
        assert!(crowded(&many).is_some());
        for cut in (0..400).filter_map(|n| many.get(..n)) {
            assert_eq!(crowded(cut), None);
        }
    }
}
