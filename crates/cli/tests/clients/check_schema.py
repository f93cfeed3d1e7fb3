"""The schema of scenes: every example is valid, and with any one key misspelt none is."""

import json
import pathlib
import sys
import tomllib

import jsonschema

schema = json.loads(pathlib.Path(sys.argv[1]).read_text())
jsonschema.Draft202012Validator.check_schema(schema)
validator = jsonschema.Draft202012Validator(schema)


def misspelt(value):
    """The same with one key misspelt, for every key in turn."""
    if isinstance(value, dict):
        for key in value:
            yield {(k + "x" if k == key else k): v for k, v in value.items()}
            for other in misspelt(value[key]):
                yield {**value, key: other}
    elif isinstance(value, list):
        for number, item in enumerate(value):
            for other in misspelt(item):
                yield value[:number] + [other] + value[number + 1 :]


files = sorted(pathlib.Path(sys.argv[2]).glob("*.toml"))
assert files, sys.argv[2]
for file in files:
    scene = tomllib.loads(file.read_text())
    validator.validate(scene)
    count = 0
    for wrong in misspelt(scene):
        assert not validator.is_valid(wrong), f"{file.name}: accepted {wrong}"
        count += 1
    print(f"{file.name}: valid; {count} misspelt keys refused")
