// libFuzzer target: any bytes as a file of zones. They may be refused with an input error; a zone that is taken must be
// a circle, or have corners on the earth of which neighbours differ.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "app/zone_file.h"
#include "core/zone_check.h"
#include "vantage/error.h"

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

void check_listed(const vantage::internal::app::ListedZone& listed) {
  for (const char c : listed.name) require(static_cast<unsigned char>(c) >= 0x20);
  require(!listed.name.empty());
  require(listed.circle.has_value() == listed.outer.empty());
  if (listed.circle)
    require(listed.circle->least_radius_m > 0 && listed.circle->least_radius_m <= listed.circle->radius_m);
  for (const Eigen::Vector2d& p : listed.outer) require(std::abs(p.y()) <= 90 && std::isfinite(p.x()));
  std::size_t corners = listed.outer.size();
  for (const vantage::Zone::Ring& hole : listed.holes) corners += hole.size();
  require(listed.corner_z_m.empty() || listed.corner_z_m.size() == corners);
  if (listed.lower) require(listed.has_heights && std::isfinite(listed.lower->metres));
  if (listed.upper) require(listed.has_heights && std::isfinite(listed.upper->metres));
  vantage::Zone zone;
  zone.outer = listed.outer;
  zone.holes = listed.holes;
  (void)vantage::internal::core::fault_of(zone);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    for (const auto& listed : vantage::internal::app::parse_zones(text, "/nowhere/zones.json").zones)
      check_listed(listed);
  } catch (const vantage::Error& error) {
    require(error.kind() == vantage::ErrorKind::input);
    require(!error.problem().empty() && !error.where().empty() && !error.fix().empty());
    require(error.problem().find('\n') == std::string::npos);
  }
  return 0;
}
