#include "batten/fit/loop_moves.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "batten/fit/loop_trial.h"
#include "batten/fit/sharp_edges.h"
#include "batten/fit/surface_guard.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

/// About how the sum of squares falls with the number of control points.
constexpr double kPower = 3.0;
constexpr int kSteps = 2;
/// A sharp edge costs this part of a control point.
constexpr double kSharpShare = 0.2;

void sort_by_gain(std::vector<LoopMove>& moves) {
  std::sort(moves.begin(), moves.end(), [](const LoopMove& a, const LoopMove& b) {
    if (a.gain != b.gain) return a.gain > b.gain;
    return a.a != b.a ? a.a < b.a : a.b < b.b;
  });
}

class LoopMover {
 public:
  LoopMover(const Mesh& mesh, const Points& points, const LoopMoveOptions& options, const Progress& progress)
      : options_(options), progress_(progress), state_(mesh, points) {}

  Mesh run() {
    constexpr double kGain = 0.01;
    set_fairness();
    place_all();
    LoopState best = state_;
    double least = -1.0;
    for (int sweep = 0; sweep < options_.sweeps; ++sweep) {
      done_ = static_cast<double>(sweep) / options_.sweeps;
      set_fairness();
      turn_and_sharpen();
      exchange(sweep);
      place_all();
      state_.attach_all();
      place_all();
      const double squares = state_.squares();
      const bool gains = least < 0.0 || squares < (1.0 - kGain) * least;
      if (least < 0.0 || squares < least) {
        best = state_;
        least = squares;
      }
      if (!gains) break;
    }
    state_ = std::move(best);
    // Mending may leave pieces of lines.
    constexpr int kCleanings = 3;
    for (int round = 0; round < kCleanings; ++round) {
      Mesh mesh = state_.mesh();
      const std::size_t sharp = mesh.creases.size();
      keep_lines(mesh, options_.spacing);
      if (round > 0 && mesh.creases.size() == sharp) break;
      state_ = LoopState(mesh, state_.points());
      place_all();
      mend();
    }
    return state_.mesh();
  }

 private:
  /// Makes the surface fairer where it passes through itself, the more the longer it does; in the end without sharp
  /// edges there.
  void mend() {
    constexpr int kRounds = 10;
    constexpr double kGrowth = 3.0;
    constexpr int kSharpRounds = 4;
    double fairness = fairness_;
    for (int round = 0; round < kRounds; ++round) {
      const std::vector<Index> around = unsound_vertices();
      if (around.empty()) return;
      fairness *= kGrowth;
      if (round >= kSharpRounds) smooth_edges_at(around);
      LoopTrial trial(state_, fairness, stencils_);
      for (const Index v : around) make(trial, {LoopMoveKind::Place, v, v}, 0.0);
    }
  }

  void smooth_edges_at(const std::vector<Index>& vertices) {
    for (const Index v : vertices) {
      const std::vector<Index> others = state_.sharp_neighbours(v);
      for (const Index other : others) {
        if (std::binary_search(vertices.begin(), vertices.end(), other)) state_.set_sharp(v, other, false);
      }
    }
  }

  /// The corners of the faces whose surface folds over or passes through another's, ascending.
  std::vector<Index> unsound_vertices() const {
    const Mesh mesh = state_.mesh();
    const SurfacePatches patches(Topology(mesh), Scheme{SchemeKind::Loop});
    const Buffer<std::uint8_t> flags = SurfaceGuard(patches, kFineGuardLevels).unsound(mesh.points, Soundness::Whole);
    std::vector<Index> corners;
    std::size_t next = 0;
    for (Index f = 0; f < state_.face_end(); ++f) {
      if (!state_.has_face(f) || flags[next++] == 0) continue;
      for (const Index v : state_.face(f)) corners.push_back(v);
    }
    std::sort(corners.begin(), corners.end());
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    return corners;
  }

  /// Fairness counts with the squared distances that are left, so that noise keeps the surface smooth and exact data
  /// set it free.
  void set_fairness() {
    constexpr double kExact = 0.02;  // of the points' spacing
    double squares = 0.0;
    const std::vector<std::array<Index, 2>> edges = state_.edges();
    for (const auto& [a, b] : edges) squares += (state_.place(a) - state_.place(b)).squaredNorm();
    const double mean = squares / static_cast<double>(edges.size());
    const double exact = kExact * options_.spacing;
    const double left = state_.squares() + static_cast<double>(state_.points().rows()) * exact * exact;
    fairness_ = options_.fairness * left / (state_.vertex_count() * mean);
  }

  /// What a control point is worth.
  double vertex_cost() const { return kPower * state_.squares() / std::max<Index>(state_.vertex_count(), 1); }

  /// The gains of all moves on the surface as it is, best first; those that cost more than `least` are left out.
  void rank(std::vector<LoopMove>& moves, double least) const {
    parallel_for(
        static_cast<std::ptrdiff_t>(moves.size()),
        [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
          LoopTrial trial(state_, fairness_, stencils_);
          for (std::ptrdiff_t i = begin; i < end; ++i) {
            LoopMove& move = moves[static_cast<std::size_t>(i)];
            move.gain = trial.gain(move, 1) - own_cost(move);
          }
        },
        32, progress_within(progress_, done_, done_));
    std::erase_if(moves, [&](const LoopMove& move) { return !(move.gain > least); });
    sort_by_gain(moves);
  }

  /// What the sharp edges cost that a move makes, or saves.
  double own_cost(const LoopMove& move) const {
    if (move.kind != LoopMoveKind::Sharpen) return 0.0;
    return (state_.is_sharp(move.a, move.b) ? -1.0 : 1.0) * kSharpShare * cost_;
  }

  /// Makes a move if it gains more than `least` now too.
  bool make(LoopTrial& trial, const LoopMove& move, double least) {
    constexpr int kOfReport = 32;  // so that whoever waits can stop within milliseconds
    if (++tried_ % kOfReport == 0) report_progress(progress_, done_);
    if (!(trial.gain(move, kSteps) - own_cost(move) > least)) return false;
    trial.commit(state_);
    return true;
  }

  void place_all() {
    LoopTrial trial(state_, fairness_, stencils_);
    for (Index v = 0; v < state_.vertex_end(); ++v) make(trial, {LoopMoveKind::Place, v, v}, 0.0);
  }

  /// Lines of sharp edges grow and shrink at their ends alone, so that none falls apart.
  bool may_sharpen(Index a, Index b) const {
    constexpr double kTurned = 0.97;
    const bool ends = state_.sharp_neighbours(a).size() == 1 || state_.sharp_neighbours(b).size() == 1;
    if (!ends || state_.is_sharp(a, b)) return ends;
    const std::vector<Index> faces = state_.faces_at(a, b);
    if (faces.size() != 2) return false;
    const auto normal = [&](Index f) {
      const std::array<Index, 3>& c = state_.face(f);
      return (state_.place(c[1]) - state_.place(c[0])).cross(state_.place(c[2]) - state_.place(c[0])).normalized();
    };
    return normal(faces[0]).dot(normal(faces[1])) < kTurned;
  }

  void turn_and_sharpen() {
    cost_ = vertex_cost();
    make_all(edge_moves(LoopMoveKind::Swap));
    // A line that has grown has another end, where it may grow again.
    constexpr int kMostGrowth = 8;
    for (int round = 0; options_.creases && round < kMostGrowth; ++round) {
      std::vector<LoopMove> moves = edge_moves(LoopMoveKind::Sharpen);
      std::erase_if(moves, [&](const LoopMove& move) { return !may_sharpen(move.a, move.b); });
      if (!make_all(std::move(moves))) return;
    }
  }

  /// Makes the moves that gain anything; false where there are none.
  bool make_all(std::vector<LoopMove> moves) {
    const double least = 0.02 * cost_;
    rank(moves, least);
    LoopTrial trial(state_, fairness_, stencils_);
    bool any = false;
    for (const LoopMove& move : moves) {
      const bool still = move.kind != LoopMoveKind::Sharpen || may_sharpen(move.a, move.b);
      any = (still && make(trial, move, least)) || any;
    }
    return any;
  }

  /// Edges split where that gains most, and collapse where that costs least, until there are as many control points as
  /// allowed.
  void exchange(int sweep) {
    constexpr double kShares[] = {0.15, 0.12, 0.09, 0.06};
    const double share = kShares[std::min(sweep, 3)];
    const auto most = static_cast<Index>(options_.vertices * (1.0 + share));
    cost_ = vertex_cost();
    std::vector<LoopMove> splits = split_candidates();
    rank(splits, 0.5 * cost_);
    LoopTrial trial(state_, fairness_, stencils_);
    for (const LoopMove& move : splits) {
      if (state_.vertex_count() >= most) break;
      make(trial, move, 0.5 * cost_);
    }
    while (state_.vertex_count() > options_.vertices) {
      std::vector<LoopMove> collapses = edge_moves(LoopMoveKind::Collapse);
      rank(collapses, -std::numeric_limits<double>::infinity());
      const Index before = state_.vertex_count();
      const Index enough = std::max(options_.vertices, before - std::max<Index>(8, before / 8));
      LoopTrial again(state_, fairness_, stencils_);
      for (const LoopMove& move : collapses) {
        if (state_.vertex_count() <= enough) break;
        // Others have changed the surroundings: what costs much more now waits for the next round.
        make(again, move, 1.5 * move.gain - 0.1 * cost_);
      }
      if (state_.vertex_count() == before) break;
    }
  }

  std::vector<LoopMove> edge_moves(LoopMoveKind kind) const {
    std::vector<LoopMove> moves;
    for (const auto& [a, b] : state_.edges()) moves.push_back({kind, a, b});
    return moves;
  }

  /// The edges beside which distances are greatest.
  std::vector<LoopMove> split_candidates() const {
    constexpr double kShare = 0.25;
    std::vector<LoopMove> moves = edge_moves(LoopMoveKind::Split);
    for (LoopMove& move : moves) {
      for (const Index f : state_.faces_at(move.a, move.b)) move.gain += state_.squares_of(f);
    }
    sort_by_gain(moves);
    moves.resize(static_cast<std::size_t>(std::ceil(kShare * static_cast<double>(moves.size()))));
    return moves;
  }

  const LoopMoveOptions& options_;
  const Progress& progress_;
  LoopState state_;
  mutable FacetStencils stencils_;
  double done_ = 0.0;  ///< of the progress
  int tried_ = 0;
  double cost_ = 0.0;
  double fairness_ = 0.0;
};

}  // namespace

Mesh improve_loop_mesh(const Mesh& mesh, const Points& points, const LoopMoveOptions& options,
                       const Progress& progress) {
  return LoopMover(mesh, points, options, progress).run();
}

}  // namespace batten
