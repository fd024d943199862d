//! The types that a user of the library can name, and whether their own documentation shows how they are used.

use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::{TokenStream, TokenTree};

use super::module_of;

/// The text of every source file by its path below `src/`.
pub type Sources = BTreeMap<String, String>;

/// What one module declares.
#[derive(Default)]
struct Module {
    /// Structs, enums and traits that are `pub`, with the lines of their documentation.
    types: Vec<(String, Vec<String>)>,
    /// Modules in files of their own that are `pub` and not hidden from the documentation.
    modules: Vec<String>,
    /// What `pub use` names, the module first; `*` for everything.
    uses: Vec<(Vec<String>, String)>,
}

/// Every public type without an example that names it, as `module::Type`.
pub fn without_example(sources: &Sources) -> Vec<String> {
    let modules: BTreeMap<Vec<String>, Module> = sources
        .iter()
        .map(|(path, text)| {
            let tokens: TokenStream = text.parse().expect("Rust");
            (module_of(path), read(tokens))
        })
        .collect();
    let mut reached = BTreeSet::new();
    reach(&modules, &[], &mut reached);
    let lacking = reached.into_iter().filter(|(module, name)| {
        let types = modules.get(module).map(|m| &m.types);
        let docs = types.and_then(|types| types.iter().find(|(n, _)| n == name));
        docs.is_some_and(|(name, docs)| !examples(docs).any(|line| names(line, name)))
    });
    lacking
        .map(|(module, name)| format!("{}::{name}", module.join("::")))
        .collect()
}

/// Adds the types that can be named through a module: its own, those of public modules in it, and what it hands on.
fn reach(
    modules: &BTreeMap<Vec<String>, Module>,
    at: &[String],
    reached: &mut BTreeSet<(Vec<String>, String)>,
) {
    let Some(module) = modules.get(at) else {
        return;
    };
    let own = module.types.iter().map(|(name, _)| name);
    reached.extend(own.map(|name| (at.to_vec(), name.clone())));
    for name in &module.modules {
        reach(modules, &[at, std::slice::from_ref(name)].concat(), reached);
    }
    for (path, name) in &module.uses {
        let from = resolved(at, path);
        match modules.get(&from) {
            Some(_) if name == "*" => reach(modules, &from, reached),
            Some(other) if other.types.iter().any(|(n, _)| n == name) => {
                reached.insert((from, name.clone()));
            }
            // handed on a second time, or a function or a constant
            Some(other) => {
                for (path, _) in other.uses.iter().filter(|(_, n)| n == name) {
                    reached.insert((resolved(&from, path), name.clone()));
                }
            }
            None => {}
        }
    }
}

/// The module that a path in `at` leads to.
fn resolved(at: &[String], path: &[String]) -> Vec<String> {
    let mut module = at.to_vec();
    for step in path {
        match step.as_str() {
            "crate" => module.clear(),
            "self" => {}
            "super" => drop(module.pop()),
            _ => module.push(step.clone()),
        }
    }
    module
}

/// The items of a file, one after another: documentation gathers until the item that it is of.
fn read(tokens: TokenStream) -> Module {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let word = |i: usize| match tokens.get(i) {
        Some(TokenTree::Ident(ident)) => ident.to_string(),
        Some(TokenTree::Punct(punct)) => punct.as_char().to_string(),
        _ => String::new(),
    };
    let (mut module, mut docs, mut hidden) = (Module::default(), Vec::new(), false);
    let mut i = 0;
    while i < tokens.len() {
        match (word(i).as_str(), word(i + 1).as_str()) {
            ("#", _) => {
                if let Some(TokenTree::Group(attribute)) = tokens.get(i + 1) {
                    let text = attribute.stream().to_string().replace(' ', "");
                    hidden |= text == "doc(hidden)";
                    docs.extend(doc_line(attribute.stream()));
                }
                i += 2;
                continue;
            }
            _ if hidden => {}
            ("pub", "struct" | "enum" | "trait") => {
                module.types.push((word(i + 2), std::mem::take(&mut docs)));
            }
            ("pub", "mod") => module.modules.push(word(i + 2)),
            ("pub", "use") => {
                let end = (i..tokens.len()).find(|&k| word(k) == ";");
                let path = &tokens[i + 2..end.unwrap_or(tokens.len())];
                expand(path, &[], &mut module.uses);
            }
            _ => {}
        }
        // on to the end of the item
        while i < tokens.len() && word(i) != ";" && !is_body(&tokens[i]) {
            i += 1;
        }
        i += 1;
        docs.clear();
        hidden = false;
    }
    module
}

fn is_body(token: &TokenTree) -> bool {
    matches!(token, TokenTree::Group(group) if group.delimiter() == proc_macro2::Delimiter::Brace)
}

/// The text of `doc = "text"`, its escapes as they are.
fn doc_line(attribute: TokenStream) -> Option<String> {
    let mut tokens = attribute.into_iter();
    let is_doc = matches!(tokens.next()?, TokenTree::Ident(name) if name == "doc");
    match tokens.nth(1)? {
        TokenTree::Literal(text) if is_doc => {
            let text = text.to_string();
            let (_, rest) = text.split_once('"')?;
            rest.rsplit_once('"').map(|(line, _)| line.to_owned())
        }
        _ => None,
    }
}

/// Adds `a::b::C` as `(a::b, C)`, and each of `a::{b, c::{d}}`.
fn expand(tokens: &[TokenTree], base: &[String], uses: &mut Vec<(Vec<String>, String)>) {
    let mut path = base.to_vec();
    for token in tokens {
        match token {
            TokenTree::Ident(ident) => path.push(ident.to_string()),
            TokenTree::Punct(punct) if punct.as_char() == '*' => path.push("*".to_owned()),
            TokenTree::Group(group) => {
                let members: Vec<TokenTree> = group.stream().into_iter().collect();
                let comma = |t: &TokenTree| matches!(t, TokenTree::Punct(p) if p.as_char() == ',');
                for member in members.split(comma).filter(|m| !m.is_empty()) {
                    expand(member, &path, uses);
                }
                return;
            }
            _ => {}
        }
    }
    if let Some(name) = path.pop() {
        uses.push((path, name));
    }
}

/// The lines of Rust that are shown and run: those of fences without a language, but for what is hidden.
fn examples(docs: &[String]) -> impl Iterator<Item = &str> {
    let (mut open, mut rust) = (false, false);
    docs.iter().filter_map(move |line| {
        let line = line.trim();
        if let Some(language) = line.strip_prefix("```") {
            open = !open;
            rust = open && language.is_empty();
            return None;
        }
        (open && rust && !line.starts_with("# ")).then_some(line)
    })
}

/// True where a line has a word.
fn names(line: &str, word: &str) -> bool {
    line.split(|c: char| !c.is_alphanumeric() && c != '_')
        .any(|found| found == word)
}
