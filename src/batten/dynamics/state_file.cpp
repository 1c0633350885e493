/// State files: a line of text, then little-endian numbers, then their checksum.
#include <cstring>
#include <string>

#include "batten/dynamics/elastic_run.h"
#include "batten/error.h"
#include "batten/io/bytes.h"
#include "batten/io/source.h"
#include "batten/mixed_bits.h"
#include "batten/output.h"

namespace batten {
namespace {

constexpr std::string_view kFirstLine = "batten elastic state 1\n";

std::uint64_t bytes_checksum(std::string_view bytes) {
  std::uint64_t sum = bytes.size();
  for (std::size_t i = 0; i < bytes.size(); i += sizeof(std::uint64_t)) {
    char eight[sizeof(std::uint64_t)] = {};
    std::memcpy(eight, bytes.data() + i, std::min(sizeof(eight), bytes.size() - i));
    sum = mixed_bits(sum + io::load<std::uint64_t, io::ByteOrder::Little>(eight) + 0x9e3779b97f4a7c15U);
  }
  return sum;
}

void put_points(io::ByteBuffer& bytes, const Points& points) {
  for (Eigen::Index i = 0; i < points.size(); ++i) bytes.put(points.data()[i]);
}

void put_state(io::ByteBuffer& bytes, const ElasticState& state) {
  bytes.put(static_cast<std::uint64_t>(state.positions.rows())).put(state.time);
  put_points(bytes, state.positions);
  put_points(bytes, state.velocities);
}

class StateReader {
 public:
  StateReader(const std::string& name, std::string_view bytes) : name_(name), bytes_(bytes) {}
  template <typename Number>
  Number number() {
    if (bytes_.size() < sizeof(Number)) fail("is cut short");
    const auto value = io::load<Number, io::ByteOrder::Little>(bytes_.data());
    bytes_.remove_prefix(sizeof(Number));
    return value;
  }
  ElasticState state() {
    const auto rows = number<std::uint64_t>();
    constexpr std::size_t kRowBytes = 6 * sizeof(double);
    if (rows > bytes_.size() / kRowBytes) fail("is cut short");
    ElasticState state;
    state.time = number<double>();
    read_points(static_cast<Eigen::Index>(rows), state.positions);
    read_points(static_cast<Eigen::Index>(rows), state.velocities);
    return state;
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::BadFile, name_ + ": the state file " + what);
  }
  bool at_end() const { return bytes_.empty(); }

 private:
  void read_points(Eigen::Index rows, Points& points) {
    points.resize(rows, 3);
    for (Eigen::Index i = 0; i < points.size(); ++i) points.data()[i] = number<double>();
    if (!points.allFinite()) fail("has numbers that are not finite");
  }
  const std::string& name_;
  std::string_view bytes_;
};

}  // namespace

void write_state(const std::string& path, const ElasticRunState& run) {
  io::ByteBuffer bytes;
  bytes.put(run.body).put(static_cast<std::uint64_t>(run.at_rest ? 1 : 0));
  bytes.put(static_cast<std::uint64_t>(run.refined_at.size()));
  for (const ElasticState& state : run.refined_at) put_state(bytes, state);
  put_state(bytes, run.state);
  write_atomically(path, [&](const std::string& temporary) {
    io::OutputFile file(temporary, path);
    file.write(kFirstLine);
    file.write(bytes.text());
    io::ByteBuffer sum;
    sum.put(bytes_checksum(bytes.text()));
    file.write(sum.text());
    file.close();
  });
}

ElasticRunState read_state(const std::string& path) {
  const io::InputFile file(path);
  std::string_view bytes = file.bytes();
  const std::string name = path == "-" ? "standard input" : path;
  StateReader whole(name, bytes);
  if (bytes.substr(0, kFirstLine.size()) != kFirstLine) whole.fail("does not begin as one that batten writes");
  bytes.remove_prefix(kFirstLine.size());
  if (bytes.size() < sizeof(std::uint64_t)) whole.fail("is cut short");
  const std::string_view content = bytes.substr(0, bytes.size() - sizeof(std::uint64_t));
  StateReader sum(name, bytes.substr(content.size()));
  if (sum.number<std::uint64_t>() != bytes_checksum(content)) whole.fail("is cut short or was changed");
  StateReader reader(name, content);
  ElasticRunState run;
  run.body = reader.number<std::uint64_t>();
  run.at_rest = reader.number<std::uint64_t>() != 0;
  const auto refined = reader.number<std::uint64_t>();
  for (std::uint64_t i = 0; i < refined; ++i) run.refined_at.push_back(reader.state());
  run.state = reader.state();
  if (!reader.at_end()) reader.fail("has more than a state");
  return run;
}

}  // namespace batten
