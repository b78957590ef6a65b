"""Files of results against what `driftwright schema` says that they hold, by a validator of another make."""
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
    """Sentences, of a diagnosis.json or calibration.json."""
    found = _validator(str(program), file.stem).iter_errors(json.loads(file.read_text()))
    return [f"{'/'.join(map(str, e.absolute_path))}: {e.message[:300]}" for e in found]
