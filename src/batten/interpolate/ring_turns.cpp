#include "batten/interpolate/ring_turns.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "batten/parallel/parallel.h"

namespace batten {

namespace {

/// Smaller angles are rounding of the normals themselves.
constexpr double kSameNormal = 1e-13;
/// Sines below this do not tell in which direction to turn by half a turn.
constexpr double kOpposite = 1e-12;
constexpr std::ptrdiff_t kRingBlock = 512;

/// The rotation by an angle about a point, in the plane of the orthogonal unit vectors `from` and `towards`.
class RingTurn {
 public:
  RingTurn(const Eigen::Vector3d& centre, const Eigen::Vector3d& from, const Eigen::Vector3d& towards, double angle)
      : centre_(centre), from_(from), towards_(towards), sine_(std::sin(angle)) {
    const double half = std::sin(0.5 * angle);
    less_ = -2.0 * half * half;  // cosine - 1, without cancellation
  }

  Eigen::Vector3d operator()(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d arm = point - centre_;
    const double u = arm.dot(from_);
    const double w = arm.dot(towards_);
    return point + (less_ * u - sine_ * w) * from_ + (sine_ * u + less_ * w) * towards_;
  }

 private:
  Eigen::Vector3d centre_;
  Eigen::Vector3d from_;
  Eigen::Vector3d towards_;
  double sine_;
  double less_;
};

/// The unit vector in the tangent plane towards which the normal leans to become the wanted one; zero where the two are
/// opposite.
Eigen::Vector3d lean_of(const Eigen::Vector3d& normal, const Eigen::Vector3d& wanted) {
  Eigen::Vector3d lean = wanted - wanted.dot(normal) * normal;
  if (lean.norm() < kOpposite) return Eigen::Vector3d::Zero();
  lean.normalize();
  return (lean - lean.dot(normal) * normal).normalized();  // once more: the first difference cancelled digits
}

TurnCounts sum_of(TurnCounts a, const TurnCounts& b) {
  a.unwanted += b.unwanted;
  a.kept += b.kept;
  a.turned += b.turned;
  a.boundary += b.boundary;
  a.opposed += b.opposed;
  a.antiparallel += b.antiparallel;
  a.crease += b.crease;
  a.corner += b.corner;
  a.valence_two += b.valence_two;
  a.degenerate += b.degenerate;
  a.outside += b.outside;
  return a;
}

/// Counts a vertex that has not one normal.
void count_skipped(FrameKind kind, TurnCounts& counts) {
  switch (kind) {
    case FrameKind::Interior:
    case FrameKind::Boundary:
      break;
    case FrameKind::Crease:
      ++counts.crease;
      break;
    case FrameKind::Corner:
      ++counts.corner;
      break;
    case FrameKind::ValenceTwo:
      ++counts.valence_two;
      break;
    case FrameKind::Degenerate:
      ++counts.degenerate;
      break;
    case FrameKind::Outside:
      ++counts.outside;
      break;
  }
}

/// The rings of a mesh at work.
class RingTurner {
 public:
  RingTurner(const VertexFrames& frames, double tolerance, Values& control, TurnReport& report)
      : frames_(frames), tolerance_(tolerance), control_(control), report_(report) {}

  void turn(Index vertex, const Eigen::Vector3d& wanted, FrameRing& ring, TurnCounts& counts) const {
    frames_.find(vertex, ring);
    const VertexFrame frame = VertexFrames::frame(control_, ring);
    if (wanted.isZero(0.0)) {
      ++counts.unwanted;
      return;
    }
    if (frame.normal.isZero(0.0)) return count_skipped(frame.kind, counts);
    const double angle = angle_between(frame.normal.transpose(), wanted.transpose());
    report_.before(vertex) = angle;
    if (angle > 0.5 * std::numbers::pi) ++counts.opposed;
    if (angle <= std::max(tolerance_, kSameNormal)) {
      ++counts.kept;
      return;
    }
    ++counts.turned;
    if (frame.kind == FrameKind::Boundary) ++counts.boundary;
    Eigen::Vector3d towards = lean_of(frame.normal, wanted);
    if (towards.isZero(0.0)) {
      ++counts.antiparallel;
      towards = lean_of(frame.normal, frame.along.normalized()).cross(frame.normal);
    }
    const RingTurn rotate(frame.position, frame.normal, towards, angle - tolerance_);
    for (const Index v : ring.vertices) control_.row(v) = rotate(control_.row(v).transpose()).transpose();
  }

 private:
  const VertexFrames& frames_;
  double tolerance_;
  Values& control_;
  TurnReport& report_;
};

}  // namespace

void turn_rings(const VertexFrames& frames, ConstValuesRef wanted, double tolerance, Values& control,
                TurnReport& report, const Progress& progress) {
  report.before = Scalars::Constant(wanted.rows(), std::numeric_limits<double>::quiet_NaN());
  const RingTurner turner(frames, tolerance, control, report);
  const auto turn_block = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    TurnCounts counts;
    FrameRing ring;
    for (auto v = static_cast<Index>(begin); v < end; ++v) turner.turn(v, wanted.row(v).transpose(), ring, counts);
    return counts;
  };
  report.counts = parallel_reduce(wanted.rows(), TurnCounts(), turn_block, sum_of, kRingBlock, progress);
  report.before_angle = measure_numbers(report.before);
}

void measure_turned(const VertexFrames& frames, ConstValuesRef wanted, const Values& control, TurnReport& report) {
  report.after = report.before;
  const auto measure_block = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    FrameRing ring;
    for (auto v = static_cast<Index>(begin); v < end; ++v) {
      if (std::isnan(report.before(v))) continue;
      frames.find(v, ring);
      report.after(v) = angle_between(VertexFrames::frame(control, ring).normal.transpose(), wanted.row(v));
    }
  };
  parallel_for(wanted.rows(), measure_block, kRingBlock);
  report.after_angle = measure_numbers(report.after);
}

}  // namespace batten
