#!/usr/bin/env python3
"""Checks the rules of the source tree that no compiler checks.

usage: include_table_test.py SOURCE_DIR
Every #include against the folder table, GL behind render/gl.h, ImGui inside ui/, no file(GLOB),
no source file above 600 lines, no absolute path. Prints one line per breach; exit 1 if any.
"""
import pathlib
import re
import subprocess
import sys

# folder -> the folders it may include besides itself; None: all of them
MAY_INCLUDE = {
    "scene": set(),
    "simplify": {"scene"},
    "render": {"scene"},
    "app": {"scene", "simplify"},
    "ui": {"scene", "app"},
    "bench": None,
    "tests": None,
}
KNOWS_EVERYTHING = re.compile(r"app/main(\.cpp|/.*)")
GL_HEADER = re.compile(r"^(GL|GLES\d?|epoxy|glad)/|^GLFW/.*native|^gl(ad|ew|core).*\.h$")
EGL_HEADER = re.compile(r"^EGL/")
IMGUI_HEADER = re.compile(r"imgui|imstb", re.IGNORECASE)
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
ABSOLUTE_PATH = re.compile(r"(?<![\w./$}>)\]*-])/(home|root|work|tmp|usr/local|opt|mnt|Users)/\w")
CODE = {".h", ".cpp"}
MAX_LINES = 600


def source_files(root):
    """Files git tracks or would track, so that build trees never count."""
    listing = subprocess.run(
        ["git", "-C", str(root), "ls-files", "--cached", "--others", "--exclude-standard", "-z"],
        check=False, capture_output=True, text=True)
    if listing.returncode == 0:
        names = [name for name in listing.stdout.split("\0") if name]
    else:  # an unpacked archive
        names = [str(path.relative_to(root)) for path in root.rglob("*")
                 if path.is_file() and path.relative_to(root).parts[0] not in ("build", ".git")]
    return sorted(name for name in names if (root / name).is_file())


def include_breach(name, bracket, target):
    """Why file `name` may not include `target`; empty if it may."""
    folder = name.split("/")[0]
    if GL_HEADER.search(target) and name != "render/gl.h":
        return f"GL header <{target}> outside render/gl.h"
    if EGL_HEADER.search(target) and folder != "render":
        return f"EGL header <{target}> outside render/"
    if IMGUI_HEADER.search(target) and not target.startswith("ui/") \
            and folder != "ui" and not name.startswith("tests/ui/") and not KNOWS_EVERYTHING.fullmatch(name):
        return f"ImGui header <{target}> outside ui/"
    room = target.split("/")[0]
    if bracket != '"' or room not in MAY_INCLUDE:
        return ""
    if KNOWS_EVERYTHING.fullmatch(name) or room == folder or MAY_INCLUDE[folder] is None:
        return ""
    return "" if room in MAY_INCLUDE[folder] else f"{folder}/ may not include {room}/ ({target})"


def relative_include_breach(root, name, bracket, target):
    """Quoted includes are written from the root, so that the table can be read off them."""
    if bracket != '"' or (root / target).is_file():
        return ""
    beside = (root / name).parent / target
    return f'"{target}" is not written from the root' if beside.is_file() else ""


def breaches_of_code(root, name, lines):
    if len(lines) > MAX_LINES:
        yield f"{name}: {len(lines)} lines, at most {MAX_LINES}"
    for number, line in enumerate(lines, 1):
        match = INCLUDE.match(line)
        if not match or name.split("/")[0] not in MAY_INCLUDE:
            continue
        for breach in (include_breach(name, *match.groups()),
                       relative_include_breach(root, name, *match.groups())):
            if breach:
                yield f"{name}:{number}: {breach}"


def breaches(root):
    for name in source_files(root):
        path = root / name
        is_code = path.suffix in CODE
        is_cmake = path.name == "CMakeLists.txt" or path.suffix == ".cmake"
        if not (is_code or is_cmake or path.suffix in {".sh", ".py", ".json", ".md", ".glsl"}):
            continue
        lines = path.read_text(encoding="utf-8").splitlines()
        if is_code:
            yield from breaches_of_code(root, name, lines)
        for number, line in enumerate(lines, 1):
            if is_cmake and re.search(r"file\s*\(\s*GLOB", line, re.IGNORECASE):
                yield f"{name}:{number}: file(GLOB)"
            if ABSOLUTE_PATH.search(line) and path.name != pathlib.Path(__file__).name:
                yield f"{name}:{number}: absolute path: {line.strip()}"


def self_check():
    """A rule that catches nothing is no rule."""
    assert include_breach("scene/scene.h", '"', "simplify/target.h")
    assert include_breach("ui/panel.cpp", '"', "render/view.h")
    assert include_breach("app/job.cpp", "<", "imgui.h")
    assert include_breach("render/view.cpp", "<", "epoxy/gl.h")
    assert include_breach("app/main.cpp", "<", "EGL/egl.h")
    assert not include_breach("render/gl.h", "<", "epoxy/gl.h")
    assert not include_breach("simplify/ias.cpp", '"', "scene/scene.h")
    assert not include_breach("app/main.cpp", '"', "ui/window.h")
    assert not include_breach("app/main/window_loop.cpp", '"', "ui/window.h")
    assert ABSOLUTE_PATH.search('load("/home/me/model.glb")')
    assert not ABSOLUTE_PATH.search("build/home/x ${dir}/tmp/x")


def main():
    self_check()
    found = list(breaches(pathlib.Path(sys.argv[1]).resolve()))
    for line in found:
        print(line)
    print(f"{len(found)} breaches")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
