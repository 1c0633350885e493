"""The tab in the sidebar: the operators, and what the last one said."""

from __future__ import annotations

import bpy

from .live import LiveSurface
from .operators import (
    Bands,
    Denoise,
    FitToObjects,
    LimitCurvature,
    ModifiedButterfly,
    MorphToShapeKeys,
    Repair,
    Sharpen,
    SurfaceThroughVertices,
)

_GROUPS = (
    ("", ((SurfaceThroughVertices, "MOD_SUBSURF"), (LiveSurface, "LINKED"), (FitToObjects, "MOD_SHRINKWRAP"))),
    ("Detail", ((Denoise, "MOD_SMOOTH"), (Sharpen, "SHARPCURVE"), (Bands, "GRAPH"))),
    ("More", ((ModifiedButterfly, "MESH_ICOSPHERE"), (MorphToShapeKeys, "SHAPEKEY_DATA"), (LimitCurvature, "COLOR"), (Repair, "TOOL_SETTINGS"))),
)


class BattenPanel(bpy.types.Panel):
    bl_idname = "VIEW3D_PT_batten"
    bl_label = "Batten"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Batten"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        for title, entries in _GROUPS:
            column = layout.column(align=True)
            if title:
                column.label(text=title)
            for operator, icon in entries:
                column.operator(operator.bl_idname, icon=icon)
        if context.scene.batten_result:
            box = layout.box()
            for line in _lines(context.scene.batten_result, 36):
                box.label(text=line)


def _lines(text: str, width: int) -> list[str]:
    lines = [""]
    for word in text.split():
        if len(lines[-1]) + len(word) > width and lines[-1]:
            lines.append("")
        lines[-1] = f"{lines[-1]} {word}".strip()
    return lines


def register() -> None:
    bpy.utils.register_class(BattenPanel)


def unregister() -> None:
    bpy.utils.unregister_class(BattenPanel)
