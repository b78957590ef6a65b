"""Checks files of results against the schema of `driftwright schema`, with an independent validator."""
import functools
import json
import subprocess

import jsonschema


@functools.cache
def _validator(program, what):
    schema = json.loads(subprocess.run([program, "schema", what], capture_output=True, text=True, check=True).stdout)
    jsonschema.Draft7Validator.check_schema(schema)
    return jsonschema.Draft7Validator(schema)


def errors(program, file):
    """Error messages for a diagnosis.json or calibration.json."""
    found = _validator(str(program), file.stem).iter_errors(json.loads(file.read_text()))
    return [f"{'/'.join(map(str, e.absolute_path))}: {e.message[:300]}" for e in found]
