"""What the tables of this folder share: running the command, reading peers' figures, writing a table twice (.md and .csv)."""

import argparse
import csv
import json
import math
import multiprocessing
import os
import resource
import subprocess
import tempfile
import time
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]
EXIT_OK, EXIT_TARGET_MISSED = 0, 5


def table_arguments(description, meshes):
    """The arguments that every table takes, in a parser; `meshes` are measured where none is named."""
    shared = Path(os.environ.get("LACERTA_SHARED_DIR", PROJECT.parent / "shared"))
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("meshes", nargs="*", default=meshes, help="names of meshes; default: " + " ".join(meshes))
    parser.add_argument("--data", type=Path, default=shared / "data", help="folder of NAME.ply")
    parser.add_argument("--peers", type=Path, default=shared / "peers", help="folder of NAME.csv and vdmc/NAME.csv")
    parser.add_argument("--command", type=Path, default=PROJECT / "build/release/bin/lacerta", help="the lacerta command")
    parser.add_argument("--out", type=Path, default=PROJECT / "docs/results", help="folder of the tables")
    return parser


def checked(parser):
    """The arguments of a parser of table_arguments, once the files that they name are seen to be there."""
    arguments = parser.parse_args()
    missing = [str(p) for p in [arguments.command] + [arguments.data / f"{m.partition(chr(58))[0]}.ply" for m in arguments.meshes] if not p.exists()]
    if missing:
        parser.error("not found: " + ", ".join(missing))
    return arguments


def parse_arguments(description, meshes):
    return checked(table_arguments(description, meshes))


def run(command):
    """Runs a command that prints JSON. Returns what it printed, seconds of wall clock and of all its threads."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    start = time.monotonic()
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    seconds = time.monotonic() - start
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode not in (EXIT_OK, EXIT_TARGET_MISSED):
        raise SystemExit(f"{' '.join(map(str, command))}: exit {done.returncode}: {done.stderr.strip()}")
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return json.loads(done.stdout), seconds, cpu


def run_with_peak(command):
    """What a command prints as JSON, its seconds of wall clock and of all threads, and the bytes of memory at its peak."""
    start = time.monotonic()
    with tempfile.TemporaryFile("w+") as out:
        process = subprocess.Popen([str(word) for word in command], stdout=out)
        _, status, usage = os.wait4(process.pid, 0)
        seconds = time.monotonic() - start
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode not in (EXIT_OK, EXIT_TARGET_MISSED):
            raise SystemExit(f"{' '.join(map(str, command))}: exit {process.returncode}")
        out.seek(0)
        return json.load(out), seconds, usage.ru_utime + usage.ru_stime, 1024 * usage.ru_maxrss


def in_own_process(function, *arguments):
    """What a function returns, called in a process of its own: what a process takes before it becomes a command counts as the command's memory."""
    with multiprocessing.Pool(1) as pool:
        return pool.apply(function, arguments)


def pack_and_check(lacerta, mesh, *options):
    """Packs a mesh file as a stream, unpacks the file again and measures that against the mesh. The measuring takes other
    samples than the encoder took, so that it checks its report."""
    with tempfile.TemporaryDirectory() as folder:
        stream, back = Path(folder) / "stream.drc", Path(folder) / "back.ply"
        report, pack_s, pack_cpu_s = run([lacerta, "pack", mesh, "-o", stream, "--json", *options])
        _, unpack_s, _ = run([lacerta, "unpack", stream, "-o", back, "--json"])
        check, _, _ = run([lacerta, "compare", mesh, back, "--samples", 300_000, "--json"])
        size = stream.stat().st_size
    encode = report["encode"]
    finest = encode["levels"][-1]
    assert size == report["bytes"] == finest["bytes"], "the report is wrong about the bytes"
    return {
        "bytes": size,
        "bpv": 8 * size / encode["inputVertices"],
        "psnr": check["psnr"],
        "psnr_reported": finest["psnr"],
        "levels": encode["levels"],
        "vertices": finest["vertices"],
        "triangles": finest["triangles"],
        "normal_share": encode["normalShare"],
        "remesh_psnr": encode["remeshPsnr"],
        "measurements": encode["measurements"],
        "target_met": report["targetMet"],
        "reason": encode["reason"],
        "pack_s": pack_s,
        "pack_cpu_s": pack_cpu_s,
        "unpack_s": unpack_s,
    }


def peer_points(peer_csv, peer):
    """PSNR and bytes of all rows of a peer; none where there is no such file."""
    if not peer_csv.exists():
        return []
    with open(peer_csv, newline="") as file:
        return [(float(row["psnr"]), int(row["bytes"])) for row in csv.DictReader(file) if row["peer"] == peer]


def fewest_bytes(peer_csv, peer, psnr):
    """Bytes of the smallest row of a peer that reaches the PSNR, or None."""
    return min((size for reached, size in peer_points(peer_csv, peer) if reached >= psnr), default=None)


def geometric_mean(values):
    values = [v for v in values if v]
    return math.exp(sum(map(math.log, values)) / len(values)) if values else None


def slope(rows, size, what):
    """Of the line nearest to ln(what) over ln(size), and where it passes at a size of one; None of fewer than two sizes."""
    points = [(math.log(r[size]), math.log(r[what])) for r in rows]
    if not points:
        return None
    mean_x, mean_y = (sum(values) / len(points) for values in zip(*points))
    square = sum((x - mean_x) ** 2 for x, _ in points)
    if square == 0:
        return None
    steepness = sum((x - mean_x) * (y - mean_y) for x, y in points) / square
    return steepness, mean_y - steepness * mean_x


def verdict(is_met, what, of=()):
    return f"- {'met' if is_met else '**missed**'}: {what}{': ' if of else ''}{', '.join(of)}"


def shown(value, digits=2):
    if value is None:
        return "–"
    return f"{value:.{digits}f}" if isinstance(value, float) else str(value)


def markdown_table(header, rows):
    lines = [header, ["---"] * len(header)] + rows
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def read_csv(path, texts):
    """The rows of a table that write_csv wrote; columns named in `texts` are strings, others numbers, truth values or none. No file, no rows."""
    rows = csv.DictReader(path.open(encoding="utf-8")) if path.exists() else []
    value = {"": None, "True": True, "False": False}
    return [{k: v if k in texts else value[v] if v in value else json.loads(v) for k, v in row.items()} for row in rows]


def write_csv(path, rows):
    path.parent.mkdir(parents=True, exist_ok=True)
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, fieldnames=list(rows[0]), lineterminator="\n")
        writer.writeheader()
        for row in rows:
            writer.writerow({k: round(v, 5) if isinstance(v, float) else v for k, v in row.items()})


def write_markdown(path, *paragraphs):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join(paragraphs))


def gnuplot(png, settings, lines):
    """Draws named lines of points: [(title, style, [(x, y), ...]), ...]."""
    script = ['set terminal pngcairo size 900,640 font "sans,11"', f'set output "{png}"', "set grid", settings]
    for i, (_, _, line) in enumerate(lines):
        script += [f"$line{i} << EOD", *(f"{x} {y}" for x, y in line), "EOD"]
    script.append("plot " + ", ".join(f'$line{i} with {style} title "{title}"' for i, (title, style, _) in enumerate(lines)))
    subprocess.run(["gnuplot"], input="\n".join(script) + "\n", text=True, check=True)
