"""Blender's meshes as Batten's, and back. Numbers move in whole arrays; Blender keeps them in floats."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np

from .library import batten


class Refused(RuntimeError):
    """What an operator does not do, said to the user."""


def require_editable(thing: bpy.types.Object) -> None:
    """Raises Refused where the points cannot simply be moved."""
    if thing.data.library is not None or thing.data.override_library is not None:
        raise Refused(f"'{thing.name}' is linked from another file; make it local first")
    if thing.data.shape_keys is not None:
        raise Refused(f"'{thing.name}' has shape keys, which would keep the old shape; remove or apply them first")


def points_of(mesh: bpy.types.Mesh) -> np.ndarray:
    points = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.vertices.foreach_get("co", points)
    return points.reshape(-1, 3).astype(np.float64)


def set_points(mesh: bpy.types.Mesh, points: np.ndarray) -> None:
    mesh.vertices.foreach_set("co", np.ascontiguousarray(points, dtype=np.float32).reshape(-1))
    mesh.update()


def _edge_creases(mesh: bpy.types.Mesh) -> np.ndarray:
    """A crease c is the sharpness 10 c^2."""
    values = np.zeros(len(mesh.edges), dtype=np.float32)
    if "crease_edge" in mesh.attributes:  # Blender 4
        mesh.attributes["crease_edge"].data.foreach_get("value", values)
    elif bpy.app.version < (4, 0, 0):
        mesh.edges.foreach_get("crease", values)
    return values


def _vertex_creases(mesh: bpy.types.Mesh) -> np.ndarray:
    values = np.zeros(len(mesh.vertices), dtype=np.float32)
    if "crease_vert" in mesh.attributes:  # Blender 4
        mesh.attributes["crease_vert"].data.foreach_get("value", values)
    elif bpy.app.version < (4, 0, 0) and mesh.vertex_creases:
        mesh.vertex_creases[0].data.foreach_get("value", values)
    return values


def set_edge_creases(mesh: bpy.types.Mesh, sharpness: dict[tuple[int, int], float]) -> None:
    """Sharpness of edges by their vertices, the lower first."""
    values = np.zeros(len(mesh.edges), dtype=np.float32)
    ends = np.empty(2 * len(mesh.edges), dtype=np.int32)
    mesh.edges.foreach_get("vertices", ends)
    for i, (a, b) in enumerate(np.sort(ends.reshape(-1, 2), axis=1).tolist()):
        values[i] = np.sqrt(min(sharpness.get((a, b), 0.0), 10.0) / 10.0)
    if bpy.app.version >= (4, 0, 0):
        attribute = mesh.attributes.get("crease_edge") or mesh.attributes.new("crease_edge", "FLOAT", "EDGE")
        attribute.data.foreach_set("value", values)
    else:
        mesh.edges.foreach_set("crease", values)


def mesh_of(mesh: bpy.types.Mesh, points: np.ndarray | None = None) -> Any:
    """A batten.Mesh with creases and corners. Edges and vertices without faces have no surface and are left out."""
    offsets = np.zeros(len(mesh.polygons) + 1, dtype=np.int32)
    starts = np.empty(len(mesh.polygons), dtype=np.int32)
    sizes = np.empty(len(mesh.polygons), dtype=np.int32)
    mesh.polygons.foreach_get("loop_start", starts)
    mesh.polygons.foreach_get("loop_total", sizes)
    vertices = np.empty(len(mesh.loops), dtype=np.int32)
    mesh.loops.foreach_get("vertex_index", vertices)
    np.cumsum(sizes, out=offsets[1:])
    if not np.array_equal(starts, offsets[:-1]):  # faces in another order than their corners
        corners = np.repeat(starts - offsets[:-1], sizes) + np.arange(offsets[-1], dtype=np.int32)
        vertices = vertices[corners]
    used = np.zeros(len(mesh.vertices), dtype=bool)
    used[vertices] = True
    creases = []
    edges = _edge_creases(mesh)
    if edges.any():
        ends = np.empty(2 * len(mesh.edges), dtype=np.int32)
        mesh.edges.foreach_get("vertices", ends)
        ends = ends.reshape(-1, 2)
        in_faces = {
            tuple(sorted((int(vertices[i]), int(vertices[i + 1 if i + 1 < end else begin]))))
            for begin, end in zip(offsets[:-1], offsets[1:])
            for i in range(begin, end)
        }
        for e in np.flatnonzero(edges):
            a, b = sorted(map(int, ends[e]))
            if (a, b) in in_faces:
                creases.append((a, b, 10.0 * float(edges[e]) ** 2))
    corners_at = _vertex_creases(mesh)
    corners = [(int(v), 10.0 * float(corners_at[v]) ** 2) for v in np.flatnonzero(corners_at) if used[v]]
    given = points_of(mesh) if points is None else points
    return batten().Mesh(given, (offsets, vertices), creases=creases, corners=corners)


def replace_mesh(mesh: bpy.types.Mesh, made: Any) -> None:
    """Puts a batten.Mesh in the place of all that a mesh has."""
    mesh.clear_geometry()
    mesh.vertices.add(made.vertex_count)
    mesh.loops.add(len(made.face_vertices))
    mesh.polygons.add(made.face_count)
    mesh.vertices.foreach_set("co", made.points.astype(np.float32).reshape(-1))
    mesh.loops.foreach_set("vertex_index", made.face_vertices)
    mesh.polygons.foreach_set("loop_start", made.face_offsets[:-1])
    if bpy.app.version < (4, 0, 0):
        mesh.polygons.foreach_set("loop_total", np.diff(made.face_offsets).astype(np.int32))
    mesh.update(calc_edges=True)
    mesh.validate()
    if made.creases:
        set_edge_creases(mesh, {(min(a, b), max(a, b)): s for a, b, s in made.creases})


def boundary_word(modifier: bpy.types.Modifier | None) -> str:
    """The boundary rule that a subdivision modifier says."""
    keeps = modifier is not None and modifier.boundary_smooth == "PRESERVE_CORNERS"
    return "edge-and-corner" if keeps else "edge-only"


def subdivision_of(thing: bpy.types.Object) -> bpy.types.Modifier | None:
    """The last subdivision modifier."""
    found = [modifier for modifier in thing.modifiers if modifier.type == "SUBSURF"]
    return found[-1] if found else None


def set_subdivision(thing: bpy.types.Object, boundary: str, levels: int) -> None:
    """Adds a subdivision modifier, or sets the last one, so that it shows the exact surface."""
    modifier = subdivision_of(thing) or thing.modifiers.new("Batten", "SUBSURF")
    modifier.subdivision_type = "CATMULL_CLARK"
    modifier.levels = max(modifier.levels, levels)
    modifier.render_levels = max(modifier.render_levels, levels)
    modifier.quality = 10
    modifier.use_limit_surface = True
    modifier.use_creases = True
    modifier.boundary_smooth = "PRESERVE_CORNERS" if boundary == "edge-and-corner" else "ALL"
