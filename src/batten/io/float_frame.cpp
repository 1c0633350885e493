#include "batten/io/float_frame.h"

#include <limits>

#include "batten/error.h"

namespace batten::io {

FloatFrame float_frame(const std::string& name, const Points& points) {
  FloatFrame frame;
  if (points.rows() == 0) return frame;
  frame.low = points.colwise().minCoeff();
  frame.high = points.colwise().maxCoeff();
  if (frame.high.cwiseAbs().cwiseMax(frame.low.cwiseAbs()).maxCoeff() > std::numeric_limits<float>::max() / 2) {
    throw Error(ErrorCode::BadArgument, name + ": a coordinate is too large for the floats of this format; scale it");
  }
  const Eigen::RowVector3d centre = 0.5 * (frame.low + frame.high);
  if (centre.norm() > (frame.high - frame.low).norm()) frame.origin = centre.cast<float>().cast<double>();
  frame.low -= frame.origin;
  frame.high -= frame.origin;
  return frame;
}

}  // namespace batten::io
