"""The programs in Python in the docs, run as they stand in the folder of 60E1 under S1002: FOLDER CLIENTS_MD."""

import os
import re
import sys

import tamaas
from folder import Checks

page = open(sys.argv[2], encoding="utf-8").read()
programs = re.findall(r"```python\n(.*?)```", page, re.S)
os.chdir(sys.argv[1])
tamaas.set_log_level(tamaas.LogLevel.error)
checks, peaks = Checks("docs"), []
for program in programs:
    names = {}
    exec(program, names)
    peaks.append(names["pressure"].max())
checks("two programs", len(programs) == 2)
checks.near("their peak pressures agree", peaks[0], peaks[1], 0.005)
checks.done()
