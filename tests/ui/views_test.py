#!/usr/bin/env python3
"""What views show and how lanes are compared, in the real window: picking, modes, keys, targets.

usage: views_test.py BINARY [NAME...]      as window_test.py
"""
import os
import sys
import time

import window_test as base
from window import differing_share, pixels_of, xdotool
from window_test import LANES, open_chair

DOUBLE_CLICK_S = 0.5  # clicks that follow within less are double clicks


def view(window, algorithm):
    return f"View {window.lane_id(algorithm)}/picture"


def coloured_pixel(ppm):
    """Of the pixels of the model, that nearest to the middle; as fractions of the picture."""
    width, height, data = pixels_of(ppm)
    best = None
    for y in range(0, height, 3):
        for x in range(0, width, 3):
            at = 3 * (y * width + x)
            pixel = data[at:at + 3]
            if max(pixel) - min(pixel) < 25 and max(pixel) < 90:
                continue
            distance = (x - width / 2) ** 2 + (y - height / 2) ** 2
            if best is None or distance < best[0]:
                best = distance, x, y
    assert best, "the picture is empty"
    return (best[1] + 0.5) / width, (best[2] + 0.5) / height


def choose(window, item, *submenus):
    """From the menu that the display button opens."""
    def is_open():
        return window.get("menu", "display")["open"]
    while not is_open():
        window.click("Master/display")
    for name in submenus:
        window.click(f"Display/{name}")
    window.click(f"Display/{item}")
    window.wait("a choice", lambda: not is_open())


def compare(window, mode):
    window.click(f"Menu/Compare/{mode}")
    window.wait(f"mode {mode}", lambda: window.state()["compare"] == mode.lower())


def test_a_click_selects_the_instance_and_a_double_click_its_submesh(folder):
    with open_chair(folder) as window:
        window.wait_still()
        name = view(window, "ias")
        x, y, width, height = window.rect(name)
        place = coloured_pixel(window.picture(window.rect(name)))
        target = round(x + place[0] * width), round(y + place[1] * height)

        def click(count=1):
            window.move(*target)
            window.wait_frames(2)
            xdotool("click", "--repeat", str(count), "--delay", "80", "1")
            window.wait_frames(3)
        click()
        (submesh, instance), = window.wait("a selection", lambda: window.document()["selection"])
        assert instance >= 0
        window.wait_still()
        before = window.picture(window.rect(name))
        window.key("f")
        window.wait_still()
        assert differing_share(before, window.picture(window.rect(name))) > 0.05, "F framed nothing"
        window.key("Home")
        window.wait_still()
        click(2)
        window.wait("the submesh", lambda: window.document()["selection"] == [[submesh, -1]])
        window.move(round(x + 4), round(y + height - 6))
        window.wait_frames(2)
        xdotool("click", "1")
        window.wait("nothing selected", lambda: window.document()["selection"] == [])


def test_shift_click_adds_and_takes_away_and_a_drag_selects_nothing(folder):
    with open_chair(folder) as window:
        window.wait_still()
        name = view(window, "quadric")  # answers in the original's instances too
        x, y, width, height = window.rect(name)
        place = coloured_pixel(window.picture(window.rect(name)))
        window.move(round(x + place[0] * width), round(y + place[1] * height))
        window.wait_frames(2)
        for expected in (1, 0):
            time.sleep(DOUBLE_CLICK_S)  # two single clicks, not a double one
            xdotool("keydown", "shift")
            window.wait_frames(2)
            xdotool("click", "1")
            window.wait(f"{expected} selected",
                        lambda e=expected: len(window.document()["selection"]) == e)
            xdotool("keyup", "shift")
            window.wait_frames(2)
        window.drag(name, place, (place[0] + 0.1, place[1]))
        assert window.document()["selection"] == []


def test_the_heat_map_follows_the_target_and_has_a_legend(folder):
    with open_chair(folder) as window:
        window.wait_still()
        before = window.picture(window.rect(view(window, "ias")))
        compare(window, "Heat map")

        def up_to_date():
            return all(window.lane(name)["error_map"] == window.lane(name)["lod"] for name in LANES)
        window.wait("every lane's map", up_to_date)
        window.wait_still()
        assert differing_share(before, window.picture(window.rect(view(window, "ias")))) > 0.02
        window.wait("a legend", lambda: window.get("widget", f"View {window.lane_id('ias')}/legend"))
        lod = window.lane("ias")["lod"]
        window.drag(f"Lane {window.lane_id('ias')}/Target", (0.45, 0.5), (0.1, 0.5))
        window.wait("the new LOD's map", lambda: window.lane("ias")["lod"] > lod and up_to_date())
        original = window.picture(window.rect(view(window, "original")))
        _, _, data = pixels_of(original)
        violet = sum(data[at] > data[at + 1] + 20 and data[at + 2] > data[at + 1] + 30
                     for at in range(0, len(data), 3))
        assert violet > 200, "the original is not at the lower end of the map"


def test_the_image_difference_has_a_number_that_grows_with_simplification(folder):
    with open_chair(folder) as window:
        compare(window, "Difference")
        window.wait("the numbers", lambda: all(window.lane(name)["flip"] >= 0
                                               for name in ("ias", "quadric")))
        window.wait_still()
        fine = window.lane("ias")["flip"]
        window.drag(f"Lane {window.lane_id('ias')}/Target", (0.45, 0.5), (0.06, 0.5))
        window.wait("a larger difference", lambda: window.lane("ias")["flip"] > fine)
        assert window.lane("original")["flip"] < 0, "the original is compared with itself"
        window.wait("the number", lambda: window.get("widget", f"View {window.lane_id('ias')}/number"))
        compare(window, "Grid")
        window.wait("no number", lambda: window.lane("ias")["flip"] < 0)


def test_flicker_shows_two_lanes_in_turn(folder):
    with open_chair(folder) as window:
        compare(window, "Flicker")
        for name in ("original", "ias"):
            window.wait(f"{name}'s turn", lambda n=name: window.get("flicker", "flicker") and str(
                window.get("flicker", "flicker")["lane"]) == window.lane_id(n))
        assert window.state()["views"] == 2


def test_every_shading_and_background_is_another_picture(folder):
    with open_chair(folder) as window:
        rect = window.rect(view(window, "ias"))
        pictures = []
        modes = {"Clay": "clay", "Matcap": "matcap", "Flat": "flat", "Normals": "normals",
                 "UV checker": "uv", "By submesh": "submesh", "By instance": "instance",
                 "By LOD state": "lod", "Texel density": "texels", "Lit": "lit"}
        for mode, name in modes.items():
            choose(window, f"Shading: {mode}")
            window.wait(mode, lambda n=name: window.state()["shading"] == n)
            window.move(*window.center("Master/Master"))
            window.wait_still()
            pictures.append(window.picture(rect))
        for mode, before, after in zip(list(modes)[1:], pictures, pictures[1:]):
            assert differing_share(before, after) > 0.01, mode
        choose(window, "Light", "Background")
        window.move(*window.center("Master/Master"))
        window.wait_still()
        assert differing_share(pictures[-1], window.picture(rect)) > 0.2, "the same background"


def test_the_camera_that_shows_everything_does_so_in_views_of_another_shape(folder):
    with open_chair(folder) as window:
        window.wait_still()  # lanes can be ready before their views have their shape
        narrow = window.state()["distance"]
        window.click("Menu/Views/1")
        window.wait("another distance",
                    lambda: abs(window.state()["distance"] - narrow) > 0.05 * narrow)
        window.click("Menu/Views/3")
        window.wait("as before", lambda: abs(window.state()["distance"] - narrow) < 0.01 * narrow)
        window.drag(view(window, "ias"), (0.4, 0.5), (0.6, 0.5))
        window.click("Menu/Views/1")
        window.wait("one view", lambda: window.state()["views"] == 1)
        window.wait_still()
        assert abs(window.state()["distance"] - narrow) < 0.01 * narrow, "the user's camera moved"


def test_g_shows_the_floor_and_m_makes_it_shine(folder):
    with open_chair(folder) as window:
        rect = window.rect(view(window, "original"))
        window.wait_still()
        before = window.picture(rect)
        window.key("g")
        window.wait("the floor", lambda: window.state()["grid"])
        window.wait_still()
        assert differing_share(before, window.picture(rect)) > 0.005
        for _ in range(3):
            window.key("m")
        window.wait("more gloss", lambda: window.state()["shininess"] > 1.9)
        for _ in range(6):
            window.key("shift+m")
        window.wait("less gloss", lambda: window.state()["shininess"] < 0.6)


def test_the_sheet_of_keys_can_be_searched(folder):
    with open_chair(folder) as window:
        window.key("F1")
        every = window.wait("the sheet", lambda: window.get("sheet", "sheet"))["rows"]
        assert every > 30
        window.type("wirefr")
        window.wait("one row", lambda: window.get("sheet", "sheet")["rows"] == 1)
        window.key("Escape")
        window.wait("no dialog", lambda: window.state()["dialog"] == 0)
        assert not window.state()["wireframe"], "a typed letter was taken for a key"


def test_the_mouse_can_be_that_of_blender_or_maya(folder):
    with open_chair(folder) as window:
        name = view(window, "original")
        rect = window.rect(name)

        def moved(button, modifier=None):
            window.wait_still()
            before = window.picture(rect)
            if modifier:
                xdotool("keydown", modifier)
                window.wait_frames(2)
            window.drag(name, (0.3, 0.2), (0.6, 0.25), button=button)  # zooming adds right and up
            if modifier:
                xdotool("keyup", modifier)
                window.wait_frames(2)
            window.wait_still()
            return differing_share(before, window.picture(rect)) > 0.01
        assert moved("1") and moved("3")
        choose(window, "Blender", "Mouse like")
        assert not moved("1") and moved("2") and moved("2", "ctrl")
        choose(window, "Maya", "Mouse like")
        assert not moved("1") and not moved("2") and moved("1", "alt") and moved("3", "alt")


def test_a_chart_of_errors_stands_behind_that_of_sizes(folder):
    with open_chair(folder) as window:
        window.wait("the curves", lambda: window.get("widget", "Compare/chart"))
        window.click("Compare/Chart/error")
        window.wait("the other chart", lambda: window.get("widget", "Compare/error chart"))
        assert window.state()["error_chart"]
        before = window.picture(window.rect("Compare/error chart"))
        window.drag("Master/Master", (0.45, 0.5), (0.2, 0.5))
        assert differing_share(before, window.picture(window.rect("Compare/error chart"))) > 0.001


def test_the_mouse_over_a_chart_reads_its_values(folder):
    with open_chair(folder) as window:
        window.wait("the curves", lambda: window.get("widget", "Compare/chart"))
        chart = window.rect("Compare/chart")
        window.move(60, 300)
        window.wait_still()
        before = window.picture(chart)
        window.move(round(chart[0] + 0.5 * chart[2]), round(chart[1] + 0.5 * chart[3]))
        window.wait("what is read", lambda: window.get("reading", "chart"))
        window.wait_frames(3)
        reading = window.get("reading", "chart")
        assert 0.45 < reading["ratio"] < 0.55 and reading["lanes"] == 2, reading
        assert differing_share(before, window.picture(chart)) > 0.01, "nothing is shown"


def test_a_lane_takes_its_target_in_each_unit(folder):
    with open_chair(folder) as window:
        window.click(view(window, "ias"))
        for kind, typed, holds in (
                ("tri", "900", lambda lane: 800 < lane["triangles"] <= 900),
                ("size", "15 KB", lambda lane: 13_000 < lane["bytes"] <= 15_360),
                ("error", "0.5", lambda lane: lane["triangles"] > 0),
                ("%", "50", lambda lane: 0.45 < lane["ratio"] <= 0.5)):
            window.click(f"Inspector/Target kind/{kind}")
            lod = window.lane("ias")["lod"]
            window.click("Inspector/Target value")
            window.key("ctrl+a")
            window.type(typed)
            window.key("Return")
            window.wait(f"{typed} {kind}", lambda h=holds, n=lod: window.lane("ias")["lod"] > n and
                        h(window.lane("ias")))


def test_a_target_in_pixels_follows_the_camera(folder):
    with open_chair(folder) as window:
        window.click(view(window, "ias"))
        window.click("Menu/Equal/pixels")
        window.wait_frames(3)
        near = {name: window.lane(name)["triangles"] for name in ("ias", "quadric")}
        for _ in range(12):
            window.key("s")
        for name, triangles in near.items():
            window.wait(f"{name} has fewer triangles",
                        lambda n=name, t=triangles: window.lane(n)["triangles"] < t)
        far = window.lane("ias")["triangles"]
        window.key("Home")
        window.wait("more again", lambda: window.lane("ias")["triangles"] > far)
        window.click("Inspector/Target kind/px")
        window.drag(f"Lane {window.lane_id('ias')}/Target", (0.5, 0.5), (0.95, 0.5))
        assert window.lane("ias")["triangles"] < window.lane("quadric")["triangles"]


def test_the_master_gives_equal_bytes(folder):
    with open_chair(folder) as window:
        window.click("Menu/Equal/bytes")
        window.drag("Master/Master", (0.7, 0.5), (0.6, 0.5))
        window.wait("both lanes ready", lambda: all(window.lane(name)["state"] == "ready"
                                                    for name in ("ias", "quadric")))
        lanes = [window.lane(name) for name in ("ias", "quadric")]
        if not any(lane["note"] for lane in lanes):
            sizes = [lane["bytes"] for lane in lanes]
            assert max(sizes) < 1.1 * min(sizes), sizes


def test_measure_finds_distances_and_rates_of_every_lane(folder):
    with open_chair(folder) as window:
        window.click("Compare/Measure")
        for name in LANES:
            window.wait(f"{name}'s rate", lambda n=name: window.lane(n)["rate"] > 0)
            window.wait(f"{name}'s distance", lambda n=name: window.lane(n)["measured"])


def test_one_shot_lanes_follow_while_a_parameter_is_dragged(folder):
    with open_chair(folder) as window:
        window.key("ctrl+6")
        window.wait_ready("fass")
        window.click(view(window, "fass"))
        lod = window.lane("fass")["lod"]

        def while_held():
            window.wait("another LOD", lambda: window.lane("fass")["lod"] > lod)
            assert window.lane("fass")["triangles"] > 0
        window.drag("Inspector/Radius", (0.3, 0.5), (0.7, 0.5), then=while_held)
        window.wait_ready("fass")


def test_an_idle_window_leaves_the_processor_alone(folder):
    with open_chair(folder) as window:
        window.wait_still()
        window.wait("no jobs", lambda: window.document()["jobs"] == 0)

        def ticks():
            with open(f"/proc/{window.process.pid}/stat", encoding="ascii") as stat:
                fields = stat.read().rsplit(")", 1)[1].split()
            return int(fields[11]) + int(fields[12])
        window.window_id()
        window.wait_frames(3)
        settled = ticks()
        window.wait("two seconds of rest", lambda begin=time.monotonic(): time.monotonic() > begin + 2)
        before, begin = ticks(), time.monotonic()
        window.wait("five more", lambda: time.monotonic() > begin + 5)
        share = (ticks() - before) / os.sysconf("SC_CLK_TCK") / (time.monotonic() - begin)
        print(f"        idle: {100 * share:.2f} % of a core ({settled} ticks before)")
        assert share < 0.03


if __name__ == "__main__":
    sys.exit(base.main(globals()))
