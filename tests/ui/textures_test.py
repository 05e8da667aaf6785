#!/usr/bin/env python3
"""Textures that lanes keep or have transferred, in the real window.

usage: textures_test.py BINARY [NAME...]      as window_test.py
"""
import json
import pathlib
import sys

import window_test as base
from window import Window, coloured_share, differing_share, run, xdotool
from window_test import LANES, Skipped

MODELS = pathlib.Path(__file__).resolve().parents[2] / "../shared/models/textured"
DIALOG_TEXTURES = 6


def open_model(name):
    path = MODELS / name
    if not path.exists():
        raise Skipped(f"there is no {path}")
    window = Window(base.BINARY, [path])
    window.wait_ready(*LANES)
    xdotool("windowsize", "--sync", window.window_id(), "1600", "1050")  # room for the atlas
    window.wait("the new layout", lambda: sum(
        window.rect("Inspector/Export LOD\u2026")[at] for at in (0, 2)) > 1550)
    return window


def transfer(window):
    """Clicks the IAS lane and lets its textures be transferred."""
    window.click(f"View {window.lane_id('ias')}/picture")
    window.click("Inspector/Textures/transfer")


def picture(window, name):
    """A view without a tooltip over it."""
    window.move(60, 300)
    window.wait_still()
    return window.picture(window.rect(name))


def wait_transferred(window):
    window.wait("textures of the LOD shown",
                lambda: window.lane("ias")["textures"] == window.lane("ias")["lod"])
    window.wait_frames(3)  # until what is told of them has moved the controls below it


def test_a_lane_shows_transferred_textures_and_keeps_them_again(_):
    with open_model("Duck/Duck.glb") as window:
        name = f"View {window.lane_id('ias')}/picture"
        window.click(name)  # it gets a frame and a selection, which stay
        kept, kept_bytes = picture(window, name), window.lane("ias")["bytes"]
        window.click("Inspector/Textures/transfer")
        wait_transferred(window)
        moved = picture(window, name)
        assert differing_share(kept, moved) > 0.001, "the lane draws its old textures"
        assert coloured_share(moved) > 0.8 * coloured_share(kept), "the duck lost its colour"
        assert window.lane("original")["textures"] == 0 and window.lane("quadric")["textures"] == 0
        window.wait("a size with the atlas", lambda: window.lane("ias")["bytes"] != kept_bytes)
        window.click("Inspector/Textures/keep UVs")
        window.wait("none", lambda: window.lane("ias")["textures"] == 0)
        window.wait("the size before", lambda: window.lane("ias")["bytes"] == kept_bytes)
        assert differing_share(kept, picture(window, name)) < 0.001
        window.key("ctrl+z")
        wait_transferred(window)


def test_the_atlas_stands_beside_the_texture_it_was_made_from(_):
    with open_model("Duck/Duck.glb") as window:
        transfer(window)
        wait_transferred(window)
        window.wait("small pictures", lambda: window.get("widget", "Inspector/atlas"))
        window.click("Inspector/atlas")
        window.wait("the dialog", lambda: window.state()["dialog"] == DIALOG_TEXTURES)
        window.wait_frames(3)
        x, y, width, height = window.rect("Textures/pair")
        for side, what in ((x, "the original texture"), (x + width / 2, "the atlas")):
            share = coloured_share(window.picture((side, y, width / 2, height)))
            assert share > 0.1, f"{what} shows {share:.3f} of colour"
        window.key("Escape")
        window.wait("closed", lambda: window.state()["dialog"] == 0)


def test_t_shows_how_dense_texels_lie_before_and_after_a_transfer(_):
    with open_model("Duck/Duck.glb") as window:
        window.key("t")
        window.wait("the mode", lambda: window.state()["shading"] == "texels")
        names = [f"View {window.lane_id(name)}" for name in ("original", "ias")]
        window.wait("a legend and the original's number",
                    lambda: window.get("widget", f"{names[0]}/legend") and
                    window.get("widget", f"{names[0]}/number"))
        assert not window.get("widget", f"{names[1]}/number"), "nobody knows"
        kept = picture(window, f"{names[1]}/picture")
        transfer(window)
        wait_transferred(window)
        window.wait("the atlas's number", lambda: window.get("widget", f"{names[1]}/number"))
        assert differing_share(kept, picture(window, f"{names[1]}/picture")) > 0.02
        window.key("t")
        window.wait("lit", lambda: window.state()["shading"] == "lit")


def test_after_a_drag_the_newest_level_gets_the_textures(_):
    with open_model("Duck/Duck.glb") as window:
        transfer(window)
        wait_transferred(window)
        first = window.lane("ias")["textures"]

        def while_held():
            window.wait("another level", lambda: window.lane("ias")["lod"] > first)
            assert window.lane("ias")["textures"] == first, "transferred in the middle of a drag"
        window.drag(f"Lane {window.lane_id('ias')}/Target", (0.45, 0.5), (0.7, 0.5), then=while_held)
        wait_transferred(window)
        assert window.lane("ias")["textures"] > first
        level = window.lane("ias")["lod"]
        assert window.lane("ias")["atlas"] == 1024
        window.drag("Inspector/Atlas size", (0.4, 0.5), (0.0, 0.5))
        window.wait("a smaller atlas", lambda: window.lane("ias")["atlas"] < 1024)
        assert window.lane("ias")["lod"] == level, "an atlas made another level"


def test_a_cancelled_transfer_leaves_the_level_and_can_be_asked_for_again(_):
    with open_model("DamagedHelmet/DamagedHelmet.glb") as window:
        window.wait_still()
        transfer(window)
        window.wait("a job", lambda: any(
            entry["job"] == "texture" and entry["running"]
            for (kind, _), entry in window.objects.items() if kind == "job"))
        window.key("Escape")
        window.wait("a message", lambda: any("cancelled" in m["text"] for m in window.messages))
        assert window.lane("ias")["state"] == "ready" and window.lane("ias")["textures"] == 0
        window.click("Inspector/Transfer again")
        wait_transferred(window)


def test_an_export_has_the_transferred_textures_and_the_size_shown(folder):
    with open_model("Duck/Duck.glb") as window:
        transfer(window)
        wait_transferred(window)
        window.wait("an exact size", lambda: window.lane("ias")["exact"])
        goal = pathlib.Path(folder) / "duck.glb"
        window.key("ctrl+e")
        window.wait("the dialog", lambda: window.get("widget", "Export/Path"))
        window.key("ctrl+a")
        window.type(str(goal))
        window.click("Export/Export")
        window.wait("the file", goal.exists)
        window.wait("a message", lambda: any("wrote" in m["text"] for m in window.messages))
        shown = window.lane("ias")
        assert goal.stat().st_size == shown["bytes"], f"{goal.stat().st_size} B, shown {shown}"
        info = json.loads(run([base.BINARY, "info", str(goal), "--json"]))
        assert info["triangles"] == shown["triangles"] and info["images"] == 1
        assert info["vertices"] == 3 * info["unique_triangles"], "its triangles share texels"


if __name__ == "__main__":
    sys.exit(base.main(globals()))
