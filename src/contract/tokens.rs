//! Reads a Rust source as tokens: its digest without comments, docs, layout and test code, and the paths that it names.
//!
//! `build.rs` includes this file to fingerprint the program; `tests/layers.rs` includes it to check the arrows between
//! rooms; the library has it under test only. It knows the lexer (proc-macro2), not the grammar: where it can't tell, a
//! change counts, so that a fingerprint may change without need but never stays when it should change.
//!
//! What does not count: comments and docs; blanks, line breaks, and trailing commas where rustfmt puts them; items
//! under `#[cfg(test)]` and `#[test]`. What counts besides the tokens: files named by `include_str!`, `include_bytes!`
//! and `include!`.

use proc_macro2::{Delimiter, Group, Spacing, TokenStream, TokenTree};
use sha2::{Digest as _, Sha256};
use std::collections::BTreeSet;

/// What there is to know about a source.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Source {
    /// The digest of the tokens, in hexadecimal; of included files nothing.
    pub digest: String,
    /// Whether it only lists modules (`mod x;`), and so says nothing.
    pub is_list: bool,
    /// The files it includes, as it names them.
    pub included: Vec<String>,
    /// The modules that are declared for tests only (`#[cfg(test)] mod x;`).
    pub test_modules: BTreeSet<String>,
    /// The first names of outside paths (`libm` in `libm::sin`): crates among them.
    pub outside: BTreeSet<String>,
    /// The paths inside this crate, from its root: `["numerics", "real", "Real"]`; `*` for a glob.
    pub inside: BTreeSet<Vec<String>>,
}

/// Reads a source; `module` is its module's path from the crate's root.
///
/// # Errors
/// A text that has no tokens (an open quote or bracket); a file included by a path that is not a literal.
pub fn read(text: &str, module: &[&str]) -> Result<Source, String> {
    let stream: TokenStream = text.parse().map_err(|error| format!("can't be read as tokens: {error}"))?;
    let mut strip = Strip::default();
    let trees = strip.items(stream);
    let mut included = Vec::new();
    find_included(&trees, &mut included)?;
    let tokens = flatten(&trees);
    Ok(Source {
        digest: digest(&tokens),
        is_list: is_list(&tokens),
        included,
        test_modules: strip.test_modules,
        outside: outside(&tokens),
        inside: inside(&tokens, module),
    })
}

/// All tokens of a source, test code too, docs and comments left out.
///
/// # Errors
/// A text that has no tokens.
pub fn all_tokens(text: &str) -> Result<Vec<String>, String> {
    let stream: TokenStream = text.parse().map_err(|error| format!("can't be read as tokens: {error}"))?;
    let mut strip = Strip { keep_tests: true, ..Strip::default() };
    Ok(flatten(&strip.items(stream)))
}

fn digest(tokens: &[String]) -> String {
    let mut hasher = Sha256::new();
    for token in tokens {
        hasher.update((token.len() as u64).to_le_bytes());
        hasher.update(token.as_bytes());
    }
    hasher.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Removes docs and test code.
#[derive(Default)]
struct Strip {
    keep_tests: bool,
    test_modules: BTreeSet<String>,
}

impl Strip {
    fn items(&mut self, stream: TokenStream) -> Vec<TokenTree> {
        let trees: Vec<TokenTree> = stream.into_iter().collect();
        let mut kept = Vec::with_capacity(trees.len());
        let mut at = 0;
        while at < trees.len() {
            if let Some((attribute, next)) = attribute(&trees, at) {
                if is_doc(attribute) {
                    at = next;
                    continue;
                }
                if !self.keep_tests && is_for_tests(attribute) {
                    // Other attributes of the item stand before or after this one; those before are already kept,
                    // which is harmless: they change with the test only when they are edited.
                    at = self.skip_item(&trees, next);
                    continue;
                }
            }
            kept.push(match &trees[at] {
                TokenTree::Group(group) => {
                    let inner: TokenStream = self.items(group.stream()).into_iter().collect();
                    TokenTree::Group(Group::new(group.delimiter(), inner))
                }
                other => other.clone(),
            });
            at += 1;
        }
        kept
    }

    /// The place after the item that begins at `at`.
    fn skip_item(&mut self, trees: &[TokenTree], mut at: usize) -> usize {
        while let Some((_, next)) = attribute(trees, at) {
            at = next;
        }
        let start = at;
        let words: Vec<String> = trees[start..].iter().take(6).map(ToString::to_string).collect();
        let word = |index: usize| words.get(index).map(String::as_str);
        let first = words.iter().position(|word| word != "pub" && !word.starts_with('(')).unwrap_or(0);
        let ends_with_semicolon = match word(first) {
            Some("use" | "static" | "type" | "let") => true,
            Some("const") => !matches!(word(first + 1), Some("fn" | "unsafe" | "extern" | "async")),
            Some("extern") => word(first + 1) == Some("crate"),
            _ => false,
        };
        let item_words = ["fn", "mod", "struct", "enum", "union", "trait", "impl", "macro_rules", "unsafe", "async"];
        let is_item = ends_with_semicolon
            || word(first).is_some_and(|word| item_words.contains(&word) || word == "const" || word == "extern");
        if let (Some("mod"), Some(name), Some(";")) = (word(first), word(first + 1), word(first + 2)) {
            self.test_modules.insert(name.to_owned());
        }
        while let Some(tree) = trees.get(at) {
            at += 1;
            match tree {
                TokenTree::Punct(punct) if punct.as_char() == ';' => break,
                // A field, a variant, an arm: ends with its comma.
                TokenTree::Punct(punct) if punct.as_char() == ',' && !is_item => break,
                TokenTree::Group(group) if group.delimiter() == Delimiter::Brace && !ends_with_semicolon => break,
                _ => {}
            }
        }
        at
    }
}

/// The attribute that begins at `at` (`#[…]` or `#![…]`), and the place after it.
fn attribute(trees: &[TokenTree], at: usize) -> Option<(&Group, usize)> {
    let is = |index: usize, c: char| matches!(trees.get(index), Some(TokenTree::Punct(p)) if p.as_char() == c);
    if !is(at, '#') {
        return None;
    }
    let at = if is(at + 1, '!') { at + 2 } else { at + 1 };
    match trees.get(at) {
        Some(TokenTree::Group(group)) if group.delimiter() == Delimiter::Bracket => Some((group, at + 1)),
        _ => None,
    }
}

fn is_doc(attribute: &Group) -> bool {
    matches!(attribute.stream().into_iter().next(), Some(TokenTree::Ident(name)) if name == "doc")
}

fn is_for_tests(attribute: &Group) -> bool {
    let trees: Vec<TokenTree> = attribute.stream().into_iter().collect();
    match trees.as_slice() {
        [TokenTree::Ident(name)] => name == "test",
        [TokenTree::Ident(name), TokenTree::Group(group)] if name == "cfg" => needs_test(group.stream()),
        _ => false,
    }
}

/// Whether a `cfg` predicate can hold in tests only: `test`, or `all(…)` with such a one.
fn needs_test(predicate: TokenStream) -> bool {
    let trees: Vec<TokenTree> = predicate.into_iter().collect();
    match trees.as_slice() {
        [TokenTree::Ident(name)] => name == "test",
        [TokenTree::Ident(name), TokenTree::Group(group)] if name == "all" => {
            let parts: Vec<TokenTree> = group.stream().into_iter().collect();
            let is_comma = |tree: &TokenTree| matches!(tree, TokenTree::Punct(p) if p.as_char() == ',');
            parts.split(is_comma).any(|part| needs_test(part.iter().cloned().collect()))
        }
        _ => false,
    }
}

fn find_included(trees: &[TokenTree], found: &mut Vec<String>) -> Result<(), String> {
    for (at, tree) in trees.iter().enumerate() {
        if let TokenTree::Group(group) = tree {
            find_included(&group.stream().into_iter().collect::<Vec<_>>(), found)?;
        }
        let TokenTree::Ident(name) = tree else { continue };
        let (Some(TokenTree::Punct(bang)), Some(TokenTree::Group(group))) = (trees.get(at + 1), trees.get(at + 2))
        else {
            continue;
        };
        if bang.as_char() != '!' || !["include_str", "include_bytes", "include"].iter().any(|macro_| name == macro_) {
            continue;
        }
        let path = group.stream().to_string();
        let plain = path.strip_prefix('"').and_then(|path| path.trim_end_matches([',', ' ']).strip_suffix('"'));
        match plain {
            Some(plain) if !plain.contains(['\\', '"']) => found.push(plain.to_owned()),
            // The table that build.rs writes is a function of all that is counted here.
            _ if path.contains("OUT_DIR") => {}
            _ => return Err(format!("{name}!({path}): name the file by a plain literal, so that it can be counted")),
        }
    }
    Ok(())
}

const OPERATORS: &[&str] = &[
    "&&", "||", "==", "!=", "<=", ">=", "+=", "-=", "*=", "/=", "%=", "^=", "&=", "|=", "<<", ">>", "<<=", ">>=", "->",
    "=>", "::", "..", "...", "..=",
];

fn flatten(trees: &[TokenTree]) -> Vec<String> {
    let mut tokens = Vec::new();
    flatten_into(trees, false, &mut tokens);
    tokens
}

fn flatten_into(trees: &[TokenTree], in_macro: bool, tokens: &mut Vec<String>) {
    let mut is_open_operator = false;
    for (at, tree) in trees.iter().enumerate() {
        match tree {
            TokenTree::Punct(punct) => {
                let c = punct.as_char();
                let joined = match tokens.last() {
                    Some(last) if is_open_operator => Some(format!("{last}{c}")),
                    _ => None,
                };
                match joined.filter(|joined| OPERATORS.contains(&joined.as_str())) {
                    Some(joined) => {
                        tokens.pop();
                        tokens.push(joined);
                    }
                    None => {
                        if c == '>' && !in_macro && tokens.last().is_some_and(|last| last == ",") {
                            tokens.pop();
                        }
                        tokens.push(c.to_string());
                    }
                }
                is_open_operator = punct.spacing() == Spacing::Joint;
                continue;
            }
            TokenTree::Group(group) => {
                let is_macro = in_macro || is_macro_body(&trees[..at]);
                let is_call =
                    matches!(trees[..at].last(), Some(TokenTree::Ident(name)) if !is_keyword(&name.to_string()));
                flatten_group(group, is_macro, is_call, tokens);
            }
            other => tokens.push(other.to_string()),
        }
        is_open_operator = false;
    }
}

fn flatten_group(group: &Group, in_macro: bool, is_call: bool, tokens: &mut Vec<String>) {
    let (open, close) = match group.delimiter() {
        Delimiter::Parenthesis => ("(", ")"),
        Delimiter::Brace => ("{", "}"),
        Delimiter::Bracket => ("[", "]"),
        Delimiter::None => ("", ""),
    };
    let inner: Vec<TokenTree> = group.stream().into_iter().collect();
    let is_comma = |tree: &TokenTree| matches!(tree, TokenTree::Punct(p) if p.as_char() == ',');
    // `(a,)` is a tuple of one; every other trailing comma is layout, except for a macro.
    let is_tuple_of_one = group.delimiter() == Delimiter::Parenthesis
        && !is_call
        && inner.iter().filter(|tree| is_comma(tree)).count() == 1;
    let is_layout = !in_macro && !is_tuple_of_one && inner.last().is_some_and(is_comma);
    tokens.push(open.to_owned());
    flatten_into(if is_layout { &inner[..inner.len() - 1] } else { &inner }, in_macro, tokens);
    tokens.push(close.to_owned());
}

/// Whether a group after these trees is the body of a macro: `name!` or `macro_rules! name`.
fn is_macro_body(before: &[TokenTree]) -> bool {
    let before = match before {
        [rest @ .., TokenTree::Punct(_), TokenTree::Ident(_)] => &before[..=rest.len()],
        _ => before,
    };
    matches!(before, [.., TokenTree::Ident(_), TokenTree::Punct(punct)] if punct.as_char() == '!')
}

fn is_keyword(word: &str) -> bool {
    let keywords = "as async await break const continue crate dyn else enum extern false fn for if impl in let loop match \
                    mod move mut pub ref return static struct super trait true type unsafe use where while yield";
    keywords.split_whitespace().any(|keyword| keyword == word)
}

fn is_list(tokens: &[String]) -> bool {
    let mut tokens = tokens.iter().map(String::as_str).peekable();
    while tokens.peek().is_some() {
        if tokens.next_if_eq(&"pub").is_some() && tokens.next_if_eq(&"(").is_some() {
            tokens.by_ref().find(|token| *token == ")");
        }
        if tokens.next() != Some("mod") || tokens.next().is_none() || tokens.next() != Some(";") {
            return false;
        }
    }
    true
}

fn is_name(token: &str) -> bool {
    token.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

fn outside(tokens: &[String]) -> BTreeSet<String> {
    let word = |at: Option<usize>| at.and_then(|at| tokens.get(at)).map_or("", String::as_str);
    let begins_path = |at: usize| {
        let before = word(at.checked_sub(1));
        is_name(&tokens[at]) && before != "::" && (word(Some(at + 1)) == "::" || before == "use")
    };
    let inner = ["crate", "self", "super", "Self"];
    let names = (0..tokens.len()).filter(|at| begins_path(*at)).map(|at| tokens[at].clone());
    names.filter(|name| !inner.contains(&name.as_str())).collect()
}

/// The paths inside the crate that tokens name, from its root: by `crate::`, `self::`, `super::` and declared modules.
pub fn inside(tokens: &[String], module: &[&str]) -> BTreeSet<Vec<String>> {
    let mut here: Vec<String> = module.iter().map(|&name| name.to_owned()).collect();
    let (mut depth, mut opened) = (0_usize, Vec::new());
    let word = |at: usize| tokens.get(at).map_or("", String::as_str);
    let declared: BTreeSet<&str> =
        (0..tokens.len()).filter(|at| word(*at) == "mod" && word(at + 2) == ";").map(|at| word(at + 1)).collect();
    let mut found = BTreeSet::new();
    for at in 0..tokens.len() {
        let starts = at.checked_sub(1).is_none_or(|before| word(before) != "::") && word(at + 1) == "::";
        match word(at) {
            "{" => {
                depth += 1;
                if at >= 2 && word(at - 2) == "mod" {
                    here.push(word(at - 1).to_owned());
                    opened.push(depth);
                }
            }
            "}" => {
                if opened.last() == Some(&depth) {
                    opened.pop();
                    here.pop();
                }
                depth = depth.saturating_sub(1);
            }
            "crate" if starts => drop(tree(tokens, at + 2, &[], &mut found)),
            "self" if starts => drop(tree(tokens, at + 2, &here, &mut found)),
            "super" if starts => {
                let (mut at, mut base) = (at, here.clone());
                while word(at) == "super" && word(at + 1) == "::" {
                    base.pop();
                    at += 2;
                }
                tree(tokens, at, &base, &mut found);
            }
            name if starts && declared.contains(name) => drop(tree(tokens, at, &here, &mut found)),
            _ => {}
        }
    }
    found
}

/// Reads one tree of a `use`, or a path: the place after it.
fn tree(tokens: &[String], mut at: usize, base: &[String], found: &mut BTreeSet<Vec<String>>) -> usize {
    let mut path = base.to_vec();
    while let Some(token) = tokens.get(at) {
        if token == "{" {
            at += 1;
            while tokens.get(at).is_some_and(|token| token != "}") {
                let is_comma = tokens.get(at).is_some_and(|token| token == ",");
                let next = if is_comma { at } else { tree(tokens, at, &path, found) };
                at = next.max(at + 1);
            }
            return at + 1;
        }
        if is_name(token) || token == "*" {
            if token != "self" {
                path.push(token.clone());
            }
            at += 1;
        } else {
            break;
        }
        if tokens.get(at).is_some_and(|token| token == "::") {
            at += 1;
        } else {
            break;
        }
    }
    if path.len() > base.len() || !base.is_empty() {
        found.insert(path);
    }
    if tokens.get(at).is_some_and(|token| token == "as") { at + 2 } else { at }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_at(text: &str) -> Source {
        read(text, &["geometry", "spin"]).expect("tokens")
    }

    const BASE: &str = "
        use crate::numerics::real::Real;
        /// A sum.
        pub fn sum(a: f64, b: f64) -> f64 { a + b }
        pub const PAIR: (f64,) = (1.0,);
        #[cfg(test)]
        mod tests { use super::*; #[test] fn adds() { assert_eq!(sum(1.0, 2.0), 3.0); } }
    ";

    /// Edits that are not of the code leave the digest; the oracle is what the edit is.
    #[test]
    fn comments_docs_layout_and_tests_do_not_count() {
        let edits = [
            ("/// A sum.", "/// The sum of two numbers.\n/** and more */ #[doc = \"x\"]"),
            ("a + b", "// now\n a\n+ /* and here */ b"),
            ("(a: f64, b: f64)", "(\n a: f64,\n b: f64,\n)"),
            ("3.0);", "4.0); assert!(true);"),
            ("mod tests {", "mod more_tests { fn other() {} } #[cfg(all(test, unix))] mod tests {"),
            ("#[cfg(test)]", "#[cfg(test)] const X: [u8; 2] = [1, 2]; #[cfg(test)] use a::{b, c}; #[cfg(test)]"),
            ("    use crate", "//! Module docs.\n#![doc = \"more\"]\nuse crate"),
        ];
        for (from, to) in edits {
            assert!(BASE.contains(from), "{from}");
            assert_eq!(read_at(&BASE.replacen(from, to, 1)).digest, read_at(BASE).digest, "{from} → {to}");
        }
    }

    #[test]
    fn edits_of_the_code_count() {
        let edits = [
            ("a + b", "a - b"),
            ("a + b", "b + a"),
            ("a + b", "a + b + 0.0"),
            ("pub fn", "fn"),
            ("pub fn", "#[inline] pub fn"),
            ("(1.0,)", "(1.0)"),
            ("1.0,)", "1.00,)"),
            ("real::Real", "real::Other as Real"),
            ("#[cfg(test)]", "#[cfg(not(test))]"),
            ("#[cfg(test)]", "#[cfg(any(test, unix))]"),
        ];
        for (from, to) in edits {
            assert!(BASE.contains(from), "{from}");
            assert_ne!(read_at(&BASE.replacen(from, to, 1)).digest, read_at(BASE).digest, "{from} → {to}");
        }
    }

    /// Blanks between operators matter only where they part one token into two.
    #[test]
    fn operators_are_single_tokens() {
        let digest = |text: &str| read_at(text).digest;
        assert_ne!(digest("const X: bool = a && b;"), digest("const X: bool = a & &b;"));
        assert_eq!(digest("const X: i32 = -1;"), digest("const X: i32 =-1;"));
        assert_eq!(digest("type X = A<B, C,>;"), digest("type X = A<B, C>;"));
    }

    /// A trailing comma may choose a macro's arm, so it counts there; rustfmt leaves those alone.
    #[test]
    fn trailing_commas_count_in_macros() {
        let digest = |text: &str| read_at(text).digest;
        assert_ne!(digest("fn f() { m!(a, b,) }"), digest("fn f() { m!(a, b) }"));
        assert_ne!(digest("macro_rules! m { (a,) => {} }"), digest("macro_rules! m { (a) => {} }"));
    }

    /// A field or an arm under `cfg(test)` ends with its comma: its neighbours still count.
    #[test]
    fn fields_for_tests_do_not_hide_their_neighbours() {
        let digest = |text: &str| read_at(text).digest;
        let field = "struct S { #[cfg(test)] a: u8, b: u16 }";
        assert_eq!(digest(field), digest("struct S { b: u16 }"));
        assert_ne!(digest(field), digest("struct S { #[cfg(test)] a: u8, b: u32 }"));
    }

    #[test]
    fn lists_of_names_are_told_apart() {
        assert!(read_at("//! Docs.\npub mod a;\nmod b;\npub(crate) mod c;\n#[cfg(test)]\nmod d;").is_list);
        assert!(read_at("//! Docs.").is_list);
        assert!(!read_at("pub mod a; pub use a::A;").is_list);
        assert!(!read_at("mod a { }").is_list);
    }

    #[test]
    fn included_files_and_test_modules_are_named() {
        let source = read_at(
            "const A: &str = include_str!(\"a.toml\"); #[cfg(test)] mod oracle; #[cfg(test)] fn f() { include_str!(\"b\"); }",
        );
        assert_eq!(source.included, ["a.toml"]);
        assert_eq!(source.test_modules, BTreeSet::from(["oracle".to_owned()]));
        assert!(read("const A: &str = include_str!(PATH);", &[]).is_err());
    }

    #[test]
    fn paths_are_resolved_from_the_root() {
        let source = read_at(
            "use crate::{numerics::{real::{self, Real}, ulp as u}, table::*}; use super::chart::Chart; mod flow; \
             fn f() { flow::go(); self::g(); libm::sin(serde_json::json!(1)); crate::plot::axes::<u8>() } \
             mod inner { use super::h; } use rayon::{prelude};",
        );
        let paths: Vec<String> = source.inside.iter().map(|path| path.join("/")).collect();
        let expected = [
            "geometry/chart/Chart",
            "geometry/spin/flow/go",
            "geometry/spin/g",
            "geometry/spin/h",
            "numerics/real",
            "numerics/real/Real",
            "numerics/ulp",
            "plot/axes",
            "table/*",
        ];
        assert_eq!(paths, expected);
        for name in ["libm", "serde_json", "rayon"] {
            assert!(source.outside.contains(name), "{name}");
        }
    }
}
