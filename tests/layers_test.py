#!/usr/bin/env python3
"""Holds every #include of the sources against the table of layers (draco_ext/README.md): layers_test.py ROOT"""
import pathlib
import re
import sys

# Lowest first: a layer includes itself and what stands before it.
LAYERS = ["common", "decoder", "geometry", "remesh", "encoder", "draco", "gltf", "plugin", "samples"]

# The layers that may include a third-party library. Whatever is not listed, nobody may.
LIBRARIES = {
    "Eigen": {"geometry", "remesh", "encoder"},
    "tbb": {"geometry", "remesh", "encoder", "draco", "plugin"},
    "draco": {"draco", "gltf"},
    "nlohmann": {"gltf", "plugin"},
    "meshoptimizer.h": {"gltf"},
    "tiny_gltf.h": {"gltf", "samples"},
    "CLI": {"plugin"},
    "lacerta.h": {"plugin", "samples"},
    "fcntl.h": {"gltf"},
    "unistd.h": {"gltf", "plugin"},
    "sys": {"gltf", "plugin"},
}

# The layer that an installed header belongs to. decoder.h and attributed_*.h are with `common`: they hold what both sides share, the base
# mesh with its attributes and the limits.
INSTALLED = {
    "lacerta.h": "plugin",
    "status.h": "common", "vec3.h": "common", "mesh.h": "common", "decoder.h": "common",
    "attributed_mesh.h": "common", "attributed_levels.h": "common", "attributed_base.h": "common",
    "surface_distance.h": "geometry", "attribute_distance.h": "geometry",
    "clean.h": "remesh", "remesh.h": "remesh",
    "codec.h": "draco", "draco.h": "draco",
    "file_io.h": "gltf", "file_mesh.h": "gltf", "mesh_file.h": "gltf", "gltf.h": "gltf", "parsed_gltf.h": "gltf", "tinygltf.h": "gltf",
}
# Installed headers that may include a third-party library, and which.
INSTALLED_LIBRARIES = {"draco.h": {"draco"}, "tinygltf.h": {"tiny_gltf.h"}}

C_STANDARD_LIBRARY = {"stddef.h", "stdint.h", "stdio.h", "stdlib.h", "string.h", "time.h"}
GLTF_FOLDERS = {"document", "extension", "mesh_file", "pack", "trim", "unpack", "validate"}
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)


def layer_of_file(path):
    """Layer of a source by its path from the root; None where the table does not know it."""
    parts = path.split("/")
    if "include" in parts:
        return INSTALLED.get(parts[-1])
    layer = parts[1] if parts[0] == "draco_ext" else parts[0]
    return layer if layer in LAYERS else None


def layer_of_include(name):
    """Layer of a quoted include; None where it is a file beside the one that includes it or unknown."""
    parts = name.split("/")
    if parts[0] == "lacerta":
        return INSTALLED.get(parts[-1])
    if parts[0] in GLTF_FOLDERS:
        return "gltf"
    return parts[0] if parts[0] in LAYERS else None


def problem(path, bracket, name):
    """What is wrong with one include, or None."""
    layer = layer_of_file(path)
    first = name.split("/")[0]
    if bracket == '"' or first == "lacerta":
        if "/" not in name:
            return None if layer == "plugin" else "paths are relative to draco_ext/ or gltf/"
        other = layer_of_include(name)
        if other is None:
            return "not in the table of layers"
        if LAYERS.index(other) > LAYERS.index(layer):
            return f"{layer} may not include {other}"
        if "include" in path.split("/") and first != "lacerta":
            return "an installed header includes one that is not installed"
        return None
    if "/" not in name and ("." not in name or name in C_STANDARD_LIBRARY):
        return None
    if first not in LIBRARIES:
        return "a library that is not in the table"
    if layer not in LIBRARIES[first]:
        return f"{layer} may not include {first}"
    if "include" in path.split("/") and first not in INSTALLED_LIBRARIES.get(path.split("/")[-1], set()):
        return f"an installed header may not include {first}"
    return None


def violations(sources):
    """sources: path from the root -> text. Returns one line per include, or file, that breaks the table."""
    found = []
    for path, text in sorted(sources.items()):
        if layer_of_file(path) is None:
            found.append(f"{path}: its layer is not in the table")
            continue
        for match in INCLUDE.finditer(text):
            what = problem(path, match[1], match[2])
            if what:
                line = text.count("\n", 0, match.start(2)) + 1
                found.append(f"{path}:{line}: {match[2]}: {what}")
    return found


# One of each kind that has to be found.
PLANTED = {
    "draco_ext/common/a.cc": '#include "decoder/synthesis.h"',
    "draco_ext/decoder/a.cc": "#include <Eigen/Core>",
    "draco_ext/decoder/b.cc": '#include "encoder/analysis.h"',
    "draco_ext/decoder/c.cc": '#  include "lacerta/surface_distance.h"',
    "draco_ext/decoder/d.cc": "#include <zlib.h>",
    "draco_ext/encoder/a.cc": "#include <draco/mesh/mesh.h>",
    "draco_ext/encoder/b.cc": '#include "pack/plan.h"',
    "draco_ext/encoder/c.cc": '#include "analysis.h"',
    "draco_ext/draco/a.cc": "#include <Eigen/Dense>",
    "draco_ext/include/lacerta/codec.h": "#include <draco/mesh/mesh.h>",
    "draco_ext/include/lacerta/mesh.h": '#include "lacerta/codec.h"',
    "draco_ext/include/lacerta/draco.h": '#include "draco/stock_stream.h"',
    "draco_ext/include/lacerta/unheard_of.h": "",
    "draco_ext/viewer/a.cc": "",
    "gltf/pack/a.cc": "#include <CLI/CLI.hpp>",
    "plugin/cli/a.cc": '#include "tests/shapes/shapes.h"',
    "samples/a.cc": "#include <Eigen/Core>",
}


def main(root):
    missed = [path for path, text in PLANTED.items() if len(violations({path: text})) != 1]
    if missed:
        sys.exit("planted violations not found: " + ", ".join(missed))
    sources = {}
    for folder in ["draco_ext", "gltf", "plugin", "samples"]:
        for file in sorted((root / folder).rglob("*")):
            if file.suffix in {".c", ".h", ".cc", ".cpp"} and not {"build", "node_modules"} & set(file.relative_to(root).parts):
                sources[file.relative_to(root).as_posix()] = file.read_text(encoding="utf-8")
    if len(sources) < 50:
        sys.exit(f"{root}: only {len(sources)} sources found; the first argument has to be the root of the repository")
    found = violations(sources)
    print("\n".join(found))
    print(f"{len(sources)} files, {len(found)} violations")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve()))
