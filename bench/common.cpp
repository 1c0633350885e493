/// Functions that all benches share.
#include <malloc.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <fstream>
#include <iomanip>
#include <map>
#include <sstream>
#include <stdexcept>

#include "batten/parallel/parallel.h"
#include "bench/bench.h"

namespace batten::bench {

namespace {

#ifdef __clang__
constexpr const char* kCompiler = __VERSION__;
#else
constexpr const char* kCompiler = "g++ " __VERSION__;
#endif

}  // namespace

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::vector<double> in_turn(const std::vector<std::function<void()>>& works, int rounds) {
  std::vector<std::vector<double>> seconds(works.size());
  for (int round = -1; round < rounds; ++round) {
    for (std::size_t i = 0; i < works.size(); ++i) {
      const double taken = seconds_of(works[i]);
      if (round >= 0) seconds[i].push_back(taken);
    }
  }
  std::vector<double> medians;
  for (const std::vector<double>& each : seconds) medians.push_back(median(each));
  return medians;
}

MarkdownTable::MarkdownTable(const std::vector<std::string>& header) {
  add(header);
  add(std::vector<std::string>(header.size(), "---"));
}

void MarkdownTable::add(const std::vector<std::string>& row) {
  text_ += "|";
  for (const std::string& cell : row) text_ += " " + cell + " |";
  text_ += "\n";
}

std::string number(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

double number_after(const std::string& path, const std::string& key) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  const std::size_t place = text.str().find(key);
  if (place == std::string::npos) throw std::runtime_error(path + " says nothing of " + key);
  return std::stod(text.str().substr(place + key.size()));
}

double peak_growth(const std::function<void()>& work) {
  malloc_trim(0);                                 // memory freed earlier must not be reused
  std::ofstream("/proc/self/clear_refs") << "5";  // resets the high-water mark
  const double before = number_after("/proc/self/status", "VmRSS:");
  work();
  return 1024.0 * (number_after("/proc/self/status", "VmHWM:") - before);
}

void write_part(const std::string& page, const std::string& command, const std::string& text) {
  const auto mark = [](const std::string& of) {
    return "<!-- ./batten bench" + (of.empty() ? "" : " " + of) + " -->\n";
  };
  const std::string head =
      "# Performance\n\n    ./batten bench            # Batten itself, and the papers' iterations\n"
      "    ./batten bench peers      # beside OpenSubdiv, OpenMesh, CGAL and VTK\n\n"
      "These two commands write the tables below: medians of repeated runs, the programs in turn in the same process. "
      "Compare numbers within a table only: a shared machine is faster at one\ntime and slower at another. \"Build\" "
      "makes an operator from a mesh, once; \"solve\" and \"query\" use it. `1.02e+03` means 1,020.\n\n";
  std::map<std::string, std::string> parts;
  std::ifstream file(page);
  std::string* part = nullptr;
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("<!-- ./batten bench", 0) == 0) {
      part = &parts[line + "\n"];
    } else if (part != nullptr) {
      *part += line + "\n";
    }
  }
  parts[mark(command)] = text;
  std::ofstream out(page);
  out << head;
  for (const auto& [marked, said] : parts) out << marked << said;
}

std::string machine() {
  std::ifstream cpu("/proc/cpuinfo");
  std::string model = "an unknown processor";
  for (std::string line; std::getline(cpu, line);) {
    if (line.rfind("model name", 0) != 0) continue;
    model = line.substr(line.find(':') + 2);
    break;
  }
  const std::size_t bytes = std::size_t{1} << 28;
  Buffer<char> from(bytes, 1);
  Buffer<char> to(bytes, 2);
  const auto copy = [&] {
    parallel_for(
        static_cast<std::ptrdiff_t>(bytes),
        [&](std::ptrdiff_t begin, std::ptrdiff_t end) { std::memcpy(&to[begin], &from[begin], end - begin); }, 1 << 22);
  };
  const double both =
      median({seconds_of(copy), seconds_of(copy), seconds_of(copy), seconds_of(copy), seconds_of(copy)});
  const ThreadLimit limit(1);
  const double one = median({seconds_of(copy), seconds_of(copy), seconds_of(copy), seconds_of(copy), seconds_of(copy)});
  std::ostringstream text;
  const std::time_t now = std::time(nullptr);
  text << "Measured on " << std::put_time(std::gmtime(&now), "%Y-%m-%d") << ". Machine: " << model << ", " << kCompiler
       << ", copy (read and write counted) " << number(2e-9 * bytes / one) << " GB/s on one thread, "
       << number(2e-9 * bytes / both) << " on all.\n";
  return text.str();
}

}  // namespace batten::bench
