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


def test_where_nothing_could_be_opened_scenes_are_offered(folder):
    with Window(base.BINARY, [f"{folder}/nowhere.glb"]) as window:
        window.wait("an error", lambda: any(m["severity"] == "error" for m in window.messages))
        window.click("Welcome/bunny")
        window.wait_ready("original")
        window.wait("one submesh", lambda: window.lane("original")["instances"] == 1)


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
                    window.get("pictures", "pictures")["shown"] > 0)
        first = time.monotonic() - begin
        window.wait_ready("ias")
        ias = time.monotonic() - begin
        window.wait_ready("quadric")
        quadric = time.monotonic() - begin
        load = os.getloadavg()[0]
        print(f"        original {first:.2f} s, IAS {ias:.2f} s, Quadric {quadric:.2f} s after the "
              f"start, load {load:.1f}")
        assert first <= quadric, "the original is there before what is made of it"


def test_a_lane_is_dragged_by_its_header_to_another_view(folder):
    with open_chair(folder) as window:
        ids = {name: window.lane_id(name) for name in LANES}

        def order():
            return sorted(LANES, key=lambda name: window.lane(name)["index"])

        def drag(name, goal, then=None):
            x, y, width, height = window.rect(f"View {ids[name]}/handle")
            to = window.center(f"View {ids[goal]}/picture")
            window.drag(f"View {ids[name]}/handle", (0.3, 0.5),
                        ((to[0] - x) / width, (to[1] - y) / height), then=then)
        assert order() == ["original", "ias", "quadric"]
        drag("quadric", "original")
        window.wait("the first place", lambda: order() == ["quadric", "original", "ias"])
        assert window.document()["active"] == int(ids["quadric"])
        window.wait_frames(3)
        drag("quadric", "ias")
        window.wait("the last place", lambda: order() == ["original", "ias", "quadric"])
        undo = window.document()["undo"]
        drag("ias", "quadric", then=lambda: window.key("Escape"))
        assert order() == ["original", "ias", "quadric"], "Esc did not cancel"
        assert window.state()["dialog"] == 0 and window.document()["undo"] == undo
        window.key("ctrl+z")
        window.wait("one step back", lambda: order() == ["quadric", "original", "ias"])


def test_a_click_on_a_header_makes_its_lane_the_active_one(folder):
    with open_chair(folder) as window:
        for name in ("original", "quadric", "ias"):
            window.click(f"View {window.lane_id(name)}/handle")
            window.wait(f"{name} active",
                        lambda n=name: window.document()["active"] == int(window.lane_id(n)))
        assert window.document()["undo"] == "", "a click moved a lane"


def test_the_wheel_zooms_and_shift_middle_pans(folder):
    with open_chair(folder) as window:
        name = view(window, "ias")
        before = pictures_of(window)
        window.move(*window.center(name))
        window.wait_frames(2)
        xdotool("click", "--repeat", "3", "--delay", "60", "4")
        window.wait_frames(2)
        nearer = pictures_of(window)
        for lane in LANES:
            assert differing_share(before[lane], nearer[lane]) > 0.02, f"{lane} was not zoomed"
        xdotool("keydown", "shift")
        window.wait_frames(2)
        azimuth = window.state()["azimuth"]
        window.drag(name, (0.4, 0.4), (0.6, 0.5), button="2")
        xdotool("keyup", "shift")
        panned = pictures_of(window)
        assert window.state()["azimuth"] == azimuth, "it orbited"
        for lane in LANES:
            assert differing_share(nearer[lane], panned[lane]) > 0.02, f"{lane} was not panned"


def test_holding_c_goes_on_collapsing_and_is_one_step(folder):
    with open_chair(folder) as window:
        window.click(view(window, "ias"))
        start = window.lane("ias")["triangles"]
        counts = set()

        def falls():
            counts.add(window.lane("ias")["triangles"])
            return len(counts) > 4
        xdotool("keydown", "c")
        try:
            window.wait("four steps", falls)
        finally:
            xdotool("keyup", "c")
        window.wait_frames(3)
        fewer = window.lane("ias")["triangles"]
        assert fewer < start
        window.key("shift+v")
        window.wait("split back", lambda: window.lane("ias")["triangles"] > fewer)
        window.key("ctrl+z")
        window.wait("collapsed", lambda: window.lane("ias")["triangles"] == fewer)
        window.key("ctrl+z")
        window.wait("all of it", lambda: window.lane("ias")["triangles"] == start)


def test_ctrl_3_brings_the_pair_back_and_ctrl_y_redoes(folder):
    with open_chair(folder) as window:
        window.key("ctrl+9")
        window.wait("nine lanes", lambda: window.document()["lanes"] > 3)
        window.key("ctrl+3")
        window.wait("three lanes", lambda: window.document()["lanes"] == 3)
        window.key("ctrl+z")
        window.wait("nine again", lambda: window.document()["lanes"] > 3)
        window.key("ctrl+y")
        window.wait("three again", lambda: window.document()["lanes"] == 3)


def test_ctrl_q_asks_and_quits(folder):
    with open_chair(folder) as window:
        window.key("ctrl+q")
        window.click("Quit/Quit")
        assert window.process.wait(30) == 0


def test_a_value_can_be_typed(folder):
    with open_chair(folder) as window:
        other = window.lane("quadric")["triangles"]
        full = window.lane("original")["triangles"]
        window.click(view(window, "ias"))
        window.click("Inspector/Target value")
        window.key("ctrl+a")
        window.type("35")
        window.key("Return")
        window.wait("35 %", lambda: 0.3 * full < window.lane("ias")["triangles"] <= 0.35 * full)
        assert window.lane("quadric")["triangles"] == other


def test_a_sample_opens_from_the_first_screen(_):
    with Window(base.BINARY) as window:
        window.wait_ready("original")
        window.click("Welcome/chair")
        window.wait("the chair", lambda: window.document()["scene"] != "" and
                    window.lane("original")["instances"] == 68)
        assert not window.state()["welcome"]
        window.wait_ready(*LANES)


def test_difference_and_heat_map_can_be_left_with_a_key(folder):
    with open_chair(folder) as window:
        for mode in ("Heat map", "Difference"):
            compare(window, mode)
            window.key("space")
            window.wait("two lanes", lambda: window.state()["compare"] == "split")


if __name__ == "__main__":
    sys.exit(base.main(globals()))
