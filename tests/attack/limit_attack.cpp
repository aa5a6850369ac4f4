#include "limit_attack.h"

#include <algorithm>
#include <cstdio>

namespace attack {

std::optional<LimitFacts> facts_named(const std::string& name) {
  std::optional<LimitFacts> found;
  every_limit([&](auto limit) {
    LimitFacts facts = facts_of<limit>();
    const bool is_it =
        name == facts.claim || std::any_of(facts.names.begin(), facts.names.end(),
                                           [&](const std::string& one) { return name.starts_with(one); });
    if (!found && is_it) found = std::move(facts);
  });
  return found;
}

std::string MissionDraws::length(double metres) const { return exact_text(scale * metres); }

void MeshPlaces::about(const vantage::Vec3& at, double size) {
  for (int i = 0; i < 6; ++i) places.push_back(at + size * random.magnitude(1e-3, 1) * random.direction());
}

void add_margin(std::vector<Margin>& margins, const Margin& margin) {
  for (Margin& known : margins) {
    if (known.limit != margin.limit) continue;
    known.low = std::min(known.low, margin.low);
    known.high = std::min(known.high, margin.high);
    known.is_measured = known.is_measured && margin.is_measured;
    return;
  }
  margins.push_back(margin);
}

void Placement::move(vantage::Mesh& mesh) const {
  for (vantage::Vec3& v : mesh.vertices) move(v);
}

void Placement::move(vantage::AboveGround& above) const {
  above.min_m *= unit;
  above.max_m *= unit;
  move(above.ground.plane_z_m);
  if (!above.ground.surface) return;
  vantage::Mesh moved = *above.ground.surface;
  move(moved);
  above.ground.surface = std::make_shared<const vantage::Mesh>(std::move(moved));
}

std::string exact_text(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

std::string exact_text(const vantage::Vec3& p) {
  return "[" + exact_text(p.x()) + ", " + exact_text(p.y()) + ", " + exact_text(p.z()) + "]";
}

std::string exact_pair(double low, double high) { return "[" + exact_text(low) + ", " + exact_text(high) + "]"; }

MissionLines lines_of(const vantage::Navigation& navigation, const vantage::Sensor& sensor) {
  MissionLines lines;
  lines.mount = sensor.mount;
  const auto add = [&](auto limit, const auto& value) { add_text<limit>(value, lines); };
  each_limit(navigation, add);
  each_limit(sensor, add);
  if (!lines.altitude.empty()) lines.navigation = "  altitude: {" + lines.altitude + "}\n" + lines.navigation;
  return lines;
}

}  // namespace attack
