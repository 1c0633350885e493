"""The operators. Each reads all its meshes, computes without touching Blender, and writes when all is well."""

from __future__ import annotations

import threading
from typing import Any, Callable

import bpy
import numpy as np
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty

from . import exchange
from .exchange import Refused
from .library import Missing, batten

Progress = Callable[[float], object]
Job = Callable[[Progress], Any]

_BOUNDARIES = [
    ("edge-only", "Smooth", "Open edges are smooth curves, at corners too: the modifier's 'All'"),
    ("edge-and-corner", "Keep Corners", "Vertices of a single face keep their place: the modifier's 'Keep Corners'"),
]


def selected_meshes(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The selected mesh objects, each mesh once; else the active one."""
    things = [thing for thing in context.selected_objects if thing.type == "MESH"]
    if not things and context.active_object is not None and context.active_object.type == "MESH":
        things = [context.active_object]
    return list({thing.data.name_full: thing for thing in things}.values())


class BattenOperator(bpy.types.Operator):
    """What all have in common: jobs in a thread where they are long, ESC, one line of result."""

    bl_options = {"REGISTER", "UNDO"}
    LONG = 50_000  # vertices

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if context.mode not in {"OBJECT", "EDIT_MESH"} or not selected_meshes(context):
            cls.poll_message_set("Select a mesh, in object or edit mode")
            return False
        return True

    def prepare(self, context: bpy.types.Context) -> list[Job]:
        """Reads Blender's data; the jobs do not."""
        raise NotImplementedError

    def apply(self, context: bpy.types.Context, results: list[Any]) -> str:
        """Writes the results, and says what was done in one line."""
        raise NotImplementedError

    def execute(self, context: bpy.types.Context) -> set[str]:
        return self._guarded(context, lambda: self._finish(context, [job(lambda done: None) for job in self._start(context)]))

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        vertices = sum(len(thing.data.vertices) for thing in selected_meshes(context))
        if bpy.app.background or vertices < self.LONG:
            return self.execute(context)
        return self._guarded(context, lambda: self._launch(context))

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type == "ESC":
            self._cancelled = True
        if event.type != "TIMER":
            return {"RUNNING_MODAL"}
        context.workspace.status_text_set(f"{self.bl_label}: {100 * self._done:.0f} %   ESC: cancel")
        if self._thread.is_alive():
            return {"RUNNING_MODAL"}
        context.window_manager.event_timer_remove(self._timer)
        context.workspace.status_text_set(None)
        if self._cancelled:
            self._back(context)
            return {"CANCELLED"}

        def finish() -> set[str]:
            if self._failure is not None:
                raise self._failure
            return self._finish(context, self._results)

        return self._guarded(context, finish)

    def _start(self, context: bpy.types.Context) -> list[Job]:
        self._was_editing = context.mode == "EDIT_MESH"
        if self._was_editing:
            bpy.ops.object.mode_set(mode="OBJECT")
        return self.prepare(context)

    def _back(self, context: bpy.types.Context) -> None:
        if getattr(self, "_was_editing", False):
            bpy.ops.object.mode_set(mode="EDIT")

    def _finish(self, context: bpy.types.Context, results: list[Any]) -> set[str]:
        said = self.apply(context, results)
        self._back(context)
        context.scene.batten_result = said
        self.report({"INFO"}, said)
        return {"FINISHED"}

    def _launch(self, context: bpy.types.Context) -> set[str]:
        jobs = self._start(context)
        self._done, self._cancelled = 0.0, False
        self._failure: Exception | None = None
        self._results: list[Any] = []

        def work() -> None:
            try:
                for i, job in enumerate(jobs):

                    def watch(done: float, i: int = i) -> bool:
                        self._done = (i + done) / len(jobs)
                        return not self._cancelled

                    self._results.append(job(watch))
            except Exception as error:  # raised again by the main thread
                self._failure = error

        self._thread = threading.Thread(target=work)
        self._thread.start()
        self._timer = context.window_manager.event_timer_add(0.1, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def _guarded(self, context: bpy.types.Context, body: Callable[[], set[str]]) -> set[str]:
        try:
            return body()
        except Missing as error:
            self.report({"ERROR"}, str(error))
        except Refused as error:
            self.report({"ERROR"}, str(error))
        except batten().Error as error:
            self.report({"ERROR"}, str(error))
        self._back(context)
        return {"CANCELLED"}


def _unit(context: bpy.types.Context, length: float) -> str:
    """A length as the scene's unit has it."""
    settings = context.scene.unit_settings
    meters = length * settings.scale_length
    if settings.system == "NONE" or meters < 1e-6:  # to_string() would say 0
        return f"{length:.2g}" + ("" if settings.system == "NONE" else f" ({meters:.2g} m)")
    return bpy.utils.units.to_string(settings.system, "LENGTH", meters, precision=6)


class SurfaceThroughVertices(BattenOperator):
    """Move the vertices so that the subdivision surface passes through where they are now"""

    bl_idname = "mesh.batten_through_vertices"
    bl_label = "Surface Through Vertices"

    boundary: EnumProperty(name="Boundary", items=_BOUNDARIES, default="edge-only")
    levels: IntProperty(name="Levels", description="Viewport levels of the modifier", default=2, min=1, max=6)

    def prepare(self, context: bpy.types.Context) -> list[Job]:
        self._things = selected_meshes(context)
        jobs: list[Job] = []
        for thing in self._things:
            exchange.require_editable(thing)
            if not thing.data.polygons:
                raise Refused(f"'{thing.name}' has no faces")
            mesh = exchange.mesh_of(thing.data)
            jobs.append(lambda progress, mesh=mesh: self._solve(mesh, progress))
        return jobs

    def _solve(self, mesh: Any, progress: Progress) -> tuple[np.ndarray, float, int]:
        solver = batten().Interpolator(mesh, scheme="catmull-clark", boundary=self.boundary, on_singular="least-squares")
        control = solver.solve(mesh.points, progress=progress).control.astype(np.float32).astype(np.float64)
        reached = batten().limit_positions(mesh, control, scheme="catmull-clark", boundary=self.boundary)
        missed = np.linalg.norm(reached - mesh.points, axis=1)
        worst = int(missed.argmax())
        return control, float(missed[worst]), worst

    def apply(self, context: bpy.types.Context, results: list[Any]) -> str:
        for thing, (control, _, _) in zip(self._things, results):
            exchange.set_points(thing.data, control)
            exchange.set_subdivision(thing, self.boundary, self.levels)
        _, error, vertex = max(results, key=lambda result: result[1])
        return f"The surface misses its vertices by at most {_unit(context, error)}, at vertex {vertex}"


class MeshesOperator(BattenOperator):
    """Operators that make another mesh of each selected one."""

    def prepare(self, context: bpy.types.Context) -> list[Job]:
        self._things = selected_meshes(context)
        jobs: list[Job] = []
        for thing in self._things:
            exchange.require_editable(thing)
            mesh = exchange.mesh_of(thing.data)
            jobs.append(lambda progress, mesh=mesh: self.made(mesh, progress))
        return jobs

    def made(self, mesh: Any, progress: Progress) -> tuple[Any, str]:
        """The other mesh, and what to say."""
        raise NotImplementedError

    def put(self, mesh: bpy.types.Mesh, made: Any) -> None:
        """Puts it in the place of the one that was there."""
        exchange.replace_mesh(mesh, made)

    def apply(self, context: bpy.types.Context, results: list[Any]) -> str:
        for thing, (mesh, _) in zip(self._things, results):
            self.put(thing.data, mesh)
        return results[-1][1]


class PointsOperator(MeshesOperator):
    """Operators that only move the vertices, and may find creases."""

    def put(self, mesh: bpy.types.Mesh, made: Any) -> None:
        exchange.set_points(mesh, made.points)
        if made.creases:
            exchange.set_edge_creases(mesh, {(min(a, b), max(a, b)): s for a, b, s in made.creases})


class Denoise(PointsOperator):
    """Smooth noise away and leave the shape"""

    bl_idname = "mesh.batten_denoise"
    bl_label = "Denoise"

    automatic: BoolProperty(name="Measure the Noise", description="As strongly as the noise asks for", default=True)
    passes: IntProperty(name="Passes", default=4, min=0, max=1000)
    features: BoolProperty(name="Keep Sharp Edges", description="Find them, and tag them as creases", default=False)
    degrees: FloatProperty(name="Sharper Than", description="Degrees", default=40.0, min=1.0, max=179.0)

    def made(self, mesh: Any, progress: Progress) -> tuple[Any, str]:
        result = batten().denoise(
            mesh,
            passes=None if self.automatic else self.passes,
            features=self.degrees if self.features else None,
            scheme="catmull-clark",
            progress=progress,
        )
        report = result.report
        return result.mesh, f"Noise of {report.noise:.3g} along the normals; vertices moved by {report.moved:.3g}"


class Sharpen(PointsOperator):
    """Make detail stronger"""

    bl_idname = "mesh.batten_sharpen"
    bl_label = "Sharpen"

    amount: FloatProperty(name="Amount", default=1.0, min=0.0, soft_max=3.0)

    def made(self, mesh: Any, progress: Progress) -> tuple[Any, str]:
        result = batten().sharpen(mesh, amount=self.amount, scheme="catmull-clark", progress=progress)
        return result.mesh, f"Vertices moved by {result.report.moved:.3g}"


class Bands(PointsOperator):
    """Mix bands of detail anew, from the finest to the overall shape"""

    bl_idname = "mesh.batten_bands"
    bl_label = "Bands"

    fine: FloatProperty(name="Finest", default=1.0, min=0.0, soft_max=3.0)
    middle: FloatProperty(name="Middle", default=1.0, min=0.0, soft_max=3.0)
    coarse: FloatProperty(name="Coarse", default=1.0, min=0.0, soft_max=3.0)
    shape: FloatProperty(name="Shape", default=1.0, min=0.0, soft_max=3.0)

    def made(self, mesh: Any, progress: Progress) -> tuple[Any, str]:
        gains = [self.fine, self.middle, self.coarse, self.shape]
        result = batten().bands(mesh, gains, scheme="catmull-clark", progress=progress)
        moved = float(np.sqrt(np.mean(np.sum((result.mesh.points - mesh.points) ** 2, axis=1))))
        return result.mesh, f"Vertices moved by {moved:.3g}"


class ModifiedButterfly(MeshesOperator):
    """Refine triangles by the Modified Butterfly scheme: smooth, and every vertex stays where it is"""

    bl_idname = "mesh.batten_butterfly"
    bl_label = "Modified Butterfly"

    levels: IntProperty(name="Levels", default=1, min=1, max=6)

    def made(self, mesh: Any, progress: Progress) -> tuple[Any, str]:
        triangles = batten().triangulate(mesh)
        fine = batten().subdivide(triangles, self.levels, scheme="modified-butterfly", progress=progress)
        return fine, f"{fine.vertex_count:,} vertices; the first {mesh.vertex_count:,} stay where they were"


class Repair(MeshesOperator):
    """Repair a mesh that has no surface, and list what was changed"""

    bl_idname = "mesh.batten_repair"
    bl_label = "Repair"

    weld: FloatProperty(name="Weld", description="Join open edges so near, of the size", default=0.0, min=0.0, max=0.1, precision=5)

    def made(self, mesh: Any, progress: Progress) -> tuple[Any, str]:
        result = batten().repair(mesh, weld=self.weld, progress=progress)
        return result.mesh, "; ".join(change.text for change in result.changes) or "Nothing to repair"


class FitToObjects(BattenOperator):
    """Fit the active cage to the other selected objects: its surface hugs them, its faces stay as they are"""

    bl_idname = "mesh.batten_fit"
    bl_label = "Fit to Objects"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        cage = context.active_object
        others = [thing for thing in context.selected_objects if thing is not cage and thing.type == "MESH"]
        if context.mode != "OBJECT" or cage is None or cage.type != "MESH" or not others:
            cls.poll_message_set("Select what to fit to, then the cage, in object mode")
            return False
        return True

    def prepare(self, context: bpy.types.Context) -> list[Job]:
        self._cage = context.active_object
        exchange.require_editable(self._cage)
        graph = context.evaluated_depsgraph_get()
        into = np.array(self._cage.matrix_world.inverted())
        points, normals = [], []
        for thing in context.selected_objects:
            if thing is self._cage or thing.type != "MESH":
                continue
            evaluated = thing.evaluated_get(graph)
            mesh = evaluated.to_mesh()
            at = exchange.points_of(mesh)
            up = np.empty(3 * len(mesh.vertices), dtype=np.float32)
            mesh.vertices.foreach_get("normal", up)
            matrix = into @ np.array(thing.matrix_world)
            points.append(at @ matrix[:3, :3].T + matrix[:3, 3])
            turned = up.reshape(-1, 3).astype(float) @ np.linalg.inv(matrix[:3, :3])
            normals.append(turned / np.maximum(np.linalg.norm(turned, axis=1, keepdims=True), 1e-300))
            evaluated.to_mesh_clear()
        cage = exchange.mesh_of(self._cage.data)
        cage._scheme = "catmull-clark"
        cloud, up_there = np.concatenate(points), np.concatenate(normals)
        return [lambda progress: batten().fit(cloud, normals=up_there, init=cage, progress=progress)]

    def apply(self, context: bpy.types.Context, results: list[Any]) -> str:
        fit = results[0]
        exchange.set_points(self._cage.data, fit.mesh.points)
        exchange.set_subdivision(self._cage, "edge-only", 2)
        worst, rms = fit.report.to_surface.max, fit.report.to_surface.rms
        return f"Points are off by {_unit(context, rms)}, at most {_unit(context, worst)}"


class MorphToShapeKeys(BattenOperator):
    """Turn the active mesh into the other selected one of the same faces, as shape keys: shape first, then detail"""

    bl_idname = "mesh.batten_morph"
    bl_label = "Morph to Shape Keys"

    steps: IntProperty(name="Shape Keys", default=8, min=1, max=100)
    low_first: BoolProperty(name="Shape First", default=True)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        others = [t for t in context.selected_objects if t is not context.active_object and t.type == "MESH"]
        if context.mode != "OBJECT" or context.active_object is None or len(others) != 1:
            cls.poll_message_set("Select the mesh to morph into, then the one to start from, in object mode")
            return False
        return True

    def prepare(self, context: bpy.types.Context) -> list[Job]:
        self._thing = context.active_object
        exchange.require_editable(self._thing)
        other = next(t for t in context.selected_objects if t is not self._thing and t.type == "MESH")
        start, end = exchange.mesh_of(self._thing.data), exchange.mesh_of(other.data)
        times = np.linspace(0.0, 1.0, self.steps + 1)[1:]
        low_first = self.low_first
        return [
            lambda progress: batten().morph(
                start, end, times, low_first=low_first, scheme="catmull-clark", progress=progress
            )
        ]

    def apply(self, context: bpy.types.Context, results: list[Any]) -> str:
        self._thing.shape_key_add(name="Basis", from_mix=False)
        for i, mesh in enumerate(results[0], start=1):
            key = self._thing.shape_key_add(name=f"Morph {i}", from_mix=False)
            key.data.foreach_set("co", mesh.points.astype(np.float32).reshape(-1))
        return f"{len(results[0])} shape keys from '{self._thing.name}'"


class LimitCurvature(BattenOperator):
    """Colour the vertices by the curvature of the subdivision surface"""

    bl_idname = "mesh.batten_curvature"
    bl_label = "Limit Curvature"

    kind: EnumProperty(
        name="Curvature",
        items=[("mean", "Mean", "The mean of both curvatures"), ("gaussian", "Gaussian", "Their product")],
        default="mean",
    )

    def prepare(self, context: bpy.types.Context) -> list[Job]:
        self._things = selected_meshes(context)
        kind = self.kind
        jobs: list[Job] = []
        for thing in self._things:
            if thing.data.library is not None:
                raise Refused(f"'{thing.name}' is linked from another file; make it local first")
            mesh = exchange.mesh_of(thing.data)
            boundary = exchange.boundary_word(exchange.subdivision_of(thing))
            jobs.append(lambda progress, mesh=mesh, boundary=boundary: _curvature(mesh, boundary, kind, progress))
        return jobs

    def apply(self, context: bpy.types.Context, results: list[Any]) -> str:
        for thing, values in zip(self._things, results):
            name = f"{self.kind.capitalize()} Curvature"
            mesh = thing.data
            number = mesh.attributes.get(name) or mesh.attributes.new(name, "FLOAT", "POINT")
            number.data.foreach_set("value", values.astype(np.float32))
            drawn = mesh.color_attributes.get(name + " Color") or mesh.color_attributes.new(
                name + " Color", "FLOAT_COLOR", "POINT"
            )
            drawn.data.foreach_set("color", _cool_warm(values).astype(np.float32).reshape(-1))
            mesh.color_attributes.active_color = drawn
        values = np.concatenate(results)
        return f"{self.kind.capitalize()} curvature from {values.min():.3g} to {values.max():.3g}"


def _curvature(mesh: Any, boundary: str, kind: str, progress: Progress) -> np.ndarray:
    """At each vertex, the mean over its corners of the curvature just inside the face: at irregular vertices it has no
    limit."""
    surface = batten().LimitSurface(mesh, scheme="catmull-clark", boundary=boundary, progress=progress)
    corner = mesh.face_vertices
    sizes = np.diff(mesh.face_offsets)
    inside = 0.02
    if (sizes == 4).all():
        face = np.repeat(np.arange(mesh.face_count, dtype=np.int32), 4)
        low, high = inside, 1.0 - inside
        uv = np.tile([[low, low], [high, low], [high, high], [low, high]], (mesh.face_count, 1))
    else:  # the quad at each corner of the first refinement
        face = np.arange(len(corner), dtype=np.int32)
        uv = np.full((len(corner), 2), inside)
    values = getattr(surface.curvature(face, uv), kind)
    sums = np.bincount(corner, weights=np.nan_to_num(values), minlength=mesh.vertex_count)
    return sums / np.maximum(np.bincount(corner, minlength=mesh.vertex_count), 1)


def _cool_warm(values: np.ndarray) -> np.ndarray:
    """Blue below zero, grey at it, red above; a twentieth of the numbers lies beyond the ends."""
    most = max(float(np.quantile(np.abs(values), 0.95)), 1e-300)
    share = np.clip(values / most, -1.0, 1.0)[:, None]
    cool, grey, warm = np.array([0.04, 0.07, 0.52]), np.array([0.72, 0.72, 0.72]), np.array([0.46, 0.0, 0.02])
    color = np.where(share < 0.0, grey + (cool - grey) * -share, grey + (warm - grey) * share)
    return np.concatenate([color, np.ones((len(values), 1))], axis=1)


OPERATORS = (
    SurfaceThroughVertices,
    FitToObjects,
    Denoise,
    Sharpen,
    Bands,
    ModifiedButterfly,
    MorphToShapeKeys,
    LimitCurvature,
    Repair,
)


def register() -> None:
    bpy.types.Scene.batten_result = bpy.props.StringProperty(name="Result", options={"SKIP_SAVE"})
    for operator in OPERATORS:
        bpy.utils.register_class(operator)


def unregister() -> None:
    for operator in reversed(OPERATORS):
        bpy.utils.unregister_class(operator)
    del bpy.types.Scene.batten_result
