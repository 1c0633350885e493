"""Run by Blender: installs the add-on and tries every operator.

blender -b --factory-startup --python-exit-code 3 --python addon_check.py -- ADDON.zip MODELS OUT
"""

import pathlib
import sys

import bpy
import numpy as np

archive, models, out = map(pathlib.Path, sys.argv[sys.argv.index("--") + 1 :])
checks = []


def check(body):
    checks.append(body)
    return body


def fresh(name="creature.obj"):
    """An empty scene with one model, selected."""
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    bpy.ops.wm.obj_import(filepath=str(models / name), forward_axis="Y", up_axis="Z")
    thing = bpy.context.selected_objects[0]
    bpy.context.view_layer.objects.active = thing
    return thing


def points(mesh):
    found = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.vertices.foreach_get("co", found)
    return found.reshape(-1, 3)


def shown(thing):
    """The vertices as the modifiers show them."""
    return points(thing.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh())


def size(at):
    return float(np.linalg.norm(np.ptp(at, axis=0)))


def refused(operator, **properties):
    """What an operator says when it refuses."""
    try:
        operator(**properties)
    except RuntimeError as error:
        return str(error)
    raise AssertionError(f"{operator} did not refuse")


@check
def the_surface_passes_through_the_vertices():
    for name in ("creature.obj", "torus-knot.obj", "pipe-joint.obj", "dodecahedron.obj"):
        thing = fresh(name)
        before = points(thing.data)
        assert bpy.ops.mesh.batten_through_vertices() == {"FINISHED"}
        assert not np.allclose(points(thing.data), before)
        miss = np.linalg.norm(shown(thing)[: len(before)] - before, axis=1).max() / size(before)
        print(f"{name}: Blender's surface misses by {miss:.2g} of the size")
        assert miss < 1e-6, name
        assert "misses its vertices" in bpy.context.scene.batten_result


@check
def creases_and_corners_are_kept():
    thing = fresh("cube.obj")
    thing.data.vertices[0].co.x -= 0.3
    for edge in list(thing.data.edges)[:4]:
        edge.crease = 1.0
    before = points(thing.data)
    bpy.ops.mesh.batten_through_vertices()
    miss = np.linalg.norm(shown(thing)[: len(before)] - before, axis=1).max() / size(before)
    assert miss < 1e-5, miss


@check
def changed_properties_start_from_the_same_vertices():
    """As the redo panel does: undo, then run again."""
    thing = fresh("pipe-joint.obj")
    before = points(thing.data)
    bpy.ops.ed.undo_push(message="start")
    bpy.ops.mesh.batten_through_vertices(boundary="edge-and-corner")
    once = points(thing.data)
    bpy.ops.ed.undo_push(message="through vertices")
    bpy.ops.ed.undo()
    thing = bpy.context.view_layer.objects.active
    assert np.array_equal(points(thing.data), before)
    bpy.ops.mesh.batten_through_vertices(boundary="edge-and-corner")
    assert np.array_equal(points(thing.data), once)


@check
def edit_mode_several_objects_and_loose_parts():
    first = fresh("creature.obj")
    second = first.copy()
    second.data = first.data.copy()
    bpy.context.collection.objects.link(second)
    second.select_set(True)
    first.data.vertices.add(2)  # loose, with an edge
    first.data.edges.add(1)
    first.data.edges[-1].vertices = (len(first.data.vertices) - 2, len(first.data.vertices) - 1)
    before = points(first.data)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.batten_through_vertices()
    assert bpy.context.mode == "EDIT_MESH"
    bpy.ops.object.mode_set(mode="OBJECT")
    assert np.array_equal(points(first.data)[-2:], before[-2:])
    assert np.allclose(points(first.data)[:-2], points(second.data))
    assert not np.allclose(points(second.data), before[:-2])


@check
def what_cannot_be_done_is_refused_by_name():
    thing = fresh()
    thing.shape_key_add(name="Basis")
    before = points(thing.data)
    assert "shape keys" in refused(bpy.ops.mesh.batten_through_vertices)
    assert np.array_equal(points(thing.data), before)
    thing = fresh("broken-tripod.obj")
    said = refused(bpy.ops.mesh.batten_through_vertices)
    assert "face" in said or "edge" in said or "vertex" in said, said
    assert bpy.ops.mesh.batten_repair() == {"FINISHED"}
    assert bpy.ops.mesh.batten_through_vertices() == {"FINISHED"}
    bpy.ops.object.select_all(action="DESELECT")
    bpy.context.view_layer.objects.active = None
    assert "Select a mesh" in refused(bpy.ops.mesh.batten_denoise)


@check
def a_live_surface_follows_edits():
    thing = fresh()
    assert bpy.ops.mesh.batten_live() == {"FINISHED"}
    follower = bpy.data.objects["creature surface"]
    miss = lambda: np.linalg.norm(shown(follower)[: len(thing.data.vertices)] - points(thing.data), axis=1).max()
    assert miss() < 1e-5
    thing.data.vertices[40].co.z += 0.3
    thing.data.update_tag()
    bpy.context.view_layer.update()
    assert miss() < 1e-5
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.transform.resize(value=(1.5, 1.0, 1.0))
    bpy.ops.object.mode_set(mode="OBJECT")
    assert miss() < 1e-5
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.subdivide()
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.view_layer.update()
    assert len(follower.data.vertices) == len(thing.data.vertices) > 2000 and miss() < 1e-5
    assert "already" in refused(bpy.ops.mesh.batten_live)
    bpy.data.objects.remove(thing)
    assert follower["batten_source"] is None  # and follows nothing else


@check
def detail():
    thing = fresh()
    before = points(thing.data)
    rng = np.random.default_rng(1)
    noisy = before + rng.normal(0.0, 0.02, before.shape).astype(np.float32)
    for operator, properties in (
        (bpy.ops.mesh.batten_denoise, {}),
        (bpy.ops.mesh.batten_denoise, {"automatic": False, "passes": 3}),
        (bpy.ops.mesh.batten_sharpen, {"amount": 0.5}),
        (bpy.ops.mesh.batten_bands, {"fine": 2.0}),
    ):
        thing.data.vertices.foreach_set("co", noisy.reshape(-1))
        assert operator(**properties) == {"FINISHED"}
        assert not np.allclose(points(thing.data), noisy)
    thing.data.vertices.foreach_set("co", noisy.reshape(-1))
    bpy.ops.mesh.batten_bands()
    assert np.abs(points(thing.data) - noisy).max() < 1e-5  # all ones change nothing


@check
def butterfly():
    thing = fresh("tetrahedron.obj")
    before = points(thing.data)
    bpy.ops.mesh.batten_butterfly(levels=2)
    assert len(thing.data.polygons) == 64 and np.array_equal(points(thing.data)[:4], before)


@check
def a_cage_is_fitted_to_an_object():
    cage = fresh()
    target = cage.copy()
    target.data = cage.data.copy()
    bpy.context.collection.objects.link(target)
    target.location = (3.0, 0.0, 0.0)
    cage.location = (3.0, 0.0, 0.0)
    modifier = target.modifiers.new("smooth", "SUBSURF")
    modifier.levels = 2
    rng = np.random.default_rng(2)
    moved = points(cage.data) + rng.normal(0.0, 0.05, (len(cage.data.vertices), 3)).astype(np.float32)
    cage.data.vertices.foreach_set("co", moved.reshape(-1))
    target.select_set(True)
    bpy.context.view_layer.update()
    bpy.context.view_layer.objects.active = cage
    goal = shown(target)
    faces = [tuple(face.vertices) for face in cage.data.polygons]
    assert bpy.ops.mesh.batten_fit() == {"FINISHED"}
    assert [tuple(face.vertices) for face in cage.data.polygons] == faces
    miss = np.linalg.norm(shown(cage)[:, None] - goal[None, ::5], axis=-1).min(axis=1).mean() / size(goal)
    print(f"a cage off by 0.05 is fitted to {miss:.2g} of the size, and says: {bpy.context.scene.batten_result}")
    assert miss < 0.02, miss


@check
def morphs_become_shape_keys():
    start = fresh("creature-ball.obj")
    bpy.ops.wm.obj_import(filepath=str(models / "creature.obj"), forward_axis="Y", up_axis="Z")
    end = bpy.context.selected_objects[0]
    start.select_set(True)
    bpy.context.view_layer.objects.active = start
    assert bpy.ops.mesh.batten_morph(steps=4) == {"FINISHED"}
    keys = start.data.shape_keys.key_blocks
    assert len(keys) == 5
    last = np.empty(3 * len(start.data.vertices), dtype=np.float32)
    keys[-1].data.foreach_get("co", last)
    assert np.abs(last.reshape(-1, 3) - points(end.data)).max() < 1e-5


@check
def curvature_becomes_a_colour():
    thing = fresh("sphere.obj")
    bpy.ops.mesh.batten_curvature(kind="gaussian")
    values = np.empty(len(thing.data.vertices), dtype=np.float32)
    thing.data.attributes["Gaussian Curvature"].data.foreach_get("value", values)
    assert (values > 0).all() and thing.data.color_attributes.active_color.name == "Gaussian Curvature Color"


@check
def files_keep_creases():
    thing = fresh("cube.obj")
    thing.data.edges[3].crease = 0.5
    path = out / "creased.obj"
    bpy.ops.export_mesh.batten(filepath=str(path))
    assert "t crease" in path.read_text()
    fresh("cube.obj")
    bpy.ops.import_mesh.batten(filepath=str(path))
    back = bpy.context.view_layer.objects.active
    assert sorted(round(edge.crease, 5) for edge in back.data.edges)[-1] == 0.5
    bpy.ops.import_mesh.batten(filepath=str(models / "bean.srep.json"))
    bean = bpy.context.view_layer.objects.active
    assert len(bean.data.vertices) > 20 and bean.modifiers[0].use_limit_surface
    assert "none.obj" in refused(bpy.ops.import_mesh.batten, filepath=str(out / "none.obj"))


assert bpy.ops.preferences.addon_install(filepath=str(archive)) == {"FINISHED"}
assert bpy.ops.preferences.addon_enable(module="batten_addon") == {"FINISHED"}
for body in checks:
    body()
    print(f"ok: {body.__name__.replace('_', ' ')}")
assert bpy.ops.preferences.addon_disable(module="batten_addon") == {"FINISHED"}
print(f"{len(checks)} checks of the add-on pass")
