#include "request/checker.h"
#include "request/describe_tour.h"
#include "vantage/tour.h"

namespace vantage {

const char* name_of(TourVehicle::Kind kind) {
  return internal::request::word_of(internal::request::kVehicleKinds, kind).data();
}

void check_tour_settings(const TourSettings& settings) {
  internal::request::Checker checker(internal::request::kSection<TourSettings>);
  describe(settings, checker);
}

}  // namespace vantage
