#include "batten/volume/segment_together.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <utility>

#include "batten/error.h"
#include "batten/fit/point_tree.h"
#include "batten/fit/surface_fitter.h"
#include "batten/mesh/joined_mesh.h"
#include "batten/mesh/self_intersections.h"
#include "batten/mesh/triangulate.h"
#include "batten/volume/guarded_steps.h"
#include "batten/volume/label_mask.h"

namespace batten {

std::vector<SurfaceMeeting> find_meetings(const std::vector<Mesh>& meshes, const Progress& progress) {
  const Mesh all = joined_mesh(meshes);
  std::vector<Index> ends;
  ends.reserve(meshes.size());
  for (const Mesh& mesh : meshes) ends.push_back((ends.empty() ? 0 : ends.back()) + mesh.face_count());
  const auto mesh_of = [&](Index face) {
    return static_cast<std::size_t>(std::upper_bound(ends.begin(), ends.end(), face) - ends.begin());
  };
  const SelfIntersections found =
      find_self_intersections(Topology(all), all.points, progress, std::numeric_limits<Index>::max());
  std::vector<SurfaceMeeting> meetings;
  for (const auto& [a, b] : found.faces) {
    if (mesh_of(a) == mesh_of(b)) continue;
    Eigen::RowVector3d middle = Eigen::RowVector3d::Zero();
    for (Index c = all.face_offsets[a]; c < all.face_offsets[a + 1]; ++c)
      middle += all.points.row(all.face_vertices[c]) / all.face_size(a);
    meetings.push_back({mesh_of(a), mesh_of(b), middle});
  }
  return meetings;
}

namespace {

/// One of the surfaces, and the border that it is drawn to.
class Neighbour {
 public:
  Neighbour(const Volume& mask, Segmentation found, const VolumeGrid& within)
      : found_(std::move(found)),
        border_(mask_border(mask)),
        tree_(border_.points),
        withdrawn_(Scalars::Zero(border_.points.rows())),
        fitter_(found_.topology, found_.scheme, found_.mesh.points, border_),
        steps_(fitter_, within) {}

  /// The limit surface as triangles, at least so many.
  Mesh fine(std::int64_t least) const {
    Mesh control = found_.mesh;
    control.points = fitter_.control();
    return triangulated(surface_of_faces(found_.topology, found_.scheme, control, least));
  }

  /// Moves the border around the places inwards: by `step` at one, less around it, not at all from `reach` on.
  void withdraw(const Points& places, double reach, double step) {
    constexpr Index kMostNear = 64;
    Scalars more = Scalars::Zero(withdrawn_.size());
    std::array<Index, kMostNear> rows{};
    std::array<double, kMostNear> squares{};
    for (Eigen::Index i = 0; i < places.rows(); ++i) {
      const Index count = tree_.nearest(places.row(i), kMostNear, rows.data(), squares.data());
      for (Index k = 0; k < count; ++k)
        more[rows[k]] = std::max(more[rows[k]], step * (1.0 - squares[k] / (reach * reach)));
    }
    withdrawn_ += more;
  }
  double most_withdrawn() const { return withdrawn_.maxCoeff(); }

  /// Draws the surface to the border as it is now.
  void draw() {
    constexpr int kSteps = 2;
    constexpr int kHalvings = 3;
    PointCloud cloud = border_;
    cloud.points -= withdrawn_.asDiagonal() * border_.normals;
    fitter_.set_cloud(std::move(cloud));
    fitter_.attach();
    FitStep step;
    step.fairness = found_.fairness;
    for (int i = 0; i < kSteps; ++i) steps_.take(step, kHalvings);
  }

  Segmentation result() {
    fitter_.set_cloud(border_);
    fitter_.attach();
    Segmentation result = found_;
    result.mesh.points = fitter_.control();
    result.rounds += steps_.taken();
    result.cut_steps += steps_.cut();
    result.border_rms = fitter_.distances().norm() / std::sqrt(static_cast<double>(border_.points.rows()));
    return result;
  }

 private:
  Segmentation found_;
  PointCloud border_;
  PointTree tree_;
  Scalars withdrawn_;  ///< how far each point of the border is moved inwards, mm
  SurfaceFitter fitter_;
  GuardedSteps steps_;
};

using Neighbours = std::vector<std::unique_ptr<Neighbour>>;

/// Pairs that meet where each surface has so many triangles.
std::vector<SurfaceMeeting> meetings_of(const Neighbours& neighbours, std::int64_t least) {
  std::vector<Mesh> meshes;
  meshes.reserve(neighbours.size());
  for (const auto& neighbour : neighbours) meshes.push_back(neighbour->fine(least));
  return find_meetings(meshes);
}

/// On coarse meshes, and where nothing meets there on those that are measured.
std::vector<SurfaceMeeting> meetings_of(const Neighbours& neighbours) {
  constexpr std::int64_t kSearchedFaces = 20000;
  std::vector<SurfaceMeeting> meetings = meetings_of(neighbours, kSearchedFaces);
  return meetings.empty() ? meetings_of(neighbours, kMeasuredFaces) : meetings;
}

[[noreturn]] void refuse_meetings(const std::vector<SurfaceMeeting>& meetings, const std::vector<double>& labels) {
  const SurfaceMeeting& first = meetings.front();
  throw Error(ErrorCode::NotConverged,
              "the surfaces of labels " + label_text(labels[first.first]) + " and " + label_text(labels[first.second]) +
                  " still meet (" + std::to_string(meetings.size()) +
                  " pairs of triangles) with the border moved inwards by one and a half voxels; take more control "
                  "points, or more smoothing");
}

/// Moves the surfaces apart.
void part(Neighbours& neighbours, double voxel, const std::vector<double>& labels, TogetherResult& result,
          const Progress& progress) {
  constexpr double kReach = 3.0;  // voxels
  constexpr double kStep = 0.1;   // voxels a round
  constexpr double kMost = 1.5;   // voxels
  constexpr int kMostRounds = 60;
  std::vector<SurfaceMeeting> meetings = meetings_of(neighbours);
  result.first_meetings = static_cast<std::int64_t>(meetings.size());
  while (!meetings.empty()) {
    report_progress(progress, static_cast<double>(result.rounds) / kMostRounds);
    if (result.rounds == kMostRounds) refuse_meetings(meetings, labels);
    for (std::size_t i = 0; i < neighbours.size(); ++i) {
      std::vector<Eigen::RowVector3d> places;
      for (const SurfaceMeeting& meeting : meetings) {
        if (meeting.first == i || meeting.second == i) places.push_back(meeting.place);
      }
      if (places.empty()) continue;
      Points rows(static_cast<Eigen::Index>(places.size()), 3);
      for (std::size_t row = 0; row < places.size(); ++row) rows.row(static_cast<Eigen::Index>(row)) = places[row];
      neighbours[i]->withdraw(rows, kReach * voxel, kStep * voxel);
      if (neighbours[i]->most_withdrawn() > kMost * voxel) refuse_meetings(meetings, labels);
      neighbours[i]->draw();
      result.most_withdrawn = std::max(result.most_withdrawn, neighbours[i]->most_withdrawn());
    }
    ++result.rounds;
    meetings = meetings_of(neighbours);
  }
}

void require_together(const SegmentRequest& request) {
  if (request.points.rows() > 0 || request.seed || request.start || request.edges || request.image)
    throw Error(ErrorCode::BadArgument, "surfaces of several labels together start from the labels alone");
  if (request.label.size() < 2) throw Error(ErrorCode::BadArgument, "two labels or more are segmented together");
  if (std::set<double>(request.label.begin(), request.label.end()).size() < request.label.size())
    throw Error(ErrorCode::BadArgument, "a label stands twice in the list");
}

}  // namespace

TogetherResult segment_together(const Volume& image, const SegmentRequest& request, const Progress& progress) {
  constexpr double kFound = 0.5;
  constexpr double kParted = 0.8;
  require_together(request);
  require_volume(image);
  const Volume& labels = request.labels ? *request.labels : image;
  SegmentOptions options = request.surface;
  options.watch = {};
  if (!options.within) options.within = labels.grid;
  const auto count = static_cast<double>(request.label.size());
  std::vector<Volume> masks;
  for (const double label : request.label) masks.push_back(label_mask(labels, {label}));
  Neighbours neighbours;
  for (const Volume& mask : masks) {
    const double begin = static_cast<double>(neighbours.size()) / count;
    Segmentation found =
        segment_mask(mask, options, progress_within(progress, kFound * begin, kFound * (begin + 1.0 / count)));
    neighbours.push_back(std::make_unique<Neighbour>(mask, std::move(found), *options.within));
  }
  TogetherResult result;
  part(neighbours, std::cbrt(labels.grid.voxel_volume()), request.label, result,
       progress_within(progress, kFound, kParted));
  for (std::size_t i = 0; i < masks.size(); ++i) {
    const double begin = kParted + (1.0 - kParted) * static_cast<double>(i) / count;
    result.surfaces.push_back(measured_segment(neighbours[i]->result(), image, masks[i],
                                               progress_within(progress, begin, begin + (1.0 - kParted) / count)));
  }
  return result;
}

}  // namespace batten
