#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Reads the exports of a map with Python's own parsers and compares them with landmarks.json; prints what differs.

Usage: read_exports.py FOLDER LANDMARKS.json SCALE
"""
import csv
import json
import math
import pathlib
import sys
import xml.etree.ElementTree as xml

SVG = "{http://www.w3.org/2000/svg}"
problems = []


def expect(condition, text):
    if not condition:
        problems.append(text)


def near(a, b, tolerance=2e-3):
    return len(a) == len(b) and all(math.dist(p, q) < tolerance for p, q in zip(a, b))


def area(ring):
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(ring, ring[1:] + ring[:1])) / 2


def check_geojson(folder, objects):
    collection = json.loads((folder / "objects.geojson").read_text())
    expect(collection["type"] == "FeatureCollection", "geojson: no FeatureCollection")
    features = {f["properties"]["id"]: f for f in collection["features"]}
    expect(features.keys() == objects.keys(), "geojson: other objects")
    for key, o in objects.items():
        ring = features[key]["geometry"]["coordinates"][0]
        expect(features[key]["geometry"]["type"] == "Polygon" and ring[0] == ring[-1], f"geojson: ring of {key} is open")
        expect(near(ring[:-1], o["footprint"], 1e-9) and area(ring[:-1]) > 0, f"geojson: footprint of {key}")
        for name in ("class", "size_wdh", "existence", "class_posterior", "x", "y"):
            expect(features[key]["properties"][name] == o[name], f"geojson: {name} of {key}")
        expect((features[key]["properties"]["yaw"] is None) == (not o["has_yaw"]), f"geojson: yaw of {key}")


def check_csv(folder, objects):
    with open(folder / "objects.csv", newline="") as file:
        rows = {int(row["id"]): row for row in csv.DictReader(file)}
    expect(rows.keys() == objects.keys(), "csv: other objects")
    for key, o in objects.items():
        row = rows[key]
        expect(row["class"] == o["class"] and row["model"] == o["model"], f"csv: names of {key}")
        values = [float(row[name]) for name in ("x_m", "y_m", "z_m", "width_m", "depth_m", "height_m", "existence")]
        expect(math.dist(values, [o["x"], o["y"], o["z"], *o["size_wdh"], o["existence"]]) < 3e-4, f"csv: numbers of {key}")
        expect(abs(float(row["sigma_y_m"]) - math.sqrt(o["covariance"][1][1])) < 1e-4, f"csv: sigma of {key}")


def check_svg(folder, objects, scale):
    root = xml.parse(folder / "plan.svg").getroot()
    view = [float(word) for word in root.get("viewBox").split()]
    for side, metres in (("width", view[2]), ("height", view[3])):
        expect(root.get(side).endswith("mm") and abs(float(root.get(side)[:-2]) - 1000 * metres / scale) < .01, "svg: scale")
    words = root.find(SVG + "desc").text.replace(",", "").split()
    left, top = float(words[words.index("from") + 1]), float(words[words.index("to") + 1])
    groups = {group.get("id"): group for group in root.iter(SVG + "g")}
    drawn = {int(p.get("data-id")): p for p in groups["objects"].iter(SVG + "polygon")}
    expect(drawn.keys() == objects.keys(), "svg: other objects")
    for key, o in objects.items():
        corners = [[float(v) for v in word.split(",")] for word in drawn[key].get("points").split()]
        expect(near([[left + u, top - v] for u, v in corners], o["footprint"]), f"svg: footprint of {key}")
        expect(drawn[key].find(SVG + "title").text.startswith(o["class"]), f"svg: title of {key}")
    expect(len(groups["walls"].find(SVG + "path").get("d")) > 20, "svg: no walls")


def read_dxf(file):
    """Layers, and entities as (type, layer, points, text, closed)."""
    lines = file.read_text().split("\n")
    pairs = [(int(code), value) for code, value in zip(lines[0::2], lines[1::2])]
    expect(pairs[-1] == (0, "EOF") and pairs[0] == (0, "SECTION"), "dxf: not whole")
    entities, layers, section = [], set(), ""
    for i, (code, value) in enumerate(pairs):
        if code == 2 and pairs[i - 1] == (0, "SECTION"):
            section = value
        if code == 2 and pairs[i - 1] == (0, "LAYER"):
            layers.add(value)
        if section != "ENTITIES" or code != 0 or value in ("ENDSEC", "EOF", "SECTION", "SEQEND"):
            continue
        body = {}
        for field, text in pairs[i + 1:]:
            if field == 0:
                break
            body[field] = text
        if value == "VERTEX":
            entities[-1][2].append([float(body[10]), float(body[20])])
        else:
            entities.append((value, body[8], [], body.get(1), body.get(70) == "1"))
    return layers, entities


def check_dxf(folder, objects):
    layers, entities = read_dxf(folder / "plan.dxf")
    expect({layer for _, layer, *_ in entities} <= layers, "dxf: entities on layers that are not declared")
    labels = {text for kind, _, _, text, _ in entities if kind == "TEXT"}
    closed = [(layer, points) for kind, layer, points, _, is_closed in entities if kind == "POLYLINE" and is_closed]
    for key, o in objects.items():
        layer = "OBJECT_" + "".join(c if c.isalnum() else "_" for c in o["class"].upper())
        expect(any(name == layer and near(points, o["footprint"]) for name, points in closed), f"dxf: footprint of {key}")
        expect(f"{o['class']} {key}" in labels, f"dxf: label of {key}")
    expect(sum(name == "WALLS" for name, _ in closed) >= 1, "dxf: no walls")


def check_ply(folder, objects):
    header, body = (folder / "map.ply").read_text().split("end_header\n")
    counts = {line.split()[1]: int(line.split()[2]) for line in header.split("\n") if line.startswith("element")}
    lines = body.strip().split("\n")
    expect(len(lines) == counts["vertex"] + counts["face"], "ply: counts")
    vertices = [[float(v) for v in line.split()[:3]] for line in lines[:counts["vertex"]]]
    for line in lines[counts["vertex"]:]:
        numbers = [int(v) for v in line.split()]
        expect(numbers[0] == len(numbers) - 1 >= 3 and max(numbers[1:]) < len(vertices), "ply: a face")
    for key, o in objects.items():
        top = o["z"] + o["size_wdh"][2]
        for x, y in o["footprint"]:
            expect(any(math.dist(v, (x, y, top)) < 1e-3 for v in vertices), f"ply: corner of {key}")


def main():
    folder = pathlib.Path(sys.argv[1])
    objects = {o["id"]: o for o in json.loads(pathlib.Path(sys.argv[2]).read_text())["landmarks"]}
    check_geojson(folder, objects)
    check_csv(folder, objects)
    check_svg(folder, objects, float(sys.argv[3]))
    check_dxf(folder, objects)
    check_ply(folder, objects)
    print("\n".join(sorted(set(problems))))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
