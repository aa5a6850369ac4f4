// A mission's volume as a file, with its report beside it; and read again.
#include "vantage/result.h"

namespace example {

vantage::VolumeFile written(const vantage::Mission& mission) {
  vantage::Result result = vantage::run_mission(mission);
  vantage::write_results(result.volume, vantage::result_request(mission, result, {"volume.ply"}));
  return vantage::read_volume("volume.ply", mission.scene());
}

}  // namespace example
