"""Run by Blender with the add-on enabled: the first picture of docs/blender.md.

blender -b --factory-startup --python-exit-code 3 --python picture.py -- MODELS OUT.png
"""

import pathlib
import sys

import bpy

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from scene import camera, empty_scene, imported, light, material, render

models, target = map(pathlib.Path, sys.argv[sys.argv.index("--") + 1 :])
empty_scene()
clay, ink = material("clay", (0.55, 0.28, 0.11)), material("ink", (0.01, 0.02, 0.06))


def place(x, through):
    thing = imported(models / "creature.obj")
    thing.location.x = x
    thing.rotation_euler.z = 0.7
    bpy.context.view_layer.update()
    thing.data.materials.append(clay)
    for face in thing.data.polygons:
        face.use_smooth = True
    wanted = [vertex.co.copy() for vertex in thing.data.vertices]
    if through:
        bpy.ops.mesh.batten_through_vertices(levels=3)
    else:
        modifier = thing.modifiers.new("", "SUBSURF")
        modifier.levels = modifier.render_levels = 3
    for i, at in enumerate(wanted):
        if i % 3 == 0:
            bpy.ops.mesh.primitive_uv_sphere_add(segments=10, ring_count=6, radius=0.06, location=thing.matrix_world @ at)
            bpy.context.active_object.data.materials.append(ink)


place(-3.4, False)
place(3.4, True)
bpy.ops.mesh.primitive_plane_add(size=4000, location=(0, 0, min(v.co.z for o in bpy.data.objects if o.name.startswith("creature") for v in o.data.vertices)))
bpy.context.active_object.data.materials.append(material("floor", (0.8, 0.8, 0.78)))
light()
camera((0.0, -25.0, 12.0), (-0.6, 0, 3.1)).data.lens = 52
render(target, 1000, 500, 128)
