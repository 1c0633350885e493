"""Run by Blender: imports control meshes as OBJ and checks where its own subdivision surface passes.

blender -b --factory-startup --python-exit-code 3 --python limit_check.py -- CONTROL.obj TARGETS.obj [CONTROL TARGETS ...]

For each pair the modifier's limit surface must pass through the points of TARGETS at the control mesh's vertices. Blender's
importer skips Batten's `t` lines, so the boundary rule and the creases are read here; add_creases() is what a user runs.
"""

import collections
import math
import sys

import bpy

# Of the diagonal. Blender keeps coordinates in floats, 6e-8 of the size each; the largest miss seen is 3e-7.
TOLERANCE = 1e-6
# At a dart, the end of a sharp crease, OpenSubdiv's patches only approach the limit: 3e-4 with quality 3, 5e-5 with 6,
# 5e-6 with 10.
DART_TOLERANCE = 1e-5


def obj_lines(path, keyword):
    with open(path) as text:
        return [line.split()[1:] for line in text if line.startswith(keyword + " ")]


def import_obj(path):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    # These axes leave the coordinates as they are.
    bpy.ops.wm.obj_import(filepath=path, forward_axis="Y", up_axis="Z")
    return bpy.context.selected_objects[0]


def crease_tags(path):
    """The sharpness of each edge and of each vertex."""
    creases = {}
    corners = {}
    for words in obj_lines(path, "t"):
        if words[0] == "crease":
            creases[frozenset(map(int, words[2:4]))] = float(words[4])
        if words[0] == "corner":
            corners[int(words[2])] = float(words[3])
    return creases, corners


def add_creases(thing, path):
    """Blender squares a crease and takes it ten times for the sharpness."""
    as_blender = lambda sharpness: math.sqrt(min(sharpness, 10.0) / 10.0)
    creases, corners = crease_tags(path)
    for edge in thing.data.edges:
        edge.crease = as_blender(creases.get(frozenset(edge.vertices), 0.0))
    if corners:
        bpy.context.view_layer.objects.active = thing
        bpy.ops.mesh.customdata_crease_vertex_add()
    for vertex, sharpness in corners.items():
        thing.data.vertex_creases[0].data[vertex].value = as_blender(sharpness)


def darts(path):
    """The vertices of exactly one edge that is sharp for ever."""
    ends = [vertex for edge, sharpness in crease_tags(path)[0].items() if sharpness >= 10 for vertex in edge]
    return {vertex for vertex, count in collections.Counter(ends).items() if count == 1}


def boundary_smooth(path):
    rules = [words[2] for words in obj_lines(path, "t") if words[0] == "interpolateboundary"]
    return {"1": "PRESERVE_CORNERS", "2": "ALL"}[rules[0]]


def add_subdivision(thing, path):
    modifier = thing.modifiers.new("subdivision", "SUBSURF")
    modifier.levels = 1
    modifier.quality = 10
    modifier.use_limit_surface = True
    modifier.use_creases = True
    modifier.boundary_smooth = boundary_smooth(path)


def evaluated_points(thing):
    mesh = thing.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    return [tuple(vertex.co) for vertex in mesh.vertices]


def largest_misses(control, targets):
    expected = [tuple(float(word) for word in words[:3]) for words in obj_lines(targets, "v")]
    diagonal = math.dist([min(axis) for axis in zip(*expected)], [max(axis) for axis in zip(*expected)])
    thing = import_obj(control)
    assert len(thing.data.vertices) == len(expected), "the importer changed the number of vertices"
    before = max(map(math.dist, evaluated_points(thing), expected))
    add_creases(thing, control)
    add_subdivision(thing, control)
    points = evaluated_points(thing)
    assert len(points) > len(expected), "the modifier did not subdivide"
    # The modifier's first vertices are the control mesh's.
    misses = [math.dist(points[i], target) / diagonal for i, target in enumerate(expected)]
    at_darts = darts(control)
    smooth = max(miss for i, miss in enumerate(misses) if i not in at_darts)
    dart = max([misses[i] for i in at_darts], default=0.0)
    return smooth, dart, before / diagonal


arguments = sys.argv[sys.argv.index("--") + 1 :]
for control, targets in zip(arguments[::2], arguments[1::2]):
    miss, dart_miss, before = largest_misses(control, targets)
    print(f"{control}: Blender's limit surface misses by {miss:.2g} of the diagonal, at darts by {dart_miss:.2g}")
    assert before > 1e-3, "the control mesh is its own surface; this model shows nothing"
    assert miss < TOLERANCE, f"{control}: more than {TOLERANCE:g}"
    assert dart_miss < DART_TOLERANCE, f"{control}: more than {DART_TOLERANCE:g} at a dart"
