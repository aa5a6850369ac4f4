// The inputs of a volume are compared bit by bit: what differs in the sign of a zero is computed again.
#include "app/kept_volumes.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

namespace vantage {

struct KeptVolumes::Data {
  struct Entry {
    PreparedTarget target;  // holds on to its scene, so that no other one comes to lie where it is
    double tolerance_m;
    std::shared_ptr<const Volume> volume;
    std::uint64_t last_run;  // that used it
  };
  std::mutex mutex;
  std::vector<Entry> entries;
  std::uint64_t run = 0;
  std::size_t taken = 0;
};

KeptVolumes::KeptVolumes() : data_(std::make_unique<Data>()) {}
KeptVolumes::~KeptVolumes() = default;

std::size_t KeptVolumes::count() const {
  const std::lock_guard lock(data_->mutex);
  return data_->entries.size();
}

std::size_t KeptVolumes::taken() const {
  const std::lock_guard lock(data_->mutex);
  return data_->taken;
}

void KeptVolumes::clear() {
  const std::lock_guard lock(data_->mutex);
  data_->entries.clear();
}

namespace internal::app {
namespace {

bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

bool same_bits(const Vec3& a, const Vec3& b) {
  return same_bits(a.x(), b.x()) && same_bits(a.y(), b.y()) && same_bits(a.z(), b.z());
}

bool same_bits(const VisibleShare& a, const VisibleShare& b) {
  return same_bits(a.share, b.share) && a.cells == b.cells;
}

template <typename T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const T& x, const T& y) { return same_bits(x, y); });
}

template <typename T>
bool same_bits(const std::optional<T>& a, const std::optional<T>& b) {
  return a && b ? same_bits(*a, *b) : a.has_value() == b.has_value();
}

bool same_bits(const Target& a, const Target& b) {
  return a.name == b.name && same_bits(a.parts, b.parts) && same_bits(a.offset_m, b.offset_m) &&
         same_bits(a.front, b.front) && a.front_by_order == b.front_by_order;
}

// All members are named: one that is added does not compile here before it is clear whether the volume depends on it.
// Volumes are cut to the others afterwards, or have been computed with them (compute_view); a camera's pixels may limit
// the range, too.
bool same_range(const Sensor& a, const Sensor& b) {
  const auto& [max_range_m, min_range_m, incidence_deg, camera, mount, pixel, sun, link, visible] = a;
  return same_bits(max_range_m, b.max_range_m) && same_bits(range_limit_m(a), range_limit_m(b)) && !link && !b.link &&
         same_bits(visible, b.visible);
}

/// Whether limits that the volume is computed with are the same.
bool same_limits_in_view(const PreparedTarget& a, const PreparedTarget& b) {
  const bool has_limits = has_limits_in_view(a);
  return has_limits == has_limits_in_view(b) && (!has_limits || a.sensor() == b.sensor());
}

bool same_bits(const PreparedTarget& a, const PreparedTarget& b) {
  return &a.scene().data() == &b.scene().data() && same_range(a.sensor(), b.sensor()) &&
         same_bits(a.target(), b.target()) && same_limits_in_view(a, b);
}

std::shared_ptr<const Volume> find(KeptVolumes::Data& data, const PreparedTarget& target, double tolerance_m) {
  const std::lock_guard lock(data.mutex);
  for (KeptVolumes::Data::Entry& entry : data.entries) {
    if (!same_bits(entry.tolerance_m, tolerance_m) || !same_bits(entry.target, target)) continue;
    entry.last_run = data.run;
    ++data.taken;
    return entry.volume;
  }
  return nullptr;
}

}  // namespace

void begin_run(const std::shared_ptr<KeptVolumes>& kept) {
  if (!kept) return;
  KeptVolumes::Data& data = kept->data();
  const std::lock_guard lock(data.mutex);
  std::erase_if(data.entries, [&](const auto& entry) { return entry.last_run < data.run; });
  ++data.run;
}

Volume kept_or_computed(const std::shared_ptr<KeptVolumes>& kept, const PreparedTarget& target, double tolerance_m,
                        const std::function<Volume()>& compute) {
  if (!kept || target.sensor().link) return compute();
  KeptVolumes::Data& data = kept->data();
  if (const auto found = find(data, target, tolerance_m)) {
    Volume volume = *found;
    if (volume.provenance) volume.provenance->sensor = target.sensor();
    return volume;
  }
  Volume volume = compute();
  if (volume.outcome == Outcome::computed) {
    auto copy = std::make_shared<const Volume>(volume);
    const std::lock_guard lock(data.mutex);
    data.entries.push_back({target, tolerance_m, std::move(copy), data.run});
  }
  return volume;
}

}  // namespace internal::app
}  // namespace vantage
