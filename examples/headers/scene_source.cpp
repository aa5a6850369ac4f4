// Any file: a mesh; or a map, where enable_maps() of vantage/city.h was called.
#include "vantage/scene_source.h"

namespace example {

vantage::Scene loaded(const char* file) {
  vantage::SceneSource source;
  source.kind = vantage::source_kind(file);
  source.file = file;
  return vantage::load_scene(source).scene;
}

}  // namespace example
