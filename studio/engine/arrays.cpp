#include "studio/engine/arrays.h"

#include <algorithm>

namespace batten::studio {

Points to_points(const val& numbers) {
  const std::vector<double> flat = emscripten::convertJSArrayToNumberVector<double>(numbers);
  if (flat.size() % 3 != 0) throw Error(ErrorCode::BadShape, "points need three coordinates each");
  return Eigen::Map<const Points>(flat.data(), static_cast<Eigen::Index>(flat.size() / 3), 3);
}

std::vector<float> to_floats(const Values& values) {
  std::vector<float> floats(static_cast<std::size_t>(values.size()));
  std::transform(values.data(), values.data() + values.size(), floats.begin(),
                 [](double number) { return static_cast<float>(number); });
  return floats;
}

val failure(int code, const std::string& message) {
  val result = val::object();
  result.set("failure", message);
  result.set("code", code);
  return result;
}

Progress progress_of(const val& report) {
  if (report.isNull() || report.isUndefined()) return {};
  return [report](double done) { return report(done).as<bool>(); };
}

}  // namespace batten::studio
