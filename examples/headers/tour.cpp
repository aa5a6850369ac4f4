// A flight through the volumes of several targets.
#include "vantage/tour.h"

namespace example {

double tour_m(const std::vector<vantage::TourTarget>& targets) {
  vantage::TourRequest request;
  request.targets = targets;
  request.settings.time_limit_s = 5;
  return vantage::plan_tour(request).length_m;
}

}  // namespace example
