// The profile of a flight: height over the way, the scene below, and what happens along it in strips.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "core/format.h"
#include "core/progress_reporter.h"
#include "picture/canvas.h"
#include "picture/draw_list.h"
#include "picture/occlusion_rays.h"
#include "picture/palette.h"
#include "vantage/error.h"
#include "vantage/picture.h"

namespace vantage {
namespace {

using namespace internal::picture;

constexpr double kChart = 0.2;                                       // height of the chart over the picture's width
constexpr double kStripRow = 1.3, kEdgeRoom = 0.9, kAxisRoom = 3.2;  // in units of the font's size
constexpr double kLabelShare = 0.16;                                 // of the width, for names at the left
constexpr int kTicks = 5;                                            // or so, of each axis
constexpr double kAboveFlight = 1;  // metres over all: from there the scene is looked up

double font_of(int width) { return std::max(9.0, width / 75.0); }

void check(const ProfileRequest& request) {
  if (request.points.size() < 2) {
    throw Error(ErrorCode::nothing_given, "a profile of a flight that has no legs", "points",
                "pass two points or more");
  }
  const auto is_finite = [](const Vec3& point) { return point.allFinite(); };
  if (!std::all_of(request.points.begin(), request.points.end(), is_finite)) {
    throw Error(ErrorCode::coordinate_not_finite, "a point of the flight is not finite", "points",
                "pass finite coordinates");
  }
  for (const ProfileStrip& strip : request.strips) {
    for (const std::array<double, 2>& span : strip.spans_m) {
      if (std::isfinite(span[0]) && std::isfinite(span[1])) continue;
      throw Error(ErrorCode::value_out_of_range, "a span of '" + strip.label + "' is not finite", "strips",
                  "pass metres along the flight");
    }
  }
  if (request.width < kSmallestPicture || request.width > kLargestPicture) {
    throw Error(ErrorCode::value_out_of_range, "a picture cannot be " + std::to_string(request.width) + " pixels wide",
                "width",
                "take " + std::to_string(kSmallestPicture) + " to " + std::to_string(kLargestPicture) + " pixels");
  }
}

/// How far along the flight each of its points is.
std::vector<double> distances(const std::vector<Vec3>& points) {
  std::vector<double> along{0};
  for (std::size_t i = 1; i < points.size(); ++i) along.push_back(along.back() + (points[i] - points[i - 1]).norm());
  return along;
}

Vec3 position_at(const ProfileRequest& request, const std::vector<double>& along, double at_m) {
  const auto next = std::upper_bound(along.begin(), along.end(), at_m);
  if (next == along.end()) return request.points.back();
  const auto i = static_cast<std::size_t>(next - along.begin());
  if (i == 0) return request.points.front();
  const double t = (at_m - along[i - 1]) / (along[i] - along[i - 1]);
  return request.points[i - 1] + t * (request.points[i] - request.points[i - 1]);
}

/// z of the triangle over a place in plan; of an upright one that of its highest vertex.
double height_at(const Mesh& mesh, std::uint32_t triangle, const Vec3& place) {
  const Triangle& t = mesh.triangles[triangle];
  const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
  const double high = std::max({a.z(), b.z(), c.z()}), low = std::min({a.z(), b.z(), c.z()});
  const Vec3 normal = (b - a).cross(c - a);
  if (normal.z() == 0) return high;
  return std::clamp(a.z() - (normal.x() * (place.x() - a.x()) + normal.y() * (place.y() - a.y())) / normal.z(), low,
                    high);
}

/// The highest surface of the scene for each column; NaN where there is none.
std::vector<double> skyline(const Scene& scene, const ProfileRequest& request, const std::vector<double>& along,
                            int columns, const internal::core::ProgressReporter& progress) {
  std::vector<double> heights(static_cast<std::size_t>(columns), std::numeric_limits<double>::quiet_NaN());
  if (scene.mesh.triangles.empty()) return heights;
  const double top = bounding_box(scene.mesh).max.z() + kAboveFlight;
  const OcclusionRays rays(scene.mesh, request.points.front(), progress.part(0, 0));
  for (int i = 0; i < columns; ++i) {
    progress.check();
    Vec3 place = position_at(request, along, along.back() * (i + 0.5) / columns);
    place.z() = top;
    rays.each_hit(place, -Vec3::UnitZ(), true, [&](std::uint32_t triangle) {
      heights[static_cast<std::size_t>(i)] = height_at(scene.mesh, triangle, place);
      return false;
    });
  }
  return heights;
}

/// Where the chart lies, and what is in it.
struct Frame {
  double left = 0, right = 0, top = 0, bottom = 0;  // pixels
  double low = 0, high = 1, length = 1;             // metres

  double x(double along_m) const { return left + (right - left) * along_m / length; }
  double y(double z) const { return bottom - (bottom - top) * (z - low) / (high - low); }
};

void range_of_heights(Frame& frame, const ProfileRequest& request, const std::vector<double>& below) {
  frame.low = std::numeric_limits<double>::infinity();
  frame.high = -frame.low;
  for (const Vec3& point : request.points) {
    frame.low = std::min(frame.low, point.z());
    frame.high = std::max(frame.high, point.z());
  }
  for (const double z : below) {
    if (std::isnan(z)) continue;
    frame.low = std::min(frame.low, z);
    frame.high = std::max(frame.high, z);
  }
  const double room = std::max(0.08 * (frame.high - frame.low), 1.0);
  frame.low -= room;
  frame.high += room;
}

void draw_skyline(Canvas& canvas, const Frame& frame, const std::vector<double>& below) {
  canvas.set_colour(kGridLine);
  const double wide = (frame.right - frame.left) / static_cast<double>(below.size());
  for (std::size_t i = 0; i < below.size(); ++i) {
    if (std::isnan(below[i])) continue;
    const double y = frame.y(below[i]);
    canvas.fill_rectangle(frame.left + static_cast<double>(i) * wide, y, wide + 0.5, frame.bottom - y);
  }
}

std::string tick_text(double value) { return internal::core::format("{:g}", std::abs(value) < 1e-9 ? 0.0 : value); }

void draw_axes(Canvas& canvas, const Frame& frame, const ProfileRequest& request, double font) {
  cairo_t* const cairo = canvas.cairo();
  canvas.set_font(0.88 * font);
  cairo_set_line_width(cairo, 0.05 * font);
  const double zero = request.height_zero_m;
  const double step = round_length((frame.high - frame.low) / kTicks * 1.5);
  for (double value = std::ceil((frame.low - zero) / step) * step; value + zero <= frame.high; value += step) {
    const double y = frame.y(value + zero);
    canvas.set_colour(kInk, 0.15);
    cairo_move_to(cairo, frame.left, y);
    cairo_line_to(cairo, frame.right, y);
    cairo_stroke(cairo);
    canvas.set_colour(kFaintInk);
    const std::string text = tick_text(value);
    canvas.show(text, frame.left - 0.5 * font - canvas.width_of(text), y + 0.3 * font);
  }
  const double along = round_length(frame.length / kTicks * 1.5);
  for (double value = 0; value <= frame.length; value += along) {
    const std::string text = tick_text(value) + (value == 0 ? "" : "\u2009m");
    const double x = frame.x(value);
    canvas.set_colour(kInk);
    cairo_move_to(cairo, x, frame.bottom);
    cairo_line_to(cairo, x, frame.bottom + 0.35 * font);
    cairo_stroke(cairo);
    canvas.set_colour(kFaintInk);
    canvas.show(text, std::min(x - 0.5 * canvas.width_of(text), frame.right - canvas.width_of(text)),
                frame.bottom + 1.4 * font);
  }
  canvas.set_colour(kInk);
  cairo_rectangle(cairo, frame.left, frame.top, frame.right - frame.left, frame.bottom - frame.top);
  cairo_stroke(cairo);
  canvas.set_font(0.88 * font);
  canvas.show(canvas.fitted(request.height_label, frame.left - font), 0.6 * font, frame.top + 0.8 * font);
}

void draw_flight(Canvas& canvas, const Frame& frame, const ProfileRequest& request, const std::vector<double>& along,
                 double font) {
  cairo_t* const cairo = canvas.cairo();
  cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
  for (const bool is_paper : {true, false}) {
    for (std::size_t i = 0; i < along.size(); ++i) {
      const double x = frame.x(along[i]), y = frame.y(request.points[i].z());
      if (i == 0) {
        cairo_move_to(cairo, x, y);
      } else {
        cairo_line_to(cairo, x, y);
      }
    }
    canvas.set_colour(is_paper ? kPaper : kPath);
    cairo_set_line_width(cairo, (is_paper ? 0.3 : 0.14) * font);
    cairo_stroke(cairo);
  }
}

void draw_strips(Canvas& canvas, const Frame& frame, const ProfileRequest& request, std::size_t count, double top,
                 double font) {
  for (std::size_t i = 0; i < count; ++i) {
    const ProfileStrip& strip = request.strips[i];
    const double y = top + static_cast<double>(i) * kStripRow * font, high = 0.8 * font;
    canvas.set_font(0.88 * font);
    canvas.set_colour(kInk);
    canvas.show(canvas.fitted(strip.label, frame.left - font), 0.6 * font, y + 0.75 * high);
    canvas.set_colour(kGridLine, 0.35);
    canvas.fill_rectangle(frame.left, y, frame.right - frame.left, high);
    canvas.set_colour(kMarkedPath);
    for (const std::array<double, 2>& span : strip.spans_m) {
      const double from = frame.x(std::clamp(span[0], 0.0, frame.length));
      const double to = frame.x(std::clamp(span[1], 0.0, frame.length));
      canvas.fill_rectangle(from, y, std::max(to - from, 1.5), high);  // hovering takes no way, and is to be seen too
    }
  }
}

}  // namespace

Picture render_profile(const Scene& scene, const ProfileRequest& request, const Progress& callback) {
  const internal::core::ProgressReporter progress(callback);
  progress.begin("drawing the profile");
  check(request);
  const std::vector<double> along = distances(request.points);
  const double font = font_of(request.width);
  const double head = (request.title.empty() ? 0.6 : request.subtitle.empty() ? 2.4 : 3.8) * font;
  const double chart = kChart * request.width;
  const double fixed_room = head + chart + (kAxisRoom + kEdgeRoom) * font;
  const auto most = static_cast<std::size_t>(std::max(0.0, (0.5 * kLargestPicture - fixed_room) / (kStripRow * font)));
  const std::size_t count = std::min(most, request.strips.size());
  const std::size_t left_out = request.strips.size() - count;
  const double rows = static_cast<double>(count + (left_out > 0 ? 1 : 0)) * kStripRow * font;

  Frame frame;
  frame.left = kLabelShare * request.width;
  frame.right = request.width - kEdgeRoom * font;
  frame.top = head;
  frame.bottom = head + chart;
  frame.length = std::max(along.back(), std::numeric_limits<double>::min());
  const std::vector<double> below =
      skyline(scene, request, along, std::max(1, static_cast<int>(frame.right - frame.left)), progress);
  range_of_heights(frame, request, below);

  Canvas canvas(request.width, static_cast<int>(std::ceil(fixed_room + rows)));
  if (!request.title.empty()) {
    canvas.set_font(1.2 * font, true);
    canvas.set_colour(kInk);
    canvas.show(canvas.fitted(request.title, request.width - 2 * font), 0.6 * font, 1.5 * font);
    canvas.set_font(font);
    canvas.set_colour(kFaintInk);
    canvas.show(canvas.fitted(request.subtitle, request.width - 2 * font), 0.6 * font, 3 * font);
  }
  draw_skyline(canvas, frame, below);
  draw_axes(canvas, frame, request, font);
  draw_flight(canvas, frame, request, along, font);
  const double strips_top = frame.bottom + (kAxisRoom - 0.8) * font;
  draw_strips(canvas, frame, request, count, strips_top, font);
  if (left_out > 0) {
    canvas.set_font(0.88 * font);
    canvas.set_colour(kFaintInk);
    canvas.show("and " + std::to_string(left_out) + " more", 0.6 * font,
                strips_top + (static_cast<double>(count) * kStripRow + 0.7) * font);
  }
  progress.finish();
  return canvas.picture();
}

Picture stack_pictures(const Picture& upper, const Picture& lower) {
  const int width = std::max(upper.width, lower.width), height = upper.height + lower.height;
  if (height > kLargestPicture) {
    throw Error(ErrorCode::value_out_of_range,
                "one picture over the other would be " + std::to_string(height) + " pixels high", "pictures",
                "take pictures that are " + std::to_string(kLargestPicture) + " high together at most");
  }
  Canvas canvas(width, height);
  const auto left_of = [width](const Picture& picture) { return std::floor(0.5 * (width - picture.width)); };
  canvas.place(upper, left_of(upper), 0);
  canvas.place(lower, left_of(lower), upper.height);
  return canvas.picture();
}

}  // namespace vantage
