#!/usr/bin/env python3
"""The real window under a virtual display, driven by real input.

usage: window_test.py BINARY [NAME...]      needs $DISPLAY, xdotool, ImageMagick
Every function named test_* is a rule; prints one line for each, exit 1 if any fails.
"""
import json
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import traceback

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from window import Window, coloured_share, differing_share, run, xdotool  # noqa: E402

BINARY = ""
LANES = ("original", "ias", "quadric")


def write_cube(path, name="cube"):
    """A valid GLB: a cube of 12 triangles, three instances."""
    corners = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    faces = [0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1, 2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4,
             1, 5, 7, 1, 7, 3]
    binary = b"".join(struct.pack("<3f", *corner) for corner in corners)
    binary += struct.pack("<36H", *faces)
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
        "nodes": [{"mesh": 0, "translation": [3 * at, 0, 0]} for at in range(3)],
        "meshes": [{"name": name, "primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3",
             "min": [-1, -1, -1], "max": [1, 1, 1]},
            {"bufferView": 1, "componentType": 5123, "count": 36, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteLength": 96},
                        {"buffer": 0, "byteOffset": 96, "byteLength": 72}],
        "buffers": [{"byteLength": len(binary)}]}
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    path.write_bytes(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(binary))
                     + struct.pack("<I4s", len(text), b"JSON") + text
                     + struct.pack("<I4s", len(binary), b"BIN\0") + binary)
    return path


def made(folder, sample):
    """A sample scene as a file."""
    path = pathlib.Path(folder) / f"{sample}.glb"
    subprocess.run([BINARY, "generate", sample, "-o", path], check=True, capture_output=True)
    return path


def open_chair(folder):
    window = Window(BINARY, [made(folder, "chair")])
    window.wait_ready(*LANES)
    return window


def test_the_first_run_shows_the_maple_tree_with_three_lanes(_):
    with Window(BINARY) as window:
        window.wait_ready("original", "ias")
        assert window.state()["welcome"]
        assert window.lane("original")["triangles"] == 1_818_074
        assert 0 < window.lane("ias")["triangles"] <= 0.2 * 1_818_074
        assert window.lane("quadric") is not None
        window.click("Welcome/\u00d7")
        window.wait("welcome closed", lambda: not window.state()["welcome"])
        for algorithm in ("original", "ias"):
            rect = window.rect(f"View {window.lane_id(algorithm)}/picture")
            seen = coloured_share(window.picture(rect))
            assert seen > 0.05, f"lane {algorithm} shows {seen:.3f} of colour"


def test_the_master_slider_moves_every_lane_while_it_is_dragged(folder):
    with open_chair(folder) as window:
        before = {name: window.lane(name)["triangles"] for name in LANES}
        rect = window.rect(f"View {window.lane_id('ias')}/picture")
        picture = window.picture(rect)

        def while_held():
            for name in ("ias", "quadric"):
                window.wait(f"{name} follows the drag",
                            lambda n=name: window.lane(n)["triangles"] < before[n])
        window.drag("Master/Master", (0.45, 0.5), (0.2, 0.5), then=while_held)
        assert window.lane("original")["triangles"] == before["original"], "Original moved"
        assert differing_share(picture, window.picture(rect)) > 0.002, "the picture is the same"


def test_a_lane_slider_moves_that_lane_alone_and_undo_brings_it_back(folder):
    with open_chair(folder) as window:
        before = {name: window.lane(name)["triangles"] for name in LANES}
        window.drag(f"Lane {window.lane_id('ias')}/Target", (0.45, 0.5), (0.8, 0.5))
        window.wait("IAS has more triangles", lambda: window.lane("ias")["triangles"] > before["ias"])
        assert window.lane("quadric")["triangles"] == before["quadric"], "Quadric moved too"
        window.key("ctrl+z")
        window.wait("undone", lambda: window.lane("ias")["triangles"] == before["ias"])
        assert window.document()["undo"] == "", "one drag was more than one step"
        window.key("ctrl+shift+z")
        window.wait("redone", lambda: window.lane("ias")["triangles"] > before["ias"])


def test_export_writes_what_the_dialog_promised(folder):
    with open_chair(folder) as window:
        window.click(f"View {window.lane_id('ias')}/picture")
        promised = window.lane("ias")["bytes"]
        goal = pathlib.Path(folder) / "written.glb"
        window.key("ctrl+e")
        window.wait("the dialog", lambda: window.get("widget", "Export/Path"))
        window.key("ctrl+a")
        window.type(str(goal))
        window.click("Export/Export")
        window.wait("the file", goal.exists)
        window.wait("a message", lambda: any(m["severity"] == "info" for m in window.messages))
        assert goal.stat().st_size == promised, f"{goal.stat().st_size} B, promised {promised} B"
        info = json.loads(run([BINARY, "info", str(goal), "--json"]))
        assert info["triangles"] == window.lane("ias")["triangles"]


def test_the_file_browser_opens_a_typed_path(folder):
    cube = write_cube(pathlib.Path(folder) / "cube.glb")
    with open_chair(folder) as window:
        window.key("ctrl+o")
        window.wait("the browser", lambda: window.get("widget", "Open/Path"))
        window.key("ctrl+a")
        window.type(str(cube))
        window.key("Return")
        window.wait("the cube", lambda: window.document()["path"].endswith("cube.glb"))
        window.wait("its lane", lambda: window.lane("original") and window.lane("original")["triangles"] == 36)


def test_a_bad_file_is_a_message_and_the_document_stays(folder):
    bad = pathlib.Path(folder) / "bad.glb"
    bad.write_bytes(b"glTF\2\0\0\0\xff\xff\xff\x7fgarbage")
    with open_chair(folder) as window:
        before = window.lane("original")["triangles"]
        window.key("ctrl+o")
        window.wait("the browser", lambda: window.get("widget", "Open/Path"))
        window.key("ctrl+a")
        window.type(str(bad))
        window.key("Return")
        window.wait("an error", lambda: any("bad.glb" in message["text"] and
                                            message["severity"] == "error"
                                            for message in window.messages))
        assert window.document()["path"].endswith("chair.glb")
        assert window.lane("original")["triangles"] == before


def test_a_missing_file_on_the_command_line_is_a_message_too(folder):
    with Window(BINARY, [pathlib.Path(folder) / "nowhere.glb"]) as window:
        window.wait("an error", lambda: any("nowhere.glb" in message["text"]
                                            for message in window.messages))


def test_orbiting_redraws_every_view(folder):
    with open_chair(folder) as window:
        rects = [window.rect(f"View {window.lane_id(name)}/picture") for name in LANES]
        before = [window.picture(rect) for rect in rects]
        window.drag(f"View {window.lane_id('original')}/picture", (0.4, 0.5), (0.7, 0.6))
        window.wait_frames(4)
        for name, rect, picture in zip(LANES, rects, before):
            assert differing_share(picture, window.picture(rect)) > 0.01, f"lane {name} stood still"


def test_tab_hides_the_panels_and_n_shows_normals(folder):
    with open_chair(folder) as window:
        name = f"View {window.lane_id('ias')}/picture"
        rect = window.rect(name)
        picture = window.picture(rect)
        window.key("n")
        assert differing_share(picture, window.picture(rect)) > 0.01, "N changed nothing"
        window.key("Tab")
        window.wait("hidden panels", lambda: window.state()["panels_hidden"])
        window.wait("larger views", lambda: window.rect(name)[2] > rect[2])


def test_resizing_keeps_every_part_inside(folder):
    with open_chair(folder) as window:
        for width, height in ((1500, 900), (1280, 720)):
            xdotool("windowsize", "--sync", window.window_id(), str(width), str(height))
            window.wait_frames(4)
            window.wait("the new layout", lambda w=width: abs(
                sum(window.rect("Inspector/Export LOD\u2026")[at] for at in (0, 2)) - w) < 40)
            for (kind, name), entry in list(window.objects.items()):
                if kind != "widget" or not re.match(r"(View \d+|Inspector|Master|Menu)/", name):
                    continue
                x, y, w, h = entry["rect"]
                assert x >= 0 and y >= 0, f"{name} begins at {x}, {y}"
                assert x + w <= width + 1 and y + h <= height + 1, f"{name} ends at {x + w}, {y + h}"


def test_escape_asks_before_it_quits(folder):
    with open_chair(folder) as window:
        window.key("Escape")
        window.wait("the question", lambda: window.get("widget", "Quit/Stay"))
        window.click("Quit/Stay")
        window.wait("no dialog", lambda: window.state()["dialog"] == 0)
        window.key("Escape")
        window.wait("the question", lambda: window.state()["dialog"] != 0)
        window.click("Quit/Quit")
        assert window.process.wait(30) == 0


def main():
    global BINARY
    BINARY = str(pathlib.Path(sys.argv[1]).resolve())
    for tool in ("xdotool", "import", "convert"):
        if not shutil.which(tool):
            print(f"skipped: {tool} is not installed")
            return 77
    wanted = sys.argv[2:]
    failures = 0
    for name, test in sorted(globals().items()):
        if not name.startswith("test_") or (wanted and name not in wanted):
            continue
        with tempfile.TemporaryDirectory() as folder:
            try:
                test(folder)
                print(f"ok      {name}", flush=True)
            except Exception:  # a failed rule must not hide the others
                failures += 1
                print(f"FAILED  {name}\n{traceback.format_exc()}", flush=True)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
