"""What the pictures of docs/blender.md have in common: materials, light, and rendering. Imported inside Blender."""

import bpy


def empty_scene():
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


def imported(path):
    """A model, selected and active."""
    bpy.ops.wm.obj_import(filepath=str(path), forward_axis="Y", up_axis="Z")
    thing = bpy.context.selected_objects[0]
    bpy.context.view_layer.objects.active = thing
    return thing


def light():
    bpy.ops.object.light_add(type="SUN", rotation=(0.7, -0.5, 0.3))
    bpy.context.active_object.data.energy = 2.5
    bpy.context.active_object.data.angle = 0.4
    world = bpy.context.scene.world or bpy.data.worlds.new("world")
    bpy.context.scene.world = world
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs[0].default_value = (0.9, 0.92, 0.95, 1.0)
    world.node_tree.nodes["Background"].inputs[1].default_value = 0.6


def camera(location, looking_at):
    bpy.ops.object.empty_add(location=looking_at)
    middle = bpy.context.active_object
    bpy.ops.object.camera_add(location=location)
    made = bpy.context.active_object
    made.constraints.new("TRACK_TO").target = middle
    bpy.context.scene.camera = made
    return made


def render(target, width, height, samples):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples = samples
    scene.cycles.use_denoising = False
    scene.view_settings.view_transform = "Standard"
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.filepath = str(target)
    bpy.ops.render.render(write_still=True)
