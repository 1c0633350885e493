#include "batten/medial/medial_boundary.h"

#include <algorithm>

#include "batten/medial/hinge.h"
#include "batten/mesh/face_normal.h"
#include "batten/mesh/topology.h"

namespace batten {

namespace {

/// True where the sheet's faces, counter-clockwise, are seen from the side of the upward spokes.
bool turns_upward(const MedialFigure& figure) {
  const Points across = figure.up - figure.down;
  const Mesh& sheet = figure.sheet;
  double sum = 0.0;
  for (Index face = 0; face < sheet.face_count(); ++face) {
    const Eigen::Vector3d normal = face_normal(sheet, face);
    for (Index c = sheet.face_offsets[face]; c < sheet.face_offsets[face + 1]; ++c)
      sum += across.row(sheet.face_vertices[c]).dot(normal);
  }
  return sum >= 0.0;
}

/// Writes the vertices of one figure.
class FigureEnds {
 public:
  FigureEnds(const MedialFigure& figure, Index number, Index first, MedialBoundary& boundary)
      : figure_(figure), number_(number), next_(first), boundary_(boundary) {}

  void add_all() {
    for (Index atom = 0; atom < figure_.atom_count(); ++atom)
      add(atom, SpokeSide::Up, figure_.sheet.points.row(atom), figure_.up.row(atom));
    for (Index atom = 0; atom < figure_.atom_count(); ++atom)
      add(atom, SpokeSide::Down, figure_.sheet.points.row(atom), figure_.down.row(atom));
    for (const CrestSpoke& crest : figure_.crest)
      add(crest.atom, SpokeSide::Crest, crest.origin.transpose(), crest.spoke.transpose());
  }

 private:
  void add(Index atom, SpokeSide side, const Eigen::RowVector3d& origin, const Eigen::RowVector3d& spoke) {
    boundary_.ends.push_back({number_, atom, side});
    boundary_.origins.row(next_) = origin;
    boundary_.mesh.points.row(next_) = origin + spoke;
    boundary_.radii(next_) = spoke.norm();
    boundary_.directions.row(next_) = spoke.normalized();
    ++next_;
  }

  const MedialFigure& figure_;
  Index number_;
  Index next_;
  MedialBoundary& boundary_;
};

/// The faces of one figure's boundary; its vertices start at `first`. Says of each where it comes from.
void add_faces(const MedialFigure& figure, Index number, Index first, Mesh& mesh, std::vector<BoundaryFace>& origins) {
  const Topology sheet(figure.sheet);
  const Index count = figure.atom_count();
  // Of the two sides the one that sees the sheet's faces counter-clockwise, and the other.
  const bool upward = turns_upward(figure);
  const Index front = upward ? first : first + count;
  const Index back = upward ? first + count : first;
  for (const Index offset : {front, back}) {
    for (Index face = 0; face < sheet.face_count(); ++face) {
      const Index begin = sheet.face_begin(face);
      const Index end = sheet.face_end(face);
      for (Index k = begin; k < end; ++k)
        mesh.face_vertices.push_back(offset + sheet.origin(offset == front ? k : begin + end - 1 - k));
      mesh.face_offsets.push_back(static_cast<Index>(mesh.face_vertices.size()));
      origins.push_back({number, offset == first ? SpokeSide::Up : SpokeSide::Down, face, -1});
    }
  }
  Buffer<Index> crest(static_cast<std::size_t>(count), -1);
  for (std::size_t i = 0; i < figure.crest.size(); ++i)
    crest[figure.crest[i].atom] = first + 2 * count + static_cast<Index>(i);
  for (Index h = 0; h < sheet.half_edge_count(); ++h) {
    if (sheet.twin(h) >= 0) continue;
    const Index a = sheet.origin(h);
    const Index b = sheet.destination(h);
    mesh.add_face({front + b, front + a, crest[a], crest[b]});
    mesh.add_face({back + a, back + b, crest[b], crest[a]});
    for (int strip = 0; strip < 2; ++strip) origins.push_back({number, SpokeSide::Crest, a, b});
  }
}

Attribute medial_attribute(const MedialModel& model, const MedialBoundary& boundary) {
  Attribute medial{"medial", Values(boundary.mesh.points.rows(), 3), {}};
  for (Index vertex = 0; vertex < boundary.mesh.vertex_count(); ++vertex) {
    const SpokeEnd& end = boundary.ends[static_cast<std::size_t>(vertex)];
    const Values& coordinates = model.figures[static_cast<std::size_t>(end.figure)].coordinates;
    medial.values.row(vertex) << coordinates(end.atom, 0), coordinates(end.atom, 1), static_cast<double>(end.side);
  }
  return medial;
}

}  // namespace

MedialBoundary medial_boundary(const MedialModel& model) {
  require_medial(model);
  Eigen::Index count = 0;
  for (const MedialFigure& figure : model.figures)
    count += 2 * figure.sheet.points.rows() + static_cast<Eigen::Index>(figure.crest.size());
  MedialBoundary boundary;
  boundary.mesh.scheme = SchemeKind::CatmullClark;
  boundary.mesh.points.resize(count, 3);
  boundary.origins.resize(count, 3);
  boundary.directions.resize(count, 3);
  boundary.radii.resize(count);
  std::vector<BoundaryFace> origins;
  for (std::size_t i = 0; i < model.figures.size(); ++i) {
    const MedialFigure& figure = model.figures[i];
    const auto first = static_cast<Index>(boundary.ends.size());
    if (model.figures.size() > 1 && !figure.name.empty())
      boundary.mesh.groups.push_back({"o", figure.name, boundary.mesh.face_count()});
    FigureEnds(figure, static_cast<Index>(i), first, boundary).add_all();
    add_faces(figure, static_cast<Index>(i), first, boundary.mesh, origins);
  }
  if (!model.hinges.empty()) join_figures(model, origins, boundary);
  const bool placed = std::all_of(model.figures.begin(), model.figures.end(),
                                  [](const MedialFigure& figure) { return figure.coordinates.rows() > 0; });
  if (placed) boundary.mesh.attributes.push_back(medial_attribute(model, boundary));
  boundary.mesh.attributes.push_back({"radius", boundary.radii, {}});
  return boundary;
}

std::string spoke_name(const MedialModel& model, const SpokeEnd& end) {
  constexpr const char* kSides[] = {"down", "crest", "up"};
  return atom_name(model.figures[static_cast<std::size_t>(end.figure)], end.atom) + ", " +
         kSides[static_cast<int>(end.side) + 1];
}

std::vector<SpokePair> spoke_pairs(const MedialBoundary& boundary) {
  // Where the downward spoke of each atom of each figure ends, -1 where it does not.
  std::vector<std::vector<Index>> downward;
  for (std::size_t vertex = 0; vertex < boundary.ends.size(); ++vertex) {
    const SpokeEnd& end = boundary.ends[vertex];
    const auto figure = static_cast<std::size_t>(end.figure);
    const auto atom = static_cast<std::size_t>(end.atom);
    if (downward.size() <= figure) downward.resize(figure + 1);
    if (downward[figure].size() <= atom) downward[figure].resize(atom + 1, -1);
    if (end.side == SpokeSide::Down) downward[figure][atom] = static_cast<Index>(vertex);
  }
  std::vector<SpokePair> pairs;
  for (std::size_t vertex = 0; vertex < boundary.ends.size(); ++vertex) {
    const SpokeEnd& end = boundary.ends[vertex];
    const Index other = downward[static_cast<std::size_t>(end.figure)][static_cast<std::size_t>(end.atom)];
    if (end.side == SpokeSide::Up && other >= 0) pairs.push_back({static_cast<Index>(vertex), other});
  }
  return pairs;
}

}  // namespace batten
