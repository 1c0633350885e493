/// \file Statements of a USD text file.
#pragma once
#include <set>
#include <string>
#include <string_view>

#include "batten/io/text_output.h"

namespace batten::io {

/// A name that USD allows (letters, digits, underscores; no digit first) and that is not in `taken`, made from any
/// text. It is added to `taken`.
std::string usda_identifier(const std::string& text, std::set<std::string>& taken);

/// Writes statements `indent type name = ["value"]`, one for each call.
class UsdaWriter {
 public:
  explicit UsdaWriter(OutputFile& file) : file_(file) {}

  void line(const std::string& text) { file_.write(indent_ + text + "\n"); }
  void open(const std::string& head) {
    line(head);
    line("{");
    indent_ += "    ";
  }
  void close() {
    indent_.resize(indent_.size() - 4);
    line("}");
  }

  /// Writes an array of put(text, i) for i in [0, count), separated by commas; nothing for an empty array. `metadata`
  /// is empty or what follows in brackets.
  template <typename Put>
  void array(const std::string& declaration, std::ptrdiff_t count, const Put& put, const std::string& metadata = "") {
    if (count == 0) return;
    file_.write(indent_ + declaration + " = [");
    write_rows<TextBuffer>(file_, count, [&](TextBuffer& out, std::ptrdiff_t i) {
      if (i > 0) out.put(std::string_view(", "));
      put(out, i);
    });
    if (metadata.empty()) {
      file_.write("]\n");
      return;
    }
    file_.write("] (\n" + indent_ + "    " + metadata + "\n" + indent_ + ")\n");
  }

  /// Appends "(x, y, z)", or the number alone.
  template <typename Row>
  static void put_tuple(TextBuffer& out, const Row& row) {
    if (row.size() == 1) {
      out.put(double{row[0]});
      return;
    }
    for (Eigen::Index k = 0; k < row.size(); ++k) out.put(std::string_view(k == 0 ? "(" : ", ")).put(double{row[k]});
    out.put(')');
  }

 private:
  OutputFile& file_;
  std::string indent_;
};

}  // namespace batten::io
