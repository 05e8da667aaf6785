"""Drives the real window: starts it with a log of its state, finds widgets by name, moves the mouse.

Waits for what the program logs, never for time; a wait that is not met in PATIENCE_S fails.
"""
import json
import os
import pathlib
import subprocess
import tempfile
import time

SEVERITIES = ("info", "warning", "error")
PATIENCE_S = float(os.environ.get("LODESTONE_UI_PATIENCE", "90"))
POLL_S = 0.02


class Window:
    """The program in the display that $DISPLAY names. Use as a context manager."""

    def __init__(self, binary, arguments=(), environment=None, folder=None):
        self._folder = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(folder or self._folder.name)
        self.log_path = self.folder / "ui.log"
        self.log_path.unlink(missing_ok=True)
        variables = dict(os.environ, LODESTONE_UI_LOG=str(self.log_path),
                         XDG_CONFIG_HOME=str(self.folder / "config"), HOME=str(self.folder))
        variables.update(environment or {})
        self._errors = open(self.folder / "stderr.txt", "wb")
        self.process = subprocess.Popen([binary, *map(str, arguments)], env=variables,
                                        cwd=self.folder, stderr=self._errors)
        self._offset = 0
        self._partial = b""
        self.objects = {}  # (kind, name) -> the newest line about it
        self.frame = 0
        self.messages = []
        self.frame_times = []
        self.changes = {}  # number of a frame -> {(kind, name)} of what became another in it
        self._changed = set()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.terminate()
            try:
                self.process.wait(20)
            except subprocess.TimeoutExpired:
                self.process.kill()
        self._errors.close()
        self._folder.cleanup()

    # --- state ---
    def read(self):
        """Takes in what was logged since the last time."""
        if not self.log_path.exists():
            return
        with open(self.log_path, "rb") as log:
            log.seek(self._offset)
            text = log.read()
        self._offset += len(text)
        lines = (self._partial + text).split(b"\n")
        self._partial = lines.pop()
        for line in lines:
            entry = json.loads(line)
            if entry["kind"] == "frame":
                self.frame = entry["number"]
                self.changes[self.frame], self._changed = self._changed, set()
            else:
                self.objects[entry["kind"], entry["name"]] = entry
                self._changed.add((entry["kind"], entry["name"]))
            if entry["kind"] == "frames":
                self.frame_times.append(entry)
            if entry["kind"] == "message":
                self.messages.append(dict(entry, severity=SEVERITIES[entry["severity"]]))

    def wait(self, what, condition):
        """Until condition() is true; its value. Fails with `what`."""
        end = time.monotonic() + PATIENCE_S
        while True:
            self.read()
            value = condition()
            if value:
                return value
            if self.process.poll() is not None:
                raise AssertionError(f"the program ended ({self.process.returncode}) before: {what}\n"
                                     + (self.folder / "stderr.txt").read_text())
            if time.monotonic() > end:
                raise AssertionError(f"waited {PATIENCE_S} s in vain for: {what}")
            time.sleep(POLL_S)

    def get(self, kind, name):
        return self.objects.get((kind, name))

    def document(self):
        return self.get("document", "document")

    def state(self):
        return self.get("window", "state")

    def lane(self, algorithm):
        """The state of the newest lane with this algorithm."""
        lanes = [entry for (kind, _), entry in self.objects.items()
                 if kind == "lane" and entry["algorithm"] == algorithm]
        return max(lanes, key=lambda entry: int(entry["name"])) if lanes else None

    def lane_id(self, algorithm):
        return self.lane(algorithm)["name"]

    def wait_frames(self, count=3):
        """Until that many more pictures are out."""
        goal = self.frame + count
        nudged = [0.0]

        def out():
            if time.monotonic() > nudged[0]:  # an idle window draws only when something happens
                nudged[0] = time.monotonic() + 0.3
                xdotool("mousemove_relative", "--", "1", "0", "mousemove_relative", "--", "-1", "0")
            return self.frame >= goal
        self.wait(f"{count} more frames", out)

    def wait_still(self):
        """Until every picture is final: no draft, nothing left to draw."""
        self.window_id()
        self.wait_frames(2)  # what was just asked for has been seen by a whole frame
        self.wait("final pictures", lambda: self.get("pictures", "pictures") and
                  self.get("pictures", "pictures")["final"])

    def wait_ready(self, *algorithms):
        for algorithm in algorithms:
            self.wait(f"lane {algorithm} ready",
                      lambda a=algorithm: self.lane(a) and self.lane(a)["state"] == "ready")

    # --- input ---
    def rect(self, name):
        entry = self.wait(f"widget {name}", lambda: self.get("widget", name))
        return entry["rect"]

    def center(self, name):
        x, y, width, height = self.rect(name)
        return round(x + width / 2), round(y + height / 2)

    def move(self, x, y):
        xdotool("mousemove", "--window", self.window_id(), str(x), str(y))

    def window_id(self):
        if not hasattr(self, "_window_id"):
            found = self.wait("a window", lambda: run(["xdotool", "search", "--onlyvisible",
                                                       "--pid", str(self.process.pid)], check=False))
            self._window_id = found.split()[-1]
            xdotool("windowfocus", self._window_id)
            self.move(100, 100)  # inside it, however small it becomes: see wait_frames
        return self._window_id

    def click(self, name, count=1):
        self.move(*self.center(name))
        self.wait_frames(2)
        xdotool("click", "--repeat", str(count), "--delay", "80", "1")
        self.wait_frames(3)

    def drag(self, name, begin, end, steps=8, button="1", then=None):
        """From one place of the widget to another, as fractions of its size; `then` runs before
        the button is let go."""
        x, y, width, height = self.rect(name)

        def at(place):
            return round(x + width * place[0]), round(y + height * place[1])
        self.move(*at(begin))
        self.wait_frames(2)
        xdotool("mousedown", button)
        self.wait_frames(2)
        for step in range(1, steps + 1):
            share = step / steps
            self.move(*at((begin[0] + (end[0] - begin[0]) * share, begin[1] + (end[1] - begin[1]) * share)))
            self.wait_frames(1)
        if then:
            then()
        xdotool("mouseup", button)
        self.wait_frames(3)

    def key(self, keys):
        """A chord such as "ctrl+o", as slowly as a hand does it: each step is seen by a frame."""
        self.window_id()
        *modifiers, last = keys.split("+")
        for modifier in modifiers:
            xdotool("keydown", modifier)
            self.wait_frames(2)
        xdotool("keydown", last)
        self.wait_frames(2)
        xdotool("keyup", last)
        for modifier in modifiers:
            xdotool("keyup", modifier)
        self.wait_frames(3)

    def type(self, text):
        xdotool("type", "--delay", "15", text)
        self.wait_frames(3)

    # --- pictures ---
    def picture(self, rect=None, path=None):
        """The window's pixels as bytes of a PPM file, or one widget's; saved as PNG with a path."""
        area = []
        if rect:
            x, y, width, height = (round(value) for value in rect)
            area = ["-crop", f"{width}x{height}+{x}+{y}", "+repage"]
        grabbed = subprocess.run(["import", "-window", self.window_id(), "png:-"], check=True,
                                 capture_output=True).stdout
        if path:
            pathlib.Path(path).write_bytes(grabbed)
        return subprocess.run(["convert", "png:-", *area, "ppm:-"], input=grabbed, check=True,
                              capture_output=True).stdout


def xdotool(*arguments):
    return run(["xdotool", *arguments])


def run(command, check=True):
    return subprocess.run(command, check=check, capture_output=True, text=True).stdout


def pixels_of(ppm):
    """Width, height and RGB bytes of a binary PPM."""
    fields = ppm.split(maxsplit=4)
    assert fields[0] == b"P6", fields[0]
    width, height = int(fields[1]), int(fields[2])
    return width, height, ppm[-3 * width * height:]


def differing_share(before, after):
    """Share of pixels that differ between two pictures of one size."""
    width, height, a = pixels_of(before)
    assert (width, height) == pixels_of(after)[:2], "pictures of different size"
    b = pixels_of(after)[2]
    differing = sum(a[at:at + 3] != b[at:at + 3] for at in range(0, len(a), 3))
    return differing / (width * height)


def coloured_share(ppm):
    """Share of pixels that are not the grey of an empty view: how much of the model is seen."""
    _, _, data = pixels_of(ppm)
    coloured = sum(max(data[at:at + 3]) - min(data[at:at + 3]) > 40 for at in range(0, len(data), 3))
    return coloured * 3 / len(data)
