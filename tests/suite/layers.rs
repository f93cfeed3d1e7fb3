//! Imports run one way, between rooms and between files.

use crate::common::repository;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use syn::visit::Visit;

/// Rooms of the library from the bottom up; each may use those before it and itself.
const ORDER: [&str; 20] = [
    "error",
    "numerics",
    "files",
    "profile",
    "lofted",
    "measured",
    "measure",
    "placement",
    "separation",
    "search",
    "conformal",
    "patch",
    "load",
    "table",
    "mesh",
    "export",
    "case",
    "scene",
    "fleet",
    "docs",
];

/// Source folders of all crates.
const SOURCES: [&str; 5] =
    ["src", "crates/check/src", "crates/report/src", "crates/cli/src", "crates/python/src"];

/// Names from the root of a crate to a module or an item.
type Names = Vec<String>;

/// What one file imports, exports, defines and implements.
#[derive(Default)]
struct File {
    /// Its module.
    module: Names,
    /// Every path it names, resolved as far as its own text allows.
    paths: BTreeSet<Names>,
    /// Names that it re-exports, with their paths.
    exports: BTreeMap<String, Names>,
    /// Types that it defines.
    types: BTreeSet<String>,
    /// Types that it has inherent implementations of.
    implementations: Vec<String>,
}

/// All files of one crate by their modules.
struct Tree(BTreeMap<Names, File>);

fn sources(folder: &Path, out: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a source folder").flatten() {
        let path = entry.path();
        if path.is_dir() {
            sources(&path, out);
        } else if path.extension().is_some_and(|e| e == "rs") {
            out.push(path);
        }
    }
}

/// The module of a file below a source folder.
fn module(inside: &Path) -> Names {
    let mut names: Names =
        inside.with_extension("").components().map(|c| c.as_os_str().to_string_lossy().into()).collect();
    if names.last().is_some_and(|name| ["mod", "lib", "main"].contains(&name.as_str())) {
        names.pop();
    }
    names
}

/// Whether an item is there for tests only.
fn for_tests(attributes: &[syn::Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("cfg")
            && attribute.parse_args::<syn::Ident>().is_ok_and(|condition| condition == "test")
    })
}

impl File {
    fn read(module: Names, text: &str) -> Self {
        let mut file = Self { module, ..Self::default() };
        file.visit_file(&syn::parse_file(text).expect("a source file that compiles"));
        file
    }

    /// A path from the root of the crate; `None` for what does not begin with `crate`, `self` or `super`.
    fn absolute(&self, path: &[String]) -> Option<Names> {
        let mut names = match path.first()?.as_str() {
            "crate" => Vec::new(),
            "self" | "super" => self.module.clone(),
            _ => return None,
        };
        for name in path {
            match name.as_str() {
                "crate" | "self" => {}
                "super" => drop(names.pop()),
                name => names.push(name.into()),
            }
        }
        Some(names)
    }

    /// Notes a path; one that begins with a name is that of a child module, if there is one.
    fn note(&mut self, path: &[String]) -> Names {
        let names =
            self.absolute(path).unwrap_or_else(|| self.module.iter().chain(path).cloned().collect::<Names>());
        self.paths.insert(names.clone());
        names
    }

    fn use_tree(&mut self, tree: &syn::UseTree, before: &[String], public: bool) {
        let with = |name: &syn::Ident| before.iter().cloned().chain([name.to_string()]).collect::<Names>();
        match tree {
            syn::UseTree::Path(path) => self.use_tree(&path.tree, &with(&path.ident), public),
            syn::UseTree::Group(group) => {
                group.items.iter().for_each(|tree| self.use_tree(tree, before, public));
            }
            syn::UseTree::Glob(_) => drop(self.note(before)),
            syn::UseTree::Name(syn::UseName { ident }) if ident == "self" => drop(self.note(before)),
            syn::UseTree::Name(syn::UseName { ident }) => self.use_name(&with(ident), ident, public),
            syn::UseTree::Rename(syn::UseRename { ident, rename, .. }) => {
                self.use_name(&with(ident), rename, public);
            }
        }
    }

    fn use_name(&mut self, path: &[String], name: &syn::Ident, public: bool) {
        let names = self.note(path);
        if public {
            self.exports.insert(name.to_string(), names);
        }
    }
}

impl<'ast> Visit<'ast> for File {
    fn visit_item(&mut self, item: &'ast syn::Item) {
        let attributes = match item {
            syn::Item::Mod(item) => &item.attrs,
            syn::Item::Fn(item) => &item.attrs,
            syn::Item::Use(item) => &item.attrs,
            syn::Item::Impl(item) => &item.attrs,
            _ => return syn::visit::visit_item(self, item),
        };
        if !for_tests(attributes) {
            syn::visit::visit_item(self, item);
        }
    }

    fn visit_item_use(&mut self, item: &'ast syn::ItemUse) {
        self.use_tree(&item.tree, &[], !matches!(item.vis, syn::Visibility::Inherited));
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let names: Names = path.segments.iter().map(|segment| segment.ident.to_string()).collect();
        if names.len() > 1 {
            self.note(&names);
        }
        syn::visit::visit_path(self, path);
    }

    /// `pub(in path)` names where an item is seen, not what it needs.
    fn visit_visibility(&mut self, _: &'ast syn::Visibility) {}

    /// A macro that is given a type defines it.
    fn visit_item_macro(&mut self, item: &'ast syn::ItemMacro) {
        let tokens = item.mac.tokens.to_string();
        let words: Vec<&str> = tokens.split_whitespace().collect();
        let defined = words.windows(2).filter(|pair| ["struct", "enum"].contains(&pair[0]));
        self.types.extend(defined.map(|pair| pair[1].to_string()));
        syn::visit::visit_item_macro(self, item);
    }

    fn visit_item_struct(&mut self, item: &'ast syn::ItemStruct) {
        self.types.insert(item.ident.to_string());
        syn::visit::visit_item_struct(self, item);
    }

    fn visit_item_enum(&mut self, item: &'ast syn::ItemEnum) {
        self.types.insert(item.ident.to_string());
        syn::visit::visit_item_enum(self, item);
    }

    fn visit_item_type(&mut self, item: &'ast syn::ItemType) {
        self.types.insert(item.ident.to_string());
        syn::visit::visit_item_type(self, item);
    }

    fn visit_item_impl(&mut self, item: &'ast syn::ItemImpl) {
        if let (None, syn::Type::Path(of)) = (&item.trait_, &*item.self_ty) {
            self.implementations.extend(of.path.segments.last().map(|segment| segment.ident.to_string()));
        }
        syn::visit::visit_item_impl(self, item);
    }
}

impl Tree {
    fn of(files: impl IntoIterator<Item = (Names, String)>) -> Self {
        Self(files.into_iter().map(|(module, text)| (module.clone(), File::read(module, &text))).collect())
    }

    fn of_folder(folder: &str) -> Self {
        let folder = repository(folder);
        let mut files = Vec::new();
        sources(&folder, &mut files);
        Self::of(files.iter().filter(|file| !file.components().any(|c| c.as_os_str() == "tests")).filter_map(
            |file| {
                let module = module(file.strip_prefix(&folder).expect("a path below it"));
                let text = std::fs::read_to_string(file).expect("a source file");
                (module.last().map(String::as_str) != Some("tests")).then_some((module, text))
            },
        ))
    }

    /// The file that defines what a path leads to, through re-exports; `None` outside this crate.
    fn home(&self, path: &[String], depth: usize) -> Option<&Names> {
        let length = (0..=path.len()).rev().find(|&n| self.0.contains_key(&path[..n]))?;
        let file = &self.0[&path[..length]];
        let exported = path.get(length).and_then(|name| file.exports.get(name));
        match exported {
            Some(further) if depth < 8 && further != path => self.home(further, depth + 1),
            // A name of the outside (std, another crate), not of this module.
            _ if length == 0 && !path.is_empty() && !file.types.contains(&path[0]) => None,
            _ => Some(&file.module),
        }
    }

    /// The files that a file imports.
    fn imports(&self, file: &File) -> BTreeSet<&Names> {
        let homes = file.paths.iter().filter_map(|path| self.home(path, 0));
        homes.filter(|home| **home != file.module).collect()
    }

    /// A ring of files that import each other.
    fn ring(&self) -> Option<Vec<String>> {
        let edges: BTreeMap<&Names, BTreeSet<&Names>> =
            self.0.values().map(|file| (&file.module, self.imports(file))).collect();
        let mut done = BTreeSet::new();
        let mut path = Vec::new();
        edges.keys().find_map(|&module| ring_from(module, &edges, &mut path, &mut done))
    }
}

fn ring_from<'t>(
    module: &'t Names,
    edges: &BTreeMap<&'t Names, BTreeSet<&'t Names>>,
    path: &mut Vec<&'t Names>,
    done: &mut BTreeSet<&'t Names>,
) -> Option<Vec<String>> {
    if let Some(from) = path.iter().position(|other| *other == module) {
        return Some(path[from..].iter().map(|names| names.join("/")).collect());
    }
    if done.contains(module) {
        return None;
    }
    path.push(module);
    let found = edges[module].iter().find_map(|next| ring_from(next, edges, path, done));
    path.pop();
    done.insert(module);
    found
}

#[test]
fn no_files_import_each_other_in_a_ring() {
    for folder in SOURCES {
        let tree = Tree::of_folder(folder);
        assert!(tree.0.len() > 5, "only {} files in {folder}", tree.0.len());
        assert_eq!(tree.ring(), None, "a ring of imports in {folder}");
    }
}

#[test]
fn planted_rings_are_found() {
    let tree = |files: &[(&str, &str)]| {
        Tree::of(files.iter().map(|(module, text)| {
            (module.split('/').filter(|name| !name.is_empty()).map(String::from).collect(), (*text).into())
        }))
    };
    let plain = [("", "mod a; mod b;"), ("a", "use crate::b::{self, f};"), ("b", "pub fn f() {}")];
    assert_eq!(tree(&plain).ring(), None);
    for back in [
        "pub fn f() { crate::a::g() }",
        "use super::a as other;",
        "use crate::{a::{x, y}, b};",
        "mod inner { use crate::a; }",
        "pub fn f() -> super::a::T { loop {} }",
    ] {
        let ring = tree(&[plain[0], plain[1], ("b", back)]).ring();
        assert_eq!(ring, Some(vec!["a".into(), "b".into()]), "{back}");
    }
    let through_export = [
        ("", "mod room;"),
        ("room", "mod a; mod b; pub use a::A;"),
        ("room/a", "use super::b::B; pub struct A;"),
        ("room/b", "use super::A; pub struct B;"),
    ];
    assert_eq!(tree(&through_export).ring(), Some(vec!["room/a".into(), "room/b".into()]));
    let in_tests = [plain[0], plain[1], ("b", "#[cfg(test)] mod tests { use crate::a; }")];
    assert_eq!(tree(&in_tests).ring(), None);
}

/// A method in another file than its type hides an import from the caller to that file.
#[test]
fn types_are_implemented_where_they_are_defined() {
    let mut strangers = Vec::new();
    for folder in SOURCES {
        for file in Tree::of_folder(folder).0.values() {
            let others = file.implementations.iter().filter(|name| !file.types.contains(*name));
            strangers.extend(others.map(|name| format!("{folder}/{}: {name}", file.module.join("/"))));
        }
    }
    assert!(strangers.is_empty(), "{strangers:#?}");
}

/// Classes of the Python package have the names of what they wrap.
#[test]
fn a_type_name_means_one_thing() {
    let mut homes: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for folder in SOURCES.into_iter().filter(|folder| *folder != "crates/python/src") {
        for file in Tree::of_folder(folder).0.values() {
            // A macro's parameter is no name.
            for name in file.types.iter().filter(|name| *name != "$") {
                homes.entry(name.clone()).or_default().push(format!("{folder}/{}", file.module.join("/")));
            }
        }
    }
    assert!(homes.len() > 400, "only {} types were found", homes.len());
    homes.retain(|_, files| files.len() > 1);
    assert!(homes.is_empty(), "{homes:#?}");
}

#[test]
fn no_room_imports_upward() {
    let tree = Tree::of_folder("src");
    let rank = |names: &Names| {
        let room = names.first()?;
        let place = ORDER.iter().position(|name| name == room);
        Some(place.unwrap_or_else(|| panic!("{room} has no place in the order")))
    };
    let mut seen = 0;
    for file in tree.0.values() {
        let Some(own) = rank(&file.module) else { continue };
        for import in tree.imports(file) {
            seen += 1;
            let to = import.join("/");
            assert!(rank(import).is_none_or(|other| other <= own), "{} imports {to}", file.module.join("/"));
        }
    }
    assert!(seen > 300, "only {seen} imports were looked at");
}

#[test]
fn one_room_touches_the_disk() {
    let src = repository("src");
    let mut files = Vec::new();
    sources(&src, &mut files);
    let elsewhere = files.iter().filter(|file| !file.starts_with(src.join("files")));
    for file in elsewhere.filter(|file| !file.ends_with("tests.rs")) {
        let text = std::fs::read_to_string(file).expect("a source file");
        let code = text.split("#[cfg(test)]").next().unwrap_or_default();
        let found = ["std::fs", "std::os", "rustix::fs"].into_iter().find(|word| code.contains(word));
        assert_eq!(found, None, "{}", file.display());
    }
}
