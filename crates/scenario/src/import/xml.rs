//! An XML element with its place: the cursor with which XML is read.

use std::collections::BTreeSet;
use std::fmt::Display;

use roxmltree::{Document, Node, ParsingOptions};

use searoom_input::text::printable;
use searoom_input::{Fault, Faults, Range, abbreviated};

/// Most nodes of a file, text and white space included: 16 MiB of a recorded scenario, 200 MB of
/// memory.
const NODES: u32 = 2_000_000;

/// Most attributes of one element: the parser compares each with all others.
const ATTRIBUTES: usize = 1_000;

/// The line of the first element with too many attributes, found before parsing.
fn crowded(text: &str) -> Option<usize> {
    let bytes = text.as_bytes();
    // the offset behind `end`, searched from `from`
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

/// Parses a text. A document type, which could declare entities, is refused: nothing expands.
pub fn parse(text: &str) -> Result<Document<'_>, Fault> {
    if let Some(line) = crowded(text) {
        let found = format_args!("an element of more than {ATTRIBUTES} attributes");
        return Err(Fault::new("", found, format_args!("at most {ATTRIBUTES}")).at_line(line));
    }
    let options = ParsingOptions {
        allow_dtd: false,
        nodes_limit: NODES,
        ..ParsingOptions::default()
    };
    let allowed =
        format_args!("XML without errors, without a document type, of at most {NODES} nodes");
    Document::parse_with_options(text, options)
        .map_err(|error| Fault::new("", &error, allowed).at_line(error.pos().row as usize))
}

/// Letters of an id in a message.
const ID_LETTERS: usize = 40;

fn short(id: &str) -> String {
    let kept: String = id.chars().take(ID_LETTERS).collect();
    printable(&kept).replace('\n', " ")
}

/// Elements, and the names of their attributes and elements that are read or mean nothing here. An
/// element without a row is not looked into.
pub type Names = &'static [(&'static str, &'static [&'static str])];

/// An element, its place, and the faults found so far.
#[derive(Debug, Clone)]
pub struct Xml<'a> {
    node: Node<'a, 'a>,
    path: String,
    faults: &'a Faults,
}

impl<'a> Xml<'a> {
    pub fn root(document: &'a Document<'a>, faults: &'a Faults) -> Self {
        let node = document.root_element();
        Self {
            path: node.tag_name().name().to_owned(),
            node,
            faults,
        }
    }

    pub fn name(&self) -> &'a str {
        self.node.tag_name().name()
    }

    /// Where it is, as in `commonOcean/dynamicObstacle[11]/type`.
    pub fn path(&self) -> &str {
        &self.path
    }

    pub fn fault(&self, found: impl Display, allowed: impl Display) {
        let at = self.node.document().text_pos_at(self.node.range().start);
        let fault = Fault::new(self.path.as_str(), found, allowed);
        self.faults.note(fault.at_line(at.row as usize));
    }

    /// Notes a fault at this place, without which there would be a value.
    pub fn reject<T>(&self, found: impl Display, allowed: impl Display) -> Option<T> {
        self.fault(found, allowed);
        None
    }

    pub fn elements(&self) -> impl Iterator<Item = Xml<'a>> + use<'a> {
        let (path, faults) = (self.path.clone(), self.faults);
        self.node
            .children()
            .filter(Node::is_element)
            .map(move |node| {
                let name = node.tag_name().name();
                let path = match node.attribute("id") {
                    Some(id) => format!("{path}/{name}[{}]", short(id)),
                    None => format!("{path}/{name}"),
                };
                Xml { node, path, faults }
            })
    }

    pub fn all(&self, name: &str) -> impl Iterator<Item = Xml<'a>> {
        self.elements()
            .filter(move |element| element.name() == name)
    }

    /// Those of one name, which faults name by their place from 1 on, whatever their ids.
    pub fn numbered(&self, name: &str) -> impl Iterator<Item = Xml<'a>> {
        let at = |(place, element): (usize, Xml<'a>)| Xml {
            path: format!("{}/{}[{place}]", self.path, element.name()),
            ..element
        };
        (1..).zip(self.all(name)).map(at)
    }

    pub fn take(&self, name: &str) -> Option<Xml<'a>> {
        self.all(name).next()
    }

    /// The first of one name, which must be there.
    pub fn require(&self, name: &str, allowed: impl Display) -> Option<Xml<'a>> {
        let found = self.take(name);
        if found.is_none() {
            self.fault(
                format_args!("no {name}"),
                format_args!("{name}: {allowed}; it is required"),
            );
        }
        found
    }

    /// Attributes and elements, below this element, that are not among `names`: each once, after the
    /// name of its element.
    pub fn unread(&self, names: Names) -> BTreeSet<String> {
        let mut unread = BTreeSet::new();
        let mut open = vec![self.node];
        while let Some(node) = open.pop() {
            let name = node.tag_name().name();
            let Some((_, known)) = names.iter().find(|(element, _)| *element == name) else {
                continue;
            };
            let elements = node.children().filter(Node::is_element);
            let attributes = node.attributes().map(|attribute| attribute.name());
            let all = attributes.chain(elements.clone().map(|child| child.tag_name().name()));
            let others = all.filter(|other| !known.contains(other));
            unread.extend(others.map(|other| format!("{name}/{}", short(other))));
            open.extend(elements.filter(|child| known.contains(&child.tag_name().name())));
        }
        unread
    }

    pub fn attribute(&self, name: &str) -> Option<&'a str> {
        self.node.attribute(name)
    }

    /// The text in it, without the white space around.
    pub fn text(&self) -> &'a str {
        self.node.text().unwrap_or_default().trim()
    }

    pub fn number(&self, range: Range) -> Option<f64> {
        self.parsed(self.text(), range)
    }

    /// The number of an attribute that must be there.
    pub fn attribute_number(&self, name: &str, range: Range) -> Option<f64> {
        match self.attribute(name) {
            Some(text) => self.parsed(text, range),
            None => self.reject(
                format_args!("no attribute {name}"),
                format_args!("{name}: {range}"),
            ),
        }
    }

    fn parsed(&self, text: &str, range: Range) -> Option<f64> {
        let number = range.parse(text.trim());
        if number.is_none() {
            self.fault(abbreviated(text), range);
        }
        number
    }

    /// The number of an element that must be there.
    pub fn required_number(&self, name: &str, range: Range) -> Option<f64> {
        self.require(name, range)?.number(range)
    }

    /// The number in the element `exact`; an interval is not a number.
    pub fn exact(&self, range: Range) -> Option<f64> {
        self.require("exact", range)?.number(range)
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
