"""OBJ files with OpenSubdiv's tags in and out: creases and corners stay, which Blender's own importer skips."""

from __future__ import annotations

import pathlib

import bpy
from bpy.props import StringProperty
from bpy_extras.io_utils import ExportHelper, ImportHelper

from . import exchange
from .library import Missing, batten


class ImportTagged(bpy.types.Operator, ImportHelper):
    """Read a mesh with its creases and corners, or the surface of a medial model"""

    bl_idname = "import_mesh.batten"
    bl_label = "Import Mesh with Tags"
    bl_options = {"REGISTER", "UNDO"}
    filename_ext = ".obj"
    filter_glob: StringProperty(default="*.obj;*.ply;*.off;*.stl;*.srep.json;*.json", options={"HIDDEN"})

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            medial = self.filepath.endswith(".json")
            made = batten().medial(self.filepath).mesh if medial else batten().read(self.filepath)
        except (Missing, ValueError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        name = pathlib.Path(self.filepath).stem
        mesh = bpy.data.meshes.new(name)
        exchange.replace_mesh(mesh, made)
        thing = bpy.data.objects.new(name, mesh)
        context.collection.objects.link(thing)
        context.view_layer.objects.active = thing
        thing.select_set(True)
        if made.scheme == "catmull-clark" or made.boundary:
            exchange.set_subdivision(thing, made.boundary or "edge-only", 2)
        return {"FINISHED"}


class ExportTagged(bpy.types.Operator, ExportHelper):
    """Write the active mesh with its creases and corners as OBJ"""

    bl_idname = "export_mesh.batten"
    bl_label = "Export Mesh with Tags"
    filename_ext = ".obj"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.active_object is not None and context.active_object.type == "MESH"

    def execute(self, context: bpy.types.Context) -> set[str]:
        thing = context.active_object
        try:
            mesh = exchange.mesh_of(thing.data)
            mesh._boundary = exchange.boundary_word(exchange.subdivision_of(thing))
            batten().write(self.filepath, mesh)
        except (Missing, ValueError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


def _import_entry(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    self.layout.operator(ImportTagged.bl_idname, text="Mesh with Subdivision Tags (.obj, .ply, .off, .stl), Medial Model (.srep.json)")


def _export_entry(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    self.layout.operator(ExportTagged.bl_idname, text="Mesh with Subdivision Tags (.obj)")


def register() -> None:
    bpy.utils.register_class(ImportTagged)
    bpy.utils.register_class(ExportTagged)
    bpy.types.TOPBAR_MT_file_import.append(_import_entry)
    bpy.types.TOPBAR_MT_file_export.append(_export_entry)


def unregister() -> None:
    bpy.types.TOPBAR_MT_file_export.remove(_export_entry)
    bpy.types.TOPBAR_MT_file_import.remove(_import_entry)
    bpy.utils.unregister_class(ExportTagged)
    bpy.utils.unregister_class(ImportTagged)
