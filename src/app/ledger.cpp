#include "app/ledger.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "common/ledger.h"
#include "core/format.h"

namespace vantage::internal::app {
namespace {

constexpr double kNowhere = std::numeric_limits<double>::infinity();

double distance(const Box& a, const Box& b) { return (a.min - b.max).cwiseMax(b.min - a.max).cwiseMax(0.0).norm(); }

/// Boxes of a list, and boxes round ever more of them: one look tells that all of these are far away. Flights have a
/// million legs, and ledgers of cities many thousand entries.
class BoxLevels {
 public:
  explicit BoxLevels(std::vector<Box> boxes) : levels_{std::move(boxes)} {
    while (levels_.back().size() > 1) {
      const std::vector<Box>& below = levels_.back();
      std::vector<Box> above((below.size() + kOfOne - 1) / kOfOne);
      for (std::size_t i = 0; i < below.size(); ++i) above[i / kOfOne].extend(below[i]);
      levels_.push_back(std::move(above));
    }
  }

  /// Infinite without boxes.
  double nearest(const Box& box) const {
    double least = kNowhere;
    look(box, levels_.size() - 1, 0, least);
    return least;
  }

 private:
  static constexpr std::size_t kOfOne = 16;

  void look(const Box& box, std::size_t level, std::size_t begin, double& least) const {
    const std::size_t end = std::min(begin + kOfOne, levels_[level].size());
    for (std::size_t i = begin; i < end; ++i) {
      const double away = distance(box, levels_[level][i]);
      if (!(away < least)) continue;
      if (level == 0) {
        least = away;
      } else {
        look(box, level - 1, i * kOfOne, least);
      }
    }
  }

  std::vector<std::vector<Box>> levels_;
};

struct Near {
  const LedgerEntry* entry = nullptr;
  double distance_m = 0;  ///< of a place that is not known 0

  bool is_worse_than(const Near& other) const {
    return std::tuple(badness(*entry), distance_m) < std::tuple(badness(*other.entry), other.distance_m);
  }
};

/// What holds the places: of so many things nothing, of others a stand-in that may be too small.
std::string holders_text(std::size_t things, std::size_t open, std::size_t guessed) {
  if (open == things) return "nothing holds their place: they hide nothing";
  if (guessed == things) return "what stands in may be too small";
  if (open + guessed == 0) return "stand-ins hold their place";
  std::string text;
  if (open > 0) text = "nothing holds the place of " + std::to_string(open) + " of them: these hide nothing";
  if (guessed == 0) return text;
  return text + (text.empty() ? "" : "; ") + "what stands in for " + std::to_string(guessed) +
         " of them may be too small";
}

/// Of UTF-8, whose characters begin with no byte 10xxxxxx.
std::string cut(const std::string& text) {
  constexpr std::size_t kMost = 200;
  if (text.size() <= kMost) return text;
  std::size_t end = kMost;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0U) == 0x80U) --end;
  return text.substr(0, end) + "...";
}

}  // namespace

std::optional<Warning> incomplete_warning(const Scene& scene, std::vector<Reach> reaches, std::vector<Box> paths,
                                          const std::string& path, const core::ProgressReporter& progress) {
  if (scene.ledger.empty()) return std::nullopt;
  progress.begin("looking at what the scene lacks");
  std::vector<std::pair<BoxLevels, double>> within;
  for (Reach& reach : reaches) within.emplace_back(BoxLevels(std::move(reach.boxes)), reach.within_m);
  const BoxLevels along(std::move(paths));
  std::vector<Near> near;
  for (const LedgerEntry& entry : scene.ledger) {
    progress.check();
    const double unsure_m = entry.stand_in && !entry.may_be_larger ? 0 : kUnsureM;
    const bool is_near = !entry.box || std::any_of(within.begin(), within.end(), [&](const auto& reach) {
      return reach.first.nearest(*entry.box) <= reach.second + unsure_m;
    });
    if (is_near) near.push_back({&entry, entry.box ? along.nearest(*entry.box) : 0});
  }
  if (near.empty()) return std::nullopt;
  std::size_t open = 0, guessed = 0;
  for (const Near& one : near) {
    open += one.entry->stand_in ? 0 : 1;
    guessed += one.entry->stand_in && one.entry->may_be_larger ? 1 : 0;
  }
  const Near& worst =
      *std::min_element(near.begin(), near.end(), [](const Near& a, const Near& b) { return a.is_worse_than(b); });
  double least = kNowhere;
  for (const Near& one : near) least = std::min(least, one.distance_m);
  std::string text = near.size() == 1 ? "1 thing within reach is not built as the scene's file has it"
                                      : std::to_string(near.size()) +
                                            " things within reach are not built as the scene's file has them";
  text += " (" + holders_text(near.size(), open, guessed) + ")";
  text += least > 0 ? core::format(", the nearest {:.0f} m from {}", std::floor(least), path)
                    : core::format(", the nearest among {}", path);
  return Warning{WarningCode::scene_incomplete, text + "; the worst: " + ledger_text(*worst.entry)};
}

}  // namespace vantage::internal::app

namespace vantage {

std::string ledger_text(const LedgerEntry& entry) {
  using internal::app::cut;
  std::string text = cut(display_name(entry.object));
  if (!entry.what.empty() && entry.what != text) text += text.empty() ? cut(entry.what) : " (" + cut(entry.what) + ")";
  if (text.empty()) text = "an unnamed thing";
  if (!entry.reason.empty()) text += ": " + cut(entry.reason);
  text += entry.stand_in ? "; stands in: " + cut(entry.instead) : "; nothing stands in";
  if (entry.may_be_larger) text += ", it may be larger";
  return text;
}

}  // namespace vantage
