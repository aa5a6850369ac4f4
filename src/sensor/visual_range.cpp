#include <algorithm>
#include <cmath>

#include "vantage/error.h"
#include "vantage/sensor.h"

namespace vantage {
namespace {

void check_positive(double value, const char* problem, const char* fix) {
  if (value > 0 && std::isfinite(value)) return;
  throw Error(ErrorCode::value_out_of_range, problem, "vlos", fix);
}

}  // namespace

double attitude_line_of_sight_m(const VisualRange& of) {
  return of.kind == VisualRange::Kind::fixed_wing ? 490 * of.aircraft_size_m + 30 : 327 * of.aircraft_size_m + 20;
}

double detection_line_of_sight_m(const VisualRange& of) { return 0.3 * of.visibility_m; }

double visual_range_m(const VisualRange& of) {
  check_positive(of.aircraft_size_m, "the size of the aircraft is not a positive length",
                 "give the largest dimension in metres: wing span, or from rotor to rotor");
  check_positive(of.visibility_m, "the visibility is not a positive length",
                 "give the ground visibility in metres: 5000");
  return std::min(attitude_line_of_sight_m(of), detection_line_of_sight_m(of));
}

}  // namespace vantage
