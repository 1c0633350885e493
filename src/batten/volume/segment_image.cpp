#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "batten/dynamics/surface_samples.h"
#include "batten/error.h"
#include "batten/mesh/triangulate.h"
#include "batten/volume/edge_search.h"
#include "batten/volume/guarded_steps.h"
#include "batten/volume/image_model.h"
#include "batten/volume/segment.h"
#include "batten/volume/segment_measures.h"

namespace batten {

namespace {

/// Places of the surface and their normals.
PointCloud surface_places(const std::vector<Jet>& jets) {
  PointCloud cloud;
  cloud.points.resize(static_cast<Eigen::Index>(jets.size()), 3);
  cloud.normals.resize(cloud.points.rows(), 3);
  for (Eigen::Index i = 0; i < cloud.points.rows(); ++i) {
    cloud.points.row(i) = jets[i].point.transpose();
    cloud.normals.row(i) = jets[i].du.cross(jets[i].dv).normalized().transpose();
  }
  return cloud;
}

std::vector<SurfacePlace> places_of(const SurfaceSamples& samples) {
  std::vector<SurfacePlace> places;
  for (std::ptrdiff_t i = 0; i < samples.count(); ++i) places.push_back(samples.place(i));
  return places;
}

/// What draws a surface besides edges. Both weights are of all of a kind together, beside all edges.
struct Holds {
  const Points& points;
  double point_weight;
  const PointCloud& held;
  double held_weight;
};

/// The edges that were found and what holds besides, each with its weight, as what the surface is drawn to.
void set_targets(SurfaceFitter& fitter, const PointCloud& places, const FoundEdges& edges, const Holds& holds) {
  const Eigen::Index count = places.points.rows();
  const Eigen::Index points = holds.points.rows();
  const Eigen::Index held = holds.held.points.rows();
  const double all = std::max(edges.weights.sum(), 1e-3 * static_cast<double>(count));
  PointCloud cloud;
  cloud.points.resize(count + points + held, 3);
  cloud.points << edges.places, holds.points, holds.held.points;
  cloud.normals = Points::Zero(cloud.points.rows(), 3);
  cloud.normals.topRows(count) = places.normals;
  cloud.normals.bottomRows(held) = holds.held.normals;
  Scalars weights(cloud.points.rows());
  weights.head(count) = edges.weights;
  if (points > 0) weights.segment(count, points).setConstant(holds.point_weight * all / static_cast<double>(points));
  if (held > 0) weights.tail(held).setConstant(holds.held_weight * all / static_cast<double>(held));
  // Places without an edge hold the surface a little where it is.
  weights.head(count).array() += 1e-3;
  fitter.set_cloud(std::move(cloud));
  fitter.set_weights(std::move(weights));
}

void require_options(const ImageFitOptions& options) {
  const bool good = options.smoothing > 0.0 && options.reach > 0.0 && options.point_weight >= 0.0 &&
                    options.held_weight >= 0.0 && options.first_smoothing >= 1.0 && options.first_reach >= 1.0 &&
                    options.fairness > 0.0 && options.rounds >= 1;
  if (!good) throw Error(ErrorCode::BadArgument, "smoothing, reach and fairness are greater than 0, rounds 1 or more");
}

/// The rounds of a fit to an image.
class ImageRounds {
 public:
  ImageRounds(const Segmentation& start, const Volume& image, const Points& points, const ImageFitOptions& options)
      : options_(options),
        points_(points),
        near_(cropped_around(image, start.mesh.points, kMargin)),
        voxel_(std::cbrt(image.grid.voxel_volume())),
        patches_(start.topology, start.scheme),
        asked_(places_of(SurfaceSamples(patches_, GaussSamples{{2, 0}}))),
        jets_(asked_.size()),
        fitter_(start.topology, start.scheme, start.mesh.points,
                {start.mesh.points, Points::Zero(start.mesh.points.rows(), 3)}),
        steps_(fitter_, image.grid, options.watch),
        surface_(patches_, fitter_.control()) {}

  /// early: 1 at first, 0 in the end.
  void take(double early) {
    const FoundEdges edges = find(early);
    set_targets(fitter_, places_, edges, holds(std::pow(kPointsFirst, early)));
    step(options_.fairness * std::pow(std::max(1.0, kFirstFairness / options_.fairness), early));
  }

  /// The image is smoothed anew a few times only.
  void smooth(double early) {
    search_.emplace(near_, options_.smoothing * voxel_ * std::pow(options_.first_smoothing, early));
  }

  /// Off the edges to where the blurred image that the surface would give is most like the one there is. Fairness makes
  /// a round body smaller, by moves that the image asks for in vain: these are asked for twice, and once more.
  void fit_model(const Progress& progress) {
    constexpr int kRounds = 20;
    constexpr int kRoundsOfHold = 6;
    constexpr double kFaces = 6000;
    const FoundEdges edges = find(0.0);
    ImageModel model(near_);
    Scalars held = Scalars::Zero(static_cast<Eigen::Index>(asked_.size()));
    for (int round = 0; round < kRounds; ++round) {
      report_progress(progress, static_cast<double>(round) / kRounds);
      look();
      const Mesh control = frame_mesh({fitter_.topology(), fitter_.scheme(), fitter_.control()});
      model.set_surface(triangulated(surface_of_faces(fitter_.topology(), fitter_.scheme(), control, kFaces)));
      const ModelMoves asked = model.moves(places_.points, places_.normals);
      if (round > 0) model.learn_blur();
      if (round > 0 && round % kRoundsOfHold == 0) held += asked.weights.cwiseProduct(asked.moves);
      set_targets(fitter_, places_, mixed(edges, asked, held), holds(1.0));
      step(options_.fairness * fairness_of_noise(model.noise()));
    }
  }

  const SurfaceFitter& fitter() const { return fitter_; }
  GuardedSteps& steps() { return steps_; }

 private:
  static constexpr Index kMargin = 24;
  static constexpr double kFirstFairness = 0.3;
  static constexpr int kHalvings = 3;
  static constexpr double kPointsFirst = 30.0;  // the points alone make the shape before edges count

  /// So much more than at the edges: the model sees through noise, which asks for moves of its own.
  static double fairness_of_noise(double noise) {
    constexpr double kNone = 2.0;
    constexpr double kOfNoise = 40.0;
    constexpr double kMost = 10.0;
    return std::min(kMost, kNone + kOfNoise * noise);
  }

  /// Where the model explains the image, what it asks for; elsewhere, as between two other parts, the edges.
  FoundEdges mixed(const FoundEdges& edges, const ModelMoves& asked, const Scalars& held) const {
    FoundEdges targets = edges;
    for (Eigen::Index row = 0; row < held.size(); ++row) {
      const double trust = asked.weights[row] * asked.weights[row];
      const double other = edges.weights[row] * std::pow(1.0 - asked.weights[row], 2.0);
      const Eigen::RowVector3d normal = places_.normals.row(row);
      const double to_edge = (edges.places.row(row) - places_.points.row(row)).dot(normal);
      targets.weights[row] = trust + other;
      const double move = trust * (asked.moves[row] + held[row]) + other * to_edge;
      targets.places.row(row) = places_.points.row(row) + (trust + other > 0.0 ? move / (trust + other) : 0.0) * normal;
    }
    return targets;
  }

  Holds holds(double times) const {
    return {points_, times * options_.point_weight, options_.held, times * options_.held_weight};
  }

  void look() {
    surface_.set_control(fitter_.control());
    surface_.jets(asked_, jets_);
    places_ = surface_places(jets_);
  }

  FoundEdges find(double early) {
    look();
    return search_->find(places_.points, places_.normals,
                         options_.reach * voxel_ * std::pow(options_.first_reach, early));
  }

  void step(double fairness) {
    fitter_.attach();
    FitStep step;
    step.pull = 0.0;
    step.fairness = fairness;
    steps_.take(step, kHalvings);
  }

  ImageFitOptions options_;
  const Points& points_;
  Volume near_;
  double voxel_;
  SurfacePatches patches_;
  std::vector<SurfacePlace> asked_;
  std::vector<Jet> jets_;
  PointCloud places_;
  SurfaceFitter fitter_;
  GuardedSteps steps_;
  LimitSurface surface_;
  std::optional<EdgeSearch> search_;
};

}  // namespace

Segmentation segment_image(const Segmentation& start, const Volume& image, const Points& points,
                           const ImageFitOptions& options, const Progress& progress) {
  require_options(options);
  ImageRounds rounds(start, image, points, options);
  // Points say where the border is, whatever the image does there.
  const bool modelled = options.leave_blur && points.rows() == 0;
  const Progress edges = progress_within(progress, 0.0, modelled ? 0.5 : 1.0);
  for (int round = 0; round < options.rounds; ++round) {
    report_progress(edges, static_cast<double>(round) / options.rounds);
    const double done = options.rounds > 1 ? static_cast<double>(round) / (options.rounds - 1) : 1.0;
    const double early = std::max(0.0, 1.0 - 1.5 * done);
    if (round % 6 == 0) rounds.smooth(early);
    rounds.take(early);
  }
  if (modelled) rounds.fit_model(progress_within(progress, 0.5, 1.0));
  rounds.steps().mend();
  Segmentation result = start;
  result.rounds = rounds.steps().taken();
  result.cut_steps = rounds.steps().cut();
  result.mesh = frame_mesh({rounds.fitter().topology(), rounds.fitter().scheme(), rounds.fitter().control()});
  report_progress(progress, 1.0);
  return result;
}

}  // namespace batten
