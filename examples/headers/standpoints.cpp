// The best places to hover at, as JSON.
#include "vantage/standpoints.h"

namespace example {

std::string places(const vantage::Mission& mission, const vantage::Volume& volume,
                   const vantage::PreparedScene& scene) {
  const vantage::Standpoints found = vantage::find_standpoints(mission, volume, scene, vantage::ViewDescriber(mission));
  return vantage::json_text(std::vector<vantage::NamedStandpoints>{{mission.target.name, found}});
}

}  // namespace example
