#include "picture/view.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "vantage/error.h"

namespace vantage::internal::picture {
namespace {

constexpr double kRoom = 1.03;        // of what is framed
constexpr double kWidestTangent = 1;  // of a perspective, to each side: beyond 45 degrees it distorts
constexpr double kNearest = 1e-3;     // of the distance to the focus

void look_along(View& view, const Vec3& back) {
  view.back = back.normalized();
  const Vec3 right = Vec3::UnitZ().cross(view.back);
  view.right = right.norm() > 1e-9 ? right.normalized() : Vec3(Vec3::UnitX());  // from above: north is up
  view.up = view.back.cross(view.right);
}

Vec3 direction(double azimuth_deg, double elevation_deg) {
  const double a = azimuth_deg * std::numbers::pi / 180, e = elevation_deg * std::numbers::pi / 180;
  return {std::cos(a) * std::cos(e), std::sin(a) * std::cos(e), std::sin(e)};
}

Eigen::Vector2d image(const View& view, const Vec3& point) {
  const Vec3 d = point - view.eye;
  const Eigen::Vector2d flat(view.right.dot(d), view.up.dot(d));
  return view.perspective ? Eigen::Vector2d(flat / view.depth(point)) : flat;
}

void place(View& view, const PictureView& request, const Vec3& centre, const Box& bounds) {
  if (request.kind != PictureView::Kind::from) {
    look_along(view, request.kind == PictureView::Kind::top
                         ? Vec3(Vec3::UnitZ())
                         : direction(request.azimuth_deg.value_or(kPreferredAzimuth), request.elevation_deg));
    view.focus_m = (bounds.max - bounds.min).norm() + (0.5 * (bounds.min + bounds.max) - centre).norm() + 1;
    view.eye = centre + view.focus_m * view.back;
    view.near_m = 0;
    view.far_m = 2 * view.focus_m;
    return;
  }
  view.focus_m = (request.from - centre).norm();
  if (!request.from.allFinite() || view.focus_m < 1e-3) {
    throw Error(ErrorCode::direction_invalid, "the camera stands where the target's centre is", "the view from X,Y,Z",
                "take it a few metres away");
  }
  look_along(view, request.from - centre);
  view.perspective = true;
  view.eye = request.from;
  view.near_m = kNearest * view.focus_m;
}

}  // namespace

Eigen::Vector2d View::pixel(const Vec3& point) const {
  const Eigen::Vector2d d = (image(*this, point) - middle) * pixels;
  return {0.5 * width + d.x(), 0.5 * height - d.y()};
}

Eigen::Matrix4f View::clip(const Vec3& origin, const Eigen::Vector2d& shift) const {
  const Vec3 from_eye = origin - eye;
  Eigen::RowVector4d x, y, z, w;
  x << right.transpose(), right.dot(from_eye);
  y << up.transpose(), up.dot(from_eye);
  const Eigen::RowVector4d along = (Eigen::RowVector4d() << -back.transpose(), -back.dot(from_eye)).finished();
  const Eigen::RowVector4d one(0, 0, 0, 1);
  w = perspective ? along : one;
  z = perspective ? Eigen::RowVector4d(near_m * one) : Eigen::RowVector4d((far_m * one - along) / (far_m - near_m));
  Eigen::Matrix4d matrix;
  matrix << 2 * pixels / width * (x - middle.x() * w) + 2 * shift.x() / width * w,
      2 * pixels / height * (y - middle.y() * w) - 2 * shift.y() / height * w, z, w;
  return matrix.cast<float>();
}

View make_view(const PictureView& request, int width, int height, const Insets& insets, const std::vector<Vec3>& points,
               const Vec3& centre, const Box& bounds) {
  View view;
  view.width = width;
  view.height = height;
  place(view, request, centre, bounds);

  Eigen::AlignedBox2d framed;
  for (const Vec3& point : points) {
    if (view.perspective && view.depth(point) < 0.05 * view.focus_m) {  // beside or behind the camera
      framed.extend(Eigen::Vector2d(-kWidestTangent, -kWidestTangent));
      framed.extend(Eigen::Vector2d(kWidestTangent, kWidestTangent));
    } else {
      framed.extend(image(view, point));
    }
  }
  if (framed.isEmpty()) framed.extend(image(view, centre));
  if (view.perspective) {
    const Eigen::Vector2d widest = Eigen::Vector2d::Constant(kWidestTangent);
    framed = Eigen::AlignedBox2d(framed.min().cwiseMax(-widest), framed.max().cwiseMin(widest));
  }
  const double room_x = width - insets.left - insets.right, room_y = height - insets.top - insets.bottom;
  const double smallest = 1e-6 * (view.perspective ? 1 : view.focus_m);
  const Eigen::Vector2d size = (kRoom * framed.sizes()).cwiseMax(smallest);
  view.pixels = std::min(room_x / size.x(), room_y / size.y());
  view.middle =
      framed.center() + Eigen::Vector2d(insets.right - insets.left, insets.top - insets.bottom) * (0.5 / view.pixels);
  return view;
}

}  // namespace vantage::internal::picture
