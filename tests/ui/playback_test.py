#!/usr/bin/env python3
"""A file's animation in the real window: its bar, its key, its time, and levels of detail on it.

usage: playback_test.py BINARY [NAME...]      as window_test.py; real models in ../shared/models
"""
import pathlib
import sys

import window_test as base
from views_test import view
from window import Window, differing_share

MODELS = pathlib.Path(__file__).resolve().parents[3] / "shared" / "models"
LANES = ("original", "ias")


def open_fox():
    """Three animations over one skeleton."""
    file = MODELS / "features" / "Fox" / "Fox.glb"
    if not file.exists():
        raise base.Skipped(f"no {file}")
    window = Window(base.BINARY, [file])
    window.wait_ready(*LANES)
    return window


def time_of(window):
    return window.state()["time_s"]


def pictures_of(window):
    window.window_id()
    window.move(4, 4)  # no tooltip
    window.wait_still()
    return {name: window.picture(window.rect(view(window, name))) for name in LANES}


def test_a_click_plays_the_animation_and_another_stops_it(_):
    with open_fox() as window:
        before = pictures_of(window)
        assert time_of(window) == 0.0 and not window.state()["playing"]
        window.click("Playback/play")
        window.wait("time to pass", lambda: window.state()["playing"] and time_of(window) > 0.1)
        window.click("Playback/play")
        window.wait("a stop", lambda: not window.state()["playing"])
        stopped = time_of(window)
        after = pictures_of(window)
        assert time_of(window) == stopped, "time passed after the stop"
        for name in LANES:
            assert differing_share(before[name], after[name]) > 0.005, f"{name} stood still"


def test_p_plays_the_animation_and_stops_it(_):
    with open_fox() as window:
        window.key("p")
        window.wait("time to pass", lambda: window.state()["playing"] and time_of(window) > 0.1)
        window.key("p")
        window.wait("a stop", lambda: not window.state()["playing"])


def test_a_drag_of_the_time_shows_that_moment_in_every_view(_):
    with open_fox() as window:
        window.key("p")
        window.wait("time to pass", lambda: time_of(window) > 0.0)
        window.drag("Playback/time", (0.1, 0.5), (0.5, 0.5))
        assert not window.state()["playing"], "the drag did not stop it"
        middle, half = time_of(window), pictures_of(window)
        window.drag("Playback/time", (0.5, 0.5), (0.98, 0.5))
        assert time_of(window) > middle * 1.5
        end = pictures_of(window)
        for name in LANES:
            assert differing_share(half[name], end[name]) > 0.005, f"{name} stood still"
        window.drag("Playback/time", (0.98, 0.5), (0.5, 0.5))
        assert abs(time_of(window) - middle) < 0.02 * middle
        again = pictures_of(window)
        for name in LANES:
            assert differing_share(half[name], again[name]) < 0.02, f"{name}: another picture"


def test_the_name_chooses_among_the_animations_and_the_pose_at_rest(_):
    with open_fox() as window:
        rest = pictures_of(window)
        seen = []
        for _animation in range(3):
            window.click("Playback/animation")
            window.drag("Playback/time", (0.02, 0.5), (0.4, 0.5))
            seen.append((time_of(window), pictures_of(window)["original"]))
        for (_, before), (_, after) in zip(seen, seen[1:]):
            assert differing_share(before, after) > 0.005, "the same animation"
        window.click("Playback/animation")
        window.wait("the time at rest", lambda: time_of(window) == 0.0)
        for name, picture in pictures_of(window).items():
            assert differing_share(rest[name], picture) < 0.005, f"{name} is not at rest"


def test_a_slider_moves_its_lane_while_the_animation_plays(_):
    with open_fox() as window:
        window.key("p")
        window.wait("time to pass", lambda: time_of(window) > 0.0)
        before = window.lane("ias")["triangles"]

        def while_held():
            window.wait("the lane follows", lambda: window.lane("ias")["triangles"] > before)
            begun = time_of(window)
            window.wait("time to pass", lambda: time_of(window) != begun)
        window.drag(f"Lane {window.lane_id('ias')}/Target", (0.45, 0.5), (0.8, 0.5), then=while_held)
        assert window.state()["playing"]


def test_a_scene_that_cannot_move_has_no_bar(folder):
    with base.open_chair(folder) as window:
        window.wait_still()
        assert window.get("widget", "Playback/play") is None
        window.key("p")
        assert not window.state()["playing"]


def test_another_scene_begins_at_rest(folder):
    with open_fox() as window:
        window.key("p")
        window.wait("time to pass", lambda: time_of(window) > 0.0)
        window.key("ctrl+o")
        window.wait("the browser", lambda: window.get("widget", "Open/Path"))
        window.key("ctrl+a")
        window.type(str(base.write_cube(pathlib.Path(folder) / "cube.glb")))
        window.key("Return")
        window.wait("the cube", lambda: window.document()["path"].endswith("cube.glb"))
        window.wait("rest", lambda: not window.state()["playing"] and time_of(window) == 0.0)


if __name__ == "__main__":
    sys.exit(base.main(globals()))
