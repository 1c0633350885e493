"""Run by Blender with the add-on enabled: each operator before and after, in one picture of docs/blender.md.

blender -b --factory-startup --python-exit-code 3 --python operators_picture.py -- MODELS OUT.png
"""

import pathlib
import sys

import bpy
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from scene import camera, empty_scene, imported, light, material, render

models, target = map(pathlib.Path, sys.argv[sys.argv.index("--") + 1 :])
empty_scene()
clay, paint, ink = material("clay", (0.55, 0.28, 0.11)), material("paint", (1.0, 1.0, 1.0)), material("ink", (0.02, 0.02, 0.03))
colors = paint.node_tree.nodes.new("ShaderNodeVertexColor")
paint.node_tree.links.new(colors.outputs["Color"], paint.node_tree.nodes["Principled BSDF"].inputs["Base Color"])

SIZE, STEP, COLUMNS = 3.4, 3.2, 4


def model(name, smooth=True):
    """One of our models, in a unit box; its vertices are moved, so that operators see what is shown."""
    thing = imported(models / f"{name}.obj")
    at = np.array([vertex.co for vertex in thing.data.vertices])
    low, high = at.min(axis=0), at.max(axis=0)
    at = (at - (low + high) / 2) * (SIZE / np.linalg.norm(high - low))
    thing.data.vertices.foreach_set("co", at.astype(np.float32).ravel())
    for face in thing.data.polygons:
        face.use_smooth = smooth
    thing.data.update()
    return thing


def noisy(name, amount):
    thing = model(name)
    at = np.array([vertex.co for vertex in thing.data.vertices])
    at += np.random.default_rng(1).normal(scale=amount, size=at.shape)
    thing.data.vertices.foreach_set("co", at.astype(np.float32).ravel())
    return thing


def fine(name, levels):
    """Its subdivision surface as a mesh."""
    thing = model(name)
    thing.modifiers.new("", "SUBSURF").levels = levels
    bpy.ops.object.modifier_apply(modifier=thing.modifiers[0].name)
    return thing


def select(*things):
    bpy.ops.object.select_all(action="DESELECT")
    for thing in things:
        thing.select_set(True)
    bpy.context.view_layer.objects.active = things[0]


def put(thing, place, turn=0.7, paints=clay):
    """The thing stands in a cell of the picture; what it is stays."""
    row, column = divmod(place, COLUMNS)
    thing.data.materials.clear()
    thing.data.materials.append(paints)
    thing.rotation_euler = (0, 0, turn)
    thing.location = (STEP * column, 0, -STEP * row)


def label(text, place):
    row, column = divmod(place, COLUMNS)
    bpy.ops.object.text_add(location=(STEP * (column + 0.5), -2.0, -STEP * row - 0.5 * STEP), rotation=(np.pi / 2, 0, 0))
    words = bpy.context.active_object
    words.data.body, words.data.size, words.data.align_x = text, 0.36, "CENTER"
    words.data.materials.append(ink)


def pair(text, place, make, change, turn=0.7, paints=clay):
    put(make(), place, turn)
    thing = make()
    select(thing)
    thing = change(thing) or thing
    put(thing, place + 1, turn, paints)
    label(text, place)


def blurred():
    """A cage that has lost its detail, with the modifier that shows its surface."""
    cage = model("creature")
    select(cage)
    bpy.ops.mesh.batten_bands(fine=0.0, middle=0.0, coarse=0.0)
    subdivision = cage.modifiers.new("", "SUBSURF")
    subdivision.levels = subdivision.render_levels = 2
    return cage


def fitted(cage):
    """To the model in full detail, which is taken away again."""
    shape = fine("creature", 3)
    select(cage, shape)
    bpy.ops.mesh.batten_fit()
    bpy.data.objects.remove(shape)


def smooth(thing):
    bpy.ops.mesh.batten_butterfly(levels=3)
    for face in thing.data.polygons:
        face.use_smooth = True


def morphed(thing):
    other = model("creature-ball")
    select(thing, other)
    bpy.ops.mesh.batten_morph(steps=4)
    bpy.data.objects.remove(other)
    keys = thing.data.shape_keys.key_blocks
    keys[len(keys) // 2].value = 1.0


def holed():
    return model("broken-tripod", smooth=False)


pair("Denoise", 0, lambda: noisy("bracket-scan", 0.006), lambda _: bpy.ops.mesh.batten_denoise(features=True) and None)
pair("Sharpen", 2, lambda: model("creature"), lambda _: bpy.ops.mesh.batten_sharpen(amount=1.0) and None)
pair("Bands: shape alone", 4, lambda: fine("creature", 1), lambda _: bpy.ops.mesh.batten_bands(fine=0.0, middle=0.0, coarse=0.0) and None)
pair("Modified Butterfly", 6, lambda: model("icosahedron", smooth=False), smooth)
pair("Fit to Objects", 8, blurred, fitted)
pair("Morph to Shape Keys", 10, lambda: model("creature"), morphed)
pair("Limit Curvature", 12, lambda: fine("creature", 1), lambda _: bpy.ops.mesh.batten_curvature() and None, paints=paint)
pair("Repair", 14, holed, lambda _: bpy.ops.mesh.batten_repair(weld=0.001) and None)
light()
view = camera((STEP * 1.5, -60.0, -STEP * 1.6 + 12.0), (STEP * 1.5, 0, -STEP * 1.6))
view.data.type = "ORTHO"
view.data.ortho_scale = STEP * COLUMNS
bpy.context.scene.world.node_tree.nodes["Background"].inputs[1].default_value = 0.9
render(target, 800, 800, 256)
