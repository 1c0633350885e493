"""Run by Blender with the add-on installed: what its own way to a base mesh leaves beside ours, and how long ours takes.

blender -b --factory-startup --python-exit-code 3 --python bench/blender.py -- ADDON.zip MODELS
"""

import pathlib
import sys
import time

import bpy
import numpy as np

archive, models = map(pathlib.Path, sys.argv[sys.argv.index("--") + 1 :])
bpy.ops.preferences.addon_install(filepath=str(archive))
bpy.ops.preferences.addon_enable(module="batten_addon")


def load(name):
    bpy.ops.object.select_all(action="SELECT")
    bpy.ops.object.delete()
    bpy.ops.wm.obj_import(filepath=str(models / name), forward_axis="Y", up_axis="Z")
    thing = bpy.context.selected_objects[0]
    bpy.context.view_layer.objects.active = thing
    return thing


def points(mesh):
    found = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.vertices.foreach_get("co", found)
    return found.reshape(-1, 3)


def missed(thing, before):
    modifier = next((m for m in thing.modifiers if m.type == "SUBSURF"), None) or thing.modifiers.new("", "SUBSURF")
    modifier.levels, modifier.quality, modifier.use_limit_surface = 1, 10, True
    shown = points(thing.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh())[: len(before)]
    return np.linalg.norm(shown - before, axis=1).max() / np.linalg.norm(np.ptp(before, axis=0))


print("greatest distance of the subdivision surface from the vertices, of the size:")
for name in ("creature.obj", "torus-knot.obj", "tripod.obj"):
    thing = load(name)
    before = points(thing.data)
    nothing = missed(thing, before)
    thing = load(name)
    modifier = thing.modifiers.new("Multires", "MULTIRES")
    for _ in range(2):
        bpy.ops.object.multires_subdivide(modifier=modifier.name, mode="SIMPLE")
    bpy.ops.object.multires_base_apply(modifier=modifier.name)
    thing.modifiers.clear()
    base = missed(thing, before)
    thing = load(name)
    bpy.ops.mesh.batten_through_vertices()
    print(f"  {name:16} as it is {nothing:.1e}   Multires, Apply Base {base:.1e}   Surface Through Vertices {missed(thing, before):.1e}")

bpy.ops.object.select_all(action="SELECT")
bpy.ops.object.delete()
bpy.ops.mesh.primitive_grid_add(x_subdivisions=710, y_subdivisions=710)
thing = bpy.context.active_object
at = points(thing.data).copy()
at[:, 2] = 0.1 * np.sin(9 * at[:, 0]) * np.cos(7 * at[:, 1])
thing.data.vertices.foreach_set("co", at.reshape(-1))
start = time.perf_counter()
bpy.ops.mesh.batten_through_vertices(levels=1)
print(f"{len(at):,} vertices: {time.perf_counter() - start:.2f} s; {bpy.context.scene.batten_result}")
