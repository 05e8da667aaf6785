#!/usr/bin/env python3
"""End to end through the command line: simplify, write, validate.

usage: sweep_test.py samples|models|bad BINARY VALIDATOR_MODULE MODELS_DIR
samples: every built-in scene by every algorithm and kind of instancing, 0 validator errors.
models:  every real model to 20 % by every algorithm, to 1 % by those with a sequence of levels; no
         validator error that the source file does not have itself; bytes as predicted; a missed
         target says why.
bad:     every hostile file ends in a load or one line on stderr and exit code 3, soon.
Exit code 77: skipped, its input is absent (a failure with CI=true).
"""
import concurrent.futures
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

SKIPPED = 77
EXTENSIONS = {".gltf", ".glb", ".dae", ".3ds", ".obj", ".ply", ".stl", ".fbx"}
RATIOS = (0.2, 0.01)
TIME_LIMIT_S = 300
BAD_TIME_LIMIT_S = 30
BAD_MEMORY_LIMIT_KB = 4 * 1024 * 1024


def skip(reason):
    print(reason)
    sys.exit(1 if os.environ.get("CI") == "true" else SKIPPED)


def run(command, limit_s):
    """Exit code (None: out of time), stdout, stderr."""
    try:
        done = subprocess.run(command, check=False, capture_output=True, text=True,
                              errors="replace", stdin=subprocess.DEVNULL, timeout=limit_s)
    except subprocess.TimeoutExpired:
        return None, "", f"still running after {limit_s} s"
    return done.returncode, done.stdout, done.stderr


def in_parallel(function, items):
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        return list(pool.map(function, items))


def algorithms(binary):
    """id -> whether it keeps a sequence of levels, by the program's own table."""
    code, out, err = run([binary, "--list-algorithms", "--json"], TIME_LIMIT_S)
    if code != 0:
        raise RuntimeError(f"--list-algorithms: exit code {code}: {err}")
    return {row["id"]: row["family"] == "edge-collapse" for row in json.loads(out)["algorithms"]}


class Case:
    """One simplification: its input, its options, and what became of it."""

    def __init__(self, source, output, algorithm, ratio, options=()):
        self.source, self.output = source, output
        self.ratio = ratio
        # Of the size that may be predicted wrongly, and bytes more. A quantised file has some digits
        # more or fewer for each submesh whose survivors of removal have grown.
        self.slack = (0.1 if "meshopt" in options or "draco" in options
                      else 0.002 if "quantize" in options else 0.0)
        self.slack_bytes = 64 if "quantize" in options else 0
        self.name = " ".join([source.name, algorithm, f"{ratio:g}", *options])
        self.command = ["simplify", str(source), "-o", str(output), "--algorithm", algorithm,
                        "--ratio", f"{ratio:g}", "--json", *options]
        self.faults = []

    def simplify(self, binary, source_triangles):
        code, out, err = run([binary, *self.command], TIME_LIMIT_S)
        if code != 0:
            self.faults.append(f"exit code {code}: {err.strip()[-300:]}")
            return
        try:
            report = json.loads(out)
        except ValueError:
            self.faults.append(f"stdout is not one JSON object: {out[:80]!r}")
            return
        size = self.output.stat().st_size
        wrong = abs(report["bytes"] - report["predicted_bytes"])
        if wrong > self.slack * size + self.slack_bytes or report["bytes"] != size:
            self.faults.append(f"predicted {report['predicted_bytes']} bytes, reported "
                               f"{report['bytes']}, wrote {size}")
        if report["triangles"] > self.ratio * source_triangles + 1 and not report["notes"]:
            self.faults.append(f"{report['triangles']} of {source_triangles} triangles left and "
                               "no note says why")


def validated(module, files):
    """path -> list of errors, from one validator process."""
    done = subprocess.run(["node", str(pathlib.Path(__file__).with_name("validate.js")), module],
                          check=True, capture_output=True, text=True,
                          input="".join(f"{file}\n" for file in files))
    return json.loads(done.stdout)


def check_validity(module, cases):
    """Adds to each case the errors its output has and its source has not."""
    outputs = [case.output for case in cases if case.output.is_file()]
    sources = {case.source for case in cases if case.source.suffix in (".gltf", ".glb")}
    errors = validated(module, [*outputs, *sorted(sources)])
    for case in cases:
        inherited = {error["code"] for error in errors.get(str(case.source), [])}
        fresh = [error for error in errors.get(str(case.output), [])
                 if error["code"] not in inherited]
        case.faults += [f"{error['code']} at {error['pointer']}: {error['message']}"
                        for error in fresh[:3]]


def finish(cases):
    faulty = [case for case in cases if case.faults]
    for case in faulty:
        for fault in case.faults:
            print(f"{case.name}: {fault}")
    print(f"{len(cases)} simplified, {len(faulty)} with faults")
    return 1 if faulty or not cases else 0


def sweep(binary, module, cases, triangles_of):
    in_parallel(lambda case: case.simplify(binary, triangles_of[case.source]), cases)
    check_validity(module, cases)
    return finish(cases)


def triangles_in(binary, file):
    """Instanced triangles, or None and the error where the file is refused."""
    code, out, err = run([binary, "info", str(file), "--json"], TIME_LIMIT_S)
    return (json.loads(out)["triangles"], "") if code == 0 else (None, f"{code}: {err.strip()}")


def samples(binary, module, folder):
    has_levels = algorithms(binary)
    scenes = {}
    for name in ("chair", "maple", "village", "bunny"):
        scenes[name] = folder / f"{name}.glb"
        code, _, err = run([binary, "generate", name, "-o", str(scenes[name])], TIME_LIMIT_S)
        if code != 0:
            print(f"generate {name}: exit code {code}: {err}")
            return 1
    triangles_of = {file: triangles_in(binary, file)[0] for file in scenes.values()}
    plan = [("chair", algorithm, ratio, ["--instancing", instancing])
            for algorithm, levels in has_levels.items() if levels
            for ratio in (*RATIOS, 0.001) for instancing in ("auto", "nodes", "gpu", "expand")]
    plan += [(name, "ias", ratio, ["--instancing", instancing]) for name in ("maple", "village")
             for ratio in RATIOS for instancing in ("auto", "nodes")]
    plan += [(name, "ias", ratio, ["--compress", compress])
             for name in ("chair", "maple", "village")
             for ratio in RATIOS for compress in ("quantize", "meshopt", "draco")]
    plan += [(name, algorithm, 0.2, []) for name in ("maple", "village", "bunny")
             for algorithm in has_levels if algorithm != "ias"]
    cases = [Case(scenes[name], folder / f"{number}.glb", algorithm, ratio, options)
             for number, (name, algorithm, ratio, options) in enumerate(plan)]
    return sweep(binary, module, cases, triangles_of)


def is_one_line(text):
    return len(text.strip().splitlines()) == 1


def models(binary, module, folder, models_dir):
    files = sorted(file for file in models_dir.rglob("*")
                   if file.suffix.lower() in EXTENSIONS and "bad" not in file.parts)
    counts = dict(zip(files, in_parallel(lambda file: triangles_in(binary, file), files)))
    refused_unclearly = 0
    for file, (triangles, error) in counts.items():
        if triangles is None:
            clear = error.startswith("3: ") and is_one_line(error) and file.name in error
            refused_unclearly += not clear
            print(f"{'refused' if clear else 'REFUSED WITHOUT A CLEAR ERROR'}: {error}")
    triangles_of = {file: count for file, (count, _) in counts.items() if count}
    cases = [Case(file, folder / f"{number}-{algorithm}-{ratio:g}.glb", algorithm, ratio)
             for number, file in enumerate(triangles_of)
             for algorithm, levels in algorithms(binary).items()
             for ratio in (RATIOS if levels else RATIOS[:1])]
    print(f"{len(files)} models, {len(triangles_of)} with triangles")
    return sweep(binary, module, cases, triangles_of) or (1 if refused_unclearly else 0)


def bad_fault(binary, file):
    """What is wrong with how a hostile file was met; empty if nothing."""
    started = time.monotonic()
    limited = f'ulimit -v {BAD_MEMORY_LIMIT_KB}; exec "$0" info "$1" --json'
    code, out, err = run(["bash", "-c", limited, binary, str(file)], BAD_TIME_LIMIT_S)
    elapsed_s = time.monotonic() - started
    if code == 0:
        return "" if isinstance(json.loads(out)["triangles"], int) else "no triangle count"
    if code != 3:
        return f"exit code {code} after {elapsed_s:.1f} s: {err.strip()[-200:]}"
    if not is_one_line(err) or file.name not in err:
        return f"not one line that names the file: {err.strip()[:300]!r}"
    return "" if re.match(r"lodestone: ", err) else f"no program name before: {err.strip()!r}"


def bad(binary, models_dir):
    files = sorted(file for file in (models_dir / "bad").rglob("*")
                   if file.suffix.lower() in EXTENSIONS)
    faults = list(zip(files, in_parallel(lambda file: bad_fault(binary, file), files)))
    for file, fault in faults:
        if fault:
            print(f"{file.relative_to(models_dir)}: {fault}")
    count = sum(1 for _, fault in faults if fault)
    print(f"{len(files)} hostile files, {count} met badly")
    return 1 if count or not files else 0


def main():
    mode, binary, module, models_dir = sys.argv[1:]
    models_dir = pathlib.Path(models_dir)
    if mode != "samples" and not models_dir.is_dir():
        skip(f"no models in {models_dir}, sweep skipped")
    if mode == "bad":
        return bad(binary, models_dir)
    if not pathlib.Path(module).is_dir():
        skip(f"no glTF validator in {module}; test.sh installs it")
    with tempfile.TemporaryDirectory(prefix="lodestone_sweep_") as folder:
        if mode == "samples":
            return samples(binary, module, pathlib.Path(folder))
        return models(binary, module, pathlib.Path(folder), models_dir)


if __name__ == "__main__":
    sys.exit(main())
