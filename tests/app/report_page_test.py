#!/usr/bin/env python3
"""Checks the page that `lodestone compare --html` writes.

usage: report_page_test.py BINARY
The page of the sample chair, all algorithms: well-formed, closed in itself, every row in every
table, every picture, no algorithm without its curve. Exit 0 if all holds; else one line per breach.
"""
import base64
import json
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ET

TABLES = ["results", "bytes", "times"]
CHARTS = 4


def run(binary, *arguments):
    ran = subprocess.run([binary, *arguments], check=False, capture_output=True, text=True,
                         timeout=600)
    if ran.returncode != 0:
        sys.exit(f"{' '.join(arguments)}: exit code {ran.returncode}: {ran.stderr}")
    return ran.stdout


def classes(element):
    return element.get("class", "").split()


def of_class(root, name):
    return [element for element in root.iter() if name in classes(element)]


def text_of(element):
    return "".join(element.itertext())


def check_closed(text, root):
    """Nothing is fetched, and nothing could be."""
    without_pictures = re.sub(r"data:image/png;base64,[A-Za-z0-9+/=]*", "", text)
    for reference in re.findall(r"https?://|//[a-z0-9.-]+/|@import|url\(", without_pictures):
        yield f"the page refers to {reference}"
    for element in root.iter():
        for name in ("src", "href", "srcset", "data", "action", "poster"):
            value = element.get(name)
            if value and not value.startswith(("data:", "#")):
                yield f"<{element.tag} {name}={value[:60]}> is not in the page"
        for name in element.keys():
            if name.startswith("on"):
                yield f"<{element.tag}> has the handler {name}"
    policies = [meta.get("content") for meta in root.iter("meta")
                if meta.get("http-equiv") == "Content-Security-Policy"]
    if len(policies) != 1 or not policies[0].startswith("default-src 'none'"):
        yield f"content security policy: {policies}"


def check_references(root):
    """Every id once; every label and link points at one."""
    ids = [element.get("id") for element in root.iter() if element.get("id")]
    for name in sorted({one for one in ids if ids.count(one) > 1}):
        yield f"the id {name} is there more than once"
    for element in root.iter():
        for value in (element.get("aria-labelledby"), (element.get("href") or "")[1:]):
            if value and not (element.get("href") or "#").startswith("data:") and value not in ids:
                yield f"<{element.tag}> points at {value}, which is not there"
    for image in root.iter("img"):
        if image.get("alt") is None:
            yield "a picture has no alternative text"


def check_tables(root, names, report):
    for table_id in TABLES:
        section = next((one for one in root.iter("section")
                        if one.get("aria-labelledby") == table_id), None)
        if section is None:
            yield f"there is no table {table_id}"
            continue
        rows = [row.get("data-algorithm") for row in section.find(".//tbody")]
        if rows != names:
            yield f"the table {table_id} has the rows {rows}, not {names}"
        columns = len(section.find(".//thead/tr"))
        for row in section.find(".//tbody"):
            if len(row) != columns:
                yield f"{table_id}: {row.get('data-algorithm')} has {len(row)} cells, not {columns}"
    results = root.find(".//section[@aria-labelledby='results']//tbody")
    for shown, told in zip(results, [report["original"], *report["rows"]]):
        if f"{told['triangles']:,}" not in text_of(shown):
            yield f"{told['algorithm']}: {told['triangles']} triangles are not in the table"
    wrong = len(of_class(root.find(".//section[@aria-labelledby='bytes']"), "warning"))
    if wrong:
        yield f"{wrong} rows were not predicted to the byte"


def check_pictures(root, names):
    pictures = [image for image in root.iter("img") if image.get("data-name")]
    if len(pictures) != len(names):
        yield f"{len(pictures)} pictures for {len(names)} rows"
    for picture in pictures:
        png = base64.b64decode(picture.get("src").split(",", 1)[1], validate=True)
        if png[:8] != b"\x89PNG\r\n\x1a\n" or png[-8:-4] != b"IEND":
            yield f"{picture.get('data-name')}: the picture is no PNG file"
            continue
        size = struct.unpack(">II", png[16:24])
        if size != (int(picture.get("width")), int(picture.get("height"))):
            yield f"{picture.get('data-name')}: {size} pixels are not what the page says"


def check_charts(root, algorithm_count):
    charts = of_class(root, "chart")
    if len(charts) != CHARTS:
        yield f"{len(charts)} charts, not {CHARTS}"
    for chart in charts:
        name = chart.get("aria-label")
        if not name:
            yield "a chart says nothing to those who cannot see it"
        _, _, width, height = map(float, chart.get("viewBox").split())
        series = of_class(chart, "series")
        if len(series) != algorithm_count:
            yield f"{name}: {len(series)} lines, not {algorithm_count}"
        for element in chart.iter("path"):
            if re.search(r"nan|inf", element.get("d")):
                yield f"{name}: a line leads to {element.get('d')}"
        for mark in of_class(chart, "marker"):
            x, y = map(float, re.findall(r"-?[\d.]+", mark.get("transform")))
            if not (0 <= x <= width and 0 <= y <= height):
                yield f"{name}: a point lies outside, at {x}, {y}"
    if len(of_class(root, "reference")) != 1:
        yield "the original is not a line of the chart of sizes"


def main():
    binary = sys.argv[1]
    algorithms = [row["id"] for row in
                  json.loads(run(binary, "--list-algorithms", "--json"))["algorithms"]]
    with tempfile.TemporaryDirectory() as folder:
        chair = pathlib.Path(folder, "chair <&>.glb")
        page = pathlib.Path(folder, "page.html")
        run(binary, "generate", "chair", "-o", str(chair))
        report = json.loads(run(binary, "compare", str(chair), "--ratio", "0.4", "--json",
                                "--html", str(page)))
        text = page.read_text(encoding="utf-8")
        left = [path.name for path in pathlib.Path(folder).iterdir()]
    breaches = [] if sorted(left) == ["chair <&>.glb", "page.html"] else [f"left behind: {left}"]
    root = ET.fromstring(text)
    names = ["original", *algorithms]
    for check in (check_closed(text, root), check_references(root),
                  check_tables(root, names, report), check_pictures(root, names),
                  check_charts(root, len(algorithms))):
        breaches += check
    for breach in breaches:
        print(breach)
    sys.exit(1 if breaches else 0)


if __name__ == "__main__":
    main()
