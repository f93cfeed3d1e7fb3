"""Runs several checks of several folders in one process, since most of their time goes into what they import.

    check_each.py READ_WRP SCRIPT... -- FOLDER...
"""

import pathlib
import runpy
import sys

reader, *rest = sys.argv[1:]
scripts, folders = rest[: rest.index("--")], rest[rest.index("--") + 1 :]
failed = False
for folder in folders:
    for script in scripts:
        sys.argv = [script, folder, reader]
        try:
            runpy.run_path(str(pathlib.Path(__file__).with_name(script)), run_name="__main__")
        except SystemExit as end:
            failed |= bool(end.code)
sys.exit(failed)
