// A scene of a mesh file, prepared for any number of targets.
#include "vantage/scene.h"

namespace example {

vantage::PreparedScene prepared(const char* file) {
  return vantage::PreparedScene(vantage::read_scene(file, {.up = vantage::UpAxis::y}));
}

}  // namespace example
