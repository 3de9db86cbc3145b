#!/usr/bin/env python3
"""Holds the example assets of LACERTA_mesh_progressive, and the JSON in its README, against its JSON schemas: schema_test.py FOLDER.
Ends with 77 where this Python has no jsonschema (Debian's: python3-jsonschema)."""

import json
import re
import struct
import sys
from pathlib import Path

try:
    import jsonschema
except ImportError:
    print("skipped: there is no jsonschema for", sys.executable)
    sys.exit(77)

NAME = "LACERTA_mesh_progressive"
# What the schemas of glTF 2.0 that these refer to say.
KNOWN = {"glTFProperty": {"$id": "glTFProperty.schema.json", "type": "object"}, "glTFid": {"$id": "glTFid.schema.json", "type": "integer", "minimum": 0}}


def validator(path):
    schema = json.loads(path.read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator({**schema, "$defs": KNOWN})


def problems(schema, value, where):
    """What is wrong with `value`, as texts."""
    return [f"{where}{error.json_path[1:]}: {error.message}" for error in schema.iter_errors(value)]


def extension(element):
    return element.get("extensions", {}).get(NAME)


def asset_problems(schemas, asset, where):
    """Of the extension in an asset, or in the part of one that the README shows."""
    found, count = [], 0
    if extension(asset) is not None:
        found += problems(schemas["glTF"], extension(asset), f"{where}: root")
        count += 1
    for mesh in asset.get("meshes", []):
        for primitive in mesh["primitives"]:
            if extension(primitive) is not None:
                found += problems(schemas["mesh.primitive"], extension(primitive), f"{where}: primitive")
                count += 1
    return found if count > 0 else [f"{where}: does not use {NAME}"]


def json_of(path):
    data = path.read_bytes()
    return json.loads(data[20:20 + struct.unpack("<I", data[12:16])[0]])


def broken(asset):
    """Assets that the schemas have to refuse."""
    for change in [lambda e: e.pop("data"), lambda e: e.update(version=2), lambda e: e["segments"].update(stream=[]),
                   lambda e: e["streams"][0].update(min=[0, 0]), lambda e: e["streams"][0].update(errors=["small"]),
                   lambda e: e["streams"][0].update(vertexCounts=[2]), lambda e: e["segments"].update(byteLength=[-1]),
                   lambda e: e["streams"][0].update(joints=[1, 1]), lambda e: e.update(data=1.5)]:
        copy = json.loads(json.dumps(asset))
        change(extension(copy))
        yield copy


def main():
    folder = Path(sys.argv[1])
    schemas = {kind: validator(folder / f"schema/{kind}.{NAME}.schema.json") for kind in ["glTF", "mesh.primitive"]}
    examples = sorted((folder / "examples").glob("*.glb"))
    found = [problem for path in examples for problem in asset_problems(schemas, json_of(path), path.name)]
    texts = re.findall(r"```json\n(.*?)```", (folder / "README.md").read_text(), re.S)
    whole, *parts = [json.loads(text) for text in texts]
    found += asset_problems(schemas, whole, "README.md, first example")
    for part in parts:  # only what differs: laid over the first
        extension(whole)["streams"][0].update(extension(part)["streams"][0])
        whole["meshes"] = part["meshes"]
        found += asset_problems(schemas, whole, "README.md, next example")
    for i, asset in enumerate(broken(json_of(examples[0]))):
        if not asset_problems(schemas, asset, ""):
            found.append(f"what is broken in way {i} passes")
    if len(examples) < 3 or len(texts) < 2:
        found.append(f"{len(examples)} examples and {len(texts)} pieces of JSON are too few")
    print("\n".join(found) or f"{len(examples)} assets and {len(texts)} pieces of JSON agree with the schemas")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
