#include "batten/medial/medial_refinement.h"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "batten/error.h"
#include "batten/interpolate/interpolator.h"
#include "batten/mesh/topology.h"
#include "batten/progress.h"
#include "batten/tessellate/tessellator.h"

namespace batten {

namespace {

/// The columns of the numbers that belong to an atom.
constexpr Eigen::Index kUp = 3;
constexpr Eigen::Index kDown = 6;
constexpr Eigen::Index kCrestOrigin = 9;
constexpr Eigen::Index kCrestSpoke = 12;
constexpr Eigen::Index kCoordinates = 15;
constexpr Eigen::Index kColumns = 17;

/// A row an atom. Inside the sheet there is no crest spoke, and what stands in its place does not matter: boundary
/// curves depend on the boundary alone.
Values values_of(const MedialFigure& figure) {
  Values values = Values::Zero(figure.sheet.points.rows(), kColumns);
  values.leftCols(3) = figure.sheet.points;
  values.middleCols(kUp, 3) = figure.up;
  values.middleCols(kDown, 3) = figure.down;
  values.middleCols(kCrestOrigin, 3) = figure.sheet.points;
  for (const CrestSpoke& crest : figure.crest) {
    values.row(crest.atom).segment<3>(kCrestOrigin) = crest.origin.transpose();
    values.row(crest.atom).segment<3>(kCrestSpoke) = crest.spoke.transpose();
  }
  if (figure.coordinates.rows() > 0) values.middleCols(kCoordinates, 2) = figure.coordinates;
  return values;
}

/// Fills a figure whose sheet has its faces.
void set_values(MedialFigure& figure, const Values& values) {
  figure.sheet.points = values.leftCols(3);
  figure.up = values.middleCols(kUp, 3);
  figure.down = values.middleCols(kDown, 3);
  figure.crest.clear();
  const Topology topology(figure.sheet);
  for (Index atom = 0; atom < topology.vertex_count(); ++atom) {
    if (!topology.is_boundary_vertex(atom)) continue;
    figure.crest.push_back({atom, values.row(atom).segment<3>(kCrestOrigin).transpose(),
                            values.row(atom).segment<3>(kCrestSpoke).transpose()});
  }
}

/// The sheet's surface through the atoms, as a mesh.
struct FineSheet {
  Topology topology;  ///< of the sheet given
  Tessellator tessellator;
  Values values;  ///< a row for each vertex of the tessellator; those of the atoms given as they are
};

FineSheet fine_sheet(const MedialFigure& figure, int levels) {
  const Topology topology(figure.sheet);
  Scheme scheme;
  scheme.kind = SchemeKind::CatmullClark;
  scheme.boundary = BoundaryRule::EdgeAndCorner;
  InterpolateOptions options;
  options.on_singular = OnSingular::Refuse;
  const Values given = values_of(figure);
  const Interpolant surface = Interpolator(topology, scheme, options).solve(given);
  FineSheet fine{topology, Tessellator(topology, scheme, levels), {}};
  fine.values.resize(fine.tessellator.vertex_count(), kColumns);
  fine.tessellator.limit<double>(surface.control, {fine.values.data(), static_cast<std::size_t>(fine.values.size())});
  fine.values.topRows(given.rows()) = given;
  return fine;
}

MedialFigure split_faces(const MedialFigure& figure, int levels) {
  const FineSheet fine = fine_sheet(figure, levels);
  MedialFigure refined;
  refined.name = figure.name;
  const Index size = fine.tessellator.face_size();
  Buffer<Index>& corners = refined.sheet.face_vertices;
  corners.resize(static_cast<std::size_t>(fine.tessellator.face_count()) * size);
  fine.tessellator.faces(corners);
  for (Index face = 0; face < fine.tessellator.face_count(); ++face)
    refined.sheet.face_offsets.push_back((face + 1) * size);
  refined.sheet.points = fine.values.leftCols(3);
  if (figure.coordinates.rows() > 0) refined.coordinates = fine.values.middleCols(kCoordinates, 2);
  set_values(refined, fine.values);
  return refined;
}

/// The vertices of the first refinement of an elliptical grid: the ends of an edge, or opposite corners of a quad, are
/// looked up to find the one in their middle.
class Middles {
 public:
  explicit Middles(const Topology& sheet) {
    const Index vertices = sheet.vertex_count();
    for (Index edge = 0; edge < sheet.edge_count(); ++edge) {
      const Index h = sheet.edge_half_edge(edge);
      add(sheet.origin(h), sheet.destination(h), vertices + edge);
    }
    for (Index face = 0; face < sheet.face_count(); ++face) {
      if (sheet.face_size(face) != 4) continue;
      const Index begin = sheet.face_begin(face);
      for (const Index k : {0, 1})
        add(sheet.origin(begin + k), sheet.origin(begin + k + 2), vertices + sheet.edge_count() + face);
    }
  }
  /// -1 where there is none.
  Index between(Index a, Index b) const {
    const auto found = middles_.find(std::minmax(a, b));
    return found == middles_.end() ? -1 : found->second;
  }

 private:
  void add(Index a, Index b, Index middle) { middles_.emplace(std::minmax(a, b), middle); }
  std::map<std::pair<Index, Index>, Index> middles_;
};

MedialFigure double_grid(const MedialFigure& figure) {
  const FineSheet fine = fine_sheet(figure, 1);
  const Middles middles(fine.topology);
  const SpineGrid grid = *figure.grid;
  MedialFigure refined;
  refined.name = figure.name;
  const SpineGrid doubled{2 * grid.crest_points, 2 * grid.steps};
  set_ellipse(refined, doubled);
  // The vertex of the fine sheet at each place of the doubled grid.
  std::vector<Index> sources(static_cast<std::size_t>(doubled.atom_count()));
  for (Index line = 0; line < doubled.crest_points; ++line) {
    for (Index step = 0; step <= doubled.steps; ++step) {
      const Index next_line = (line / 2 + line % 2) % grid.crest_points;
      const Index next_step = step / 2 + step % 2;
      const Index a = grid.atom(line / 2, step / 2);
      const Index c = grid.atom(next_line, next_step);
      Index source = a == c ? a : middles.between(a, c);
      // Beside the far side of an end of the spine the other diagonal is an edge.
      if (source < 0) source = middles.between(grid.atom(next_line, step / 2), grid.atom(line / 2, next_step));
      sources[static_cast<std::size_t>(doubled.atom(line, step))] = source;
    }
  }
  const Values values = fine.values(sources, Eigen::all);
  refined.sheet.points = values.leftCols(3);
  set_values(refined, values);
  return refined;
}

}  // namespace

MedialModel refine_medial(const MedialModel& model, int levels, const Progress& progress) {
  if (levels < 0) throw Error(ErrorCode::BadArgument, "the number of levels is negative");
  require_medial(model);
  MedialModel refined = model;
  if (levels > 0) refined.hinges.clear();
  const auto parts = static_cast<double>(model.figures.size());
  for (std::size_t i = 0; i < model.figures.size() && levels > 0; ++i) {
    report_progress(progress, static_cast<double>(i) / parts);
    MedialFigure& figure = refined.figures[i];
    if (!figure.grid) figure = split_faces(figure, levels);
    for (int level = 0; level < levels && figure.grid; ++level) figure = double_grid(figure);
  }
  return refined;
}

Mesh sheet_mesh(const MedialModel& model) {
  require_medial(model);
  Eigen::Index count = 0;
  bool placed = true;
  for (const MedialFigure& figure : model.figures) {
    count += figure.sheet.points.rows();
    placed = placed && figure.coordinates.rows() > 0;
  }
  Mesh mesh;
  mesh.points.resize(count, 3);
  Attribute up{"up", Values(count, 3), {}};
  Attribute down{"down", Values(count, 3), {}};
  Attribute radius{"radius", Values(count, 1), {}};
  Attribute uv{"uv", Values(placed ? count : 0, 2), {}};
  Eigen::Index first = 0;
  for (const MedialFigure& figure : model.figures) {
    const Eigen::Index rows = figure.sheet.points.rows();
    if (model.figures.size() > 1 && !figure.name.empty()) mesh.groups.push_back({"o", figure.name, mesh.face_count()});
    mesh.points.middleRows(first, rows) = figure.sheet.points;
    up.values.middleRows(first, rows) = figure.up;
    down.values.middleRows(first, rows) = figure.down;
    radius.values.middleRows(first, rows) = 0.5 * (figure.up.rowwise().norm() + figure.down.rowwise().norm());
    if (placed) uv.values.middleRows(first, rows) = figure.coordinates;
    const auto corners = static_cast<Index>(mesh.face_vertices.size());
    for (const Index atom : figure.sheet.face_vertices) mesh.face_vertices.push_back(static_cast<Index>(first) + atom);
    for (std::size_t face = 1; face < figure.sheet.face_offsets.size(); ++face)
      mesh.face_offsets.push_back(corners + figure.sheet.face_offsets[face]);
    first += rows;
  }
  mesh.attributes = {std::move(up), std::move(down), std::move(radius)};
  if (placed) mesh.attributes.push_back(std::move(uv));
  return mesh;
}

}  // namespace batten
