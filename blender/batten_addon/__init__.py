"""Batten in Blender: smooth subdivision surfaces that pass through the vertices of a mesh, and what goes with them."""

bl_info = {
    "name": "Batten",
    "author": "The Batten authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "3D Viewport > Sidebar > Batten",
    "description": "Subdivision surfaces through vertices, fitted cages, denoising, bands of detail",
    "category": "Mesh",
}

from . import files, live, operators, panel

_PARTS = (operators, live, files, panel)


def register() -> None:
    for part in _PARTS:
        part.register()


def unregister() -> None:
    for part in reversed(_PARTS):
        part.unregister()
