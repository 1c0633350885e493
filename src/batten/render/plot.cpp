#include "batten/render/plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "batten/error.h"
#include "batten/output.h"
#include "batten/render/canvas.h"
#include "batten/render/ticks.h"

namespace batten {
namespace {

using namespace render_detail;

// Okabe and Ito's colours for colour-blind readers (2008, jfly.uni-koeln.de/color) without the yellow.
constexpr std::array<unsigned, 7> kPalette{0x0072B2, 0xD55E00, 0x009E73, 0xCC79A7, 0xE69F00, 0x56B4E9, 0x000000};
constexpr Ink kPaper = ink(0xFAFAF9);
constexpr Ink kText = ink(0x2B2F36);
constexpr Ink kSoftText = ink(0x5B616B);
constexpr Ink kGrid = ink(0xE1E3E6);
constexpr Ink kAxis = ink(0x9AA0A8);
constexpr Ink kReference = ink(0x7A808A);
constexpr double kDotSpacing = 24.0;  // lines with closer points are drawn without dots

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  bool empty() const { return low > high; }
  double length() const { return high - low; }
};

struct Box {
  Spot low;   ///< top left
  Spot high;  ///< bottom right
  bool meets(const Box& other) const {
    return (low.array() < other.high.array()).all() && (other.low.array() < high.array()).all();
  }
  bool holds(const Box& other) const {
    return (low.array() <= other.low.array()).all() && (other.high.array() <= high.array()).all();
  }
  /// True if a segment passes through the box (Liang and Barsky's clipping).
  bool meets(const Spot& a, const Spot& b) const {
    double enter = 0.0;
    double leave = 1.0;
    for (int axis = 0; axis < 2; ++axis) {
      const double way = b[axis] - a[axis];
      if (way == 0.0) {
        if (a[axis] <= low[axis] || a[axis] >= high[axis]) return false;
        continue;
      }
      const double first = (low[axis] - a[axis]) / way;
      const double second = (high[axis] - a[axis]) / way;
      enter = std::max(enter, std::min(first, second));
      leave = std::min(leave, std::max(first, second));
    }
    return enter < leave;
  }
};

/// A line's connected pieces in pixels.
struct DrawnLine {
  std::vector<std::vector<Spot>> pieces;
  Ink ink;
  std::optional<Box> name_place;

  /// True if the points are on average farther apart than `spacing`.
  bool has_dots(double spacing) const {
    double length = 0.0;
    std::size_t gaps = 0;
    for (const std::vector<Spot>& piece : pieces) {
      for (std::size_t i = 1; i < piece.size(); ++i, ++gaps) length += (piece[i] - piece[i - 1]).norm();
    }
    return length >= spacing * static_cast<double>(gaps);
  }
};

class Drawing {
 public:
  Drawing(const Plot& plot, int width, int height, Canvas& canvas)
      : plot_(plot), canvas_(canvas), width_(width), height_(height), unit_(std::min(width / 1280.0, height / 800.0)) {
    measure();
    lay_out(false);
    if (!place_names()) lay_out(true);
  }

  void draw() {
    canvas_.fill(kPaper);
    draw_axes();
    for (std::size_t i = 0; i < lines_.size(); ++i) draw_line(plot_.lines[i], lines_[i]);
    if (has_legend_) {
      draw_legend();
    } else {
      draw_names();
    }
  }

 private:
  bool shown(double y) const { return std::isfinite(y) && (!log_ || y > 0.0); }

  void measure() {
    for (const PlotLine& line : plot_.lines) {
      for (const double y : line.y) log_ = log_ || (plot_.log_y && std::isfinite(y) && y > 0.0);
    }
    for (const PlotLine& line : plot_.lines) {
      for (std::size_t i = 0; i < line.x.size(); ++i) {
        if (!shown(line.y[i])) continue;
        x_.add(line.x[i]);
        y_.add(line.y[i]);
      }
    }
    if (x_.empty()) throw Error(ErrorCode::BadArgument, "the plot has no point that can be drawn");
    if (x_.length() == 0.0) x_ = {x_.low - 0.5, x_.high + 0.5};
    if (log_) {
      const double low = std::floor(std::log10(y_.low) + 1e-9);
      const double high = std::max(std::ceil(std::log10(y_.high) - 1e-9), low + 1.0);
      y_ = {std::pow(10.0, std::max(low, -307.0)), std::pow(10.0, std::min(high, 308.0))};
    } else {
      const double pad = y_.length() > 0.0 ? 0.06 * y_.length() : std::max(0.5 * std::abs(y_.low), 0.5);
      const bool on_zero = y_.low >= 0.0 && y_.low < 0.3 * y_.high;
      y_ = {on_zero ? 0.0 : y_.low - pad, y_.high + pad};
    }
  }

  void lay_out(bool legend) {
    has_legend_ = legend;
    title_ = {26 * unit_, kText, Align::Left, true};
    tick_ = {19 * unit_, kSoftText};
    label_ = {20 * unit_, kSoftText};
    name_ = {20 * unit_, kText};
    x_ticks_ = linear_ticks(x_.low, x_.high, 7);
    y_ticks_ = log_ ? log_ticks(y_.low, y_.high, 7) : linear_ticks(y_.low, y_.high, 6);
    double tick_width = 0.0;
    for (const Tick& tick : y_ticks_) tick_width = std::max(tick_width, canvas_.text_width(tick.text, tick_));
    double name_width = 0.0;
    for (const PlotLine& line : plot_.lines) {
      const bool at_right = !line.x.empty() && line.x.back() > x_.high - 0.15 * x_.length();
      if (legend || at_right) name_width = std::max(name_width, canvas_.text_width(line.name, name_));
    }
    const double edge = 36 * unit_;
    area_.low = {edge + tick_width + 12 * unit_,
                 edge + (plot_.title.empty() ? 0.0 : 44 * unit_) + (plot_.y_label.empty() ? 0.0 : 44 * unit_)};
    area_.high = {width_ - edge - (name_width > 0.0 ? name_width + (legend ? kSwatch : 0.0) * unit_ : 0.0),
                  height_ - edge - 30 * unit_ - (plot_.x_label.empty() ? 0.0 : 34 * unit_)};
    place_lines();
  }

  Spot spot(double x, double y) const {
    const auto level = [&](double value) { return log_ ? std::log10(value) : value; };
    const double across = (x - x_.low) / x_.length();
    const double up = (level(y) - level(y_.low)) / (level(y_.high) - level(y_.low));
    return {area_.low.x() + across * (area_.high.x() - area_.low.x()),
            area_.high.y() - up * (area_.high.y() - area_.low.y())};
  }

  void place_lines() {
    std::size_t color = 0;
    lines_.clear();
    for (const PlotLine& line : plot_.lines) {
      DrawnLine drawn;
      drawn.ink = line.reference ? kReference : ink(kPalette[color++ % kPalette.size()]);
      bool joined = false;
      for (std::size_t i = 0; i < line.x.size(); ++i) {
        if (shown(line.y[i])) {
          if (!joined) drawn.pieces.emplace_back();
          drawn.pieces.back().push_back(spot(line.x[i], line.y[i]));
        }
        joined = shown(line.y[i]);
      }
      lines_.push_back(std::move(drawn));
    }
  }

  void draw_axes() {
    const double edge = 36 * unit_;
    double row = edge;
    if (!plot_.title.empty()) {
      row += 22 * unit_;
      canvas_.text({edge, row}, plot_.title, title_);
      row += 22 * unit_;
    }
    if (!plot_.y_label.empty()) canvas_.text({edge, row + 16 * unit_}, plot_.y_label, label_);
    TextStyle right = tick_;
    right.align = Align::Right;
    for (const Tick& tick : y_ticks_) {
      const double y = spot(x_.low, tick.value).y();
      canvas_.line({{area_.low.x(), y}, {area_.high.x(), y}}, {1.5 * unit_, kGrid});
      canvas_.text({area_.low.x() - 12 * unit_, y + 0.36 * tick_.size}, tick.text, right);
    }
    canvas_.line({{area_.low.x(), area_.high.y()}, area_.high}, {1.5 * unit_, kAxis});
    TextStyle centred = tick_;
    centred.align = Align::Centre;
    for (const Tick& tick : x_ticks_) {
      const double x = spot(tick.value, y_.low).x();
      canvas_.line({{x, area_.high.y()}, {x, area_.high.y() + 7 * unit_}}, {1.5 * unit_, kAxis});
      canvas_.text({x, area_.high.y() + 28 * unit_}, tick.text, centred);
    }
    TextStyle centred_label = label_;
    centred_label.align = Align::Centre;
    canvas_.text({0.5 * (area_.low.x() + area_.high.x()), height_ - edge}, plot_.x_label, centred_label);
  }

  void draw_line(const PlotLine& line, const DrawnLine& drawn) {
    const Stroke stroke = line.reference ? Stroke{1.8 * unit_, drawn.ink, 8 * unit_} : Stroke{3 * unit_, drawn.ink};
    for (const std::vector<Spot>& piece : drawn.pieces) canvas_.line(piece, stroke);
    if (line.reference || !drawn.has_dots(kDotSpacing * unit_)) return;
    for (const std::vector<Spot>& piece : drawn.pieces) {
      for (const Spot& point : piece) {
        canvas_.disc(point, 6.5 * unit_, kPaper);
        canvas_.disc(point, 4.5 * unit_, drawn.ink);
      }
    }
  }

  bool is_free(const Box& box, const std::vector<Box>& taken) const {
    const Box page{{area_.low.x(), area_.low.y() - 24 * unit_}, {static_cast<double>(width_), area_.high.y()}};
    if (!page.holds(box)) return false;
    for (const Box& other : taken) {
      if (box.meets(other)) return false;
    }
    for (const DrawnLine& line : lines_) {
      for (const std::vector<Spot>& piece : line.pieces) {
        for (std::size_t i = 0; i + 1 < piece.size(); ++i) {
          if (box.meets(piece[i], piece[i + 1])) return false;
        }
      }
    }
    return true;
  }

  /// A free place for a name beside the end of its line.
  std::optional<Box> free_place(const Spot& end, const Spot& size, const std::vector<Box>& taken) const {
    const double gap = 14 * unit_;
    std::vector<Spot> places;  // top left corners of the box
    for (const double shift : {0.0, -0.6, 0.6, -1.2, 1.2})
      places.emplace_back(end.x() + gap, end.y() + (shift - 0.5) * size.y());
    for (const double along : {0.0, 0.5, 1.0}) {
      places.emplace_back(end.x() - along * size.x(), end.y() - gap - size.y());
      places.emplace_back(end.x() - along * size.x(), end.y() + gap);
    }
    for (const Spot& place : places) {
      const Box box{place, place + size};
      if (is_free(box, taken)) return box;
    }
    return {};
  }

  /// Places names beside the lines' ends. Returns false if one has no room.
  bool place_names() {
    std::vector<Box> taken;
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      const std::string& name = plot_.lines[i].name;
      if (name.empty() || lines_[i].pieces.empty()) continue;
      const Spot size(canvas_.text_width(name, name_), 1.3 * name_.size);
      const std::optional<Box> place = free_place(lines_[i].pieces.back().back(), size, taken);
      if (!place) return false;
      taken.push_back(*place);
      lines_[i].name_place = place;
    }
    return true;
  }

  void draw_names() {
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      if (!lines_[i].name_place) continue;
      const Spot at = lines_[i].name_place->low + Spot(0.0, 0.98 * name_.size);
      canvas_.text(at, plot_.lines[i].name, {name_.size, lines_[i].ink});
    }
  }

  void draw_legend() {
    double y = area_.low.y() + 8 * unit_;
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      const PlotLine& line = plot_.lines[i];
      if (line.name.empty()) continue;
      const double x = area_.high.x() + 16 * unit_;
      const Stroke stroke =
          line.reference ? Stroke{1.8 * unit_, lines_[i].ink, 8 * unit_} : Stroke{4 * unit_, lines_[i].ink};
      canvas_.line({{x, y}, {x + 28 * unit_, y}}, stroke);
      canvas_.text({x + 38 * unit_, y + 0.36 * name_.size}, line.name, name_);
      y += 32 * unit_;
    }
  }

  static constexpr double kSwatch = 56;  ///< the width of a legend's line and gaps, besides the names
  const Plot& plot_;
  Canvas& canvas_;
  int width_;
  int height_;
  double unit_;
  bool log_ = false;
  bool has_legend_ = false;
  Range x_;
  Range y_;
  Box area_;  ///< the area between the axes
  TextStyle title_;
  TextStyle tick_;
  TextStyle label_;
  TextStyle name_;
  std::vector<Tick> x_ticks_;
  std::vector<Tick> y_ticks_;
  std::vector<DrawnLine> lines_;
};

Canvas drawn(const Plot& plot, int width, int height, Canvas::Kind kind) {
  constexpr int kSmallestSide = 200;
  constexpr int kLargestSide = 16384;
  if (std::min(width, height) < kSmallestSide || std::max(width, height) > kLargestSide)
    throw Error(ErrorCode::BadArgument, "a plot's width and height must be 200 to 16384 pixels");
  for (const PlotLine& line : plot.lines) {
    if (line.x.size() != line.y.size())
      throw Error(ErrorCode::BadShape, "the plot's line '" + line.name + "' needs as many x as y");
    if (!std::all_of(line.x.begin(), line.x.end(), [](double x) { return std::isfinite(x); }))
      throw Error(ErrorCode::NotFinite, "the plot's line '" + line.name + "' has an x that is not finite");
  }
  Canvas canvas(width, height, kind);
  Drawing(plot, width, height, canvas).draw();
  return canvas;
}

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

}  // namespace

Picture draw_plot(const Plot& plot, int width, int height) {
  return drawn(plot, width, height, Canvas::Kind::Picture).picture();
}

Buffer<unsigned char> encode_svg(const Plot& plot, int width, int height) {
  return drawn(plot, width, height, Canvas::Kind::Svg).svg();
}

void write_plot(const std::string& path, const Plot& plot) {
  if (ends_with(path, ".svg")) return write_bytes(path, encode_svg(plot));
  if (ends_with(path, ".png")) return write_bytes(path, encode_png(draw_plot(plot)));
  throw Error(ErrorCode::UnknownFormat, path + ": plots are written as .png or .svg");
}

}  // namespace batten
