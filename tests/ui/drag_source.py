#!/usr/bin/env python3
"""A window that offers one file to drag from. usage: drag_source.py X Y FILE

Prints "ready" once it stands at X, Y and "dropped" when a drag of it was accepted.
"""
import pathlib
import sys

import gi

gi.require_version("Gdk", "3.0")
gi.require_version("Gtk", "3.0")
from gi.repository import Gdk, Gtk  # noqa: E402


def main():
    x, y, file = int(sys.argv[1]), int(sys.argv[2]), pathlib.Path(sys.argv[3])
    window = Gtk.Window(type=Gtk.WindowType.POPUP)
    window.set_default_size(80, 60)
    window.move(x, y)
    window.add(Gtk.EventBox())
    source = window.get_child()
    source.drag_source_set(Gdk.ModifierType.BUTTON1_MASK, [], Gdk.DragAction.COPY)
    source.drag_source_add_uri_targets()
    source.connect("drag-data-get",
                   lambda _widget, _context, data, *_: data.set_uris([file.as_uri()]))
    source.connect("drag-end", lambda *_: print("dropped", flush=True))
    window.connect("map-event", lambda *_: print("ready", flush=True))
    window.show_all()
    Gtk.main()


if __name__ == "__main__":
    main()
