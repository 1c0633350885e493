"""Smooth subdivision surfaces through data.

A batten is the thin strip that shipbuilders bend through fixed points to draw a fair curve; this does it for surfaces::

    import batten

    cage = batten.interpolate(batten.read("shape.obj"))
    print(cage.report)
    batten.write("control.obj", cage.mesh)
"""

from . import _native
from .elastic import ElasticMotion, ElasticSurface, Place, SurfaceEnergy
from .errors import Error
from .fitting import Fit, fit
from .interpolation import Interpolant, Interpolator, Updates, interpolate
from .mesh import CornerValues, Mesh, Repaired, check, read, repair, subdivide, triangulate, write
from .models import MedialSurface, medial, texture
from .pictures import render, write_png
from .reports import (
    DenoiseReport,
    DistanceSummary,
    EquilibriumReport,
    FairReport,
    FitReport,
    InterpolationReport,
    MotionMeasure,
    Problem,
    RepairChange,
    SegmentReport,
    SharpenReport,
    UpdateReport,
)
from .series import Bands, Denoised, MeshSeries, Sharpened, bands, denoise, morph, sharpen
from .surface import (
    Curvature,
    Distances,
    LimitSurface,
    Nearest,
    NearestPoints,
    Refinement,
    SparseRows,
    Tessellator,
    distance,
    limit_normals,
    limit_positions,
    surface_weights,
    tessellate,
)
from .volumes import Segmented, Together, Volume, read_marked_points, read_volume, segment, segment_together, write_volume

_native.set_error_type(Error)

__all__ = [
    "Bands",
    "CornerValues",
    "Curvature",
    "DenoiseReport",
    "Denoised",
    "DistanceSummary",
    "Distances",
    "ElasticMotion",
    "ElasticSurface",
    "EquilibriumReport",
    "Error",
    "FairReport",
    "Fit",
    "FitReport",
    "Interpolant",
    "InterpolationReport",
    "Interpolator",
    "LimitSurface",
    "MedialSurface",
    "Mesh",
    "MeshSeries",
    "MotionMeasure",
    "Nearest",
    "NearestPoints",
    "Place",
    "Problem",
    "Refinement",
    "RepairChange",
    "Repaired",
    "SegmentReport",
    "Segmented",
    "SharpenReport",
    "Sharpened",
    "SparseRows",
    "SurfaceEnergy",
    "Tessellator",
    "Together",
    "UpdateReport",
    "Updates",
    "Volume",
    "bands",
    "check",
    "denoise",
    "distance",
    "fit",
    "interpolate",
    "limit_normals",
    "limit_positions",
    "medial",
    "morph",
    "read",
    "read_marked_points",
    "read_volume",
    "render",
    "repair",
    "segment",
    "segment_together",
    "sharpen",
    "subdivide",
    "surface_weights",
    "tessellate",
    "texture",
    "triangulate",
    "write",
    "write_png",
    "write_volume",
]
