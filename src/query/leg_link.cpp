#include "query/leg_link.h"

#include <algorithm>

namespace vantage::internal::query {
namespace {

constexpr double kShortest = 1e-3;       // metres
constexpr double kShortestShare = 1e-5;  // and of the leg

/// A zone that nothing enters when it is so much longer in all is not even touched within rounding.
constexpr double kZoneTouch = 1e-8;

using Objects = std::vector<std::uint32_t>;

class LinkHalving {
 public:
  LinkHalving(const LinkQuery& link, const Vec3& origin, const Leg& leg, double radius, double slack)
      : link_(link),
        from_(leg.from - origin - link.antenna()),
        along_(leg.to - leg.from),
        length_(along_.norm()),
        radius_(radius),
        slack_(2 * slack + kZoneTouch * link.excess_m()) {}

  // From p to x the way over a point b and the straight way change by at most |x - p| each. So a zone longer by twice
  // that holds all zones of positions so near, and one shorter by twice that is in all of them. What enters a zone that
  // is 2 `radius` longer counts for the tube all along the piece: it never has to be decided between the two.
  void look(double begin, double end) {
    const double half = 0.5 * (end - begin) * length_, middle = 0.5 * (begin + end);
    const Objects maybe = entering(middle, 2 * (half + radius_) + slack_);
    if (maybe.empty()) return;
    const bool is_short = 2 * half <= std::min(kShortest, kShortestShare * length_);
    if (is_short || ++pieces_ > kMostPieces || entering(middle, 2 * radius_ - 2 * half) == maybe) {
      for (const std::uint32_t object : maybe) found.emplace_back(object, LegInterval{begin, end});
      return;
    }
    look(begin, middle);
    look(middle, end);
  }

  std::vector<std::pair<std::uint32_t, LegInterval>> found;

 private:
  /// A leg along the border of what is free is neither free nor not at any length. Then what is left of it is not.
  static constexpr int kMostPieces = 20'000;

  Objects entering(double place, double more) const {
    const Vec3 position = from_ + place * along_;
    const double distance = position.norm();
    const Vec3 direction = distance > 0 ? Vec3(position / distance) : Vec3(Vec3::UnitZ());
    Objects objects;
    link_.for_each_entering(
        direction, distance, [&](std::uint32_t object) { objects.push_back(object); }, more);
    std::sort(objects.begin(), objects.end());
    objects.erase(std::unique(objects.begin(), objects.end()), objects.end());
    return objects;
  }

  const LinkQuery& link_;
  Vec3 from_, along_;  // about the antenna
  double length_, radius_, slack_;
  int pieces_ = 0;  ///< looked at
};

}  // namespace

std::vector<std::pair<std::uint32_t, LegInterval>> link_parts(const LinkQuery& link, const Vec3& origin, const Leg& leg,
                                                              double radius, double slack) {
  LinkHalving halving(link, origin, leg, radius, slack);
  halving.look(0, 1);
  return std::move(halving.found);
}

}  // namespace vantage::internal::query
