"""Run by Blender with the add-on enabled: the picture of docs/blender.md.

blender -b --factory-startup --python-exit-code 3 --python picture.py -- MODELS OUT.png
"""

import pathlib
import sys

import bpy

models, target = map(pathlib.Path, sys.argv[sys.argv.index("--") + 1 :])
bpy.ops.preferences.addon_enable(module="batten_addon")
bpy.ops.object.select_all(action="SELECT")
bpy.ops.object.delete()


def material(name, color):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    shader = made.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*color, 1.0)
    shader.inputs["Roughness"].default_value = 0.45
    return made


clay, ink = material("clay", (0.55, 0.28, 0.11)), material("ink", (0.01, 0.02, 0.06))


def place(x, through):
    bpy.ops.wm.obj_import(filepath=str(models / "creature.obj"), forward_axis="Y", up_axis="Z")
    thing = bpy.context.selected_objects[0]
    bpy.context.view_layer.objects.active = thing
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
bpy.ops.object.light_add(type="SUN", rotation=(0.7, -0.5, 0.3))
bpy.context.active_object.data.energy = 2.5
bpy.context.active_object.data.angle = 0.4
world = bpy.context.scene.world or bpy.data.worlds.new("world")
bpy.context.scene.world = world
world.use_nodes = True
world.node_tree.nodes["Background"].inputs[0].default_value = (0.9, 0.92, 0.95, 1.0)
world.node_tree.nodes["Background"].inputs[1].default_value = 0.6
bpy.ops.object.empty_add(location=(-0.6, 0, 3.1))
middle = bpy.context.active_object
bpy.ops.object.camera_add(location=(0.0, -25.0, 12.0))
camera = bpy.context.active_object
camera.data.lens = 52
aim = camera.constraints.new("TRACK_TO")
aim.target = middle
scene = bpy.context.scene
scene.camera = camera
scene.render.engine = "CYCLES"
scene.cycles.samples = 128
scene.cycles.use_denoising = False
scene.view_settings.view_transform = "Standard"
scene.render.resolution_x, scene.render.resolution_y = 1000, 500
scene.render.filepath = str(target)
bpy.ops.render.render(write_still=True)
