// A mission file, computed.
#include "vantage/mission.h"

namespace example {

vantage::Volume computed(const char* file) {
  return vantage::run_mission(vantage::resolve_mission(vantage::read_mission(file))).volume;
}

}  // namespace example
