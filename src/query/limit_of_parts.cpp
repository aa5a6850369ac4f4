#include <algorithm>
#include <utility>

#include "query/point_limit.h"

namespace vantage::internal::query {
namespace {

using Margin = std::function<double(const sensor::ViewedPart& part, const Vec3& point)>;

/// Where a limit changes along a line: `margin` is >= 0 where it is kept. `sign`: 1 where the places where it is kept
/// are one interval, -1 where those are where it is broken.
template <typename MarginAt>
void add_changes(const MarginAt& margin, double sign, double reach, std::vector<double>& out) {
  // With the sign, the interval is where the values are largest.
  const auto value = [&](double t) { return sign * margin(t); };
  constexpr int kSamples = 32, kSteps = 60;
  int best = 0;
  for (int i = 1; i <= kSamples; ++i) {
    if (value(reach * i / kSamples) > value(reach * best / kSamples)) best = i;
  }
  double low = reach * std::max(best - 1, 0) / kSamples, high = reach * std::min(best + 1, kSamples) / kSamples;
  for (int i = 0; i < kSteps; ++i) {
    const double third = (high - low) / 3;
    (value(low + third) < value(high - third) ? low : high) =
        value(low + third) < value(high - third) ? low + third : high - third;
  }
  const double top = (low + high) / 2;
  if (value(top) < 0) return;
  for (const double end : {0.0, reach}) {
    if (value(end) >= 0) continue;
    double inside = top, outside = end;
    for (int i = 0; i < kSteps; ++i) {
      const double middle = (inside + outside) / 2;
      (value(middle) >= 0 ? inside : outside) = middle;
    }
    out.push_back((inside + outside) / 2);
  }
}

class LimitOfParts : public PointLimit {
 public:
  LimitOfParts(const char* name, std::shared_ptr<const sensor::SensorView> view, OneInterval interval, Margin margin)
      : name_(name),
        view_(std::move(view)),
        sign_(interval == OneInterval::kept ? 1 : -1),
        margin_(std::move(margin)) {}

  void add_broken(const Vec3& point, std::vector<std::string>& broken) const override {
    const sensor::Viewed& target = view_->target;
    const Vec3 local = point - target.origin;
    if (std::any_of(target.parts.begin(), target.parts.end(),
                    [&](const sensor::ViewedPart& part) { return margin_(part, local) < 0; })) {
      broken.emplace_back(name_);
    }
  }
  void add_crossings(const ViewRay& line, std::vector<double>& cuts) const override {
    const Vec3 start = line.origin - view_->target.origin;
    for (const sensor::ViewedPart& part : view_->target.parts) {
      add_changes([&](double t) { return margin_(part, start + t * line.direction); }, sign_, line.reach, cuts);
    }
  }

 private:
  const char* name_;
  std::shared_ptr<const sensor::SensorView> view_;
  double sign_;
  Margin margin_;
};

}  // namespace

std::unique_ptr<const PointLimit> limit_of_parts(const char* name,
                                                 const std::shared_ptr<const sensor::SensorView>& view,
                                                 OneInterval interval, Margin margin) {
  return std::make_unique<LimitOfParts>(name, view, interval, std::move(margin));
}

}  // namespace vantage::internal::query
