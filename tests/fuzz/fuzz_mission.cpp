// libFuzzer target: any bytes as the text of a mission file. Nothing but Error(input), with one line of each part, may
// come out; what is accepted must satisfy what the rest of the program relies on.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <variant>

#include "app/mission_parser.h"
#include "core/zone_check.h"
#include "vantage/error.h"

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

void check_target(const vantage::MissionTarget& given, bool is_in_frame) {
  require(!given.target.parts.empty());
  for (const std::vector<vantage::Vec3>& part : given.target.parts) {
    if (!std::holds_alternative<std::monostate>(given.source)) {
      require(part.empty());  // the scene says where it lies
    } else if (is_in_frame) {
      require(part.size() == 1 || (part.size() >= 3 && part.size() <= 64));
    }
    for (const vantage::Vec3& vertex : part) require(vertex.allFinite());
  }
}

void check_accepted(const vantage::MissionFile& mission) {
  require(mission.scene.file.is_absolute());
  require(!mission.targets.empty());
  for (const vantage::MissionTarget& target : mission.targets) check_target(target, mission.crs.empty());
  require(std::isfinite(mission.sensor.max_range_m) && mission.sensor.max_range_m > 0);
  require(std::isfinite(mission.exact.tolerance_m) && mission.exact.tolerance_m > 0);
  require(mission.scene.mesh.scale > 0);
  if (mission.navigation.altitude) require(mission.navigation.altitude->min_m < mission.navigation.altitude->max_m);
  for (const vantage::Zone& zone : mission.navigation.keep_in) require(!vantage::internal::core::fault_of(zone));
  for (const vantage::Zone& zone : mission.navigation.keep_out) require(!vantage::internal::core::fault_of(zone));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    check_accepted(vantage::internal::app::parse_mission(text, "mission.yaml"));
  } catch (const vantage::Error& error) {
    require(error.kind() == vantage::ErrorKind::input);
    require(!error.problem().empty() && !error.where().empty() && !error.fix().empty());
    require(error.problem().find('\n') == std::string::npos);
  }
  return 0;
}
