"""Live: a second object is the surface through the vertices of the first, and follows while these are edited."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
from bpy.app.handlers import persistent

from . import exchange
from .exchange import Refused
from .library import Missing, batten

_SOURCE = "batten_source"  # on the following object: the one that it follows
_solvers: dict[str, tuple[Any, Any]] = {}  # by its name: the mesh that a solver was built for, and the solver
_busy = False


def followers(source: bpy.types.Object) -> list[bpy.types.Object]:
    return [thing for thing in bpy.data.objects if thing.type == "MESH" and thing.get(_SOURCE) == source]


def _same_faces(a: Any, b: Any) -> bool:
    return (
        np.array_equal(a.face_vertices, b.face_vertices)
        and np.array_equal(a.face_offsets, b.face_offsets)
        and (a.creases, a.corners) == (b.creases, b.corners)
    )


def follow(source: bpy.types.Object, follower: bpy.types.Object) -> float:
    """Makes the follower the surface through the source's vertices; returns the greatest distance from them."""
    if source.mode == "EDIT":
        source.update_from_editmode()
    mesh = exchange.mesh_of(source.data)
    boundary = exchange.boundary_word(exchange.subdivision_of(follower))
    known, solver = _solvers.get(source.name, (None, None))
    if known is None or not _same_faces(known, mesh):
        solver = batten().Interpolator(mesh, scheme="catmull-clark", boundary=boundary, on_singular="least-squares")
        _solvers[source.name] = (mesh, solver)
    solved = solver.solve(mesh.points)
    if len(follower.data.vertices) != mesh.vertex_count or not _same_faces(exchange.mesh_of(follower.data), mesh):
        exchange.replace_mesh(follower.data, solved.mesh)
    else:
        exchange.set_points(follower.data, solved.control)
    return float(solved.report.max_error)


@persistent
def _on_update(scene: bpy.types.Scene, graph: bpy.types.Depsgraph) -> None:
    global _busy
    if _busy:
        return
    changed = {update.id.original for update in graph.updates if update.is_updated_geometry}
    _busy = True
    try:
        for source in [thing for thing in bpy.data.objects if thing.type == "MESH"]:
            if source not in changed and source.data not in changed:
                continue
            for follower in followers(source):
                try:
                    scene.batten_result = f"Missed by at most {follow(source, follower):.2g}"
                except (Missing, Refused, ValueError) as error:
                    scene.batten_result = str(error)  # while faces are being drawn, say; the follower waits
    finally:
        _busy = False


class LiveSurface(bpy.types.Operator):
    """Make a second object that is the surface through this one's vertices, and follows while you edit it"""

    bl_idname = "mesh.batten_live"
    bl_label = "Live Surface"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        thing = context.active_object
        if thing is None or thing.type != "MESH" or context.mode not in {"OBJECT", "EDIT_MESH"} or _SOURCE in thing:
            cls.poll_message_set("Select the mesh whose vertices the surface shall pass through")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        source = context.active_object
        if followers(source):
            self.report({"ERROR"}, f"'{source.name}' has a live surface already; delete that object to end it")
            return {"CANCELLED"}
        mesh = bpy.data.meshes.new(source.name + " surface")
        follower = bpy.data.objects.new(source.name + " surface", mesh)
        follower.matrix_world = source.matrix_world
        follower[_SOURCE] = source
        follower.hide_select = True
        exchange.set_subdivision(follower, exchange.boundary_word(exchange.subdivision_of(source)), 2)
        try:
            error = follow(source, follower)
        except (Missing, Refused, ValueError) as problem:
            bpy.data.objects.remove(follower)
            bpy.data.meshes.remove(mesh)
            self.report({"ERROR"}, str(problem))
            return {"CANCELLED"}
        mesh.polygons.foreach_set("use_smooth", np.ones(len(mesh.polygons), dtype=bool))
        context.collection.objects.link(follower)
        source.display_type = "WIRE"
        context.scene.batten_result = f"'{follower.name}' follows, missed by at most {error:.2g}"
        self.report({"INFO"}, context.scene.batten_result)
        return {"FINISHED"}


def register() -> None:
    bpy.utils.register_class(LiveSurface)
    bpy.app.handlers.depsgraph_update_post.append(_on_update)


def unregister() -> None:
    bpy.app.handlers.depsgraph_update_post.remove(_on_update)
    bpy.utils.unregister_class(LiveSurface)
    _solvers.clear()
