#include "batten/render/panels.h"

#include <algorithm>
#include <cmath>

#include "batten/error.h"
#include "batten/render/canvas.h"

namespace batten {

using namespace render_detail;

namespace {

/// A row of panels [first, last).
struct Row {
  std::size_t first;
  std::size_t last;
  int width = 0;
  int height = 0;  ///< of the pictures
  int below = 0;   ///< for captions
};

std::vector<Row> rows_of(const std::vector<Panel>& panels, std::size_t columns, const PictureStyle& style) {
  std::vector<Row> rows;
  for (std::size_t first = 0; first < panels.size(); first += columns) {
    Row row{first, std::min(first + columns, panels.size())};
    for (std::size_t i = row.first; i < row.last; ++i) {
      check_picture(panels[i].picture);
      row.width += panels[i].picture.width;
      row.height = std::max(row.height, panels[i].picture.height);
      if (!panels[i].caption.empty()) row.below = caption_height(style);
    }
    rows.push_back(row);
  }
  return rows;
}

void draw_caption(Canvas& canvas, const Panel& panel, const Spot& foot, double size, const PictureStyle& style) {
  constexpr double kMostWidth = 0.96;
  TextStyle text{size, text_ink(style), Align::Centre};
  const double width = canvas.text_width(panel.caption, text);
  text.size *= std::min(1.0, kMostWidth * panel.picture.width / std::max(width, 1.0));
  canvas.text(foot - Spot(0.0, 0.8 * size), panel.caption, text);
}

}  // namespace

Picture beside(const std::vector<Panel>& panels, const PictureStyle& style) {
  return in_rows(panels, static_cast<int>(std::max<std::size_t>(panels.size(), 1)), style);
}

int caption_height(const PictureStyle& style) { return static_cast<int>(std::lround(1.7 * style.text_size)); }

Picture in_rows(const std::vector<Panel>& panels, int columns, const PictureStyle& style) {
  if (panels.empty()) throw Error(ErrorCode::BadArgument, "there are no pictures to put side by side");
  if (columns < 1) throw Error(ErrorCode::BadArgument, "a row needs at least one picture");
  const std::vector<Row> rows = rows_of(panels, static_cast<std::size_t>(columns), style);
  int width = 0;
  int height = 0;
  for (const Row& row : rows) {
    width = std::max(width, row.width);
    height += row.height + row.below;
  }
  Canvas canvas(width, height, style.transparent ? Canvas::Kind::Clear : Canvas::Kind::Picture);
  if (!style.transparent) canvas.fill(ink_of(style.background));
  int top = 0;
  for (const Row& row : rows) {
    const double size = style.text_size > 0.0 ? style.text_size : row.height / 34.0;
    int left = (width - row.width) / 2;
    for (std::size_t i = row.first; i < row.last; ++i) {
      const Picture& picture = panels[i].picture;
      canvas.paste(picture, left, top + (row.height - picture.height) / 2);
      draw_caption(canvas, panels[i], {left + 0.5 * picture.width, double{1} * (top + row.height + row.below)}, size,
                   style);
      left += picture.width;
    }
    top += row.height + row.below;
  }
  return canvas.picture();
}

}  // namespace batten
