#include "prove/flat_polygons.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "prove/orientation.h"

namespace vantage::internal::prove {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kMostCorners = 48, kMostTriangles = 512;

std::size_t hash_of(std::uint64_t a, std::uint64_t b, std::uint64_t c) {
  std::uint64_t h = a * 0x9E3779B97F4A7C15ULL;
  h = (h ^ (h >> 32) ^ b) * 0xC2B2AE3D27D4EB4FULL;
  h = (h ^ (h >> 29) ^ c) * 0x165667B19E3779F9ULL;
  return static_cast<std::size_t>(h ^ (h >> 32));
}

std::size_t hash_of(const Vec3& at) {
  const Vec3 p = at + Vec3::Zero();  // -0 is 0
  return hash_of(std::bit_cast<std::uint64_t>(p.x()), std::bit_cast<std::uint64_t>(p.y()),
                 std::bit_cast<std::uint64_t>(p.z()));
}

std::size_t table_size(std::size_t count) { return std::bit_ceil(2 * count + 1); }

double distance_from_segment(const Vec3& point, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double part = std::clamp((point - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
  return (point - a - part * ab).norm();
}

/// How far `at` lies to the right of the line from one point to the next, in the plane with that normal.
double right_of(const Vec3& at, const Vec3& from, const Vec3& to, const Vec3& normal) {
  const Vec3 along = to - from;
  return normal.dot((at - from).cross(along)) / along.norm();
}

}  // namespace

/// A ring of welded vertices, and the triangles inside it.
class FlatPolygons::Growth {
 public:
  Growth(const FlatPolygons& all, std::uint32_t slot) : all_(all), used_{slot} {
    const Triangle& t = all.triangles_[slot];
    ring_.assign(t.begin(), t.end());
    normal_ = (at(1) - at(0)).cross(at(2) - at(0));
    const double twice = normal_.norm();
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, (at(k + 1) - at(k)).norm());
    has_area_ = twice > 4 * all.planar_m_ * longest;  // narrower ones have no normal to speak of
    if (has_area_) normal_ /= twice;
  }

  bool has_area() const { return has_area_; }

  void grow() {
    bool changed = true;
    while (changed) {
      changed = false;
      for (std::size_t i = 0; i < ring_.size(); ++i) {
        while (ring_.size() < kMostCorners && used_.size() < kMostTriangles && extend(i)) changed = true;
      }
    }
  }

  /// Null where rounding leaves no convex polygon.
  std::unique_ptr<FlatPolygon> polygon() const;

 private:
  const Vec3& at(std::size_t i) const { return all_.positions_[ring_[i % ring_.size()]]; }
  double height(const Vec3& point) const { return normal_.dot(point - all_.positions_[ring_[0]]); }
  bool extend(std::size_t side);
  std::vector<std::uint32_t> corners() const;

  const FlatPolygons& all_;
  std::vector<std::uint32_t> ring_, used_;
  Vec3 normal_ = Vec3::Zero();
  bool has_area_ = false;
};

/// By the first triangle across a side that lies in the plane and leaves the ring convex.
bool FlatPolygons::Growth::extend(std::size_t side) {
  const std::size_t n = ring_.size();
  const std::uint32_t a = ring_[side], b = ring_[(side + 1) % n];
  const Vec3 &pa = at(side), &pb = at(side + 1), &before = at(side + n - 1), &after = at(side + 2);
  std::uint32_t best = kNone, apex = kNone;
  all_.visit_run(a, b, [&](std::uint32_t slot, std::uint32_t third) {
    if (best != kNone && slot >= best) return;
    if (std::find(used_.begin(), used_.end(), slot) != used_.end()) return;
    if (std::find(ring_.begin(), ring_.end(), third) != ring_.end()) return;
    const Vec3& p = all_.positions_[third];
    const double allowed = all_.planar_m_;
    if (std::abs(height(p)) > allowed || !(right_of(p, pa, pb, normal_) > 4 * allowed)) return;
    if (right_of(pa, before, p, normal_) < -allowed || right_of(pb, p, after, normal_) < -allowed) return;
    best = slot;
    apex = third;
  });
  if (best == kNone) return false;
  used_.push_back(best);
  ring_.insert(ring_.begin() + static_cast<std::ptrdiff_t>(side) + 1, apex);
  return true;
}

/// The corners of the ring, without those that all but lie on the line between their neighbours.
std::vector<std::uint32_t> FlatPolygons::Growth::corners() const {
  std::vector<std::uint32_t> left = ring_;
  for (std::size_t i = 0; left.size() > 3 && i < left.size();) {
    const std::size_t n = left.size();
    const Vec3 &a = all_.positions_[left[(i + n - 1) % n]], &b = all_.positions_[left[(i + 1) % n]];
    if (right_of(all_.positions_[left[i]], a, b, normal_) > 4 * all_.planar_m_) {
      ++i;
      continue;
    }
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
    i = i > 0 ? i - 1 : 0;  // what it stood beside may now lie on a line as well
  }
  return left;
}

std::unique_ptr<FlatPolygon> FlatPolygons::Growth::polygon() const {
  auto made = std::make_unique<FlatPolygon>();
  made->normal = normal_;
  for (const std::uint32_t v : corners()) {
    made->corners.push_back(all_.positions_[v]);
    made->fine_corners.push_back(all_.stored_[v].cast<long double>() - all_.origin_.cast<long double>());
  }
  const std::size_t n = made->corners.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 &a = made->corners[i], &b = made->corners[(i + 1) % n], &c = made->corners[(i + 2) % n];
    if (!(right_of(b, a, c, normal_) > 0)) return nullptr;
    made->inward.push_back(normal_.cross(b - a).normalized());
    made->reach_m = std::max(made->reach_m, a.norm());
  }
  for (const std::uint32_t v : ring_) {
    const Vec3& p = all_.positions_[v];
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < n; ++i) {
      nearest = std::min(nearest, distance_from_segment(p, made->corners[i], made->corners[(i + 1) % n]));
    }
    made->outline_slack_m = std::max(made->outline_slack_m, nearest);
    made->slack_m = std::max({made->slack_m, nearest, std::abs(normal_.dot(p - made->corners[0]))});
  }
  const auto& [a, b, c] = all_.triangles_[used_[0]];
  made->is_exactly_flat = std::all_of(ring_.begin(), ring_.end(), [&, a = a, b = b, c = c](std::uint32_t v) {
    return orientation(all_.stored_[a], all_.stored_[b], all_.stored_[c], all_.stored_[v]) == 0;
  });
  for (const std::uint32_t slot : used_) made->triangles.push_back(all_.numbers_[slot]);
  std::sort(made->triangles.begin(), made->triangles.end());
  return made;
}

FlatPolygons::FlatPolygons(const Scene& scene, const Vec3& origin, std::vector<std::uint32_t> triangles)
    : origin_(origin), numbers_(std::move(triangles)) {
  std::sort(numbers_.begin(), numbers_.end());
  numbers_.erase(std::unique(numbers_.begin(), numbers_.end()), numbers_.end());
  weld(scene);
  link();
  slots_ = std::make_unique<Slot[]>(numbers_.size());
}

/// Corners in one place are one vertex, whatever the file calls them.
void FlatPolygons::weld(const Scene& scene) {
  std::vector<std::uint32_t> table(table_size(3 * numbers_.size()), kNone);
  const std::size_t mask = table.size() - 1;
  double largest = 0;
  triangles_.reserve(numbers_.size());
  for (const std::uint32_t number : numbers_) {
    Triangle welded = {};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& at = scene.mesh.vertices[scene.mesh.triangles[number][k]];
      std::size_t place = hash_of(at) & mask;
      while (table[place] != kNone && stored_[table[place]] != at) place = (place + 1) & mask;
      if (table[place] == kNone) {
        table[place] = static_cast<std::uint32_t>(stored_.size());
        positions_.push_back(at - origin_);
        stored_.push_back(at);
        largest = std::max({largest, at.cwiseAbs().maxCoeff(), positions_.back().cwiseAbs().maxCoeff()});
      }
      welded[k] = table[place];
    }
    triangles_.push_back(welded);
  }
  constexpr double kRoundings = 16;
  planar_m_ = kRoundings * std::numeric_limits<double>::epsilon() * largest;
}

void FlatPolygons::link() {
  first_run_.assign(table_size(3 * triangles_.size()), kNone);
  next_run_.assign(3 * triangles_.size(), kNone);
  const std::size_t mask = first_run_.size() - 1;
  for (std::uint32_t run = 0; run < next_run_.size(); ++run) {
    const Triangle& t = triangles_[run / 3];
    const std::uint32_t a = t[run % 3], b = t[(run + 1) % 3];
    std::uint32_t& first = first_run_[hash_of(std::min(a, b), std::max(a, b), 0) & mask];
    next_run_[run] = first;
    first = run;
  }
}

/// Calls visit(slot, third corner) for the triangles at an edge, whichever way they run it.
template <typename Visit>
void FlatPolygons::visit_run(std::uint32_t from, std::uint32_t to, const Visit& visit) const {
  const std::size_t mask = first_run_.size() - 1;
  std::uint32_t run = first_run_[hash_of(std::min(from, to), std::max(from, to), 0) & mask];
  for (; run != kNone; run = next_run_[run]) {
    const Triangle& t = triangles_[run / 3];
    const std::uint32_t a = t[run % 3], b = t[(run + 1) % 3];
    if ((a == from && b == to) || (a == to && b == from)) visit(run / 3, t[(run + 2) % 3]);
  }
}

std::uint32_t FlatPolygons::slot_of(std::uint32_t triangle) const {
  return static_cast<std::uint32_t>(std::lower_bound(numbers_.begin(), numbers_.end(), triangle) - numbers_.begin());
}

const FlatPolygon* FlatPolygons::around(std::uint32_t triangle) const {
  const std::uint32_t slot = slot_of(triangle);
  std::call_once(slots_[slot].grown_once, [&] {
    Growth growth(*this, slot);
    if (!growth.has_area()) return;
    growth.grow();
    slots_[slot].grown = growth.polygon();
  });
  return slots_[slot].grown ? slots_[slot].grown.get() : only(triangle);
}

const FlatPolygon* FlatPolygons::only(std::uint32_t triangle) const {
  const std::uint32_t slot = slot_of(triangle);
  std::call_once(slots_[slot].single_once, [&] {
    const Growth growth(*this, slot);
    if (growth.has_area()) slots_[slot].single = growth.polygon();
  });
  return slots_[slot].single.get();
}

}  // namespace vantage::internal::prove
