#!/bin/sh
# Makes what the client tests need, once: a Python environment in target/clients-venv and the compiled Fortran reader.
# Prints the environment's python and, where gfortran is there, the reader, a line each. Installs nothing outside of target/.
# Does nothing, in milliseconds, when all is there.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
target=${CARGO_TARGET_DIR:-$here/../../../../target}
venv=$target/clients-venv
mkdir -p "$target"

# One set-up at a time: tests may start it together.
exec 9>"$target/clients-venv.lock"
flock 9

if ! cmp -s "$here/requirements.txt" "$venv/installed.txt"; then
    echo "clients: installing $here/requirements.txt into $venv" >&2
    "${PYTHON:-python3}" -m venv "$venv" >&2
    "$venv/bin/pip" install --quiet --disable-pip-version-check -r "$here/requirements.txt" >&2
    cp "$here/requirements.txt" "$venv/installed.txt"
fi
echo "$venv/bin/python"

if command -v gfortran >/dev/null; then
    if [ ! "$target/read_wrp" -nt "$here/read_wrp.f90" ]; then
        gfortran -std=f2008 -Wall -Wextra -Wno-compare-reals -Werror -O2 -o "$target/read_wrp" "$here/read_wrp.f90" >&2
    fi
    echo "$target/read_wrp"
else
    echo "clients: no gfortran, so that nothing reads the decks" >&2
fi
