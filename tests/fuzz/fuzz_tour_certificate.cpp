// libFuzzer target: any bytes as the certificate of a bound, beside the meshes of five boxes. It may be refused; what
// is accepted is no more than the length of a tour that visits all five. The seeds are certificates of these boxes.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "fuzz/files.h"
#include "vantage/error.h"
#include "vantage/geometry.h"
#include "vantage/mission_tour.h"

namespace vantage::fuzzing {
namespace {

struct BoxCorners {
  Vec3 low, high;
};

/// As in tests/check_tours.py.
const std::array<BoxCorners, 5> kBoxes = {{{{0, 0, 0}, {2, 2, 2}},
                                           {{30, 0, 1}, {33, 2, 4}},
                                           {{32, 28, 0}, {35, 30, 3}},
                                           {{1, 31, 0}, {4, 34, 2}},
                                           {{14, 40, 5}, {17, 43, 9}}}};
constexpr std::array<std::array<int, 4>, 6> kQuads = {
    {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};

void require(bool holds) {
  if (!holds) std::abort();
}

template <typename Value>
void append(std::string& bytes, Value value) {
  static_assert(std::endian::native == std::endian::little);
  const auto raw = std::bit_cast<std::array<char, sizeof(Value)>>(value);
  bytes.append(raw.data(), raw.size());
}

std::string ply_of(const BoxCorners& box) {
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\ncomment vantage region: outer\nelement vertex 8\nproperty double x\n"
      "property double y\nproperty double z\nelement face 12\nproperty list uchar int vertex_indices\nend_header\n";
  for (int i = 0; i < 8; ++i) {
    for (int axis = 0; axis < 3; ++axis) append(bytes, (i >> axis & 1) == 0 ? box.low[axis] : box.high[axis]);
  }
  for (const auto& [a, b, c, d] : kQuads) {
    for (const std::array<int, 3>& triangle : {std::array<int, 3>{a, b, c}, std::array<int, 3>{a, c, d}}) {
      append(bytes, std::uint8_t{3});
      for (const int corner : triangle) append(bytes, std::int32_t{corner});
    }
  }
  return bytes;
}

/// Of a short closed tour through all boxes: of the best of all orders, after some rounds of pulling it tight.
double short_tour_m() {
  std::array<std::size_t, 5> order = {0, 1, 2, 3, 4};
  double best = std::numeric_limits<double>::infinity();
  do {
    std::array<Vec3, 5> points;
    for (std::size_t i = 0; i < 5; ++i) points[i] = (kBoxes[order[i]].low + kBoxes[order[i]].high) / 2;
    for (int round = 0; round < 100; ++round) {
      for (std::size_t i = 0; i < 5; ++i) {
        const Vec3 middle = (points[(i + 4) % 5] + points[(i + 1) % 5]) / 2;
        points[i] = middle.cwiseMax(kBoxes[order[i]].low).cwiseMin(kBoxes[order[i]].high);
      }
    }
    double length = 0;
    for (std::size_t i = 0; i < 5; ++i) length += (points[(i + 1) % 5] - points[i]).norm();
    best = std::min(best, length);
  } while (std::next_permutation(order.begin() + 1, order.end()));
  return best;
}

/// Without what makes a tour longer: curves, stretches that serve one region alone, places elsewhere.
bool is_of_plain_tours(const TourCertificateCheck& check) {
  return check.turn_radius_m == 0 && std::all_of(check.regions.begin(), check.regions.end(), [](const auto& region) {
           return region.dwell_m == 0 && region.kind != TourCertificateRegion::Kind::point;
         });
}

void judge(std::string_view bytes) {
  static const bool is_written = [] {
    for (std::size_t i = 0; i < kBoxes.size(); ++i) {
      folder().write("r" + std::to_string(i) + ".ply", ply_of(kBoxes[i]));
    }
    return true;
  }();
  require(is_written);
  static const double short_m = short_tour_m();
  try {
    const TourCertificateCheck check = verify_tour_certificate(folder().write("tour.cert", bytes));
    require(check.is_accepted == check.reason.empty());
    if (!check.is_accepted) return;
    require(std::isfinite(check.bound_m) && (!check.proved_m || *check.proved_m >= check.bound_m));
    if (is_of_plain_tours(check)) require(check.bound_m <= short_m * (1 + 1e-12));
  } catch (const Error& error) {
    require(error.kind() == ErrorKind::input);
    require(!error.problem().empty() && !error.where().empty() && !error.fix().empty());
    require(error.problem().find('\n') == std::string::npos);
  }
}

}  // namespace
}  // namespace vantage::fuzzing

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  vantage::fuzzing::judge(vantage::fuzzing::text_of(data, size));
  return 0;
}
