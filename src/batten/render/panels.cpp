#include "batten/render/panels.h"

#include <algorithm>

#include "batten/error.h"
#include "batten/render/canvas.h"

namespace batten {

using namespace render_detail;

Picture beside(const std::vector<Panel>& panels, const PictureStyle& style) {
  if (panels.empty()) throw Error(ErrorCode::BadArgument, "there are no pictures to put side by side");
  int width = 0;
  int height = 0;
  for (const Panel& panel : panels) {
    check_picture(panel.picture);
    width += panel.picture.width;
    height = std::max(height, panel.picture.height);
  }
  const double size = height / 34.0;
  Canvas canvas(width, height, style.transparent ? Canvas::Kind::Clear : Canvas::Kind::Picture);
  if (!style.transparent) canvas.fill(ink_of(style.background));
  int left = 0;
  for (const Panel& panel : panels) {
    canvas.paste(panel.picture, left, (height - panel.picture.height) / 2);
    canvas.text({left + 0.5 * panel.picture.width, height - 0.8 * size}, panel.caption,
                {size, text_ink(style), Align::Centre});
    left += panel.picture.width;
  }
  return canvas.picture();
}

}  // namespace batten
