// What is seen along a flight, and what is told to hide it.
#include "judge_flight.h"

namespace attack {

void FlightJudge::judge_seen(const FlightOracle& oracle, const vantage::TargetCheck& target) {
  // Ends are told by their positions, which are not rounded once more.
  for (const FlightSpan& span : target.seen) {
    for (const Vec3& end : {span.begin, span.end}) claim(oracle, end, target, "at an end");
  }
  std::vector<FlightPlace> judged = places({&target.seen}, 10, kDense);
  if (const OneTarget* single = oracle.single()) add_hidden(*single, target, judged);
  for (const FlightPlace& at : judged) {
    if (holds(target.seen, at.at_m, 0)) {
      claim(oracle, at.position, target, "inside");
    } else if (!is_near_end(target.seen, at.at_m)) {
      miss(oracle, at, target);
    }
  }
}

void FlightJudge::judge_link(const vantage::LinkCheck& link) {
  vantage::Mission as_mission;
  as_mission.loaded = drawn_.mission.loaded;
  as_mission.target = vantage::Target::point(link.point);
  double farthest = 1;
  for (const auto& point : drawn_.flight.points) {
    farthest = std::max(farthest, (point.position - link.point).norm() + radius_);
  }
  as_mission.sensor.max_range_m = link.max_range_m.value_or(1.01 * farthest);
  as_mission.sensor.link = link.radio;
  const FlightOracle& oracle = *oracles_.emplace_back(std::make_unique<FlightOracle>(as_mission, scene_));
  vantage::TargetCheck as_target;
  as_target.name = link.name;
  as_target.seen = link.linked;
  judge_seen(oracle, as_target);
  oracles_.pop_back();
  for (const FlightPlace& at : places({&link.linked, &link.lost}, 10)) {
    if (!holds(link.linked, at.at_m, slack_m()) && !holds(link.lost, at.at_m, slack_m())) {
      wrong("link", "neither linked nor lost at " + place_text(at.position));
    }
  }
}

void FlightJudge::claim(const FlightOracle& oracle, const Vec3& position, const vantage::TargetCheck& target,
                        const char* where) {
  result_.count("positions that are claimed");
  const std::string reason = oracle.surely_not_seen(position, rounding_of(position));
  if (!reason.empty()) {
    wrong("over-claim",
          std::string(where) + " " + place_text(position) + ", " + target.name + " is not seen: " + reason);
  }
  if (!(radius_ > 0)) return;
  for (int i = 0; i < 4; ++i) {
    const Vec3 beside = in_tube(position);
    result_.count("positions of tubes");
    const std::string why = oracle.surely_not_seen(beside, rounding_of(beside));
    if (why.empty()) continue;
    wrong("over-claim of a tube",
          place_text(beside) + " about " + place_text(position) + ", " + target.name + ": " + why);
  }
}

double FlightJudge::rounding_of(const Vec3& position) const {
  double reach = 0;
  for (const auto& oracle : oracles_) reach = std::max(reach, oracle->lists()[0][0]->reach(position));
  return rounding_ + 1e-11 * reach;
}

void FlightJudge::miss(const FlightOracle& oracle, const FlightPlace& at, const vantage::TargetCheck& target) {
  result_.count("positions that are not claimed");
  const double reach = oracle.lists()[0][0]->reach(at.position), rounding = rounding_of(at.position);
  // A camera that turns, or what enters a link's zone, is looked for in parts of a leg that are so long.
  const bool is_link = oracle.lists()[0][0]->sensor().link.has_value();
  const double parts = is_link ? length(at.leg) / 8000 : 2.5 * std::min(1e-3, 1e-5 * length(at.leg));
  if (radius_ > 0) return miss_in_tube(oracle, at, parts + 4 * rounding);
  const double tight = 1e-9 * reach + 2 * rounding, loose = 1.5e-6 * reach + 2 * rounding;
  if (!oracle.surely_seen(at.position, tight, 1e-6 * reach + 4 * rounding + parts)) return;
  if (!oracle.surely_seen(at.position, loose, 1e-6 * reach + 4 * rounding + parts)) {
    result_.count("not claimed, by less than a millionth of the distance");
    return;
  }
  wrong("under-claim", place_text(at.position) + " of leg " + std::to_string(at.leg) + ", " + target.name + " is seen");
}

void FlightJudge::miss_in_tube(const FlightOracle& oracle, const FlightPlace& at, double margin) {
  const double larger = 1.02 * radius_ + margin;
  for (int i = 0; i < 40; ++i) {
    if (!oracle.surely_seen(at.position + larger * random_.direction(), 0, margin)) return;
  }
  result_.count("not claimed, and nothing is found in the tube");
}

void FlightJudge::add_hidden(const OneTarget& target, const vantage::TargetCheck& check,
                             std::vector<FlightPlace>& judged) {
  for (std::size_t i = 0; i < leg_count(); ++i) {
    if (!(length(i) > 0)) continue;
    for (const HiddenPart& part : target.hidden_parts(leg(i))) {
      result_.count("hidden parts of legs");
      for (const FlightSpan& span : check.seen) {
        const double begin = std::max(part.begin, (span.begin_m - begin_m(i)) / length(i));
        const double end = std::min(part.end, (span.end_m - begin_m(i)) / length(i));
        if (begin < end) judged.push_back(place(i, 0.5 * (begin + end)));
      }
      for (const double end : {part.begin, part.end}) {
        for (const double aside : {-1.02, 1.02}) {
          const double share = end + aside * near_ / length(i);
          if (share > 0 && share < 1) judged.push_back(place(i, share));
        }
      }
    }
  }
}

std::vector<FlightSpan> FlightJudge::spans_of(const vantage::TargetCheck& check, vantage::NotSeen::Kind kind,
                                              const std::vector<std::string>& names) const {
  std::vector<FlightSpan> spans;
  for (const vantage::NotSeen& reason : check.not_seen) {
    if (reason.kind != kind || std::find(names.begin(), names.end(), reason.name) == names.end()) continue;
    spans.insert(spans.end(), reason.spans.begin(), reason.spans.end());
  }
  return spans;
}

void FlightJudge::judge_reasons(const vantage::TargetCheck& check, const OneTarget& target) {
  using Kind = vantage::NotSeen::Kind;
  if (!target.sensor().link) judge_hidden(check, target);
  const auto margins = [&](const Vec3& p) { return target.margins(p); };
  for (const Margin& margin : target.margins(leg(0).from)) {
    const bool is_range = margin.limit == "max_range", is_behind = margin.limit == "behind";
    std::vector<std::string> names = {""};
    if (const auto limit = facts_named(margin.limit)) names = limit->names;
    const Kind kind = is_range ? Kind::out_of_range : is_behind ? Kind::behind : Kind::limit;
    judge_limit(margin.limit, spans_of(check, kind, names), margins, margin.is_measured, margin.is_searched);
  }
}

void FlightJudge::judge_hidden(const vantage::TargetCheck& check, const OneTarget& target) {
  const auto& objects = drawn_.mission.scene().objects;
  const auto is_in_view = [&](const Vec3& p) {
    for (const Margin& margin : target.margins(p)) {
      const bool counts = margin.limit == "max_range" || margin.limit == "behind";
      if (counts && margin.low < rounding_of(p)) return false;
    }
    return true;
  };
  for (std::size_t i = 0; i < leg_count(); ++i) {
    if (!(length(i) > 0)) continue;
    for (const HiddenPart& part : target.hidden_parts(leg(i))) {
      const FlightPlace at = place(i, random_.uniform(part.begin, part.end));
      const auto spans = spans_of(check, vantage::NotSeen::Kind::hidden, {display_name(objects[part.object])});
      if (!is_in_view(at.position) || holds(spans, at.at_m, slack_m())) continue;
      if (!target.surely_hidden_by(at.position, part.object)) continue;
      wrong("hidden", "not told at " + place_text(at.position) + ": by " + display_name(objects[part.object]));
    }
  }
  if (radius_ > 0) return;
  for (const vantage::NotSeen& reason : check.not_seen) {
    if (reason.kind != vantage::NotSeen::Kind::hidden) continue;
    for (const FlightPlace& at : places({&reason.spans}, 0)) {
      if (!holds(reason.spans, at.at_m, 0) || is_near_end(reason.spans, at.at_m)) continue;
      const double aside = 1.5e-6 * target.reach(at.position) + 2 * rounding_of(at.position);
      bool is_hidden = false;
      for (std::uint32_t object = 0; object < objects.size() && !is_hidden; ++object) {
        is_hidden = display_name(objects[object]) == reason.name && target.may_be_hidden_by(at.position, object, aside);
      }
      if (!is_hidden) wrong("blames", place_text(at.position) + " is not hidden by " + reason.name);
    }
  }
}

}  // namespace attack
