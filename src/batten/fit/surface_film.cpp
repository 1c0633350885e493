#include "batten/fit/surface_film.h"

#include <utility>

#include "batten/error.h"
#include "batten/refine/refinement.h"

namespace batten {

namespace {

bool has_same_faces(const Topology& a, const Topology& b) {
  if (a.vertex_count() != b.vertex_count() || a.face_count() != b.face_count() ||
      a.half_edge_count() != b.half_edge_count())
    return false;
  for (Index f = 0; f < a.face_count(); ++f) {
    if (a.face_begin(f) != b.face_begin(f)) return false;
  }
  for (Index h = 0; h < a.half_edge_count(); ++h) {
    if (a.origin(h) != b.origin(h)) return false;
  }
  return true;
}

}  // namespace

Mesh frame_mesh(const SurfaceFrame& frame) {
  Mesh mesh = mesh_from_topology(frame.topology);
  mesh.points = frame.control;
  state_scheme(frame.scheme, mesh);
  return mesh;
}

void SurfaceFilm::add(const SurfaceFrame& frame) {
  int level = levels_.empty() ? 0 : levels_.back();
  if (!frames_.empty() && !has_same_faces(frames_.back().topology, frame.topology)) {
    const SurfaceFrame& last = frames_.back();
    if (has_same_faces(Refinement(last.topology, last.scheme).child(), frame.topology)) {
      ++level;
    } else {
      frames_.clear();
      levels_.clear();
      level = 0;
    }
  }
  frames_.push_back(frame);
  levels_.push_back(level);
}

Points SurfaceFilm::on_last_mesh(Index i) const {
  const SurfaceFrame& own = frame(i);
  return refine(own.topology, own.scheme, own.control, levels_.back() - levels_[static_cast<std::size_t>(i)]).values;
}

MovingSurface SurfaceFilm::moving(double frames_per_second, int levels, const Progress& progress) const {
  if (frames_.empty()) throw Error(ErrorCode::BadArgument, "a film needs a frame");
  if (!(frames_per_second > 0.0)) throw Error(ErrorCode::BadArgument, "a film needs more than 0 frames a second");
  std::vector<Points> shapes;
  std::vector<double> times;
  for (Index i = 0; i < size(); ++i) {
    times.push_back(i / frames_per_second);
    if (i > 0) shapes.push_back(on_last_mesh(i));
  }
  SurfaceFrame first = frames_.back();
  first.control = on_last_mesh(0);
  return surface_through_time(first.topology, first.scheme, frame_mesh(first), shapes, std::move(times), levels,
                              progress);
}

}  // namespace batten
