#include "tiles/instances.h"

#include <cmath>
#include <optional>
#include <string>

namespace vantage::internal::tiles {
namespace {

using Numbers = std::optional<std::vector<double>>;

Vec3 vector_at(const std::vector<double>& numbers, std::size_t i) {
  return {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
}

/// A direction from two numbers of 16 bits (Cigolle et al., "A survey of efficient representations for independent unit
/// vectors", 2014).
Vec3 from_octahedron(double u, double v) {
  const double x = u / 65535 * 2 - 1, y = v / 65535 * 2 - 1, z = 1 - std::abs(x) - std::abs(y);
  if (z >= 0) return Vec3(x, y, z).normalized();
  return Vec3(std::copysign(1 - std::abs(y), x), std::copysign(1 - std::abs(x), y), z).normalized();
}

/// "NORMAL_UP" and the like, one for each instance.
std::vector<Vec3> directions(const Table& features, const char* name, std::size_t count) {
  std::vector<Vec3> result;
  if (const Numbers plain = features.per_instance(name, 3, count, "FLOAT")) {
    for (std::size_t i = 0; i < count; ++i) result.push_back(vector_at(*plain, i).normalized());
    return result;
  }
  const Numbers packed = features.per_instance((std::string(name) + "_OCT32P").c_str(), 2, count, "UNSIGNED_SHORT");
  if (!packed) return result;
  for (std::size_t i = 0; i < count; ++i) result.push_back(from_octahedron((*packed)[2 * i], (*packed)[2 * i + 1]));
  return result;
}

std::vector<Vec3> positions(const Table& features, std::size_t count) {
  std::vector<Vec3> result;
  if (const Numbers plain = features.per_instance("POSITION", 3, count, "FLOAT")) {
    for (std::size_t i = 0; i < count; ++i) result.push_back(vector_at(*plain, i));
    return result;
  }
  const Numbers packed = features.per_instance("POSITION_QUANTIZED", 3, count, "UNSIGNED_SHORT");
  const Numbers offset = features.global("QUANTIZED_VOLUME_OFFSET", 3);
  const Numbers scale = features.global("QUANTIZED_VOLUME_SCALE", 3);
  if (!packed || !offset || !scale) throw std::string("its instances have no positions");
  for (std::size_t i = 0; i < count; ++i) {
    result.emplace_back(vector_at(*packed, i).cwiseProduct(vector_at(*scale, 0)) / 65535 + vector_at(*offset, 0));
  }
  return result;
}

/// East, north and up at a place on the earth, in the tile's coordinates. `turn`: how the tile is turned into the
/// world, without its scale, which is to enlarge an instance as it does all else.
Eigen::Matrix3d upright_at(const Vec3& position, const Transform& into_world, const Eigen::Matrix3d& turn) {
  const geo::TangentFrame frame(geo::from_ecef(into_world * position).place);
  return turn.transpose() * frame.axes.transpose();
}

/// Whether "EAST_NORTH_UP" is set.
bool stands_on_earth(const Table& features) {
  const auto upright = features.json().find("EAST_NORTH_UP");
  return upright != features.json().end() && *upright == true;
}

}  // namespace

std::size_t instance_count(const Table& features) {
  return static_cast<std::size_t>(features.whole("INSTANCES_LENGTH"));
}

std::vector<Instance> instances_of(const Table& features, const Transform& into_world) {
  const std::size_t count = instance_count(features);
  const std::vector<Vec3> places = positions(features, count);
  const std::vector<Vec3> up = directions(features, "NORMAL_UP", count);
  const std::vector<Vec3> right = directions(features, "NORMAL_RIGHT", count);
  if (up.empty() != right.empty()) throw std::string("its instances have only one of two directions");
  const Numbers scale = features.per_instance("SCALE", 1, count, "FLOAT");
  const Numbers scales = features.per_instance("SCALE_NON_UNIFORM", 3, count, "FLOAT");
  const Numbers batch = features.per_instance("BATCH_ID", 1, count, "UNSIGNED_SHORT");
  const Numbers about = features.global("RTC_CENTER", 3);
  const bool on_earth = stands_on_earth(features);
  if (on_earth && !into_world.matrix().allFinite()) throw std::string("its transform is not finite");
  const Eigen::Matrix3d tile_turn = on_earth ? into_world.rotation() : Eigen::Matrix3d::Identity().eval();

  std::vector<Instance> result;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 position = places[i] + (about ? vector_at(*about, 0) : Vec3::Zero().eval());
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    if (!up.empty() && !right.empty()) {
      turn << right[i], up[i], right[i].cross(up[i]);
    } else if (on_earth) {
      turn = upright_at(position, into_world, tile_turn);
    }
    Vec3 stretch = scales ? vector_at(*scales, i) : Vec3::Ones().eval();
    if (scale) stretch *= (*scale)[i];
    Instance instance{Transform(Eigen::Translation3d(position)), i};
    if (batch && (*batch)[i] >= 0 && (*batch)[i] < 4294967296.0)
      instance.batch = static_cast<std::uint64_t>((*batch)[i]);
    instance.transform.linear() = turn * stretch.asDiagonal();
    result.push_back(instance);
  }
  return result;
}

}  // namespace vantage::internal::tiles
