#!/bin/sh
# Makes what the tests of the pages need, once: the packages of src/export/html/package-lock.json in target/clients-node, beside
# a copy of the pages' sources. Prints that folder and the browser, a line each. Installs nothing outside of target/.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
pages=$here/../../../../src/export/html
target=${CARGO_TARGET_DIR:-$here/../../../../target}
node=$target/clients-node
for tool in node npm; do
    command -v "$tool" >/dev/null || { echo "pages: $tool is missing" >&2; exit 1; }
done
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome) || {
    echo "pages: chromium is missing" >&2
    exit 1
}
mkdir -p "$node"

# One set-up at a time: tests may start it together.
exec 9>"$target/clients-node.lock"
flock 9

rm -rf "$node/source"
cp -r "$pages/package.json" "$pages/package-lock.json" "$pages/build.mjs" "$pages/source" "$node"
cp "$here/pages.mjs" "$here/check_page.mjs" "$here/check_keys.mjs" "$node"
if ! cmp -s "$node/package-lock.json" "$node/node_modules/installed.json"; then
    echo "pages: installing $pages/package-lock.json into $node" >&2
    (cd "$node" && npm ci --no-audit --no-fund --loglevel=error) >&2
    cp "$node/package-lock.json" "$node/node_modules/installed.json"
fi
cd "$node" && pwd
echo "$browser"
