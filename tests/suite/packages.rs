//! What a registry gets holds every file that its sources include.

use crate::common::repository;
use std::collections::BTreeSet;
use std::path::{Component, Path, PathBuf};
use std::process::Command;

use syn::visit::Visit;
use syn::{Attribute, ItemFn, ItemMod, LitStr, Macro};

/// The crates that are packaged, with their folders.
const PACKAGES: [(&str, &str); 4] = [
    ("wheelrail", "."),
    ("wheelrail-check", "crates/check"),
    ("wheelrail-report", "crates/report"),
    ("wheelrail-cli", "crates/cli"),
];

/// What a source file includes and which of its modules are files of tests.
#[derive(Default)]
struct Included {
    files: Vec<String>,
    tests: Vec<String>,
}

fn is_test(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        let cfg = attribute.path().is_ident("cfg")
            && attribute.parse_args::<syn::Ident>().is_ok_and(|of| of == "test");
        cfg || attribute.path().is_ident("test")
    })
}

impl<'ast> Visit<'ast> for Included {
    fn visit_item_mod(&mut self, item: &'ast ItemMod) {
        match (is_test(&item.attrs), &item.content) {
            (true, None) => self.tests.push(item.ident.to_string()),
            (true, Some(_)) => {}
            (false, _) => syn::visit::visit_item_mod(self, item),
        }
    }

    fn visit_item_fn(&mut self, item: &'ast ItemFn) {
        if !is_test(&item.attrs) {
            syn::visit::visit_item_fn(self, item);
        }
    }

    fn visit_macro(&mut self, item: &'ast Macro) {
        let name = item.path.segments.last().map(|last| last.ident.to_string()).unwrap_or_default();
        if name.starts_with("include") {
            self.files.push(item.parse_body::<LitStr>().expect("the path of an include").value());
        }
    }
}

/// A path without its steps upward.
fn plain(path: &Path) -> PathBuf {
    let mut out = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => drop(out.pop()),
            Component::CurDir => {}
            other => out.push(other),
        }
    }
    out
}

/// The files of a package, relative to its folder.
fn listed(package: &str) -> BTreeSet<PathBuf> {
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["package", "--list", "--allow-dirty", "--locked", "--offline", "-p", package]);
    let output = cargo.current_dir(repository("")).output().expect("cargo");
    assert!(output.status.success(), "{package}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8_lossy(&output.stdout).lines().map(PathBuf::from).collect()
}

#[test]
fn packages_hold_what_their_sources_include() {
    let mut included = 0;
    for (package, folder) in PACKAGES {
        let folder = repository(folder);
        let files = listed(package);
        let (mut wanted, mut tests) = (Vec::new(), Vec::new());
        for file in files
            .iter()
            .filter(|file| file.starts_with("src") && file.extension().is_some_and(|end| end == "rs"))
        {
            let text = std::fs::read_to_string(folder.join(file)).expect("a source file");
            let mut found = Included::default();
            found.visit_file(&syn::parse_file(&text).expect("Rust"));
            let beside = file.parent().expect("src");
            let stem = file.file_stem().expect("a name").to_string_lossy();
            let own =
                if ["mod", "lib", "main"].contains(&&*stem) { beside.into() } else { beside.join(&*stem) };
            tests.extend(found.tests.into_iter().map(|name| own.join(name)));
            wanted.extend(found.files.into_iter().map(|path| (file.clone(), plain(&beside.join(path)))));
        }
        // A module of tests and what is below it: packages are built without them.
        let of_tests = |file: &Path| tests.iter().any(|test| file.with_extension("").starts_with(test));
        for (file, path) in wanted.iter().filter(|(file, _)| !of_tests(file)) {
            assert!(
                files.contains(path),
                "{package}: {} includes {}, which is not packaged",
                file.display(),
                path.display()
            );
            included += 1;
        }
    }
    assert!(included > 20, "only {included} files are included");
}
