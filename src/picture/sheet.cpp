// Pictures side by side, as in a paper.
#include <algorithm>
#include <cmath>

#include "picture/canvas.h"
#include "vantage/error.h"
#include "vantage/picture.h"

namespace vantage {
namespace {

using namespace internal::picture;

void check(const std::vector<PicturePanel>& panels, int columns) {
  if (panels.empty())
    throw Error(ErrorCode::nothing_given, "a figure sheet without panels", "panels", "pass one at least");
  if (columns < 1) {
    throw Error(ErrorCode::value_out_of_range, "a figure sheet of " + std::to_string(columns) + " columns", "columns",
                "pass 1 or more");
  }
  for (std::size_t i = 1; i < panels.size(); ++i) {
    if (panels[i].picture.width == panels[0].picture.width && panels[i].picture.height == panels[0].picture.height)
      continue;
    throw Error(ErrorCode::array_sizes_differ, "the panels of a figure sheet differ in size",
                "panel " + std::to_string(i), "draw all in the first's size");
  }
}

/// "(a)", ..., "(z)", "(27)".
std::string letter(std::size_t index) {
  std::string text = "(";
  text += index < 26 ? std::string(1, static_cast<char>('a' + index)) : std::to_string(index + 1);
  return text += ")";
}

}  // namespace

Picture arrange_sheet(const std::vector<PicturePanel>& panels, int columns, const std::string& title,
                      const std::string& subtitle) {
  check(panels, columns);
  const int wide = panels[0].picture.width, high = panels[0].picture.height;
  const auto count = static_cast<int>(panels.size());
  columns = std::min(columns, count);
  const int rows = (count + columns - 1) / columns;
  const double font = std::max(9.0, 0.045 * wide);
  const auto pixels = [&](double fonts) { return static_cast<int>(std::lround(fonts * font)); };
  const int edge = pixels(1), gap = pixels(0.8), caption = pixels(2.1);
  const int head = title.empty() ? 0 : pixels(subtitle.empty() ? 2.2 : 3.8);

  Canvas canvas(2 * edge + columns * wide + (columns - 1) * gap, 2 * edge + head + rows * (high + caption + gap) - gap);
  canvas.set_colour(kInk);
  canvas.set_font(1.25 * font, true);
  const double room = columns * wide + (columns - 1) * gap;
  canvas.show(canvas.fitted(title, room), edge, edge + font);
  canvas.set_font(font);
  canvas.set_colour(kFaintInk);
  canvas.show(canvas.fitted(subtitle, room), edge, edge + 2.5 * font);
  for (int i = 0; i < count; ++i) {
    const PicturePanel& panel = panels[static_cast<std::size_t>(i)];
    const int x = edge + i % columns * (wide + gap), y = edge + head + i / columns * (high + caption + gap);
    canvas.place(panel.picture, x, y);
    canvas.set_colour(kGridLine);
    cairo_set_line_width(canvas.cairo(), 1);
    cairo_rectangle(canvas.cairo(), x + 0.5, y + 0.5, wide - 1, high - 1);
    cairo_stroke(canvas.cairo());

    const double baseline = y + high + 1.35 * font;
    const std::string mark = letter(static_cast<std::size_t>(i));
    canvas.set_colour(kInk);
    canvas.set_font(font, true);
    canvas.show(mark, x, baseline);
    const double after = canvas.width_of(mark) + 0.4 * font;
    canvas.set_font(font);
    canvas.show(canvas.fitted(panel.caption, wide - after), x + after, baseline);
  }
  return canvas.picture();
}

}  // namespace vantage
