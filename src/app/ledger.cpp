#include "app/ledger.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "core/format.h"

namespace vantage::internal::app {
namespace {

constexpr double kNowhere = std::numeric_limits<double>::infinity();

double distance(const Box& a, const Box& b) { return (a.min - b.max).cwiseMax(b.min - a.max).cwiseMax(0.0).norm(); }

double nearest(const Box& box, const std::vector<Box>& others) {
  double least = kNowhere;
  for (const Box& other : others) least = std::min(least, distance(box, other));
  return least;
}

struct Near {
  const LedgerEntry* entry = nullptr;
  double distance_m = 0;  ///< of a place that is not known 0

  auto badness() const { return std::tuple(entry->stand_in.has_value(), !entry->may_be_larger, distance_m); }
};

}  // namespace

std::string ledger_text(const LedgerEntry& entry) {
  std::string text = display_name(entry.object);
  if (!entry.what.empty() && entry.what != text) text += text.empty() ? entry.what : " (" + entry.what + ")";
  text += ": " + entry.reason;
  text += entry.stand_in ? "; stands in: " + entry.instead : "; nothing stands in";
  if (entry.may_be_larger) text += ", it may be larger";
  return text;
}

std::optional<Warning> incomplete_warning(const Scene& scene, const std::vector<Box>& targets, double range_m,
                                          const std::vector<Box>& paths, const std::string& path) {
  std::vector<Near> near;
  for (const LedgerEntry& entry : scene.ledger) {
    if (entry.box && !(nearest(*entry.box, targets) <= range_m)) continue;
    near.push_back({&entry, entry.box ? nearest(*entry.box, paths) : 0});
  }
  if (near.empty()) return std::nullopt;
  const auto held = static_cast<std::size_t>(
      std::count_if(near.begin(), near.end(), [](const Near& one) { return one.entry->stand_in.has_value(); }));
  const Near& worst = *std::min_element(near.begin(), near.end(),
                                        [](const Near& a, const Near& b) { return a.badness() < b.badness(); });
  double least = kNowhere;
  for (const Near& one : near) least = std::min(least, one.distance_m);
  std::string text = near.size() == 1 ? "1 thing within reach is not built as the scene's file has it"
                                      : std::to_string(near.size()) +
                                            " things within reach are not built as the scene's file has them";
  const std::size_t open = near.size() - held;
  text += open == 0   ? " (stand-ins hold their place)"
          : held == 0 ? " (nothing holds their place: they hide nothing)"
                      : " (nothing holds the place of " + std::to_string(open) + " of them: these hide nothing)";
  text += least > 0 ? core::format(", the nearest {:.0f} m from {}", std::floor(least), path)
                    : core::format(", the nearest among {}", path);
  return Warning{WarningCode::scene_incomplete, text + "; the worst: " + ledger_text(*worst.entry)};
}

}  // namespace vantage::internal::app
