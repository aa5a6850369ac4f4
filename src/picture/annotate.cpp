#include "picture/annotate.h"

#include <algorithm>
#include <array>

#include "core/format.h"
#include "picture/canvas.h"
#include "picture/draw_list.h"

namespace vantage::internal::picture {
namespace {

// In units of the font's size.
constexpr double kEdge = 1.1;                         // from the picture's edges to the writing
constexpr double kRow = 1.75;                         // from one baseline to the next
constexpr double kGap = 1.5;                          // between entries of the legend
constexpr double kMark = 1.15;                        // side of a legend's mark
constexpr double kArrow = 1.6;                        // half the length of the north arrow
constexpr double kTitleSize = 1.3;                    // of the title's letters
constexpr double kNoteSize = 0.88;                    // of the notes' letters
constexpr double kNoteRow = 1.2;                      // from one line of notes to the next
constexpr double kBar = 9.5;                          // the longest scale bar
constexpr double kBarRoom = 11, kLongBarRoom = 15.5;  // for it in the last row of the legend, with its writing

double font_size(int width, int height) { return std::max(9.0, 25 * std::min(width / 1600.0, height / 1200.0)); }

std::string percent(double share) {
  if (share > 0 && share < 0.005) return "<\u20091\u2009%";
  return core::format("{:.0f}\u2009%", 100 * share);
}

/// "200 m", "0.5 m", "2 km".
std::string length_text(double metres) {
  return metres >= 1000 ? core::format("{:g}\u2009km", metres / 1000) : core::format("{:g}\u2009m", metres);
}

const char* label_of(CauseKind kind) {
  switch (kind) {
    case CauseKind::scene:
      return "hidden by the scene";
    case CauseKind::range:
      return "out of range";
    case CauseKind::target_plane:
      return "plane of the target";
    case CauseKind::navigation:
      return "navigation limit";
    case CauseKind::sensor:
      return "sensor limit";
  }
  return "";
}

/// The legend in rows, and where the scale bar goes.
struct Layout {
  struct Item {
    std::size_t entry;
    double x;
    int row;
  };
  std::vector<Item> items;
  int rows = 1;
};

double entry_width(const Canvas& canvas, const LegendEntry& entry, double font) {
  double width = (kMark + 0.5) * font + canvas.width_of(entry.label);
  if (!entry.remark.empty()) width += 0.45 * font + canvas.width_of(entry.remark);
  return width;
}

Layout lay_out(Canvas& canvas, const Annotation& annotation, int width, double font) {
  canvas.set_font(font);
  Layout layout;
  double x = kEdge * font;
  const double right = width - kEdge * font;
  for (std::size_t i = 0; i < annotation.legend.size(); ++i) {
    const double wide = entry_width(canvas, annotation.legend[i], font);
    if (x > kEdge * font && x + wide > right) {
      x = kEdge * font;
      ++layout.rows;
    }
    layout.items.push_back({i, x, layout.rows - 1});
    x += wide + kGap * font;
  }
  if (x > right - (annotation.is_perspective ? kLongBarRoom : kBarRoom) * font) ++layout.rows;
  return layout;
}

/// Paper under the legend, with a soft border towards the picture.
void lay_paper(Canvas& canvas, const View& view, double top, double soft) {
  cairo_pattern_t* fade = cairo_pattern_create_linear(0, top, 0, top + soft);
  cairo_pattern_add_color_stop_rgba(fade, 0, 1, 1, 1, 0);
  cairo_pattern_add_color_stop_rgba(fade, 1, 1, 1, 1, 1);
  cairo_set_source(canvas.cairo(), fade);
  canvas.fill_rectangle(0, top, view.width, view.height - top);
  cairo_pattern_destroy(fade);
}

void draw_mark(Canvas& canvas, const LegendEntry& entry, double x, double baseline, double font) {
  const double side = kMark * font, y = baseline - 0.36 * font - 0.5 * side;
  cairo_set_line_width(canvas.cairo(), 0.07 * font);
  if (entry.mark == LegendEntry::Mark::line) {
    canvas.set_colour(entry.colour);
    cairo_set_line_width(canvas.cairo(), 0.1 * font);
    cairo_rectangle(canvas.cairo(), x, y + 0.1 * side, side, 0.8 * side);
    cairo_stroke(canvas.cairo());
    return;
  }
  canvas.set_colour(entry.colour, entry.mark == LegendEntry::Mark::film ? 0.55 : 1);
  canvas.fill_rectangle(x, y, side, side);
  canvas.set_colour(entry.mark == LegendEntry::Mark::film ? kCrease : kTargetOutline);
  cairo_rectangle(canvas.cairo(), x, y, side, side);
  cairo_stroke(canvas.cairo());
}

void draw_legend(Canvas& canvas, const Annotation& annotation, const Layout& layout, double last, double font) {
  for (const Layout::Item& item : layout.items) {
    const LegendEntry& entry = annotation.legend[item.entry];
    const double baseline = last - (layout.rows - 1 - item.row) * kRow * font;
    draw_mark(canvas, entry, item.x, baseline, font);
    const double x = item.x + (kMark + 0.5) * font;
    canvas.set_font(font);
    canvas.set_colour(kInk);
    canvas.show(entry.label, x, baseline);
    canvas.set_colour(kFaintInk);
    canvas.show(entry.remark, x + canvas.width_of(entry.label) + 0.45 * font, baseline);
  }
}

/// A bar of alternating halves, its length over it.
void draw_scale(Canvas& canvas, const Annotation& annotation, const View& view, double last, double font) {
  const double length = round_length(kBar * font / view.pixels_per_metre());
  const double wide = length * view.pixels_per_metre(), right = view.width - kEdge * font, thick = 0.24 * font;
  const double left = right - wide, top = last - thick;
  std::string label = length_text(length);
  if (annotation.is_perspective) label += " at the target";
  if (annotation.grid_m > 0) label += ", grid " + length_text(annotation.grid_m);

  for (int i = 0; i < 4; ++i) {
    canvas.set_colour(i % 2 == 0 ? kInk : kPaper);
    canvas.fill_rectangle(left + i * wide / 4, top, wide / 4, thick);
  }
  canvas.set_colour(kInk);
  cairo_set_line_width(canvas.cairo(), 0.06 * font);
  cairo_rectangle(canvas.cairo(), left, top, wide, thick);
  cairo_stroke(canvas.cairo());
  canvas.set_font(0.88 * font);
  canvas.show(label, std::min(left, right - canvas.width_of(label)), top - 0.42 * font);
}

/// A needle as it lies on the ground.
void draw_north(Canvas& canvas, const View& view, double font) {
  const Eigen::Vector2d flat(view.right.y(), -view.up.y());  // of a step to the north, right and down
  const double length = kArrow * font;
  const double room = (kEdge + kArrow + 1.25) * font;  // the letter beyond the tip included, wherever it points
  const Eigen::Vector2d centre(view.width - room, room);
  const double size = std::clamp(flat.norm(), 0.35, 1.0) * length;
  const Eigen::Vector2d along = flat.norm() > 1e-6 ? flat.normalized() : Eigen::Vector2d(0, -1);
  const Eigen::Vector2d across(-along.y(), along.x());
  const Eigen::Vector2d tip = centre + size * along, tail = centre - 0.75 * size * along,
                        waist = centre - 0.45 * size * along;
  const double half = 0.42 * font;
  for (const double side : {-1.0, 1.0}) {
    const Eigen::Vector2d corner = tail + side * half * across;
    cairo_move_to(canvas.cairo(), tip.x(), tip.y());
    cairo_line_to(canvas.cairo(), corner.x(), corner.y());
    cairo_line_to(canvas.cairo(), waist.x(), waist.y());
    cairo_close_path(canvas.cairo());
    canvas.set_colour(side < 0 ? kInk : kPaper);
    cairo_fill_preserve(canvas.cairo());
    canvas.set_colour(kInk);
    cairo_set_line_width(canvas.cairo(), 0.06 * font);
    cairo_set_line_join(canvas.cairo(), CAIRO_LINE_JOIN_ROUND);
    cairo_stroke(canvas.cairo());
  }
  canvas.set_font(font, true);
  const Eigen::Vector2d letter = tip + 0.75 * font * along;
  canvas.show_with_halo("N", letter.x() - 0.5 * canvas.width_of("N"), letter.y() + 0.36 * font);
}

/// The notes, broken between words into lines that are no wider than `room`.
std::vector<std::string> note_lines(Canvas& canvas, const Annotation& annotation, double room, double font) {
  constexpr std::size_t kMostLines = 6;
  canvas.set_font(kNoteSize * font);
  std::vector<std::string> lines;
  for (const std::string& note : annotation.notes) {
    std::string line = "!";
    for (std::size_t at = 0; at < note.size();) {
      const std::size_t end = std::min(note.find(' ', at), note.size());
      const std::string longer = line + " " + note.substr(at, end - at);
      if (canvas.width_of(longer) > room) {
        lines.push_back(line);
        line = "   " + note.substr(at, end - at);
      } else {
        line = longer;
      }
      at = end + 1;
    }
    lines.push_back(line);
  }
  if (lines.size() > kMostLines) {
    lines.resize(kMostLines);
    lines.back() += " \u2026";
  }
  return lines;
}

/// How wide a line under the title may be: the north arrow is beside it.
double title_width(int width, double font) { return width - (2 * kEdge + 4) * font; }

double title_room(const Annotation& annotation, std::size_t note_lines, double font) {
  if (annotation.title.empty() && annotation.subtitle.empty() && note_lines == 0) return 0;
  return (kEdge + kTitleSize * 0.8 + (annotation.subtitle.empty() ? 0 : 1.35) + 0.5) * font +
         static_cast<double>(note_lines) * kNoteRow * font;
}

void show_credit(Canvas& canvas, const std::string& credit, double baseline, double left, double room, double font) {
  canvas.set_font(kNoteSize * font);
  canvas.set_colour(kInk);
  canvas.show_with_halo(canvas.fitted(credit, room), left, baseline);
}

}  // namespace

std::vector<LegendEntry> legend_of(const PictureRequest& request) {
  using Mark = LegendEntry::Mark;
  std::vector<LegendEntry> legend;
  const std::size_t targets = request.others.size() + (request.target != nullptr ? 1 : 0);
  if (targets > 0) legend.push_back({Mark::solid, kTarget, targets > 1 ? "targets" : "target", ""});
  for (const PicturePath& path : request.paths) {
    legend.push_back({Mark::solid, kPath, path.label, ""});
    if (!path.marked.empty() && !path.marked_label.empty()) {
      legend.push_back({Mark::solid, kMarkedPath, path.marked_label, ""});
    }
  }
  const bool is_drawn = (request.volume != nullptr && !request.volume->mesh.triangles.empty()) ||
                        (request.solid != nullptr && !request.solid->triangles.empty());
  if (is_drawn && !request.marks.empty()) {
    legend.push_back({Mark::film, kPlainVolume, "volume", ""});
    for (std::size_t i = 0; i < request.marks.size(); ++i) {
      const MarkedFacets& marks = request.marks[i];
      if (marks.facets.empty()) continue;
      legend.push_back({Mark::solid, kMarks[i % kMarks.size()], marks.label, std::to_string(marks.facets.size())});
    }
  } else if (request.volume != nullptr && !request.volume->mesh.triangles.empty()) {
    std::array<double, 5> area{};  // by kind
    double total = 0;
    for (const Cause& cause : request.volume->causes) {
      area[static_cast<std::size_t>(cause.kind)] += cause.area_m2;
      total += cause.area_m2;
    }
    for (std::size_t kind = 0; kind < area.size(); ++kind) {
      if (area[kind] <= 0) continue;
      const auto cause = static_cast<CauseKind>(kind);
      legend.push_back({Mark::film, colour_of(cause), label_of(cause), percent(area[kind] / total)});
    }
    if (total <= 0) legend.push_back({Mark::film, kPlainVolume, "volume", ""});
  } else if (is_drawn) {
    legend.push_back({Mark::film, kPlainVolume, "volume", ""});
  }
  if (!request.solids.empty()) {
    legend.push_back({Mark::film, kSolids[0], request.solids.size() > 1 ? "volumes" : "volume", ""});
  }
  const Navigation& limits = request.navigation;
  if (!limits.keep_in.empty()) {
    const bool are_boxes =
        std::all_of(limits.keep_in.begin(), limits.keep_in.end(), [](const Zone& zone) { return zone.is_box; });
    const char* const several = are_boxes ? "navigable boxes" : "navigable zones";
    const char* const one = are_boxes ? "navigable box" : "navigable zone";
    legend.push_back({Mark::line, kBox, limits.keep_in.size() == 1 ? one : several, ""});
  }
  if (!limits.keep_out.empty()) legend.push_back({Mark::line, kKeepOut, "keep out", ""});
  return legend;
}

Insets insets_of(const Annotation& annotation, int width, int height) {
  const double font = font_size(width, height);
  Canvas canvas(1, 1);
  const Layout layout = lay_out(canvas, annotation, width, font);
  const std::size_t notes = note_lines(canvas, annotation, title_width(width, font), font).size();
  const double credit = annotation.credit.empty() ? 0 : kRow;
  return {font, std::max(title_room(annotation, notes, font), 0.8 * font), font,
          (kEdge + 1.0 + (layout.rows - 1) * kRow + credit + 0.9) * font};
}

Picture credited(const Picture& picture, const std::string& credit) {
  if (credit.empty()) return picture;
  const double font = font_size(picture.width, picture.height);
  Canvas canvas(picture);
  show_credit(canvas, credit, picture.height - 0.6 * font, 0.6 * font, picture.width - 1.2 * font, font);
  return canvas.picture();
}

Picture annotated(const Picture& picture, const Annotation& annotation, const View& view) {
  const double font = font_size(picture.width, picture.height);
  Canvas canvas(picture);
  const Layout layout = lay_out(canvas, annotation, picture.width, font);
  const Insets insets = insets_of(annotation, picture.width, picture.height);
  const double last = picture.height - kEdge * font;  // the lowest baseline

  const double strip = picture.height - insets.bottom;
  lay_paper(canvas, view, strip, 0.8 * font);

  draw_legend(canvas, annotation, layout, last, font);
  if (!annotation.credit.empty()) {
    show_credit(canvas, annotation.credit, last - layout.rows * kRow * font, kEdge * font,
                picture.width - 2 * kEdge * font, font);
  }
  draw_scale(canvas, annotation, view, last, font);
  draw_north(canvas, view, font);

  const double room = title_width(picture.width, font);
  double baseline = (kEdge + 0.8 * kTitleSize) * font;
  canvas.set_font(kTitleSize * font, true);
  canvas.set_colour(kInk);
  canvas.show_with_halo(canvas.fitted(annotation.title, room), kEdge * font, baseline);
  baseline += 1.4 * font;
  canvas.set_font(font);
  canvas.set_colour(kFaintInk);
  canvas.show_with_halo(canvas.fitted(annotation.subtitle, room), kEdge * font, baseline);
  baseline += 0.15 * font;
  const std::vector<std::string> notes = note_lines(canvas, annotation, room, font);
  canvas.set_font(kNoteSize * font);
  canvas.set_colour(kTarget);
  for (const std::string& line : notes) {
    baseline += kNoteRow * font;
    canvas.show_with_halo(canvas.fitted(line, room), kEdge * font, baseline);
  }
  return canvas.picture();
}

}  // namespace vantage::internal::picture
