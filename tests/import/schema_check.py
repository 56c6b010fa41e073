# The schema and the reader of JSON scenes agree: on the examples, and on what becomes of them by thousands of small changes.
# SPDX-License-Identifier: MIT
# usage: schema_check.py SCHEMA VERDICTS SCENE...   VERDICTS is the program of json_verdicts.c. Exit code 77: skipped.
import copy, json, os, subprocess, sys, tempfile

try:
    import jsonschema
    Validator = jsonschema.Draft202012Validator
except (ImportError, AttributeError):
    print("SKIPPED: python3-jsonschema (4.0 or later) is not installed", file=sys.stderr)
    sys.exit(77)

FULL = {  # every key of the format once
    "portcullis": 1, "$schema": "x", "name": "n", "note": ["any"],
    "include": [{"file": "t.boxes", "at": [9, 0, 0], "turn": [0, 90, 0], "scale": 2}, {"file": "i.json", "name": "p", "at": [0, 50, 0]}],
    "meshes": [{"file": "t.boxes", "name": "m", "at": [0, 9, 0], "repeat": {"count": 2, "step": [0, 3, 0]}}],
    "boxes": [{"name": "b", "min": [0, 0, 0], "max": [4, 3, 5], "material": "brick", "side": "in", "omit": ["+x"]}],
    "walls": [{"name": "w", "points": [[4, 0, 0], [4, 0, 5], [4, 3, 5], [4, 3, 0]], "material": "glass"}],
    "zones": [{"name": "out"}, {"name": "a", "box": [[0, 0, 0], [4, 3, 5]], "in": "out", "chain": "frustum[backface=1]"},
              {"name": "b", "boxes": [[[4, 0, 0], [8, 3, 5]]], "hulls": [[[8, 0, 0], [8, 0, 5], [8, 3, 0], [9, 0, 0]]]},
              {"name": "c", "hull": [[20, 0, 0], [21, 0, 0], [20, 1, 0], [20, 0, 1]], "in": "out"}],
    "portals": [{"name": "way", "zones": ["a", "b"], "points": [[4, 0, 2], [4, 0, 3], [4, 2, 3], [4, 2, 2]], "door": "d"}],
    "doors": [{"name": "d", "open": True, "mover": "m"}],
    "movers": [{"name": "m", "box": {"min": [4, 0, 2], "max": [4.25, 2, 3], "material": "oak", "side": "out", "omit": ["-y"]},
                "open": [0, 0, 1], "pivot": [4, 0, 2], "at": [0, 0, 0], "turn": [0, 0, 0], "scale": 1},
               {"name": "f", "file": "t.boxes", "path": [{"time": 0}, {"time": 1.5, "at": [1, 0, 0], "turn": [0, 90, 0]}], "loop": True}],
    "lights": [{"name": "l", "kind": "point", "at": [1, 2, 3], "reach": 4, "colour": [1, 1, 0.5]}, {"kind": "sun", "direction": [0, -1, 0]}],
    "paths": [{"name": "w", "views": [{"eye": [1, 1, 1], "forward": [1, 0, 0], "up": [0, 1, 0], "fovy": 60, "aspect": 1.5, "near": 0.1, "far": 9},
                                      {"eye": [1, 1, 1], "forward": [1, 0, 0], "far": "inf"}]}, {"name": "v", "file": "t.views"}],
}
BRUSHES = {  # every key of a scene with brushes once
    "portcullis": 1,
    "brushes": [{"name": "rock", "box": {"min": [-9, -9, -9], "max": [9, 9, 9]}, "material": "rock", "texture": {"scale": 2, "offset": [0, 0.5]}},
                {"operation": "subtract", "cylinder": {"base": [0, 0, 0], "top": [0, 3, 0], "radius": 2, "segments": 7}, "at": [0, 1, 0], "turn": [0, 30, 0]},
                {"operation": "add", "cone": {"base": [0, 0, 0], "apex": [0, 2, 0], "radius": 1, "segments": 5}, "scale": 0.5},
                {"plane": {"point": [0, -5, 0], "normal": [0, 1, 0]}}, {"plane": {"points": [[0, -6, 0], [0, -6, 1], [1, -6, 0]]}},
                {"convex": {"points": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]}},
                {"convex": {"planes": [{"point": [0, 0, 0], "normal": [-1, 0, 0]}, {"point": [0, 0, 0], "normal": [0, -1, 0]},
                                       {"point": [0, 0, 0], "normal": [0, 0, -1]}, {"points": [[1, 0, 0], [0, 1, 0], [0, 0, 1]]}]}},
                {"operation": "portal", "name": "gate", "box": {"min": [0, 1, 0], "max": [0.1, 3, 2]}, "door": "d"}],
    "zone_info": [{"name": "z", "at": [0, 1, 0], "chain": "frustum"}],
    "starts": [{"name": "here", "at": [0, 2, 0]}],
    "doors": [{"name": "d"}],
}
INCLUDED = {"portcullis": 1, "boxes": [{"min": [0, 0, 0], "max": [1, 1, 1]}], "zones": [{"name": "z", "box": [[0, 0, 0], [1, 1, 1]]}]}


def places(value, way=()):
    yield way
    children = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, child in children:
        yield from places(child, way + (key,))


def changed(document, way, change):
    document = copy.deepcopy(document)
    above = document
    for key in way[:-1]:
        above = above[key]
    change(above, way[-1])
    return document


VALUES = (None, True, "", "word", -1, 0.5, 1e10, [], {}, [1, 2, 3], [[1, 2, 3]] * 300, "x" * 1024, "/x")


def changes(document, values=VALUES):
    def put(value):
        def change(above, key):
            above[key] = value
        return change

    def drop(above, key):
        del above[key]

    def add_key(above, key):
        above[key]["unheard of"] = 1

    for way in places(document):
        if not way or way[0] == "note":
            continue
        for value in values:
            yield changed(document, way, put(value))
        yield changed(document, way, drop)
        value = document
        for key in way:
            value = value[key]
        if isinstance(value, dict):
            yield changed(document, way, add_key)
    yield {**document, "unheard of": 1}


def verdicts(program, folder, documents):
    paths = []
    for number, document in enumerate(documents):
        paths.append(os.path.join(folder, f"{number}.json"))
        with open(paths[-1], "w", encoding="utf-8") as file:
            json.dump(document, file)
    lines = []
    for first in range(0, len(paths), 500):
        done = subprocess.run([program, *paths[first:first + 500]], check=True, capture_output=True, text=True)
        lines += done.stdout.splitlines()
    return lines


# What only the reader can know: meaning. Everything else that it refuses, the schema refuses too.
MEANING = ("there is no", "already", "not later", "is not within 1", "overlap", "no face", "is above", "the wall", "the hull", "the zone", "the portal",
           "the mover", "no door has", "a door has", "unknown kind", "cannot", "correct the view", "chain '", "a name begins", "a scene", "is no mesh",
           "no polygon", "placed too far", "only a .json", "wide;", "a direction", "the path", "beyond", "is not finite", "a colour", "goes beyond", "m wide",
           "no volume", "leave it open", "by hand", "there are none", "no brushes")


def main():
    schema_path, program, *scenes = sys.argv[1:]
    with open(schema_path, encoding="utf-8") as file:
        schema = json.load(file)
    Validator.check_schema(schema)
    validator = Validator(schema)
    faults = []
    for path in scenes:
        with open(path, encoding="utf-8") as file:
            faults += [f"{path}: {error.json_path}: {error.message[:200]}" for error in validator.iter_errors(json.load(file))]
        line = subprocess.run([program, path], check=True, capture_output=True, text=True).stdout.strip()
        if line != "yes":
            faults.append(f"{path}: the reader refuses it: {line}")
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "t.boxes"), "w", encoding="utf-8") as file:
            file.write("boxes 1\n0 0 0 1 1 1\n")
        with open(os.path.join(folder, "t.views"), "w", encoding="utf-8") as file:
            file.write("0 1.7 -120 0 0 1 0 1 0 60 1.5 0.1 10000\n")
        with open(os.path.join(folder, "i.json"), "w", encoding="utf-8") as file:
            json.dump(INCLUDED, file)
        documents = [FULL, BRUSHES, *changes(FULL), *changes(BRUSHES, VALUES[4:10])]
        lines = verdicts(program, folder, documents)
    taken = 0
    for number, (document, line) in enumerate(zip(documents, lines)):
        by_schema = next(validator.iter_errors(document), None)
        taken += line == "yes"
        if line == "yes" and by_schema:
            faults.append(f"change {number}: the reader takes what the schema refuses: {by_schema.json_path}: {by_schema.message[:160]}")
        if line != "yes" and not by_schema and not any(word in line for word in MEANING):
            faults.append(f"change {number}: the schema takes what the reader refuses: {line}")
    for line in lines[:2]:
        if line != "yes":
            faults.append(f"a scene with every key is refused: {line}")
    print(*faults[:40], sep="\n")
    print(f"{len(scenes)} scenes, {len(documents)} changes of which the reader takes {taken}, {len(faults)} faults")
    return 1 if faults or taken < 50 else 0


sys.exit(main())
