#include "app/combine_targets.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "vantage/error.h"

namespace vantage::internal::app {
namespace {

/// The parts of a target where it is, each counter-clockwise seen from its front: so that parts with another front or
/// another offset can stand beside them.
Target settled(const Target& target) {
  Target result;
  result.name = target.name;
  result.parts.clear();
  for (std::size_t i = 0; i < target.parts.size(); ++i) {
    const Vec3 normal = make_target_frame(target, i).normal;
    std::vector<Vec3> part = target.parts[i];
    Vec3 turn = Vec3::Zero();
    for (std::size_t k = 1; k + 1 < part.size(); ++k) turn += (part[k] - part[0]).cross(part[k + 1] - part[0]);
    if (turn.dot(normal) < 0) std::reverse(part.begin(), part.end());
    if (target.offset_m != 0) {
      for (Vec3& vertex : part) vertex += target.offset_m * normal;
    }
    result.parts.push_back(std::move(part));
  }
  result.front_by_order = true;
  return result;
}

/// Seen from the back: moved to that side by the offset, where there is one.
Target back_of(const Target& target) {
  Target front = target;
  front.offset_m = 0;
  Target back = settled(front);
  for (std::vector<Vec3>& part : back.parts) std::reverse(part.begin(), part.end());
  back.offset_m = target.offset_m;
  back.name += ", back";
  return back;
}

bool agree(const Target& a, const Target& b) {
  return a.offset_m == b.offset_m && a.front == b.front && a.front_by_order == b.front_by_order;
}

/// One target of the parts of several.
Target together(const std::vector<Target>& targets) {
  constexpr std::size_t kMostNames = 3;
  if (targets.size() == 1) return targets[0];
  const bool agreed =
      std::all_of(targets.begin(), targets.end(), [&](const Target& target) { return agree(target, targets[0]); });
  Target result = agreed ? targets[0] : settled(targets[0]);
  for (std::size_t i = 1; i < targets.size(); ++i) {
    const Target other = agreed ? targets[i] : settled(targets[i]);
    result.parts.insert(result.parts.end(), other.parts.begin(), other.parts.end());
    if (i < kMostNames) result.name += "; " + other.name;
  }
  if (targets.size() > kMostNames) {
    result.name = targets[0].name + " and " + std::to_string(targets.size() - 1) + " more";
  }
  return result;
}

/// Names that are there twice are numbered.
void tell_apart(std::vector<std::vector<Target>>& views) {
  std::set<std::string> taken;
  for (const std::vector<Target>& view : views) taken.insert(view.front().name);
  std::set<std::string> seen;
  for (std::vector<Target>& view : views) {
    std::string& name = view.front().name;
    if (seen.insert(name).second) continue;
    std::string numbered;
    for (int number = 2; numbered.empty() || !taken.insert(numbered).second; ++number) {
      numbered = name + " (" + std::to_string(number) + ")";
    }
    name = numbered;
    seen.insert(name);
  }
}

}  // namespace

void combine_targets(const std::vector<MissionTarget>& given, std::vector<std::vector<Target>> targets,
                     Mission& mission) {
  const Combine combine = mission.as_written.combine;
  std::vector<Target> plain, drawn;
  std::vector<std::vector<Target>> views;
  for (std::size_t i = 0; i < given.size(); ++i) {
    for (Target& target : targets[i]) {
      const bool has_area = !target.is_point() && !target.is_volume();
      if (has_area) drawn.push_back(target);
      const bool is_plain = combine == Combine::all && !given[i].both_sides && has_area;
      if (is_plain) {
        plain.push_back(std::move(target));
      } else if (given[i].both_sides) {
        Target back = back_of(target);
        views.push_back({std::move(target), std::move(back)});
      } else {
        views.push_back({std::move(target)});
      }
    }
  }
  if (!plain.empty()) views.insert(views.begin(), {together(plain)});
  mission.target = drawn.empty() ? views[0][0] : together(drawn);
  mission.views.clear();
  if (combine == Combine::any) {
    for (std::size_t i = 1; i < views.size(); ++i) {
      std::move(views[i].begin(), views[i].end(), std::back_inserter(views[0]));
    }
    views.resize(1);
  }
  if (views.size() == 1 && views[0].size() == 1) {
    mission.target = std::move(views[0][0]);
    return;
  }
  tell_apart(views);
  mission.views = std::move(views);
}

std::vector<std::vector<Target>> views_of(const Mission& mission) {
  return mission.views.empty() ? std::vector<std::vector<Target>>{{mission.target}} : mission.views;
}

}  // namespace vantage::internal::app

namespace vantage {

const char* name_of(Combine combine) {
  switch (combine) {
    case Combine::all:
      return "all";
    case Combine::any:
      return "any";
    case Combine::each:
      return "each";
  }
  return "unknown";
}

std::size_t volume_count(const Mission& mission) {
  return mission.as_written.combine == Combine::each ? std::max<std::size_t>(1, mission.views.size()) : 1;
}

Mission one_volume(const Mission& mission, std::size_t index) {
  if (index >= volume_count(mission)) {
    throw Error(ErrorCode::index_out_of_range, "the mission has no volume " + std::to_string(index + 1), "mission",
                "count volumes from 0");
  }
  Mission result = mission;
  if (mission.as_written.combine != Combine::each || mission.views.empty()) return result;
  const std::vector<Target>& view = mission.views[index];
  result.as_written.combine = Combine::all;
  result.target = view.front();
  result.views.clear();
  if (view.size() > 1) result.views = {view};
  if (mission.views.size() == mission.as_written.targets.size()) {
    result.as_written.places.target = mission.as_written.targets[index].place;
  }
  return result;
}

}  // namespace vantage
