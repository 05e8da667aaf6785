#!/usr/bin/env python3
"""What keys, lane menus and drags do in the real window, and how long its frames take meanwhile.

usage: keys_test.py BINARY [NAME...]      as window_test.py
"""
import os
import sys
import time

import window_test as base
from views_test import compare, view
from window import Window, differing_share, xdotool
from window_test import LANES, open_chair


def pictures_of(window):
    window.wait_still()
    return {name: window.picture(window.rect(view(window, name))) for name in LANES}


def test_a_lets_the_vertices_of_the_active_lane_slide(folder):
    with open_chair(folder) as window:
        window.click(view(window, "ias"))
        start = window.lane("ias")["triangles"]
        window.key("a")
        window.wait("more triangles", lambda: window.lane("ias")["slides"] and
                    window.lane("ias")["triangles"] > start)
        seen = {}

        def slid():
            lane = window.lane("ias")
            seen.setdefault(lane["triangles"], set()).add(lane["lod"])
            return max(map(len, seen.values())) > 2
        window.wait("other vertices, the same triangles", slid)
        window.wait("down again", lambda: window.lane("ias")["triangles"] < start)
        window.key("a")
        window.wait("its end", lambda: not window.lane("ias")["slides"])
        window.wait_still()
        assert window.document()["undo"] != ""
        window.key("ctrl+z")
        window.wait("where it began", lambda: window.lane("ias")["triangles"] == start)
        assert window.document()["undo"] == "", "the animation was more than one step"


def test_an_animation_ends_where_a_dialog_opens(folder):
    with open_chair(folder) as window:
        window.click(view(window, "ias"))
        window.key("a")
        window.wait("sliding", lambda: window.lane("ias")["slides"])
        window.key("ctrl+e")
        window.wait("the dialog", lambda: window.get("widget", "Export/Path"))
        window.wait("its end", lambda: not window.lane("ias")["slides"])


def test_one_lets_a_drag_move_the_light_and_zero_the_camera(folder):
    with open_chair(folder) as window:
        name = view(window, "ias")
        before = pictures_of(window)["ias"]

        def state(*members):
            return [window.state()[member] for member in members]
        light, azimuth = state("light_azimuth", "azimuth")
        window.key("1")
        window.drag(name, (0.4, 0.5), (0.6, 0.6))
        window.wait("another light", lambda: window.state()["light_azimuth"] != light)
        assert window.state()["azimuth"] == azimuth, "the camera moved"
        assert differing_share(before, pictures_of(window)["ias"]) > 0.005
        light = window.state()["light_azimuth"]
        window.key("0")
        window.drag(name, (0.4, 0.5), (0.6, 0.6))
        window.wait("another camera", lambda: window.state()["azimuth"] != azimuth)
        assert window.state()["light_azimuth"] == light, "the light moved"


def test_s_and_z_go_away_and_come_back_with_shift(folder):
    with open_chair(folder) as window:
        before = pictures_of(window)["ias"]
        for key in ("s", "z"):
            window.key(key)
            assert differing_share(before, pictures_of(window)["ias"]) > 0.005, key
            window.key(f"shift+{key}")
            assert differing_share(before, pictures_of(window)["ias"]) < 0.002, f"shift+{key}"


def test_f11_fills_the_screen_and_leaves_it(folder):
    with open_chair(folder) as window:
        width = window.state()["width"]
        window.key("F11")
        window.wait("the whole screen", lambda: window.state()["width"] > width)
        window.key("F11")
        window.wait("the window", lambda: window.state()["width"] == width)


def test_a_drag_with_ctrl_selects_what_is_in_the_box(folder):
    with open_chair(folder) as window:
        name = view(window, "original")
        before = pictures_of(window)
        azimuth = window.state()["azimuth"]

        def box(begin, end, *modifiers):
            for modifier in ("ctrl", *modifiers):
                xdotool("keydown", modifier)
            window.wait_frames(2)
            window.drag(name, begin, end, steps=4)
            for modifier in ("ctrl", *modifiers):
                xdotool("keyup", modifier)
            window.wait_frames(2)
        box((0.02, 0.02), (0.98, 0.98))
        every = window.wait("a selection", lambda: window.document()["selection"])
        assert [item[1] for item in every] == [-1] * 6, f"not six whole submeshes: {every}"
        after = pictures_of(window)
        for lane in LANES:
            assert differing_share(before[lane], after[lane]) > 0.01, f"{lane} marks nothing"
        box((0.02, 0.02), (0.06, 0.06))
        window.wait("nothing", lambda: window.document()["selection"] == [])
        assert window.state()["azimuth"] == azimuth, "the camera moved"
        box((0.02, 0.02), (0.98, 0.5))
        some = window.wait("a part", lambda: window.document()["selection"])
        box((0.02, 0.5), (0.98, 0.98), "shift")
        window.wait("more", lambda: len(window.document()["selection"]) > len(some) or
                    window.document()["selection"] == every)


def test_lanes_are_duplicated_moved_and_removed_by_their_menu(folder):
    with open_chair(folder) as window:
        def choose(lane_id, item):
            window.click(f"View {lane_id}/menu")
            window.click(f"View {lane_id}/{item}")
        first = window.lane_id("ias")
        choose(first, "Duplicate")
        window.wait("four lanes", lambda: window.document()["lanes"] == 4)
        window.wait_ready("ias")
        second = window.lane_id("ias")
        assert second != first and window.lane("ias")["index"] == 2
        choose(second, "Move left")
        window.wait("its new place", lambda: window.lane("ias")["index"] == 1)
        window.wait_frames(3)
        choose(second, "Remove")
        window.wait("three lanes", lambda: window.document()["lanes"] == 3)
        for lanes in (4, 4, 3):
            window.key("ctrl+z")
            window.wait(f"{lanes} lanes", lambda n=lanes: window.document()["lanes"] == n)


def test_a_free_view_offers_lanes(folder):
    with open_chair(folder) as window:
        window.click("Menu/Views/4")
        window.click("Grid/FASS" if window.get("widget", "Grid/FASS") else "Grid/Wild")
        window.wait("four lanes", lambda: window.document()["lanes"] == 4)


def test_escape_in_a_drag_leaves_everything_as_it_was(folder):
    with open_chair(folder) as window:
        before = {name: window.lane(name)["triangles"] for name in LANES}

        def cancel():
            window.wait("fewer triangles", lambda: window.lane("ias")["triangles"] < before["ias"])
            window.key("Escape")
            window.wait("as before", lambda: all(
                window.lane(name)["triangles"] == before[name] for name in LANES))
        window.drag("Master/Master", (0.45, 0.5), (0.2, 0.5), then=cancel)
        assert {name: window.lane(name)["triangles"] for name in LANES} == before
        assert window.state()["dialog"] == 0


def test_escape_closes_a_menu_and_nothing_else(folder):
    with open_chair(folder) as window:
        window.click("Master/display")
        window.wait("the menu", lambda: window.get("menu", "display")["open"])
        window.key("Escape")
        window.wait("no menu", lambda: not window.get("menu", "display")["open"])
        assert window.state()["dialog"] == 0, "it asked whether to quit"


def test_messages_are_listed_counted_and_cleared(folder):
    with Window(base.BINARY, [f"{folder}/nowhere.glb"]) as window:
        window.wait("an error", lambda: any(m["severity"] == "error" for m in window.messages))
        window.click("Status/message")
        window.wait("the list", lambda: window.get("widget", "Messages/Clear"))
        window.click("Messages/Clear")
        window.click("Menu/File")  # nothing in its way
        window.wait("the menu", lambda: window.get("widget", "Menu/File/Quit"))


def test_a_missed_target_is_marked_in_the_view(folder):
    with open_chair(folder) as window:
        window.drag(f"Lane {window.lane_id('ias')}/Target", (0.45, 0.5), (0.0, 0.5))
        window.wait("a note", lambda: window.lane("ias")["note"])
        mark = window.wait("its mark", lambda: window.get(
            "widget", f"View {window.lane_id('ias')}/note"))
        assert max(mark["rect"][2:]) < 24, "it covers the picture"


def test_frames_are_drawn_while_a_large_sequence_is_built(_):
    """Orbits while Quadric takes the sample's 1.8 M triangles, and reports."""
    with Window(base.BINARY) as window:
        window.wait_ready("original", "ias")
        window.click("Welcome/\u00d7")
        window.frame_times.clear()

        def building():
            return window.lane("quadric")["state"] != "ready"
        while building():
            window.drag(view(window, "original"), (0.3, 0.4), (0.6, 0.5), steps=20)
        frames = sum(entry["count"] for entry in window.frame_times)
        slow = sum(entry["slow"] for entry in window.frame_times)
        worst = max((entry["max_ms"] for entry in window.frame_times), default=0.0)
        load = os.getloadavg()[0]
        print(f"        {frames} frames, {slow} above 100 ms, worst {worst} ms, load {load:.1f}")
        assert frames, "nothing was drawn while it was built"


def test_the_first_picture_is_soon_there(_):
    """Reports how soon."""
    begin = time.monotonic()
    with Window(base.BINARY) as window:
        window.wait("a picture", lambda: window.get("pictures", "pictures") and
                    window.lane("original") and window.lane("original")["state"] == "ready")
        first = time.monotonic() - begin
        window.wait_ready("ias")
        ias = time.monotonic() - begin
        window.wait_ready("quadric")
        quadric = time.monotonic() - begin
        load = os.getloadavg()[0]
        print(f"        original {first:.2f} s, IAS {ias:.2f} s, Quadric {quadric:.2f} s after the "
              f"start, load {load:.1f}")
        assert first <= quadric, "the original is there before what is made of it"


def test_difference_and_heat_map_can_be_left_with_a_key(folder):
    with open_chair(folder) as window:
        for mode in ("Heat map", "Difference"):
            compare(window, mode)
            window.key("space")
            window.wait("two lanes", lambda: window.state()["compare"] == "split")


if __name__ == "__main__":
    sys.exit(base.main(globals()))
